// The force of the gas on a particle during the substeps of a gas step, as the motion kernel calls it.
#pragma once

#include <Kokkos_Core.hpp>

#include <variant>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"
#include "coupling/drag_laws.hpp"
#include "dem/particles.hpp"

namespace pellicle::coupling {

/// The gas that one particle sees, sampled once a gas step; in one cache line.
struct alignas(64) SampledGas {
  Vec3 velocity;              ///< [m/s]
  Real drag_coefficient = 0;  ///< K V, at the particle's velocity at the start of the gas step [kg/s]
  Vec3 pressure_force;        ///< -V grad p [N]
  Real void_fraction = 1;
};

/// What drag feels of the gas.
struct LocalGas {
  Real density = 0;    ///< [kg/m3]
  Real viscosity = 0;  ///< dynamic [Pa s]
  KOKKOS_INLINE_FUNCTION LocalGas& operator+=(const LocalGas& b) {
    density += b.density;
    viscosity += b.viscosity;
    return *this;
  }
  friend KOKKOS_INLINE_FUNCTION LocalGas operator*(Real s, const LocalGas& a) {
    return {s * a.density, s * a.viscosity};
  }
};

/// What the gas gave to one particle since the start of the gas step; in half a cache line.
struct alignas(32) Received {
  Vec3 drag_impulse;  ///< [N s]
  Real time = 0;      ///< over which forces acted [s]
};

/// Fluid force with coefficients fixed during the gas step.
struct FixedCoefficientForce {
  DeviceArray<SampledGas> gas;
  DeviceArray<Received> received;
  DeviceArray<dem::PositionRadius> position_radius;
  Vec3 buoyancy_per_volume;  ///< -density gravity [N/m3]

  /// Force [N] on particle p at this velocity; adds what acts over dt [s] to what p has received. To be called once a
  /// particle and substep.
  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index p, const Vec3& velocity, Real dt) const {
    const SampledGas g = gas(p);
    return add_drag(p, dt, g, g.drag_coefficient * (g.velocity - velocity));
  }

  KOKKOS_INLINE_FUNCTION Vec3 add_drag(Index p, Real dt, const SampledGas& g, const Vec3& drag) const {
    Received sum = received(p);
    sum.drag_impulse += dt * drag;
    sum.time += dt;
    received(p) = sum;
    return drag + g.pressure_force + volume(p) * buoyancy_per_volume;
  }

  KOKKOS_INLINE_FUNCTION Real volume(Index p) const { return dem::sphere_volume(position_radius(p).radius); }
};

/// Fluid force whose momentum exchange coefficient follows the particle's velocity.
struct FollowingCoefficientForce {
  FixedCoefficientForce fixed;
  LocalGas uniform;
  DeviceArray<LocalGas> local;  ///< of every particle; empty where the gas is uniform
  int law;                      ///< position in the list of drag laws

  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index p, const Vec3& velocity, Real dt) const {
    const SampledGas g = fixed.gas(p);
    const Vec3 slip = g.velocity - velocity;
    const LocalGas around = local.extent(0) > 0 ? local(p) : uniform;
    const ParticleFlow flow{g.void_fraction, norm(slip), 2 * fixed.position_radius(p).radius, around.density,
                            around.viscosity};
    return fixed.add_drag(p, dt, g, (fixed.volume(p) * momentum_exchange_coefficient(law, flow)) * slip);
  }
};

/// The two cost differently: std::visit picks the one in use, once a gas step.
using FluidForce = std::variant<FixedCoefficientForce, FollowingCoefficientForce>;

}  // namespace pellicle::coupling
