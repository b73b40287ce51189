// What walls leave of the gas grid's cells, as the particles' kernels see it: nothing is put or looked up beyond a wall.
#pragma once

#include <cstdint>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"
#include "coupling/grid_locator.hpp"

namespace pellicle::cfd {
struct FlowGeometry;
}

namespace pellicle::coupling {

/// A surface thinner than a cell as one of its cells sees it; a plane.
struct ThinWall {
  Vec3 point;    ///< [m]
  Vec3 normal;   ///< towards the cell's centre
  Index beyond;  ///< the cell on the other side
};

/// Cells cut by walls, on the device. Without walls its arrays are empty. Sides are numbered x-, x+, y-, y+, z-, z+.
struct CutGrid {
  DeviceArray<Real> volume;              ///< open volume of a cell [m3]; 0 where no gas is
  DeviceArray<std::uint8_t> open_sides;  ///< bit s: side s of a cell is open towards another cell
  DeviceArray<Index> nearest_open;       ///< the cell itself if it holds gas, else the nearest one that does
  DeviceArray<Index> walls_begin;        ///< of the thin walls of a cell, cells + 1
  DeviceArray<ThinWall> walls;

  KOKKOS_INLINE_FUNCTION bool is_cut() const { return volume.extent(0) > 0; }
  KOKKOS_INLINE_FUNCTION bool is_open(Index cell, int side) const {
    return ((open_sides(cell) >> side) & 1) != 0;
  }
  /// The cell that a particle is in whose centre [m] lies in `cell`: on its own side of thin walls, and with gas.
  KOKKOS_INLINE_FUNCTION Index home(Index cell, const Vec3& centre) const {
    Index found = cell;
    for (Index w = walls_begin(cell); w < walls_begin(cell + 1); ++w) {
      const ThinWall wall = walls(w);
      if (dot(centre - wall.point, wall.normal) < 0) {
        found = wall.beyond;
        break;
      }
    }
    return nearest_open(found);
  }
  /// Whether steps from cell to cell lead from one to the other without crossing a closed side: first along x, then y,
  /// then z, or the other way round. Along a periodic axis the shorter way is taken.
  KOKKOS_INLINE_FUNCTION bool joined(const GridLocator& grid, const Index3& from, const Index3& to) const {
    Index3 at = from;
    if (step_along(grid, 0, to.x, at) && step_along(grid, 1, to.y, at) && step_along(grid, 2, to.z, at)) {
      return true;
    }
    at = from;
    return step_along(grid, 2, to.z, at) && step_along(grid, 1, to.y, at) && step_along(grid, 0, to.x, at);
  }

 private:
  KOKKOS_INLINE_FUNCTION bool step_along(const GridLocator& grid, int axis, Index target, Index3& at) const {
    const AxisLocator& along = axis == 0 ? grid.x : (axis == 1 ? grid.y : grid.z);
    Index steps = target - at[axis];
    if (along.periodic && 2 * steps > along.cells) steps -= along.cells;
    if (along.periodic && 2 * steps < -along.cells) steps += along.cells;
    const int side = 2 * axis + (steps > 0 ? 1 : 0);
    for (; steps != 0; steps += steps > 0 ? -1 : 1) {
      if (!is_open(grid.index(at.x, at.y, at.z), side)) return false;
      at[axis] += steps > 0 ? 1 : -1;
      if (at[axis] < 0) at[axis] = along.cells - 1;
      if (at[axis] == along.cells) at[axis] = 0;
    }
    return true;
  }
};

/// The gas grid's cells as walls cut them; empty if they do not.
CutGrid make_cut_grid(const cfd::FlowGeometry& geometry);

}  // namespace pellicle::coupling
