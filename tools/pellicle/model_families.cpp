#include "tools/pellicle/model_families.hpp"

#include <array>

#include "cfd/gas_options.hpp"
#include "core/model_variant.hpp"
#include "coupling/coupling_options.hpp"
#include "dem/contact_laws.hpp"
#include "dem/size_distribution.hpp"
#include "heat/film_growth.hpp"
#include "heat/heat_options.hpp"
#include "spray/spray_pattern.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

namespace {

constexpr core::ModelInfo axis_list[] = {
    {"x", "from left to right"}, {"y", "from front to back"}, {"z", "from bottom to top"}};

constexpr core::ModelInfo side_list[] = {{"left", "smallest x"},   {"right", "largest x"},
                                         {"front", "smallest y"},  {"back", "largest y"},
                                         {"bottom", "smallest z"}, {"top", "largest z"}};

constexpr core::ModelInfo length_unit_list[] = {{"m", "metre"}, {"cm", "centimetre"}, {"mm", "millimetre"}};

constexpr core::ModelInfo fill_pattern_list[] = {
    {"lattice", "cubic, bottom layer first; up to a solids fraction of 0.52"},
    {"random",
     "up to a solids fraction of 0.30 uniform, one after the other; up to 0.60 by moving overlaps away"},
    {"hexagonal", "close-packed layers, the bottom one first; up to a solids fraction of 0.74"}};

static_assert(static_cast<int>(spray::SprayPattern::full) == 0 &&
              static_cast<int>(spray::SprayPattern::hollow) == 1);
constexpr core::ModelInfo spray_pattern_list[] = {
    {"full", "uniform over the solid angle of the cone, from anywhere on the orifice"},
    {"hollow", "uniform over the solid angle between two cones, from the rim of the orifice outwards"}};

template <std::size_t N, std::size_t M>
constexpr std::array<core::ModelInfo, N + M> join(const std::array<core::ModelInfo, N>& a,
                                                  const std::array<core::ModelInfo, M>& b) {
  std::array<core::ModelInfo, N + M> joined{};
  for (std::size_t i = 0; i < N; ++i) joined[i] = a[i];
  for (std::size_t i = 0; i < M; ++i) joined[N + i] = b[i];
  return joined;
}
constexpr auto line_quantity_list = join(particle_quantities, gas_quantities);
constexpr auto probe_quantity_list =
    join(join(join(join(join(line_quantity_list, bed_quantities), coating_quantities), wall_quantities),
              side_quantities),
         plane_quantities);
constexpr auto plane_probe_quantity_list = join(plane_quantities, gas_quantities);

}  // namespace

constinit const core::ModelList axes = axis_list;
constinit const core::ModelList domain_sides = side_list;
constinit const core::ModelList length_units = length_unit_list;
constinit const core::ModelList fill_patterns = fill_pattern_list;
constinit const core::ModelList normal_contact_models = core::model_list<dem::NormalLaw>();
constinit const core::ModelList tangential_contact_models = core::model_list<dem::TangentialLaw>();
constinit const core::ModelList rolling_models = core::model_list<dem::RollingLaw>();
constinit const core::ModelList cohesion_models = core::model_list<dem::CohesionLaw>();
constinit const core::ModelList drag_laws = core::model_list<coupling::DragLaw>();
constinit const core::ModelList depositions = core::model_list<coupling::Deposition>();
constinit const core::ModelList transfer_laws = core::model_list<heat::TransferLaw>();
constinit const core::ModelList saturation_laws = core::model_list<heat::SaturationLaw>();
constinit const core::ModelList spray_patterns = spray_pattern_list;
constinit const core::ModelList line_quantities = line_quantity_list;
constinit const core::ModelList probe_quantities = probe_quantity_list;
constinit const core::ModelList plane_probe_quantities = plane_probe_quantity_list;

const std::vector<ModelFamily>& model_families() {
  static const std::vector<ModelFamily> families{
      {"contacts.model.normal", "Normal contact force", normal_contact_models},
      {"contacts.model.tangential", "Tangential contact force", tangential_contact_models},
      {"contacts.model.rolling", "Rolling resistance", rolling_models},
      {"contacts.cohesion.model", "Attraction between particles", cohesion_models},
      {"particles.diameter", "Ways in which the diameters of a fill are spread",
       core::model_list<dem::SizeDistribution>()},
      {"particles.fill.pattern", "Ways to fill a region with particles", fill_patterns},
      {"gas.convection", "Convection schemes of the gas", cfd::convection_models},
      {"gas.turbulence", "Models of turbulence of the gas", cfd::turbulence_models},
      {"coupling.drag", "Drag laws", drag_laws},
      {"coupling.deposition", "Ways to share a particle's volume among cells", depositions},
      {"coupling.exchange", "Momentum exchange between gas and particles", coupling::exchange_models},
      {"coupling.coefficients", "How often momentum exchange coefficients are computed",
       coupling::coefficients_models},
      {"heat.nusselt", "Heat transfer between gas and particles", transfer_laws},
      {"heat.sherwood", "Transfer of vapour between gas and particles", transfer_laws},
      {"heat.saturation", "Vapour pressure over water", saturation_laws},
      {"coating.growth", "What films do to the motion of their particles", heat::film_growth_models},
      {"spray.pattern", "Where the droplets of a nozzle go", spray_patterns},
  };
  return families;
}

const std::vector<ModelFamily>& quantity_families() {
  static const std::vector<ModelFamily> families{
      {"quantities.particles", "Of particles, for lines, histograms and probes of one particle",
       particle_quantities},
      {"quantities.gas", "Of the gas, for lines, probes of a point and, as means, of a plane",
       gas_quantities},
      {"quantities.bed", "Of the whole bed, for probes", bed_quantities},
      {"quantities.coating", "Of the coating of the whole bed, for probes", coating_quantities},
      {"quantities.wall", "Of a wall, for probes; means over the time since the row before", wall_quantities},
      {"quantities.side", "Of an open side, for probes", side_quantities},
      {"quantities.plane", "Of the gas through a plane, for probes", plane_quantities},
  };
  return families;
}

}  // namespace pellicle::tools
