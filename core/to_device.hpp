// Values of the host in device memory.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/views.hpp"

namespace pellicle {

/// A new device array with this label that holds the values.
template <class T>
DeviceArray<T> to_device(const char* label, const std::vector<T>& values) {
  DeviceArray<T> array(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)), values.size());
  const auto host = Kokkos::create_mirror_view(array);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(array, host);
  return array;
}

}  // namespace pellicle
