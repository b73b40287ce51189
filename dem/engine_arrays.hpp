// Helpers that the files of the engine share.
#pragma once

#include <string>
#include <utility>

#include "core/checkpoint.hpp"
#include "core/views.hpp"

namespace pellicle::dem {

template <class T>
DeviceArray<T> make_array(const char* label, std::size_t n) {
  return DeviceArray<T>(Kokkos::view_alloc(std::string(label)), n);
}

/// Makes an array at least `size` long; contents are not kept when it grows.
template <class T>
void ensure_size(DeviceArray<T>& array, std::size_t size, const char* label) {
  if (array.extent(0) < size) {
    array = DeviceArray<T>(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)),
                           size + size / 8 + 16);
  }
}

/// Device memory that an array holds [bytes].
template <class T>
std::size_t bytes_of(const DeviceArray<T>& array) {
  return array.span() * sizeof(T);
}

/// Host copy of the part of an array that is in use.
template <class T>
auto host_copy(const DeviceArray<T>& array, Index count) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{},
                                             Kokkos::subview(array, std::pair<Index, Index>(0, count)));
}

/// Reads the first `size` entries of an array from a checkpoint; it grows if it is shorter.
template <class T>
void read_array(const core::CheckpointReader& file, const char* name, Index size, DeviceArray<T>& array,
                const char* label) {
  ensure_size(array, static_cast<std::size_t>(size), label);
  const auto part = Kokkos::subview(array, std::pair<Index, Index>(0, size));
  const auto host = Kokkos::create_mirror_view(part);
  file.read_into(name, host);
  Kokkos::deep_copy(part, host);
}

/// Rows that belong to particles, after a re-sort: particle p < count, which was order(p), has the row it had then, or
/// none (-1) if it came after the first `known`.
inline void follow_rows(const DeviceArray<std::int32_t>& order, Index known, Index count,
                        DeviceArray<std::int32_t>& row, DeviceArray<std::int32_t>& next) {
  ensure_size(next, static_cast<std::size_t>(count), "dem::engine_arrays::rows");
  const auto from = row;
  const auto to = next;
  Kokkos::parallel_for(
      "dem::engine_arrays::follow_rows", DeviceRange(0, count),
      KOKKOS_LAMBDA(const Index p) { to(p) = order(p) < known ? from(order(p)) : -1; });
  std::swap(row, next);
}

}  // namespace pellicle::dem
