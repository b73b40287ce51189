// The footprint of particles on a grid: which cells each particle covers, and with how many of its pieces.
#pragma once

#include "coupling/cut_grid.hpp"
#include "coupling/deposition_kernels.hpp"
#include "coupling/grid_locator.hpp"
#include "dem/particles.hpp"

namespace pellicle::coupling {

/// So many pieces of a particle lie in this cell.
struct FootprintEntry {
  Index cell;
  Index pieces;
};

/// Compressed rows: entries begin(p) to begin(p + 1) - 1 belong to particle p. The same weights serve deposition and,
/// transposed, sampling.
struct FootprintView {
  DeviceArray<Index> begin;
  DeviceArray<FootprintEntry> entries;
  Real share = 1;  ///< of a piece in its particle's volume

  /// Weighted mean over the particle's cells of a field: sum of value(cell) x share of the particle in the cell.
  template <class T>
  KOKKOS_INLINE_FUNCTION T sample(Index p, const DeviceArray<T>& field) const {
    const Index first = begin(p), last = begin(p + 1);
    if (last - first == 1) return field(entries(first).cell);
    T sum = share * entries(first).pieces * field(entries(first).cell);
    for (Index e = first + 1; e < last; ++e) sum += share * entries(e).pieces * field(entries(e).cell);
    return sum;
  }
};

/// Owns the footprint of all particles on one grid. Memory grows with the particles and is kept.
class Footprint {
 public:
  /// Pieces outside the grid belong to the nearest cell; periodic axes wrap. Where walls cut the grid, pieces in cells
  /// that are not joined (CutGrid::joined) to the particle's own belong to that.
  Footprint(const GridLocator& grid, const Deposition& kernel, const CutGrid& cut = {});

  /// Finds the cells of every particle at its present position. Independent of the number of threads.
  void compute(const dem::Particles& particles);
  /// Whether the particles, in this order, are where they were at the last `compute`.
  bool is_current(const dem::Particles& particles) const;

  const FootprintView& view() const { return view_; }
  const GridLocator& grid() const { return grid_; }
  Index particle_count() const { return particle_count_; }
  Index entry_count() const { return entry_count_; }

 private:
  template <class Kernel, class Cells>
  void count_and_store(const dem::Particles& particles, const Cells& cells);

  GridLocator grid_;
  Deposition kernel_;
  CutGrid cut_;
  FootprintView view_;
  DeviceArray<dem::PositionRadius> computed_at_;
  Index particle_count_ = 0;
  Index entry_count_ = 0;
};

}  // namespace pellicle::coupling
