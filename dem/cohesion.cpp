#include "dem/cohesion.hpp"

#include <cmath>

namespace pellicle::dem {
namespace {

/// A block of particles a work item. A pair that half lists have once, within a block, is added to both; any other is in
/// the rows of both, which find the same to the last bit.
struct BridgeKernel {
  ContactInput in;
  ContactResult out;
  Willett law;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    BlockReport report = out.report(block);
    report.bridges = 0;
    const Index begin = block * contact_block;
    const Index end = Kokkos::min(begin + contact_block, in.particles.count);
    for (Index p = begin; p < end; ++p) add_row(p, begin, report);
    out.report(block) = report;
  }

 private:
  KOKKOS_INLINE_FUNCTION void add_row(Index p, Index block_begin, BlockReport& report) const {
    const PositionRadius a = in.particles.position_radius(p);
    const Real inverse_mass = in.particles.velocity_spin(p).inverse_mass;
    for (std::int32_t slot = in.list.offset(p); slot < in.list.offset(p + 1); ++slot) {
      const Index q = in.list.partner(slot);
      const PositionRadius b = in.particles.position_radius(q);
      const Vec3 d = in.domain.shortest(b.position() - a.position());
      const Real s2 = norm_squared(d);
      const Real reach = a.radius + b.radius;
      bool& bridge = out.springs.bridge(slot);
      if (!bridge && s2 >= reach * reach) continue;
      const Real partner_inverse_mass = in.particles.velocity_spin(q).inverse_mass;
      if (inverse_mass + partner_inverse_mass == 0) continue;
      const Real s = Kokkos::sqrt(s2);
      const Real gap = s - reach;
      const Real radius = 2 * a.radius * b.radius / reach;
      bridge = gap < law.rupture_gap(radius);
      if (!bridge) continue;
      const Vec3 force = (law.force(gap, radius) / s) * d;
      add(p, inverse_mass, force, report);
      const bool once = in.list.half && q >= block_begin && q < block_begin + list_block;
      if (once) add(q, partner_inverse_mass, -force, report);
    }
  }

  KOKKOS_INLINE_FUNCTION void add(Index p, Real inverse_mass, const Vec3& force, BlockReport& report) const {
    out.load(p).force += force;
    if (inverse_mass == 0) report.support_impulse += in.kick * force;
    ++report.bridges;
  }
};

}  // namespace

Real bridge_reach(const Willett& law, Real radius) {
  const Real size = std::cbrt(law.bridge_volume);
  return (1 + 0.5 * law.contact_angle) * (0.5 * size + 0.05 * size * size / radius);
}

void add_bridge_forces(const ContactInput& input, const Willett& law, const ContactResult& result) {
  Kokkos::parallel_for("dem::cohesion::add_bridge_forces",
                       Kokkos::RangePolicy<Device, Kokkos::Schedule<Kokkos::Dynamic>>(
                           0, contact_block_count(input.particles.count)),
                       BridgeKernel{input, result, law});
}

}  // namespace pellicle::dem
