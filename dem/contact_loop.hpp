// Contact forces between particles: the loop that most of the time goes into.
#pragma once

#include <type_traits>

#include "dem/contact_history.hpp"
#include "dem/contact_laws.hpp"
#include "dem/neighbour_list.hpp"
#include "dem/particles.hpp"

namespace pellicle::dem {

/// The extremes of some contacts.
struct ContactExtremes {
  Real largest_overlap = 0;         ///< largest δ/R of the smaller particle [-]
  Real largest_depth = 0;           ///< largest δ [m]
  Real largest_approach_speed = 0;  ///< [m/s]

  KOKKOS_INLINE_FUNCTION void include(const ContactExtremes& other) {
    largest_overlap = Kokkos::max(largest_overlap, other.largest_overlap);
    largest_depth = Kokkos::max(largest_depth, other.largest_depth);
    largest_approach_speed = Kokkos::max(largest_approach_speed, other.largest_approach_speed);
  }
};

/// What one block of particles reports about contacts with particles: extremes and impulses since the report was last cleared,
/// counts of the last substep.
struct BlockReport : ContactExtremes {
  Vec3 support_impulse{};     ///< that contacts gave to fixed particles [N s]
  std::int64_t touching = 0;  ///< touching partners, each pair counted at both particles
  std::int64_t bridges = 0;   ///< liquid bridges, each counted at both particles
};

/// Extremes and impulses go on, counts start anew.
KOKKOS_INLINE_FUNCTION BlockReport start_report(BlockReport report) {
  report.touching = 0;
  return report;
}

/// What contacts do to a particle, in one cache line: sums go straight there.
struct alignas(64) ContactLoad {
  Vec3 force{};       ///< [N]
  Vec3 torque{};      ///< [N m]
  Real touching = 0;  ///< partners and walls touched
  Real unused = 0;
};

/// Loads by contact, and the reports of the blocks. All arrays are particle- or block-sized.
struct ContactResult {
  DeviceArray<ContactLoad> load;
  DeviceArray<std::int32_t>
      touching;  ///< partners and walls touched in the last substep (rolling needs it); motion sets it
  DeviceArray<BlockReport> report;
  SpringSlots springs;  ///< of laws that remember; read and written
};

/// Everything the contact loop reads.
struct ContactInput {
  Domain domain;
  Particles particles;
  NeighbourList list;
  DeviceArray<PairParameters> table;  ///< materials²
  Index materials = 1;
  Real kick = 0;  ///< time over which these forces will act [s], for the impulses reported
  bool one_particle_material = true;  ///< all particles are of material 0: the pair table is one entry
  bool any_fixed = true;              ///< some particle may be fixed
};

/// Particles a block, a work item of the loop. On a GPU every particle is one of its own.
inline constexpr Index contact_block = half_lists ? list_block : 1;

inline Index contact_block_count(Index particles) { return (particles + contact_block - 1) / contact_block; }

/// Overwrites the loads with the contacts between particles at this moment and carries the reports on; walls add theirs afterwards (dem/wall_contacts.hpp). Deterministic: each particle sums its row in list order,
/// whoever computes it.
void compute_contact_forces(const ContactInput& input, const ContactOptions& options,
                            const ContactResult& result);

}  // namespace pellicle::dem
