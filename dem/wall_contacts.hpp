// Contacts of particles with walls: which particles are near which wall, and the forces.
#pragma once

#include <type_traits>

#include "dem/contact_loop.hpp"
#include "dem/walls.hpp"

namespace pellicle::dem {

/// The particles that may touch a wall before the next build, each with a row of walls, in compressed rows.
struct WallList {
  Index count = 0;                     ///< particles near a wall
  DeviceArray<std::int32_t> particle;  ///< their indices, ascending
  DeviceArray<std::int32_t> offset;    ///< count + 1: row k is entries offset(k) … offset(k + 1)
  DeviceArray<std::int32_t> wall;      ///< wall index, row by row, ascending
};

/// What one block of a wall list reports: extremes and impulses since the report was last cleared, counts of the last
/// substep.
struct WallReport {
  Real largest_overlap = 0;         ///< largest δ/R [-]
  Real largest_depth = 0;           ///< largest δ [m]
  Real largest_approach_speed = 0;  ///< [m/s]
  Vec3 impulse{};                   ///< that walls gave to moving particles [N s]
  std::int64_t touching = 0;        ///< contacts
};

/// Blocks of a wall list, whatever its length: reports then have a fixed size, and sums do not depend on threads.
inline constexpr Index wall_blocks = std::is_same_v<Device, Host> ? 256 : 8192;

/// Finds the walls within reach of each moving particle: its radius and its allowance of the neighbour list that has just
/// been built. A fixed particle has none: it may stand in a wall as far as it likes.
void build_wall_list(const Particles& particles, const NeighbourList& neighbours,
                     const DeviceArray<DevicePlane>& walls, WallList& list);

/// Adds the contacts with walls at this moment to force, torque and touching_new and carries the reports on. `report` is
/// wall_blocks long.
void add_wall_contacts(const ContactInput& input, const WallList& list, const DeviceArray<DevicePlane>& walls,
                       const ContactOptions& options, const ContactResult& result,
                       const DeviceArray<WallReport>& report);

}  // namespace pellicle::dem
