// Particles whose radius grows while they move or rest.
#include <gtest/gtest.h>

#include <cmath>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

/// Every particle's radius by a length [m] more, its mass by that of a shell of glass.
void grow(Engine& engine, Real by) {
  const auto n = static_cast<std::size_t>(engine.particles().count);
  const DeviceArray<Real> mass("test::growing::mass", n), radius("test::growing::radius", n);
  const auto place = host_copy(engine.particles().position_radius, engine.particles().count);
  const auto old_mass = host_copy(engine.particles().mass, engine.particles().count);
  const auto host_mass = Kokkos::create_mirror_view(mass), host_radius = Kokkos::create_mirror_view(radius);
  for (std::size_t p = 0; p < n; ++p) {
    host_radius(p) = place(p).radius + by;
    host_mass(p) = old_mass(p) * std::pow(host_radius(p) / place(p).radius, 3);
  }
  Kokkos::deep_copy(mass, host_mass);
  Kokkos::deep_copy(radius, host_radius);
  engine.set_sizes(mass, radius);
}

/// A column of five spheres of 1 mm on the floor, between walls that just do not touch.
struct Column {
  EngineSetup setup = tests::glass_setup({0.01, 0.01, 0.03}, 1e-5, 0.5);
  std::vector<ParticleSeed> seeds;
  Column() {
    setup.gravity = {0, 0, -9.81};
    tests::add_box_walls(setup);
    for (int i = 0; i < 5; ++i) {
      ParticleSeed seed;
      seed.position = {0.005, 0.005, 1e-3 + 2e-3 * i};
      seed.radius = 1e-3;
      seeds.push_back(seed);
    }
  }
};

/// Static overlaps of a column on the floor from Hertz: F = 4/3 E* sqrt(R*) d^(3/2) with the weight above each contact.
Real height_of(int sphere, Real radius, Real density) {
  const Real mass = density * 4 / 3 * M_PI * radius * radius * radius;
  Real z = 0;
  for (int i = 0; i <= sphere; ++i) {
    const Real load = mass * 9.81 * (5 - i);
    const bool floor = i == 0;
    const Real modulus = floor ? tests::glass_wall_modulus : tests::glass_wall_modulus / 2;
    const Real reduced = floor ? radius : radius / 2;
    const Real overlap = std::pow(0.75 * load / (modulus * std::sqrt(reduced)), 2.0 / 3);
    z += (floor ? radius : 2 * radius) - overlap;
  }
  return z;
}

// A column at rest grows by 1 % in 1000 steps of 1e-8 m and stays a column: each sphere is where weight and Hertz's law put
// one of its size. Nothing of what the lists were built with is exceeded unnoticed.
TEST(Growing, AColumnAtRestStaysInContact) {
  Column column;
  Engine engine(column.setup);
  engine.set_particles(column.seeds);
  tests::advance(engine, 4000);
  for (int k = 0; k < 1000; ++k) {
    grow(engine, 1e-8);
    tests::advance(engine, 10);
    if (k % 100 == 99) {
      ASSERT_EQ(engine.collect_report().touching_pairs, 4) << k;
    }
  }
  // Growing lifts the column at 1e-4 m/s and a little more; its slowest swing dies down as exp(-160/s t), to 1e-14 of 1e-6 m.
  tests::advance(engine, 20000);
  const auto place = host_copy(engine.particles().position_radius, 5);
  const auto motion = host_copy(engine.particles().velocity_spin, 5);
  for (Index p = 0; p < 5; ++p) {
    EXPECT_NEAR(place(p).radius, 1.01e-3, 1e-15);
    // Within a thousandth of the least overlap, 1e-7 m.
    EXPECT_NEAR(place(p).z, height_of(motion(p).id, 1.01e-3, 2500), 1e-10) << motion(p).id;
    EXPECT_NEAR(place(p).x, 0.005, 1e-12);
  }
  // The books: mass of shells, and volume.
  const ParticleTotals totals = engine.compute_totals();
  EXPECT_NEAR(engine.grown_mass(), 5 * tests::glass_mass(1e-3) * (1.01 * 1.01 * 1.01 - 1),
              1e-12 * totals.mass);
  const Real volume_time = engine.volume_time();
  tests::advance(engine, 100);
  const Real volume = 5 * 4.0 / 3 * M_PI * 1.01e-3 * 1.01e-3 * 1.01e-3;
  EXPECT_NEAR(engine.volume_time() - volume_time, volume * 100 * 1e-5, 1e-9 * volume * 1e-3);
}

// Spheres at rest that do not touch grow until they do: half a radius, in steps of which a hundred fit into an allowance. The
// search has to be told, though nobody moves. They are pushed apart then.
TEST(Growing, RestingNeighboursFindEachOther) {
  auto setup = tests::glass_setup({0.02, 0.02, 0.02}, 1e-5);
  std::vector<ParticleSeed> seeds(3);
  seeds[0] = {{0.005, 0.01, 0.01}, {}, {}, 1e-3, 0, true};  // fixed: no displacement is ever summed for it
  seeds[1] = {{0.0079, 0.01, 0.01}, {}, {}, 1e-3, 0, false};
  seeds[2] = {{0.015, 0.01, 0.01}, {}, {}, 1e-3, 0, false};
  setup.skin.tuned = false;  // it searches now and then by itself
  Engine engine(setup);
  engine.set_particles(seeds);
  int first = 0;
  for (int k = 1; k <= 500 && first == 0; ++k) {
    grow(engine, 1e-6);
    tests::advance(engine, 1);
    if (engine.collect_report().touching_pairs > 0) first = k;
  }
  // 0.9 mm apart, each gains 1 um a step.
  EXPECT_TRUE(first == 450 || first == 451) << first;
  EXPECT_LT(engine.list_builds(), 60);
}

TEST(Growing, WallsAreFoundToo) {
  auto setup = tests::glass_setup({0.02, 0.02, 0.02}, 1e-5);
  tests::add_box_walls(setup);
  std::vector<ParticleSeed> seeds(1);
  seeds[0] = {{0.01, 0.01, 0.0014}, {}, {}, 1e-3, 0, false};
  setup.skin.tuned = false;  // it searches now and then by itself
  Engine engine(setup);
  engine.set_particles(seeds);
  int first = 0;
  for (int k = 1; k <= 500 && first == 0; ++k) {
    grow(engine, 1e-6);
    tests::advance(engine, 1);
    if (engine.collect_report().touching_walls > 0) first = k;
  }
  EXPECT_TRUE(first == 400 || first == 401) << first;
}

// Inertia follows: 2/5 m r^2 of the grown sphere slows the same torque. A sphere that slides on the floor rolls at 5/7 of its
// speed whatever its size; the time to get there is 2 v/(7 mu g). Here: spin and speed after growth as of one born so large.
TEST(Growing, MovesAsOneBornSoLarge) {
  auto setup = tests::glass_setup({0.04, 0.02, 0.02}, 2e-6, 0.8, 0.3);
  setup.gravity = {0, 0, -9.81};
  tests::add_box_walls(setup);
  std::vector<ParticleSeed> seeds(1);
  seeds[0] = {{0.005, 0.01, 0.0016}, {0.2, 0, 0}, {}, 1e-3, 0, false};
  Engine grown(setup);
  grown.set_particles(seeds);
  grow(grown, 5e-4);
  seeds[0].radius = 1.5e-3;
  Engine born(setup);
  born.set_particles(seeds);
  tests::advance(grown, 20000);
  tests::advance(born, 20000);
  const auto a = tests::grains(grown.particles()), b = tests::grains(born.particles());
  EXPECT_GT(norm(a[0].spin), 10);
  // Radius and mass differ by a rounding, which bounces blow up a little.
  EXPECT_NEAR(norm(a[0].position - b[0].position), 0, 1e-10);
  EXPECT_NEAR(norm(a[0].spin - b[0].spin), 0, 1e-5);
}

TEST(Growing, APeriodicDomainGetsTooNarrow) {
  auto setup = tests::glass_setup({0.0065, 0.02, 0.02}, 1e-5);
  setup.domain.periodic = {1, 0, 0};
  std::vector<ParticleSeed> seeds(1);
  seeds[0] = {{0.003, 0.01, 0.01}, {}, {}, 1e-3, 0, false};
  Engine engine(setup);
  engine.set_particles(seeds);
  grow(engine, 1e-4);
  EXPECT_THROW(grow(engine, 3e-4), RunError);
}

TEST(Growing, GoesOnBitForBitFromACheckpoint) {
  const tests::TemporaryFolder folder;
  Column column;
  Engine whole(column.setup);
  whole.set_particles(column.seeds);
  for (int k = 0; k < 50; ++k) {
    grow(whole, 1e-7);
    tests::advance(whole, 100);
  }
  whole.canonicalise();
  core::CheckpointWriter out(folder / "checkpoint.h5");
  whole.save(out);
  out.close();
  Engine resumed(column.setup);
  core::CheckpointReader in(folder / "checkpoint.h5");
  resumed.load(in);
  for (int k = 0; k < 50; ++k) {
    for (Engine* engine : {&whole, &resumed}) {
      grow(*engine, 1e-7);
      tests::advance(*engine, 100);
    }
  }
  const auto a = host_copy(whole.particles().position_radius, 5),
             b = host_copy(resumed.particles().position_radius, 5);
  for (Index p = 0; p < 5; ++p) {
    EXPECT_EQ(a(p).z, b(p).z);
    EXPECT_EQ(a(p).radius, b(p).radius);
  }
  EXPECT_EQ(whole.grown_mass(), resumed.grown_mass());
}

}  // namespace
}  // namespace pellicle::dem
