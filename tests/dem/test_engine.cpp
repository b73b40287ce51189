// The engine: what must be conserved, what stops a run, and going on after a checkpoint as if nothing had happened.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

using tests::advance;
using tests::Grain;
using tests::grains;
using tests::random_vector;

struct Sums {
  Vec3 momentum{}, angular_momentum{};
  Real gross = 0, angular_gross = 0;  // sums of magnitudes, to measure round-off against
};

/// At the half step behind, where velocity has had whole impulses: v − a Δt/2.
Sums sum_half_step(const std::vector<Grain>& all, Real time_step) {
  Sums sums;
  for (const Grain& g : all) {
    const Vec3 v = g.velocity - 0.5 * time_step * g.acceleration;
    const Vec3 spin = g.spin - 0.5 * time_step * g.angular_acceleration;
    const Vec3 orbital = g.mass * cross(g.position, v);
    const Vec3 own = 0.4 * g.mass * g.radius * g.radius * spin;
    sums.momentum += g.mass * v;
    sums.angular_momentum += orbital + own;
    sums.gross += g.mass * norm(v);
    sums.angular_gross += norm(orbital) + norm(own);
  }
  return sums;
}

/// A cloud of overlapping grains of several sizes that fly into each other, in the middle of a wide domain.
std::vector<ParticleSeed> make_cluster(int count, int seed) {
  std::vector<Real> radii(static_cast<std::size_t>(count));
  for (int p = 0; p < count; ++p)
    radii[static_cast<std::size_t>(p)] = 0.001 + 0.0005 * random_vector(seed, p).x;
  const auto centres =
      tests::scatter({{-0.006, -0.006, -0.006}, {0.006, 0.006, 0.006}}, radii, 0.05, seed + 1);
  std::vector<ParticleSeed> seeds;
  for (int p = 0; p < count; ++p) {
    const auto i = static_cast<std::size_t>(p);
    const Vec3 inward = -100.0 * centres[i];
    seeds.push_back({centres[i], inward + random_vector(seed + 2, p), 200.0 * random_vector(seed + 3, p),
                     radii[i], p % 3 == 0 ? 2 : 0, false});
  }
  return seeds;
}

EngineSetup cluster_setup() {
  auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 2e-6);
  setup.domain.box = {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}};
  setup.materials.push_back({"heavy", 8000, 2e7, 0.3, false});
  setup.pairs = {{0, 0, 0.8, 0.4, 0.02}, {0, 2, 0.7, 0.3, 0.05}, {2, 2, 0.6, 0.5, 0.01}};
  return setup;
}

void expect_momentum_and_angular_momentum_constant(const EngineSetup& setup) {
  Engine engine(setup);
  engine.set_particles(make_cluster(100, 31));
  const Sums start = sum_half_step(grains(engine.particles()), setup.time_step);
  std::int64_t contacts = 0;
  Real gross = 0, angular_gross = 0;
  for (int block = 0; block < 40; ++block) {
    advance(engine, 10);
    contacts += engine.collect_report().touching_pairs;
    const Sums now = sum_half_step(grains(engine.particles()), setup.time_step);
    gross = std::max(gross, now.gross);
    angular_gross = std::max(angular_gross, now.angular_gross);
  }
  ASSERT_GT(contacts, 500);
  const Sums end = sum_half_step(grains(engine.particles()), setup.time_step);
  // 400 steps, each a rounding of 1e-16 per particle in v and in x: below 1e-13 even if they all added up.
  EXPECT_LT(norm(end.momentum - start.momentum), 1e-13 * gross);
  EXPECT_LT(norm(end.angular_momentum - start.angular_momentum), 1e-13 * angular_gross);
  // The engine's own sums are these.
  const ParticleTotals totals = engine.compute_totals();
  EXPECT_LT(norm(totals.momentum - end.momentum), 1e-14 * gross);
  EXPECT_LT(norm(totals.angular_momentum - end.angular_momentum), 1e-14 * angular_gross);
}

TEST(Engine, ConservesMomentumAndAngularMomentumOfAFreeCluster) {
  expect_momentum_and_angular_momentum_constant(cluster_setup());
}

TEST(Engine, ConservesThemWithLawsThatRemember) {
  auto setup = cluster_setup();
  tests::let_contacts_remember(setup);
  expect_momentum_and_angular_momentum_constant(setup);
  setup.contacts.tangential = MindlinDeresiewicz{};
  expect_momentum_and_angular_momentum_constant(setup);
  setup.contacts.normal = Linear{};
  for (PairProperties& pair : setup.pairs) pair.normal_stiffness = 2000;
  expect_momentum_and_angular_momentum_constant(setup);
  setup.contacts.cohesion = Willett{1e-11, 0.072, 0.3};
  expect_momentum_and_angular_momentum_constant(setup);
}

TEST(Engine, BooksEveryImpulse) {
  // Grains with two fixed ones among them fall onto a floor and out of the open sides: what the particles have gained
  // is what gravity, the floor and the fixed ones gave them less what left.
  auto setup = tests::glass_setup({0.02, 0.02, 0.02}, 1e-5);
  setup.domain.open_min = {1, 1, 0};
  setup.domain.open_max = {1, 1, 1};
  setup.gravity = {1, 0, -9.81};
  tests::add_box_walls(setup);
  std::vector<ParticleSeed> seeds;
  const auto centres =
      tests::scatter({{0.002, 0.002, 0.002}, {0.018, 0.018, 0.018}}, std::vector<Real>(120, 0.0012), 0, 41);
  for (std::size_t p = 0; p < centres.size(); ++p) {
    seeds.push_back({centres[p], 0.5 * random_vector(42, static_cast<int>(p)), {}, 0.0012, 0, p < 2});
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  const ParticleTotals start = engine.compute_totals();
  Vec3 wall{}, fixed{};
  Real gross = 0;
  for (int block = 0; block < 300; ++block) {
    engine.prepare_outer_step();
    advance(engine, 20);
    const ContactReport report = engine.collect_report();
    wall += report.wall_impulse;
    fixed += report.support_impulse;
    gross += norm(report.wall_impulse);
  }
  engine.prepare_outer_step();
  const std::int64_t gone = engine.left_through_open_sides();
  EXPECT_GT(gone, 5);
  EXPECT_EQ(engine.particles().count + gone, 120);
  EXPECT_GT(norm(wall), 0);
  EXPECT_GT(norm(fixed), 0);
  const ParticleTotals end = engine.compute_totals();
  const Vec3 gained = end.momentum - start.momentum;
  const Vec3 given = engine.gravity_impulse() + wall - fixed - engine.left_momentum();
  // 6000 steps of round-off against the sum of what was exchanged.
  EXPECT_LT(norm(gained - given), 1e-12 * gross);
  for (const Grain& g : grains(engine.particles())) {
    if (g.id >= 2) continue;
    EXPECT_TRUE(g.fixed);
    EXPECT_EQ(g.position, centres[static_cast<std::size_t>(g.id)]);  // felt by others, but never moved
    EXPECT_EQ(g.velocity, seeds[static_cast<std::size_t>(g.id)].velocity);
  }
}

TEST(Engine, PotentialEnergyIsThatOfTheMovingParticles) {
  auto setup = tests::glass_setup({1, 1, 1}, 1e-4);
  setup.gravity = {1, 0, -10};
  Engine engine(setup);
  engine.set_particles({{{0.3, 0.5, 0.6}, {}, {}, 0.01, 0, false}, {{0.7, 0.5, 0.5}, {}, {}, 0.01, 0, true}});
  // −m g·x = −m (1 × 0.3 − 10 × 0.6).
  const Real mass = 2500 * 4.0 / 3.0 * M_PI * 1e-6;
  EXPECT_NEAR(engine.compute_totals().potential_energy, 5.7 * mass, 1e-14 * mass);
}

TEST(Engine, GravityImpulseIsThatOfTheParticlesPresent) {
  auto setup = tests::glass_setup({1, 1, 1}, 1e-4);
  setup.gravity = {0, 0, -10};
  Engine engine(setup);
  engine.set_particles({{{0.3, 0.5, 0.5}, {}, {}, 0.01, 0, false}, {{0.7, 0.5, 0.5}, {}, {}, 0.01, 0, true}});
  advance(engine, 100);
  const Real mass = 2500 * 4.0 / 3.0 * M_PI * 1e-6;
  // The first kick is half a step long; the fixed particle receives nothing.
  EXPECT_NEAR(engine.gravity_impulse().z, -mass * 10 * 99.5e-4, 1e-13 * mass);
  EXPECT_NEAR(engine.compute_totals().momentum.z, -mass * 10 * 99.5e-4, 1e-13 * mass);
  EXPECT_NEAR(engine.volume_time(), 4.0 / 3.0 * M_PI * 1e-6 * 99.5e-4, 1e-13 * 4e-8);
}

TEST(Engine, OpenSidesLetParticlesLeaveAndCountThem) {
  auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-5);
  setup.domain.open_max = {0, 0, 1};
  setup.domain.open_min = {1, 0, 0};
  setup.domain.periodic = {0, 1, 0};
  Engine engine(setup);
  engine.set_particles({{{0.05, 0.05, 0.0999}, {0, 0, 1}, {}, 0.001, 0, false},
                        {{0.05, 0.02, 0.05}, {0, -100, 0}, {}, 0.001, 0, false},
                        {{0.0001, 0.05, 0.05}, {-1, 0, 0}, {}, 0.002, 0, false},
                        {{0.02, 0.05, 0.05}, {0, 0, 0}, {}, 0.001, 0, false}});
  engine.prepare_outer_step();
  EXPECT_EQ(engine.left_through_open_sides(), 0);
  advance(engine, 20);
  engine.prepare_outer_step();
  EXPECT_EQ(engine.left_through_open_sides(), 2);
  EXPECT_EQ(engine.particles().count, 2);
  const Real mass = 2500 * 4.0 / 3.0 * M_PI * 1e-9;
  EXPECT_NEAR(engine.left_momentum().z, mass, 1e-13 * mass);
  EXPECT_NEAR(engine.left_momentum().x, -8 * mass, 1e-13 * mass);
  const auto& by_side = engine.left_by_side();  // left, right, front, back, bottom, top
  for (std::size_t side = 0; side < by_side.size(); ++side) {
    EXPECT_EQ(by_side[side].particles, side == 0 || side == 5 ? 1 : 0) << side;
    EXPECT_NEAR(by_side[side].mass, (side == 0 ? 8 : side == 5 ? 1 : 0) * mass, 1e-14 * mass) << side;
  }
  const auto rest = grains(engine.particles());
  EXPECT_EQ(rest[0].id, 1);
  EXPECT_EQ(rest[1].id, 3);
  advance(engine, 200);  // 0.22 m along y, wrapped wherever the lists were built
  engine.prepare_outer_step();
  const Real y = grains(engine.particles())[0].position.y;
  EXPECT_NEAR(std::remainder(y - (0.02 - 0.22), 0.1), 0, 1e-12);
  EXPECT_GT(y, -0.01);
  EXPECT_LT(y, 0.11);
}

template <class F>
std::string run_error(F&& function) {
  try {
    function();
  } catch (const RunError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Engine, StopsForAParticleBeyondAClosedSide) {
  auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-5);  // closed on all sides, but no wall holds
  setup.domain.open_max = {1, 0, 0};
  Engine engine(setup);
  engine.set_particles({{{0.05, 0.05, 0.05}, {}, {}, 0.001, 0, false},
                        {{0.0999, 0.05, 0.0001}, {2, 0, -3}, {}, 0.001, 0, false}});
  engine.prepare_outer_step();
  advance(engine, 10);
  const std::string message = run_error([&] { engine.prepare_outer_step(); });
  EXPECT_NE(message.find("particle 1 is outside the domain at (0.1001"), std::string::npos) << message;
  EXPECT_EQ(engine.left_through_open_sides(), 0);
}

TEST(Engine, StopsForTooLargeAnOverlap) {
  auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-6);
  setup.contacts.overlap_limit = 0.3;
  const auto overlap_of = [&setup](Real gap, bool fixed) {
    Engine engine(setup);
    // The smaller radius counts: spheres of 1 and 3 mm.
    engine.set_particles({{{0.05, 0.05, 0.05}, {}, {}, 0.001, 0, fixed},
                          {{0.05, 0.05, 0.054 - gap}, {}, {}, 0.003, 0, fixed}});
    advance(engine, 1);
    return run_error([&] { engine.collect_report(); });
  };
  EXPECT_EQ(overlap_of(0.00029, false), "no error");
  EXPECT_NE(overlap_of(0.00031, false).find("0.31"), std::string::npos);
  EXPECT_EQ(overlap_of(0.00100, true), "no error") << "fixed bodies may be built into each other";
}

TEST(Engine, StopsForNaN) {
  for (const bool position : {true, false}) {
    auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-5);
    setup.domain.periodic = {1, 1, 1};
    Engine engine(setup);
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    ParticleSeed bad{{0.02, 0.05, 0.05}, {}, {}, 0.001, 0, false};
    (position ? bad.position.y : bad.velocity.y) = nan;
    engine.set_particles({{{0.05, 0.05, 0.05}, {}, {}, 0.001, 0, false}, bad});
    const std::string message = run_error([&] {
      engine.prepare_outer_step();
      advance(engine, 1);
    });
    EXPECT_NE(message.find("particle 1 "), std::string::npos) << message;
    EXPECT_NE(message.find("nan"), std::string::npos) << message;
  }
}

TEST(Engine, RefusesASetupThatCannotWork) {
  auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 0);
  EXPECT_THROW(Engine{setup}, std::invalid_argument);
  setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-5);
  setup.contacts.normal = Linear{};
  EXPECT_THROW(Engine{setup}, std::invalid_argument);  // without a stiffness
  setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-5);
  setup.pairs.pop_back();
  tests::add_box_walls(setup);
  Engine engine(setup);
  EXPECT_THROW(engine.set_particles({{{0.05, 0.05, 0.05}, {}, {}, 0.001, 0, false}}), std::invalid_argument);
}

TEST(Engine, WorksWithoutParticles) {
  Engine engine(tests::glass_setup({0.1, 0.1, 0.1}, 1e-5));
  engine.set_particles({});
  engine.prepare_outer_step();
  advance(engine, 3);
  EXPECT_EQ(engine.collect_report().touching_pairs, 0);
  EXPECT_EQ(engine.compute_totals().mass, 0);
  EXPECT_EQ(engine.substeps(), 3);
}

/// Every bit of the particles, in their order in memory, and the engine's counters.
std::string state_of(const Engine& engine) {
  std::string bytes;
  const auto add = [&bytes](const auto& array, Index count) {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, array);
    bytes.append(reinterpret_cast<const char*>(host.data()),
                 static_cast<std::size_t>(count) * sizeof(*host.data()));
  };
  const Particles& p = engine.particles();
  add(p.position_radius, p.count);
  add(p.velocity_spin, p.count);
  add(p.mass, p.count);
  add(p.acceleration, p.count);
  add(p.angular_acceleration, p.count);
  const Real numbers[] = {engine.gravity_impulse().z,
                          engine.left_momentum().x,
                          engine.left_momentum().y,
                          engine.left_momentum().z,
                          engine.volume_time(),
                          static_cast<Real>(engine.substeps()),
                          static_cast<Real>(engine.list_builds()),
                          static_cast<Real>(engine.left_through_open_sides())};
  bytes.append(reinterpret_cast<const char*>(numbers), sizeof(numbers));
  return bytes;
}

void run_outer_steps(Engine& engine, int count) {
  for (int k = 0; k < count; ++k) {
    engine.prepare_outer_step();
    advance(engine, 10);
  }
}

void expect_to_continue_bit_for_bit(bool remembers) {
  // A busy bed: two materials and sizes, friction, rolling resistance at its cap, a periodic axis, an open top that
  // some leave through, more cells than there may be for so few particles: the canonical order, the cell grid and the
  // sums all differ from those of a fresh start.
  auto setup = tests::glass_setup({0.3, 0.015, 0.3}, 5e-6, 0.7, 0.3, 0.5);
  setup.materials.push_back({"heavy", 8000, 2e7, 0.3, false});
  setup.pairs.push_back({0, 2, 0.8, 0.2, 0.01});
  setup.pairs.push_back({2, 2, 0.9, 0.4, 0.02});
  setup.pairs.push_back({2, 1, 0.9, 0.4, 0.02});
  setup.domain.periodic = {0, 1, 0};
  setup.domain.box.min.z = -0.28;
  setup.domain.box.max.z = 0.02;
  setup.domain.open_max = {0, 0, 1};
  setup.gravity = {0, 5, -200};  // settles within the test
  tests::add_box_walls(setup);
  setup.walls.emplace_back(PlaneWall{"partition", {0.02, 0, 0}, {-1, 0, 0}, {}, 1});
  setup.walls.emplace_back(PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 1});
  if (remembers) {
    tests::let_contacts_remember(setup);
    setup.contacts.cohesion = Willett{1e-11, 0.072, 0.3};
  }
  std::vector<Real> radii(150);
  for (std::size_t p = 0; p < 150; ++p) radii[p] = p % 4 == 0 ? 0.0015 : 0.0009;
  const auto centres = tests::scatter({{0.002, 0.0015, 0.002}, {0.018, 0.0135, 0.018}}, radii, 0, 51);
  std::vector<ParticleSeed> seeds;
  for (int p = 0; p < 150; ++p) {
    const auto i = static_cast<std::size_t>(p);
    seeds.push_back({centres[i], 2.0 * random_vector(52, p), 100.0 * random_vector(53, p), radii[i],
                     p % 3 == 0 ? 2 : 0, p == 7});
  }
  const tests::TemporaryFolder folder;

  Engine straight(setup);
  straight.set_particles(seeds);
  run_outer_steps(straight, 240);  // past regular re-sorts, and with contacts enough
  straight.collect_report();
  straight.canonicalise();
  {
    core::CheckpointWriter file(folder / "checkpoint.h5");
    straight.save(file);
    file.close();
  }
  ASSERT_GT(straight.left_through_open_sides(), 0);
  run_outer_steps(straight, 60);
  ASSERT_GT(straight.collect_report().touching_pairs, 10);

  Engine resumed(setup);
  core::CheckpointReader file(folder / "checkpoint.h5");
  resumed.load(file);
  EXPECT_EQ(resumed.substeps(), 2400);
  run_outer_steps(resumed, 60);
  EXPECT_TRUE(state_of(straight) == state_of(resumed)) << "the run that was resumed differs";

  // The comparison sees a difference: without canonicalise the straight run sums in another order.
  Engine without(setup);
  without.set_particles(seeds);
  run_outer_steps(without, 300);
  EXPECT_FALSE(state_of(straight) == state_of(without));
}

TEST(Engine, ContinuesBitForBitAfterACheckpoint) { expect_to_continue_bit_for_bit(false); }
TEST(Engine, ContinuesBitForBitWithLawsThatRemember) { expect_to_continue_bit_for_bit(true); }

TEST(Engine, ResortingKeepsWhatBelongsToAParticle) {
  // Chains of three that are squeezed together while they fly, each at its own speed. The one in the middle has two
  // contacts and shares its rolling torque among them. A sum of two does not depend on their order, so that it makes
  // no difference at all whether memory was re-sorted on the way.
  auto setup = tests::glass_setup({0.2, 0.2, 0.2}, 2e-6, 0.7, 0.3, 0.5);
  std::vector<ParticleSeed> seeds;
  for (int chain = 0; chain < 40; ++chain) {
    const Vec3 x{0.02 + 0.02 * (chain % 8), 0.05, 0.02 + 0.03 * (chain % 5)};
    const Vec3 n = (1 / norm(random_vector(71, chain))) * random_vector(71, chain);
    const Vec3 drift{0, 10 + 2.0 * (chain * 7 % 13), 0};
    for (int k = -1; k <= 1; ++k) {
      const int id = 3 * chain + k + 1;
      seeds.push_back({x + (0.00195 * k) * n, drift - (0.3 * k) * n, random_vector(72, id), 0.001, 0, false});
    }
  }
  const auto run = [&](bool sort) {
    Engine engine(setup);
    engine.set_particles(seeds);
    advance(engine, 60);
    const auto memory = state_of(engine);
    if (sort) engine.canonicalise();
    EXPECT_EQ(memory != state_of(engine), sort) << "sorting was to change the order";
    advance(engine, 40);
    EXPECT_GT(engine.collect_report().touching_pairs, 40);
    return grains(engine.particles());
  };
  const auto straight = run(false);
  const auto sorted = run(true);
  for (std::size_t p = 0; p < straight.size(); ++p) {
    EXPECT_EQ(straight[p].position, sorted[p].position) << p;
    EXPECT_EQ(straight[p].velocity, sorted[p].velocity) << p;
    EXPECT_EQ(straight[p].spin, sorted[p].spin) << p;
  }
}

TEST(Engine, ResumesAfterTheLastParticleHasLeft) {
  auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-5);
  setup.domain.open_max = {0, 0, 1};
  const tests::TemporaryFolder folder;
  Engine engine(setup);
  engine.set_particles({{{0.05, 0.05, 0.0999}, {0, 0, 5}, {}, 0.001, 0, false}});
  run_outer_steps(engine, 5);
  ASSERT_EQ(engine.particles().count, 0);
  engine.canonicalise();
  core::CheckpointWriter writer(folder / "checkpoint.h5");
  engine.save(writer);
  writer.close();
  Engine resumed(setup);
  core::CheckpointReader file(folder / "checkpoint.h5");
  resumed.load(file);
  run_outer_steps(engine, 2);
  run_outer_steps(resumed, 2);
  EXPECT_EQ(resumed.left_through_open_sides(), 1);
  EXPECT_EQ(resumed.left_by_side()[5].particles, 1);
  EXPECT_EQ(resumed.left_by_side()[5].mass, engine.left_mass());
  EXPECT_TRUE(state_of(engine) == state_of(resumed));
}

}  // namespace
}  // namespace pellicle::dem
