// Helpers that the files of the engine share.
#pragma once

#include <string>
#include <utility>

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

}  // namespace pellicle::dem
