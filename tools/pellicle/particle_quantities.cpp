#include "tools/pellicle/particle_quantities.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace pellicle::tools {

namespace {

template <class T>
std::vector<T> gather(const DeviceArray<T>& array, const std::vector<std::size_t>& order) {
  const auto part = Kokkos::subview(array, std::pair<std::size_t, std::size_t>(0, order.size()));
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), part);
  std::vector<T> values(order.size());
  for (std::size_t n = 0; n < order.size(); ++n) values[n] = host(order[n]);
  return values;
}

}  // namespace

ParticleSample HostParticles::sample(std::size_t p) const {
  ParticleSample sample;
  sample.position_radius = position_radius[p];
  sample.velocity_spin = velocity_spin[p];
  sample.mass = mass[p];
  sample.acceleration = acceleration[p];
  if (!temperature.empty()) sample.temperature = temperature[p];
  if (!film.empty()) sample.film = film[p];
  if (!hits.empty()) sample.hit = hits[p];
  sample.solids_density = solids_density;
  return sample;
}

HostParticles copy_to_host(const ParticleColumns& columns) {
  const dem::Particles& particles = columns.particles;
  std::vector<std::size_t> order(static_cast<std::size_t>(particles.count));
  std::iota(order.begin(), order.end(), std::size_t{0});
  HostParticles host;
  host.velocity_spin = gather(particles.velocity_spin, order);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return host.velocity_spin[a].id < host.velocity_spin[b].id;
  });
  std::sort(host.velocity_spin.begin(), host.velocity_spin.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  host.position_radius = gather(particles.position_radius, order);
  host.mass = gather(particles.mass, order);
  if (particles.acceleration.extent(0) >= order.size())
    host.acceleration = gather(particles.acceleration, order);
  host.acceleration.resize(order.size());
  if (columns.temperature.extent(0) > 0) host.temperature = gather(columns.temperature, order);
  if (columns.film.extent(0) > 0) host.film = gather(columns.film, order);
  if (columns.hits.extent(0) > 0) host.hits = gather(columns.hits, order);
  host.solids_density = columns.solids_density;
  return host;
}

}  // namespace pellicle::tools
