// Sums that do not depend on the number of threads: blocks of fixed size, added in a fixed order.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
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

  /// Several sums in one go through memory: block(begin, end, sums) adds what a block of entries has.
  template <std::size_t n, class Block>
  std::array<Real, n> several(const char* label, Index count, Block&& block) {
    std::array<Real, n> total{};
    parts_.resize(n * static_cast<std::size_t>((count + block_size - 1) / block_size));
    by_blocks(label, count, [&](Index begin, Index end) {
      std::array<Real, n> sums{};
      block(begin, end, sums);
      const auto block_number = static_cast<std::size_t>(begin) / block_size;
      std::copy(sums.begin(), sums.end(), parts_.data() + n * block_number);
      return Real{0};
    });
    for (std::size_t i = 0; i < parts_.size(); ++i) total[i % n] += parts_[i];
    return total;
  }

  /// Largest of term(entry) >= 0; a term that is no number counts as 0.
  template <class Term>
  Real largest(const char* label, Index count, Term&& term) {
    if (count <= block_size) return largest_of_block(0, count, term);
    by_blocks(label, count, [&](Index begin, Index end) { return largest_of_block(begin, end, term); });
    return *std::max_element(partial_.begin(), partial_.end());
  }

  /// Likewise of two terms.
  template <class Terms>
  std::array<Real, 2> largest_two(const char* label, Index count, Terms&& terms) {
    parts_.resize(2 * static_cast<std::size_t>((count + block_size - 1) / block_size));
    by_blocks(label, count, [&](Index begin, Index end) {
      const std::decay_t<Terms> own = terms;
      Real first = 0;
      Real second = 0;
#pragma omp simd reduction(max : first, second)
      for (Index e = begin; e < end; ++e) {
        const std::array<Real, 2> values = own(e);
        first = values[0] > first ? values[0] : first;
        second = values[1] > second ? values[1] : second;
      }
      const std::size_t at = 2 * (static_cast<std::size_t>(begin) / block_size);
      parts_[at] = first;
      parts_[at + 1] = second;
      return Real{0};
    });
    std::array<Real, 2> result{};
    for (std::size_t i = 0; i < parts_.size(); ++i) result[i % 2] = std::max(result[i % 2], parts_[i]);
    return result;
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

  // A copy of the term: what a loop reads through a reference it reads anew for every entry.
  template <class Term>
  static Real largest_of_block(Index begin, Index end, const Term& term) {
    const Term own = term;
    Real largest = 0;
#pragma omp simd reduction(max : largest)
    for (Index e = begin; e < end; ++e) {
      const Real value = own(e);
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

  std::vector<Real> partial_, parts_;
};

}  // namespace pellicle::cfd
