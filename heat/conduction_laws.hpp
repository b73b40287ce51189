// Conduction of heat through the contact of two bodies, as stateless functions of scalars.
//
// Batchelor & O'Brien, Proc. R. Soc. Lond. A 355 (1977) 313: two spheres of conductivity k that touch over a small circle
// of radius a conduct h (T_b - T_a) with h = 2 k a. Each side is a resistance of 1 / (4 k a), so for two conductivities
// h = 4 a / (1/k_a + 1/k_b). The circle is Hertz's, a = sqrt(R* overlap).
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"

namespace pellicle::heat {

/// What of a solid matters to the heat that a contact conducts.
struct ConductingSolid {
  Real conductivity = 0;  ///< [W/m/K]; 0: no resistance of its own
  Real modulus = 0;       ///< E / (1 - nu2) that contacts have [Pa]; 0: rigid
  Real true_modulus = 0;  ///< of the real solid [Pa]
};

/// h over the radius of the circle as it is computed [W/m/K]; 0 if neither body conducts. Softened bodies touch over too
/// large a circle: under the same force its radius is as E*^(-1/3) (Hertz), and so much is h less.
inline Real conductance_per_radius(const ConductingSolid& a, const ConductingSolid& b) {
  const auto inverse = [](Real x) { return x > 0 ? 1 / x : Real(0); };
  const Real resistance = inverse(a.conductivity) + inverse(b.conductivity);
  if (!(resistance > 0)) return 0;
  const Real softness = inverse(a.modulus) + inverse(b.modulus);
  const Real true_softness = inverse(a.true_modulus) + inverse(b.true_modulus);
  return 4 / resistance * (softness > 0 ? Kokkos::cbrt(true_softness / softness) : 1);
}

/// Radius [m] of the circle where two spheres touch, of reduced radius R* and overlap [m].
KOKKOS_INLINE_FUNCTION Real contact_radius(Real reduced_radius, Real overlap) {
  return Kokkos::sqrt(reduced_radius * overlap);
}

/// Heat [J] that flows in a time dt [s] over a difference of 1 K at its start between bodies that together have the reduced
/// heat capacity C = C_a C_b / (C_a + C_b) [J/K], C_a against a wall: C (1 - exp(-h dt / C)), exact for the two alone.
KOKKOS_INLINE_FUNCTION Real conducted_heat(Real conductance, Real capacity, Real dt) {
  const Real x = conductance * dt / capacity;
  if (x < 1e-3) return conductance * dt * (1 - x / 2 * (1 - x / 3 * (1 - x / 4)));
  return -capacity * Kokkos::expm1(-x);
}

}  // namespace pellicle::heat
