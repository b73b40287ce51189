// The engine's memory: its arrays, their order in space, and particles that leave.
#include <utility>

#include "core/error.hpp"
#include "dem/engine.hpp"
#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

/// Outer steps between two re-sorts of memory: neighbours drift apart slowly, a sort costs about one list build.
constexpr std::int64_t sort_interval = 64;

void permute(const Particles& from, const DeviceArray<std::int32_t>& touching_from,
             const DeviceArray<std::int32_t>& order, const Particles& to,
             const DeviceArray<std::int32_t>& touching_to) {
  Kokkos::parallel_for(
      "dem::engine_memory::permute", DeviceRange(0, to.count), KOKKOS_LAMBDA(const Index slot) {
        const Index p = order(slot);
        to.position_radius(slot) = from.position_radius(p);
        to.velocity_spin(slot) = from.velocity_spin(p);
        to.mass(slot) = from.mass(p);
        to.acceleration(slot) = from.acceleration(p);
        to.angular_acceleration(slot) = from.angular_acceleration(p);
        touching_to(slot) = touching_from(p);
      });
}

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
      "dem::engine_memory::find_outside", DeviceRange(0, particles.count),
      KOKKOS_LAMBDA(const Index p, std::int32_t& l, std::int32_t& w) {
        const int where = classify(domain, place(p));
        if (where == 1) ++l;
        if (where == 2 && p > w) w = p;
      },
      Kokkos::Sum<std::int32_t>(left), Kokkos::Max<std::int32_t>(lost));
  return {left, lost < 0 ? -1 : lost};
}

/// New place of every particle that stays, in the present order; returns how many stay.
Index rank_staying(const Domain& domain, const Particles& particles, const DeviceArray<std::int32_t>& order) {
  const auto place = particles.position_radius;
  std::int32_t staying = 0;
  Kokkos::parallel_scan(
      "dem::engine_memory::rank_staying", DeviceRange(0, particles.count),
      KOKKOS_LAMBDA(const Index p, std::int32_t& rank, const bool final) {
        const bool stays = classify(domain, place(p)) != 1;
        if (final && stays) order(rank) = p;
        if (stays) ++rank;
      },
      staying);
  return staying;
}

}  // namespace

void Engine::allocate(std::size_t n) {
  const auto make = [n](Particles& p, const char* place, const char* motion, const char* mass,
                        const char* acceleration, const char* angular) {
    p.position_radius = make_array<PositionRadius>(place, n);
    p.velocity_spin = make_array<VelocitySpin>(motion, n);
    p.mass = make_array<Real>(mass, n);
    p.acceleration = make_array<Vec3>(acceleration, n);
    p.angular_acceleration = make_array<Vec3>(angular, n);
    p.count = static_cast<Index>(n);
  };
  make(particles_, "dem::engine_memory::position_radius", "dem::engine_memory::velocity_spin",
       "dem::engine_memory::mass", "dem::engine_memory::acceleration",
       "dem::engine_memory::angular_acceleration");
  make(scratch_, "dem::engine_memory::position_radius_scratch", "dem::engine_memory::velocity_spin_scratch",
       "dem::engine_memory::mass_scratch", "dem::engine_memory::acceleration_scratch",
       "dem::engine_memory::angular_acceleration_scratch");
  result_.force = make_array<Vec3>("dem::engine_memory::force", n);
  result_.torque = make_array<Vec3>("dem::engine_memory::torque", n);
  result_.touching = make_array<std::int32_t>("dem::engine_memory::touching", n);
  result_.touching_new = make_array<std::int32_t>("dem::engine_memory::touching_new", n);
  result_.report = make_array<BlockReport>("dem::engine_memory::report",
                                           static_cast<std::size_t>(contact_block_count(particles_.count)));
  touching_scratch_ = make_array<std::int32_t>("dem::engine_memory::touching_scratch", n);
  history_.clear();
  list_valid_ = false;
}

void Engine::sort_memory() {
  if (search_.empty()) return;
  // A build yields the canonical order; the lists it also makes name particles by their old place and are dropped.
  history_.pack(list_);
  search_.front().build(particles_, setup_.time_step, list_);
  scratch_.count = particles_.count;
  permute(particles_, result_.touching, search_.front().order(), scratch_, touching_scratch_);
  history_.reorder(search_.front().order(), particles_.count, particles_.count);
  std::swap(particles_, scratch_);
  std::swap(result_.touching, touching_scratch_);
  list_valid_ = false;
  outer_steps_since_sort_ = 0;
}

void Engine::canonicalise() { sort_memory(); }

void Engine::remove_left() {
  const Index staying = rank_staying(setup_.domain, particles_, touching_scratch_);
  const auto order =
      make_array<std::int32_t>("dem::engine_memory::staying_order", static_cast<std::size_t>(staying));
  Kokkos::deep_copy(order, Kokkos::subview(touching_scratch_, std::pair<Index, Index>(0, staying)));
  left_ += particles_.count - staying;
  const Vec3 momentum = compute_totals().momentum;
  scratch_.count = staying;
  permute(particles_, result_.touching, order, scratch_, touching_scratch_);
  history_.pack(list_);
  history_.reorder(order, particles_.count, staying);
  std::swap(particles_, scratch_);
  std::swap(result_.touching, touching_scratch_);
  list_valid_ = false;
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
