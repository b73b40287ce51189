#include "dem/walls.hpp"

#include <algorithm>
#include <cmath>

namespace pellicle::dem {
namespace {

/// Distance of a point from the axis of the wall's spin; from the point it leads through if there is no spin.
Real arm(const WallMotion& motion, const Vec3& point) {
  const Vec3 from_axis = point - motion.through;
  const Real speed = norm(motion.spin);
  if (speed == 0) return norm(from_axis);
  return norm(cross(from_axis, motion.spin)) / speed;
}

bool parallel(const Vec3& a, const Vec3& b) { return norm(cross(a, b)) <= 1e-12 * norm(a) * norm(b); }

Real arm_of_box(const WallMotion& motion, const Vec3& min, const Vec3& max) {
  Real largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x{(corner & 1) != 0 ? max.x : min.x, (corner & 2) != 0 ? max.y : min.y,
                 (corner & 4) != 0 ? max.z : min.z};
    largest = std::max(largest, arm(motion, x));
  }
  return largest;
}

}  // namespace

bool has_to_turn(const Wall& wall) {
  const Vec3& spin = wall.motion.spin;
  if (norm(spin) == 0) return false;
  if (wall.mesh || !wall.boxes.empty()) return true;
  const auto plane_turns = [&](const PlaneShape& plane) { return !parallel(plane.normal, spin); };
  const auto revolved_turns = [&](const RevolvedShape& shape) {
    const Real size = std::max({shape.r0, shape.r1, std::abs(shape.z1 - shape.z0)});
    return !parallel(shape.axis, spin) || arm(wall.motion, shape.origin) > 1e-12 * size;
  };
  return std::any_of(wall.planes.begin(), wall.planes.end(), plane_turns) ||
         std::any_of(wall.revolved.begin(), wall.revolved.end(), revolved_turns);
}

Real largest_arm(const Wall& wall, const Vec3& domain_min, const Vec3& domain_max) {
  Real largest = 0;
  if (!wall.planes.empty()) largest = arm_of_box(wall.motion, domain_min, domain_max);
  for (const BoxShape& box : wall.boxes)
    largest = std::max(largest, arm_of_box(wall.motion, box.min, box.max));
  for (const RevolvedShape& shape : wall.revolved) {
    // An end circle reaches no further from the axis of the spin than its centre does, and its radius.
    for (const auto& [r, z] : {std::pair(shape.r0, shape.z0), std::pair(shape.r1, shape.z1)})
      largest = std::max(largest, arm(wall.motion, shape.origin + z * shape.axis) + r);
  }
  if (wall.mesh) {
    for (const Vec3& corner : wall.mesh->corners) largest = std::max(largest, arm(wall.motion, corner));
  }
  return largest;
}

}  // namespace pellicle::dem
