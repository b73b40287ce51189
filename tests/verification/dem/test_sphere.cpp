// One or two spheres against closed solutions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/dem/bed.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using tests::advance;
using tests::glass_mass;
using tests::glass_setup;
using tests::glass_wall_modulus;
using tests::Grain;
using tests::grains;

constexpr Real g = 9.81;

TEST(Sphere, FallsFreely) {
  auto setup = glass_setup({1, 1, 4}, 1e-3);
  setup.gravity = {0.3, 0, -g};
  Engine engine(setup);
  engine.set_particles({{{0.2, 0.5, 3}, {0.1, -0.2, 2}, {1, 2, 3}, 0.01, 0, false}});
  advance(engine, 800);
  const Grain s = grains(engine.particles())[0];
  const Real t = 0.8;
  // Velocity-Verlet is exact for a constant acceleration: what is left is the rounding of 800 sums.
  EXPECT_NEAR(s.position.x, 0.2 + 0.1 * t + 0.15 * t * t, 1e-12);
  EXPECT_NEAR(s.position.y, 0.5 - 0.2 * t, 1e-12);
  EXPECT_NEAR(s.position.z, 3 + 2 * t - 0.5 * g * t * t, 1e-12);
  EXPECT_NEAR(s.velocity.z - 0.5e-3 * s.acceleration.z, 2 - g * (t - 0.5e-3), 1e-12);
  // The velocity at the time of the position is predicted with an acceleration in single precision: 2^-24 g Δt/2.
  EXPECT_NEAR(s.velocity.z, 2 - g * t, 3e-10);
  EXPECT_EQ(s.spin, (Vec3{1, 2, 3}));
}

/// Ratio of separation speed to approach speed of many impacts that begin at different moments within a step: smallest
/// and largest of them. `fraction` is Δt/t_c, t_c the contact time estimated at this speed.
struct Rebound {
  Real smallest = 10, largest = -10;

  void add(const Rebound& other) {
    smallest = std::min(smallest, other.smallest);
    largest = std::max(largest, other.largest);
  }
};

Rebound measure_rebound(Real restitution, Real speed, bool pair, Real fraction) {
  const Real radius = 0.0015;
  const Real reduced_mass = (pair ? 0.5 : 1) * glass_mass(radius);
  const Real reduced_radius = (pair ? 0.5 : 1) * radius;
  const Real modulus = (pair ? 0.5 : 1) * glass_wall_modulus;
  const Real contact_time =
      2.87 * std::pow(reduced_mass * reduced_mass / (reduced_radius * modulus * modulus * speed), 0.2);
  const Real step = fraction * contact_time;
  auto setup = glass_setup({0.4, 0.1, 0.1}, step, restitution, 0.3, 0.01);
  setup.contacts.overlap_limit = 1;
  setup.walls = {PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 1}};
  const int impacts = 16;
  std::vector<ParticleSeed> seeds;
  for (int i = 0; i < impacts; ++i) {
    const Real gap = (1 + (i + 0.37) / impacts) * speed * step;
    const Real x = 0.02 * (i + 1);
    if (pair) {
      const Vec3 n{0.6, 0, 0.8};
      const Vec3 half = (radius + 0.5 * gap) * n;
      seeds.push_back({Vec3{x, 0.05, 0.05} - half, 0.5 * speed * n, {}, radius, 0, false});
      seeds.push_back({Vec3{x, 0.05, 0.05} + half, -0.5 * speed * n, {}, radius, 0, false});
    } else {
      seeds.push_back({{x, 0.05, radius + gap}, {0, 0, -speed}, {}, radius, 0, false});
    }
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  advance(engine, static_cast<int>(3 / fraction));  // at e 0.3 a contact lasts 1.6 t_c
  const auto report = engine.collect_report();
  EXPECT_EQ(report.touching_pairs + report.touching_walls, 0) << "still in contact";
  const auto all = grains(engine.particles());
  Rebound result;
  for (std::size_t i = 0; i < impacts; ++i) {
    const Vec3 n{0.6, 0, 0.8};
    const Real after = pair ? dot(n, all[2 * i + 1].velocity - all[2 * i].velocity) : all[i].velocity.z;
    result.smallest = std::min(result.smallest, after / speed);
    result.largest = std::max(result.largest, after / speed);
  }
  return result;
}

TEST(Sphere, ReboundsWithTheRestitutionAskedFor) {
  // At the largest step that is allowed the scheme itself scatters by about so much: 0.0101, 0.0060 and 0.0010 were
  // measured. Damping sets in with the power δ^(1/4), so the error falls as the step to the power 1.25: a twentieth
  // of the step has 1/40 of it.
  for (const auto& [restitution, scatter] :
       {std::pair{0.30, 0.015}, std::pair{0.70, 0.0065}, std::pair{0.97, 0.001}}) {
    Rebound coarse, fine;
    for (const bool pair : {false, true}) {
      for (const Real speed : {0.05, 1.0, 5.0}) {
        coarse.add(measure_rebound(restitution, speed, pair, 0.05));
        fine.add(measure_rebound(restitution, speed, pair, 0.0025));
      }
    }
    const std::string what = "e " + tests::show(restitution) + " at 0.05, 1 and 5 m/s, floor and pair: ";
    const auto worst = [e = restitution](const Rebound& r) {
      return e - r.smallest > r.largest - e ? r.smallest : r.largest;
    };
    tests::expect_line(what + "restitution out, worst of 96, Δt = t_c/20", restitution, worst(coarse),
                       scatter, "the scheme's own scatter at the largest step allowed");
    tests::expect_line(what + "the same, Δt = t_c/400", restitution, worst(fine), scatter / 40,
                       "the scatter falls as Δt^1.25");
  }
}

TEST(Sphere, ElasticImpactHasHertzsContactTimeAndOverlap) {
  const Real radius = 0.0015;
  const Real mass = glass_mass(radius);
  const Real speed = 0.7;
  // ½ m v² = (8/15) E* √R δ^(5/2); the contact lasts 2 δ/v ∫ dx/√(1 − x^(5/2)) = 2.943275 δ/v (Hertz 1882).
  const Real overlap =
      std::pow(15 * mass * speed * speed / (16 * glass_wall_modulus * std::sqrt(radius)), 0.4);
  const Real contact_time = 2.943275 * overlap / speed;
  const Real step = contact_time / 1000;
  auto setup = glass_setup({0.1, 0.1, 0.1}, step, 1);
  setup.walls = {PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 1}};
  Engine engine(setup);
  engine.set_particles({{{0.05, 0.05, radius + 1.5 * speed * step}, {0, 0, -speed}, {}, radius, 0, false}});
  int touching = 0;
  Real largest_overlap = 0;
  for (int k = 0; k < 1010; ++k) {
    advance(engine, 1);
    const auto report = engine.collect_report();
    touching += static_cast<int>(report.touching_walls);
    largest_overlap = std::max(largest_overlap, report.largest_overlap * radius);
  }
  EXPECT_NEAR(touching, 1000, 2);                   // counted in whole steps at both ends
  EXPECT_NEAR(largest_overlap / overlap, 1, 1e-4);  // O((Δt/t_c)²) and half a step off the peak
  EXPECT_NEAR(grains(engine.particles())[0].velocity.z, speed, 1e-4 * speed);  // O((Δt/t_c)²)
}

/// A sphere at rest on the floor, at the overlap where the floor carries its weight.
struct Resting {
  Real radius = 0.005;
  Real overlap =
      std::pow(0.75 * glass_mass(0.005) * g / (glass_wall_modulus * std::sqrt(0.005)), 2.0 / 3.0);  // Hertz
  Real lever = 0.005 - overlap;
  /// Share of the speed that is left when a sliding sphere rolls: 1/(1 + 0.4 R²/l²), 5/7 for a hard one, from angular
  /// momentum about the line of contact.
  Real rolling_share = 1 / (1 + 0.4 * radius * radius / (lever * lever));

  EngineSetup setup(Real sliding_friction, Real rolling_friction) const {
    auto result = glass_setup({1, 0.1, 0.1}, 1e-5, 0.9, sliding_friction, rolling_friction);
    result.walls = {PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 1}};
    result.gravity = {0, 0, -g};
    return result;
  }
  ParticleSeed seed(const Vec3& velocity, const Vec3& spin) const {
    return {{0.1, 0.05, lever}, velocity, spin, radius, 0, false};
  }
};

TEST(Sphere, SlidesUntilItRolls) {
  const Resting rest;
  const Real friction = 0.3;
  const Real v0 = 0.1;
  Engine engine(rest.setup(friction, 0));
  engine.set_particles({rest.seed({v0, 0, 0}, {0, 0, 0})});
  // It slides for 2 v0/(7 µ g) = 9.7 ms, at a deceleration of µ g and a spin that grows with (5/2) µ g/R.
  advance(engine, 500);
  Grain s = grains(engine.particles())[0];
  // Exact but for the round-off of the overlap (1e-16 R/δ), which the weight depends on.
  EXPECT_NEAR(s.velocity.x, v0 - friction * g * 0.005, 1e-9 * v0);
  EXPECT_NEAR(s.spin.y, 2.5 * friction * g * 0.005 * rest.lever / (rest.radius * rest.radius),
              1e-9 * v0 / rest.radius);
  EXPECT_NEAR(s.position.x, 0.1 + v0 * 0.005 - 0.5 * friction * g * 0.005 * 0.005, 1e-9 * v0);
  advance(engine, 1500);
  s = grains(engine.particles())[0];
  EXPECT_NEAR(s.velocity.x, rest.rolling_share * v0, 1e-9 * v0);
  EXPECT_NEAR(s.spin.y * rest.lever, s.velocity.x, 1e-9 * v0);
  EXPECT_NEAR(s.velocity.x / v0, 5.0 / 7.0, 2 * rest.overlap / rest.radius);  // the lever is short by δ
  EXPECT_NEAR(s.velocity.y, 0, 1e-15);
  EXPECT_NEAR(s.position.z, rest.lever, 1e-6 * rest.overlap);
}

TEST(Sphere, IsTakenAlongByABelt) {
  const Resting rest;
  auto setup = rest.setup(0.3, 0);
  setup.walls[0].motion.surface_velocity = {0, 0.1, 0};
  Engine engine(setup);
  engine.set_particles({rest.seed({0, 0, 0}, {0, 0, 0})});
  advance(engine, 2000);
  const Grain s = grains(engine.particles())[0];
  // In the frame of the belt it slid at -0.1 m/s and now rolls at 5/7 of that: 2/7 of the belt's speed.
  EXPECT_NEAR(s.velocity.y, (1 - rest.rolling_share) * 0.1, 1e-10);
  EXPECT_NEAR(s.velocity.y, 0.1 * 2 / 7, 0.1 * 2 * rest.overlap / rest.radius);
}

TEST(Sphere, RollingResistanceStopsItWithoutReversingIt) {
  const Resting rest;
  const Real rolling = 0.1;
  const Real v0 = 0.02;
  Engine engine(rest.setup(0.5, rolling));
  engine.set_particles({rest.seed({v0, 0, 0}, {0, v0 / rest.lever, 0})});
  // (I/l + m l) dv/dt = −µ_r R m g while it rolls: 5/7 µ_r g for a hard sphere.
  const Real deceleration =
      rolling * g * rest.radius / (0.4 * rest.radius * rest.radius / rest.lever + rest.lever);
  EXPECT_NEAR(deceleration, 5.0 / 7.0 * rolling * g, 0.002 * deceleration);
  const auto steps = static_cast<int>(0.5 * v0 / deceleration / 1e-5);
  advance(engine, steps);
  // The friction that brakes the centre needs a slip, m a/η_t. Here the critical damping of the tangential stiffness
  // 8 G* √(R δ), G* = E/(2 (2 − ν)(1 + ν)), is below the bound of an explicit step, m/(21 Δt).
  const Real mass = glass_mass(rest.radius);
  const Real stiffness = 8 * 1e7 / (2 * 1.75 * 1.25) * std::sqrt(rest.radius * rest.overlap);
  const Real damping = 2 * std::sqrt(stiffness * mass);
  ASSERT_LT(damping, mass / (21 * 1e-5));
  const Real slip = mass * deceleration / damping;
  Grain s = grains(engine.particles())[0];
  EXPECT_NEAR(s.velocity.x, v0 - deceleration * steps * 1e-5, slip);
  EXPECT_NEAR(s.velocity.x - s.spin.y * rest.lever, slip, 0.01 * slip);
  Real lowest = 1;
  for (int k = 0; k < 2 * steps; ++k) {
    advance(engine, 1);
    lowest = std::min(lowest, grains(engine.particles())[0].spin.y);
  }
  s = grains(engine.particles())[0];
  EXPECT_GE(lowest, -1e-12 * v0 / rest.radius);
  EXPECT_NEAR(s.spin.y, 0, 1e-9 * v0 / rest.radius);
  EXPECT_NEAR(s.velocity.x, 0, 1e-9 * v0);
}

TEST(Sphere, RollingResistanceOfManyContactsStopsTheSpinAndNoMore) {
  // Wedged between six walls without friction, 1 % of R in each. Six capped torques of a contact alone would reverse
  // the spin and make it grow.
  const Real radius = 0.005;
  const Real half = 0.99 * radius;
  auto setup = glass_setup({2 * half, 2 * half, 2 * half}, 1e-5, 0.9, 0, 0.1);
  tests::add_box_walls(setup);
  Engine engine(setup);
  engine.set_particles({{{half, half, half}, {}, {30, 20, -10}, radius, 0, false}});
  const Real force = 4.0 / 3.0 * glass_wall_modulus * std::sqrt(radius) * std::pow(0.01 * radius, 1.5);
  const Real inertia = 0.4 * glass_mass(radius) * radius * radius;
  const Real deceleration = 6 * 0.1 * radius * force / inertia;
  const Real start = norm(Vec3{30, 20, -10});
  const auto steps = static_cast<int>(start / deceleration / 1e-5);
  ASSERT_GT(steps, 10);
  Real before = start;
  for (int k = 0; k < 2 * steps + 60; ++k) {
    advance(engine, 1);
    const Vec3 spin = grains(engine.particles())[0].spin;
    // Velocities are those at the time of the position, first moved by half a kick and then half a step ahead.
    if (k + 1 == steps / 2) {
      EXPECT_NEAR(norm(spin), start - deceleration * 1e-5 * (k + 1), 1e-9 * start);
    }
    ASSERT_GE(dot(spin, Vec3{30, 20, -10}), 0) << "reversed in step " << k;
    ASSERT_LE(norm(spin), before) << "grew in step " << k;
    before = norm(spin);
  }
  EXPECT_LT(before, 1e-9 * start);
}

}  // namespace
}  // namespace pellicle::dem
