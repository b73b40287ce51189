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

/// Host copy of the part of an array that is in use.
template <class T>
auto host_copy(const DeviceArray<T>& array, Index count) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{},
                                             Kokkos::subview(array, std::pair<Index, Index>(0, count)));
}

}  // namespace pellicle::dem
