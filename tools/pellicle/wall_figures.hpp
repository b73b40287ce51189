// What particles do to walls, for outputs.
#pragma once

#include <cstdint>
#include <string>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::tools {

/// What particles have done to a wall since t = 0, and how many touch it now.
struct WallFigures {
  std::string name;
  Vec3 impulse{};          ///< [N s]
  Vec3 angular_impulse{};  ///< about the wall's torque_about [N m s]
  std::int64_t contacts = 0;
};

}  // namespace pellicle::tools
