// When a droplet on its way first touches a particle, and how hard.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::spray {

/// What a first touch or crossing returns where there is none: larger than any share of a path.
inline constexpr Real never = 2;

/// Share of the sum of radii by whose square a droplet has to be inside to count as inside although it moves out: more
/// than rounding leaves of one that has just bounced off.
inline constexpr Real inside_share = 1e-9;

/// Share of a path (0 … 1) after which a point first is within `reach` [m] of the origin, or `never`. `start` and
/// `path` [m] are those of a droplet as seen from the centre of a particle, reach is the sum of their radii. One that
/// begins inside touches at once, unless it is on the surface and moves out.
KOKKOS_INLINE_FUNCTION Real first_touch(const Vec3& start, const Vec3& path, Real reach) {
  const Real outside = norm_squared(start) - reach * reach;
  const Real along = dot(start, path);
  if (outside <= 0) return along < 0 || outside < -inside_share * reach * reach ? Real(0) : never;
  if (along >= 0) return never;
  // norm_squared(start + s path) = reach²: the smaller root, in the form that does not cancel.
  const Real discriminant = along * along - norm_squared(path) * outside;
  if (discriminant < 0) return never;
  const Real share = outside / (Kokkos::sqrt(discriminant) - along);
  return share <= 1 ? share : never;
}

/// Impact Weber number: density normal_speed² diameter / surface_tension.
KOKKOS_INLINE_FUNCTION Real weber_number(Real density, Real normal_speed, Real diameter,
                                         Real surface_tension) {
  return density * normal_speed * normal_speed * diameter / surface_tension;
}

/// Points of a function that is linear between them and constant beyond.
inline constexpr int most_efficiency_points = 16;

/// Share of the droplets that stay on a particle that they hit, as a function of the impact Weber number.
struct CaptureEfficiency {
  int points = 0;            ///< 0: all droplets stay
  Real surface_tension = 0;  ///< [N/m]
  Real weber[most_efficiency_points] = {};
  Real share[most_efficiency_points] = {};

  KOKKOS_INLINE_FUNCTION Real operator()(Real number) const {
    if (points == 0) return 1;
    int i = 0;
    while (i < points && weber[i] < number) ++i;
    if (i == 0) return share[0];
    if (i == points) return share[points - 1];
    const Real between = (number - weber[i - 1]) / (weber[i] - weber[i - 1]);
    return share[i - 1] + between * (share[i] - share[i - 1]);
  }
};

}  // namespace pellicle::spray
