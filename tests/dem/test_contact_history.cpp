// Springs in the engine: their stiffness and limit in contacts that slide, bounces against a closed form, and that they
// follow their contacts through everything that moves memory.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

using tests::advance;
using tests::Grain;
using tests::grains;
using tests::random_vector;

/// Two spheres of 1.5 mm, one fixed, that overlap by 0.03 mm: the other is so heavy that nothing changes its speed.
/// Restitution 1, µ 0.3. E 1e7 Pa, ν 0.25: E* = 16/3 MPa, G* = 8/7 MPa.
struct HeavyPair {
  EngineSetup setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-6, 1.0, 0.3, 0.1);
  std::vector<ParticleSeed> seeds;

  HeavyPair() {
    setup.materials[0].density = 1e20;
    setup.contacts.tangential = Mindlin{};
    setup.contacts.rolling = NoRolling{};
    const Vec3 x{0.05, 0.05, 0.05};
    seeds.push_back({x, {}, {}, 1.5e-3, 0, true});
    seeds.push_back({x + Vec3{0, 0, 2.97e-3}, {0.01, 0, 0}, {}, 1.5e-3, 0, false});
  }
};

/// Force on the heavy sphere, along the line from the fixed one and across it towards x, as it was when the force acted:
/// before the last move.
struct Force {
  Real normal, tangential;
};
Force force_on_heavy(const Engine& engine) {
  const auto all = grains(engine.particles());
  const Vec3 d = all[1].position - 1e-6 * all[1].velocity - all[0].position;
  const Vec3 n = (1 / norm(d)) * d;
  const Vec3 force = all[1].mass * all[1].acceleration;
  const Vec3 t = Vec3{n.z, 0, -n.x};
  return {dot(force, n), dot(force, t)};
}

TEST(ContactHistory, LoadsWithTheMindlinStiffnessUpToTheLimit) {
  const HeavyPair pair;
  Engine engine(pair.setup);
  engine.set_particles(pair.seeds);
  // 8 G* √(R* δ) with R* = 0.75 mm, δ = 0.03 mm.
  const Real stiffness = 8 * (8e6 / 7) * std::sqrt(0.75e-3 * 0.03e-3);
  for (const int step : {1, 2, 10, 60}) {
    while (engine.substeps() < step) advance(engine, 1);
    // At the time of this force the sphere has moved (step − 1) times, and half a step before the first is counted: the
    // contact began somewhere within that step. The normal turns by 2e-4 rad, the overlap changes by 4e-6 of itself.
    const Real slip = (step - 0.5) * 1e-6 * 0.01;
    EXPECT_NEAR(force_on_heavy(engine).tangential, -stiffness * slip, 1e-5 * stiffness * slip) << step;
  }
  // It slips after µ F_n/k_t = 7e-6 m, 700 steps, and then bears µ F_n.
  advance(engine, 1000);
  const Force sliding = force_on_heavy(engine);
  // The force is told from the acceleration, which is kept in single precision: 2^-24 of it in each component.
  EXPECT_NEAR(-sliding.tangential / sliding.normal, 0.3, 1e-7);
}

TEST(ContactHistory, TurnsWithAWallAndAParticleThatSpin) {
  // A disc and a heavy sphere on its axis turn alike about it, while the sphere slides off at u along x, by 0.5 rad in all.
  // Seen from the material of both, that is where the contact began, turned, to where it is: ξ = (u t, 0, 0) solves
  // dξ/dt = slip + ω × ξ, slip = (u, −ω u t, 0). Nothing slips: µ is 10. R* and G* are those of a rigid wall.
  const HeavyPair pair;
  EngineSetup setup = pair.setup;
  setup.pairs[1].sliding_friction = 10;
  Wall disc;
  disc.material = 1;
  disc.revolved = {{{0.05, 0.05, 0.05}, {0, 0, 1}, 0, 0, 0.01, 0}};
  disc.motion.spin = {0, 0, 500};
  disc.motion.through = {0.05, 0.05, 0};
  setup.walls = {disc};
  const Real radius = 1.5e-3, overlap = 1e-5, speed = 1e-3;
  Engine engine(setup);
  engine.set_particles(
      {{{0.05, 0.05, 0.05 + radius - overlap}, {speed, 0, 0}, {0, 0, 500}, radius, 0, false}});
  advance(engine, 1000);
  const auto sphere = grains(engine.particles())[0];
  const Real stiffness = 8 * (16e6 / 7) * std::sqrt(radius * overlap);
  const Real expected = stiffness * 999.5e-6 * speed;
  EXPECT_NEAR(sphere.mass * sphere.acceleration.x, -expected, 1e-3 * expected);
  // Half a step of the slip, of ω u t, is not in the balance of both.
  EXPECT_NEAR(sphere.mass * sphere.acceleration.y, 0, 1e-3 * expected);
}

TEST(ContactHistory, BeginsAnewAfterAGap) {
  const HeavyPair pair;
  Engine engine(pair.setup);
  engine.set_particles(pair.seeds);
  advance(engine, 30);
  const Force before = force_on_heavy(engine);
  const auto lift = [&engine](Real height) {
    const auto place = engine.particles().position_radius;
    const auto motion = engine.particles().velocity_spin;
    Kokkos::parallel_for(
        "test::contact_history::lift", DeviceRange(0, 2), KOKKOS_LAMBDA(const Index p) {
          if (motion(p).id == 1) place(p).z += height;
        });
    Kokkos::fence();
  };
  const auto builds = engine.list_builds();
  lift(4e-5);  // apart, but within the allowance of 0.15 mm: the list entry stays
  advance(engine, 1);
  EXPECT_EQ(force_on_heavy(engine).normal, 0);
  lift(-4e-5);
  advance(engine, 1);
  EXPECT_EQ(engine.list_builds(), builds);
  const Force after = force_on_heavy(engine);
  EXPECT_NEAR(after.normal / before.normal, 1, 1e-5);
  EXPECT_NEAR(after.tangential / before.tangential, 0.5 / 29.5, 1e-5);  // half a step, as at the first touch
}

/// Speeds after the collision of two equal spheres with linear springs that stick: across the line of centres the
/// contact point swings with ω_t² = (7/2) k_t/m* for half a period of ω_n² = k/m*, so that its relative speed becomes
/// cos(π √(7/2 · k_t/k)) of what it was. No loss: restitution 1.
TEST(ContactHistory, BouncesLikeATangentialPendulum) {
  struct Case {
    int steps;  // of half a normal period
    Real tolerance;
  };
  // The spheres touch in the middle of a step, so that forces act evenly about the middle of the contact; a phase that is
  // one step off would show as sin(π √3) ω_t Δt = 4/steps, slip taken in whole steps instead of halves as a damping of
  // 5/steps. The line of centres turns by 1e-4 rad.
  for (const Case c : {Case{100, 0.01}, Case{2000, 1e-3}}) {
    auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 1, 1.0, 1e4, 0);
    const Real radius = 1.5e-3;
    const Real mass = 2500 * 4.0 / 3.0 * M_PI * radius * radius * radius;
    for (PairProperties& pair : setup.pairs) pair.normal_stiffness = 1e6;
    setup.contacts.normal = Linear{};
    setup.contacts.tangential = Mindlin{};
    setup.contacts.rolling = NoRolling{};
    const Real duration = M_PI * std::sqrt(0.5 * mass / 1e6);
    setup.time_step = duration / c.steps;
    Engine engine(setup);
    const Vec3 x{0.05, 0.05, 0.05};
    const Vec3 speed{0.1, 0.05, 0};  // half of the approach, half of the slip
    const Vec3 apart{radius + 0.05 * setup.time_step, 0, 0};
    engine.set_particles(
        {{x - apart, speed, {}, radius, 0, false}, {x + apart, -speed, {}, radius, 0, false}});
    advance(engine, c.steps + c.steps / 10);
    ASSERT_EQ(engine.collect_report().touching_pairs, 0);
    const auto all = grains(engine.particles());
    const Vec3 slip =
        all[0].velocity - all[1].velocity + radius * cross(all[0].spin + all[1].spin, Vec3{1, 0, 0});
    EXPECT_NEAR(slip.x / 0.2, -1, 1e-3 + 1.0 / (c.steps * c.steps));
    // k_t/k = 4 G*/E* = 2 (1 − ν)/(2 − ν) = 6/7: cos(π √3).
    EXPECT_NEAR(slip.y / 0.1, std::cos(M_PI * std::sqrt(3.0)), c.tolerance);
  }
}

/// Chains of three that are squeezed and sheared while they fly, each at its own speed; a sum of two does not depend on
/// its order, so that nothing that moves memory may make any difference at all.
std::vector<ParticleSeed> make_chains() {
  std::vector<ParticleSeed> seeds;
  for (int chain = 0; chain < 40; ++chain) {
    const Vec3 x{0.02 + 0.02 * (chain % 8), 0.05, 0.02 + 0.03 * (chain % 5)};
    const Vec3 n = (1 / norm(random_vector(71, chain))) * random_vector(71, chain);
    const Vec3 drift{0, 10 + 2.0 * (chain * 7 % 13), 0};
    for (int k = -1; k <= 1; ++k) {
      const int id = 3 * chain + k + 1;
      seeds.push_back({x + (0.00195 * k) * n, drift - (0.3 * k) * n + 0.1 * random_vector(73, id),
                       100.0 * random_vector(72, id), 0.001, 0, false});
    }
  }
  return seeds;
}

EngineSetup chain_setup() {
  auto setup = tests::glass_setup({0.2, 0.2, 0.2}, 2e-6, 0.7, 0.5, 0.5);
  setup.domain.open_max = {0, 1, 0};
  setup.contacts.tangential = Mindlin{};
  setup.contacts.rolling = Epsd2{};
  return setup;
}

void expect_same(const std::vector<Grain>& a, const std::vector<Grain>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t p = 0; p < a.size(); ++p) {
    ASSERT_EQ(a[p].id, b[p].id);
    EXPECT_EQ(a[p].position, b[p].position) << p;
    EXPECT_EQ(a[p].velocity, b[p].velocity) << p;
    EXPECT_EQ(a[p].spin, b[p].spin) << p;
  }
}

TEST(ContactHistory, SurvivesRebuildsAndResorts) {
  const auto run = [](const SkinOptions& skin, bool sort) {
    auto setup = chain_setup();
    setup.skin = skin;
    Engine engine(setup);
    engine.set_particles(make_chains());
    for (int block = 0; block < 10; ++block) {
      advance(engine, 10);
      if (sort) engine.canonicalise();
    }
    EXPECT_GT(engine.collect_report().touching_pairs, 40);
    return std::pair(grains(engine.particles()), engine.list_builds());
  };
  const auto [straight, builds] = run({26, 0.1, 0.4}, false);
  const auto [rebuilt, more_builds] = run({1, 0.001, 0.4}, false);
  const auto [sorted, sorted_builds] = run({26, 0.1, 0.4}, true);
  EXPECT_GT(more_builds, builds + 20);
  expect_same(straight, rebuilt);
  expect_same(straight, sorted);
}

TEST(ContactHistory, SurvivesParticlesThatLeave) {
  // Every second particle of the second run is one that flies out and leaves a gap in memory.
  const auto run = [](bool visitors) {
    Engine engine(chain_setup());
    auto seeds = make_chains();
    const std::size_t chains = seeds.size();
    for (int k = 0; visitors && k < 120; ++k) {
      const int row = k / 40;
      seeds.push_back(
          {{0.004 * (k % 40) + 0.02, 0.199 - 0.0025 * row, 0.17}, {0, 60, 0}, {}, 0.0005, 0, false});
    }
    engine.set_particles(seeds);
    for (int block = 0; block < 20; ++block) {
      engine.prepare_outer_step();
      advance(engine, 5);
    }
    engine.prepare_outer_step();
    EXPECT_EQ(engine.left_through_open_sides(), visitors ? 120 : 0);
    auto all = grains(engine.particles());
    EXPECT_EQ(all.size(), chains);
    return all;
  };
  expect_same(run(false), run(true));
}

}  // namespace
}  // namespace pellicle::dem
