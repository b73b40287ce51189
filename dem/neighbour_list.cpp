#include "dem/neighbour_list.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

struct CellGrid {
  Domain domain;
  Index3 cells;
  Vec3 inverse_cell_size;

  KOKKOS_INLINE_FUNCTION Index coordinate(int axis, Real x) const {
    const auto i = static_cast<Index>(Kokkos::floor((x - domain.box.min[axis]) * inverse_cell_size[axis]));
    return i < 0 ? 0 : (i >= cells[axis] ? cells[axis] - 1 : i);
  }
  KOKKOS_INLINE_FUNCTION Index cell(const PositionRadius& p) const {
    return coordinate(0, p.x) + cells.x * (coordinate(1, p.y) + cells.y * coordinate(2, p.z));
  }
};

void count_per_cell(const CellGrid& grid, const Particles& particles,
                    const DeviceArray<std::int32_t>& cell_of, const DeviceArray<std::int32_t>& cell_fill) {
  const auto place = particles.position_radius;
  Kokkos::parallel_for(
      "dem::neighbour_list::count_per_cell", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index p) {
        const Index cell = grid.cell(place(p));
        cell_of(p) = cell;
        // Integer counts do not depend on the order of the additions.
        Kokkos::atomic_inc(&cell_fill(cell));
      });
}

/// Exclusive prefix sum of count(0 … n), total in the last entry of offset.
void offsets_from_counts(const DeviceArray<std::int32_t>& count, const DeviceArray<std::int32_t>& offset,
                         Index n, const char* label) {
  Kokkos::parallel_scan(
      label, DeviceRange(0, n + 1), KOKKOS_LAMBDA(const Index i, std::int32_t& sum, const bool final) {
        if (final) offset(i) = sum;
        if (i < n) sum += count(i);
      });
}

void scatter_to_cells(const Particles& particles, const DeviceArray<std::int32_t>& cell_of,
                      const DeviceArray<std::int32_t>& cell_start, const DeviceArray<std::int32_t>& cell_fill,
                      const DeviceArray<std::int32_t>& order) {
  Kokkos::parallel_for(
      "dem::neighbour_list::scatter_to_cells", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index p) {
        const Index cell = cell_of(p);
        const std::int32_t place = cell_start(cell) + Kokkos::atomic_fetch_add(&cell_fill(cell), 1);
        order(place) = p;
      });
}

/// The scatter leaves each cell in the order threads came by; sorting by id makes it the same every time.
void sort_cells_by_id(const Particles& particles, Index cells, const DeviceArray<std::int32_t>& cell_start,
                      const DeviceArray<std::int32_t>& order) {
  const auto motion = particles.velocity_spin;
  Kokkos::parallel_for(
      "dem::neighbour_list::sort_cells_by_id", DeviceRange(0, cells), KOKKOS_LAMBDA(const Index cell) {
        for (std::int32_t a = cell_start(cell) + 1; a < cell_start(cell + 1); ++a) {
          const std::int32_t particle = order(a);
          const std::int32_t id = motion(particle).id;
          std::int32_t b = a;
          for (; b > cell_start(cell) && motion(order(b - 1)).id > id; --b) order(b) = order(b - 1);
          order(b) = particle;
        }
      });
}

struct AllowanceRule {
  Real reach_time;  ///< steps × time step [s]
  Real smallest, largest;

  KOKKOS_INLINE_FUNCTION Real operator()(const VelocitySpin& m) const {
    const Real travel = reach_time * Kokkos::sqrt(m.vx * m.vx + m.vy * m.vy + m.vz * m.vz);
    const Real allowance = travel > smallest ? travel : smallest;
    return allowance < largest ? allowance : largest;
  }
};

void gather_sorted(const Particles& particles, const AllowanceRule& rule,
                   const DeviceArray<std::int32_t>& order, const DeviceArray<PositionRadius>& sorted,
                   const NeighbourList& list) {
  const auto place = particles.position_radius;
  const auto motion = particles.velocity_spin;
  const auto built_at = list.built_at;
  const auto allowance_squared = list.allowance_squared;
  Kokkos::parallel_for(
      "dem::neighbour_list::gather_sorted", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index slot) {
        const Index p = order(slot);
        PositionRadius entry = place(p);
        const Real allowance = rule(motion(p));
        built_at(p) = entry.position();
        allowance_squared(p) = allowance * allowance;
        entry.radius += allowance;
        sorted(slot) = entry;
      });
}

/// Visits the runs of sorted slots that may hold a neighbour of the particle in `slot`, always in the same order.
template <class Scan>
KOKKOS_INLINE_FUNCTION void visit_runs(const CellGrid& grid, const DeviceArray<std::int32_t>& cell_start,
                                       const PositionRadius& self, const Scan& scan) {
  const Index3 n = grid.cells;
  const Index3 periodic = grid.domain.periodic;
  const Index ci = grid.coordinate(0, self.x);
  const Index cj = grid.coordinate(1, self.y);
  const Index ck = grid.coordinate(2, self.z);
  // Along a periodic axis of fewer than three cells the neighbours on both sides are the same cell: visit it once.
  const auto first = [](Index c, Index cells, Index repeats) {
    return repeats != 0 ? (cells >= 3 ? c - 1 : Index{0}) : (c > 0 ? c - 1 : c);
  };
  const auto last = [](Index c, Index cells, Index repeats) {
    return repeats != 0 ? (cells >= 3 ? c + 1 : cells - 1) : (c < cells - 1 ? c + 1 : c);
  };
  const auto wrapped = [](Index c, Index cells) { return c < 0 ? c + cells : (c >= cells ? c - cells : c); };
  for (Index k = first(ck, n.z, periodic.z); k <= last(ck, n.z, periodic.z); ++k) {
    for (Index j = first(cj, n.y, periodic.y); j <= last(cj, n.y, periodic.y); ++j) {
      const Index row = n.x * (wrapped(j, n.y) + n.y * wrapped(k, n.z));
      if (periodic.x == 0) {
        // Cells of a row lie side by side in the sorted order: one run instead of three.
        scan(cell_start(row + first(ci, n.x, 0)), cell_start(row + last(ci, n.x, 0) + 1));
      } else {
        for (Index i = first(ci, n.x, 1); i <= last(ci, n.x, 1); ++i) {
          const Index cell = row + wrapped(i, n.x);
          scan(cell_start(cell), cell_start(cell + 1));
        }
      }
    }
  }
}

/// Whether two entries of the sorted array may touch before the next build.
template <bool Repeats>
KOKKOS_INLINE_FUNCTION bool in_reach(const Domain& domain, const PositionRadius& a, const PositionRadius& b) {
  Vec3 d{b.x - a.x, b.y - a.y, b.z - a.z};
  if constexpr (Repeats) d = domain.shortest(d);
  const Real reach = a.radius + b.radius;
  return norm_squared(d) < reach * reach;
}

template <bool Repeats>
struct CountPairs {
  CellGrid grid;
  DeviceArray<std::int32_t> cell_start, order;
  DeviceArray<PositionRadius> sorted;
  DeviceArray<std::int32_t> pair_count;

  KOKKOS_INLINE_FUNCTION void operator()(const Index slot) const {
    const PositionRadius self = sorted(slot);
    const PositionRadius* const place = sorted.data();
    const Domain& domain = grid.domain;
    std::int32_t pairs = -1;  // the particle itself is within its own reach
    visit_runs(grid, cell_start, self, [&](std::int32_t begin, std::int32_t end) {
      // No branch: the outcome cannot be predicted.
      for (std::int32_t o = begin; o < end; ++o) pairs += in_reach<Repeats>(domain, self, place[o]) ? 1 : 0;
    });
    const Index p = order(slot);
    pair_count(p) = pairs < 0 ? 0 : pairs;  // a particle that is nowhere (NaN) is not even near itself
  }
};

template <bool Repeats>
struct FillPairs {
  CellGrid grid;
  DeviceArray<std::int32_t> cell_start, order;
  DeviceArray<PositionRadius> sorted;
  NeighbourList list;

  KOKKOS_INLINE_FUNCTION void operator()(const Index slot) const {
    const PositionRadius self = sorted(slot);
    const PositionRadius* const place = sorted.data();
    const Domain& domain = grid.domain;
    const Index p = order(slot);
    std::int32_t entry = list.offset(p);
    visit_runs(grid, cell_start, self, [&](std::int32_t begin, std::int32_t end) {
      constexpr std::int32_t part = 64;
      std::int32_t found[part + 1];
      for (std::int32_t start = begin; start < end; start += part) {
        const std::int32_t stop = start + part < end ? start + part : end;
        std::int32_t n = 0;
        for (std::int32_t o = start; o < stop; ++o) {
          found[n] = o;
          n += (in_reach<Repeats>(domain, self, place[o]) ? 1 : 0) & (o != slot ? 1 : 0);
        }
        for (std::int32_t f = 0; f < n; ++f) list.partner(entry++) = order(found[f]);
      }
    });
  }
};

/// The last entry of an offsets array: the total.
std::size_t read_total(const DeviceArray<std::int32_t>& offset, Index n) {
  std::int32_t total = 0;
  Kokkos::deep_copy(total, Kokkos::subview(offset, n));
  return static_cast<std::size_t>(total);
}

}  // namespace

NeighbourSearch::NeighbourSearch(const Domain& domain, const SkinOptions& skin, Real smallest_radius,
                                 Real largest_radius, std::int64_t particles)
    : domain_(domain), skin_(skin), smallest_radius_(smallest_radius), largest_radius_(largest_radius) {
  const Real reach = 2 * largest_radius_ * (1 + skin_.largest_fraction);
  for (int axis = 0; axis < 3; ++axis) {
    const Real length = domain_.length()[axis];
    if (domain_.periodic[axis] != 0 && length < 2 * reach) {
      throw std::invalid_argument("a periodic domain must be at least " + std::to_string(2 * reach) +
                                  " m wide for these particles, so that none meets two images of another");
    }
    cells_[axis] = static_cast<Index>(std::clamp(length / reach, 1.0, 1e6));
  }
  // A few small particles in a large domain: wider cells, so that the grid does not cost more than they do.
  const auto total = [this] { return static_cast<Real>(cells_.x) * cells_.y * cells_.z; };
  const Real most = 4096 + 16 * static_cast<Real>(particles);
  while (total() > most) {
    const Real factor = std::min(0.9, std::cbrt(most / total()));
    for (int axis = 0; axis < 3; ++axis)
      cells_[axis] = std::max(1, static_cast<Index>(factor * cells_[axis]));
  }
  for (int axis = 0; axis < 3; ++axis) {
    inverse_cell_size_[axis] = static_cast<Real>(cells_[axis]) / domain_.length()[axis];
  }
}

void NeighbourSearch::bin(const Particles& particles) {
  const auto cells = static_cast<std::size_t>(cells_.x) * static_cast<std::size_t>(cells_.y) *
                     static_cast<std::size_t>(cells_.z);
  const auto n = static_cast<std::size_t>(particles.count);
  ensure_size(cell_of_, n, "dem::neighbour_list::cell_of");
  ensure_size(order_, n, "dem::neighbour_list::order");
  ensure_size(sorted_, n, "dem::neighbour_list::sorted");
  ensure_size(pair_count_, n, "dem::neighbour_list::pair_count");
  ensure_size(cell_start_, cells + 1, "dem::neighbour_list::cell_start");
  ensure_size(cell_fill_, cells, "dem::neighbour_list::cell_fill");
  const CellGrid grid{domain_, cells_, inverse_cell_size_};
  Kokkos::deep_copy(cell_fill_, 0);
  count_per_cell(grid, particles, cell_of_, cell_fill_);
  offsets_from_counts(cell_fill_, cell_start_, static_cast<Index>(cells),
                      "dem::neighbour_list::cell_offsets");
  Kokkos::deep_copy(cell_fill_, 0);
  scatter_to_cells(particles, cell_of_, cell_start_, cell_fill_, order_);
  sort_cells_by_id(particles, static_cast<Index>(cells), cell_start_, order_);
}

void NeighbourSearch::build(const Particles& particles, Real time_step, NeighbourList& list) {
  const auto n = static_cast<std::size_t>(particles.count);
  wrap_periodic(domain_, particles);
  bin(particles);
  list.count = particles.count;
  ensure_size(list.offset, n + 1, "dem::neighbour_list::offset");
  ensure_size(list.built_at, n, "dem::neighbour_list::built_at");
  ensure_size(list.allowance_squared, n, "dem::neighbour_list::allowance_squared");
  const CellGrid grid{domain_, cells_, inverse_cell_size_};
  const AllowanceRule rule{skin_.steps * time_step, skin_.smallest_fraction * smallest_radius_,
                           skin_.largest_fraction * largest_radius_};
  gather_sorted(particles, rule, order_, sorted_, list);
  const bool repeats = domain_.periodic.x + domain_.periodic.y + domain_.periodic.z != 0;
  const DeviceRange all(0, particles.count);
  if (repeats) {
    Kokkos::parallel_for("dem::neighbour_list::count_periodic", all,
                         CountPairs<true>{grid, cell_start_, order_, sorted_, pair_count_});
  } else {
    Kokkos::parallel_for("dem::neighbour_list::count", all,
                         CountPairs<false>{grid, cell_start_, order_, sorted_, pair_count_});
  }
  offsets_from_counts(pair_count_, list.offset, particles.count, "dem::neighbour_list::pair_offsets");
  ensure_size(list.partner, read_total(list.offset, particles.count), "dem::neighbour_list::partner");
  if (repeats) {
    Kokkos::parallel_for("dem::neighbour_list::fill_periodic", all,
                         FillPairs<true>{grid, cell_start_, order_, sorted_, list});
  } else {
    Kokkos::parallel_for("dem::neighbour_list::fill", all,
                         FillPairs<false>{grid, cell_start_, order_, sorted_, list});
  }
}

void wrap_periodic(const Domain& domain, const Particles& particles) {
  if (domain.periodic.x + domain.periodic.y + domain.periodic.z == 0) return;
  const auto place = particles.position_radius;
  Kokkos::parallel_for(
      "dem::neighbour_list::wrap_periodic", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index p) {
        Vec3 x = place(p).position();
        const Vec3 length = domain.length();
        for (int axis = 0; axis < 3; ++axis) {
          if (domain.periodic[axis] == 0) continue;
          if (x[axis] < domain.box.min[axis]) x[axis] += length[axis];
          if (x[axis] >= domain.box.max[axis]) x[axis] -= length[axis];
        }
        place(p).x = x.x;
        place(p).y = x.y;
        place(p).z = x.z;
      });
}

}  // namespace pellicle::dem
