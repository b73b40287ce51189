#include "dem/wall_bridges.hpp"

#include "dem/wall_candidates.hpp"

namespace pellicle::dem {
namespace {

/// One block of the list a work item, as for contacts.
struct WallBridgeKernel {
  ContactInput in;
  WallList list;
  WallGeometry walls;
  ContactResult out;
  DeviceArray<WallMemory> memory;
  DeviceArray<WallReport> reports;
  Willett law;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const auto wall_count = static_cast<Index>(walls.body.extent(0));
    const std::int64_t count = list.count;
    const auto begin = static_cast<Index>(block * count / wall_blocks);
    const auto end = static_cast<Index>((block + 1) * count / wall_blocks);
    WallReport* const report =
        reports.data() + static_cast<std::size_t>(block) * static_cast<std::size_t>(wall_count);
    for (Index w = 0; w < wall_count; ++w) report[w].bridges = 0;
    for (Index k = begin; k < end; ++k) add_row(k, report);
  }

 private:
  KOKKOS_INLINE_FUNCTION void add_row(Index k, WallReport* report) const {
    const Index p = list.particle(k);
    const PositionRadius self = in.particles.position_radius(p);
    const Real reach = self.radius + wall_bridge_reach(law, self.radius);
    const WallMemory before = memory(k);
    WallCandidates candidates;
    bool touches = false;
    const std::int32_t end = list.offset(k + 1);
    for (std::int32_t slot = list.offset(k); slot < end; ++slot) {
      const std::int32_t s = list.surface(slot);
      const ClosestPoint at = walls.closest(s, self.position());
      if (at.distance < reach) candidates.insert({at, s, walls.wall_of(s)});
      touches = touches || at.distance < self.radius;
    }
    WallMemory& after = memory(k);
    after.count = 0;
    if (before.count == 0 && !touches) return;
    if (candidates.crowded()) ++report[candidates[0].wall].crowded;
    candidates.select(walls, self.radius);
    Vec3 force = out.load(p).force;
    unsigned taken = 0;
    for (int i = 0; i < candidates.count(); ++i) {
      const WallCandidate& candidate = candidates[i];
      const Real gap = candidate.at.distance - self.radius;
      const int entry = before.find(WallMemory::any_wall, candidate.at.towards, taken);
      if (entry < 0 && gap >= 0) continue;
      if (entry >= 0) taken |= 1U << entry;
      after.wall[after.count] = candidate.wall;
      after.towards[after.count] = candidate.at.towards;
      ++after.count;
      const Vec3 pull = law.force(gap, 2 * self.radius) * candidate.at.towards;
      force += pull;
      const Vec3 arm = candidate.at.point - walls.body(candidate.wall).torque_about;
      WallReport& r = report[candidate.wall];
      r.impulse += in.kick * pull;
      r.angular_impulse -= in.kick * cross(arm, pull);
      ++r.bridges;
    }
    out.load(p).force = force;
  }
};

}  // namespace

void add_wall_bridge_forces(const WallInput& walls, const DeviceArray<WallMemory>& memory,
                            const ContactInput& input, const Willett& law, const ContactResult& result) {
  if (walls.geometry.body.extent(0) == 0) return;
  Kokkos::parallel_for(
      "dem::wall_bridges::add_wall_bridge_forces",
      Kokkos::RangePolicy<Device, Kokkos::Schedule<Kokkos::Dynamic>>(0, wall_blocks),
      WallBridgeKernel{input, walls.list, walls.geometry, result, memory, walls.report, law});
}

}  // namespace pellicle::dem
