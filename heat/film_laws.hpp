// The film on a particle: stateless functions for host and device.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"

namespace pellicle::heat {

/// Thickness [m] of a uniform dry coating of so much solids [kg] and density [kg/m3] on a sphere of radius [m]:
/// (R^3 + 3 m / (4 pi rho))^(1/3) - R, written so that thin coatings lose no digits.
KOKKOS_INLINE_FUNCTION Real coating_thickness(Real radius, Real solids, Real solids_density) {
  constexpr Real three_over_four_pi = 0.23873241463784300365;
  const Real relative = three_over_four_pi * solids / (solids_density * radius * radius * radius);
  return radius * Kokkos::expm1(Kokkos::log1p(relative) / 3);
}

/// The same from the radius [m] of the coated sphere: R - (R^3 - 3 m / (4 pi rho))^(1/3).
KOKKOS_INLINE_FUNCTION Real coating_thickness_within(Real radius, Real solids, Real solids_density) {
  constexpr Real three_over_four_pi = 0.23873241463784300365;
  const Real relative = three_over_four_pi * solids / (solids_density * radius * radius * radius);
  return -radius * Kokkos::expm1(Kokkos::log1p(-relative) / 3);
}

}  // namespace pellicle::heat
