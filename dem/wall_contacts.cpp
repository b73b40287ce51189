#include "dem/wall_contacts.hpp"

#include "dem/contact_force.hpp"
#include "dem/wall_candidates.hpp"

namespace pellicle::dem {
namespace {

/// One block of the list a work item.
template <class Laws>
struct WallContactKernel {
  ContactInput in;
  WallList list;
  WallGeometry walls;
  ContactResult out;
  DeviceArray<WallReport> reports;
  Laws laws;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const auto wall_count = static_cast<Index>(walls.body.extent(0));
    for (Index w = 0; w < wall_count; ++w) reports(block * wall_count + w).touching = 0;
    const std::int64_t count = list.count;
    const auto begin = static_cast<Index>(block * count / wall_blocks);
    const auto end = static_cast<Index>((block + 1) * count / wall_blocks);
    for (Index k = begin; k < end; ++k) add_contacts(k, reports.data() + block * wall_count);
  }

  KOKKOS_INLINE_FUNCTION void add_contacts(Index k, WallReport* report) const {
    const Index p = list.particle(k);
    const PositionRadius self = in.particles.position_radius(p);
    WallCandidates candidates;
    const std::int32_t end = list.offset(k + 1);
    for (std::int32_t slot = list.offset(k); slot < end; ++slot) {
      const std::int32_t s = list.surface(slot);
      const ClosestPoint at = walls.closest(s, self.position());
      if (at.distance < self.radius) candidates.insert({at, s, walls.wall_of(s)});
    }
    if (candidates.count() == 0) return;
    if (candidates.crowded()) ++report[candidates[0].wall].crowded;
    candidates.select(walls, self.radius);
    const VelocitySpin motion = in.particles.velocity_spin(p);
    const Real compliance = spin_compliance_of(out.touching(p), motion.inverse_mass, self.radius);
    Vec3 force = out.force(p);
    Vec3 torque = out.torque(p);
    for (int i = 0; i < candidates.count(); ++i) {
      const ContactForce f = contact(candidates[i], self, motion, compliance, report[candidates[i].wall]);
      force += f.force;
      torque += f.torque + f.rolling_torque;
    }
    out.force(p) = force;
    out.torque(p) = torque;
    out.touching_new(p) += candidates.count();
  }

  /// The force of one wall on the particle, reported.
  KOKKOS_INLINE_FUNCTION ContactForce contact(const WallCandidate& candidate, const PositionRadius& self,
                                              const VelocitySpin& motion, Real compliance,
                                              WallReport& report) const {
    const ClosestPoint& at = candidate.at;
    const WallBody& body = walls.body(candidate.wall);
    const PairParameters& pair = in.table(motion.material * in.materials + body.material);
    const Vec3& n = at.towards;
    const Vec3 dv = motion.velocity() - walls.pose(candidate.wall).velocity_at(at.point, n);
    const ContactState c{self.radius - at.distance, self.radius, 1 / motion.inverse_mass, dot(dv, n)};
    // A wall that turns does not roll: the relative spin is that of the two bodies.
    const Vec3 wall_spin = walls.pose(candidate.wall).spin;
    const Vec3 relative_spin = motion.spin() - wall_spin;
    const Vec3 mean_spin = 0.5 * (motion.spin() + wall_spin);
    ContactSprings springs;
    const ContactForce f = laws(c, pair, n, dv, at.distance * motion.spin(), at.distance, relative_spin,
                                compliance, mean_spin, springs);
    report.impulse += in.kick * f.force;
    report.angular_impulse -= in.kick * (cross(at.point - body.torque_about, f.force) + f.rolling_torque);
    ++report.touching;
    report.largest_overlap = Kokkos::max(report.largest_overlap, c.overlap / self.radius);
    report.largest_depth = Kokkos::max(report.largest_depth, c.overlap);
    report.largest_approach_speed = Kokkos::max(report.largest_approach_speed, c.approach_speed);
    return f;
  }
};

KOKKOS_INLINE_FUNCTION void add_report(WallReport& sum, const WallReport& r) {
  sum.largest_overlap = Kokkos::max(sum.largest_overlap, r.largest_overlap);
  sum.largest_depth = Kokkos::max(sum.largest_depth, r.largest_depth);
  sum.largest_approach_speed = Kokkos::max(sum.largest_approach_speed, r.largest_approach_speed);
  sum.impulse += r.impulse;
  sum.angular_impulse += r.angular_impulse;
  sum.touching += r.touching;
  sum.crowded += r.crowded;
}

}  // namespace

void add_wall_contacts(const ContactInput& input, const WallList& list, const WallGeometry& walls,
                       const ContactOptions& options, const ContactResult& result,
                       const DeviceArray<WallReport>& report) {
  if (walls.body.extent(0) == 0) return;
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

std::vector<WallReport> collect_wall_reports(const DeviceArray<WallReport>& report,
                                             const DeviceArray<WallReport>& scratch) {
  const auto walls = static_cast<Index>(report.extent(0)) / wall_blocks;
  std::vector<WallReport> sums(static_cast<std::size_t>(walls));
  if (walls == 0) return sums;
  constexpr Index blocks = wall_blocks / report_parts;
  Kokkos::parallel_for(
      "dem::wall_contacts::collect", DeviceRange(0, report_parts * walls), KOKKOS_LAMBDA(const Index item) {
        const Index part = item / walls;
        const Index wall = item % walls;
        WallReport sum;
        for (Index b = part * blocks; b < (part + 1) * blocks; ++b) {
          add_report(sum, report(b * walls + wall));
          report(b * walls + wall) = WallReport{};
        }
        scratch(item) = sum;
      });
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, scratch);
  for (Index item = 0; item < report_parts * walls; ++item)
    add_report(sums[static_cast<std::size_t>(item % walls)], host(item));
  return sums;
}

}  // namespace pellicle::dem
