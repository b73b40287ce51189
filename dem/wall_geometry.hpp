// All walls of a run as kernels see them: primitives one by one, triangles through a grid of cells.
#pragma once

#include <vector>

#include "core/cartesian_grid.hpp"
#include "core/views.hpp"
#include "dem/walls.hpp"

namespace pellicle::dem {

/// One primitive: a plane, a revolved segment, or a box.
struct WallSurface {
  enum class Kind : std::int32_t { plane, revolved, box };
  Kind kind;
  std::int32_t wall;    ///< the named wall it belongs to
  Vec3 a, b;            ///< plane: normal; revolved: origin, axis; box: min, max
  Real r0, z0, r1, z1;  ///< revolved: its segment; plane: r0 is the offset

  KOKKOS_INLINE_FUNCTION ClosestPoint closest(const Vec3& c) const {
    if (kind == Kind::plane) return PlaneShape{a, r0}.closest(c);
    if (kind == Kind::revolved) return RevolvedShape{a, b, r0, z0, r1, z1}.closest(c);
    return BoxShape{a, b}.closest(c);
  }
};

/// A named wall but for its shapes.
struct WallBody {
  WallMotion motion;
  Vec3 torque_about;
  std::int32_t material;
  bool turning;    ///< its shapes turn with its spin
  Real allowance;  ///< how far it may move before the list of near particles must be made anew [m]
};

/// The cells of a mesh, in the frame of its wall; cell c holds cell_triangle(cell_start(c) … cell_start(c + 1)): the
/// triangles whose bounding box meets it.
struct MeshGrid {
  Vec3 min;
  Vec3 max;  ///< bounds of the mesh [m]
  Vec3 inverse_cell_size;
  Index3 cells;
  std::int32_t first_cell;  ///< in cell_start
  std::int32_t wall;

  KOKKOS_INLINE_FUNCTION Index coordinate(int axis, Real x) const {
    const Real share = (x - min[axis]) * inverse_cell_size[axis];
    if (!(share > 0)) return 0;
    return share < cells[axis] ? static_cast<Index>(share) : cells[axis] - 1;
  }
};

/// Surfaces are numbered: primitives first, then triangles. In the memory of the execution space `Space`.
template <class Space>
struct BasicWallGeometry {
  template <class T>
  using Array = Kokkos::View<T*, Space>;

  Index primitives = 0;
  Array<WallSurface> surface;
  Array<WallBody> body;
  Array<WallPose> pose;  ///< of every body, at the present moment
  Array<TriangleShape> triangle;
  Array<std::int32_t> triangle_wall;
  Array<MeshGrid> grid;
  Array<std::int32_t> cell_start;
  Array<std::int32_t> cell_triangle;

  KOKKOS_INLINE_FUNCTION std::int32_t wall_of(Index s) const {
    return s < primitives ? surface(s).wall : triangle_wall(s - primitives);
  }
  /// Closest point of surface s, in the frame of its wall.
  KOKKOS_INLINE_FUNCTION ClosestPoint closest_in_wall(Index s, const Vec3& c) const {
    return s < primitives ? surface(s).closest(c) : triangle(s - primitives).closest(c);
  }
  /// Closest point of surface s to a point of the world.
  KOKKOS_INLINE_FUNCTION ClosestPoint closest(Index s, const Vec3& c) const {
    const WallPose& at = pose(wall_of(s));
    ClosestPoint e = closest_in_wall(s, at.to_wall(c));
    e.point = at.to_world(e.point);
    e.towards = at.to_world_direction(e.towards);
    return e;
  }
};

using WallGeometry = BasicWallGeometry<Device>;

/// Copies walls to the device; bodies rest, with no allowance. Throws std::invalid_argument where there are more triangles
/// than can be numbered.
WallGeometry make_wall_geometry(const std::vector<Wall>& walls);

/// The same in host memory.
BasicWallGeometry<Host> make_host_wall_geometry(const std::vector<Wall>& walls);

/// Brings all poses to `time` seconds after walls began to move; negative: before that.
void update_poses(const WallGeometry& geometry, Real time);

/// Calls `visit(s)` for every triangle of a mesh whose distance from the point c of the wall's frame is below `reach`,
/// each once, until it returns true; says whether it did.
template <class Space, class Visit>
KOKKOS_INLINE_FUNCTION bool visit_triangles(const BasicWallGeometry<Space>& geometry, const MeshGrid& grid,
                                            const Vec3& c, Real reach, const Visit& visit) {
  Index3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(c[axis] + reach >= grid.min[axis] && c[axis] - reach <= grid.max[axis])) return false;
    low[axis] = grid.coordinate(axis, c[axis] - reach);
    high[axis] = grid.coordinate(axis, c[axis] + reach);
  }
  for (Index k = low.z; k <= high.z; ++k) {
    for (Index j = low.y; j <= high.y; ++j) {
      for (Index i = low.x; i <= high.x; ++i) {
        const Index cell = grid.first_cell + i + grid.cells.x * (j + grid.cells.y * k);
        const std::int32_t end = geometry.cell_start(cell + 1);
        for (std::int32_t entry = geometry.cell_start(cell); entry < end; ++entry) {
          const std::int32_t t = geometry.cell_triangle(entry);
          const TriangleShape& shape = geometry.triangle(t);
          // A triangle may be in several of these cells: it counts in the first of them alone.
          const auto first = [&](int axis, Index lowest) {
            const Real least = Kokkos::min(shape.a[axis], Kokkos::min(shape.b[axis], shape.c[axis]));
            return Kokkos::max(lowest, grid.coordinate(axis, least));
          };
          if (first(0, low.x) != i || first(1, low.y) != j || first(2, low.z) != k) continue;
          if (shape.closest(c).distance < reach && visit(geometry.primitives + t)) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace pellicle::dem
