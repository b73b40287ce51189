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

/// Entries of a footprint by cell, in the order of their particles: those of a cell are begin(cell) to
/// begin(cell + 1) - 1.
struct CellRows {
  DeviceArray<Index> begin;
  DeviceArray<std::uint64_t> keys;  ///< particle in the upper half, pieces in the lower one
  Real share = 1;                   ///< of a piece in its particle

  KOKKOS_INLINE_FUNCTION Index particle(Index entry) const { return static_cast<Index>(keys(entry) >> 32); }
  /// Of the particle, in the cell.
  KOKKOS_INLINE_FUNCTION Real share_of(Index entry) const {
    return share * static_cast<Real>(keys(entry) & 0xffffffffU);
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

  /// Only the order, for `rows`.
  void sort(const Footprint& footprint);
  /// Which particles lie in each cell, and with how many of their pieces, as of the last `compute` or `sort`.
  CellRows rows() const { return {begin_, sorted_, share_}; }

 private:
  void distribute(const Footprint& footprint);

  Index cells_ = 0;
  DeviceArray<Index> begin_;   // of each cell in sorted_, cells + 1
  DeviceArray<Index> cursor_;  // next free place of each cell while sorting
  DeviceArray<std::uint64_t> sorted_;
  Real share_ = 1;
};

}  // namespace pellicle::coupling
