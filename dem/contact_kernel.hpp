// The kernels of the contact loop, for any choice of laws: one particle a work item on a GPU, a block of particles with
// the touching pairs side by side on a CPU. Each family of instances has a file of its own, contact_loop_*.cpp.
#pragma once

#include <type_traits>
#include <variant>

#include "dem/contact_force.hpp"
#include "dem/contact_loop.hpp"

namespace pellicle::dem {

struct Accumulator {
  Vec3 force{}, torque{};
};

/// Extremes and impulses go on, counts start anew.
KOKKOS_INLINE_FUNCTION BlockReport start_report(BlockReport report) {
  report.touching = 0;
  return report;
}

/// One pair contact seen from particle i. `d` from i to its partner, with |d|² = s2 < (r_i + r_j)².
template <class Laws>
KOKKOS_FORCEINLINE_FUNCTION ContactForce pair_force(const Laws& laws, const PairParameters& pair,
                                                    const Vec3& d, Real s2, Real ri, Real rj,
                                                    Real inverse_mass_sum, const Vec3& dv, const Vec3& spin_i,
                                                    const Vec3& spin_j, Real spin_compliance, ContactState& c,
                                                    ContactSprings& springs) {
  const Real s = Kokkos::sqrt(s2);
  const Real inverse_s = 1 / s;
  const Real sum = ri + rj;
  const Vec3 n = inverse_s * d;
  // Lever arms to the plane through the circle where the spheres meet: l_i + l_j = s exactly.
  const Real skew = (ri - rj) * sum * inverse_s;
  const Real li = 0.5 * (s + skew);
  const Real lj = 0.5 * (s - skew);
  c.overlap = sum - s;
  c.reduced_radius = ri * rj / sum;
  c.reduced_mass = 1 / inverse_mass_sum;
  c.approach_speed = dot(dv, n);
  return laws(c, pair, n, dv, li * spin_i + lj * spin_j, li, spin_i - spin_j, spin_compliance,
              0.5 * (spin_i + spin_j), springs);
}

/// One particle a work item: the form for a GPU.
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
      const Real compliance = spin_compliance_of(out.touching(p), ma.inverse_mass, a.radius) +
                              spin_compliance_of(out.touching(q), mb.inverse_mass, b.radius);
      ContactState c;
      ContactSprings springs = Laws::unpack(out.springs.at(Laws::springs, slot), goes_on);
      const ContactForce f =
          pair_force(laws, in.table(ma.material * in.materials + mb.material), d, s2, a.radius, b.radius,
                     mass_sum, ma.velocity() - mb.velocity(), ma.spin(), mb.spin(), compliance, c, springs);
      if constexpr (Laws::springs > 0) {
        out.springs.held(slot) = true;
        Laws::pack(springs, out.springs.at(Laws::springs, slot));
      }
      sum.force += f.force;
      sum.torque += f.torque + f.rolling_torque;
      ++contacts;
      ++report.touching;
      report.largest_overlap =
          Kokkos::max(report.largest_overlap, c.overlap / Kokkos::min(a.radius, b.radius));
      report.largest_depth = Kokkos::max(report.largest_depth, c.overlap);
      report.largest_approach_speed = Kokkos::max(report.largest_approach_speed, c.approach_speed);
    }
    if (ma.inverse_mass == 0) report.support_impulse += in.kick * sum.force;
    out.force(p) = sum.force;
    out.torque(p) = sum.torque;
    out.touching_new(p) = contacts;
  }
};

/// Touching pairs of a block side by side, one array a quantity, so that the laws run in vector registers.
template <int Springs>
struct PairBuffer {
  static constexpr int capacity = 256;
  static constexpr int components = Springs > 0 ? 3 * Springs : 1;
  static constexpr int spring_capacity = Springs > 0 ? capacity : 1;
  alignas(64) Real dx[capacity], dy[capacity], dz[capacity], s2[capacity];
  alignas(64) Real ri[capacity], rj[capacity], inverse_mass_sum[capacity], compliance[capacity];
  alignas(64) Real dvx[capacity], dvy[capacity], dvz[capacity];
  alignas(64) Real wix[capacity], wiy[capacity], wiz[capacity];
  alignas(64) Real wjx[capacity], wjy[capacity], wjz[capacity];
  // On return, the force in d and the torque in dv: written over what was read.
  alignas(64) Real overlap[capacity], approach[capacity];
  alignas(64) std::int32_t pair[capacity];
  alignas(64) Real spring[components][spring_capacity];
  std::int32_t owner[capacity];
  std::int32_t slot[spring_capacity];  // of the neighbour list, where the springs belong
  int count = 0;
};

/// A block of particles a work item: scan rows, gather touching pairs, run the laws over them in vectors, add up.
template <class Laws, bool OnePair>
struct BlockContactKernel {
  using Buffer = PairBuffer<Laws::springs>;

  ContactInput in;
  ContactResult out;
  Laws laws;
  bool repeats;

  void operator()(const Index block) const {
    Buffer buffer;
    Accumulator sum[contact_block];
    std::int32_t contacts[contact_block] = {};
    BlockReport report = start_report(out.report(block));
    const Index begin = block * contact_block;
    const Index end = begin + contact_block < in.particles.count ? begin + contact_block : in.particles.count;
    for (Index p = begin; p < end; ++p) {
      std::int32_t slot = in.list.offset(p);
      const std::int32_t last = in.list.offset(p + 1);
      while (slot < last) {
        const std::int32_t stop = last - slot < row_part ? last : slot + row_part;
        if (buffer.count + (stop - slot) > Buffer::capacity) flush(buffer, sum, report);
        contacts[p - begin] += gather(p, p - begin, slot, stop, buffer);
        slot = stop;
      }
    }
    flush(buffer, sum, report);
    for (Index p = begin; p < end; ++p) {
      report.touching += contacts[p - begin];
      if (in.particles.velocity_spin(p).inverse_mass == 0) {
        report.support_impulse += in.kick * sum[p - begin].force;
      }
      out.force(p) = sum[p - begin].force;
      out.torque(p) = sum[p - begin].torque;
      out.touching_new(p) = contacts[p - begin];
    }
    out.report(block) = report;
  }

 private:
  static constexpr bool needs_compliance = Laws::needs_compliance;
  static constexpr bool remembers = Laws::springs > 0;
  static constexpr int components = 3 * Laws::springs;
  static constexpr std::int32_t row_part =
      64;  // of a row scanned at once; a large particle may have many partners

  /// Appends the touching partners among slots [slot, stop) of particle p.
  int gather(Index p, std::int32_t owner, std::int32_t slot, std::int32_t stop, Buffer& buffer) const {
    std::int32_t partner[row_part + 1];
    [[maybe_unused]] std::int32_t slot_of[remembers ? row_part + 1 : 1];
    [[maybe_unused]] bool goes_on[remembers ? row_part + 1 : 1];
    const PositionRadius* const place = in.particles.position_radius.data();
    const VelocitySpin* const motion = in.particles.velocity_spin.data();
    const std::int32_t* const row = in.list.partner.data();
    [[maybe_unused]] bool* const held = out.springs.held.data();
    const PositionRadius a = place[p];
    int found = 0;
    // Without a branch: whether a neighbour touches cannot be predicted.
    for (std::int32_t s = slot; s < stop; ++s) {
      const std::int32_t q = row[s];
      const PositionRadius b = place[q];
      Vec3 d{b.x - a.x, b.y - a.y, b.z - a.z};
      if (repeats) d = in.domain.shortest(d);
      const Real reach = a.radius + b.radius;
      partner[found] = q;
      const bool touches = norm_squared(d) < reach * reach;
      if constexpr (remembers) {
        slot_of[found] = s;
        goes_on[found] = held[s];
        held[s] = touches;
      }
      found += touches ? 1 : 0;
    }
    const VelocitySpin ma = motion[p];
    const Real compliance_a =
        needs_compliance ? spin_compliance_of(out.touching(p), ma.inverse_mass, a.radius) : Real(0);
    int taken = 0;
    for (int k = 0; k < found; ++k) {
      const std::int32_t q = partner[k];
      const PositionRadius b = place[q];
      const VelocitySpin mb = motion[q];
      const Real mass_sum = ma.inverse_mass + mb.inverse_mass;
      if (mass_sum == 0) {  // two fixed particles may overlap
        if constexpr (remembers) held[slot_of[k]] = false;
        continue;
      }
      Vec3 d{b.x - a.x, b.y - a.y, b.z - a.z};
      if (repeats) d = in.domain.shortest(d);
      const int c = buffer.count + taken++;
      buffer.dx[c] = d.x;
      buffer.dy[c] = d.y;
      buffer.dz[c] = d.z;
      buffer.s2[c] = norm_squared(d);
      buffer.ri[c] = a.radius;
      buffer.rj[c] = b.radius;
      buffer.inverse_mass_sum[c] = mass_sum;
      if constexpr (needs_compliance) {
        buffer.compliance[c] = compliance_a + spin_compliance_of(out.touching(q), mb.inverse_mass, b.radius);
      }
      buffer.dvx[c] = ma.vx - mb.vx;
      buffer.dvy[c] = ma.vy - mb.vy;
      buffer.dvz[c] = ma.vz - mb.vz;
      buffer.wix[c] = ma.wx;
      buffer.wiy[c] = ma.wy;
      buffer.wiz[c] = ma.wz;
      buffer.wjx[c] = mb.wx;
      buffer.wjy[c] = mb.wy;
      buffer.wjz[c] = mb.wz;
      if constexpr (!OnePair) buffer.pair[c] = ma.material * in.materials + mb.material;
      buffer.owner[c] = owner;
      if constexpr (remembers) {
        buffer.slot[c] = slot_of[k];
        const Real* const spring = &out.springs.at(Laws::springs, slot_of[k])->x;
        for (int e = 0; e < components; ++e) buffer.spring[e][c] = goes_on[k] ? spring[e] : Real(0);
      }
    }
    buffer.count += taken;
    return taken;
  }

  /// Runs the laws over the gathered pairs and adds the results to their owners, in list order.
  void flush(Buffer& b, Accumulator* sum, BlockReport& report) const {
    const int n = b.count;
    b.count = 0;
    const PairParameters* const table = in.table.data();
    const PairParameters only = table[0];
    const Laws law = laws;
    Real largest_overlap = report.largest_overlap;
    Real largest_depth = report.largest_depth;
    Real largest_approach = report.largest_approach_speed;
#pragma omp simd reduction(max : largest_overlap, largest_depth, largest_approach)
    for (int c = 0; c < n; ++c) {
      ContactState state;
      ContactSprings springs;
      constexpr int t = 3 * Laws::tangential_spring;
      constexpr int r = 3 * Laws::rolling_spring;
      if constexpr (t >= 0) springs.tangential = {b.spring[t][c], b.spring[t + 1][c], b.spring[t + 2][c]};
      if constexpr (r >= 0) springs.rolling = {b.spring[r][c], b.spring[r + 1][c], b.spring[r + 2][c]};
      const ContactForce f = pair_force(
          law, OnePair ? only : table[b.pair[c]], Vec3{b.dx[c], b.dy[c], b.dz[c]}, b.s2[c], b.ri[c], b.rj[c],
          b.inverse_mass_sum[c], Vec3{b.dvx[c], b.dvy[c], b.dvz[c]}, Vec3{b.wix[c], b.wiy[c], b.wiz[c]},
          Vec3{b.wjx[c], b.wjy[c], b.wjz[c]}, needs_compliance ? b.compliance[c] : Real(0), state, springs);
      if constexpr (t >= 0) {
        b.spring[t][c] = springs.tangential.x;
        b.spring[t + 1][c] = springs.tangential.y;
        b.spring[t + 2][c] = springs.tangential.z;
      }
      if constexpr (r >= 0) {
        b.spring[r][c] = springs.rolling.x;
        b.spring[r + 1][c] = springs.rolling.y;
        b.spring[r + 2][c] = springs.rolling.z;
      }
      b.dx[c] = f.force.x;
      b.dy[c] = f.force.y;
      b.dz[c] = f.force.z;
      b.dvx[c] = f.torque.x + f.rolling_torque.x;
      b.dvy[c] = f.torque.y + f.rolling_torque.y;
      b.dvz[c] = f.torque.z + f.rolling_torque.z;
      const Real smaller = b.ri[c] < b.rj[c] ? b.ri[c] : b.rj[c];
      const Real relative = state.overlap / smaller;
      largest_overlap = relative > largest_overlap ? relative : largest_overlap;
      largest_depth = state.overlap > largest_depth ? state.overlap : largest_depth;
      largest_approach = state.approach_speed > largest_approach ? state.approach_speed : largest_approach;
    }
    report.largest_overlap = largest_overlap;
    report.largest_depth = largest_depth;
    report.largest_approach_speed = largest_approach;
    for (int c = 0; c < n; ++c) {
      Accumulator& s = sum[b.owner[c]];
      s.force += Vec3{b.dx[c], b.dy[c], b.dz[c]};
      s.torque += Vec3{b.dvx[c], b.dvy[c], b.dvz[c]};
      if constexpr (remembers) {
        Real* const spring = &out.springs.at(Laws::springs, b.slot[c])->x;
        for (int e = 0; e < components; ++e) spring[e] = b.spring[e][c];
      }
    }
  }
};

template <class Laws>
void run_contact_kernel(const ContactInput& in, const Laws& laws, const ContactResult& out) {
  const Index blocks = contact_block_count(in.particles.count);
  if constexpr (std::is_same_v<Device, Host>) {
    const bool repeats = in.domain.periodic.x + in.domain.periodic.y + in.domain.periodic.z != 0;
    // Dense and dilute blocks cost differently: threads take them as they come. Blocks do not share results.
    const Kokkos::RangePolicy<Device, Kokkos::Schedule<Kokkos::Dynamic>> range(0, blocks,
                                                                               Kokkos::ChunkSize(4));
    if (in.one_particle_material) {
      Kokkos::parallel_for("dem::contact_kernel::block_one_material", range,
                           BlockContactKernel<Laws, true>{in, out, laws, repeats});
    } else {
      Kokkos::parallel_for("dem::contact_kernel::block", range,
                           BlockContactKernel<Laws, false>{in, out, laws, repeats});
    }
  } else {
    Kokkos::parallel_for("dem::contact_kernel::particle", DeviceRange(0, blocks),
                         ParticleContactKernel<Laws>{in, out, laws});
  }
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
