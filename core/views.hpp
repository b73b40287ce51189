// The two memory worlds: particles on the device, gas on the host.
#pragma once

#include <Kokkos_Core.hpp>

namespace pellicle {

using Device = Kokkos::DefaultExecutionSpace;
using Host = Kokkos::DefaultHostExecutionSpace;

/// One-dimensional array in device memory. Whoever allocates it owns it; others get a const reference to its owner.
template <class T>
using DeviceArray = Kokkos::View<T*, Device>;

/// One-dimensional array in host memory (gas fields: index i + nx (j + ny k)).
template <class T>
using HostArray = Kokkos::View<T*, Kokkos::LayoutRight, Host>;

using DeviceRange = Kokkos::RangePolicy<Device>;
using HostRange = Kokkos::RangePolicy<Host>;

}  // namespace pellicle
