// Sums over all particles.
#include <algorithm>

#include "dem/engine.hpp"
#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

/// Particles whose sums are formed in one go; fixed, so that totals do not depend on threads.
constexpr Index sum_block = 512;

struct BlockTotals {
  Real mass, volume, kinetic_energy, potential_energy, moment, largest_speed;
  Vec3 momentum, angular_momentum;
};

void sum_blocks(const Particles& particles, const Vec3& gravity, Real half_step,
                const DeviceArray<BlockTotals>& blocks) {
  Kokkos::parallel_for(
      "dem::engine_totals::sum_blocks", DeviceRange(0, static_cast<Index>(blocks.extent(0))),
      KOKKOS_LAMBDA(const Index block) {
        BlockTotals t{};
        const Index end = Kokkos::min((block + 1) * sum_block, particles.count);
        for (Index p = block * sum_block; p < end; ++p) {
          const VelocitySpin motion = particles.velocity_spin(p);
          if (motion.inverse_mass == 0) continue;
          const PositionRadius place = particles.position_radius(p);
          const Real mass = particles.mass(p);
          const Real inertia = 0.4 * mass * place.radius * place.radius;
          const Vec3 v = motion.velocity();
          t.mass += mass;
          t.volume += sphere_volume(place.radius);
          t.moment += mass * place.z;
          t.kinetic_energy += 0.5 * mass * norm_squared(v) + 0.5 * inertia * norm_squared(motion.spin());
          t.potential_energy -= mass * dot(gravity, place.position());
          const Vec3 half_step_velocity = v - half_step * convert<Real>(particles.acceleration(p));
          const Vec3 half_step_spin =
              motion.spin() - half_step * convert<Real>(particles.angular_acceleration(p));
          t.momentum += mass * half_step_velocity;
          t.angular_momentum += mass * cross(place.position(), half_step_velocity) + inertia * half_step_spin;
          t.largest_speed = Kokkos::max(t.largest_speed, norm(v));
        }
        blocks(block) = t;
      });
}

}  // namespace

ParticleTotals Engine::compute_totals() const {
  ParticleTotals totals;
  if (particles_.count == 0) return totals;
  const auto blocks =
      make_array<BlockTotals>("dem::engine_totals::block_totals",
                              static_cast<std::size_t>((particles_.count + sum_block - 1) / sum_block));
  sum_blocks(particles_, setup_.gravity, 0.5 * setup_.time_step, blocks);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, blocks);
  Real moment = 0;
  for (std::size_t b = 0; b < host.extent(0); ++b) {
    totals.mass += host(b).mass;
    totals.volume += host(b).volume;
    totals.kinetic_energy += host(b).kinetic_energy;
    totals.potential_energy += host(b).potential_energy;
    totals.momentum += host(b).momentum;
    totals.angular_momentum += host(b).angular_momentum;
    totals.largest_speed = std::max(totals.largest_speed, host(b).largest_speed);
    moment += host(b).moment;
  }
  totals.mean_height = totals.mass > 0 ? moment / totals.mass : 0;
  return totals;
}

void Engine::take_stock(const std::vector<ParticleSeed>& seeds) {
  const LaterParticles& later = setup_.later;
  smallest_radius_ = later.count > 0 ? later.smallest_radius : seeds.empty() ? 0 : seeds.front().radius;
  largest_radius_ = later.count > 0 ? later.largest_radius : 0;
  for (const ParticleSeed& s : seeds) {
    smallest_radius_ = std::min(smallest_radius_, s.radius);
    largest_radius_ = std::max(largest_radius_, s.radius);
  }
  moving_mass_ = moving_volume_ = 0;
}

}  // namespace pellicle::dem
