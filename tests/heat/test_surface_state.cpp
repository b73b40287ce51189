// Temperature and film stay with their particles: through re-sorts, feeds, departures and checkpoints.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "dem/engine.hpp"
#include "heat/surface_state.hpp"
#include "tests/core/temporary_folder.hpp"

namespace pellicle::heat {
namespace {

constexpr Real spacing = 4e-3;   // [m]
constexpr Real radius = 1e-3;    // [m]
constexpr Real density = 1000;   // [kg/m3]
constexpr Real capacity = 800;   // [J/kg/K]
constexpr Real reference = 300;  // [K]

/// A loose cube of grains that fly in different directions, without walls; top and bottom are open.
dem::EngineSetup make_setup() {
  dem::EngineSetup setup;
  setup.domain.box = {{0, 0, 0}, {0.04, 0.04, 0.04}};
  setup.domain.periodic = {1, 1, 0};
  setup.domain.open_min = setup.domain.open_max = {0, 0, 1};
  setup.materials.push_back({"grain", density, 1e7, 0.3});
  setup.pairs.push_back({0, 0, 0.9, 0.3, 0});
  setup.time_step = 1e-5;
  setup.later = {{0}, radius, radius, 100};
  return setup;
}

std::vector<dem::ParticleSeed> make_seeds(int count) {
  std::vector<dem::ParticleSeed> seeds;
  for (int n = 0; n < count; ++n) {
    const int i = n % 9, j = (n / 9) % 9, k = n / 81;
    dem::ParticleSeed seed;
    seed.position = spacing * Vec3{i + 0.5, j + 0.5, k + 0.5};
    seed.velocity = {0.5 * (n % 5 - 2), 0.5 * (n % 7 - 3), 1.0 + 0.25 * (n % 4)};
    seed.radius = radius;
    seeds.push_back(seed);
  }
  return seeds;
}

// Told apart by exact numbers: what is read back is the number that was put in, not one close to it.
Real temperature_of(std::int32_t id) { return 310 + 0.125 * id; }
Film film_of(std::int32_t id) { return {1e-9 * id, 3e-9 * id}; }

void set(SurfaceState& state, int count) {
  std::vector<Real> temperature;
  std::vector<Film> film;
  for (int id = 0; id < count; ++id) {
    temperature.push_back(temperature_of(id));
    film.push_back(film_of(id));
  }
  state.set_by_id(temperature, film);
}

void expect_own(const dem::Engine& engine, const SurfaceState& state, std::int32_t known) {
  const Index count = engine.particles().count;
  const auto motion = dem::host_copy(engine.particles().velocity_spin, count);
  const auto temperature = dem::host_copy(state.temperature(), count);
  const auto film = dem::host_copy(state.film(), count);
  for (Index p = 0; p < count; ++p) {
    const std::int32_t id = motion(p).id;
    EXPECT_EQ(temperature(p), id < known ? temperature_of(id) : reference + 5) << "particle " << id;
    EXPECT_EQ(film(p).liquid, id < known ? film_of(id).liquid : 0) << "particle " << id;
    EXPECT_EQ(film(p).solids, id < known ? film_of(id).solids : 0) << "particle " << id;
  }
}

HeatCapacities capacities() {
  HeatCapacities c;
  c.reference_temperature = reference;
  c.liquid = 4000;
  c.solids = 1200;
  return c;
}

struct Bed {
  dem::Engine engine{make_setup()};
  SurfaceState state{engine.particles(), {capacity}, capacities(), reference + 5};
  core::Timers timers;
  Bed() { engine.attach(state); }
  void run(int outer_steps) {
    for (int n = 0; n < outer_steps; ++n) {
      engine.prepare_outer_step();
      engine.advance(20, timers);
    }
  }
};

TEST(SurfaceState, FollowsSortsFeedsAndDepartures) {
  Bed bed;
  constexpr int count = 405;
  bed.engine.set_particles(make_seeds(count));
  set(bed.state, count);
  expect_own(bed.engine, bed.state, count);
  const SurfaceTotals before = bed.state.compute_totals();
  // By hand: liquid sum id 1e-9 = 1e-9 n (n - 1) / 2, solids three times as much.
  EXPECT_NEAR(before.film.liquid, 1e-9 * count * (count - 1) / 2, 1e-18);
  EXPECT_NEAR(before.film.solids, 3e-9 * count * (count - 1) / 2, 1e-18);
  Real enthalpy = 0;
  for (int id = 0; id < count; ++id) {
    const Real heat_capacity =
        density * dem::sphere_volume(radius) * capacity + 4000e-9 * id + 3 * 1200e-9 * id;
    enthalpy += heat_capacity * (temperature_of(id) - reference);
  }
  EXPECT_NEAR(before.enthalpy, enthalpy, 1e-13 * enthalpy);

  bed.run(100);  // 20 ms: some of the fastest have flown out of the top, memory was sorted once
  const Index left = count - bed.engine.particles().count;
  ASSERT_GT(left, 20);
  ASSERT_LT(left, count - 20);
  expect_own(bed.engine, bed.state, count);
  std::vector<dem::ParticleSeed> fed = make_seeds(7);
  bed.engine.add_particles(fed);
  expect_own(bed.engine, bed.state, count);
  const Real fed_enthalpy = 7 * density * dem::sphere_volume(radius) * capacity * 5;
  EXPECT_NEAR(bed.state.entered().enthalpy, fed_enthalpy, 1e-13 * fed_enthalpy);
  bed.run(70);
  expect_own(bed.engine, bed.state, count);
  const SurfaceTotals now = bed.state.compute_totals();
  // What is there, what left and what came close to the round-off of a few hundred terms.
  EXPECT_NEAR(now.film.liquid + bed.state.left().film.liquid, before.film.liquid, 1e-14 * before.film.liquid);
  EXPECT_NEAR(now.film.solids + bed.state.left().film.solids, before.film.solids, 1e-14 * before.film.solids);
  EXPECT_NEAR(now.enthalpy + bed.state.left().enthalpy - fed_enthalpy, before.enthalpy,
              1e-14 * before.enthalpy);
}

TEST(SurfaceState, GoesThroughACheckpoint) {
  const tests::TemporaryFolder folder;
  Bed bed;
  constexpr int count = 243;
  bed.engine.set_particles(make_seeds(count));
  set(bed.state, count);
  bed.run(120);
  ASSERT_LT(bed.engine.particles().count, count);
  bed.engine.canonicalise();
  {
    core::CheckpointWriter file(folder.path() / "checkpoint.h5");
    bed.engine.save(file);
    file.close();
  }
  Bed resumed;
  core::CheckpointReader file(folder.path() / "checkpoint.h5");
  resumed.engine.load(file);
  ASSERT_EQ(resumed.engine.particles().count, bed.engine.particles().count);
  expect_own(resumed.engine, resumed.state, count);
  bed.run(10);
  resumed.run(10);
  expect_own(resumed.engine, resumed.state, count);
  EXPECT_EQ(resumed.state.compute_totals().enthalpy, bed.state.compute_totals().enthalpy);
  EXPECT_EQ(resumed.state.left().film.liquid, bed.state.left().film.liquid);
}

/// The hook sees every substep once, before the particles move.
TEST(SurfaceState, HookRunsBeforeParticlesMove) {
  Bed bed;
  bed.engine.set_particles(make_seeds(1));
  std::vector<int> seen;
  std::vector<Real> heights;
  bed.engine.advance(3, bed.timers, [&](int k) {
    seen.push_back(k);
    heights.push_back(dem::host_copy(bed.engine.particles().position_radius, 1)(0).z);
  });
  EXPECT_EQ(seen, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(heights[0], 0.5 * spacing);
  EXPECT_NEAR(heights[2] - heights[0], 2 * 1e-5, 1e-12);  // 1 m/s, no gravity
}

}  // namespace
}  // namespace pellicle::heat
