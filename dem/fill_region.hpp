// Regions that can be filled with particles.
#pragma once

#include <variant>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::dem {

// Round regions lie between two points of their axis, cut off at right angles to it. Lengths in m.

struct CylinderRegion {
  Vec3 from, to;
  Real radius = 0;
  friend bool operator==(const CylinderRegion&, const CylinderRegion&) = default;
};

/// A frustum of a cone; one of the radii may be zero.
struct ConeRegion {
  Vec3 from, to;
  Real from_radius = 0, to_radius = 0;
  friend bool operator==(const ConeRegion&, const ConeRegion&) = default;
};

/// Between two cylinders around the same axis.
struct AnnulusRegion {
  Vec3 from, to;
  Real inner_radius = 0, outer_radius = 0;
  friend bool operator==(const AnnulusRegion&, const AnnulusRegion&) = default;
};

/// A flat round region: particles can enter there, but not fill it.
struct DiscRegion {
  Vec3 centre;
  Vec3 normal;  ///< of length 1
  Real radius = 0;
};

using FillRegion = std::variant<Box, CylinderRegion, ConeRegion, AnnulusRegion>;

/// Volume of a region [m³].
Real region_volume(const FillRegion& region);

/// Smallest box around a region.
Box region_bounds(const FillRegion& region);
Box region_bounds(const DiscRegion& disc);

/// Where the centres of spheres can be that lie wholly inside a region.
class Room {
 public:
  explicit Room(const FillRegion& region);

  /// Whether a sphere is inside, to 1e-9 of its radius: a slot of exactly one diameter must hold a sphere whatever the
  /// last bit of its coordinates.
  bool holds(const Vec3& centre, Real radius) const;

  /// Moves a centre to a near place where the sphere is inside; false if no place in the region holds it.
  bool bring_inside(Vec3& centre, Real radius) const;

 private:
  Real radius_at(Real along) const { return radius_ + slope_ * along; }

  bool round_ = false;
  Box box_;
  Vec3 from_, axis_{0, 0, 1};
  Real length_ = 0;
  Real radius_ = 0, slope_ = 0;  // of the outer surface: radius at `from`, and its growth along the axis
  Real slant_ = 1;  // 1/cos of half the opening angle: radial distance over that from the surface
  Real inner_ = 0;  // 0: none
};

}  // namespace pellicle::dem
