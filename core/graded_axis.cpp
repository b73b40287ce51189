// The axis is cut at the ends of the zones. A size is chosen for each cut, which both cells that touch it have to within
// half the growth; the pieces between cuts can then be filled one by one. For a number of cells the logarithms of their
// sizes that satisfy all bounds form a convex set with a largest and a smallest member, so that every length between
// their sums can be met exactly.
#include "core/graded_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pellicle {

namespace {

constexpr Real unbounded = std::numeric_limits<Real>::infinity();

/// Least number of equal cells of at most this size; a length that is a multiple but for round-off is one.
Index count_equal(Real length, Real size) {
  return std::max(Index{1}, static_cast<Index>(std::ceil(length / size * (1 - 1e-9))));
}

/// Between two cuts. Sizes are logarithms; those of the cuts are infinite where nothing lies beyond.
class Piece {
 public:
  Piece(Real length, Real largest, Real growth)
      : length_(length),
        largest_(std::log(std::max(largest, length / count_equal(length, largest)))),
        growth_(std::log(growth) * (1 - 1e-9)) {}

  /// Of the fewest equal cells not above a size.
  Real equal_size(Real most) const { return std::log(length_ / count_equal(length_, std::exp(most))); }
  Real equal_size() const { return equal_size(largest_); }
  Index least_count() const { return count_equal(length_, std::exp(largest_)); }

  /// The fewest cells whose largest sizes reach the length.
  Index count(Real left, Real right) const {
    const auto reaches = [&](Index n) { return fill(n, left, right, largest_, 0) >= length_ * (1 - 1e-10); };
    Index high = least_count();
    if (reaches(high)) return high;
    Index low = high;  // does not reach
    while (!reaches(high)) {
      low = high;
      high *= 2;
    }
    while (high - low > 1) {
      const Index middle = low + (high - low) / 2;
      (reaches(middle) ? high : low) = middle;
    }
    return high;
  }

  /// Whether the piece can be filled between cuts of these sizes.
  bool fits(Real left, Real right) const {
    const Index n = count(left, right);
    if (std::isfinite(left) && std::isfinite(right) && std::abs(left - right) > n * growth_) return false;
    return fill(n, left, right, largest_, 1) <= length_ * (1 + 1e-10);
  }

  /// The cells: as large as can be but for a lower limit of the large ones; where that cannot do, all are made smaller.
  std::vector<Real> cells(Real left, Real right) const {
    const Index n = count(left, right);
    std::vector<Real> sizes(static_cast<std::size_t>(n));
    Real lowest =
        std::max(std::isfinite(left) ? left : -unbounded, std::isfinite(right) ? right : -unbounded) -
        0.5 * growth_;
    if (!std::isfinite(lowest)) lowest = std::log(length_ / n) - 1;
    Real limit = largest_;
    Real share = 0;
    if (fill(n, left, right, lowest, 0) <= length_) {
      limit = bisect(lowest, largest_, [&](Real c) { return fill(n, left, right, c, 0) > length_; });
    } else {
      limit = lowest;
      share = bisect(0, 1, [&](Real s) { return fill(n, left, right, lowest, s) < length_; });
    }
    const Real sum = fill(n, left, right, limit, share, sizes.data());
    for (Real& size : sizes) size *= length_ / sum;
    return sizes;
  }

 private:
  /// Sum of n sizes: the largest below `limit`, or with `share` so far on the way to the smallest.
  Real fill(Index n, Real left, Real right, Real limit, Real share, Real* sizes = nullptr) const {
    Real sum = 0;
    for (Index i = 0; i < n; ++i) {
      const Real from_left = (i + 0.5) * growth_;
      const Real from_right = (n - i - 0.5) * growth_;
      const Real upper = std::min({limit, left + from_left, right + from_right});
      Real size = upper;
      if (share > 0) {
        const Real lower = std::max(std::isfinite(left) ? left - from_left : -unbounded,
                                    std::isfinite(right) ? right - from_right : -unbounded);
        size = std::isfinite(lower) ? (1 - share) * upper + share * lower : upper - 700 * share;
      }
      sum += std::exp(size);
      if (sizes != nullptr) sizes[i] = std::exp(size);
    }
    return sum;
  }

  /// Where a condition that holds from some point on begins to hold, to round-off.
  template <class Condition>
  static Real bisect(Real low, Real high, Condition&& holds) {
    for (int i = 0; i < 100; ++i) {
      const Real middle = 0.5 * (low + high);
      (holds(middle) ? high : low) = middle;
    }
    return 0.5 * (low + high);
  }

  Real length_, largest_, growth_;
};

/// Ends of the axis and of the zones, in order; those within round-off of each other are one.
std::vector<Real> find_cuts(Real min, Real max, const std::vector<SizeZone>& zones) {
  const Real slack = 1e-9 * (max - min);
  std::vector<Real> inner;
  for (const SizeZone& zone : zones) {
    for (const Real end : {zone.min, zone.max}) {
      if (end > min + slack && end < max - slack) inner.push_back(end);
    }
  }
  std::sort(inner.begin(), inner.end());
  std::vector<Real> cuts{min};
  for (const Real cut : inner) {
    if (cut > cuts.back() + slack) cuts.push_back(cut);
  }
  cuts.push_back(max);
  return cuts;
}

std::vector<Piece> make_pieces(const std::vector<Real>& cuts, Real size, Real growth,
                               const std::vector<SizeZone>& zones) {
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    Real largest = size;
    const Real middle = 0.5 * (cuts[k] + cuts[k + 1]);
    for (const SizeZone& zone : zones) {
      if (zone.min < middle && middle < zone.max) largest = std::min(largest, zone.size);
    }
    pieces.emplace_back(cuts[k + 1] - cuts[k], largest, growth);
  }
  return pieces;
}

/// Makes the sizes at the ends of a piece smaller until it can be filled: first the larger one, then both alike.
void make_fit(const Piece& piece, Real& left, Real& right) {
  constexpr Real less = 0.02;  // of the logarithm
  while (!piece.fits(left, right)) {
    if (left == right) {
      left = right = piece.equal_size(left);  // equal cells fit
      return;
    }
    const bool take_left = std::isfinite(left) && (!std::isfinite(right) || left > right);
    Real& larger = take_left ? left : right;
    const Real other = take_left ? right : left;
    larger = std::isfinite(other) ? std::max(other, larger - less) : larger - less;
  }
}

}  // namespace

std::vector<Real> make_graded_faces(Real min, Real max, Real size, Real growth,
                                    const std::vector<SizeZone>& zones, bool periodic, Index most) {
  if (!(max > min) || !(size > 0))
    throw std::invalid_argument("cells need a length and a size greater than 0");
  if (!(growth > 1)) throw std::invalid_argument("the growth of cells is not greater than 1");
  for (const SizeZone& zone : zones) {
    if (!(zone.size > 0)) throw std::invalid_argument("the size of cells in a zone is not greater than 0");
  }
  const std::vector<Real> cuts = find_cuts(min, max, zones);
  Real smallest = size;
  for (const SizeZone& zone : zones) smallest = std::min(smallest, zone.size);
  if (!((max - min) / smallest < 1e9)) throw std::length_error("too many cells along an axis");
  const std::vector<Piece> pieces = make_pieces(cuts, size, growth, zones);
  Index least = 0;
  for (const Piece& piece : pieces) {
    least += piece.least_count();
    if (least > most) throw std::length_error("too many cells along an axis");
  }

  std::vector<Real> at_cut(cuts.size(), unbounded);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (const std::size_t cut : {k, k + 1}) at_cut[cut] = std::min(at_cut[cut], pieces[k].equal_size());
  }
  const auto join_ends = [&] {
    at_cut.front() = at_cut.back() = periodic ? std::min(at_cut.front(), at_cut.back()) : unbounded;
  };
  join_ends();
  for (bool changed = true; changed;) {
    const std::vector<Real> before = at_cut;
    for (std::size_t k = 0; k < pieces.size(); ++k) make_fit(pieces[k], at_cut[k], at_cut[k + 1]);
    join_ends();
    changed = at_cut != before;
  }

  std::vector<Real> faces{min};
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    for (const Real cell : pieces[k].cells(at_cut[k], at_cut[k + 1])) faces.push_back(faces.back() + cell);
    faces.back() = cuts[k + 1];
    if (faces.size() > static_cast<std::size_t>(most) + 1)
      throw std::length_error("too many cells along an axis");
  }
  return faces;
}

}  // namespace pellicle
