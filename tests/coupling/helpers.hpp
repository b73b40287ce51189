// Particles and fields for the tests of coupling.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "coupling/momentum_exchange.hpp"

namespace pellicle::coupling::testing {

struct TestParticle {
  Vec3 position;
  Real radius = 1e-3;
  Vec3 velocity{};
};

inline Real sphere_volume(Real radius) { return 4 * std::numbers::pi / 3 * radius * radius * radius; }

inline dem::Particles make_particles(const std::vector<TestParticle>& from) {
  dem::Particles made;
  made.count = static_cast<Index>(from.size());
  made.position_radius = DeviceArray<dem::PositionRadius>("tests::coupling::position_radius", from.size());
  made.velocity_spin = DeviceArray<dem::VelocitySpin>("tests::coupling::velocity_spin", from.size());
  made.mass = DeviceArray<Real>("tests::coupling::mass", from.size());
  const auto place = Kokkos::create_mirror_view(made.position_radius);
  const auto motion = Kokkos::create_mirror_view(made.velocity_spin);
  for (std::size_t p = 0; p < from.size(); ++p) {
    place(p) = {from[p].position.x, from[p].position.y, from[p].position.z, from[p].radius};
    motion(p) = {};
    motion(p).vx = from[p].velocity.x;
    motion(p).vy = from[p].velocity.y;
    motion(p).vz = from[p].velocity.z;
  }
  Kokkos::deep_copy(made.position_radius, place);
  Kokkos::deep_copy(made.velocity_spin, motion);
  return made;
}

template <class T>
std::vector<T> to_vector(const DeviceArray<T>& view, Index count) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
  return std::vector<T>(host.data(), host.data() + count);
}

/// Random particles in a box, order shuffled by construction.
inline std::vector<TestParticle> random_particles(const Box& box, int count, Real radius, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<Real> unit(0, 1);
  std::vector<TestParticle> made;
  for (int p = 0; p < count; ++p) {
    TestParticle particle;
    particle.radius = radius * (0.5 + 0.5 * unit(generator));
    for (int axis = 0; axis < 3; ++axis) {
      particle.position[axis] = box.min[axis] + unit(generator) * (box.max[axis] - box.min[axis]);
      particle.velocity[axis] = 2 * unit(generator) - 1;
    }
    made.push_back(particle);
  }
  return made;
}

/// A stretched axis: widths grow by `ratio` from cell to cell.
inline std::vector<Real> stretched_faces(Real from, Real to, int cells, Real ratio) {
  std::vector<Real> faces{from};
  Real width = (to - from) * (1 - ratio) / (1 - std::pow(ratio, cells));
  for (int i = 1; i < cells; ++i) {
    faces.push_back(faces.back() + width);
    width *= ratio;
  }
  faces.push_back(to);
  return faces;
}

}  // namespace pellicle::coupling::testing
