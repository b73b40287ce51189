// Sums of per-particle quantities over the cells of a grid, in an order that does not depend on threads.
#pragma once

#include <cstdint>

#include "coupling/footprint.hpp"

namespace pellicle::coupling {

/// What particles bring to a cell; also what one particle brings to all its cells together.
struct alignas(64) CellLoad {
  Real solids = 0;       ///< volume of particles [m3]
  Real coefficient = 0;  ///< sum of K V, the part of the drag that the gas takes implicitly [kg/s]
  Vec3 explicit_force;   ///< on the gas, besides -coefficient x gas velocity [N]
  Vec3 reaction;  ///< mean force of the particles on the gas over the step, drag and pressure gradient [N]

  KOKKOS_INLINE_FUNCTION CellLoad& operator+=(const CellLoad& b) {
    solids += b.solids;
    coefficient += b.coefficient;
    explicit_force += b.explicit_force;
    reaction += b.reaction;
    return *this;
  }
  friend KOKKOS_INLINE_FUNCTION CellLoad operator*(Real s, const CellLoad& a) {
    return {s * a.solids, s * a.coefficient, s * a.explicit_force, s * a.reaction};
  }
};

/// Sums loads over cells: entries of the footprint are sorted by cell with a counting sort, within a cell by particle,
/// and summed in that order.
class CellSums {
 public:
  explicit CellSums(Index cells);

  /// Overwrites result(cell) = sum over particles of load(p) x share of p in the cell.
  void compute(const Footprint& footprint, const DeviceArray<CellLoad>& load,
               const DeviceArray<CellLoad>& result);

 private:
  Index cells_ = 0;
  DeviceArray<Index> begin_;   // of each cell in sorted_, cells + 1
  DeviceArray<Index> cursor_;  // next free place of each cell while sorting
  DeviceArray<std::uint64_t> sorted_;
};

}  // namespace pellicle::coupling
