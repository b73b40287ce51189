// What a particle takes from the gas during one gas step, heat and vapour, as stateless functions of scalars.
//
// A particle of heat capacity C and temperature y, in gas of temperature T and vapour mass fraction w:
//   C dy/dt = H (T - y) - L e,   e = G (w*(y) - w),   H = h A,   G = density k_m A
// (thesis eqs. 2.13 and 2.18, with the sign of a loss and the gas's density, which it leaves out). With w*(y) replaced by
// a straight line of slope s the solution is an exponential, and the means of heat and evaporation over the step are
// linear in T and w: so a cell can be solved together with all its particles, whatever the step. docs/theory/heat.md.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"
#include "heat/saturation_laws.hpp"

namespace pellicle::heat {

/// Enthalpies of water; temperatures [K].
struct WaterEnthalpy {
  Real reference;        ///< from which all enthalpies count [K]
  Real latent;           ///< of evaporation at the reference [J/kg]
  Real vapour_capacity;  ///< c_p of vapour [J/kg/K]
  Real liquid_capacity;  ///< [J/kg/K]

  /// Of evaporation at a temperature; energy closes only with this dependence (Kirchhoff) [J/kg].
  KOKKOS_INLINE_FUNCTION Real evaporation(Real temperature) const {
    return latent + (vapour_capacity - liquid_capacity) * (temperature - reference);
  }
  /// Of vapour over that of liquid at the reference [J/kg].
  KOKKOS_INLINE_FUNCTION Real vapour(Real temperature) const {
    return latent + vapour_capacity * (temperature - reference);
  }
};

/// How well gas and particle are connected.
struct Conductances {
  Real heat;    ///< H = h A [W/K]
  Real vapour;  ///< G = density k_m A [kg/s]
};

/// What G is to be multiplied with so that G (w* - w) is Stefan's flow, density k_m A ln(1 + B) with
/// B = (w* - w) / (1 - w*) (Spalding 1953); `surface` is w*. Held finite where the surface boils.
KOKKOS_INLINE_FUNCTION Real stefan_factor(Real surface, Real gas) {
  constexpr Real least_dry_share = 1e-6;
  const Real dry = Kokkos::fmax(1 - surface, least_dry_share);
  const Real b = (surface - gas) / dry;
  // Below 1e-8 the quotient is 1 - b/2, and its rounding would be larger than that.
  return (Kokkos::fabs(b) > 1e-8 ? Kokkos::log1p(b) / b : 1 - b / 2) / dry;
}

/// The mean over a step of 1 - exp(-t/tau), x = step / tau >= 0: how far, in the mean, the particle has come on its way.
KOKKOS_INLINE_FUNCTION Real mean_progress(Real x) {
  if (x < 1e-3) return x / 2 * (1 - x / 3 * (1 - x / 4));  // 1 + expm1(-x) / x cancels
  return 1 + Kokkos::expm1(-x) / x;
}

/// Mean heat [W] to a particle and mean evaporation [kg/s] from it over the step, as functions of the gas: of its
/// temperature over the reference, `warmth` [K], and of its vapour mass fraction. In one cache line.
struct alignas(64) ParticleResponse {
  Real heat_0, heat_warmth, heat_vapour;
  Real evaporation_0, evaporation_warmth, evaporation_vapour;
  Real conductance;  ///< H [W/K]; 0: the particle is out of it
  Real slope;        ///< of the line in place of w* [1/K]; negative: what evaporates is given

  KOKKOS_INLINE_FUNCTION bool is_given() const { return slope < 0; }
  KOKKOS_INLINE_FUNCTION Real heat(Real warmth, Real vapour) const {
    return heat_0 + heat_warmth * warmth + heat_vapour * vapour;
  }
  KOKKOS_INLINE_FUNCTION Real evaporation(Real warmth, Real vapour) const {
    return evaporation_0 + evaporation_warmth * warmth + evaporation_vapour * vapour;
  }
};

/// A particle at the start of a step.
struct ParticleHeat {
  Real warmth;    ///< temperature over the reference [K]
  Real capacity;  ///< of its solid and its film [J/K]
};

/// What evaporates is given: `evaporation` [kg/s], constant over the step [s]; 0 for a dry particle.
KOKKOS_INLINE_FUNCTION ParticleResponse limited_response(const ParticleHeat& p, Real heat_conductance,
                                                         Real evaporation, Real latent, Real step) {
  // y - y0 tends to T - y0 - L e / H.
  const Real progress = mean_progress(heat_conductance * step / p.capacity);
  const Real of_difference = heat_conductance * (1 - progress);
  return {latent * evaporation * progress - of_difference * p.warmth,
          of_difference,
          0,
          evaporation,
          0,
          0,
          heat_conductance,
          -1};
}

/// As much evaporates or condenses as the straight line through w* at the start, of slope s [1/K], says.
KOKKOS_INLINE_FUNCTION ParticleResponse wet_response(const ParticleHeat& p, const Conductances& k,
                                                     const ValueAndSlope& surface, Real latent, Real step) {
  const Real total = k.heat + latent * k.vapour * surface.slope;  // [W/K]
  const Real gain = mean_progress(total * step / p.capacity) / total;
  const Real heat_warmth = k.heat * (1 - gain * k.heat);
  const Real heat_vapour = -k.heat * gain * latent * k.vapour;
  const Real evaporation_warmth = k.vapour * surface.slope * gain * k.heat;
  const Real evaporation_vapour = -k.vapour * (1 - surface.slope * gain * latent * k.vapour);
  return {-heat_warmth * p.warmth - heat_vapour * surface.value,
          heat_warmth,
          heat_vapour,
          -evaporation_warmth * p.warmth - evaporation_vapour * surface.value,
          evaporation_warmth,
          evaporation_vapour,
          k.heat,
          surface.slope};
}

/// Slope of w* for wet_response: of the chord from the start to the particle's end of the step in gas of this warmth and
/// vapour. With the tangent a cold particle would meet its wet-bulb temperature at too little evaporation, and a step
/// far longer than its time constant would carry it past the gas. `saturation(temperature)` gives w* and its slope, `start`
/// is that at the particle's start.
template <class Saturation>
KOKKOS_INLINE_FUNCTION ValueAndSlope find_chord(const Saturation& saturation, const ValueAndSlope& start,
                                                const ParticleHeat& p, const Conductances& k,
                                                const WaterEnthalpy& water, Real gas_warmth, Real gas_vapour,
                                                Real step) {
  constexpr Real close = 1e-2;  // [K]: the slope of w* changes by 6 % a kelvin
  constexpr int most_rounds = 8;
  const Real latent = water.evaporation(water.reference + p.warmth);
  const Real pull = k.heat * (gas_warmth - p.warmth) - latent * k.vapour * (start.value - gas_vapour);  // [W]
  // It does not get further than it would at this pace; most are here in a short step.
  if (Kokkos::fabs(pull) * step < close * p.capacity) return start;
  ValueAndSlope end = start;
  Real slope = start.slope, change = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const Real total = k.heat + latent * k.vapour * slope;
    const Real found = -pull / total * Kokkos::expm1(-total * step / p.capacity);
    const Real miss = found - change;
    if (Kokkos::fabs(miss) < close) break;
    // Newton's step for change = found(slope(change)), whose right side falls the more the steeper the chord.
    Real steeper = 0;
    if (round > 0) steeper = Kokkos::fmax(latent * k.vapour * (end.slope - slope) / total, Real(0));
    change += miss / (1 + steeper);
    end = saturation(water.reference + p.warmth + change);
    slope = Kokkos::fabs(change) > 1e-6 ? (end.value - start.value) / change : start.slope;
  }
  return {start.value, slope};
}

}  // namespace pellicle::heat
