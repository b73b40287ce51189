// The standard k-epsilon model and its wall functions as functions of scalars.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/types.hpp"

namespace pellicle::cfd {

/// Launder & Spalding, Comput. Methods Appl. Mech. Eng. 3 (1974) 269, table 2.1.
struct KEpsilonConstants {
  static constexpr Real c_mu = 0.09;
  static constexpr Real c_1 = 1.44;
  static constexpr Real c_2 = 1.92;
  static constexpr Real sigma_k = 1.0;
  static constexpr Real sigma_epsilon = 1.3;
  static constexpr Real kappa = 0.4187;  ///< of the log law, ibid. ...
  static constexpr Real wall = 9.793;    ///< ... and its E, of a smooth wall
};

/// Viscosity of the eddies [Pa s]: C_mu rho k^2 / epsilon, at most `largest`.
inline Real eddy_viscosity(Real density, Real k, Real epsilon, Real largest) {
  return std::min(KEpsilonConstants::c_mu * density * k * k / epsilon, largest);
}

/// Velocity scale of the gas beside a wall, C_mu^(1/4) sqrt(k) [m/s]: the friction velocity where production balances
/// dissipation.
inline Real wall_velocity_scale(Real k) {
  return std::sqrt(std::sqrt(KEpsilonConstants::c_mu) * std::max(k, Real{0}));
}

/// y* where the viscous and the logarithmic profile meet: y* = ln(E y*) / kappa.
inline constexpr Real viscous_sublayer = 11.2252;

/// U* = rho u U / tau_wall at y* = rho u y / mu, with the velocity scale u.
inline Real wall_velocity(Real y_star) {
  return y_star < viscous_sublayer ? y_star
                                   : std::log(KEpsilonConstants::wall * y_star) / KEpsilonConstants::kappa;
}

/// Resistance of the sublayer to heat over that to momentum (Jayatilleke 1969, as Launder & Spalding give it, eq. 4.8).
inline Real sublayer_resistance(Real prandtl, Real turbulent_prandtl) {
  const Real ratio = prandtl / turbulent_prandtl;
  return 9.24 * (std::pow(ratio, 0.75) - 1) * (1 + 0.28 * std::exp(-0.007 * ratio));
}

/// T* = rho c u (T_wall - T) / q at y*: conduction through the sublayer, beyond it the log law for heat. The sublayer ends
/// where the two meet.
inline Real wall_temperature(Real y_star, Real prandtl, Real turbulent_prandtl) {
  const Real p = sublayer_resistance(prandtl, turbulent_prandtl);
  const auto logarithmic = [&](Real y) {
    return turbulent_prandtl * (std::log(KEpsilonConstants::wall * y) / KEpsilonConstants::kappa + p);
  };
  // Of the two meetings the outer one: from there on the log law lies below conduction, by Newton from far outside.
  Real meeting = 1000;
  for (int i = 0; i < 20; ++i) {
    const Real gap = prandtl * meeting - logarithmic(meeting);
    const Real slope = prandtl - turbulent_prandtl / (KEpsilonConstants::kappa * meeting);
    if (!(slope > 0)) break;
    const Real change = gap / slope;
    meeting -= change;
    if (std::abs(change) < 1e-10 * meeting) break;
  }
  return y_star < meeting ? prandtl * y_star : logarithmic(y_star);
}

/// In a cell beside a wall, from the velocity scale u, the distance y and the kinematic viscosity nu: dissipation [m2/s3].
inline Real wall_dissipation(Real k, Real scale, Real distance, Real kinematic_viscosity) {
  const bool viscous = scale * distance < viscous_sublayer * kinematic_viscosity;
  return viscous ? 2 * kinematic_viscosity * k / (distance * distance)
                 : scale * scale * scale / (KEpsilonConstants::kappa * distance);
}

/// Likewise production of k [kg/m/s3] from the shear stress [Pa]; none in the viscous sublayer.
inline Real wall_production(Real shear_stress, Real density, Real scale, Real distance,
                            Real kinematic_viscosity) {
  const bool viscous = scale * distance < viscous_sublayer * kinematic_viscosity;
  return viscous ? 0 : shear_stress * shear_stress / (KEpsilonConstants::kappa * density * scale * distance);
}

/// k of an intensity (root mean square of one component over the velocity) [m2/s2].
inline Real k_of_intensity(Real intensity, Real velocity) {
  return 1.5 * intensity * intensity * velocity * velocity;
}

/// Dissipation of eddies of a length [m2/s3]: C_mu^(3/4) k^(3/2) / length.
inline Real dissipation_of_length(Real k, Real length) {
  return std::pow(KEpsilonConstants::c_mu, 0.75) * k * std::sqrt(k) / length;
}

}  // namespace pellicle::cfd
