// Walls that particles touch, as a case describes them: shapes, material, motion.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "dem/wall_motion.hpp"
#include "dem/wall_shapes.hpp"

namespace pellicle::dem {

/// Triangles by the numbers of their corners.
struct TriangleMesh {
  std::vector<Vec3> corners;  ///< [m]
  std::vector<std::array<std::int32_t, 3>> triangles;
  bool closed = false;  ///< watertight: every point that is not on it is either within or outside

  TriangleShape triangle(std::size_t t) const {
    const auto corner = [&](std::size_t i) { return corners[static_cast<std::size_t>(triangles[t][i])]; };
    return {corner(0), corner(1), corner(2)};
  }
};

/// An unbounded plane as a wall of its own; particles live on the side its normal points to.
struct PlaneWall {
  std::string name;
  Vec3 point;        ///< any point of the plane [m]
  Vec3 normal;       ///< unit vector into the particles' side
  Vec3 velocity{};   ///< speed of its surface without displacement (a belt) [m/s]
  int material = 0;  ///< index into the materials
};

/// A wall with a name: any number of shapes of one material that move together.
struct Wall {
  std::string name;
  int material = 0;  ///< index into the materials
  WallMotion motion{};
  Vec3 torque_about{};  ///< the point that its torque is reported about [m]
  std::vector<PlaneShape> planes{};
  std::vector<RevolvedShape> revolved{};
  std::vector<BoxShape> boxes{};
  std::shared_ptr<const TriangleMesh> mesh{};

  Wall() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a plane is the wall that most set-ups need
  Wall(const PlaneWall& plane)
      : name(plane.name), material(plane.material), planes{{plane.normal, dot(plane.normal, plane.point)}} {
    motion.surface_velocity = plane.velocity;
  }
};

/// Whether a wall turns with its spin, because its shape is not the same at every angle about that axis.
bool has_to_turn(const Wall& wall);

/// Largest distance [m] from the axis of its spin of a point of the wall; of the part within `domain` if it has no bounds.
Real largest_arm(const Wall& wall, const Vec3& domain_min, const Vec3& domain_max);

}  // namespace pellicle::dem
