// Attraction between wet bodies: stateless functions of scalars.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/model_list.hpp"
#include "core/types.hpp"

namespace pellicle::dem {

/// Liquid bridge between two spheres, attractive (PHYSICS.md 3; P 5; Willett, Adams, Johnson & Seville, Langmuir 16
/// (2000) 9396, eqs. 17 and 14, their fit to the exact shape of the bridge):
///   F = 2π R_w γ exp{f1 − f2 exp[f3 ln S⁺ + f4 ln² S⁺]},  S⁺ = (S/2) √(R_w/V),  R_w = 2 R_i R_j/(R_i + R_j)
/// with f1 … f4 polynomials in ln V*, V* = V/R_w³, and in the contact angle θ; S is the gap, at least 1 µm. Below
/// V* = 1e-5 the simple form F = 2π R_w γ cos θ/(1 + 2.1 S⁺ + 10 S⁺²). It breaks at the gap
/// R_w (1 + θ/2)(V*^⅓ + 0.1 V*^⅔).
struct Willett {
  static constexpr core::ModelInfo info{"willett",
                                        "liquid bridge of a given volume, from the touch to its rupture",
                                        "Willett et al. 2000; plume paper, eq. 5"};

  Real bridge_volume = 0;    ///< V of one bridge [m³]
  Real surface_tension = 0;  ///< γ [N/m]
  Real contact_angle = 0;    ///< θ [rad]

  static constexpr Real least_gap = 1e-6;            ///< [m]
  static constexpr Real least_fitted_volume = 1e-5;  ///< V* [-]

  /// Attraction [N] at a gap [m], negative in contact; `radius` is R_w [m].
  KOKKOS_INLINE_FUNCTION Real force(Real gap, Real radius) const {
    constexpr Real pi = 3.14159265358979323846;
    const Real separation = gap > least_gap ? gap : least_gap;
    const Real scaled_volume = bridge_volume / (radius * radius * radius);
    const Real s = 0.5 * separation * Kokkos::sqrt(radius / bridge_volume);
    const Real scale = 2 * pi * radius * surface_tension;
    if (scaled_volume < least_fitted_volume) {
      return scale * Kokkos::cos(contact_angle) / (1 + s * (2.1 + 10 * s));
    }
    const Real l = Kokkos::log(scaled_volume);
    const Real t = contact_angle;
    const Real f1 =
        at(t, -0.44507, 0.050832, -1.1466) +
        l * (at(t, -0.1119, -0.000411, -0.1490) +
             l * (at(t, -0.012101, -0.0036456, -0.01255) + l * at(t, -0.0005, -0.0003505, -0.00029076)));
    const Real f2 = at(t, 1.9222, -0.57473, -1.2918) +
                    l * (at(t, -0.0668, -0.1201, -0.22574) + l * at(t, -0.0013375, -0.0068988, -0.01137));
    const Real f3 = at(t, 1.268, -0.01396, -0.23566) +
                    l * (at(t, 0.198, 0.092, -0.06418) +
                         l * (at(t, 0.02232, 0.02238, -0.009853) + l * at(t, 0.0008585, 0.001318, -0.00053)));
    const Real f4 = at(t, -0.010703, 0.073776, -0.34742) +
                    l * (at(t, 0.03345, 0.04543, -0.09056) + l * at(t, 0.0018574, 0.004456, -0.006257));
    const Real x = Kokkos::log(s);
    return scale * Kokkos::exp(f1 - f2 * Kokkos::exp(x * (f3 + x * f4)));
  }

  /// Gap at which the bridge breaks [m].
  KOKKOS_INLINE_FUNCTION Real rupture_gap(Real radius) const {
    const Real size = Kokkos::cbrt(bridge_volume) / radius;
    return radius * (1 + 0.5 * contact_angle) * size * (1 + 0.1 * size);
  }

 private:
  KOKKOS_INLINE_FUNCTION static Real at(Real t, Real a, Real b, Real c) { return a + t * (b + t * c); }
};

}  // namespace pellicle::dem
