// Smoothing of what particles bring to the cells, by diffusion.
#pragma once

#include <array>

#include "coupling/cell_sums.hpp"
#include "coupling/grid_locator.hpp"

namespace pellicle::coupling {

/// Spreads loads over the cells around: their densities f = load / cell volume obey df/dt = D lap f up to a pseudo time
/// T with D T = length^2 / 4, without flux through walls, so that a load far from walls becomes about a Gaussian
/// exp(-r^2 / length^2), of variance length^2 / 2 along each axis.
///
/// Source: Sun & Xiao, Int. J. Multiphase Flow 77 (2015), diffusion-based coarse graining. Here the axes are solved one
/// after the other, each in three backward-Euler steps. Sums over cells are kept to round-off, and no density leaves
/// the range it had before: an upper bound of the solids fraction still holds. Every line of cells along an axis is one
/// work item: the result does not depend on threads.
///
/// The factors are the same for all lines of an axis; closed faces inside the domain (immersed walls) would multiply
/// the conductance of each face by its openness, with factors for each line that has such a face.
class Smoothing {
 public:
  /// What a backward-Euler step needs to know of a cell. The conductance of a face is D dt / distance of the centres.
  struct CellFactors {
    Real width = 0;     ///< [m]
    Real own = 0;       ///< width / pivot of the cell
    Real previous = 0;  ///< conductance towards the previous cell / pivot
    Real next = 0;      ///< conductance towards the next cell / pivot
    Real around = 0;    ///< answer to a unit difference between the ends, of a periodic axis; else 0
  };
  struct Axis {
    DeviceArray<CellFactors> factors;  ///< one for each cell along the axis
    Index cells = 0;                   ///< along the axis; 0 where there is nothing to do
    Index stride = 0;                  ///< from a cell to the next one along the axis
    bool periodic = false;
  };

  /// `length` in [m], at least 0; with 0 nothing is changed.
  Smoothing(const GridLocator& grid, Real length);

  /// Smooths all components of loads(cell).
  void apply(const DeviceArray<CellLoad>& loads) const;

 private:
  Index cell_count_ = 0;
  std::array<Axis, 3> axes_;
};

}  // namespace pellicle::coupling
