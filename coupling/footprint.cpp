#include "coupling/footprint.hpp"

#include <Kokkos_BitManipulation.hpp>

#include <algorithm>

namespace pellicle::coupling {

namespace {

constexpr PieceMask all_pieces = ~PieceMask{0};

/// The cells along one axis that hold pieces of a particle, and which pieces.
template <class Kernel>
struct AxisSplit {
  int count = 0;
  Index cell[Kernel::most_cells_along_axis];
  PieceMask pieces[Kernel::most_cells_along_axis];
};

template <class Kernel>
KOKKOS_INLINE_FUNCTION AxisSplit<Kernel> split_along(int axis, const AxisLocator& grid, Real centre,
                                                     Real radius) {
  const Real x = grid.wrap(centre);
  const Real reach = Kernel::extent(axis) * radius;
  AxisSplit<Kernel> split;
  // Fast path: all pieces in one cell.
  const Index here = grid.locate(x);
  if ((x - reach >= grid.faces(here) || (here == 0 && !grid.periodic)) &&
      (x + reach < grid.faces(here + 1) || (here == grid.cells - 1 && !grid.periodic))) {
    split.count = 1;
    split.cell[0] = here;
    split.pieces[0] = all_pieces;
    return split;
  }
  // Cells from the one with the lowest piece to the one with the highest; beyond a periodic end they are images.
  const Real length = grid.max - grid.min;
  Index i = here;
  Real shift = 0;
  while (x - reach < grid.faces(i) + shift && (i > 0 || grid.periodic)) {
    if (--i < 0) {
      i = grid.cells - 1;
      shift -= length;
    }
  }
  PieceMask taken = 0;
  while (true) {
    const Real upper = grid.faces(i + 1) + shift;
    // Negated, so that a position that is not a number ends the loop.
    const bool last = !(x + reach >= upper) || (i == grid.cells - 1 && !grid.periodic);
    const PieceMask below = last ? all_pieces : Kernel::pieces_below(axis, (upper - x) / radius);
    const PieceMask here_only = below & ~taken;
    taken |= below;
    if (here_only != 0 && split.count < Kernel::most_cells_along_axis) {
      split.cell[split.count] = i;
      split.pieces[split.count] = here_only;
      ++split.count;
    }
    if (last) break;
    if (++i == grid.cells) {
      i = 0;
      shift += length;
    }
  }
  return split;
}

/// Calls visit(cell, pieces) for every cell that holds pieces of the particle, in the order z, y, x.
template <class Kernel, class Visit>
KOKKOS_INLINE_FUNCTION void visit_cells(const GridLocator& grid, const dem::PositionRadius& particle,
                                        const Visit& visit) {
  constexpr PieceMask exists = all_pieces >> (64 - Kernel::pieces);
  const AxisSplit<Kernel> x = split_along<Kernel>(0, grid.x, particle.x, particle.radius);
  const AxisSplit<Kernel> y = split_along<Kernel>(1, grid.y, particle.y, particle.radius);
  const AxisSplit<Kernel> z = split_along<Kernel>(2, grid.z, particle.z, particle.radius);
  for (int c = 0; c < z.count; ++c) {
    for (int b = 0; b < y.count; ++b) {
      const PieceMask column = exists & z.pieces[c] & y.pieces[b];
      for (int a = 0; a < x.count; ++a) {
        const Index pieces = Kokkos::popcount(column & x.pieces[a]);
        if (pieces > 0) visit(grid.index(x.cell[a], y.cell[b], z.cell[c]), pieces);
      }
    }
  }
}

struct CountVisits {
  Index& count;
  KOKKOS_INLINE_FUNCTION void operator()(Index, Index) const { ++count; }
};

struct StoreVisits {
  const DeviceArray<FootprintEntry>& entries;
  Index& next;
  KOKKOS_INLINE_FUNCTION void operator()(Index cell, Index pieces) const { entries(next++) = {cell, pieces}; }
};

/// Cells that nothing cuts: every piece stays where it is.
struct WholeCells {
  GridLocator grid;

  template <class Kernel, class Visit>
  KOKKOS_INLINE_FUNCTION void visit_cells_of(const dem::PositionRadius& particle, const Visit& visit) const {
    visit_cells<Kernel>(grid, particle, visit);
  }
};

/// Passes on the cells that are joined to a particle's own, and counts the pieces in the others.
template <class Visit>
struct VisitJoined {
  const GridLocator& grid;
  const CutGrid& cut;
  const Visit& visit;
  Index3 home;
  Index& pieces_at_home;

  KOKKOS_INLINE_FUNCTION void operator()(Index cell, Index pieces) const {
    const Index nx = grid.x.cells, ny = grid.y.cells;
    const Index3 at{cell % nx, (cell / nx) % ny, cell / (nx * ny)};
    if (at == home || !cut.joined(grid, home, at)) {
      pieces_at_home += pieces;
    } else {
      visit(cell, pieces);
    }
  }
};

/// Cells that walls cut: pieces beyond them are taken back into the particle's own cell.
struct CutCells {
  GridLocator grid;
  CutGrid cut;

  template <class Kernel, class Visit>
  KOKKOS_INLINE_FUNCTION void visit_cells_of(const dem::PositionRadius& particle, const Visit& visit) const {
    const Vec3 centre{grid.x.wrap(particle.x), grid.y.wrap(particle.y), grid.z.wrap(particle.z)};
    const Index cell = grid.index(grid.x.locate(centre.x), grid.y.locate(centre.y), grid.z.locate(centre.z));
    const Index home = cut.home(cell, centre);
    const Index nx = grid.x.cells, ny = grid.y.cells;
    Index pieces_at_home = 0;
    visit_cells<Kernel>(
        grid, particle,
        VisitJoined<Visit>{
            grid, cut, visit, {home % nx, (home / nx) % ny, home / (nx * ny)}, pieces_at_home});
    if (pieces_at_home > 0) visit(home, pieces_at_home);
  }
};

/// Counts the entries of each particle, and where they begin.
template <class Kernel, class Cells>
struct CountEntries {
  Cells cells;
  DeviceArray<dem::PositionRadius> position_radius;
  FootprintView footprint;
  DeviceArray<dem::PositionRadius> computed_at;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    const dem::PositionRadius particle = position_radius(p);
    computed_at(p) = particle;
    Index count = 0;
    cells.template visit_cells_of<Kernel>(particle, CountVisits{count});
    footprint.begin(p) = count;
  }
};

struct ScanCounts {
  DeviceArray<Index> begin;
  Index particles;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Index& sum, const bool final) const {
    const Index count = p < particles ? begin(p) : 0;
    if (final) begin(p) = sum;
    sum += count;
  }
};

template <class Kernel, class Cells>
struct StoreEntries {
  Cells cells;
  DeviceArray<dem::PositionRadius> computed_at;
  FootprintView footprint;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    Index next = footprint.begin(p);
    cells.template visit_cells_of<Kernel>(computed_at(p), StoreVisits{footprint.entries, next});
  }
};

/// Particles that are not where they were.
struct CountMoved {
  DeviceArray<dem::PositionRadius> now, then;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Index& moved) const {
    const dem::PositionRadius a = now(p), b = then(p);
    if (!(a.x == b.x && a.y == b.y && a.z == b.z && a.radius == b.radius)) ++moved;
  }
};

}  // namespace

Footprint::Footprint(const GridLocator& grid, const Deposition& kernel, const CutGrid& cut)
    : grid_(grid), kernel_(kernel), cut_(cut) {
  view_.share = std::visit([](const auto& k) { return 1.0 / k.pieces; }, kernel_);
}

template <class Kernel, class Cells>
void Footprint::count_and_store(const dem::Particles& particles, const Cells& cells) {
  const Index n = particles.count;
  Kokkos::parallel_for("coupling::footprint::count_entries", DeviceRange(0, n),
                       CountEntries<Kernel, Cells>{cells, particles.position_radius, view_, computed_at_});
  Index total = 0;
  Kokkos::parallel_scan("coupling::footprint::scan_counts", DeviceRange(0, n + 1), ScanCounts{view_.begin, n},
                        total);
  if (view_.entries.extent(0) < static_cast<std::size_t>(total)) {
    // Room to move: a bed that expands covers more cells.
    const std::size_t room =
        std::max<std::size_t>(static_cast<std::size_t>(total) * 3 / 2, 4 * static_cast<std::size_t>(n));
    view_.entries = DeviceArray<FootprintEntry>(
        Kokkos::view_alloc("coupling::footprint::entries", Kokkos::WithoutInitializing), room);
  }
  Kokkos::parallel_for("coupling::footprint::store_entries", DeviceRange(0, n),
                       StoreEntries<Kernel, Cells>{cells, computed_at_, view_});
  particle_count_ = n;
  entry_count_ = total;
}

void Footprint::compute(const dem::Particles& particles) {
  const auto size = static_cast<std::size_t>(particles.count);
  if (computed_at_.extent(0) < size || view_.begin.extent(0) == 0) {
    computed_at_ = DeviceArray<dem::PositionRadius>(
        Kokkos::view_alloc("coupling::footprint::computed_at", Kokkos::WithoutInitializing), size);
    view_.begin = DeviceArray<Index>(
        Kokkos::view_alloc("coupling::footprint::begin", Kokkos::WithoutInitializing), size + 1);
  }
  std::visit(
      [&](const auto& kernel) {
        using Kernel = std::decay_t<decltype(kernel)>;
        if (cut_.is_cut()) {
          count_and_store<Kernel>(particles, CutCells{grid_, cut_});
        } else {
          count_and_store<Kernel>(particles, WholeCells{grid_});
        }
      },
      kernel_);
}

bool Footprint::is_current(const dem::Particles& particles) const {
  if (particles.count != particle_count_) return false;
  Index moved = 0;
  Kokkos::parallel_reduce("coupling::footprint::count_moved", DeviceRange(0, particles.count),
                          CountMoved{particles.position_radius, computed_at_}, moved);
  return moved == 0;
}

}  // namespace pellicle::coupling
