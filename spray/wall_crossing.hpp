// Where a straight path first crosses a wall: exact for every shape, for walls at rest and moving ones. A path that ends
// on a surface crosses it, one that begins there does not; so of two paths of which one goes on where the other ends,
// one crosses what both together do. Thin shapes are crossed from both sides; a path that begins inside a solid one is
// stopped at once.
#pragma once

#include <Kokkos_Core.hpp>

#include "dem/wall_geometry.hpp"
#include "spray/swept_capture_laws.hpp"

namespace pellicle::spray {

/// Share of a path below which a root of one that begins on a surface is that beginning, moved by rounding.
inline constexpr Real on_surface_share = 1e-9;

/// Where a path changes sides of something: `from` and `to` tell on which side its ends are, and how far.
KOKKOS_INLINE_FUNCTION bool changes_sides(Real from, Real to) {
  return (from > 0 && to <= 0) || (from < 0 && to >= 0);
}

/// Share (0 … 1) of the path from one point to another [m] at which it first crosses a shape, or `never`.
KOKKOS_INLINE_FUNCTION Real first_crossing(const dem::PlaneShape& plane, const Vec3& from, const Vec3& to) {
  const Real before = dot(plane.normal, from) - plane.offset;
  const Real after = dot(plane.normal, to) - plane.offset;
  if (after > 0 || after >= before) return never;  // in front of it, or on its way out
  return before > 0 ? before / (before - after) : Real(0);
}

KOKKOS_INLINE_FUNCTION Real first_crossing(const dem::BoxShape& box, const Vec3& from, const Vec3& to) {
  Real enter = 0;
  Real leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const Real step = to[axis] - from[axis];
    if (step == 0) {
      if (!(from[axis] > box.min[axis] && from[axis] < box.max[axis])) return never;
      continue;
    }
    const Real low = (box.min[axis] - from[axis]) / step;
    const Real high = (box.max[axis] - from[axis]) / step;
    enter = Kokkos::max(enter, Kokkos::min(low, high));
    leave = Kokkos::min(leave, Kokkos::max(low, high));
  }
  // One that ends on a face enters at 1; one that begins on a face and moves out leaves at 0.
  return enter <= leave && leave > 0 ? enter : never;
}

/// A point as seen along a path: sheared so that the path goes along one axis, the coordinates on the other two.
struct SeenAlong {
  Real x, y;
  KOKKOS_INLINE_FUNCTION SeenAlong(const Vec3& place, const Vec3& path, int axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    x = place[u] - path[u] / path[axis] * place[axis];
    y = place[v] - path[v] / path[axis] * place[axis];
  }
};

/// Woop, Benthin & Wald (2013), J. Comput. Graph. Tech. 2(1), 65: what triangles share, corners and edges, is tested with
/// the same numbers (edges but for the sign, -ffp-contract=off), so that no path slips through between them.
KOKKOS_INLINE_FUNCTION Real first_crossing(const dem::TriangleShape& triangle, const Vec3& from,
                                           const Vec3& to) {
  const Vec3 normal = cross(triangle.b - triangle.a, triangle.c - triangle.a);
  const Real before = dot(normal, from - triangle.a);
  const Real after = dot(normal, to - triangle.a);
  if (!changes_sides(before, after)) return never;
  const Vec3 path = to - from;
  int axis = Kokkos::abs(path.x) > Kokkos::abs(path.y) ? 0 : 1;
  if (Kokkos::abs(path.z) > Kokkos::abs(path[axis])) axis = 2;
  const SeenAlong a(triangle.a - from, path, axis);
  const SeenAlong b(triangle.b - from, path, axis);
  const SeenAlong c(triangle.c - from, path, axis);
  const Real ab = a.x * b.y - a.y * b.x;
  const Real bc = b.x * c.y - b.y * c.x;
  const Real ca = c.x * a.y - c.y * a.x;
  const bool inside = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
  return inside ? before / (before - after) : never;
}

/// The quadratic equation in the share s of the path on the cone that the segment turned for ever makes; on a disc or
/// an annulus, its plane.
KOKKOS_INLINE_FUNCTION Real first_crossing(const dem::RevolvedShape& shape, const Vec3& from,
                                           const Vec3& to) {
  const Vec3 p = from - shape.origin;
  const Vec3 path = to - from;
  const Real z = dot(p, shape.axis);
  const Real dz = dot(path, shape.axis);
  const Vec3 across = p - z * shape.axis;
  const Vec3 across_path = path - dz * shape.axis;
  const Real height = shape.z1 - shape.z0;
  // Shapes that meet at a ring are a little longer than they are, so that rounding leaves no gap.
  const Real slack = dem::rim_share * (Kokkos::abs(height) + Kokkos::abs(shape.r1 - shape.r0));
  // The far end on its own, by the same formula as the beginning of the next path.
  const Vec3 q = to - shape.origin;
  const Real z_end = dot(q, shape.axis);
  if (height == 0) {
    const Real before = z - shape.z0;
    const Real after = z_end - shape.z0;
    if (!changes_sides(before, after)) return never;
    const Real share = before / (before - after);
    const Vec3 at = across + share * across_path;
    const Real r = Kokkos::sqrt(norm_squared(at));
    const Real low = Kokkos::min(shape.r0, shape.r1);
    const Real high = Kokkos::max(shape.r0, shape.r1);
    return r >= low - slack && r <= high + slack ? share : never;
  }
  const Real slope = (shape.r1 - shape.r0) / height;
  const Real radius = shape.r0 + slope * (z - shape.z0);
  const Vec3 across_end = q - z_end * shape.axis;
  const Real radius_end = shape.r0 + slope * (z_end - shape.z0);
  // Outside (> 0) or inside of the cone; a quadratic function of the share, c + 2 b s + a s².
  const Real before = norm_squared(across) - radius * radius;
  const Real after = norm_squared(across_end) - radius_end * radius_end;
  const Real a = norm_squared(across_path) - slope * slope * dz * dz;
  const Real b = dot(across, across_path) - slope * radius * dz;
  const bool changes = changes_sides(before, after);
  Real discriminant = b * b - a * before;
  if (discriminant < 0) {
    if (!changes) return never;
    discriminant = 0;  // by rounding
  }
  const Real half = b > 0 ? -b - Kokkos::sqrt(discriminant) : -b + Kokkos::sqrt(discriminant);
  Real roots[2] = {half != 0 ? before / half : Real(0), a != 0 ? half / a : never};
  if (roots[1] < roots[0]) {
    const Real later = roots[0];
    roots[0] = roots[1];
    roots[1] = later;
  }
  const auto meets = [&](Real share) {
    const Real at = z + share * dz;
    const Real low = Kokkos::min(shape.z0, shape.z1);
    const Real high = Kokkos::max(shape.z0, shape.z1);
    return at >= low - slack && at <= high + slack;
  };
  if (changes) {
    // One root, or one of the two, is on the path: rounding may have put it a little beyond an end.
    const auto beyond = [](Real share) { return share < 0 ? -share : (share > 1 ? share - 1 : Real(0)); };
    const Real root = beyond(roots[0]) <= beyond(roots[1]) ? roots[0] : roots[1];
    const Real share = root < 0 ? Real(0) : (root > 1 ? Real(1) : root);
    return meets(share) ? share : never;
  }
  for (const Real root : roots) {
    // Twice or not at all; the beginning itself does not count.
    if (root > (before == 0 ? on_surface_share : Real(0)) && root <= 1 && meets(root)) return root;
  }
  return never;
}

/// Walls as a path during a step sees them: where they are at its beginning and at its end.
struct MovingWalls {
  dem::WallGeometry geometry;              ///< its poses are those at the beginning
  DeviceArray<dem::WallPose> pose_at_end;  ///< of every body
};

/// Share (0 … 1) of the path at which it first crosses any wall, or `never`. Of a wall that moves, the path is straight in
/// the frame of the wall.
KOKKOS_INLINE_FUNCTION Real first_wall_crossing(const MovingWalls& walls, const Vec3& from, const Vec3& to) {
  const dem::WallGeometry& geometry = walls.geometry;
  Real first = never;
  for (Index s = 0; s < geometry.primitives; ++s) {
    const dem::WallSurface& surface = geometry.surface(s);
    const Vec3 start = geometry.pose(surface.wall).to_wall(from);
    const Vec3 end = walls.pose_at_end(surface.wall).to_wall(to);
    Real share = never;
    if (surface.kind == dem::WallSurface::Kind::plane) {
      share = first_crossing(dem::PlaneShape{surface.a, surface.r0}, start, end);
    } else if (surface.kind == dem::WallSurface::Kind::revolved) {
      share = first_crossing(
          dem::RevolvedShape{surface.a, surface.b, surface.r0, surface.z0, surface.r1, surface.z1}, start,
          end);
    } else {
      share = first_crossing(dem::BoxShape{surface.a, surface.b}, start, end);
    }
    first = Kokkos::min(first, share);
  }
  const auto grids = static_cast<Index>(geometry.grid.extent(0));
  for (Index g = 0; g < grids; ++g) {
    const dem::MeshGrid& grid = geometry.grid(g);
    const Vec3 start = geometry.pose(grid.wall).to_wall(from);
    const Vec3 end = walls.pose_at_end(grid.wall).to_wall(to);
    Index3 low, high;
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis) {
      const Real least = Kokkos::min(start[axis], end[axis]);
      const Real most = Kokkos::max(start[axis], end[axis]);
      apart = apart || !(most >= grid.min[axis] && least <= grid.max[axis]);
      low[axis] = grid.coordinate(axis, least);
      high[axis] = grid.coordinate(axis, most);
    }
    if (apart) continue;
    // All cells of the box around the path: it is no longer than a cell or two.
    for (Index k = low.z; k <= high.z; ++k) {
      for (Index j = low.y; j <= high.y; ++j) {
        for (Index i = low.x; i <= high.x; ++i) {
          const Index cell = grid.first_cell + i + grid.cells.x * (j + grid.cells.y * k);
          const std::int32_t last = geometry.cell_start(cell + 1);
          for (std::int32_t entry = geometry.cell_start(cell); entry < last; ++entry) {
            const dem::TriangleShape& triangle = geometry.triangle(geometry.cell_triangle(entry));
            first = Kokkos::min(first, first_crossing(triangle, start, end));
          }
        }
      }
    }
  }
  return first;
}

}  // namespace pellicle::spray
