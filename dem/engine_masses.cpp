// Particles whose mass changes while they move.
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

}  // namespace

void Engine::set_masses(const DeviceArray<Real>& mass) {
  if (particles_.count == 0) return;
  const Vec3 momentum = compute_totals().momentum;
  Kokkos::parallel_for("dem::engine_masses::set_masses", DeviceRange(0, particles_.count),
                       SetMasses{particles_, mass});
  const ParticleTotals totals = compute_totals();
  grown_momentum_ += totals.momentum - momentum;
  grown_mass_ += totals.mass - moving_mass_;
  moving_mass_ = totals.mass;
}

}  // namespace pellicle::dem
