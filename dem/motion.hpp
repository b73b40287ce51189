// Newton's law for every particle: velocity-Verlet, the contact force once a step.
#pragma once

#include <algorithm>
#include <type_traits>

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
    const ContactLoad load = contacts.load(p);
    contacts.touching(p) = static_cast<std::int32_t>(load.touching);
    if (motion.inverse_mass == 0) return;
    const Real half = 0.5 * step.time_step;
    const Vec3 acceleration = motion.inverse_mass * (load.force + fluid) + step.gravity;
    const Real inverse_inertia = 2.5 * motion.inverse_mass / (place.radius * place.radius);
    const Vec3 angular_acceleration = inverse_inertia * load.torque;
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

/// Particles a work item of the kernel below. A multiple of four.
inline constexpr Index motion_block = 64;

/// The same on a CPU, for a block of particles, velocity and spin side by side in a vector. What does not change is read
/// once: the compiler cannot know that writing to particles leaves the kernel alone.
template <class FluidForce>
struct MotionKernelInLanes {
  Particles particles;
  ContactResult contacts;
  NeighbourList list;
  MotionStep step;
  FluidForce fluid_force;
  MotionFlagsView flags;

  void operator()(const Index block) const {
    const Index begin = block * motion_block;
    const Index end = std::min(begin + motion_block, particles.count);
    const Rows rows{particles.position_radius.data(), particles.velocity_spin.data(),
                    particles.acceleration.data(),    particles.angular_acceleration.data(),
                    list.displacement.data(),         contacts.load.data(),
                    contacts.touching.data()};
    const Vec3& g = step.gravity;
    const Constants constants{{g.x, g.y, g.z, 0, 0, 0, 0, 0},
                              lanes::all(0.5 * step.time_step),
                              lanes::all(step.kick),
                              lanes::all(step.time_step),
                              step.kick};
    bool spent = false;
    Index p = begin;
    for (; p + 4 <= end; p += 4) {
      prefetch_four(rows, p);
      // All that has to be divided at once and early: what waits for it fills the processor's queue.
      lanes::Real4 mass;
      lanes::Real4 radius;
      for (int k = 0; k < 4; ++k) {
        mass[k] = rows.motion[p + k].inverse_mass;
        radius[k] = rows.place[p + k].radius;
      }
      const lanes::Real4 inertia = 2.5 * mass / (radius * radius);
      const bool fixed = mass[0] * mass[1] * mass[2] * mass[3] == 0;
      lanes::Float4 moved[4];
      for (int k = 0; k < 4; ++k) moved[k] = move(rows, constants, p + k, inertia[k], fixed);
      // Together: reading at once what was written one by one takes long.
      Displacement* const four = rows.displacement + p;
      const lanes::Float16 displacement =
          lanes::load<lanes::Float16>(four) +
          lanes::join(lanes::join(moved[0], moved[1]), lanes::join(moved[2], moved[3]));
      lanes::store(displacement, four);
      spent = any_spent(displacement) || spent;
    }
    for (; p < end; ++p) {
      const Real radius = rows.place[p].radius;
      const auto moved =
          move(rows, constants, p, 2.5 * rows.motion[p].inverse_mass / (radius * radius), true);
      lanes::store(lanes::load<lanes::Float4>(rows.displacement + p) + moved, rows.displacement + p);
      spent = rows.displacement[p].spent() || spent;
    }
    if (spent) {
      flags().list_outdated = 1;  // every writer writes the same
      for (p = begin; p < end; ++p) note_broken(rows, p);
    }
  }

 private:
  struct Rows {
    PositionRadius* place;
    VelocitySpin* motion;
    Vec3f* acceleration;
    Vec3f* angular_acceleration;
    Displacement* displacement;
    const ContactLoad* load;
    std::int32_t* touching;
  };
  struct Constants {
    lanes::Real8 gravity, half_step, kick, time_step;
    Real fluid_time;
  };

  /// Moves a particle, which may be `fixed` or not; returns by how much.
  KOKKOS_FORCEINLINE_FUNCTION lanes::Float4 move(const Rows& rows, const Constants& constants, Index p,
                                                 Real inverse_inertia, bool fixed) const {
    using lanes::Float4;
    using lanes::Real4;
    using lanes::Real8;
    VelocitySpin& motion = rows.motion[p];
    auto force = lanes::load<Real8>(rows.load + p);
    if constexpr (std::is_same_v<FluidForce, NoFluid>) {
      rows.touching[p] = static_cast<std::int32_t>(rows.load[p].touching);
    } else {
      const Vec3 fluid = fluid_force(p, motion.velocity(), constants.fluid_time);
      rows.touching[p] = static_cast<std::int32_t>(rows.load[p].touching);
      force += Real8{fluid.x, fluid.y, fluid.z, 0, 0, 0, 0, 0};
    }
    const Real m = motion.inverse_mass;
    if (fixed && m == 0) return Float4{};
    PositionRadius& place = rows.place[p];
    const Real8 acceleration =
        lanes::select(0x07, lanes::all(m), lanes::all(inverse_inertia)) * force + constants.gravity;
    // What ends a row is no number, and kept as it is.
    const auto row = lanes::load<Real8>(&motion);
    const auto before = lanes::load_threes(&rows.acceleration[p].x, &rows.angular_acceleration[p].x);
    const Real8 velocity =
        lanes::keep(0x3f, row) - constants.half_step * lanes::to_real(before) + constants.kick * acceleration;
    const Real8 kept = lanes::round_to_single(acceleration);
    lanes::store_threes(lanes::to_float(kept), &rows.acceleration[p].x, &rows.angular_acceleration[p].x);
    lanes::store(lanes::select(0x3f, velocity + constants.half_step * kept, row), &motion);
    const Real4 moved = moved_by(constants, velocity);
    lanes::store(lanes::load<Real4>(&place) + moved, &place);
    return __builtin_convertvector(moved, Float4);
  }

  /// x, y, z of a step, and zero.
  KOKKOS_FORCEINLINE_FUNCTION static lanes::Real4 moved_by(const Constants& constants,
                                                           const lanes::Real8& velocity) {
    constexpr lanes::Bits4 in_space{-1, -1, -1, 0};
    const lanes::Real8 all = constants.time_step * velocity;
    const lanes::Real4 moved = __builtin_shufflevector(all, all, 0, 1, 2, 3);
    return reinterpret_cast<lanes::Real4>(reinterpret_cast<lanes::Bits4>(moved) & in_space);
  }

  /// Displacement::spent of any of four.
  KOKKOS_FORCEINLINE_FUNCTION static bool any_spent(const lanes::Float16& d) {
    const lanes::Float16 square = d * d;
    const lanes::Float16 y =
        __builtin_shufflevector(square, square, 1, 1, 1, 1, 5, 5, 5, 5, 9, 9, 9, 9, 13, 13, 13, 13);
    const lanes::Float16 z =
        __builtin_shufflevector(square, square, 2, 2, 2, 2, 6, 6, 6, 6, 10, 10, 10, 10, 14, 14, 14, 14);
    const lanes::Float16 allowance =
        __builtin_shufflevector(d, d, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
    return (lanes::not_at_most(square + y + z, 0.996F * allowance * allowance) & 0x1111) != 0;
  }

  /// As the kernel of one particle: of those whose displacement is spent, the broken ones are told by the velocity half a
  /// step before that of the position.
  void note_broken(const Rows& rows, Index p) const {
    const VelocitySpin& motion = rows.motion[p];
    if (motion.inverse_mass == 0 || !rows.displacement[p].spent()) return;
    const Vec3 velocity = motion.velocity() - 0.5 * step.time_step * convert<Real>(rows.acceleration[p]);
    // Negated, so that NaN counts as broken.
    if (!(norm_squared(velocity) < broken_speed * broken_speed))
      Kokkos::atomic_max(&flags().broken_particle, p);
  }

  /// These are more streams than the processor follows by itself.
  KOKKOS_FORCEINLINE_FUNCTION void prefetch_four(const Rows& rows, Index p) const {
    constexpr Index distance = 48;
    const Index q = std::min(p + distance, particles.count - 1);
    const Index end = std::min(q + 4, particles.count);
    for (Index k = q; k < end; ++k) {
      prefetch_to_write(rows.motion + k);
      prefetch(rows.load + k);
    }
    prefetch_to_write(rows.place + q);
    prefetch_to_write(rows.place + end - 1);
    prefetch_to_write(rows.acceleration + end - 1);
    prefetch_to_write(rows.angular_acceleration + end - 1);
    prefetch_to_write(rows.displacement + end - 1);
    prefetch_to_write(rows.touching + end - 1);
  }
};

#endif

/// One substep of all particles under contacts, gravity and the fluid force.
template <class FluidForce>
void move_particles(const Particles& particles, const ContactResult& contacts, const NeighbourList& list,
                    const MotionStep& step, const FluidForce& fluid_force, const MotionFlagsView& flags) {
#ifndef KOKKOS_ENABLE_CUDA
  using Kernel = MotionKernelInLanes<FluidForce>;
  const Index items = (particles.count + motion_block - 1) / motion_block;
#else
  using Kernel = MotionKernel<FluidForce>;
  const Index items = particles.count;
#endif
  Kokkos::parallel_for("dem::motion::move_particles", DeviceRange(0, items),
                       Kernel{particles, contacts, list, step, fluid_force, flags});
}

}  // namespace pellicle::dem
