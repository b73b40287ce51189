#include "tools/pellicle/particle_quantities.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace pellicle::tools {

ParticleSample HostParticles::sample(std::size_t p) const {
  ParticleSample sample;
  sample.position_radius = position_radius[p];
  sample.velocity_spin = velocity_spin[p];
  sample.mass = mass[p];
  if (!acceleration.empty()) sample.acceleration = acceleration[p];
  if (!temperature.empty()) sample.temperature = temperature[p];
  if (!film.empty()) sample.film = film[p];
  if (!hits.empty()) sample.hit = hits[p];
  sample.solids_density = solids_density;
  sample.radius_grows = radius_grows;
  return sample;
}

HostParticles copy_to_host(const ParticleColumns& columns) {
  const dem::Particles& particles = columns.particles;
  auto order = std::make_shared<std::vector<std::int32_t>>(static_cast<std::size_t>(particles.count));
  std::iota(order->begin(), order->end(), 0);
  HostParticles host;
  const auto motion = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), particles.velocity_spin);
  std::sort(order->begin(), order->end(),
            [&](std::int32_t a, std::int32_t b) { return motion(a).id < motion(b).id; });
  const auto fill = [&order](auto& column, const auto& array) {
    if (array.extent(0) >= order->size() && array.extent(0) > 0) column = {array, order};
  };
  fill(host.velocity_spin, particles.velocity_spin);
  fill(host.position_radius, particles.position_radius);
  fill(host.mass, particles.mass);
  fill(host.acceleration, particles.acceleration);
  fill(host.temperature, columns.temperature);
  fill(host.film, columns.film);
  fill(host.hits, columns.hits);
  host.solids_density = columns.solids_density;
  host.radius_grows = columns.radius_grows;
  return host;
}

}  // namespace pellicle::tools
