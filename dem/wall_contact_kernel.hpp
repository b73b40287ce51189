// The kernel of wall contacts, instantiated in one file a law of friction: wall_contacts_*.cpp.
#pragma once

#include <type_traits>
#include <variant>

#include "dem/contact_force.hpp"
#include "dem/prefetch.hpp"
#include "dem/run_blocks.hpp"
#include "dem/wall_candidates.hpp"
#include "dem/wall_contacts.hpp"

namespace pellicle::dem {

/// One block of the list a work item.
template <class Laws>
struct WallContactKernel {
  static constexpr int springs = Laws::springs;

  ContactInput in;
  WallList list;
  WallGeometry walls;
  ContactResult out;
  WallSprings history;
  DeviceArray<WallReport> reports;
  Laws laws;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const auto wall_count = static_cast<Index>(walls.body.extent(0));
    for (Index w = 0; w < wall_count; ++w) reports(block * wall_count + w).touching = 0;
    const std::int64_t count = list.count;
    const auto begin = static_cast<Index>(block * count / wall_blocks);
    const auto end = static_cast<Index>((block + 1) * count / wall_blocks);
    WallReport* const report =
        reports.data() + static_cast<std::size_t>(block) * static_cast<std::size_t>(wall_count);
    for (Index k = begin; k < end; ++k) {
      prefetch_ahead(k);
      add_contacts(k, report);
    }
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
    if (candidates.count() == 0) {
      if constexpr (Laws::springs > 0) history.memory(k).count = 0;
      return;
    }
    if (candidates.crowded()) ++report[candidates[0].wall].crowded;
    candidates.select(walls, self.radius);
    const VelocitySpin motion = in.particles.velocity_spin(p);
    const Real compliance = spin_compliance_of(out.touching(p), motion.inverse_mass, self.radius);
    ContactLoad load = out.load(p);
    std::conditional_t<(springs > 0), SpringRow, NoSpringRow> row;
    row.take(*this, k, candidates);
    for (int i = 0; i < candidates.count(); ++i) {
      const ContactForce f =
          contact(candidates[i], self, motion, compliance, row[i], report[candidates[i].wall]);
      load.force += f.force;
      load.torque += f.torque + f.rolling_torque;
    }
    row.put_back(*this, k, candidates);
    load.touching += candidates.count();
    out.load(p) = load;
  }

  /// Particles near walls are far apart in memory.
  KOKKOS_FORCEINLINE_FUNCTION void prefetch_ahead(Index k) const {
    constexpr Index distance = 6;
    const Index ahead = Kokkos::min(k + distance, list.count - 1);
    const Index p = list.particle(ahead);
    prefetch(&in.particles.position_radius(p));
    prefetch(&in.particles.velocity_spin(p));
    prefetch_to_write(&out.load(p));
    if constexpr (springs > 0) {
      const WallMemory& memory = history.memory(ahead);
      prefetch_to_write(&memory.count);
      prefetch_to_write(&memory.towards[0]);
      prefetch_to_write(&history.spring(ahead * most_wall_contacts * springs));
    }
  }

  /// The force of one wall on the particle, reported.
  KOKKOS_INLINE_FUNCTION ContactForce contact(const WallCandidate& candidate, const PositionRadius& self,
                                              const VelocitySpin& motion, Real compliance,
                                              ContactSprings& spring, WallReport& report) const {
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
    const ContactForce f = laws(c, pair, n, dv, at.distance * motion.spin(), at.distance, relative_spin,
                                compliance, mean_spin, spring);
    report.impulse += in.kick * f.force;
    report.angular_impulse -= in.kick * (cross(at.point - body.torque_about, f.force) + f.rolling_torque);
    ++report.touching;
    report.include({c.overlap / self.radius, c.overlap, c.approach_speed});
    return f;
  }

  /// The springs of one particle's contacts.
  class SpringRow {
   public:
    // The entries are not set, see WallCandidates.
    KOKKOS_INLINE_FUNCTION SpringRow() {}  // NOLINT(modernize-use-equals-default): a union's would be deleted

    KOKKOS_INLINE_FUNCTION ContactSprings& operator[](int i) { return spring_[i]; }

    /// Those that the contacts had in the substep before; zero for contacts that have just begun.
    KOKKOS_INLINE_FUNCTION void take(const WallContactKernel& kernel, Index k,
                                     const WallCandidates& contacts) {
      const WallMemory& before = kernel.history.memory(k);
      const Vec3* const stored = kernel.history.spring.data() + k * most_wall_contacts * springs;
      unsigned taken = 0;
      for (int i = 0; i < contacts.count(); ++i) {
        spring_[i] = ContactSprings{};
        const int entry = before.find(contacts[i].wall, contacts[i].at.towards, taken);
        if (entry < 0) continue;
        taken |= 1U << entry;
        if constexpr (Laws::tangential_spring >= 0)
          spring_[i].tangential = stored[entry * springs + Laws::tangential_spring];
        if constexpr (Laws::rolling_spring >= 0)
          spring_[i].rolling = stored[entry * springs + Laws::rolling_spring];
      }
    }

    KOKKOS_INLINE_FUNCTION void put_back(const WallContactKernel& kernel, Index k,
                                         const WallCandidates& contacts) const {
      WallMemory& after = kernel.history.memory(k);
      Vec3* const stored = kernel.history.spring.data() + k * most_wall_contacts * springs;
      after.count = contacts.count();
      for (int i = 0; i < contacts.count(); ++i) {
        after.wall[i] = contacts[i].wall;
        after.towards[i] = contacts[i].at.towards;
        if constexpr (Laws::tangential_spring >= 0)
          stored[i * springs + Laws::tangential_spring] = spring_[i].tangential;
        if constexpr (Laws::rolling_spring >= 0)
          stored[i * springs + Laws::rolling_spring] = spring_[i].rolling;
      }
    }

   private:
    union {
      ContactSprings spring_[most_wall_contacts];
    };
  };

  /// The same for laws that do not remember.
  class NoSpringRow {
   public:
    KOKKOS_INLINE_FUNCTION ContactSprings& operator[](int) { return none_; }
    KOKKOS_INLINE_FUNCTION void take(const WallContactKernel&, Index, const WallCandidates&) const {}
    KOKKOS_INLINE_FUNCTION void put_back(const WallContactKernel&, Index, const WallCandidates&) const {}

   private:
    ContactSprings none_;
  };
};

/// The same for each law of friction, compiled in a file of its own.
template <class Tangential>
void run_wall_contacts(const WallInput& walls, const ContactInput& input, const Tangential& tangential,
                       const ContactOptions& options, const ContactResult& result) {
  std::visit(
      [&](const auto& normal, const auto& rolling) {
        using Laws = ContactLaws<std::decay_t<decltype(normal)>, Tangential, std::decay_t<decltype(rolling)>>;
        run_blocks("dem::wall_contact_kernel::block", wall_blocks, 8,
                   WallContactKernel<Laws>{input, walls.list, walls.geometry, result, walls.springs,
                                           walls.report, Laws{normal, tangential, rolling}});
      },
      options.normal, options.rolling);
}

}  // namespace pellicle::dem
