// What the tests of the DEM share: set-ups of one material and a wall, particles read back by id.
#pragma once

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "core/timers.hpp"
#include "dem/engine.hpp"

namespace pellicle::tests {

/// A particle as the tests see it.
struct Grain {
  int id;
  Vec3 position, velocity, spin;
  Real radius, mass;
  Vec3 acceleration, angular_acceleration;
  bool fixed;
};

/// Particles on the host, sorted by id.
inline std::vector<Grain> grains(const dem::Particles& particles) {
  const auto place = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.position_radius);
  const auto motion = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.velocity_spin);
  const auto mass = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.mass);
  const auto linear = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.acceleration);
  const auto angular =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.angular_acceleration);
  std::vector<Grain> result;
  result.reserve(static_cast<std::size_t>(particles.count));
  for (Index p = 0; p < particles.count; ++p) {
    result.push_back({motion(p).id, place(p).position(), motion(p).velocity(), motion(p).spin(),
                      place(p).radius, mass(p), convert<Real>(linear(p)), convert<Real>(angular(p)),
                      motion(p).inverse_mass == 0});
  }
  std::sort(result.begin(), result.end(), [](const Grain& a, const Grain& b) { return a.id < b.id; });
  return result;
}

/// Glass (material 0, soft as usual) and a rigid wall (material 1) in a box; no walls, no gravity.
inline dem::EngineSetup glass_setup(const Vec3& size, Real time_step, Real restitution = 0.9,
                                    Real sliding_friction = 0.3, Real rolling_friction = 0) {
  dem::EngineSetup setup;
  setup.domain.box = {{0, 0, 0}, size};
  setup.materials = {{"glass", 2500, 1e7, 0.25, false}, {"wall", 0, 0, 0, true}};
  setup.pairs = {{0, 0, restitution, sliding_friction, rolling_friction},
                 {0, 1, restitution, sliding_friction, rolling_friction}};
  setup.time_step = time_step;
  return setup;
}

/// Laws with springs, instead of those that forget.
inline void let_contacts_remember(dem::EngineSetup& setup) {
  setup.contacts.tangential = dem::Mindlin{};
  setup.contacts.rolling = dem::Epsd2{};
}

/// Mass of a sphere of that glass [kg], and its reduced modulus E* against a rigid wall [Pa]; against glass half of it.
inline Real glass_mass(Real radius) { return 2500 * 4.0 / 3.0 * M_PI * radius * radius * radius; }
inline constexpr Real glass_wall_modulus = 1e7 / (1 - 0.25 * 0.25);

/// Walls on the sides of the domain that neither repeat nor are open.
inline void add_box_walls(dem::EngineSetup& setup) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int upper = 0; upper < 2; ++upper) {
      const Index3& open = upper == 1 ? setup.domain.open_max : setup.domain.open_min;
      if (setup.domain.periodic[axis] != 0 || open[axis] != 0) continue;
      dem::PlaneWall wall;
      wall.name = "box";
      wall.point = upper == 1 ? setup.domain.box.max : setup.domain.box.min;
      wall.normal[axis] = upper == 1 ? -1 : 1;
      wall.material = 1;
      setup.walls.emplace_back(wall);
    }
  }
}

/// A vector of three numbers in [-1, 1), the same at every run.
inline Vec3 random_vector(int seed, int id) {
  const Vec3 u = core::random_uniform3(static_cast<std::uint64_t>(seed), core::Purpose::test, 0, id);
  return 2.0 * u - Vec3{1, 1, 1};
}

/// Random centres in a box for spheres that may overlap by `overlap` of the sum of their radii, one after the other.
inline std::vector<Vec3> scatter(const Box& box, const std::vector<Real>& radii, Real overlap, int seed) {
  std::vector<Vec3> centres;
  int draw = 0;
  for (std::size_t i = 0; i < radii.size(); ++i) {
    for (;;) {
      const Vec3 share = 0.5 * (random_vector(seed, draw++) + Vec3{1, 1, 1});
      const Vec3 size = box.max - box.min;
      const Vec3 x = box.min + Vec3{share.x * size.x, share.y * size.y, share.z * size.z};
      bool free = true;
      for (std::size_t j = 0; j < centres.size() && free; ++j) {
        free = norm(centres[j] - x) > (1 - overlap) * (radii[i] + radii[j]);
      }
      if (!free) continue;
      centres.push_back(x);
      break;
    }
  }
  return centres;
}

inline void advance(dem::Engine& engine, int substeps) {
  core::Timers timers;
  engine.advance(substeps, timers);
}

}  // namespace pellicle::tests
