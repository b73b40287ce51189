// Surfaces within the domain that the gas cannot pass: what shapes they have, and where grid lines cross them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cfd/boundary.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::cfd {

/// An unbounded plane, {x : normal.x = offset}.
struct PlaneSurface {
  Vec3 normal;  ///< unit vector
  Real offset;  ///< [m]
};

/// A segment turned about an axis: a cylinder, a cone frustum, a disc or an annulus. Open at its ends.
struct RevolvedSurface {
  Vec3 origin;  ///< any point of the axis [m]
  Vec3 axis;    ///< unit vector
  Real r0, z0;  ///< one end of the segment: distance from the axis, place along it from the origin [m]
  Real r1, z1;  ///< the other end
};

/// The six sides of a box.
struct BoxSurface {
  Vec3 min, max;  ///< [m]
};

/// Triangles by the numbers of their corners.
struct MeshSurface {
  std::shared_ptr<const std::vector<Vec3>> corners;  ///< [m]
  std::shared_ptr<const std::vector<std::array<std::int32_t, 3>>> triangles;
};

using SurfaceShape = std::variant<PlaneSurface, RevolvedSurface, BoxSurface, MeshSurface>;

/// A named surface: a wall of the case as the gas sees it. It does not move; its material may.
struct ImmersedSurface {
  std::string name;
  std::vector<SurfaceShape> shapes;
  Vec3 velocity;       ///< of the surface in its own plane, like a belt [m/s]
  Vec3 spin;           ///< angular velocity of the surface [rad/s] ...
  Vec3 through;        ///< ... about an axis through this point [m]
  bool sticks = true;  ///< the gas sticks to it; else it slips along without shear

  /// Velocity of the surface's material at a point where it has the (unit) normal n, without the part through itself.
  Vec3 velocity_at(const Vec3& point, const Vec3& n) const {
    const Vec3 v = velocity + cross(spin, point - through);
    return v - dot(v, n) * n;
  }
};

/// The lines along one axis that run through a lattice of points: coordinates on the two other axes.
struct LineLattice {
  int axis = 0;
  std::array<int, 2> across{1, 2};        ///< the two other axes, the faster-running first
  std::array<std::vector<Real>, 2> at{};  ///< coordinates on these, increasing [m]
};

/// Calls found(a, b, position, normal) for every point where the line through at[0][a], at[1][b] crosses a shape;
/// `position` along the axis [m], `normal` a unit vector of either sense. Where two triangles meet, both may report.
using CrossingFound = std::function<void(std::size_t a, std::size_t b, Real position, const Vec3& normal)>;
void find_crossings(const SurfaceShape& shape, const LineLattice& lines, const CrossingFound& found);

}  // namespace pellicle::cfd
