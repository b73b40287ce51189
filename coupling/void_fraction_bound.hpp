// The lower bound of the void fraction: solids above it are moved to neighbouring cells.
#pragma once

#include "coupling/cell_sums.hpp"
#include "coupling/cut_grid.hpp"
#include "coupling/grid_locator.hpp"

namespace pellicle::coupling {

struct BoundReport {
  Index cells_over = 0;       ///< cells that held too much before
  Index iterations = 0;       ///< sweeps it took
  Index cells_left_over = 0;  ///< cells that still do; more than 0 only if there is not room enough
};

/// Spreads solids above (1 - minimum void fraction) x cell volume to the cells across the six faces. What moves takes
/// its share of drag and reaction along, so that volume and momentum are kept to round-off. Each sweep a cell gives its
/// excess to neighbours in proportion to their room, or, where no neighbour has any, in equal parts, for them to pass
/// on. Sweeps read the old state and write the new one: the result does not depend on threads. Where walls cut the grid,
/// cells hold as much of their open volume, and nothing passes closed faces.
class VoidFractionBound {
 public:
  VoidFractionBound(const GridLocator& grid, Real minimum_void_fraction, const CutGrid& cut = {});

  BoundReport apply(const DeviceArray<CellLoad>& loads);

 private:
  template <class Neighbours>
  BoundReport spread(const Neighbours& neighbours, const DeviceArray<CellLoad>& loads);

  GridLocator grid_;
  CutGrid cut_;
  Real largest_solids_fraction_ = 1;
  DeviceArray<CellLoad> before_;
  DeviceArray<Real> given_;  // share of its load that a cell gives to each of six neighbours
};

}  // namespace pellicle::coupling
