// The engine's memory: its arrays and their order in space.
#include <algorithm>

#include "dem/engine.hpp"
#include "dem/engine_arrays.hpp"
#include "dem/permute.hpp"

namespace pellicle::dem {
namespace {

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

}  // namespace

void Engine::allocate(std::size_t n) {
  particles_.position_radius = make_array<PositionRadius>("dem::engine_memory::position_radius", n);
  particles_.velocity_spin = make_array<VelocitySpin>("dem::engine_memory::velocity_spin", n);
  particles_.mass = make_array<Real>("dem::engine_memory::mass", n);
  particles_.acceleration = make_array<Vec3f>("dem::engine_memory::acceleration", n);
  particles_.angular_acceleration = make_array<Vec3f>("dem::engine_memory::angular_acceleration", n);
  particles_.count = static_cast<Index>(n);
  const std::size_t loads = sizeof(ContactLoad) / sizeof(Real) * n;
  work_ = make_array<Real>("dem::engine_memory::work", std::max(loads, NeighbourSearch::scratch_size(n)));
  result_.load = DeviceArray<ContactLoad>(reinterpret_cast<ContactLoad*>(work_.data()), n);
  result_.touching = make_array<std::int32_t>("dem::engine_memory::touching", n);
  free_order_ = make_array<std::int32_t>("dem::engine_memory::order", n);
  result_.report = make_array<BlockReport>("dem::engine_memory::report",
                                           static_cast<std::size_t>(contact_block_count(particles_.count)));
  history_.clear();
  list_valid_ = false;
}

void Engine::reorder(const DeviceArray<std::int32_t>& order, Index count) {
  // First, while the particles are still in the old order.
  for (Companion* companion : companions_) companion->reorder(order, particles_.count, count, work_);
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
  search_.front().find_memory_order(free_order_);
  reorder(free_order_, particles_.count);
  outer_steps_since_sort_ = 0;
}

void Engine::canonicalise() { sort_memory(); }

}  // namespace pellicle::dem
