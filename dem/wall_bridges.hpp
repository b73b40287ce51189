// Liquid bridges between particles and walls: forces, and when bridges form and break.
#pragma once

#include "dem/cohesion_laws.hpp"
#include "dem/wall_contacts.hpp"

namespace pellicle::dem {

/// How far a particle can be from a wall and still be bridged [m]: the rupture distance for R_w = 2R, as between a sphere
/// and one that is endlessly large. Nothing without a bridge volume.
KOKKOS_INLINE_FUNCTION Real wall_bridge_reach(const Willett& law, Real radius) {
  return law.bridge_volume > 0 ? law.rupture_gap(2 * radius) : 0;
}

/// Adds the attraction of all bridges between particles and walls at this moment to the forces and the walls' reports. A
/// bridge forms where a particle touches a wall and lasts until the gap exceeds its rupture distance. There is one for
/// each place where contacts would be if the particle were larger by that distance (dem/wall_candidates.hpp), so that a
/// flat wall has one however many surfaces it is made of, and a corner two. A bridge is known by its direction alone and
/// slides along with the particle from one surface to the next, of whatever wall. `memory` holds the bridges of each row
/// of the list; the list must reach as far as bridges do.
void add_wall_bridge_forces(const WallInput& walls, const DeviceArray<WallMemory>& memory,
                            const ContactInput& input, const Willett& law, const ContactResult& result);

}  // namespace pellicle::dem
