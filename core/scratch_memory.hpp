// Device memory that the parts of a step use one after the other.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "core/types.hpp"
#include "core/views.hpp"

namespace pellicle::core {

/// One allocation that grows to the largest wish. What is taken from it holds until the next one takes.
class ScratchMemory {
 public:
  explicit ScratchMemory(std::string label) : label_(std::move(label)) {}

  /// `count` values with anything in them; with a quarter to spare where it has to grow.
  template <class T>
  DeviceArray<T> take(Index count) const {
    static_assert(alignof(T) <= 64);  // of Kokkos's allocations
    const std::size_t wanted =
        (static_cast<std::size_t>(count) * sizeof(T) + sizeof(Real) - 1) / sizeof(Real);
    if (memory_.extent(0) < wanted) {
      memory_ = {};  // before the new one is there
      memory_ =
          DeviceArray<Real>(Kokkos::view_alloc(label_, Kokkos::WithoutInitializing), wanted + wanted / 4);
    }
    return DeviceArray<T>(reinterpret_cast<T*>(memory_.data()), static_cast<std::size_t>(count));
  }

 private:
  std::string label_;
  mutable DeviceArray<Real> memory_;  // nothing that anyone could tell from outside
};

}  // namespace pellicle::core
