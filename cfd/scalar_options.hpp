// What the gas carries with it: temperature and moisture, and what they meet at the boundaries.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "core/types.hpp"
#include "core/views.hpp"

namespace pellicle::cfd {

enum class Scalar { temperature, moisture };
inline constexpr std::size_t scalar_count = 2;
inline constexpr std::array<std::string_view, scalar_count> scalar_names{"temperature", "moisture"};
/// For arrays with one entry a scalar.
constexpr std::size_t index_of(Scalar scalar) { return static_cast<std::size_t>(scalar); }

/// No flux by diffusion. Gas that comes back in through an outlet brings what the cell has.
struct Insulated {};
/// A value at the boundary: of a wall's surface, of the gas that comes in.
struct GivenValue {
  Real value = 0;
};
/// A wall between the gas and surroundings of a given value.
struct Surroundings {
  Real value = 0;
  Real coefficient =
      0;  ///< flux per area and difference between surroundings and gas at the wall [W/m2/K], [kg/m2/s]
};
using ScalarBoundary = std::variant<Insulated, GivenValue, Surroundings>;

/// One scalar. Temperature in kelvin; moisture is the mass fraction of vapour.
struct ScalarOptions {
  Real capacity = 1;  ///< amount per mass of gas and value: c_p [J/kg/K]; 1 for the moisture
  /// The same of vapour, where it differs and moisture is solved; `capacity` then is that of dry gas.
  std::optional<Real> vapour_capacity;
  Real conductivity = 0;  ///< k [W/m/K]
  Real diffusivity =
      0;  ///< D of what diffuses relative to the gas: adds density D to the conductivity [m2/s]
  Real turbulent_number = 1;  ///< Prandtl or Schmidt number of the eddies, where there is a model of them
  bool viscous = false;       ///< the molecular viscosity adds to the conductivity: of k and epsilon
  Real initial = 0;
  Real reference = 0;      ///< amounts count from here, and the equation is solved for the difference
  Real tolerance = 1e-12;  ///< of the linear solves, relative
  Real correction_tolerance = 1e-5;  ///< change of the value, of its range, that ends the deferred correction
  int max_corrections = 10;          ///< solves of a step in which the convection scheme is corrected
};

/// What the particles give to the gas, per volume of cell and second: rate - coefficient value. Empty arrays: nothing.
/// The rate counts from the reference, and what comes with ParticleExchange::mass_source is part of it: c_p,vapour
/// (T_vapour - reference) a kilogram for heat, and 1 for vapour (whose reference is 0).
struct ScalarSource {
  HostArray<Real> rate;         ///< [W/m3]; [kg/m3/s]
  HostArray<Real> coefficient;  ///< >= 0, taken implicitly [W/m3/K]; [kg/m3/s]
};

}  // namespace pellicle::cfd
