// How walls move, and where a moving wall is at a given time: closed forms, so that a restart needs no state.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::dem {

/// What a wall does from the moment walls start to move; before, it rests where it is at that moment.
struct WallMotion {
  Vec3 surface_velocity{};  ///< of its surface, without displacement, like a belt [m/s]
  Vec3 spin{};              ///< angular velocity [rad/s] …
  Vec3 through{};           ///< … about an axis through this point [m]
  Vec3 amplitude{};         ///< displacement amplitude · sin(2π frequency t + phase) [m]
  Real frequency = 0;       ///< [Hz]
  Real phase = 0;           ///< [rad]
};

/// Where a wall is, and how fast: x = through + R (X − through) + shift for its points X at rest.
struct WallPose {
  Vec3 column_x{1, 0, 0}, column_y{0, 1, 0}, column_z{0, 0, 1};  ///< of the rotation R
  Vec3 through{};                                                ///< centre of the rotation [m]
  Vec3 shift{};                                                  ///< [m]
  Vec3 velocity{};                                               ///< of the shift [m/s]
  Vec3 spin{};                                                   ///< [rad/s]
  Vec3 surface_velocity{};                                       ///< [m/s]
  bool turned = false;                                           ///< R is not 1

  /// A vector of the wall's own frame as the world sees it, and the other way round.
  KOKKOS_INLINE_FUNCTION Vec3 to_world_direction(const Vec3& d) const {
    return turned ? d.x * column_x + d.y * column_y + d.z * column_z : d;
  }
  KOKKOS_INLINE_FUNCTION Vec3 to_wall_direction(const Vec3& d) const {
    return turned ? Vec3{dot(column_x, d), dot(column_y, d), dot(column_z, d)} : d;
  }
  KOKKOS_INLINE_FUNCTION Vec3 to_world(const Vec3& point) const {
    return turned ? through + shift + to_world_direction(point - through) : point + shift;
  }
  KOKKOS_INLINE_FUNCTION Vec3 to_wall(const Vec3& point) const {
    return turned ? through + to_wall_direction(point - shift - through) : point - shift;
  }
  /// Velocity [m/s] of the wall's material at a point of the world, where its surface has the normal n. A belt has no
  /// speed through its own surface.
  KOKKOS_INLINE_FUNCTION Vec3 velocity_at(const Vec3& point, const Vec3& n) const {
    const Vec3 along = surface_velocity - dot(surface_velocity, n) * n;
    return velocity + along + cross(spin, point - through - shift);
  }
};

/// Pose of a wall `time` seconds after walls started to move. `turning`: the shape is not the same at every angle, so
/// that it has to be turned; else the spin only moves the surface.
KOKKOS_INLINE_FUNCTION WallPose compute_pose(const WallMotion& motion, bool turning, Real time) {
  WallPose pose;
  pose.through = motion.through;
  pose.spin = motion.spin;
  pose.surface_velocity = motion.surface_velocity;
  const Real rate = 2 * Kokkos::numbers::pi * motion.frequency;
  const Real angle = rate * time + motion.phase;
  pose.shift = Kokkos::sin(angle) * motion.amplitude;
  pose.velocity = (rate * Kokkos::cos(angle)) * motion.amplitude;
  const Real speed = Kokkos::sqrt(norm_squared(motion.spin));
  if (turning && speed > 0) {
    // Rodrigues: R d = d cos θ + (a × d) sin θ + a (a·d) (1 − cos θ).
    const Vec3 a = (1 / speed) * motion.spin;
    const Real cosine = Kokkos::cos(speed * time);
    const Real sine = Kokkos::sin(speed * time);
    const auto column = [&](const Vec3& d) {
      return cosine * d + sine * cross(a, d) + ((1 - cosine) * dot(a, d)) * a;
    };
    pose.column_x = column({1, 0, 0});
    pose.column_y = column({0, 1, 0});
    pose.column_z = column({0, 0, 1});
    pose.turned = true;
  }
  return pose;
}

/// The same before walls start to move.
KOKKOS_INLINE_FUNCTION WallPose compute_pose_at_rest(const WallMotion& motion) {
  WallPose pose;
  pose.through = motion.through;
  pose.shift = Kokkos::sin(motion.phase) * motion.amplitude;
  return pose;
}

}  // namespace pellicle::dem
