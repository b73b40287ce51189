// What leaves through the sides of the domain.
#pragma once

#include <cstdint>

#include "core/types.hpp"

namespace pellicle::dem {

/// Sides of the domain: left, right (smallest and largest x), front, back (y), bottom, top (z).
inline constexpr int domain_side_count = 6;

/// What left through a side.
struct SideTotals {
  std::int64_t particles = 0;
  Real mass = 0;  ///< of moving particles [kg]
};

}  // namespace pellicle::dem
