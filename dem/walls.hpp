// Walls that particles touch: planes, alone or as the sides of a box.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"

namespace pellicle::dem {

/// An unbounded plane; particles live on the side its normal points to.
struct PlaneWall {
  std::string name;
  Vec3 point;        ///< any point of the plane [m]
  Vec3 normal;       ///< unit vector into the particles' side
  Vec3 velocity{};   ///< speed of its surface without displacement (a belt) [m/s]
  int material = 0;  ///< index into the materials
};

/// A plane as a kernel sees it.
struct DevicePlane {
  Vec3 normal;
  Real offset;  ///< normal · point [m]
  Vec3 velocity;
  std::int32_t material;

  /// Distance of a point from the plane [m], positive on the particles' side.
  KOKKOS_INLINE_FUNCTION Real distance(const Vec3& position) const { return dot(normal, position) - offset; }
};

/// Copies walls to the device.
DeviceArray<DevicePlane> make_device_planes(const std::vector<PlaneWall>& walls);

}  // namespace pellicle::dem
