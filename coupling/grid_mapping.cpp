#include "coupling/grid_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "coupling/grid_locator.hpp"

namespace pellicle::coupling {

namespace {

AxisOverlap compute_overlap(const std::vector<Real>& source, const std::vector<Real>& target) {
  std::vector<Index> begin{0}, cells;
  std::vector<Real> shares;
  const std::size_t last = source.size() - 2;
  std::size_t s = 0;
  for (std::size_t t = 0; t + 1 < target.size(); ++t) {
    const Real width = target[t + 1] - target[t];
    // A sliver that rounding leaves between faces that were meant to coincide is no overlap.
    const Real sliver = 1e-9 * width;
    while (s < last && source[s + 1] <= target[t] + sliver) ++s;
    const std::size_t first_share = shares.size();
    Real sum = 0;
    for (std::size_t q = s; q <= last && source[q] < target[t + 1] - sliver; ++q) {
      const Real overlap = std::min(source[q + 1], target[t + 1]) - std::max(source[q], target[t]);
      cells.push_back(static_cast<Index>(q));
      shares.push_back(overlap);
      sum += overlap;
    }
    for (std::size_t i = first_share; i < shares.size(); ++i) shares[i] /= sum;
    begin.push_back(static_cast<Index>(cells.size()));
  }
  AxisOverlap made{HostArray<Index>("coupling::grid_mapping::begin", begin.size()),
                   HostArray<Index>("coupling::grid_mapping::source", cells.size()),
                   HostArray<Real>("coupling::grid_mapping::share", shares.size())};
  std::copy(begin.begin(), begin.end(), made.begin.data());
  std::copy(cells.begin(), cells.end(), made.source.data());
  std::copy(shares.begin(), shares.end(), made.share.data());
  return made;
}

}  // namespace

GridMapping::GridMapping(const CartesianGrid& source, const CartesianGrid& target)
    : identity_(same_cells(source, target)), source_cells_(source.cells()), target_cells_(target.cells()) {
  for (int axis = 0; axis < 3; ++axis) {
    const Real length = target.box().max[axis] - target.box().min[axis];
    if (std::abs(source.box().min[axis] - target.box().min[axis]) > 1e-9 * length ||
        std::abs(source.box().max[axis] - target.box().max[axis]) > 1e-9 * length) {
      throw InputError("coupling.transfer_grid: must cover the same box as the gas grid");
    }
    overlap_[static_cast<std::size_t>(axis)] = compute_overlap(source.faces(axis), target.faces(axis));
  }
}

}  // namespace pellicle::coupling
