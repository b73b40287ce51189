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

/// Sum over the entries of a cell, in their order: particle in the upper half of a key, pieces in the lower one.
template <class Load>
struct SumOverCell {
  DeviceArray<Index> begin;
  DeviceArray<std::uint64_t> sorted;
  DeviceArray<Load> load, result;
  Real share;
  KOKKOS_INLINE_FUNCTION void operator()(const Index c) const {
    Load sum{};
    for (Index e = begin(c); e < begin(c + 1); ++e) {
      const std::uint64_t key = sorted(e);
      sum += (share * static_cast<Real>(key & 0xffffffffU)) * load(static_cast<Index>(key >> 32));
    }
    result(c) = sum;
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

  /// Only the order, for `sum` and `rows`.
  void sort(const Footprint& footprint);
  /// Which particles lie in each cell, and with how many of their pieces, as of the last `compute` or `sort`.
  CellRows rows() const { return {begin_, sorted_, share_}; }

  /// The same for another load over the footprint of the last `compute`, whose order is used again. Load needs a
  /// default of zero, += and Real x Load.
  template <class Load>
  void sum(const DeviceArray<Load>& load, const DeviceArray<Load>& result) const {
    Kokkos::parallel_for("coupling::cell_sums::sum", DeviceRange(0, cells_),
                         SumOverCell<Load>{begin_, sorted_, load, result, share_});
  }

 private:
  void distribute(const Footprint& footprint);

  Index cells_ = 0;
  DeviceArray<Index> begin_;   // of each cell in sorted_, cells + 1
  DeviceArray<Index> cursor_;  // next free place of each cell while sorting
  DeviceArray<std::uint64_t> sorted_;
  Real share_ = 1;
};

}  // namespace pellicle::coupling
