// What a case file says, as plain structs in SI units, with every default filled in. The keys have the same names in
// the case file; docs/case_file.md describes each. Nothing here knows YAML.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cfd/boundary.hpp"
#include "cfd/gas_options.hpp"
#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "coupling/coupling_options.hpp"
#include "dem/cohesion_laws.hpp"
#include "dem/fill.hpp"
#include "dem/size_distribution.hpp"
#include "heat/film_growth.hpp"
#include "spray/spray_pattern.hpp"

namespace pellicle::tools {

struct DomainSpec {
  Box box;  ///< [m]
  std::array<bool, 3> periodic{false, false, false};
};

/// Settling until the particles hardly move.
struct SettleSpec {
  int until = 0;      ///< a position in `settle_ends`: quiet
  Real at_most = 0;   ///< [s]
  Real speed = 1e-3;  ///< root mean square of all moving particles [m/s]
};

struct TimeSpec {
  Real end = 0;  ///< [s]
  /// Outer step [s]; without gas, how often the loop looks at outputs (default 10 particle steps).
  Real gas_step = 0;
  /// [s]; gas_step / particle_step is a whole number; equals gas_step without particles.
  Real particle_step = 0;
  std::optional<Real> courant;      ///< of the gas; the outer step is divided where it would be larger
  std::optional<Real> parcel_step;  ///< how often parcels of the spray move [s]; none: they choose
  Real impact_speed = 0;            ///< largest impact speed expected, for the bound on particle_step [m/s]
  Real settle = 0;                  ///< gas off, for so long before t = 0 [s]
  std::optional<SettleSpec> settle_until;  ///< in place of `settle`, which then is 0

  /// The longest that particles settle [s].
  Real longest_settling() const { return settle_until ? settle_until->at_most : settle; }
  bool allow_large_step = false;  ///< particle_step over the bound is a warning, not an error

  /// Substeps an outer step: gas_step / particle_step.
  Index substeps() const { return static_cast<Index>(std::lround(gas_step / particle_step)); }
};

/// Both name and order of `CaseSpec::materials` are kept from the file; materials that only walls name come last.
struct MaterialSpec {
  std::string name;
  bool rigid = false;       ///< named by a wall but not among `materials`: has none of the properties below
  Real density = 0;         ///< [kg/m3]
  Real youngs_modulus = 0;  ///< that contacts have [Pa]
  std::optional<Real> true_youngs_modulus{};  ///< of the real solid [Pa], to tell what softening saves
  Real poisson_ratio = 0;
  std::optional<Real> heat_capacity{};  ///< [J/kg/K]; set where particles have a temperature
  std::optional<Real> conductivity{};   ///< [W/m/K]; set of particles where contacts conduct heat
};

struct PairSpec {
  std::string where;                   ///< `file:line: key.path`, for messages, here and in the structs below
  int material_a = 0, material_b = 0;  ///< indices into CaseSpec::materials
  Real restitution = 0;
  Real sliding_friction = 0;
  Real rolling_friction = 0;               ///< ratio to the reduced radius R*
  std::optional<Real> normal_stiffness{};  ///< of the linear law [N/m]; none: from LinearSpec
};

/// Stiffness of the linear law where a pair gives none.
struct LinearSpec {
  Real largest_overlap = 0.01;  ///< over the smaller radius
  Real speed = 0;               ///< of the impact that overlaps so much [m/s]; 0: time.impact_speed
};

/// Liquid bridges.
struct CohesionSpec {
  std::string model = "willett";
  dem::Willett willett;
};

struct ContactSpec {
  std::string normal = "hertz";
  std::string tangential = "viscous_coulomb";
  std::string rolling = "constant_torque";
  std::optional<CohesionSpec> cohesion;
  std::optional<LinearSpec> linear;  ///< only with the linear law
  bool clip = true;          ///< no attraction at release; the damping then is the one that gives back e
  Real overlap_limit = 0.5;  ///< a larger overlap stops the run; fraction of the (smaller) radius
  std::vector<PairSpec> pairs;
};

struct FillSpec {
  std::string where;
  // Exactly one is set.
  std::optional<Box> box;
  std::optional<dem::CylinderRegion> cylinder;
  std::optional<dem::ConeRegion> cone;
  std::optional<dem::AnnulusRegion> annulus;
  dem::FillPattern pattern = dem::FillPattern::random;
  std::optional<Real> solids_fraction;  ///< how many particles, when neither count nor total_mass is given

  /// The one that is set.
  dem::FillRegion region() const;
  /// Whether both place particles at random in the same region: they are then placed together, and mix.
  bool mixes_with(const FillSpec& other) const;
};

/// Particles that enter during the run.
struct FeedSpec {
  std::string where;
  // Exactly one is set.
  std::optional<Box> box;
  std::optional<dem::DiscRegion> disc;
  // Exactly one is set.
  std::optional<Real> mass_rate;  ///< [kg/s]
  std::optional<Real> rate;       ///< [1/s]
  Real from = 0, to = 0;          ///< [s]; `to` is filled in
};

struct ListedParticleSpec {
  Vec3 position;      ///< [m]
  Vec3 velocity;      ///< [m/s]
  Vec3 spin;          ///< [rad/s]
  Real diameter = 0;  ///< [m]
  bool fixed = false;
};

/// How diameters are spread; exactly one is set.
struct SizesSpec {
  std::optional<dem::UniformSizes> uniform;
  std::optional<dem::NormalSizes> normal;
  std::optional<dem::LogNormalSizes> log_normal;
  std::optional<dem::RosinRammlerSizes> rosin_rammler;
  std::optional<dem::TableSizes> table;

  /// The one that is set, if any.
  std::optional<dem::SizeDistribution> distribution() const;
};

/// Particles of one material: a fill, a list or a feed.
struct PopulationSpec {
  std::string where;
  int material = 0;  ///< index into CaseSpec::materials
  std::optional<Index>
      count;  ///< of count, total_mass and fill->solids_fraction exactly one is set with a fill
  std::optional<Real> total_mass;  ///< [kg]
  Real diameter = 0;  ///< of a filled population [m]; 0 with `sizes`, or if every listed particle has its own
  std::optional<SizesSpec> sizes;  ///< of a filled population whose particles differ
  Vec3 velocity;                   ///< initial, of a filled population; default of listed particles [m/s]
  Vec3 spin;                       ///< likewise [rad/s]
  bool fixed = false;              ///< likewise: never moves, but is felt by others and by the gas
  std::optional<Real> initial_temperature;  ///< [K]; none: HeatSpec's
  std::optional<Real> initial_liquid;  ///< mass of liquid on a particle over that of the particle; none: 0
  std::optional<Real> initial_solids;  ///< likewise of a dry coating
  std::optional<FillSpec> fill;
  std::vector<ListedParticleSpec> list;
  std::optional<FeedSpec> feed;
  std::int64_t filled = 0;  ///< particles of the fill: follows from the above, see count_fill
};

struct PlaneSpec {
  Vec3 point;   ///< [m]
  Vec3 normal;  ///< of length 1, into the domain
};

struct DiscSpec {
  Vec3 centre;            ///< [m]
  Vec3 normal;            ///< of length 1
  Real radius = 0;        ///< [m]
  Real inner_radius = 0;  ///< of the hole [m]
};

struct SpinSpec {
  Real rate = 0;  ///< [rad/s]
  Vec3 axis;      ///< of length 1
  Vec3 through;   ///< a point of the axis [m]
};

struct VibrationSpec {
  Vec3 amplitude;      ///< [m]
  Real frequency = 0;  ///< [Hz]
  Real phase = 0;      ///< [rad]
};

/// What a wall is to the gas.
enum class GasWall { no_slip, free_slip, open };

struct WallSpec {
  std::string where;
  std::string name;
  bool box = false;             ///< the six sides of the domain; exactly one of this and the shapes below
  std::vector<cfd::Side> open;  ///< sides of the box that are left out: particles leave there
  std::optional<PlaneSpec> plane;
  std::optional<DiscSpec> disc;
  std::optional<dem::CylinderRegion> cylinder;
  std::optional<dem::ConeRegion> cone;
  std::optional<Box> block;        ///< a solid box
  std::optional<std::string> stl;  ///< path of a file, absolute
  std::optional<int> unit;         ///< of the file, in the order of `length_units`
  int material = 0;                ///< index into CaseSpec::materials
  Vec3 velocity;                   ///< of the surface; the wall stays in place, like a belt [m/s]
  std::optional<SpinSpec> spin;
  std::optional<VibrationSpec> vibration;
  std::optional<Vec3> torque_about;  ///< [m]
  GasWall gas = GasWall::no_slip;
  std::optional<Real> temperature;  ///< towards particles that touch it [K]; none: it takes no heat
};

/// A box in which cells are smaller.
struct GridZoneSpec {
  Box box;             ///< [m]
  Real cell_size = 0;  ///< [m]
};

/// Cells of a size, and of smaller ones in zones; see make_graded_faces.
struct RefinementSpec {
  Real cell_size = 0;  ///< largest [m]
  Real max_growth = 1.15;
  std::vector<GridZoneSpec> zones;
  std::array<bool, 3> single_cell{false, false, false};  ///< axes along which the domain is one cell
};

/// A grid over the whole domain; see make_grid.
struct GridSpec {
  Index3 cells{0, 0, 0};
  Vec3 growth{1, 1, 1};  ///< per axis, size of a cell over that of the one before it, from min to max
  /// Face coordinates per axis, cells + 1 each [m]; empty along axes where cells and growth say it all.
  std::array<std::vector<Real>, 3> faces;
  std::optional<RefinementSpec> refinement;  ///< what cells and faces follow from, if they do
};

/// Buoyancy of a gas of constant density.
struct BuoyancySpec {
  std::optional<Real> temperature;  ///< without buoyancy [K]; default: the initial one
  std::optional<Real> expansion;    ///< [1/K]; default: 1 / temperature
};

/// Defaults: air at 300 K, and vapour in it at 298 K (Incropera & DeWitt, Fundamentals of Heat and Mass Transfer, 6th
/// ed. 2007, tables A.4, A.6 and A.8).
struct GasHeatSpec {
  Real initial_temperature = 0;               ///< [K]
  Real capacity = 1007;                       ///< of dry gas at constant pressure [J/kg/K]
  Real vapour_capacity = 1872;                ///< [J/kg/K]
  Real conductivity = 0.0263;                 ///< [W/m/K]
  std::optional<Real> reference_temperature;  ///< from which the ledger counts [K]; default: the initial one
  std::optional<BuoyancySpec> buoyancy;
};

struct GasMoistureSpec {
  Real initial_vapour_mass_fraction = 0;
  Real diffusivity = 2.6e-5;  ///< of vapour in the gas [m2/s]
};

struct GasSpec {
  /// Gravity is that of the case. What follows from `heat` and `moisture` is filled in: the scalars, the density and
  /// viscosity at the start of a gas that has laws for them.
  cfd::GasOptions options;
  std::optional<GasHeatSpec> heat;
  std::optional<GasMoistureSpec> moisture;
  Vec3 velocity;               ///< initial [m/s]
  std::optional<Vec3> inside;  ///< a point in the gas, where walls divide the domain [m]
  GridSpec grid;
  std::vector<cfd::BoundaryPatch> boundaries;  ///< what none of them takes is a no-slip wall
};

/// Exchange of heat and vapour between gas and particles.
struct HeatSpec {
  std::string nusselt = "gunn";     ///< a name in the list of heat::TransferLaw
  std::string sherwood = "gunn";    ///< likewise
  std::string saturation = "buck";  ///< a name in the list of heat::SaturationLaw
  std::optional<bool> evaporation;  ///< filled in: whether the gas carries moisture
  bool stefan_flow = false;
  bool contact_conduction = false;
  Real latent_heat = 2.4417e6;                   ///< at the temperature below [J/kg]
  Real latent_heat_temperature = 298.15;         ///< [K]
  std::optional<Real> initial_temperature = {};  ///< of particles [K]; filled in: the gas's
};

/// What films on particles are made of. Defaults: water at 25 degC, and a polymer.
struct CoatingSpec {
  Real liquid_heat_capacity = 4181;  ///< [J/kg/K]
  Real solids_density = 1250;        ///< of the dry coating [kg/m3]
  Real solids_heat_capacity = 1300;  ///< [J/kg/K]
  heat::FilmGrowth growth = heat::FilmGrowth::none;
};

struct CouplingSpec {
  std::string drag = "beetstra";       ///< a name in the list of coupling::DragLaw
  std::string deposition = "divided";  ///< a name in the list of coupling::Deposition
  GridSpec transfer_grid;              ///< default: the gas grid
  coupling::Exchange exchange = coupling::Exchange::implicit;
  bool pressure_gradient_force = true;
  coupling::Coefficients coefficients = coupling::Coefficients::gas_step;
  Real minimum_void_fraction = 0.36;
  Real pending_release = 0.1;  ///< share of the carried momentum that the gas gets back a step
  Real smoothing_length = 0;   ///< of what particles bring to the cells [m]; 0: none
};

/// Share of the droplets that stay on a particle, over the impact Weber number.
struct CaptureSpec {
  std::vector<Real> weber;  ///< increasing
  std::vector<Real> efficiency;
  Real surface_tension = 0.072;  ///< [N/m]
};

/// A nozzle, and the droplets that leave it.
struct NozzleSpec {
  std::string where;
  std::string name;
  Vec3 position;        ///< [m]
  Vec3 axis{0, 0, 1};   ///< of length 1
  Real cone_angle = 0;  ///< full [rad]
  spray::SprayPattern pattern = spray::SprayPattern::full;
  std::optional<Real> inner_cone_angle;  ///< of a hollow cone, full [rad]; filled in
  Real nozzle_radius = 0;                ///< [m]
  Real speed = 0;                        ///< [m/s]
  Real mass_rate = 0;                    ///< liquid and solids [kg/s]
  Real solids_fraction = 0;              ///< of the mass
  Real density = 1000;                   ///< of a droplet [kg/m3]
  Real temperature = 293.15;             ///< [K]
  Real droplet_diameter = 0;             ///< [m]; 0 with `sizes`
  std::optional<SizesSpec> sizes;
  Real droplets_per_parcel = 1;
  Real from = 0, to = 0;  ///< [s]; `to` is filled in
  std::optional<CaptureSpec> capture;
};

/// What droplets do in flight besides flying.
struct DropletSpec {
  bool two_way = false;      ///< they push the gas and the particles
  bool evaporation = false;  ///< they have a temperature, and exchange heat and vapour with the gas
};

/// An interval of simulated time; both ends are filled in.
struct WindowSpec {
  Real from = 0, to = 0;  ///< [s]
};

struct SnapshotSpec {
  Real every = 0;                                                  ///< [s]; 0: none
  std::vector<std::string> particles{"id", "velocity", "radius"};  ///< names of fields
  std::vector<std::string> spray{"nozzle", "velocity", "diameter", "mass"};
  std::vector<std::string> gas{"velocity", "pressure", "void_fraction"};
};

/// Time averages of the gas's fields: gas_average.h5.
struct GasAverageSpec {
  WindowSpec window;
  std::vector<std::string> gas{"velocity", "pressure", "void_fraction"};  ///< names of fields
};

/// Time-averaged profile along a line: bins of length / points, height `thickness`.
struct LineSpec {
  std::string where;
  std::string name;
  Vec3 from, to;  ///< [m]
  Index points = 0;
  std::optional<int> depth_average;  ///< axis 0, 1, 2 over whose whole length a bin extends
  Real thickness = 0;                ///< size of a bin across the line [m]
  std::string quantity;
  WindowSpec average;
};

/// A part of a plane across an axis.
struct PlaneProbeSpec {
  struct Disc {
    Vec3 centre;  ///< [m]; its coordinate along the axis does not matter
    Real radius = 0;
  };
  int axis = 2;
  Real at = 0;               ///< [m]
  std::optional<Box> box;    ///< the part inside it; its extent along the axis does not matter
  std::optional<Disc> disc;  ///< the part inside it
  bool by_flow = false;      ///< means are weighted with the flow, not with the area
};

/// A time series at a point, over a plane, of one particle, of a wall, of an open side, or of the whole bed.
struct ProbeSpec {
  std::string where;
  std::string name;
  std::optional<Vec3> point;  ///< exactly one of the six is set [m]
  std::optional<PlaneProbeSpec> plane;
  std::optional<Index> particle;    ///< id
  std::optional<std::string> wall;  ///< name
  std::optional<int> side;          ///< a position in `domain_sides`
  bool bed = false;
  bool coating = false;
  std::vector<std::string> quantities;
  Real every = 1e-3;                  ///< [s]
  std::optional<WindowSpec> average;  ///< of which mean, RMS, smallest and largest are written too
};

/// Distribution of a particle quantity at given times.
struct HistogramSpec {
  std::string where;
  std::string name;
  std::string quantity;
  Index bins = 50;
  std::optional<Real> min, max;  ///< in the quantity's unit; unset: from the particles
  bool by_mass = false;
  std::optional<std::string> against;  ///< a second quantity: the joint distribution of the two
  Index against_bins = 20;
  std::optional<Real> against_min, against_max;  ///< in that quantity's unit; unset: from the particles
  Real every = 0;                                ///< [s]
};

/// A zone whose passing particles are followed: one of box and cylinder.
struct ZoneSpec {
  std::string where;
  std::string name;
  std::optional<Box> box;  ///< [m]
  std::optional<dem::CylinderRegion> cylinder;
  Real every = 0;             ///< time between two rows; 0: only at the end [s]
  Real shortest_absence = 0;  ///< [s]
  Real longest_time = 0;      ///< upper end of the distributions; 0 until defaults are filled in [s]
  Index bins = 50;
  Index size_classes = 1;
};

/// A region in which the wetness of contacts is counted: one of box and cylinder.
struct WetnessSpec {
  std::string where;
  std::string name;
  std::optional<Box> box;  ///< [m]
  std::optional<dem::CylinderRegion> cylinder;
  int measure = 0;   ///< a position in `wetness_measures`
  Real wettest = 0;  ///< upper end of the bins; 0 until defaults are filled in [kg/m2] or [-]
  Index bins = 20;   ///< of wetness
  Real fastest = 1;  ///< upper end of the bins of speed [m/s]
  Index speed_bins = 20;
  int sample = 0;  ///< 0: of each gas step; 1: of each particle step
  Real every = 0;  ///< time between two histograms; 0: only at the end [s]
};

struct OutputSpec {
  Real checkpoint_every = 0;  ///< [s]; 0: only at the end
  SnapshotSpec snapshots;
  std::optional<GasAverageSpec> average;
  std::vector<LineSpec> lines;
  std::vector<ProbeSpec> probes;
  std::vector<HistogramSpec> histograms;
  std::vector<ZoneSpec> zones;
  std::vector<WetnessSpec> wetness;
};

struct CaseSpec {
  std::string file;  ///< as the user wrote it
  std::string title;
  std::uint64_t seed = 1;
  DomainSpec domain;
  Vec3 gravity{0, 0, -9.81};  ///< [m/s2]
  TimeSpec time;
  std::vector<MaterialSpec> materials;
  ContactSpec contacts;
  std::vector<PopulationSpec> particles;  ///< empty: pure CFD
  std::vector<WallSpec> walls;
  std::optional<GasSpec> gas;  ///< unset: pure DEM
  CouplingSpec coupling;       ///< of use only with both gas and particles
  std::optional<HeatSpec> heat;
  CoatingSpec coating;  ///< of use only where particles have films
  std::vector<NozzleSpec> spray;
  DropletSpec droplets;  ///< of use only with a spray
  OutputSpec output;
  std::vector<std::string> warnings;  ///< each `file:line: key.path: ...`; the run goes on
  std::map<std::string, std::string>
      lines;  ///< key path -> `file:line` (or `--set`), of every key that was given

  /// `file:line: key.path` of a key such as `time.gas_step`, for messages; the line is that of the section if the key
  /// was not given.
  std::string where(const std::string& path) const;
  /// Whether a quantity of particles is kept up in this case: temperature, film and hits are with heat or spray only.
  bool follows(std::string_view quantity) const;
};

/// Gives a grid with a refinement the cells and faces that follow from it; throws std::length_error if they are more than
/// 100,000 along an axis.
void refine(GridSpec& grid, const DomainSpec& domain);

/// The grid that a specification describes, over the domain and periodic where the domain is.
CartesianGrid make_grid(const GridSpec& grid, const DomainSpec& domain);

}  // namespace pellicle::tools
