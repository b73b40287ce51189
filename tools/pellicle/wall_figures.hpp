// What particles do to walls, and what leaves through open sides, for outputs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "dem/side_totals.hpp"

namespace pellicle::tools {

/// What particles and gas have done to a wall since t = 0, and how many particles touch it now.
struct WallFigures {
  std::string name;
  Vec3 impulse{};          ///< [N s]
  Vec3 angular_impulse{};  ///< about the wall's torque_about [N m s]
  std::int64_t contacts = 0;
  Vec3 gas_impulse{};  ///< that the gas gave to it since t = 0: pressure and shear [N s]
  std::optional<Real>
      heat{};  ///< that particles conducted to it since t = 0 [J]; of a wall with a temperature
};

/// What has left through each side since the start, settling included; in the order of `domain_sides`.
using SideFigures = std::array<dem::SideTotals, dem::domain_side_count>;

}  // namespace pellicle::tools
