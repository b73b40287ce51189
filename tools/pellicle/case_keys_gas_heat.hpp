// Keys of what the gas carries: its heat and its moisture, and what of the gas depends on them.
#pragma once

#include <array>
#include <optional>

#include "tools/pellicle/case_keys.hpp"

namespace pellicle::tools {

/// What a boundary says about heat and moisture.
struct CarriedKeys {
  std::optional<Real> temperature;           ///< [K]
  std::optional<cfd::Surroundings> outside;  ///< of a wall
  std::optional<Real> vapour_mass_fraction;
};

CarriedKeys take_carried_apart(const std::array<cfd::ScalarBoundary, cfd::scalar_count>& scalars);
std::array<cfd::ScalarBoundary, cfd::scalar_count> put_carried_together(const CarriedKeys& carried);

/// Density, viscosity, heat and moisture of the gas; before its boundaries.
void describe_gas_properties(core::Keys& keys, GasSpec& gas);
/// Fills in the gas options that follow from heat and moisture.
void set_gas_options(GasSpec& gas);
/// Of an inlet, where they are required, or of gas that comes back in.
void describe_incoming_gas(core::Keys& keys, const GasSpec& gas, bool required, CarriedKeys& carried);
void describe_wall_heat(core::Keys& keys, const GasSpec& gas, CarriedKeys& carried);

}  // namespace pellicle::tools
