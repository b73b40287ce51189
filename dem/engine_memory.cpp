// The engine's memory: its arrays, their order in space, and particles that leave.
#include <algorithm>

#include "core/error.hpp"
#include "dem/engine.hpp"
#include "dem/engine_arrays.hpp"
#include "dem/permute.hpp"

namespace pellicle::dem {
namespace {

/// Outer steps between two re-sorts of memory: neighbours drift apart slowly, a sort costs about one list build.
constexpr std::int64_t sort_interval = 64;

/// Velocities and spins are put aside together, the rest of the entry after them, so that less scratch is needed.
struct Motion {
  Vec3 velocity, spin;
};
struct Identity {
  Real inverse_mass;
  std::int32_t material, id;
};

void permute_motion(const DeviceArray<VelocitySpin>& motion, const DeviceArray<std::int32_t>& order,
                    Index count, const DeviceArray<Real>& scratch) {
  auto* const moving = reinterpret_cast<Motion*>(scratch.data());
  Kokkos::parallel_for(
      "dem::engine_memory::gather_motion", DeviceRange(0, count), KOKKOS_LAMBDA(const Index slot) {
        const VelocitySpin m = motion(order(slot));
        moving[slot] = {m.velocity(), m.spin()};
      });
  // The particles' identity is still in the old order while this half of the entry is put back.
  Kokkos::parallel_for(
      "dem::engine_memory::put_back_motion", DeviceRange(0, count), KOKKOS_LAMBDA(const Index slot) {
        const Motion from = moving[slot];
        VelocitySpin& to = motion(slot);
        to.vx = from.velocity.x;
        to.vy = from.velocity.y;
        to.vz = from.velocity.z;
        to.wx = from.spin.x;
        to.wy = from.spin.y;
        to.wz = from.spin.z;
      });
  auto* const who = reinterpret_cast<Identity*>(scratch.data());
  Kokkos::parallel_for(
      "dem::engine_memory::gather_identity", DeviceRange(0, count), KOKKOS_LAMBDA(const Index slot) {
        const VelocitySpin& m = motion(order(slot));
        who[slot] = {m.inverse_mass, m.material, m.id};
      });
  Kokkos::parallel_for(
      "dem::engine_memory::put_back_identity", DeviceRange(0, count), KOKKOS_LAMBDA(const Index slot) {
        VelocitySpin& to = motion(slot);
        to.inverse_mass = who[slot].inverse_mass;
        to.material = who[slot].material;
        to.id = who[slot].id;
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
  particles_.position_radius = make_array<PositionRadius>("dem::engine_memory::position_radius", n);
  particles_.velocity_spin = make_array<VelocitySpin>("dem::engine_memory::velocity_spin", n);
  particles_.mass = make_array<Real>("dem::engine_memory::mass", n);
  particles_.acceleration = make_array<Vec3f>("dem::engine_memory::acceleration", n);
  particles_.angular_acceleration = make_array<Vec3f>("dem::engine_memory::angular_acceleration", n);
  particles_.count = static_cast<Index>(n);
  const std::size_t force_and_torque = 6 * n;
  work_ = make_array<Real>("dem::engine_memory::work",
                           std::max(force_and_torque, NeighbourSearch::scratch_size(n)));
  result_.force = DeviceArray<Vec3>(reinterpret_cast<Vec3*>(work_.data()), n);
  result_.torque = DeviceArray<Vec3>(reinterpret_cast<Vec3*>(work_.data()) + n, n);
  result_.touching = make_array<std::int32_t>("dem::engine_memory::touching", n);
  result_.touching_new = make_array<std::int32_t>("dem::engine_memory::touching_new", n);
  result_.report = make_array<BlockReport>("dem::engine_memory::report",
                                           static_cast<std::size_t>(contact_block_count(particles_.count)));
  history_.clear();
  list_valid_ = false;
}

void Engine::reorder(const DeviceArray<std::int32_t>& order, Index count) {
  permute_array(particles_.position_radius, order, count, work_);
  permute_motion(particles_.velocity_spin, order, count, work_);
  permute_array(particles_.mass, order, count, work_);
  permute_array(particles_.acceleration, order, count, work_);
  permute_array(particles_.angular_acceleration, order, count, work_);
  permute_array(result_.touching, order, count, work_);
  history_.pack(list_);
  history_.reorder(order, particles_.count, count);
  walls_.pack_history(particles_);
  walls_.reorder_history(order, count);
  particles_.count = count;
  list_valid_ = false;
}

void Engine::sort_memory() {
  if (search_.empty()) return;
  search_.front().find_order(particles_, setup_.time_step, list_);
  const DeviceArray<std::int32_t>& order = result_.touching_new;  // free between substeps
  search_.front().find_memory_order(order);
  reorder(order, particles_.count);
  outer_steps_since_sort_ = 0;
}

void Engine::canonicalise() { sort_memory(); }

void Engine::remove_left() {
  const DeviceArray<std::int32_t>& order = result_.touching_new;  // free between substeps
  const Vec3 momentum = compute_totals().momentum;
  const Index staying = rank_staying(setup_.domain, particles_, order);
  left_ += particles_.count - staying;
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
