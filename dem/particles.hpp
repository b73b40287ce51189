// The particles: device arrays, one entry a particle.
#pragma once

#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"

namespace pellicle::dem {

using Vec3f = Vector3<float>;

/// The nearest number of single precision, as a Real. Done on the bits, because gcc 12 takes a conversion to float and
/// back for the number itself where it vectorises both.
KOKKOS_INLINE_FUNCTION Real round_to_single(Real x) {
  constexpr std::uint64_t dropped = (std::uint64_t{1} << 29) - 1;
  const auto bits = Kokkos::bit_cast<std::uint64_t>(x);
  return Kokkos::bit_cast<Real>((bits + (dropped + 1) / 2) & ~dropped);
}
KOKKOS_INLINE_FUNCTION Vec3 round_to_single(const Vec3& a) {
  return {round_to_single(a.x), round_to_single(a.y), round_to_single(a.z)};
}

/// Volume of a sphere [m3] from its radius [m].
KOKKOS_INLINE_FUNCTION constexpr Real sphere_volume(Real radius) {
  return 4.0 / 3.0 * 3.14159265358979323846 * radius * radius * radius;
}

/// What the contact search needs of a particle, in half a cache line: a partner is gathered with one load.
struct alignas(32) PositionRadius {
  Real x, y, z;  ///< centre [m]
  Real radius;   ///< [m]
  KOKKOS_INLINE_FUNCTION Vec3 position() const { return {x, y, z}; }
};

/// What the contact force needs of a partner beyond its place, in one cache line.
struct alignas(64) VelocitySpin {
  Real vx, vy, vz;        ///< velocity [m/s], at the time of the position
  Real wx, wy, wz;        ///< angular velocity [rad/s], at the time of the position
  Real inverse_mass;      ///< [1/kg]; 0 for a fixed particle
  std::int32_t material;  ///< index into the case's materials
  std::int32_t id;        ///< never changes, unlike the particle's place in the arrays
  KOKKOS_INLINE_FUNCTION Vec3 velocity() const { return {vx, vy, vz}; }
  KOKKOS_INLINE_FUNCTION Vec3 spin() const { return {wx, wy, wz}; }
};

/// All particles of a run. Arrays are at least `count` long; entry p of each belongs to the same particle.
/// The order changes when particles are re-sorted in space, which happens between outer steps only, so that
/// per-particle arrays of other folders (drag coefficients, impulses) stay valid through the substeps.
/// Accelerations are only there to tell the velocity at the time of the position from that half a step before; both ways
/// use the same single-precision number, so nothing is lost.
struct Particles {
  Index count = 0;
  DeviceArray<PositionRadius> position_radius;
  DeviceArray<VelocitySpin> velocity_spin;
  DeviceArray<Real> mass;                   ///< [kg], also of a fixed particle
  DeviceArray<Vec3f> acceleration;          ///< [m/s2], of the last substep
  DeviceArray<Vec3f> angular_acceleration;  ///< [rad/s2], of the last substep
};

}  // namespace pellicle::dem
