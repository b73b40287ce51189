// Particles that enter an engine while it runs.
#include <stdexcept>

#include "core/error.hpp"
#include "dem/engine.hpp"
#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

/// Memory grows by a quarter, or by this many particles.
constexpr std::size_t least_growth = 1024;

template <class T>
void copy_first(const DeviceArray<T>& to, const DeviceArray<T>& from, Index count) {
  const std::pair<Index, Index> range(0, count);
  Kokkos::deep_copy(Kokkos::subview(to, range), Kokkos::subview(from, range));
}

/// Copies `values` to the entries of an array from `first` on.
template <class T>
void put(const DeviceArray<T>& array, Index first, const std::vector<T>& values) {
  const Kokkos::View<const T*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> host(
      values.data(), values.size());
  const std::pair<Index, Index> range(first, first + static_cast<Index>(values.size()));
  Kokkos::deep_copy(Kokkos::subview(array, range), host);
}

}  // namespace

Real Engine::mass_of(const ParticleSeed& seed) const {
  return setup_.materials.at(static_cast<std::size_t>(seed.material)).density * sphere_volume(seed.radius);
}

void Engine::put_particles(const std::vector<ParticleSeed>& seeds, Index first) {
  std::vector<PositionRadius> place;
  std::vector<VelocitySpin> motion;
  std::vector<Real> mass;
  for (const ParticleSeed& s : seeds) {
    mass.push_back(mass_of(s));
    place.push_back({s.position.x, s.position.y, s.position.z, s.radius});
    motion.push_back({s.velocity.x, s.velocity.y, s.velocity.z, s.spin.x, s.spin.y, s.spin.z,
                      s.fixed ? 0 : 1 / mass.back(), s.material, next_id_++});
    one_particle_material_ = one_particle_material_ && s.material == 0;
    any_fixed_ = any_fixed_ || s.fixed;
  }
  put(particles_.position_radius, first, place);
  put(particles_.velocity_spin, first, motion);
  put(particles_.mass, first, mass);
}

void Engine::reserve(std::size_t capacity) {
  if (capacity <= particles_.position_radius.extent(0)) return;
  const Particles before = particles_;
  const DeviceArray<std::int32_t> touching = result_.touching;
  const DeviceArray<BlockReport> report = result_.report;
  const ContactHistory history = history_;
  allocate(capacity);
  particles_.count = before.count;
  history_ = history;
  // What contacts have reported and nobody has collected yet.
  copy_first(result_.report, report, static_cast<Index>(report.extent(0)));
  if (before.count == 0) return;
  copy_first(particles_.position_radius, before.position_radius, before.count);
  copy_first(particles_.velocity_spin, before.velocity_spin, before.count);
  copy_first(particles_.mass, before.mass, before.count);
  copy_first(particles_.acceleration, before.acceleration, before.count);
  copy_first(particles_.angular_acceleration, before.angular_acceleration, before.count);
  copy_first(result_.touching, touching, before.count);
}

void Engine::add_particles(const std::vector<ParticleSeed>& seeds) {
  if (seeds.empty()) return;
  const Index first = particles_.count;
  const std::size_t total = static_cast<std::size_t>(first) + seeds.size();
  if (total + static_cast<std::size_t>(next_id_) > std::numeric_limits<Index>::max()) {
    throw RunError("more particles than can be counted have entered");
  }
  history_.pack(list_);  // new particles have no contacts to remember
  walls_.pack_history(particles_);
  if (total > particles_.position_radius.extent(0)) {
    reserve(std::max(total + total / 4, static_cast<std::size_t>(first) + least_growth));
  }
  // The velocity is that at the time of the position; the half-step velocity behind it is that of free flight.
  const Vec3 free_flight = round_to_single(started_ ? setup_.gravity : Vec3{});
  for (const ParticleSeed& s : seeds) {
    if (s.fixed) continue;
    entered_mass_ += mass_of(s);
    entered_momentum_ += mass_of(s) * (s.velocity - (0.5 * setup_.time_step) * free_flight);
  }
  put_particles(seeds, first);
  put(particles_.acceleration, first, std::vector<Vec3f>(seeds.size(), convert<float>(free_flight)));
  put(particles_.angular_acceleration, first, std::vector<Vec3f>(seeds.size()));
  put(result_.touching, first, std::vector<std::int32_t>(seeds.size()));
  particles_.count = static_cast<Index>(total);
  for (Companion* companion : companions_) companion->add(first, static_cast<Index>(seeds.size()));
  const ParticleTotals totals = compute_totals();
  moving_mass_ = totals.mass;
  moving_volume_ = totals.volume;
  list_valid_ = false;
}

}  // namespace pellicle::dem
