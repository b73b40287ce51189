// Particles whose mass changes while they move.
#include <stdexcept>

#include "core/error.hpp"
#include "dem/engine.hpp"
#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

/// Velocities stay: what is added has the particle's.
struct SetMasses {
  Particles particles;
  DeviceArray<Real> mass;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    particles.mass(p) = mass(p);
    VelocitySpin& motion = particles.velocity_spin(p);
    if (motion.inverse_mass != 0) motion.inverse_mass = 1 / mass(p);
  }
};

struct SetRadii {
  DeviceArray<PositionRadius> place;
  DeviceArray<Real> radius;
  DeviceArray<Displacement> displacement;  // empty without lists
  /// What a particle gains in radius its surface has moved: that is taken off its allowance, with what rounding to single
  /// precision may add. Tells the largest radius and the least that is left of an allowance.
  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Real& largest, Real& least) const {
    const Real gained = radius(p) - place(p).radius;
    place(p).radius = radius(p);
    largest = Kokkos::max(largest, radius(p));
    if (displacement.extent(0) == 0) return;
    const auto allowance = static_cast<Real>(displacement(p).allowance);
    if (gained > 0) displacement(p).allowance = static_cast<float>(allowance - gained - 2e-7 * allowance);
    least = Kokkos::min(least, allowance - gained);
  }
};

}  // namespace

void Engine::book_growth(const Vec3& momentum_before) {
  const ParticleTotals totals = compute_totals();
  grown_momentum_ += totals.momentum - momentum_before;
  grown_mass_ += totals.mass - moving_mass_;
  moving_mass_ = totals.mass;
  moving_volume_ = totals.volume;
}

void Engine::set_masses(const DeviceArray<Real>& mass) {
  if (particles_.count == 0) return;
  const Vec3 momentum = compute_totals().momentum;
  Kokkos::parallel_for("dem::engine_masses::set_masses", DeviceRange(0, particles_.count),
                       SetMasses{particles_, mass});
  book_growth(momentum);
}

void Engine::set_sizes(const DeviceArray<Real>& mass, const DeviceArray<Real>& radius) {
  if (particles_.count == 0) return;
  const Vec3 momentum = compute_totals().momentum;
  Kokkos::parallel_for("dem::engine_masses::set_masses_with_radii", DeviceRange(0, particles_.count),
                       SetMasses{particles_, mass});
  Real largest = 0, least = 0;
  Kokkos::parallel_reduce("dem::engine_masses::set_radii", DeviceRange(0, particles_.count),
                          SetRadii{particles_.position_radius, radius,
                                   list_valid_ ? list_.displacement : DeviceArray<Displacement>{}},
                          Kokkos::Max<Real>(largest), Kokkos::Min<Real>(least));
  book_growth(momentum);
  // An allowance that is used up does not show in the motion of a particle that rests.
  if (list_valid_ && !(least > 0)) list_valid_ = false;
  try {
    search_.front().require_room(largest);
  } catch (const std::invalid_argument& narrow) {
    throw RunError(narrow.what());
  }
}

}  // namespace pellicle::dem
