#include "coupling/void_fraction_bound.hpp"

namespace pellicle::coupling {

namespace {

constexpr int sides = 6;             // x-, x+, y-, y+, z-, z+
constexpr Index most_sweeps = 2000;  // a bed packed to the bound needs tens
constexpr Real tolerance = 1e-10;    // of what a cell may hold

struct WholeNeighbours {
  GridLocator locator;

  KOKKOS_INLINE_FUNCTION const GridLocator& grid() const { return locator; }

  /// The cell across a side, or -1 at a wall (or where a periodic axis has one cell only).
  KOKKOS_INLINE_FUNCTION Index across(Index i, Index j, Index k, int side) const {
    const int axis = side / 2;
    const AxisLocator& along = axis == 0 ? locator.x : (axis == 1 ? locator.y : locator.z);
    const Index at = axis == 0 ? i : (axis == 1 ? j : k);
    Index next = side % 2 == 0 ? at - 1 : at + 1;
    if (next < 0 || next >= along.cells) {
      if (!along.periodic || along.cells == 1) return -1;
      next = next < 0 ? along.cells - 1 : 0;
    }
    return axis == 0 ? locator.index(next, j, k)
                     : (axis == 1 ? locator.index(i, next, k) : locator.index(i, j, next));
  }
  KOKKOS_INLINE_FUNCTION Real volume(Index cell) const {
    const Index nx = locator.x.cells, ny = locator.y.cells;
    return locator.volume(cell % nx, (cell / nx) % ny, cell / (nx * ny));
  }
};

/// The same where walls cut the cells.
struct OpenNeighbours {
  WholeNeighbours whole;
  CutGrid cut;

  KOKKOS_INLINE_FUNCTION const GridLocator& grid() const { return whole.locator; }

  KOKKOS_INLINE_FUNCTION Index across(Index i, Index j, Index k, int side) const {
    return cut.is_open(whole.locator.index(i, j, k), side) ? whole.across(i, j, k, side) : -1;
  }
  KOKKOS_INLINE_FUNCTION Real volume(Index cell) const { return cut.volume(cell); }
};

/// Decides what each cell gives to each side, and counts the cells that hold too much.
template <class Neighbours>
struct ComputeGiven {
  Neighbours neighbours;
  DeviceArray<CellLoad> loads;
  DeviceArray<Real> given;
  Real largest_solids_fraction;

  KOKKOS_INLINE_FUNCTION Real capacity(Index cell) const {
    return largest_solids_fraction * neighbours.volume(cell);
  }

  KOKKOS_INLINE_FUNCTION void operator()(const Index cell, Index& cells_over) const {
    const Real solids = loads(cell).solids;
    const Real excess = solids - capacity(cell);
    for (int side = 0; side < sides; ++side) given(sides * cell + side) = 0;
    if (!(excess > tolerance * capacity(cell))) return;
    ++cells_over;
    const Index nx = neighbours.grid().x.cells, ny = neighbours.grid().y.cells;
    const Index i = cell % nx, j = (cell / nx) % ny, k = cell / (nx * ny);
    Real room[sides];
    Real all_room = 0, all_neighbours = 0;
    for (int side = 0; side < sides; ++side) {
      room[side] = 0;
      const Index q = neighbours.across(i, j, k, side);
      if (q < 0) continue;
      all_neighbours += 1;
      room[side] = Kokkos::max(Real(0), capacity(q) - loads(q).solids);
      all_room += room[side];
    }
    const bool no_room = all_room <= tolerance * capacity(cell);
    const Real moved = no_room ? excess : Kokkos::min(excess, all_room);
    for (int side = 0; side < sides; ++side) {
      if (neighbours.across(i, j, k, side) < 0) continue;
      const Real part = no_room ? 1 / all_neighbours : room[side] / all_room;
      given(sides * cell + side) = part * (moved / solids);
    }
  }
};

template <class Neighbours>
struct MoveLoads {
  Neighbours neighbours;
  DeviceArray<Real> given;
  DeviceArray<CellLoad> before, after;

  KOKKOS_INLINE_FUNCTION void operator()(const Index cell) const {
    const Index nx = neighbours.grid().x.cells, ny = neighbours.grid().y.cells;
    const Index i = cell % nx, j = (cell / nx) % ny, k = cell / (nx * ny);
    CellLoad load = before(cell);
    const CellLoad own = load;
    for (int side = 0; side < sides; ++side) {
      const Real gives = given(sides * cell + side);
      if (gives != 0) load += (-gives) * own;
      const Index q = neighbours.across(i, j, k, side);
      if (q < 0) continue;
      const Real gets = given(sides * q + (side ^ 1));  // the neighbour's opposite side
      if (gets != 0) load += gets * before(q);
    }
    after(cell) = load;
  }
};

}  // namespace

VoidFractionBound::VoidFractionBound(const GridLocator& grid, Real minimum_void_fraction, const CutGrid& cut)
    : grid_(grid), cut_(cut), largest_solids_fraction_(1 - minimum_void_fraction) {
  const auto cells = static_cast<std::size_t>(grid.cell_count());
  before_ = DeviceArray<CellLoad>("coupling::void_fraction_bound::before", cells);
  given_ = DeviceArray<Real>("coupling::void_fraction_bound::given", sides * cells);
}

BoundReport VoidFractionBound::apply(const DeviceArray<CellLoad>& loads) {
  const WholeNeighbours whole{grid_};
  return cut_.is_cut() ? spread(OpenNeighbours{whole, cut_}, loads) : spread(whole, loads);
}

template <class Neighbours>
BoundReport VoidFractionBound::spread(const Neighbours& neighbours, const DeviceArray<CellLoad>& loads) {
  BoundReport report;
  const DeviceRange cells(0, grid_.cell_count());
  while (true) {
    Index over = 0;
    Kokkos::parallel_reduce("coupling::void_fraction_bound::compute_given", cells,
                            ComputeGiven<Neighbours>{neighbours, loads, given_, largest_solids_fraction_},
                            over);
    if (report.iterations == 0) report.cells_over = over;
    report.cells_left_over = over;
    if (over == 0 || report.iterations == most_sweeps) return report;
    Kokkos::deep_copy(Device(), before_, loads);
    Kokkos::parallel_for("coupling::void_fraction_bound::move_loads", cells,
                         MoveLoads<Neighbours>{neighbours, given_, before_, loads});
    ++report.iterations;
  }
}

}  // namespace pellicle::coupling
