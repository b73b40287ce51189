// Water vapour over liquid water: how much of it the gas at the surface of a wet particle holds.
#pragma once

#include <Kokkos_Core.hpp>

#include <variant>

#include "cfd/gas_property_laws.hpp"
#include "core/model_list.hpp"
#include "core/model_variant.hpp"
#include "core/types.hpp"

namespace pellicle::heat {

/// A function of temperature and its derivative.
struct ValueAndSlope {
  Real value, slope;
};

/// Buck, J. Appl. Meteorol. 20 (1981) 1527, coefficients of his 1996 manual: within 0.2 % from 0 to 100 degC.
struct Buck {
  static constexpr core::ModelInfo info{"buck", "Buck: within 0.2 % of tables from 0 to 100 degC",
                                        "Buck, J. Appl. Meteorol. 20 (1981) 1527, coefficients of 1996"};
  /// Saturation pressure [Pa] at a temperature [K].
  KOKKOS_INLINE_FUNCTION ValueAndSlope operator()(Real temperature) const {
    const Real t = temperature - cfd::freezing_point_of_water;
    const Real pressure = cfd::buck_saturation_pressure(temperature);
    // ln p = (a - t/b) t / (c + t) + const; its derivative is [(a - 2 t/b)(c + t) - (a - t/b) t] / (c + t)2.
    const Real below = 257.14 + t;
    const Real slope =
        ((18.678 - 2 * t / 234.5) * below - (18.678 - t / 234.5) * t) / (below * below) * pressure;
    return {pressure, slope};
  }
};

/// The thesis's law (eq. 2.20): Clausius and Clapeyron with the latent heat at the boiling point throughout. 18 % high at
/// 25 degC, 2 % at 80 degC.
struct ClausiusClapeyron {
  static constexpr core::ModelInfo info{
      "clausius_clapeyron", "with 2260 kJ/kg and 373 K at 101325 Pa, as the thesis: 18 % high at 25 degC",
      "Clausius-Clapeyron with constant latent heat"};
  static constexpr Real latent_heat = 2.26e6;   ///< [J/kg]
  static constexpr Real boiling_point = 373.0;  ///< at the standard atmosphere [K]
  KOKKOS_INLINE_FUNCTION ValueAndSlope operator()(Real temperature) const {
    constexpr Real kelvin = latent_heat * cfd::water_molar_mass / cfd::gas_constant;  // L M / R
    const Real pressure =
        cfd::standard_atmosphere * Kokkos::exp(kelvin * (1 / boiling_point - 1 / temperature));
    return {pressure, pressure * kelvin / (temperature * temperature)};
  }
};

/// The family: what `heat.saturation` may name.
using SaturationLaw = std::variant<Buck, ClausiusClapeyron>;

/// Mass fraction of vapour in gas that is saturated at a temperature [K] and a total pressure [Pa], and its derivative
/// [1/K]; 1 and 0 from the boiling point on.
template <class Law>
KOKKOS_INLINE_FUNCTION ValueAndSlope saturated_fraction(const Law& law, Real temperature, Real pressure) {
  const ValueAndSlope vapour = law(temperature);
  if (!(vapour.value < pressure)) return {1, 0};
  const Real share = vapour.value / pressure;  // of the molecules
  const Real mass = share * cfd::water_molar_mass + (1 - share) * cfd::air_molar_mass;
  return {share * cfd::water_molar_mass / mass,
          vapour.slope / pressure * cfd::water_molar_mass * cfd::air_molar_mass / (mass * mass)};
}

/// The same by the law at a position of the family's list.
template <std::size_t I = 0>
KOKKOS_INLINE_FUNCTION ValueAndSlope saturated_fraction_by(int law, Real temperature, Real pressure) {
  if constexpr (I < std::variant_size_v<SaturationLaw>) {
    if (static_cast<int>(I) == law) {
      return saturated_fraction(std::variant_alternative_t<I, SaturationLaw>{}, temperature, pressure);
    }
    return saturated_fraction_by<I + 1>(law, temperature, pressure);
  } else {
    return {0, 0};
  }
}

}  // namespace pellicle::heat
