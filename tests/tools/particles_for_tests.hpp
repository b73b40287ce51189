// Particles made up on the host, for tests of the outputs.
#pragma once

#include <vector>

#include "dem/particles.hpp"

namespace pellicle::tests {

struct MadeUpParticle {
  Vec3 position, velocity;
  std::int32_t id = 0;
  Real radius = 1e-3;
  Real mass = 1e-5;
};

/// Device arrays that hold these particles in this order, with room for `spare` more.
inline dem::Particles make_particles(const std::vector<MadeUpParticle>& made_up, std::size_t spare = 3) {
  const std::size_t size = made_up.size() + spare;
  dem::Particles particles;
  particles.count = static_cast<Index>(made_up.size());
  particles.position_radius = DeviceArray<dem::PositionRadius>("test::position_radius", size);
  particles.velocity_spin = DeviceArray<dem::VelocitySpin>("test::velocity_spin", size);
  particles.mass = DeviceArray<Real>("test::mass", size);
  particles.acceleration = DeviceArray<dem::Vec3f>("test::acceleration", size);
  particles.angular_acceleration = DeviceArray<dem::Vec3f>("test::angular_acceleration", size);
  const auto places = Kokkos::create_mirror_view(particles.position_radius);
  const auto motions = Kokkos::create_mirror_view(particles.velocity_spin);
  const auto masses = Kokkos::create_mirror_view(particles.mass);
  for (std::size_t p = 0; p < made_up.size(); ++p) {
    const auto& m = made_up[p];
    places(p) = {m.position.x, m.position.y, m.position.z, m.radius};
    motions(p) = {m.velocity.x, m.velocity.y, m.velocity.z, 0.1 * m.id, 0.2 * m.id, 0.3 * m.id, 1 / m.mass, 0,
                  m.id};
    masses(p) = m.mass;
  }
  Kokkos::deep_copy(particles.position_radius, places);
  Kokkos::deep_copy(particles.velocity_spin, motions);
  Kokkos::deep_copy(particles.mass, masses);
  return particles;
}

}  // namespace pellicle::tests
