#include "coupling/void_fraction_bound.hpp"

namespace pellicle::coupling {

namespace {

constexpr int sides = 6;             // x-, x+, y-, y+, z-, z+
constexpr Index most_sweeps = 2000;  // a bed packed to the bound needs tens
constexpr Real tolerance = 1e-10;    // of what a cell may hold

struct Neighbours {
  GridLocator grid;

  /// The cell across a side, or -1 at a wall (or where a periodic axis has one cell only).
  KOKKOS_INLINE_FUNCTION Index across(Index i, Index j, Index k, int side) const {
    const int axis = side / 2;
    const AxisLocator& along = axis == 0 ? grid.x : (axis == 1 ? grid.y : grid.z);
    const Index at = axis == 0 ? i : (axis == 1 ? j : k);
    Index next = side % 2 == 0 ? at - 1 : at + 1;
    if (next < 0 || next >= along.cells) {
      if (!along.periodic || along.cells == 1) return -1;
      next = next < 0 ? along.cells - 1 : 0;
    }
    return axis == 0 ? grid.index(next, j, k) : (axis == 1 ? grid.index(i, next, k) : grid.index(i, j, next));
  }
  KOKKOS_INLINE_FUNCTION Real volume(Index cell) const {
    const Index nx = grid.x.cells, ny = grid.y.cells;
    return grid.volume(cell % nx, (cell / nx) % ny, cell / (nx * ny));
  }
};

/// Decides what each cell gives to each side, and counts the cells that hold too much.
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
    const Index nx = neighbours.grid.x.cells, ny = neighbours.grid.y.cells;
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

struct MoveLoads {
  Neighbours neighbours;
  DeviceArray<Real> given;
  DeviceArray<CellLoad> before, after;

  KOKKOS_INLINE_FUNCTION void operator()(const Index cell) const {
    const Index nx = neighbours.grid.x.cells, ny = neighbours.grid.y.cells;
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

VoidFractionBound::VoidFractionBound(const GridLocator& grid, Real minimum_void_fraction)
    : grid_(grid), largest_solids_fraction_(1 - minimum_void_fraction) {
  const auto cells = static_cast<std::size_t>(grid.cell_count());
  before_ = DeviceArray<CellLoad>("coupling::void_fraction_bound::before", cells);
  given_ = DeviceArray<Real>("coupling::void_fraction_bound::given", sides * cells);
}

BoundReport VoidFractionBound::apply(const DeviceArray<CellLoad>& loads) {
  BoundReport report;
  const Neighbours neighbours{grid_};
  const DeviceRange cells(0, grid_.cell_count());
  while (true) {
    Index over = 0;
    Kokkos::parallel_reduce("coupling::void_fraction_bound::compute_given", cells,
                            ComputeGiven{neighbours, loads, given_, largest_solids_fraction_}, over);
    if (report.iterations == 0) report.cells_over = over;
    report.cells_left_over = over;
    if (over == 0 || report.iterations == most_sweeps) return report;
    Kokkos::deep_copy(Device(), before_, loads);
    Kokkos::parallel_for("coupling::void_fraction_bound::move_loads", cells,
                         MoveLoads{neighbours, given_, before_, loads});
    ++report.iterations;
  }
}

}  // namespace pellicle::coupling
