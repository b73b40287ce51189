#include "dem/wall_contacts.hpp"

#include "dem/contact_force.hpp"
#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

/// Whether a moving particle can reach a wall before the next build.
struct NearWall {
  Particles particles;
  NeighbourList neighbours;
  DeviceArray<DevicePlane> walls;

  KOKKOS_INLINE_FUNCTION Real reach(Index p) const {
    return reach_of(particles.position_radius(p), neighbours.displacement(p));
  }
  KOKKOS_INLINE_FUNCTION bool operator()(Index p, Index wall, Real reach) const {
    return walls(wall).distance(particles.position_radius(p).position()) < reach;
  }
  KOKKOS_INLINE_FUNCTION bool any(Index p) const {
    if (particles.velocity_spin(p).inverse_mass == 0) return false;
    const Real far = reach(p);
    for (Index w = 0; w < static_cast<Index>(walls.extent(0)); ++w) {
      if ((*this)(p, w, far)) return true;
    }
    return false;
  }
};

/// Writes the particles near a wall in ascending order, as many as there is room for; returns how many there are.
std::int32_t collect_near(const NearWall& near, const DeviceArray<std::int32_t>& particle) {
  const auto room = static_cast<std::int32_t>(particle.extent(0));
  std::int32_t found = 0;
  Kokkos::parallel_scan(
      "dem::wall_contacts::collect_near", DeviceRange(0, near.particles.count),
      KOKKOS_LAMBDA(const Index p, std::int32_t& rank, const bool final) {
        if (!near.any(p)) return;
        if (final && rank < room) particle(rank) = p;
        ++rank;
      },
      found);
  return found;
}

/// Row lengths, summed up to offsets; returns the total.
std::int32_t find_offsets(const NearWall& near, const WallList& list) {
  const auto walls = static_cast<Index>(near.walls.extent(0));
  const auto particle = list.particle;
  const auto offset = list.offset;
  const Index count = list.count;
  std::int32_t total = 0;
  Kokkos::parallel_scan(
      "dem::wall_contacts::offsets", DeviceRange(0, count + 1),
      KOKKOS_LAMBDA(const Index k, std::int32_t& sum, const bool final) {
        if (final) offset(k) = sum;
        if (k == count) return;
        const Index p = particle(k);
        const Real reach = near.reach(p);
        for (Index w = 0; w < walls; ++w) sum += near(p, w, reach) ? 1 : 0;
      },
      total);
  return total;
}

void fill_rows(const NearWall& near, const WallList& list) {
  const auto walls = static_cast<Index>(near.walls.extent(0));
  Kokkos::parallel_for(
      "dem::wall_contacts::fill_rows", DeviceRange(0, list.count), KOKKOS_LAMBDA(const Index k) {
        const Index p = list.particle(k);
        const Real reach = near.reach(p);
        std::int32_t entry = list.offset(k);
        for (Index w = 0; w < walls; ++w) {
          if (near(p, w, reach)) list.wall(entry++) = w;
        }
      });
}

/// One block of the list a work item.
template <class Laws>
struct WallContactKernel {
  ContactInput in;
  WallList list;
  DeviceArray<DevicePlane> walls;
  ContactResult out;
  DeviceArray<WallReport> reports;
  Laws laws;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    WallReport report = reports(block);
    report.touching = 0;
    const std::int64_t count = list.count;
    const auto begin = static_cast<Index>(block * count / wall_blocks);
    const auto end = static_cast<Index>((block + 1) * count / wall_blocks);
    for (Index k = begin; k < end; ++k) add_contacts(k, report);
    reports(block) = report;
  }

  KOKKOS_INLINE_FUNCTION void add_contacts(Index k, WallReport& report) const {
    const Index p = list.particle(k);
    const PositionRadius self = in.particles.position_radius(p);
    const VelocitySpin motion = in.particles.velocity_spin(p);
    Vec3 force = out.force(p);
    Vec3 torque = out.torque(p);
    std::int32_t contacts = 0;
    const std::int32_t end = list.offset(k + 1);
    for (std::int32_t slot = list.offset(k); slot < end; ++slot) {
      const DevicePlane wall = walls(list.wall(slot));
      const Real distance = wall.distance(self.position());
      if (distance >= self.radius) continue;
      const PairParameters& pair = in.table(motion.material * in.materials + wall.material);
      const Vec3 n = -wall.normal;
      const Vec3 dv = motion.velocity() - wall.velocity;
      const ContactState c{self.radius - distance, self.radius, 1 / motion.inverse_mass, dot(dv, n)};
      const Real compliance = spin_compliance_of(out.touching(p), motion.inverse_mass, self.radius);
      ContactSprings springs;
      const ContactForce f = laws(c, pair, n, dv, distance * motion.spin(), distance, motion.spin(),
                                  compliance, 0.5 * motion.spin(), springs);
      force += f.force;
      torque += f.torque + f.rolling_torque;
      ++contacts;
      report.impulse += in.kick * f.force;
      report.largest_overlap = Kokkos::max(report.largest_overlap, c.overlap / self.radius);
      report.largest_depth = Kokkos::max(report.largest_depth, c.overlap);
      report.largest_approach_speed = Kokkos::max(report.largest_approach_speed, c.approach_speed);
    }
    if (contacts == 0) return;
    out.force(p) = force;
    out.torque(p) = torque;
    out.touching_new(p) += contacts;
    report.touching += contacts;
  }
};

}  // namespace

void build_wall_list(const Particles& particles, const NeighbourList& neighbours,
                     const DeviceArray<DevicePlane>& walls, WallList& list) {
  list.count = 0;
  if (walls.extent(0) == 0) return;
  const NearWall near{particles, neighbours, walls};
  std::int32_t found = collect_near(near, list.particle);
  if (found > static_cast<std::int32_t>(list.particle.extent(0))) {
    ensure_size(list.particle, static_cast<std::size_t>(found), "dem::wall_contacts::particle");
    found = collect_near(near, list.particle);
  }
  list.count = found;
  ensure_size(list.offset, static_cast<std::size_t>(found) + 1, "dem::wall_contacts::offset");
  const std::int32_t total = find_offsets(near, list);
  ensure_size(list.wall, static_cast<std::size_t>(total), "dem::wall_contacts::wall");
  fill_rows(near, list);
}

void add_wall_contacts(const ContactInput& input, const WallList& list, const DeviceArray<DevicePlane>& walls,
                       const ContactOptions& options, const ContactResult& result,
                       const DeviceArray<WallReport>& report) {
  if (walls.extent(0) == 0) return;
  std::visit(
      [&](const auto& normal, const auto& tangential, const auto& rolling) {
        using Laws = ContactLaws<std::decay_t<decltype(normal)>, std::decay_t<decltype(tangential)>,
                                 std::decay_t<decltype(rolling)>>;
        Kokkos::parallel_for(
            "dem::wall_contacts::block",
            Kokkos::RangePolicy<Device, Kokkos::Schedule<Kokkos::Dynamic>>(0, wall_blocks),
            WallContactKernel<Laws>{input, list, walls, result, report, Laws{normal, tangential, rolling}});
      },
      options.normal, options.tangential, options.rolling);
}

}  // namespace pellicle::dem
