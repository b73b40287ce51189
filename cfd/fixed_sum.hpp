// Sums that do not depend on the number of threads: blocks of fixed size, added in a fixed order.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "cfd/stencil.hpp"
#include "core/types.hpp"

namespace pellicle::cfd {

/// Sums over 0 <= entry < count; keeps its scratch memory between calls.
class FixedSum {
 public:
  static constexpr Index block_size = 1024;

  /// Sum of term(entry).
  template <class Term>
  Real operator()(const char* label, Index count, Term&& term) {
    if (count <= block_size) return sum_block(0, count, term);
    by_blocks(label, count, [&](Index begin, Index end) { return sum_block(begin, end, term); });
    Real sum = 0;
    for (const Real p : partial_) sum += p;
    return sum;
  }

  /// Largest of term(entry) >= 0; a term that is no number counts as 0.
  template <class Term>
  Real largest(const char* label, Index count, Term&& term) {
    if (count <= block_size) return largest_of_block(0, count, term);
    by_blocks(label, count, [&](Index begin, Index end) { return largest_of_block(begin, end, term); });
    return *std::max_element(partial_.begin(), partial_.end());
  }

 private:
  template <class Block>
  void by_blocks(const char* label, Index count, Block&& block) {
    const Index blocks = (count + block_size - 1) / block_size;
    partial_.resize(static_cast<std::size_t>(blocks));
    const auto one_block = [&](const Index b) {
      partial_[static_cast<std::size_t>(b)] = block(b * block_size, std::min(count, (b + 1) * block_size));
    };
    if (count < 4 * serial_limit) {
      for (Index b = 0; b < blocks; ++b) one_block(b);
    } else {
      Kokkos::parallel_for(label, HostRange(0, blocks), [&](const Index b) { one_block(b); });
    }
  }

  template <class Term>
  static Real largest_of_block(Index begin, Index end, Term& term) {
    Real largest = 0;
#pragma omp simd reduction(max : largest)
    for (Index e = begin; e < end; ++e) {
      const Real value = term(e);
      largest = value > largest ? value : largest;
    }
    return largest;
  }

  // Four sums side by side: additions need not wait for each other, and the order is still fixed.
  template <class Term>
  static Real sum_block(Index begin, Index end, Term& term) {
    Real s0 = 0, s1 = 0, s2 = 0, s3 = 0;
    Index e = begin;
    for (; e + 3 < end; e += 4) {
      s0 += term(e);
      s1 += term(e + 1);
      s2 += term(e + 2);
      s3 += term(e + 3);
    }
    for (; e < end; ++e) s0 += term(e);
    return (s0 + s1) + (s2 + s3);
  }

  std::vector<Real> partial_;
};

}  // namespace pellicle::cfd
