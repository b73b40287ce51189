// Conservative mapping of densities between two grids of the same box, by overlap volume. On the host.
#pragma once

#include <array>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/views.hpp"

namespace pellicle::coupling {

/// Along one axis: which source cells each target cell overlaps, and which share of the target cell each fills.
struct AxisOverlap {
  HostArray<Index> begin;   // target cells + 1
  HostArray<Index> source;  // source cell of each overlap
  HostArray<Real> share;    // sums to 1 over a target cell
};

/// Maps cell means of one grid onto another so that integrals over the box are kept: target = sum over source cells of
/// value x overlap volume / target volume. Grids may be finer, coarser or stretched in any direction. If they have the
/// same cells, values are copied.
class GridMapping {
 public:
  /// Throws InputError if the grids do not cover the same box.
  GridMapping(const CartesianGrid& source, const CartesianGrid& target);

  bool is_identity() const { return identity_; }

  /// Overwrites target(cell) = to_target(mean over the cell of source values); T needs +=, and Real x T.
  template <class T>
  void map(const HostArray<T>& source, const HostArray<T>& target) const {
    if (identity_) {
      Kokkos::deep_copy(Host(), target, source);
      return;
    }
    const Index nx = target_cells_.x, ny = target_cells_.y;
    const Index sx = source_cells_.x, sy = source_cells_.y;
    const AxisOverlap &x = overlap_[0], &y = overlap_[1], &z = overlap_[2];
    Kokkos::parallel_for("coupling::grid_mapping::map", HostRange(0, nx * ny * target_cells_.z),
                         [=](Index cell) {
                           const Index i = cell % nx, j = (cell / nx) % ny, k = cell / (nx * ny);
                           T sum{};
                           for (Index c = z.begin(k); c < z.begin(k + 1); ++c) {
                             for (Index b = y.begin(j); b < y.begin(j + 1); ++b) {
                               for (Index a = x.begin(i); a < x.begin(i + 1); ++a) {
                                 const Real share = x.share(a) * y.share(b) * z.share(c);
                                 sum += share * source(x.source(a) + sx * (y.source(b) + sy * z.source(c)));
                               }
                             }
                           }
                           target(cell) = sum;
                         });
  }

 private:
  bool identity_ = false;
  Index3 source_cells_, target_cells_;
  std::array<AxisOverlap, 3> overlap_;
};

}  // namespace pellicle::coupling
