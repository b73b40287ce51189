// Cells to look for neighbours in: one uniform grid a size class of particles, finer for smaller ones.
#pragma once

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/particles.hpp"

namespace pellicle::dem {

/// The box particles live in, and the axes along which it repeats.
struct Domain {
  Box box;
  Index3 periodic{0, 0, 0};  ///< 1 along a periodic axis
  Index3 open_min{0, 0, 0};  ///< 1 where particles may leave through the lower side of an axis
  Index3 open_max{0, 0, 0};  ///< 1 where particles may leave through the upper side of an axis

  KOKKOS_INLINE_FUNCTION Vec3 length() const { return box.max - box.min; }
  KOKKOS_INLINE_FUNCTION bool repeats() const { return periodic.x + periodic.y + periodic.z != 0; }
  /// Shortest image of a separation; plain separation along axes that do not repeat.
  KOKKOS_INLINE_FUNCTION Vec3 shortest(Vec3 d) const {
    const Vec3 l = length();
    for (int axis = 0; axis < 3; ++axis) {
      if (periodic[axis] == 0) continue;
      if (d[axis] > 0.5 * l[axis]) d[axis] -= l[axis];
      if (d[axis] < -0.5 * l[axis]) d[axis] += l[axis];
    }
    return d;
  }
};

/// How a particle has moved since the lists were built, a quarter of a cache line.
struct alignas(16) Displacement {
  float x, y, z;    ///< sum of the steps [m]
  float allowance;  ///< how far it may be from where it was at the build [m]

  /// Whether so much is spent that the lists may miss a contact. Summing in single precision loses at most 6e-8 of the
  /// allowance a step, 0.0012 of it over `most_steps`: less than the 0.002 held back. Not a number counts as spent.
  KOKKOS_INLINE_FUNCTION bool spent() const {
    return !(x * x + y * y + z * z <= 0.996F * allowance * allowance);
  }
  /// Steps after which lists are rebuilt whoever moved.
  static constexpr std::int64_t most_steps = 20000;
};

/// How far from its centre a particle may be felt before the next build [m]: its surface, and `beyond` that its share of
/// the gap at which two still feel each other.
KOKKOS_INLINE_FUNCTION Real reach_of(const PositionRadius& place, const Displacement& displacement,
                                     Real beyond = 0) {
  return place.radius + static_cast<Real>(displacement.allowance) + beyond;
}

/// Size classes at most: the finest holds all that is smaller than 1/128 of the largest radius.
inline constexpr int most_levels = 8;

/// The cells of one size class.
struct CellLevel {
  Real largest_radius = 0;  ///< particles of this radius and less, down to that of the next level [m]
  Real largest_reach = 0;   ///< the largest reach_of among its particles [m]
  Index count = 0;          ///< its particles
  Index first_cell = 0;     ///< number of its first cell
  Index3 cells{0, 0, 0};
  Vec3 cell_size{}, inverse_cell_size{};  // [m], [1/m]
};

/// Cells of all levels, numbered level by level, x fastest. A particle is in the cell of its own level that holds its
/// centre; points outside the box belong to the cells at its rim.
struct CellGrid {
  Domain domain;
  Box box;          ///< around all centres; the domain's along periodic axes
  Real beyond = 0;  ///< see reach_of [m]
  int levels = 1;
  CellLevel level[most_levels];

  KOKKOS_INLINE_FUNCTION int level_of(Real radius) const {
    int l = 0;
    while (l + 1 < levels && radius <= level[l + 1].largest_radius) ++l;
    return l;
  }
  /// Cell along an axis before it is limited to the box; not a number counts as 0.
  KOKKOS_INLINE_FUNCTION Index coordinate(const CellLevel& l, int axis, Real x) const {
    const Real i = Kokkos::floor((x - box.min[axis]) * l.inverse_cell_size[axis]);
    constexpr Real far = 1 << 30;
    return i > -far ? (i < far ? static_cast<Index>(i) : (1 << 30)) : (i <= -far ? -(1 << 30) : 0);
  }
  KOKKOS_INLINE_FUNCTION static Index limited(Index i, Index cells) {
    return i < 0 ? 0 : (i >= cells ? cells - 1 : i);
  }
  KOKKOS_INLINE_FUNCTION Index cell_of(const PositionRadius& p) const {
    const CellLevel& l = level[level_of(p.radius)];
    const Index i = limited(coordinate(l, 0, p.x), l.cells.x);
    const Index j = limited(coordinate(l, 1, p.y), l.cells.y);
    const Index k = limited(coordinate(l, 2, p.z), l.cells.z);
    return l.first_cell + i + l.cells.x * (j + l.cells.y * k);
  }
  Index cell_count() const {
    const CellLevel& last = level[levels - 1];
    return last.first_cell + last.cells.x * last.cells.y * last.cells.z;
  }
};

/// Cells first … last along an axis, to be wrapped where the axis repeats.
struct CellSpan {
  Index first, last;
};

/// The cells of an axis between two places in units of cells from the lower end of the box; all of a periodic axis once
/// at most.
template <bool Repeats>
KOKKOS_INLINE_FUNCTION CellSpan find_span(bool periodic, Index cells, Real from, Real to) {
  if (Repeats && periodic) {
    const auto first = static_cast<Index>(Kokkos::floor(from == from ? from : 0));
    const auto last = static_cast<Index>(Kokkos::floor(to == to ? to : 0));
    return last - first + 1 < cells ? CellSpan{first, last} : CellSpan{0, cells - 1};
  }
  const auto end = static_cast<Real>(cells - 1);
  from = from > 0 ? from : 0;  // so is what is not a number
  to = to > 0 ? to : 0;
  return {static_cast<Index>(from < end ? from : end), static_cast<Index>(to < end ? to : end)};
}

/// Square of the distance [m²] between a place, in units of cells, and cell i of an axis; 0 where all of a periodic axis
/// is looked at.
template <bool Repeats>
KOKKOS_INLINE_FUNCTION Real distance_squared(bool whole, Real place, Index i, Real cell_size) {
  if (Repeats && whole) return 0;
  const Real before = static_cast<Real>(i) - place;
  const Real after = -1 - before;
  const Real d = cell_size * Kokkos::max(Kokkos::max(before, after), 0.0);
  return d * d;
}

/// Calls scan(begin, end) for the runs of sorted slots that may hold a neighbour of `self` (its radius is its reach),
/// level by level, always in the same order. `Repeats`: some axis may.
template <bool Repeats, class Scan>
KOKKOS_INLINE_FUNCTION void visit_runs(const CellGrid& grid, const DeviceArray<std::int32_t>& cell_start,
                                       const PositionRadius& self, const Scan& scan) {
  const auto wrapped = [](Index c, Index cells) {
    return !Repeats ? c : c < 0 ? c + cells : (c >= cells ? c - cells : c);
  };
  const Index3& periodic = grid.domain.periodic;
  const std::int32_t* const start = cell_start.data();
  for (int level = 0; level < grid.levels; ++level) {
    const CellLevel& l = grid.level[level];
    if (l.count == 0) continue;
    // A little more than is needed, so that no rounding below loses a cell.
    const Real range = (1 + 1e-9) * (self.radius + l.largest_reach);
    const Vec3 at{(self.x - grid.box.min.x) * l.inverse_cell_size.x,
                  (self.y - grid.box.min.y) * l.inverse_cell_size.y,
                  (self.z - grid.box.min.z) * l.inverse_cell_size.z};
    const Real y_range = range * l.inverse_cell_size.y;
    const Real z_range = range * l.inverse_cell_size.z;
    const CellSpan ys = find_span<Repeats>(periodic.y != 0, l.cells.y, at.y - y_range, at.y + y_range);
    const CellSpan zs = find_span<Repeats>(periodic.z != 0, l.cells.z, at.z - z_range, at.z + z_range);
    const bool all_y = ys.last - ys.first + 1 >= l.cells.y;
    const bool all_z = zs.last - zs.first + 1 >= l.cells.z;
    const Index n = l.cells.x;
    for (Index k = zs.first; k <= zs.last; ++k) {
      const Real left = range * range - distance_squared<Repeats>(all_z, at.z, k, l.cell_size.z);
      for (Index j = ys.first; j <= ys.last; ++j) {
        // The part of this row of cells that a sphere of that range reaches.
        const Real half_squared = left - distance_squared<Repeats>(all_y, at.y, j, l.cell_size.y);
        if (half_squared < 0) continue;
        const Real half = Kokkos::sqrt(half_squared) * l.inverse_cell_size.x;
        const CellSpan xs = find_span<Repeats>(periodic.x != 0, n, at.x - half, at.x + half);
        const Index row = l.first_cell + n * (wrapped(j, l.cells.y) + l.cells.y * wrapped(k, l.cells.z));
        // Cells of a row lie side by side in the sorted order: one run, or two where it crosses a periodic side.
        if (Repeats && xs.first < 0) {
          scan(start[row + xs.first + n], start[row + n]);
          scan(start[row], start[row + xs.last + 1]);
        } else if (Repeats && xs.last >= n) {
          scan(start[row + xs.first], start[row + n]);
          scan(start[row], start[row + xs.last - n + 1]);
        } else {
          scan(start[row + xs.first], start[row + xs.last + 1]);
        }
      }
    }
  }
}

/// Sets the levels of a grid for radii between these [m].
void set_levels(CellGrid& grid, Real smallest_radius, Real largest_radius);

/// Counts the particles of every level, and finds their largest reach and the box. `reach` of particle p is its radius +
/// list.displacement(p).allowance.
void measure_levels(CellGrid& grid, const Particles& particles,
                    const DeviceArray<Displacement>& displacement);

/// Cells that a level of so many particles has at most.
Index most_cells(Index particles);

/// Sets the cells of every level that has particles: as wide as two of its particles reach, wider where there are few
/// particles in a large domain, so that cells never cost more than particles do.
void set_cells(CellGrid& grid);

/// Sorts particles by cell, then by id: order(slot) is the particle in a slot, those of cell c are in slots
/// cell_start(c) … cell_start(c + 1). cell_start has an entry more than there are cells.
void sort_into_cells(const CellGrid& grid, const Particles& particles,
                     const DeviceArray<std::int32_t>& cell_start, const DeviceArray<std::int32_t>& order);

}  // namespace pellicle::dem
