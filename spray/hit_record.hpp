// What the spray has done to one particle.
#pragma once

#include <cstdint>

#include "core/types.hpp"

namespace pellicle::spray {

/// Of captured parcels; one a particle, in the particles' memory order.
struct HitRecord {
  std::int64_t hits = 0;  ///< parcels captured
  Real first_hit = -1;    ///< [s]; -1: never
  Real last_hit = -1;     ///< [s]; -1: never
};

}  // namespace pellicle::spray
