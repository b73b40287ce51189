// Properties of moist air as functions of temperature and moisture, for host and device.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"

namespace pellicle::cfd {

inline constexpr Real gas_constant = 8.314462618;        ///< R_u [J/mol/K], exact in the SI of 2019
inline constexpr Real air_molar_mass = 28.9647e-3;       ///< dry [kg/mol], U.S. Standard Atmosphere 1976
inline constexpr Real water_molar_mass = 18.01528e-3;    ///< [kg/mol]
inline constexpr Real standard_atmosphere = 101325;      ///< [Pa]
inline constexpr Real freezing_point_of_water = 273.15;  ///< 0 degC [K]

/// Saturation pressure of vapour over liquid water [Pa] at a temperature [K]; 0 to 100 degC. Buck, J. Appl. Meteorol.
/// 20 (1981) 1527, with the coefficients of his 1996 manual.
KOKKOS_INLINE_FUNCTION Real buck_saturation_pressure(Real temperature) {
  const Real t = temperature - freezing_point_of_water;
  return 611.21 * Kokkos::exp((18.678 - t / 234.5) * t / (257.14 + t));
}

/// Mass of vapour per mass of moist air whose vapour has a partial pressure [Pa] out of a total [Pa]; 1 where the
/// partial pressure reaches the total.
KOKKOS_INLINE_FUNCTION Real vapour_mass_fraction(Real vapour_pressure, Real pressure) {
  const Real share = vapour_pressure < pressure ? vapour_pressure / pressure : 1;
  return share * water_molar_mass / (share * water_molar_mass + (1 - share) * air_molar_mass);
}

/// The same for a relative humidity, 0 to 1, at a temperature [K] and a total pressure [Pa].
KOKKOS_INLINE_FUNCTION Real humid_vapour_mass_fraction(Real relative_humidity, Real temperature,
                                                       Real pressure) {
  return vapour_mass_fraction(relative_humidity * buck_saturation_pressure(temperature), pressure);
}

/// Relative humidity of air with a mass fraction of vapour at a temperature [K] and a total pressure [Pa].
KOKKOS_INLINE_FUNCTION Real relative_humidity_of(Real moisture, Real temperature, Real pressure) {
  const Real vapour = moisture / water_molar_mass;
  const Real share = vapour / (vapour + (1 - moisture) / air_molar_mass);
  return share * pressure / buck_saturation_pressure(temperature);
}

/// Density [kg/m3] of moist air as an ideal gas: p M / (R_u T), 1/M = w/M_water + (1 - w)/M_air.
KOKKOS_INLINE_FUNCTION Real ideal_gas_density(Real pressure, Real temperature, Real moisture) {
  const Real moles = moisture / water_molar_mass + (1 - moisture) / air_molar_mass;  // a kilogram
  return pressure / (gas_constant * temperature * moles);
}

/// Dynamic viscosity of air [Pa s] at a temperature [K]; U.S. Standard Atmosphere 1976, eq. 51 (Sutherland's law).
KOKKOS_INLINE_FUNCTION Real sutherland_viscosity(Real temperature) {
  return 1.458e-6 * temperature * Kokkos::sqrt(temperature) / (temperature + 110.4);
}

}  // namespace pellicle::cfd
