// Forces of walls on particles, and of particles on walls.
#pragma once

#include <type_traits>
#include <vector>

#include "dem/contact_loop.hpp"
#include "dem/wall_history.hpp"
#include "dem/wall_list.hpp"

namespace pellicle::dem {

/// What one block of a wall list reports of one wall: extremes and impulses since the report was last cleared, counts of
/// the last substep.
struct WallReport : ContactExtremes {
  Vec3 impulse{};             ///< that the wall gave to moving particles [N s]
  Vec3 angular_impulse{};     ///< that particles gave to the wall, about its torque_about [N m s]
  std::int64_t touching = 0;  ///< contacts
  std::int64_t bridges = 0;   ///< liquid bridges
  std::int64_t crowded = 0;   ///< particles that overlapped more surfaces than are compared
};

/// Blocks of a wall list, whatever its length: reports then have a fixed size, and sums do not depend on threads.
inline constexpr Index wall_blocks = std::is_same_v<Device, Host> ? 256 : 4096;

/// Groups of blocks summed on the device before the host sees them, so that little crosses over.
inline constexpr Index report_parts = 16;

/// Everything that contacts with walls need of the walls; entry block × walls + wall of `report` is one block's of one wall.
struct WallInput {
  WallGeometry geometry;
  WallList list;
  WallSprings springs;
  DeviceArray<WallReport> report;
};

/// Adds the contacts with walls at this moment to the loads and carries springs and reports on.
void add_wall_contacts(const WallInput& walls, const ContactInput& input, const ContactOptions& options,
                       const ContactResult& result);

/// Reports of each wall over all blocks, in an order that does not depend on threads; clears `report`. `scratch` is
/// report_parts × walls long.
std::vector<WallReport> collect_wall_reports(const DeviceArray<WallReport>& report,
                                             const DeviceArray<WallReport>& scratch);

}  // namespace pellicle::dem
