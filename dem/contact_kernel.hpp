// The kernels of the contact loop, for any choice of laws: one particle a work item for full lists, as a GPU wants them,
// and the loop of dem/block_kernel.hpp for half lists. Each family of instances has a file of its own,
// contact_loop_*.cpp.
#pragma once

#include <algorithm>
#include <type_traits>
#include <variant>

#include "dem/contact_force.hpp"
#include "dem/contact_loop.hpp"
#include "dem/run_blocks.hpp"
#ifndef KOKKOS_ENABLE_CUDA
#include "dem/block_kernel.hpp"
#endif

namespace pellicle::dem {

struct Accumulator {
  Vec3 force{}, torque{};
};

/// One particle a work item, over full lists, in double precision.
template <class Laws>
struct ParticleContactKernel {
  ContactInput in;
  ContactResult out;
  Laws laws;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    BlockReport report = start_report(out.report(block));
    const Index begin = block * contact_block;
    const Index end = Kokkos::min(begin + contact_block, in.particles.count);
    for (Index p = begin; p < end; ++p) compute(p, report);
    out.report(block) = report;
  }

  KOKKOS_INLINE_FUNCTION void compute(Index p, BlockReport& report) const {
    Accumulator sum;
    std::int32_t contacts = 0;
    const PositionRadius a = in.particles.position_radius(p);
    const VelocitySpin ma = in.particles.velocity_spin(p);
    const std::int32_t last = in.list.offset(p + 1);
    for (std::int32_t slot = in.list.offset(p); slot < last; ++slot) {
      const Index q = in.list.partner(slot);
      const PositionRadius b = in.particles.position_radius(q);
      const Vec3 d = in.domain.shortest(b.position() - a.position());
      const Real s2 = norm_squared(d);
      const Real reach = a.radius + b.radius;
      bool goes_on = false;
      if constexpr (Laws::springs > 0) {
        goes_on = out.springs.held(slot);
        out.springs.held(slot) = false;
      }
      if (s2 >= reach * reach) continue;
      const VelocitySpin mb = in.particles.velocity_spin(q);
      const Real mass_sum = ma.inverse_mass + mb.inverse_mass;
      if (mass_sum == 0) continue;  // two fixed particles may overlap
      PairState<Real> pair{d,
                           reach * reach - s2,
                           a.radius,
                           b.radius,
                           ma.velocity() - mb.velocity(),
                           ma.spin() + mb.spin(),
                           ma.spin() - mb.spin(),
                           mass_sum};
      if constexpr (Laws::needs_compliance) {
        pair.spin_compliance = spin_compliance_of(out.touching(p), ma.inverse_mass, a.radius) +
                               spin_compliance_of(out.touching(q), mb.inverse_mass, b.radius);
      }
      ContactSprings springs;
      if constexpr (Laws::tangential_spring >= 0) {
        if (goes_on) springs.tangential = out.springs.get(Laws::tangential_spring, slot);
      }
      if constexpr (Laws::rolling_spring >= 0) {
        if (goes_on) springs.rolling = out.springs.get(Laws::rolling_spring, slot);
      }
      const PairForce<Real> f =
          find_pair_force(laws, in.table(ma.material * in.materials + mb.material), pair, springs);
      if constexpr (Laws::springs > 0) out.springs.held(slot) = true;
      if constexpr (Laws::tangential_spring >= 0) {
        out.springs.set(Laws::tangential_spring, slot, springs.tangential);
      }
      if constexpr (Laws::rolling_spring >= 0) out.springs.set(Laws::rolling_spring, slot, springs.rolling);
      sum.force += f.friction - f.pull * d;
      sum.torque += (0.5 * (1 + f.skew)) * cross(d, f.friction) + f.rolling_torque;
      ++contacts;
      ++report.touching;
      report.include({f.overlap / Kokkos::min(a.radius, b.radius), f.overlap, f.approach_speed});
    }
    if (ma.inverse_mass == 0) report.support_impulse += in.kick * sum.force;
    out.load(p) = {sum.force, sum.torque, static_cast<Real>(contacts), 0};
  }
};

template <class Laws>
void run_contact_kernel(const ContactInput& in, const Laws& laws, const ContactResult& out) {
  const Index blocks = contact_block_count(in.particles.count);
#ifndef KOKKOS_ENABLE_CUDA
  if (in.list.half) {
    if (in.domain.repeats()) {
      run_blocks("dem::contact_kernel::block_periodic", blocks, 1,
                 BlockContactKernel<Laws, false, true>{in, out, laws});
    } else if (in.one_particle_material) {
      run_blocks("dem::contact_kernel::block_one_material", blocks, 1,
                 BlockContactKernel<Laws, true, false>{in, out, laws});
    } else {
      run_blocks("dem::contact_kernel::block", blocks, 1,
                 BlockContactKernel<Laws, false, false>{in, out, laws});
    }
    return;
  }
#endif
  Kokkos::parallel_for("dem::contact_kernel::particle", DeviceRange(0, blocks),
                       ParticleContactKernel<Laws>{in, out, laws});
}

/// Runs the loop with one law of friction and any of the others.
template <class Tangential>
void run_contact_loop(const ContactInput& input, const Tangential& tangential, const ContactOptions& options,
                      const ContactResult& result) {
  std::visit(
      [&](const auto& normal, const auto& rolling) {
        using Laws = ContactLaws<std::decay_t<decltype(normal)>, Tangential, std::decay_t<decltype(rolling)>>;
        run_contact_kernel(input, Laws{normal, tangential, rolling}, result);
      },
      options.normal, options.rolling);
}

}  // namespace pellicle::dem
