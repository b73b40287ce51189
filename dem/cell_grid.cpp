#include "dem/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pellicle::dem {
namespace {

struct Measure {
  Index count[most_levels];
  Real largest_reach[most_levels];
  Real min[3], max[3];
};

/// Counts and extremes: the same whatever the order.
struct MeasureKernel {
  using value_type = Measure;

  CellGrid grid;
  DeviceArray<PositionRadius> place;
  DeviceArray<Displacement> displacement;

  KOKKOS_INLINE_FUNCTION void init(Measure& m) const {
    for (int l = 0; l < most_levels; ++l) {
      m.count[l] = 0;
      m.largest_reach[l] = 0;
    }
    for (int axis = 0; axis < 3; ++axis) {
      m.min[axis] = Kokkos::Experimental::infinity_v<Real>;
      m.max[axis] = -Kokkos::Experimental::infinity_v<Real>;
    }
  }
  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Measure& m) const {
    const PositionRadius at = place(p);
    const int l = grid.level_of(at.radius);
    ++m.count[l];
    m.largest_reach[l] = larger(m.largest_reach[l], reach_of(at, displacement(p), grid.beyond));
    for (int axis = 0; axis < 3; ++axis) {
      const Real x = at.position()[axis];
      m.min[axis] = x < m.min[axis] ? x : m.min[axis];  // not a number counts as nowhere
      m.max[axis] = larger(m.max[axis], x);
    }
  }
  KOKKOS_INLINE_FUNCTION void join(Measure& m, const Measure& other) const {
    for (int l = 0; l < most_levels; ++l) {
      m.count[l] += other.count[l];
      m.largest_reach[l] = larger(m.largest_reach[l], other.largest_reach[l]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      m.min[axis] = other.min[axis] < m.min[axis] ? other.min[axis] : m.min[axis];
      m.max[axis] = larger(m.max[axis], other.max[axis]);
    }
  }
  KOKKOS_INLINE_FUNCTION static Real larger(Real a, Real b) { return b > a ? b : a; }
};

void count_per_cell(const CellGrid& grid, const Particles& particles,
                    const DeviceArray<std::int32_t>& cell_start) {
  const auto place = particles.position_radius;
  Kokkos::parallel_for(
      "dem::cell_grid::count_per_cell", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index p) {
        // Integer counts do not depend on the order of the additions.
        Kokkos::atomic_inc(&cell_start(grid.cell_of(place(p)) + 1));
      });
}

/// Counts in entries 1 … cells become the slots at which cells begin, one entry late.
void scan_cells(const DeviceArray<std::int32_t>& cell_start, Index cells) {
  Kokkos::parallel_scan(
      "dem::cell_grid::scan_cells", DeviceRange(0, cells),
      KOKKOS_LAMBDA(const Index cell, std::int32_t& sum, const bool final) {
        const std::int32_t count = cell_start(cell + 1);
        if (final) cell_start(cell + 1) = sum;
        sum += count;
      });
}

/// Entry c + 1 runs from the begin of cell c to its end, which is where the next cell begins.
void scatter_to_cells(const CellGrid& grid, const Particles& particles,
                      const DeviceArray<std::int32_t>& cell_start, const DeviceArray<std::int32_t>& order) {
  const auto place = particles.position_radius;
  Kokkos::parallel_for(
      "dem::cell_grid::scatter_to_cells", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index p) {
        order(Kokkos::atomic_fetch_add(&cell_start(grid.cell_of(place(p)) + 1), 1)) = p;
      });
}

/// The scatter leaves each cell in the order threads came by; sorting by id makes it the same every time.
void sort_cells_by_id(const Particles& particles, Index cells, const DeviceArray<std::int32_t>& cell_start,
                      const DeviceArray<std::int32_t>& order) {
  const auto motion = particles.velocity_spin;
  Kokkos::parallel_for(
      "dem::cell_grid::sort_cells_by_id", DeviceRange(0, cells), KOKKOS_LAMBDA(const Index cell) {
        for (std::int32_t a = cell_start(cell) + 1; a < cell_start(cell + 1); ++a) {
          const std::int32_t particle = order(a);
          const std::int32_t id = motion(particle).id;
          std::int32_t b = a;
          for (; b > cell_start(cell) && motion(order(b - 1)).id > id; --b) order(b) = order(b - 1);
          order(b) = particle;
        }
      });
}

}  // namespace

void set_levels(CellGrid& grid, Real smallest_radius, Real largest_radius) {
  grid.levels = 1;
  grid.level[0].largest_radius = largest_radius;
  // Within a factor of two one level does: its few larger cells cost less than looking twice.
  Real radius = largest_radius / 2;
  while (radius > smallest_radius && grid.levels < most_levels) {
    grid.level[grid.levels++].largest_radius = radius;
    radius /= 2;
  }
}

void measure_levels(CellGrid& grid, const Particles& particles,
                    const DeviceArray<Displacement>& displacement) {
  Measure m;
  Kokkos::parallel_reduce("dem::cell_grid::measure_levels", DeviceRange(0, particles.count),
                          MeasureKernel{grid, particles.position_radius, displacement}, m);
  for (int l = 0; l < grid.levels; ++l) {
    grid.level[l].count = m.count[l];
    grid.level[l].largest_reach = m.largest_reach[l];
  }
  grid.box = grid.domain.box;
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.domain.periodic[axis] != 0 || !(m.min[axis] <= m.max[axis])) continue;
    grid.box.min[axis] = m.min[axis];
    grid.box.max[axis] = m.max[axis];
  }
}

Index most_cells(Index particles) { return 256 + 2 * particles; }

void set_cells(CellGrid& grid) {
  const Vec3 length = grid.box.max - grid.box.min;
  Index first_cell = 0;
  for (int i = 0; i < grid.levels; ++i) {
    CellLevel& level = grid.level[i];
    level.first_cell = first_cell;
    level.cells = Index3{0, 0, 0};
    if (level.count == 0) continue;
    const auto total = [&level] { return static_cast<Real>(level.cells.x) * level.cells.y * level.cells.z; };
    for (int axis = 0; axis < 3; ++axis) {
      // Negated so that a reach that is not a number gives one cell.
      const Real cells = length[axis] / (2 * level.largest_reach);
      level.cells[axis] = !(cells > 1) ? 1 : static_cast<Index>(std::min(cells, 1e6));
    }
    const auto most = static_cast<Real>(most_cells(level.count));
    while (total() > most) {
      const Real factor = std::min(0.9, std::cbrt(most / total()));
      for (int axis = 0; axis < 3; ++axis)
        level.cells[axis] = std::max(1, static_cast<Index>(factor * level.cells[axis]));
    }
    for (int axis = 0; axis < 3; ++axis) {
      level.cell_size[axis] = length[axis] / level.cells[axis];
      level.inverse_cell_size[axis] =
          length[axis] > 0 ? static_cast<Real>(level.cells[axis]) / length[axis] : 0;
    }
    first_cell += level.cells.x * level.cells.y * level.cells.z;
  }
}

void sort_into_cells(const CellGrid& grid, const Particles& particles,
                     const DeviceArray<std::int32_t>& cell_start, const DeviceArray<std::int32_t>& order) {
  const Index cells = grid.cell_count();
  Kokkos::deep_copy(Kokkos::subview(cell_start, std::pair<Index, Index>(0, cells + 1)), 0);
  count_per_cell(grid, particles, cell_start);
  scan_cells(cell_start, cells);
  scatter_to_cells(grid, particles, cell_start, order);
  sort_cells_by_id(particles, cells, cell_start, order);
}

}  // namespace pellicle::dem
