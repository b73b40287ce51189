// Loops over one grid of the multigrid, and how cells are joined.
#pragma once

#include <algorithm>

#include "cfd/stencil.hpp"

namespace pellicle::cfd {

inline constexpr Index multigrid_chunk =
    4096;  ///< entries that a thread takes at a time; fewer do not pay for waking another thread

/// Calls f(begin, end) for parts of begin..end.
template <class F>
void for_chunks(const char* label, Index begin, Index end, F&& f) {
  const Index parts = (end - begin + multigrid_chunk - 1) / multigrid_chunk;
  if (parts <= 2) {
    f(begin, end);
    return;
  }
  Kokkos::parallel_for(label, HostRange(0, parts), [&](const Index part) {
    f(begin + part * multigrid_chunk, std::min(end, begin + (part + 1) * multigrid_chunk));
  });
}

/// Calls f(k) for every plane across z.
template <class F>
void for_planes(const char* label, const Stencil& s, F&& f) {
  if (s.cells() < 4 * multigrid_chunk) {
    for (Index k = 0; k < s.n.z; ++k) f(k);
  } else {
    Kokkos::parallel_for(label, HostRange(0, s.n.z), [&](const Index k) { f(k); });
  }
}

/// Calls f(j, k) for every row.
template <class F>
void for_lines(const char* label, const Stencil& s, F&& f) {
  if (s.cells() < 4 * multigrid_chunk) {
    for (Index r = 0; r < s.rows(); ++r) f(r % s.n.y, r / s.n.y);
  } else {
    Kokkos::parallel_for(label, HostRange(0, s.rows()), [&](const Index r) { f(r % s.n.y, r / s.n.y); });
  }
}

/// Number of aggregates along an axis, and the cells of one.
inline Index first_child(Index coarse, bool joined) { return joined ? 2 * coarse : coarse; }
inline Index last_child(Index coarse, bool joined, Index n) {
  return joined ? std::min(2 * coarse + 1, n - 1) : coarse;
}

}  // namespace pellicle::cfd
