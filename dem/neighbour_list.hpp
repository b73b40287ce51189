// Who may touch whom until somebody has moved too far: Verlet lists from a cell grid, on the device.
#pragma once

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/particles.hpp"

namespace pellicle::dem {

/// The box particles live in, and the axes along which it repeats.
struct Domain {
  Box box;
  Index3 periodic{0, 0, 0};  ///< 1 along a periodic axis
  Index3 open_min{0, 0, 0};  ///< 1 where particles may leave through the lower side of an axis
  Index3 open_max{0, 0, 0};  ///< 1 where particles may leave through the upper side of an axis

  KOKKOS_INLINE_FUNCTION Vec3 length() const { return box.max - box.min; }
  /// Shortest image of a separation; plain separation along axes that do not repeat.
  KOKKOS_INLINE_FUNCTION Vec3 shortest(Vec3 d) const {
    const Vec3 l = length();
    for (int axis = 0; axis < 3; ++axis) {
      if (periodic[axis] == 0) continue;
      if (d[axis] > 0.5 * l[axis]) d[axis] -= l[axis];
      if (d[axis] < -0.5 * l[axis]) d[axis] += l[axis];
    }
    return d;
  }
};

/// How far each particle may move before the lists must be rebuilt, in terms of what it is doing: a slow particle in
/// the annulus gets little, a fast one in the spout more, so that one fast particle does not fatten every list.
struct SkinOptions {
  Real steps = 26;                ///< steps that a particle's own speed should last
  Real smallest_fraction = 0.10;  ///< of the smallest radius
  Real largest_fraction = 0.40;   ///< of the largest radius
};

/// Full lists (each pair twice, once at each particle) in compressed rows. Row p is entries offset(p) … offset(p+1).
/// A slot keeps its meaning until the next build, so laws with history can keep an array per slot.
struct NeighbourList {
  Index count = 0;                      ///< particles
  DeviceArray<std::int32_t> offset;     ///< count + 1
  DeviceArray<std::int32_t> partner;    ///< particle index, row by row, ordered by cell, then by id
  DeviceArray<Vec3> built_at;           ///< position at the build [m]
  DeviceArray<Real> allowance_squared;  ///< how far a particle may move, squared [m²]
};

/// Scratch of the search, kept to spare allocations, and the canonical order of the particles.
class NeighbourSearch {
 public:
  /// Radii [m] of the smallest and largest particle, and about how many there will be: the three shape the cell grid,
  /// and with it the canonical order. Throws std::invalid_argument where a periodic axis is too short.
  NeighbourSearch(const Domain& domain, const SkinOptions& skin, Real smallest_radius, Real largest_radius,
                  std::int64_t particles);

  /// Finds all pairs within reach; the result depends on positions, speeds and ids alone, not on the memory
  /// order or the number of threads. Time step in s.
  void build(const Particles& particles, Real time_step, NeighbourList& list);

  /// Particle indices ordered by cell, then id, as of the last build: the order to sort memory by.
  const DeviceArray<std::int32_t>& order() const { return order_; }

 private:
  void bin(const Particles& particles);

  Domain domain_;
  SkinOptions skin_;
  Real smallest_radius_;
  Real largest_radius_;
  Index3 cells_{1, 1, 1};
  Vec3 inverse_cell_size_{};
  DeviceArray<std::int32_t> cell_of_;     // particle -> cell
  DeviceArray<std::int32_t> cell_start_;  // cells + 1
  DeviceArray<std::int32_t> cell_fill_;   // cells
  DeviceArray<std::int32_t> order_;       // sorted slot -> particle
  DeviceArray<PositionRadius> sorted_;    // x, y, z, radius + allowance in sorted order
  DeviceArray<std::int32_t> pair_count_;  // particle -> row length
};

/// Moves every particle that has left a periodic side back in.
void wrap_periodic(const Domain& domain, const Particles& particles);

}  // namespace pellicle::dem
