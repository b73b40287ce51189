// A part of the domain that outputs look at.
#pragma once

#include <Kokkos_Core.hpp>

#include <string>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::spray {

/// A box along the axes, or a cylinder between two points.
struct ZoneShape {
  bool is_box = true;
  Vec3 min, max;                ///< of a box [m]
  Vec3 from, axis;              ///< of a cylinder: centre of one end [m], unit vector to the other
  Real length = 0, radius = 0;  ///< [m]

  /// Whether a place is in it, or no further outside than `margin` [m] along each of its directions.
  KOKKOS_INLINE_FUNCTION bool contains(const Vec3& x, Real margin = 0) const {
    if (is_box) {
      return x.x >= min.x - margin && x.x <= max.x + margin && x.y >= min.y - margin &&
             x.y <= max.y + margin && x.z >= min.z - margin && x.z <= max.z + margin;
    }
    const Vec3 d = x - from;
    const Real along = dot(d, axis);
    const Real reach = radius + margin;
    return along >= -margin && along <= length + margin && norm_squared(d - along * axis) <= reach * reach;
  }
};

/// The numbers that make it what it is, for checkpoints.
std::string describe(const ZoneShape& shape);

}  // namespace pellicle::spray
