// Who may touch whom until somebody has moved too far: Verlet lists from a cell grid, on the device.
#pragma once

#include <type_traits>

#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/cell_grid.hpp"
#include "dem/particles.hpp"

namespace pellicle::dem {

/// How far each particle may move before the lists must be rebuilt, in terms of what it is doing: a slow particle in
/// the annulus gets little, a fast one in the spout more, so that one fast particle does not fatten every list.
struct SkinOptions {
  Real steps = 44;                ///< steps that a particle's own speed should last
  Real smallest_fraction = 0.07;  ///< of the smallest radius, at the start if it is tuned
  Real largest_fraction = 0.40;   ///< of the largest radius
  Real reach = 0;                 ///< share of a particle in the gap at which two still feel each other [m]
  bool tuned = true;              ///< whether the engine looks for a better smallest fraction, see SkinTuner
};

/// Whether lists have pairs once where they can: on a CPU that halves the work; a GPU would need atomics.
inline constexpr bool half_lists = std::is_same_v<Device, Host>;

/// Particles a block of half lists. Enough that most pairs are within a block, few enough that its sums stay in the
/// second-level cache and threads find blocks to share.
inline constexpr Index list_block = 1024;

/// Lists in compressed rows: row p is entries offset(p) … offset(p+1). Full lists have each pair twice, once at each
/// particle. Half lists have the pairs of particles of one block, list_block particles next to each other in memory, once,
/// at the first of the two, those of particles of two blocks twice, and none of two fixed particles.
/// A slot keeps its meaning until the next build, so laws with history can keep an array per slot.
struct NeighbourList {
  Index count = 0;                    ///< particles
  std::int64_t entries = 0;           ///< of all rows
  bool half = half_lists;             ///< to be set before a build
  DeviceArray<std::int32_t> offset;   ///< count + 1
  DeviceArray<std::int32_t> partner;  ///< particle index, row by row, ordered by cell, then by id
  DeviceArray<std::uint16_t>
      owner;  ///< of half lists: whose row an entry is in, counted from its block's first
  DeviceArray<Displacement> displacement;  ///< of every particle since the build
};

/// Finds pairs within reach; keeps its scratch to spare allocations, and the canonical order of the particles.
class NeighbourSearch {
 public:
  /// Radii [m] of the smallest and largest particle. Throws std::invalid_argument where a periodic axis is too short.
  NeighbourSearch(const Domain& domain, const SkinOptions& skin, Real smallest_radius, Real largest_radius);

  /// Numbers that a build may write over, for so many particles: the engine lends memory that is free at that time.
  static std::size_t scratch_size(std::size_t particles) { return 4 * sorted_stride(particles); }

  /// Finds all pairs within reach; which they are, and their order but for the numbering, depends on positions, speeds
  /// and ids alone, not on the memory order or the number of threads. Time step in s; `scratch` has scratch_size
  /// entries, on a cache line.
  void build(const Particles& particles, Real time_step, NeighbourList& list,
             const DeviceArray<Real>& scratch);

  /// Brings particles back into the domain and finds their canonical order, by cell, then by id; spoils the list.
  void find_order(const Particles& particles, Real time_step, NeighbourList& list);
  /// Throws where a periodic axis is too short for particles of this radius [m], whatever they were at first:
  /// std::invalid_argument.
  void require_room(Real largest_radius) const;

  /// From the next build on.
  void set_smallest_fraction(Real fraction) { skin_.smallest_fraction = fraction; }

  /// Particle indices in canonical order, as of the last build or search for it: the order to sort memory by.
  const DeviceArray<std::int32_t>& order() const { return order_; }

  /// The order to keep particles in memory by, as of the last build or search for the order of the cells.
  void find_memory_order(const DeviceArray<std::int32_t>& memory_order);

  /// The cells of the last build.
  const CellGrid& grid() const { return grid_; }
  /// Slots of the canonical order at which its cells begin.
  const DeviceArray<std::int32_t>& cell_start() const { return cell_start_; }
  /// Device memory held [bytes].
  std::size_t bytes() const;

 private:
  /// Room for whole vectors at the end.
  static std::size_t sorted_stride(std::size_t particles) { return (particles + 15) / 8 * 8; }
  void find_rows(const Particles& particles, NeighbourList& list, const DeviceArray<Real>& scratch);

  SkinOptions skin_;
  Real smallest_radius_;
  Real largest_radius_;
  CellGrid grid_;
  DeviceArray<std::int32_t> cell_start_;   // cells + 1
  DeviceArray<std::int32_t> order_;        // sorted slot -> particle
  DeviceArray<std::int32_t> staging_;      // rows of the blocks of one round
  DeviceArray<std::int32_t> cube_start_;   // cubes of cells
  DeviceArray<std::int32_t> block_start_;  // in the entries of the round
  std::int32_t block_capacity_ = 0;        // entries that a block has room for in staging_
};

/// Moves every particle that has left a periodic side back in.
void wrap_periodic(const Domain& domain, const Particles& particles);

}  // namespace pellicle::dem
