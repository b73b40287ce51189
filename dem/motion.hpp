// Newton's law for every particle: velocity-Verlet, the contact force once a step.
#pragma once

#include "dem/contact_loop.hpp"
#include "dem/neighbour_list.hpp"
#include "dem/particles.hpp"

#ifndef KOKKOS_ENABLE_CUDA
#include "dem/lanes.hpp"
#include "dem/prefetch.hpp"
#endif

namespace pellicle::dem {

/// The fluid force of a case without gas.
struct NoFluid {
  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index, const Vec3&, Real) const { return {0, 0, 0}; }
};

/// What the motion kernel tells the host at once, in memory that both see: no copy within the substeps.
struct MotionFlags {
  std::int32_t list_outdated = 0;     ///< somebody has moved beyond its allowance
  std::int32_t broken_particle = -1;  ///< a particle whose velocity is not a number or beyond all reason
};
using MotionFlagsView = Kokkos::View<MotionFlags, Kokkos::SharedHostPinnedSpace>;

/// Constants of a substep.
struct MotionStep {
  Vec3 gravity{};      ///< [m/s²]
  Real time_step = 0;  ///< [s]
  Real kick =
      0;  ///< time over which the force acts on the velocity [s]: the time step, half of it at the start
};

/// Faster than this a particle of this size is broken [m/s].
inline constexpr Real broken_speed = 1e4;

/// Advances one particle. Between substeps `velocity_spin` holds v*, the velocity at the time of the position,
/// predicted with the last acceleration: v* = h + a Δt/2, h the velocity half a step earlier. With the new force
///   h ← h + a Δt,  x ← x + h Δt,  v* ← h + a Δt/2 (this a rounded to single precision, as it is kept),
/// which is velocity-Verlet for forces that depend on x, and second order for those that depend on v through v*.
/// Momentum changes by exactly Σ F Δt, so the stock of a ledger is Σ m h.
template <class FluidForce>
struct MotionKernel {
  Particles particles;
  ContactResult contacts;
  NeighbourList list;
  MotionStep step;
  FluidForce fluid_force;
  MotionFlagsView flags;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    VelocitySpin motion = particles.velocity_spin(p);
    PositionRadius place = particles.position_radius(p);
    // Called for fixed particles too: the gas feels them.
    const Vec3 fluid = fluid_force(p, motion.velocity(), step.kick);
    if (motion.inverse_mass == 0) return;
    const Real half = 0.5 * step.time_step;
    const Vec3 acceleration = motion.inverse_mass * (contacts.force(p) + fluid) + step.gravity;
    const Real inverse_inertia = 2.5 * motion.inverse_mass / (place.radius * place.radius);
    const Vec3 angular_acceleration = inverse_inertia * contacts.torque(p);
    const Vec3 velocity =
        motion.velocity() - half * convert<Real>(particles.acceleration(p)) + step.kick * acceleration;
    const Vec3 spin = motion.spin() - half * convert<Real>(particles.angular_acceleration(p)) +
                      step.kick * angular_acceleration;
    const Vec3 moved = step.time_step * velocity;
    place.x += moved.x;
    place.y += moved.y;
    place.z += moved.z;
    const Vec3 kept = round_to_single(acceleration);
    const Vec3 kept_angular = round_to_single(angular_acceleration);
    const Vec3 present = velocity + half * kept;
    const Vec3 present_spin = spin + half * kept_angular;
    motion.vx = present.x;
    motion.vy = present.y;
    motion.vz = present.z;
    motion.wx = present_spin.x;
    motion.wy = present_spin.y;
    motion.wz = present_spin.z;
    particles.position_radius(p) = place;
    particles.velocity_spin(p) = motion;
    particles.acceleration(p) = convert<float>(kept);
    particles.angular_acceleration(p) = convert<float>(kept_angular);
    Displacement since_build = list.displacement(p);
    since_build.x += static_cast<float>(moved.x);
    since_build.y += static_cast<float>(moved.y);
    since_build.z += static_cast<float>(moved.z);
    list.displacement(p) = since_build;
    if (since_build.spent()) {
      flags().list_outdated = 1;  // every writer writes the same
      // Negated, so that NaN counts as broken.
      if (!(norm_squared(velocity) < broken_speed * broken_speed))
        Kokkos::atomic_max(&flags().broken_particle, p);
    }
  }
};

#ifndef KOKKOS_ENABLE_CUDA

/// The same on a CPU, velocity and spin side by side in a vector.
template <class FluidForce>
struct MotionKernelInLanes {
  Particles particles;
  ContactResult contacts;
  NeighbourList list;
  MotionStep step;
  FluidForce fluid_force;
  MotionFlagsView flags;

  void operator()(const Index p) const {
    using lanes::Float4;
    using lanes::Real4;
    using lanes::Real8;
    prefetch_ahead(p);
    VelocitySpin& motion = particles.velocity_spin(p);
    const Vec3 fluid = fluid_force(p, motion.velocity(), step.kick);
    const Real m = motion.inverse_mass;
    if (m == 0) return;
    PositionRadius& place = particles.position_radius(p);
    const Real i = 2.5 * m / (place.radius * place.radius);
    const Real half = 0.5 * step.time_step;
    const Vec3& g = step.gravity;
    const Real8 force = lanes::load_threes(&contacts.force(p).x, &contacts.torque(p).x) +
                        Real8{fluid.x, fluid.y, fluid.z, 0, 0, 0, 0, 0};
    const Real8 acceleration = Real8{m, m, m, i, i, i, 0, 0} * force + Real8{g.x, g.y, g.z, 0, 0, 0, 0, 0};
    float* const kept_linear = &particles.acceleration(p).x;
    float* const kept_angular = &particles.angular_acceleration(p).x;
    // Not what ends the row: material and id are no numbers.
    const Real8 velocity = lanes::keep(0x3f, lanes::load<Real8>(&motion)) -
                           half * lanes::to_real(lanes::load_threes(kept_linear, kept_angular)) +
                           step.kick * acceleration;
    const Real8 kept = lanes::round_to_single(acceleration);
    lanes::store_threes(lanes::to_float(kept), kept_linear, kept_angular);
    const Real8 present = velocity + half * kept;
    lanes::store_six(present, &motion.vx);
    constexpr lanes::Bits4 in_space{-1, -1, -1, 0};
    const Real8 step_all = step.time_step * velocity;
    const auto moved = reinterpret_cast<Real4>(
        reinterpret_cast<lanes::Bits4>(__builtin_shufflevector(step_all, step_all, 0, 1, 2, 3)) & in_space);
    lanes::store(lanes::load<Real4>(&place) + moved, &place);
    Displacement since_build;
    lanes::store(lanes::load<Float4>(&list.displacement(p)) + __builtin_convertvector(moved, Float4),
                 &since_build);
    list.displacement(p) = since_build;
    if (since_build.spent()) {
      flags().list_outdated = 1;  // every writer writes the same
      // Negated, so that NaN counts as broken.
      const Vec3 v{velocity[0], velocity[1], velocity[2]};
      if (!(norm_squared(v) < broken_speed * broken_speed)) Kokkos::atomic_max(&flags().broken_particle, p);
    }
  }

 private:
  /// These are more streams than the processor follows by itself.
  KOKKOS_FORCEINLINE_FUNCTION void prefetch_ahead(Index p) const {
    constexpr Index distance = 48;
    const Index q = Kokkos::min(p + distance, particles.count - 1);
    prefetch_to_write(&particles.velocity_spin(q));
    prefetch_to_write(&particles.position_radius(q));
    prefetch_to_write(&particles.acceleration(q));
    prefetch_to_write(&particles.angular_acceleration(q));
    prefetch_to_write(&list.displacement(q));
    prefetch(&contacts.force(q));
    prefetch(&contacts.torque(q));
  }
};

#endif

/// One substep of all particles under contacts, gravity and the fluid force.
template <class FluidForce>
void move_particles(const Particles& particles, const ContactResult& contacts, const NeighbourList& list,
                    const MotionStep& step, const FluidForce& fluid_force, const MotionFlagsView& flags) {
#ifndef KOKKOS_ENABLE_CUDA
  using Kernel = MotionKernelInLanes<FluidForce>;
#else
  using Kernel = MotionKernel<FluidForce>;
#endif
  Kokkos::parallel_for("dem::motion::move_particles", DeviceRange(0, particles.count),
                       Kernel{particles, contacts, list, step, fluid_force, flags});
}

}  // namespace pellicle::dem
