// How a droplet moves in a gas: drag and gravity, integrated exactly over a step with the drag it begins with.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::spray {

/// Drag of a sphere over that of Stokes at this Reynolds number (density diameter speed / viscosity): Schiller &
/// Naumann, VDI-Zeitung 77 (1933) 318, up to 1000, and a drag coefficient of 0.44 beyond.
KOKKOS_INLINE_FUNCTION Real drag_over_stokes(Real reynolds) {
  return reynolds < 1000 ? 1 + 0.15 * Kokkos::pow(reynolds, 0.687) : 0.44 / 24 * reynolds;
}

/// What of the gas a droplet feels.
struct DragGas {
  Real density = 0;    ///< [kg/m3]
  Real viscosity = 0;  ///< [Pa s]; 0: there is no gas, and no drag
};

/// Inverse [1/s] of the time in which a droplet of this density [kg/m3] and diameter [m] loses its slip (its norm in
/// m/s): 18 viscosity drag_over_stokes / (density diameter²).
KOKKOS_INLINE_FUNCTION Real relaxation_rate(const DragGas& gas, Real droplet_density, Real diameter,
                                            Real slip) {
  if (!(gas.viscosity > 0)) return 0;
  const Real reynolds = gas.density * diameter * slip / gas.viscosity;
  return 18 * gas.viscosity * drag_over_stokes(reynolds) / (droplet_density * diameter * diameter);
}

/// Velocity [m/s] at the end of a step, and the way [m] that was gone in it.
struct DropletStep {
  Vec3 velocity, path;
};

/// Solves dv/dt = rate (u − v) + g over dt [s] for constant rate, u and g:
///   v' = v + (rate (u − v) + g) f,  path = v dt + (rate (u − v) + g) (dt − f)/rate,  f = (1 − exp(−rate dt))/rate.
/// Written so that nothing is divided by a rate that may be 0.
KOKKOS_INLINE_FUNCTION DropletStep move_droplet(const Vec3& velocity, const Vec3& gas_velocity, Real rate,
                                                const Vec3& gravity, Real dt) {
  const Real x = rate * dt;
  // (1 − e^−x)/x and (x − 1 + e^−x)/x²; the series where the formulas lose digits.
  const bool small = x < 1e-3;
  const Real f = small ? 1 - x * (1.0 / 2 - x * (1.0 / 6 - x / 24)) : -Kokkos::expm1(-x) / x;
  const Real g = small ? 0.5 - x * (1.0 / 6 - x * (1.0 / 24 - x / 120)) : (1 - f) / x;
  const Vec3 acceleration = rate * (gas_velocity - velocity) + gravity;
  return {velocity + (dt * f) * acceleration, dt * velocity + (dt * dt * g) * acceleration};
}

}  // namespace pellicle::spray
