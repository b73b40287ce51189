// What a particle remembers of the droplets that hit it.
#pragma once

#include <cstdint>

#include "core/types.hpp"

namespace pellicle::spray {

struct HitRecord {
  Real hits = 0;        ///< parcels captured; a Real, so that outputs show it like any other quantity
  Real first_hit = -1;  ///< when [s]; negative: never
  Real last_hit = -1;   ///< [s]
};

}  // namespace pellicle::spray
