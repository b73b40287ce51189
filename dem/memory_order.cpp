#include "dem/memory_order.hpp"

#include <algorithm>

#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

/// Cells along the edge of a cube.
constexpr Index edge = 8;

/// The bits of a cell's number within a cube that belong to an axis: every third.
KOKKOS_INLINE_FUNCTION Index along(int axis, Index number) {
  const Index bits = number >> axis;
  return (bits & 1) | ((bits >> 2) & 2) | ((bits >> 4) & 4);
}

/// The cubes of one level, numbered along the axis with the fewest first: layers of cubes, of which each needs the one
/// before, are then as small as can be and stay in the cache.
struct Cubes {
  CellLevel level;
  Index3 count;
  Index first;    ///< number of its first cube
  Index3 stride;  ///< between the numbers of neighbours along each axis

  Index last() const { return first + count.x * count.y * count.z; }

  /// Calls visit(cell) for the cells of a cube, in order.
  template <class Visit>
  KOKKOS_INLINE_FUNCTION void visit_cells(Index cube, const Visit& visit) const {
    const Index own = cube - first;
    const Index3 corner{edge * (own / stride.x % count.x), edge * (own / stride.y % count.y),
                        edge * (own / stride.z % count.z)};
    for (Index number = 0; number < edge * edge * edge; ++number) {
      const Index i = corner.x + along(0, number);
      const Index j = corner.y + along(1, number);
      const Index k = corner.z + along(2, number);
      if (i >= level.cells.x || j >= level.cells.y || k >= level.cells.z) continue;
      visit(level.first_cell + i + level.cells.x * (j + level.cells.y * k));
    }
  }
};

Cubes make_cubes(const CellLevel& level, Index first) {
  const auto cubes = [](Index cells) { return (cells + edge - 1) / edge; };
  const Index3 count{cubes(level.cells.x), cubes(level.cells.y), cubes(level.cells.z)};
  int axes[3] = {0, 1, 2};
  std::stable_sort(axes, axes + 3, [&](int a, int b) { return count[a] < count[b]; });
  Index3 stride{1, 1, 1};
  stride[axes[1]] = count[axes[0]];
  stride[axes[2]] = count[axes[0]] * count[axes[1]];
  return {level, count, first, stride};
}

void count_particles(const Cubes& cubes, const DeviceArray<std::int32_t>& cell_start,
                     const DeviceArray<std::int32_t>& cube_start) {
  Kokkos::parallel_for(
      "dem::memory_order::count", DeviceRange(cubes.first, cubes.last()), KOKKOS_LAMBDA(const Index cube) {
        std::int32_t particles = 0;
        cubes.visit_cells(cube, [&](Index cell) { particles += cell_start(cell + 1) - cell_start(cell); });
        cube_start(cube) = particles;
      });
}

void scan_cubes(const DeviceArray<std::int32_t>& cube_start, Index cubes) {
  Kokkos::parallel_scan(
      "dem::memory_order::scan", DeviceRange(0, cubes),
      KOKKOS_LAMBDA(const Index cube, std::int32_t& sum, const bool final) {
        const std::int32_t particles = cube_start(cube);
        if (final) cube_start(cube) = sum;
        sum += particles;
      });
}

void fill_order(const Cubes& cubes, const DeviceArray<std::int32_t>& cell_start,
                const DeviceArray<std::int32_t>& order, const DeviceArray<std::int32_t>& cube_start,
                const DeviceArray<std::int32_t>& memory_order) {
  Kokkos::parallel_for(
      "dem::memory_order::fill", DeviceRange(cubes.first, cubes.last()), KOKKOS_LAMBDA(const Index cube) {
        std::int32_t place = cube_start(cube);
        cubes.visit_cells(cube, [&](Index cell) {
          for (std::int32_t slot = cell_start(cell); slot < cell_start(cell + 1); ++slot) {
            memory_order(place++) = order(slot);
          }
        });
      });
}

}  // namespace

void find_memory_order(const CellGrid& grid, const DeviceArray<std::int32_t>& cell_start,
                       const DeviceArray<std::int32_t>& order, DeviceArray<std::int32_t>& cube_start,
                       const DeviceArray<std::int32_t>& memory_order) {
  Cubes cubes[most_levels];
  Index total = 0;
  for (int l = 0; l < grid.levels; ++l) {
    cubes[l] = make_cubes(grid.level[l], total);
    total = cubes[l].last();
  }
  ensure_size(cube_start, static_cast<std::size_t>(total), "dem::memory_order::cube_start");
  for (int l = 0; l < grid.levels; ++l) count_particles(cubes[l], cell_start, cube_start);
  scan_cubes(cube_start, total);
  for (int l = 0; l < grid.levels; ++l) fill_order(cubes[l], cell_start, order, cube_start, memory_order);
}

}  // namespace pellicle::dem
