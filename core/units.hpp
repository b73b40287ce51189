// Quantities with units, as a user writes them: "5 mm", "73.5 m3/h", "80 degC".
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "core/types.hpp"

namespace pellicle::core {

/// What a number in a case file measures: a name for messages, the SI unit of a bare number, and an example.
struct Dimension {
  std::string_view name;     ///< with its article, as in "a length"
  std::string_view unit;     ///< in the syntax of UDUNITS-2; empty for a pure number
  std::string_view example;  ///< something a user could write
};

namespace dimension {
inline constexpr Dimension pure_number{"a pure number", "", "0.5"};
inline constexpr Dimension length{"a length", "m", "5 mm"};
inline constexpr Dimension volume{"a volume", "m3", "2 nL"};
inline constexpr Dimension duration{"a time", "s", "0.1 ms"};
inline constexpr Dimension mass{"a mass", "kg", "200 g"};
inline constexpr Dimension velocity{"a velocity", "m/s", "5 cm/s"};
inline constexpr Dimension acceleration{"an acceleration", "m/s2", "981 cm/s2"};
inline constexpr Dimension angular_velocity{"an angular velocity", "rad/s", "60 rpm"};
inline constexpr Dimension angle{"an angle", "rad", "30 deg"};
inline constexpr Dimension density{"a density", "kg/m3", "2.5 g/cm3"};
inline constexpr Dimension pressure{"a pressure", "Pa", "1 bar"};
inline constexpr Dimension viscosity{"a dynamic viscosity", "Pa s", "18 uPa s"};
inline constexpr Dimension mass_flow_rate{"a mass flow rate", "kg/s", "5 g/s"};
inline constexpr Dimension frequency{"a rate", "1/s", "200 1/s"};
inline constexpr Dimension flow_rate{"a volume flow rate", "m3/s", "73.5 m3/h"};
inline constexpr Dimension surface_tension{"a surface tension", "N/m", "72 mN/m"};
inline constexpr Dimension stiffness{"a stiffness", "N/m", "1 kN/m"};
inline constexpr Dimension force_per_volume{"a force per volume", "N/m3", "5 N/m3"};
inline constexpr Dimension temperature{"a temperature", "K", "80 degC"};
inline constexpr Dimension specific_energy{"an energy per mass", "J/kg", "2442 kJ/kg"};
inline constexpr Dimension heat_capacity{"a heat capacity", "J/kg/K", "1 kJ/kg/K"};
inline constexpr Dimension heat_conductivity{"a heat conductivity", "W/m/K", "26 mW/m/K"};
inline constexpr Dimension turbulent_energy{"a kinetic energy per mass", "m2/s2", "0.5 m2/s2"};
inline constexpr Dimension turbulent_dissipation{"a dissipation rate per mass", "m2/s3", "10 m2/s3"};
inline constexpr Dimension diffusivity{"a diffusivity", "m2/s", "26 mm2/s"};
inline constexpr Dimension heat_transfer{"a heat transfer coefficient", "W/m2/K", "5 W/m2/K"};
inline constexpr Dimension thermal_expansion{"a thermal expansion coefficient", "1/K", "3.4e-3 1/K"};
}  // namespace dimension

/// A quantity that cannot be used; the message reads `what is wrong; what is allowed`, without a place.
class UnitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Value in SI of a text such as "5 mm" or "0.005"; a number without unit is taken as SI.
/// Throws UnitError if the text is no number with a unit, the unit is unknown or of another dimension, or the value is
/// not finite. For set-up only: not thread-safe.
Real parse_quantity(std::string_view text, const Dimension& dimension);

/// `a number in m or a string such as "5 mm"`: what a message says is allowed.
std::string allowed_quantity(const Dimension& dimension);

}  // namespace pellicle::core
