// What droplets give to the particles that they hit: momentum, summed over an outer step in whole units.
#pragma once

#include <cstdint>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"
#include "dem/particles.hpp"
#include "spray/whole_units.hpp"

namespace pellicle::spray {

/// Of one particle in an outer step, in whole units: the same in whatever order droplets come.
struct alignas(32) ParticlePush {
  std::int64_t momentum[3] = {};  ///< that captured droplets had, and the impulse of those that bounced
  std::int64_t mass = 0;          ///< of captured droplets
};

/// Adds to what particles get. Empty if droplets do not push them.
struct ParticlePushes {
  DeviceArray<ParticlePush> of;  ///< one entry a particle
  WholeUnits unit;

  KOKKOS_INLINE_FUNCTION bool is_on() const { return of.extent(0) > 0; }
  /// A droplet of this momentum [kg m/s] and mass [kg] stays on particle p.
  KOKKOS_INLINE_FUNCTION void capture(Index p, const Vec3& momentum, Real mass) const {
    push(p, momentum);
    Kokkos::atomic_add(&of(p).mass, whole(mass / unit.water));
  }
  /// An impulse [N s] on particle p; returns it in whole units.
  KOKKOS_INLINE_FUNCTION Vec3 push(Index p, const Vec3& impulse) const {
    Vec3 given;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t units = whole(impulse[axis] / unit.impulse);
      Kokkos::atomic_add(&of(p).momentum[axis], units);
      given[axis] = unit.impulse * static_cast<Real>(units);
    }
    return given;
  }
};

/// Gives every moving particle of mass M and velocity v the velocity that it and what it captured, of mass m and momentum p,
/// have together, v + (p - m v)/(M + m), and clears `pushes`. The velocity is that half a step before the position, whose
/// momentum the ledger counts; `half_step` [s]. Returns the sum of M times the changes [kg m/s], in blocks of a fixed size;
/// `partial` is scratch that grows.
Vec3 push_particles(const dem::Particles& particles, const ParticlePushes& pushes, Real half_step,
                    DeviceArray<Vec3>& partial);

}  // namespace pellicle::spray
