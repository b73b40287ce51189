// Conduction of heat between particles that touch, and between particles and walls, once a gas step.
#pragma once

#include <optional>
#include <vector>

#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/engine.hpp"
#include "heat/conduction_laws.hpp"
#include "heat/surface_state.hpp"

namespace pellicle::core {
class CheckpointReader;
class CheckpointWriter;
}  // namespace pellicle::core

namespace pellicle::heat {

struct ConductionOptions {
  std::vector<ConductingSolid> solids;                ///< of each material
  std::vector<std::optional<Real>> wall_temperature;  ///< of each wall [K]; none: it takes no heat
};

/// What contacts bring to a particle in one step.
struct Conducted {
  Real heat = 0;    ///< [J]
  Real bound = 0;   ///< sum over its contacts of what they conduct for 1 K [J/K]
  Real linear = 0;  ///< sum of h dt, which is larger [J/K]
};

/// Every contact exchanges what it would if its two bodies were alone. Where a particle could so be carried beyond its
/// neighbours the step is divided. Pairs get opposite heat to the last bit; sums are in the order of the neighbour list,
/// whatever the number of threads. docs/theory/heat.md.
class ContactConduction {
 public:
  explicit ContactConduction(const ConductionOptions& options);

  /// Advances temperatures by `step` [s] through the contacts that there are; to be called after the engine's substeps,
  /// before anything reorders the particles.
  void update(const dem::Engine& engine, const SurfaceState& surface, Real step);

  /// Heat that went into each wall since the start [J].
  const std::vector<Real>& heat_to_walls() const { return heat_to_walls_; }
  /// Parts that the last step was divided into.
  int parts() const { return parts_; }

  void save(core::CheckpointWriter& file) const;
  void load(const core::CheckpointReader& file);

 private:
  void find_flows(const dem::Engine& engine, const SurfaceState& surface, Real step);
  void apply(const dem::Engine& engine, const SurfaceState& surface);

  Index materials_ = 0, walls_ = 0;
  bool any_warm_wall_ = false;
  DeviceArray<Real> per_radius_;        // of pairs of materials, conductance_per_radius
  DeviceArray<Real> wall_temperature_;  // [K]; negative: it takes no heat
  DeviceArray<Real> capacity_;          // of every particle [J/K]
  DeviceArray<Conducted> flow_;         // likewise
  DeviceArray<Real> wall_heat_;         // by block of the wall list and wall [J]
  decltype(Kokkos::create_mirror_view(DeviceArray<Real>())) wall_heat_host_;
  std::vector<Real> heat_to_walls_;
  Index fixed_ = 0;  // fixed particles
  int parts_ = 0;
};

}  // namespace pellicle::heat
