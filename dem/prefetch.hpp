// Asking for memory ahead of its use, where the order of the accesses hides from the processor what comes next. Nothing
// depends on it but the time taken; on a GPU it does nothing.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"

namespace pellicle::dem {

/// Asks for the cache line of an address. Inlined by force, as all here: gcc 12 drops calls of functions that do nothing
/// else.
KOKKOS_FORCEINLINE_FUNCTION void prefetch([[maybe_unused]] const void* address) {
  KOKKOS_IF_ON_HOST((__builtin_prefetch(address);))
}

/// The same for a line that will be written.
KOKKOS_FORCEINLINE_FUNCTION void prefetch_to_write([[maybe_unused]] const void* address) {
  KOKKOS_IF_ON_HOST((__builtin_prefetch(address, 1);))
}

/// The same for all lines of the entries first … last of an array.
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void prefetch(const T* array, Index first, Index last) {
  constexpr int line = 64;
  const auto* const end = reinterpret_cast<const char*>(array + last);
  for (const auto* at = reinterpret_cast<const char*>(array + first); at < end; at += line) prefetch(at);
}
template <class T>
KOKKOS_FORCEINLINE_FUNCTION void prefetch_to_write(const T* array, Index first, Index last) {
  constexpr int line = 64;
  const auto* const end = reinterpret_cast<const char*>(array + last);
  for (const auto* at = reinterpret_cast<const char*>(array + first); at < end; at += line) {
    prefetch_to_write(at);
  }
}

}  // namespace pellicle::dem
