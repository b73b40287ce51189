// Re-orders arrays of particles through memory that is free at the time.
#pragma once

#include "core/types.hpp"
#include "core/views.hpp"

namespace pellicle::dem {

/// Entry `slot` of the array becomes what was entry order(slot), for slots below count. `scratch` has room for count
/// entries and starts on a cache line.
template <class T>
void permute_array(const DeviceArray<T>& array, const DeviceArray<std::int32_t>& order, Index count,
                   const DeviceArray<Real>& scratch) {
  T* const aside = reinterpret_cast<T*>(scratch.data());
  Kokkos::parallel_for(
      "dem::permute::gather", DeviceRange(0, count),
      KOKKOS_LAMBDA(const Index slot) { aside[slot] = array(order(slot)); });
  Kokkos::parallel_for(
      "dem::permute::put_back", DeviceRange(0, count),
      KOKKOS_LAMBDA(const Index slot) { array(slot) = aside[slot]; });
}

}  // namespace pellicle::dem
