// The spray of a case: nozzles, parcels on their way, and what has become of those that are not.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "core/ledger.hpp"
#include "core/types.hpp"
#include "dem/companion.hpp"
#include "dem/engine.hpp"
#include "heat/surface_state.hpp"
#include "spray/hits.hpp"
#include "spray/injector.hpp"
#include "spray/parcel_motion.hpp"
#include "spray/parcels.hpp"

namespace pellicle::spray {

struct SprayOptions {
  std::vector<Nozzle> nozzles;
  Vec3 gravity{};  ///< [m/s2]
  Real parcel_step =
      0;  ///< how often parcels move [s]; 0: as seldom as their path stays below a particle's radius
  std::uint64_t seed = 1;
  bool watch_momentum = false;  ///< what parcels bring along and take away is added up
  bool push_particles = false;  ///< particles get the momentum of droplets that they capture or throw back
  DropletHeat heat{};           ///< whether droplets evaporate in flight, and by what
  Real solids_density = 0;      ///< of what they leave behind [kg/m3]; of use with `heat` on
};

/// What has become of the droplets of a nozzle, in kg of liquid and solids together; injected is the sum of the others up to
/// evaporated.
struct NozzleFigures {
  std::string name;
  Real injected = 0, captured = 0, wall_loss = 0, overspray = 0;
  Real in_flight = 0;   ///< summed over the parcels there are
  Real evaporated = 0;  ///< in flight, less what condensed
  Real captured_solids = 0, wall_solids = 0, overspray_solids = 0, in_flight_solids = 0;
  Real dried = 0;          ///< solids of droplets that ran dry in flight: dust
  Real dust_captured = 0;  ///< of this, what particles captured nevertheless
  Real solids_fraction = 0;
  std::int64_t parcels = 0;  ///< injected
};

/// Heat that droplets brought since the start [J].
struct SprayHeat {
  Real enthalpy = 0;   ///< of captured ones, above the reference temperature
  Real free_heat = 0;  ///< of this, what nothing gave: droplets take the gas's temperature for nothing
  // Where droplets have a temperature of their own: with which they came, went, and are.
  Real injected = 0, wall_loss = 0, overspray = 0, in_flight = 0;
};

/// Momentum of parcels [kg m/s], since the start but for the last.
struct ParcelMomentum {
  Vec3 injected, captured, wall_loss, overspray;
  Vec3 in_flight;  ///< now
  /// That moving particles got, of droplets that they captured or threw back. The films' own is not in it: it comes with
  /// their mass.
  Vec3 to_particles;
};

/// Of parcels that ended alike, in whole units.
struct EndedWater {
  std::int64_t evaporated = 0, enthalpy = 0;
  std::int64_t dust = 0;  ///< parcels that were dry
};

/// Of the parcels of a nozzle in flight.
struct FlyingWater {
  Real mass = 0, solids = 0;          ///< [kg]
  Real evaporated = 0, enthalpy = 0;  ///< [kg], [J]
};

/// An outer step is inject, move in its substeps (dem::SubstepHook), collect.
class Spray {
 public:
  /// Throws std::invalid_argument for sizes of droplets that make no sense. `walls` are those of the engine.
  Spray(const SprayOptions& options, const std::vector<dem::Wall>& walls);

  /// What the particles remember of their hits: to be attached to the engine.
  dem::FollowingArray<HitRecord>& hit_records() { return records_; }
  const DeviceArray<HitRecord>& hit_record() const { return records_.values(); }

  /// Before the substeps of an outer step that begins at `time` [s]: adds the parcels that leave the nozzles in it.
  void inject(Real time, int substeps, const dem::Engine& engine);

  /// In substep k, before the particles move: moves the parcels, if it is their turn, until the next time it is; says
  /// whether it was.
  bool move(int k, const dem::Engine& engine, const ParcelGas& gas);

  /// After the substeps: hands what was captured to the particles and forgets parcels that fly no more. `gas_temperature`
  /// of the gas grid's cells [K] is empty without heat: no temperature then changes.
  void collect(const dem::Particles& particles, const heat::SurfaceState& surface, const ParcelGas& gas,
               const DeviceArray<Real>& gas_temperature);

  std::vector<NozzleFigures> figures() const;
  /// Summed over the parcels, in blocks of a fixed size, if `SprayOptions::watch_momentum` is set; else 0.
  ParcelMomentum momentum() const;
  /// By the mass of the parcels of any nozzle.
  const WholeUnits& units() const { return units_; }
  SprayHeat heat() const;
  const Parcels& parcels() const { return parcels_; }
  const NozzleView& nozzle(std::int32_t number) const {
    return injectors_[static_cast<std::size_t>(number)].view();
  }
  const DropletHeat& droplet_heat() const { return options_.heat; }
  /// Substeps between two moves, in the present outer step.
  int stride() const { return stride_; }
  std::size_t bytes() const;

  void save(core::CheckpointWriter& file) const;
  void load(const core::CheckpointReader& file);

 private:
  int choose_stride(const ParticleBounds& bounds, Real substep) const;
  std::array<Vec3, fate_count> sum_momentum(Index first) const;
  MovingWalls walls_during(const dem::Engine& engine, int substeps) const;

  void count_ended_water();
  void make_pushes(Index particles);
  void push(const dem::Particles& particles);
  /// Sums over the parcels in flight, by nozzle.
  std::vector<FlyingWater> sum_flying() const;

  SprayOptions options_;
  WholeUnits units_;
  std::vector<Injector> injectors_;
  DeviceArray<NozzleView> nozzle_;
  DeviceArray<Real> nozzle_temperature_;
  Parcels parcels_, aside_;
  HitList hits_;
  DeviceArray<HitHeat> heat_scratch_;
  dem::FollowingArray<HitRecord> records_;
  DeviceArray<std::int64_t> ended_;  // parcels by nozzle and fate, since the start
  bool walls_move_ = false;
  DeviceArray<dem::WallPose> pose_at_end_;

  // Of the present outer step.
  Real time_ = 0;
  int substeps_ = 0;
  int stride_ = 1;
  Real half_step_ = 0;  // of a particle [s]
  Real largest_speed_ = 0;

  core::ExactSum enthalpy_, free_heat_;
  ParticlePushes pushes_;  // of the present outer step
  DeviceArray<Vec3> push_scratch_;
  std::array<core::ExactSum, 3> pushed_;
  mutable DeviceArray<Vec3> momentum_scratch_;
  std::array<core::ExactSum, 3 * static_cast<std::size_t>(fate_count)> momentum_;  // injected, then by fate
  // Where droplets evaporate: of parcels that ended in an outer step, and since the start, by nozzle and fate.
  DeviceArray<EndedWater> ended_water_;
  DeviceArray<std::int64_t> dried_;  // parcels, by nozzle, since the start
  std::vector<core::ExactSum> evaporated_, ended_enthalpy_;
  std::vector<std::int64_t> dust_;
};

}  // namespace pellicle::spray
