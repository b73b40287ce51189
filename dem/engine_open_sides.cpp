// Particles that leave through open sides, and those that are where they cannot be.
#include "core/error.hpp"
#include "dem/engine.hpp"
#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

/// Outer steps between two re-sorts of memory: neighbours drift apart slowly, a sort costs about one list build.
constexpr std::int64_t sort_interval = 64;

/// How many particles are beyond an open side, and the highest index of one that is beyond a closed side.
struct Outside {
  std::int32_t left = 0;
  std::int32_t lost = -1;
};

/// 0 inside, 1 beyond an open side, 2 beyond a closed one. Periodic sides are crossed freely until the next wrap.
KOKKOS_INLINE_FUNCTION int classify(const Domain& domain, const PositionRadius& place) {
  const Vec3 x = place.position();
  int result = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(x[axis] == x[axis])) result = 2;
    if (domain.periodic[axis] != 0) continue;
    if (x[axis] < domain.box.min[axis]) result = domain.open_min[axis] != 0 ? Kokkos::max(result, 1) : 2;
    if (x[axis] > domain.box.max[axis]) result = domain.open_max[axis] != 0 ? Kokkos::max(result, 1) : 2;
  }
  return result;
}

Outside find_outside(const Domain& domain, const Particles& particles) {
  const auto place = particles.position_radius;
  std::int32_t left = 0;
  std::int32_t lost = -1;
  Kokkos::parallel_reduce(
      "dem::engine_open_sides::find_outside", DeviceRange(0, particles.count),
      KOKKOS_LAMBDA(const Index p, std::int32_t& l, std::int32_t& w) {
        const int where = classify(domain, place(p));
        if (where == 1) ++l;
        if (where == 2 && p > w) w = p;
      },
      Kokkos::Sum<std::int32_t>(left), Kokkos::Max<std::int32_t>(lost));
  return {left, lost < 0 ? -1 : lost};
}

/// The side that a particle which left is beyond, in the order left, right, front, back, bottom, top; the first of several.
KOKKOS_INLINE_FUNCTION int side_left_through(const Domain& domain, const PositionRadius& place) {
  const Vec3 x = place.position();
  for (int axis = 0; axis < 3; ++axis) {
    if (domain.periodic[axis] != 0) continue;
    if (x[axis] < domain.box.min[axis]) return 2 * axis;
    if (x[axis] > domain.box.max[axis]) return 2 * axis + 1;
  }
  return 0;
}

/// New place of every particle that stays, in the present order, and from the end backwards the particles that leave;
/// returns how many stay.
Index rank_staying(const Domain& domain, const Particles& particles, const DeviceArray<std::int32_t>& order) {
  const auto place = particles.position_radius;
  std::int32_t staying = 0;
  Kokkos::parallel_scan(
      "dem::engine_open_sides::rank_staying", DeviceRange(0, particles.count),
      KOKKOS_LAMBDA(const Index p, std::int32_t& rank, const bool final) {
        const bool stays = classify(domain, place(p)) != 1;
        if (final) order(stays ? rank : particles.count - 1 - (p - rank)) = p;
        if (stays) ++rank;
      },
      staying);
  return staying;
}

/// What left through each side: the particles order(staying) … order(count − 1), one work item a side, so that sums do not
/// depend on threads.
void sum_leaving(const Domain& domain, const Particles& particles, const DeviceArray<std::int32_t>& order,
                 Index staying, const DeviceArray<SideTotals>& sides) {
  Kokkos::parallel_for(
      "dem::engine_open_sides::sum_leaving", DeviceRange(0, domain_side_count),
      KOKKOS_LAMBDA(const Index side) {
        SideTotals sum;
        for (Index k = particles.count - 1; k >= staying; --k) {
          const Index p = order(k);
          if (side_left_through(domain, particles.position_radius(p)) != side) continue;
          ++sum.particles;
          if (particles.velocity_spin(p).inverse_mass != 0) sum.mass += particles.mass(p);
        }
        sides(side) = sum;
      });
}

}  // namespace

void Engine::remove_left() {
  const DeviceArray<std::int32_t>& order = free_order_;
  const Vec3 momentum = compute_totals().momentum;
  const Index staying = rank_staying(setup_.domain, particles_, order);
  left_ += particles_.count - staying;
  sum_leaving(setup_.domain, particles_, order, staying, leaving_);
  const auto leaving = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, leaving_);
  for (std::size_t side = 0; side < left_by_side_.size(); ++side) {
    left_by_side_[side].particles += leaving(side).particles;
    left_by_side_[side].mass += leaving(side).mass;
  }
  reorder(order, staying);
  const ParticleTotals rest = compute_totals();
  left_momentum_ += momentum - rest.momentum;
  left_mass_ += moving_mass_ - rest.mass;
  moving_mass_ = rest.mass;
  moving_volume_ = rest.volume;
}

void Engine::prepare_outer_step() {
  if (particles_.count == 0) return;
  const Outside outside = find_outside(setup_.domain, particles_);
  if (outside.lost >= 0) {
    const auto place = Kokkos::create_mirror_view_and_copy(
        Kokkos::HostSpace{}, Kokkos::subview(particles_.position_radius, outside.lost));
    const auto motion = Kokkos::create_mirror_view_and_copy(
        Kokkos::HostSpace{}, Kokkos::subview(particles_.velocity_spin, outside.lost));
    throw RunError("particle " + std::to_string(motion().id) + " is outside the domain at (" +
                   std::to_string(place().x) + ", " + std::to_string(place().y) + ", " +
                   std::to_string(place().z) +
                   ") m, beyond a side that is not open; no wall held it, or it was too fast for the wall");
  }
  if (outside.left > 0) remove_left();
  if (++outer_steps_since_sort_ >= sort_interval) sort_memory();
}

}  // namespace pellicle::dem
