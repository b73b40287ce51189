#include "dem/wall_list.hpp"

#include "dem/engine_arrays.hpp"
#include "dem/wall_bridges.hpp"

namespace pellicle::dem {
namespace {

/// The surfaces that a moving particle can reach before the next search.
struct NearWalls {
  Particles particles;
  NeighbourList neighbours;
  Real allowances;
  WallGeometry walls;
  Willett cohesion;

  /// Calls `visit(s)` for each of them until it returns true; says whether it did.
  template <class Visit>
  KOKKOS_INLINE_FUNCTION bool visit(Index p, const Visit& visit) const {
    if (particles.velocity_spin(p).inverse_mass == 0) return false;
    const PositionRadius self = particles.position_radius(p);
    const Real reach = self.radius + wall_bridge_reach(cohesion, self.radius) +
                       allowances * static_cast<Real>(neighbours.displacement(p).allowance);
    for (Index s = 0; s < walls.primitives; ++s) {
      const WallSurface& surface = walls.surface(s);
      const Vec3 c = walls.pose(surface.wall).to_wall(self.position());
      if (surface.closest(c).distance < reach + walls.body(surface.wall).allowance && visit(s)) return true;
    }
    for (Index g = 0; g < static_cast<Index>(walls.grid.extent(0)); ++g) {
      const MeshGrid& grid = walls.grid(g);
      const Vec3 c = walls.pose(grid.wall).to_wall(self.position());
      if (visit_triangles(walls, grid, c, reach + walls.body(grid.wall).allowance, visit)) return true;
    }
    return false;
  }
};

struct StopAtFirst {
  KOKKOS_INLINE_FUNCTION bool operator()(Index) const { return true; }
};

struct Count {
  std::int32_t& number;
  KOKKOS_INLINE_FUNCTION bool operator()(Index) const {
    ++number;
    return false;
  }
};

struct Store {
  const DeviceArray<std::int32_t>& surface;
  std::int32_t& entry;
  KOKKOS_INLINE_FUNCTION bool operator()(Index s) const {
    surface(entry++) = s;
    return false;
  }
};

/// Apart from the scan, which on several threads looks at everything twice.
void find_near(const NearWalls& walls, const DeviceArray<std::uint8_t>& near) {
  Kokkos::parallel_for(
      "dem::wall_list::find_near", DeviceRange(0, walls.particles.count),
      KOKKOS_LAMBDA(const Index p) { near(p) = walls.visit(p, StopAtFirst{}) ? 1 : 0; });
}

/// Writes the particles near a wall in ascending order, as many as there is room for; returns how many there are.
std::int32_t collect_near(const DeviceArray<std::uint8_t>& near, Index count,
                          const DeviceArray<std::int32_t>& particle) {
  const auto room = static_cast<std::int32_t>(particle.extent(0));
  std::int32_t found = 0;
  Kokkos::parallel_scan(
      "dem::wall_list::collect_near", DeviceRange(0, count),
      KOKKOS_LAMBDA(const Index p, std::int32_t& rank, const bool final) {
        if (near(p) == 0) return;
        if (final && rank < room) particle(rank) = p;
        ++rank;
      },
      found);
  return found;
}

/// Row lengths, summed up to offsets; returns the total.
std::int32_t find_offsets(const NearWalls& near, const WallList& list) {
  std::int32_t total = 0;
  Kokkos::parallel_scan(
      "dem::wall_list::offsets", DeviceRange(0, list.count + 1),
      KOKKOS_LAMBDA(const Index k, std::int32_t& sum, const bool final) {
        if (final) list.offset(k) = sum;
        if (k < list.count) near.visit(list.particle(k), Count{sum});
      },
      total);
  return total;
}

void fill_rows(const NearWalls& near, const WallList& list) {
  Kokkos::parallel_for(
      "dem::wall_list::fill_rows", DeviceRange(0, list.count), KOKKOS_LAMBDA(const Index k) {
        std::int32_t entry = list.offset(k);
        near.visit(list.particle(k), Store{list.surface, entry});
      });
}

}  // namespace

void build_wall_list(const Particles& particles, const NeighbourList& neighbours, Real allowances,
                     const WallGeometry& walls, WallList& list, const Willett& cohesion) {
  list.count = 0;
  if (walls.body.extent(0) == 0) return;
  const NearWalls near{particles, neighbours, allowances, walls, cohesion};
  ensure_size(list.near, static_cast<std::size_t>(particles.count), "dem::wall_list::near");
  find_near(near, list.near);
  std::int32_t found = collect_near(list.near, particles.count, list.particle);
  if (found > static_cast<std::int32_t>(list.particle.extent(0))) {
    ensure_size(list.particle, static_cast<std::size_t>(found), "dem::wall_list::particle");
    found = collect_near(list.near, particles.count, list.particle);
  }
  list.count = found;
  ensure_size(list.offset, static_cast<std::size_t>(found) + 1, "dem::wall_list::offset");
  const std::int32_t total = find_offsets(near, list);
  ensure_size(list.surface, static_cast<std::size_t>(total), "dem::wall_list::surface");
  fill_rows(near, list);
}

}  // namespace pellicle::dem
