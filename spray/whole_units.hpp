// What droplets exchange is counted in whole units: sums are the same in whatever order they are added.
#pragma once

#include <Kokkos_Core.hpp>

#include <cstdint>

#include "core/types.hpp"

namespace pellicle::spray {

/// What one unit is worth: powers of two times the mass of the largest parcel. A droplet's velocity is kept to 6e-11 m/s, its
/// mass to 6e-14, its temperature to 1e-11 K; 5e6 parcels at 100 m/s fit into a cell, and 2e5 that evaporate in it within a
/// step.
struct WholeUnits {
  Real impulse = 0;    ///< [N s]
  Real mass_time = 0;  ///< [kg s]
  Real mass = 0;       ///< of droplets that drag, and of gas that they reach [kg]
  Real water = 0;      ///< [kg]
  Real heat = 0;       ///< [J]
};

inline WholeUnits make_units(Real largest_parcel_mass) {
  return {largest_parcel_mass * 0x1p-34, largest_parcel_mass * 0x1p-55, largest_parcel_mass * 0x1p-34,
          largest_parcel_mass * 0x1p-44, largest_parcel_mass * 0x1p-24};
}

/// The nearest whole number.
KOKKOS_INLINE_FUNCTION std::int64_t whole(Real x) { return static_cast<std::int64_t>(Kokkos::round(x)); }

}  // namespace pellicle::spray
