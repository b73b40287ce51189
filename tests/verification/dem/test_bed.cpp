// Many spheres: what must stay at rest, what must stay constant, what must not depend on threads.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "dem/fill.hpp"
#include "tests/dem/bed.hpp"
#include "tests/dem/child_process.hpp"

namespace pellicle::dem {
namespace {

using tests::advance;
using tests::glass_mass;
using tests::glass_setup;
using tests::glass_wall_modulus;
using tests::Grain;
using tests::grains;
using tests::random_vector;

constexpr Real g = 9.81;
constexpr Real pair_modulus = 0.5 * glass_wall_modulus;

/// Overlap at which a Hertz contact carries a force.
Real overlap_of(Real force, Real modulus, Real reduced_radius) {
  return std::pow(0.75 * force / (modulus * std::sqrt(reduced_radius)), 2.0 / 3.0);
}

TEST(Bed, ALatticeBetweenWallsThatNeedsNoFrictionStaysAtRest) {
  // A cubic lattice of 4 x 4 x 5 spheres. Each carries those above it, on the overlap that Hertz gives; sideways all
  // press with the same small force against each other and the walls. All contact forces run through the centres, so
  // that neither friction nor anything hidden is needed.
  const Real radius = 0.0015;
  const Real weight = glass_mass(radius) * g;
  const int n = 4, layers = 5;
  const Real side_force = 0.5 * weight;
  const Real pitch = 2 * radius - overlap_of(side_force, pair_modulus, radius / 2);
  const Real edge = radius - overlap_of(side_force, glass_wall_modulus, radius);
  const Real width = 2 * edge + (n - 1) * pitch;
  auto setup = glass_setup({width, width, 0.02}, 1e-5, 0.9, 0.3, 0.01);
  setup.gravity = {0, 0, -g};
  setup.domain.open_max.z = 1;
  tests::add_box_walls(setup);
  std::vector<ParticleSeed> seeds;
  Real z = radius - overlap_of(layers * weight, glass_wall_modulus, radius);
  for (int k = 0; k < layers; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        seeds.push_back({{edge + i * pitch, edge + j * pitch, z}, {}, {}, radius, 0, false});
      }
    }
    z += 2 * radius - overlap_of((layers - 1 - k) * weight, pair_modulus, radius / 2);
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  for (int block = 0; block < 200; ++block) {
    engine.prepare_outer_step();
    advance(engine, 10);
    engine.collect_report();
  }
  // 20 ms, 100 times the time in which a sphere would fall through an overlap. Forces of pairs are found in single
  // precision, 6e-8, and so they balance, on a sphere that bears others as on one that does not.
  const Real fall_speed = g * 0.02;
  Real largest_speed = 0, largest_spin = 0, largest_shift = 0;
  const auto all = grains(engine.particles());
  for (std::size_t p = 0; p < all.size(); ++p) {
    largest_speed = std::max(largest_speed, norm(all[p].velocity));
    largest_spin = std::max(largest_spin, norm(all[p].spin) * radius);
    largest_shift = std::max(largest_shift, norm(all[p].position - seeds[p].position));
  }
  EXPECT_LT(largest_speed, 1e-8 * fall_speed);
  EXPECT_LT(largest_spin, 1e-8 * fall_speed);
  EXPECT_LT(largest_shift, 1e-8 * radius);
}

/// Mean speed of settled grains, and what else is on record about them.
struct Creep {
  Real mean_speed = 0, largest_speed = 0, sinking = 0;  // [m/s]
};

/// Lets grains fall and rest for `settle`, then watches them for `watch` [s].
Creep measure_creep(Engine& engine, Real settle, Real watch) {
  const auto run = [&engine](Real duration) {
    const auto outer = static_cast<int>(std::lround(duration / (10 * engine.setup().time_step)));
    for (int k = 0; k < outer; ++k) {
      engine.prepare_outer_step();
      advance(engine, 10);
    }
  };
  run(settle);
  engine.collect_report();
  Creep creep;
  const Real height = engine.compute_totals().mean_height;
  const int samples = 20;
  for (int s = 0; s < samples; ++s) {
    run(watch / samples);
    for (const Grain& grain : grains(engine.particles())) {
      if (grain.fixed) continue;
      creep.mean_speed += norm(grain.velocity) / samples;
      creep.largest_speed = std::max(creep.largest_speed, norm(grain.velocity));
    }
  }
  creep.mean_speed *= glass_mass(0.0015) / engine.compute_totals().mass;
  creep.sinking = (height - engine.compute_totals().mean_height) / watch;
  return creep;
}

void report(const char* name, const Creep& creep, Real time_step) {
  std::printf(
      "creep of %s at a step of %g s: mean speed %.2g m/s, largest %.2g m/s, centre of mass sinks %.2g m/s\n",
      name, time_step, creep.mean_speed, creep.largest_speed, creep.sinking);
  ::testing::Test::RecordProperty(std::string(name) + "_mean_creep_speed", std::to_string(creep.mean_speed));
}

// Friction without history resists with η_t v and cannot hold: what a contact has to hold against slides at F_t/η_t,
// η_t = m*/(21 Δt) at most. A weight m g on the contact of a pair (m* = m/2) slides at 42 g Δt. The measured speeds are
// for the record (docs/theory/dem.md); that they stay below this scale says that the pile has settled.
constexpr Real creep_scale = 42 * g * 1e-5;

TEST(Bed, CreepSpeedOfARandomPackingIsReported) {
  const Real radius = 0.0015;
  auto setup = glass_setup({0.024, 0.024, 0.1}, 1e-5, 0.9, 0.3);
  setup.gravity = {0, 0, -g};
  setup.domain.open_max.z = 1;
  tests::add_box_walls(setup);
  const auto centres = fill_region(Box{{0, 0, 0}, {0.024, 0.024, 0.06}}, FillPattern::random,
                                   std::vector<Real>(500, radius), 5);
  ASSERT_EQ(centres.size(), 500U);
  std::vector<ParticleSeed> seeds;
  seeds.reserve(centres.size());
  for (const Vec3& x : centres) seeds.push_back({x, {}, {}, radius, 0, false});
  Engine engine(setup);
  engine.set_particles(seeds);
  const Creep creep = measure_creep(engine, 0.25, 0.05);
  report("random_packing", creep, setup.time_step);
  EXPECT_EQ(engine.left_through_open_sides(), 0);
  EXPECT_LT(creep.mean_speed, creep_scale);
  // Settled, not collapsed: between a very loose and the closest packing.
  const Real solids = 500 * 4.0 / 3.0 * M_PI * std::pow(radius, 3) /
                      (0.024 * 0.024 * 2 * engine.compute_totals().mean_height);
  EXPECT_GT(solids, 0.45);
  EXPECT_LT(solids, 0.74);
}

TEST(Bed, CreepSpeedOfAGentleSlopeIsReported) {
  // A layer on a floor of fixed grains, inclined by 10 degrees and endless (periodic): with friction 0.3 real grains
  // rest up to 20 degrees or so. Without history it flows, faster than a packing between walls creeps.
  const Real radius = 0.0015;
  const Real slope = 10 * M_PI / 180;
  auto setup = glass_setup({0.024, 0.024, 0.1}, 1e-5, 0.9, 0.3);
  setup.gravity = {g * std::sin(slope), 0, -g * std::cos(slope)};
  setup.domain.periodic = {1, 1, 0};
  setup.domain.open_max.z = 1;
  std::vector<ParticleSeed> seeds;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      seeds.push_back({{0.003 * i + 0.0015, 0.003 * j + 0.0015, radius}, {}, {}, radius, 0, true});
    }
  }
  const auto centres = fill_region(Box{{0, 0, 0.003}, {0.024, 0.024, 0.04}}, FillPattern::random,
                                   std::vector<Real>(320, radius), 6);
  ASSERT_EQ(centres.size(), 320U);
  for (const Vec3& x : centres) seeds.push_back({x, {}, {}, radius, 0, false});
  Engine engine(setup);
  engine.set_particles(seeds);
  const Creep creep = measure_creep(engine, 0.25, 0.05);
  const ParticleTotals totals = engine.compute_totals();
  report("slope_of_10_degrees", creep, setup.time_step);
  std::printf("  downhill on the mean %.2g m/s\n", totals.momentum.x / totals.mass);
  EXPECT_LT(creep.mean_speed, creep_scale);
  EXPECT_EQ(engine.left_through_open_sides(), 0);
}

TEST(Bed, UndampedGasKeepsItsEnergy) {
  // Elastic, frictionless spheres in a periodic box. Whenever none touch, their kinetic energy is the initial one.
  const Real radius = 0.0015;
  const Real speed = 1;
  const Real mass = glass_mass(radius);
  const Real contact_time =
      2.87 * std::pow(0.25 * mass * mass / (0.5 * radius * pair_modulus * pair_modulus * speed), 0.2);
  auto setup = glass_setup({0.03, 0.03, 0.03}, contact_time / 40, 1, 0);
  setup.domain.periodic = {1, 1, 1};
  const auto centres = tests::scatter({{0.0015, 0.0015, 0.0015}, {0.0285, 0.0285, 0.0285}},
                                      std::vector<Real>(60, radius), 0, 71);
  std::vector<ParticleSeed> seeds;
  for (int p = 0; p < 60; ++p) {
    const Vec3 spin = 100.0 * random_vector(73, p);  // nothing acts on it
    seeds.push_back(
        {centres[static_cast<std::size_t>(p)], speed * random_vector(72, p), spin, radius, 0, false});
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  const auto energies = [&] {
    std::array<Real, 2> sum{};
    for (const Grain& s : grains(engine.particles())) {
      sum[0] += 0.5 * mass * norm_squared(s.velocity);
      sum[1] += 0.2 * mass * radius * radius * norm_squared(s.spin);
    }
    return sum;
  };
  const auto start = energies();
  int free_moments = 0;
  std::int64_t contact_steps = 0;
  Real largest_error = 0;
  for (int step = 0; step < 6000; ++step) {
    advance(engine, 1);
    const auto touching = engine.collect_report().touching_pairs;
    contact_steps += touching;
    if (touching != 0) continue;
    ++free_moments;
    largest_error = std::max(largest_error, std::abs(energies()[0] / start[0] - 1));
  }
  std::printf("energy of an elastic gas: %lld collisions or so, largest deviation %.2g\n",
              static_cast<long long>(contact_steps / 40), largest_error);
  EXPECT_GT(contact_steps / 40, 100);
  EXPECT_GT(free_moments, 20);
  EXPECT_LT(largest_error, 1e-3);
  EXPECT_EQ(energies()[1], start[1]);
  const ParticleTotals totals = engine.compute_totals();
  const auto end = energies();
  EXPECT_NEAR(totals.kinetic_energy / (end[0] + end[1]), 1, 1e-13);
}

/// A bed with everything in it that could depend on threads: two materials and sizes, walls, a periodic axis, an open
/// top, re-sorts and many list builds; with laws that remember or not. Returns a hash (FNV-1a) of every bit of its state.
std::uint64_t run_busy_bed(bool remembers) {
  auto setup = glass_setup({0.05, 0.03, 0.05}, 5e-6, 0.8, 0.3, 0.02);
  setup.materials.push_back({"heavy", 8000, 2e7, 0.3, false});
  setup.pairs.insert(setup.pairs.end(),
                     {{0, 2, 0.8, 0.2, 0.01}, {2, 2, 0.9, 0.4, 0.02}, {2, 1, 0.9, 0.4, 0.02}});
  setup.domain.periodic = {0, 1, 0};
  setup.domain.open_max.z = 1;
  setup.gravity = {0, 1, -300};
  tests::add_box_walls(setup);
  if (remembers) tests::let_contacts_remember(setup);
  std::vector<Real> radii(900);
  for (std::size_t p = 0; p < radii.size(); ++p) radii[p] = p % 4 == 0 ? 0.0015 : 0.001;
  const auto centres = fill_region(Box{{0, 0, 0}, {0.05, 0.03, 0.05}}, FillPattern::random, radii, 81);
  std::vector<ParticleSeed> seeds;
  for (int p = 0; p < 900; ++p) {
    const auto i = static_cast<std::size_t>(p);
    seeds.push_back({centres.at(i), 3.0 * random_vector(82, p), 100.0 * random_vector(83, p), radii[i],
                     p % 3 == 0 ? 2 : 0, p == 7});
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  for (int outer = 0; outer < 150; ++outer) {
    engine.prepare_outer_step();
    advance(engine, 10);
  }
  const ContactReport contacts = engine.collect_report();
  const ParticleTotals totals = engine.compute_totals();
  EXPECT_GT(contacts.touching_pairs, 50);
  EXPECT_GT(engine.left_through_open_sides(), 0);
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&hash](const void* data, std::size_t size) {
    for (std::size_t b = 0; b < size; ++b) {
      hash = (hash ^ static_cast<const unsigned char*>(data)[b]) * 0x100000001b3;
    }
  };
  for (const Grain& s : grains(engine.particles())) {
    add(&s.position, sizeof(Vec3));
    add(&s.velocity, sizeof(Vec3));
    add(&s.spin, sizeof(Vec3));
  }
  add(&contacts.largest_overlap, sizeof(Real));
  add(&contacts.wall_impulse, sizeof(Vec3));
  add(&contacts.support_impulse, sizeof(Vec3));
  add(&contacts.touching_pairs, sizeof(std::int64_t));
  add(&totals.momentum, sizeof(Vec3));
  add(&totals.angular_momentum, sizeof(Vec3));
  add(&totals.kinetic_energy, sizeof(Real));
  const Vec3 left = engine.left_momentum();
  add(&left, sizeof(Vec3));
  return hash;
}

TEST(Bed, IsTheSameBitForBitWithAnyNumberOfThreads) {
  if (tests::is_child()) {
    tests::answer(fmt::format("{} threads {:016x} {:016x}", Host().concurrency(), run_busy_bed(false),
                              run_busy_bed(true)));
    return;
  }
  tests::expect_same_answer({1, 2, 3});
}

}  // namespace
}  // namespace pellicle::dem
