// The shapes that walls are made of, and the point of each that is closest to a sphere's centre: stateless functions for
// host and device. All shapes are exact; those that are thin can be touched from both sides.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::dem {

/// Where a shape is closest to a point c.
struct ClosestPoint {
  Vec3 point;     ///< on the shape [m]
  Vec3 towards;   ///< unit vector from c to the wall
  Real distance;  ///< [m]; negative where c is inside or behind the shape
  bool rim;       ///< the point lies on the end, an edge or a corner, where another surface may go on
};

/// Share of a surface's own size within which a point counts as on its rim: beyond what rounding moves it.
inline constexpr Real rim_share = 1e-7;

/// An unbounded plane, solid behind: {x : normal·x = offset}.
struct PlaneShape {
  Vec3 normal;  ///< unit vector into the particles' side
  Real offset;  ///< normal · any point of the plane [m]

  KOKKOS_INLINE_FUNCTION ClosestPoint closest(const Vec3& c) const {
    const Real distance = dot(normal, c) - offset;
    return {c - distance * normal, -normal, distance, false};
  }
};

/// A segment turned about an axis: a cylinder (r equal), a cone frustum, a disc (z equal, inner radius 0) or an annulus.
/// Thin, touched from both sides.
struct RevolvedShape {
  Vec3 origin;  ///< any point of the axis [m]
  Vec3 axis;    ///< unit vector
  Real r0, z0;  ///< one end of the segment: distance from the axis, place along it from the origin [m]
  Real r1, z1;  ///< the other end

  KOKKOS_INLINE_FUNCTION ClosestPoint closest(const Vec3& c) const {
    // The closest point lies in the half plane of the axis and c: there the problem is that of a segment.
    const Vec3 from_origin = c - origin;
    const Real z = dot(from_origin, axis);
    const Vec3 across = from_origin - z * axis;
    const Real r = Kokkos::sqrt(norm_squared(across));
    const Vec3 outward = r > 0 ? (1 / r) * across : perpendicular_to(axis);
    const Real dr = r1 - r0;
    const Real dz = z1 - z0;
    const Real length_squared = dr * dr + dz * dz;
    Real share = ((r - r0) * dr + (z - z0) * dz) / length_squared;
    share = share < 0 ? Real(0) : (share > 1 ? Real(1) : share);
    const Real gap_r = r0 + share * dr - r;
    const Real gap_z = z0 + share * dz - z;
    const Real distance = Kokkos::sqrt(gap_r * gap_r + gap_z * gap_z);
    const Vec3 gap = gap_r * outward + gap_z * axis;
    // The middle of a disc is no rim.
    const bool rim = (share < rim_share && r0 > 0) || (share > 1 - rim_share && r1 > 0);
    if (distance > 0) return {c + gap, (1 / distance) * gap, distance, rim};
    const Real inverse_length = 1 / Kokkos::sqrt(length_squared);
    return {c, (inverse_length * dz) * outward - (inverse_length * dr) * axis, 0, rim};
  }
};

/// A solid box, its sides along the coordinates.
struct BoxShape {
  Vec3 min, max;  ///< [m]

  KOKKOS_INLINE_FUNCTION ClosestPoint closest(const Vec3& c) const {
    Vec3 e = c;
    int beyond = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (c[axis] < min[axis] || c[axis] > max[axis]) {
        e[axis] = c[axis] < min[axis] ? min[axis] : max[axis];
        ++beyond;
      }
    }
    if (beyond > 0) {
      const Vec3 gap = e - c;
      const Real distance = Kokkos::sqrt(norm_squared(gap));
      return {e, (1 / distance) * gap, distance, on_edge(e)};
    }
    // Inside: out through the nearest side.
    int nearest = 0;
    bool upper = false;
    Real depth = c.x - min.x;
    for (int axis = 0; axis < 3; ++axis) {
      if (c[axis] - min[axis] < depth) {
        depth = c[axis] - min[axis];
        nearest = axis;
        upper = false;
      }
      if (max[axis] - c[axis] < depth) {
        depth = max[axis] - c[axis];
        nearest = axis;
        upper = true;
      }
    }
    e[nearest] = upper ? max[nearest] : min[nearest];
    Vec3 towards{0, 0, 0};
    towards[nearest] = upper ? -1 : 1;
    return {e, towards, -depth, on_edge(e)};
  }

  /// Whether a point of the surface is on two sides or more.
  KOKKOS_INLINE_FUNCTION bool on_edge(const Vec3& e) const {
    int sides = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Real slack = rim_share * (max[axis] - min[axis]);
      sides += e[axis] - min[axis] <= slack || max[axis] - e[axis] <= slack ? 1 : 0;
    }
    return sides > 1;
  }
};

/// A triangle, thin, touched from both sides.
struct TriangleShape {
  Vec3 a, b, c;  ///< corners [m]

  /// Ericson, Real-Time Collision Detection (2005), section 5.1.5: by the region of the plane that p is above.
  KOKKOS_INLINE_FUNCTION ClosestPoint closest(const Vec3& p) const {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ap = p - a;
    const Real d1 = dot(ab, ap);
    const Real d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return from(p, a, true);
    const Vec3 bp = p - b;
    const Real d3 = dot(ab, bp);
    const Real d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return from(p, b, true);
    const Real vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return from(p, a + (d1 / (d1 - d3)) * ab, true);
    const Vec3 cp = p - c;
    const Real d5 = dot(ab, cp);
    const Real d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return from(p, c, true);
    const Real vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return from(p, a + (d2 / (d2 - d6)) * ac, true);
    const Real va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
      return from(p, b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b), true);
    }
    // Above the face. Its normal gives the distance better than the difference of two points, and at no distance too.
    const Real sum = va + vb + vc;
    const Real v = vb / sum;
    const Real w = vc / sum;
    const bool rim = v < rim_share || w < rim_share || v + w > 1 - rim_share;
    const Vec3 normal_area = cross(ab, ac);
    const Vec3 normal = (1 / Kokkos::sqrt(norm_squared(normal_area))) * normal_area;
    const Real height = dot(normal, ap);
    return {p - height * normal, height > 0 ? -normal : normal, Kokkos::abs(height), rim};
  }

 private:
  KOKKOS_INLINE_FUNCTION ClosestPoint from(const Vec3& p, const Vec3& point, bool rim) const {
    const Vec3 gap = point - p;
    const Real distance = Kokkos::sqrt(norm_squared(gap));
    if (distance > 0) return {point, (1 / distance) * gap, distance, rim};
    const Vec3 normal = cross(b - a, c - a);
    return {point, (1 / Kokkos::sqrt(norm_squared(normal))) * normal, 0, rim};
  }
};

}  // namespace pellicle::dem
