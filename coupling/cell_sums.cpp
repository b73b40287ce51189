#include "coupling/cell_sums.hpp"

#include <algorithm>

namespace pellicle::coupling {

namespace {

/// Particle and pieces of an entry as one number that orders by particle first.
KOKKOS_INLINE_FUNCTION std::uint64_t make_key(Index particle, Index pieces) {
  return (static_cast<std::uint64_t>(particle) << 32) | static_cast<std::uint64_t>(pieces);
}

struct CountPerCell {
  FootprintView footprint;
  DeviceArray<Index> cursor;
  KOKKOS_INLINE_FUNCTION void operator()(const Index e) const {
    Kokkos::atomic_inc(&cursor(footprint.entries(e).cell));
  }
};

/// From counts to where each cell begins; the cursor starts there.
struct ScanCells {
  DeviceArray<Index> begin, cursor;
  Index cells;
  KOKKOS_INLINE_FUNCTION void operator()(const Index c, Index& sum, const bool final) const {
    const Index count = c < cells ? cursor(c) : 0;
    if (final) {
      begin(c) = sum;
      if (c < cells) cursor(c) = sum;
    }
    sum += count;
  }
};

/// Whole numbers only are exchanged between threads here; the order within a cell is put right afterwards.
struct Scatter {
  FootprintView footprint;
  DeviceArray<Index> cursor;
  DeviceArray<std::uint64_t> sorted;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    for (Index e = footprint.begin(p); e < footprint.begin(p + 1); ++e) {
      const FootprintEntry entry = footprint.entries(e);
      sorted(Kokkos::atomic_fetch_add(&cursor(entry.cell), 1)) = make_key(p, entry.pieces);
    }
  }
};

/// Shell sort: linear on the nearly sorted runs that come from particles in spatial order, and bearable on any other.
KOKKOS_INLINE_FUNCTION void sort_keys(const DeviceArray<std::uint64_t>& sorted, Index first, Index last) {
  Index gap = 1;
  while (gap < (last - first) / 9) gap = 3 * gap + 1;
  for (; gap > 0; gap /= 3) {
    for (Index i = first + gap; i < last; ++i) {
      const std::uint64_t key = sorted(i);
      Index j = i;
      for (; j >= first + gap && sorted(j - gap) > key; j -= gap) sorted(j) = sorted(j - gap);
      sorted(j) = key;
    }
  }
}

struct SortAndSum {
  CellRows rows;
  DeviceArray<CellLoad> load, result;

  KOKKOS_INLINE_FUNCTION void operator()(const Index c) const {
    const Index first = rows.begin(c), last = rows.begin(c + 1);
    sort_keys(rows.keys, first, last);
    CellLoad sum;
    for (Index e = first; e < last; ++e) sum += rows.share_of(e) * load(rows.particle(e));
    result(c) = sum;
  }
};

struct SortCells {
  DeviceArray<Index> begin;
  DeviceArray<std::uint64_t> sorted;
  KOKKOS_INLINE_FUNCTION void operator()(const Index c) const { sort_keys(sorted, begin(c), begin(c + 1)); }
};

}  // namespace

CellSums::CellSums(Index cells) : cells_(cells) {
  const auto size = static_cast<std::size_t>(cells);
  begin_ = DeviceArray<Index>("coupling::cell_sums::begin", size + 1);
  cursor_ = DeviceArray<Index>("coupling::cell_sums::cursor", size);
}

/// Entries to their cells, in any order within a cell.
void CellSums::distribute(const Footprint& footprint) {
  const FootprintView& view = footprint.view();
  if (sorted_.extent(0) < view.entries.extent(0)) {
    sorted_ = DeviceArray<std::uint64_t>(
        Kokkos::view_alloc("coupling::cell_sums::sorted", Kokkos::WithoutInitializing),
        view.entries.extent(0));
  }
  share_ = view.share;
  Kokkos::deep_copy(Device(), cursor_, 0);
  Kokkos::parallel_for("coupling::cell_sums::count_per_cell", DeviceRange(0, footprint.entry_count()),
                       CountPerCell{view, cursor_});
  Kokkos::parallel_scan("coupling::cell_sums::scan_cells", DeviceRange(0, cells_ + 1),
                        ScanCells{begin_, cursor_, cells_});
  Kokkos::parallel_for("coupling::cell_sums::scatter", DeviceRange(0, footprint.particle_count()),
                       Scatter{view, cursor_, sorted_});
}

void CellSums::compute(const Footprint& footprint, const DeviceArray<CellLoad>& load,
                       const DeviceArray<CellLoad>& result) {
  distribute(footprint);
  Kokkos::parallel_for("coupling::cell_sums::sort_and_sum", DeviceRange(0, cells_),
                       SortAndSum{rows(), load, result});
}

void CellSums::sort(const Footprint& footprint) {
  distribute(footprint);
  Kokkos::parallel_for("coupling::cell_sums::sort", DeviceRange(0, cells_), SortCells{begin_, sorted_});
}

}  // namespace pellicle::coupling
