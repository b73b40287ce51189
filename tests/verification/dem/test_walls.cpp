// Spheres and walls of every kind against closed solutions, and meshes against the exact shapes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/checkpoint.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/dem/bed.hpp"
#include "tests/dem/child_process.hpp"
#include "tests/dem/meshes.hpp"

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

/// Overlap at which Hertz's force on a sphere is F: F = 4/3 E* √R δ^1.5.
Real overlap_at(Real force, Real radius) {
  return std::pow(0.75 * force / (glass_wall_modulus * std::sqrt(radius)), 2.0 / 3.0);
}

Wall mesh_wall(const std::vector<TriangleShape>& triangles) {
  Wall wall;
  wall.name = "mesh";
  wall.material = 1;
  wall.mesh = tests::loose_mesh(triangles);
  return wall;
}

Wall revolved_wall(const RevolvedShape& shape) {
  Wall wall;
  wall.name = "round";
  wall.material = 1;
  wall.revolved = {shape};
  return wall;
}

/// Two triangles that share the diagonal from (0, 0) to (size, size) of a square at z = 0.
std::vector<TriangleShape> square(Real size) {
  const Vec3 a{0, 0, 0}, b{size, 0, 0}, c{size, size, 0}, d{0, size, 0};
  return {{a, b, c}, {a, c, d}};
}

TEST(Walls, SphereRollsOverTheSharedEdgeOfTwoTrianglesAsOverAPlane) {
  // At rest on the floor but for rolling at 0.2 m/s across the diagonal, under every law of friction.
  const Real radius = 1e-3;
  const Real rest = radius - overlap_at(glass_mass(radius) * g, radius);
  for (const bool remembers : {false, true}) {
    auto setup = glass_setup({0.04, 0.04, 0.02}, 5e-6, 0.8, 0.4, 0.02);
    setup.domain.box.min.z = -0.01;
    setup.gravity = {0, 0, -g};
    if (remembers) tests::let_contacts_remember(setup);
    const ParticleSeed seed{
        {0.012, 0.02, rest}, {0.2, 0.02, 0}, {-0.02 / rest, 0.2 / rest, 0}, radius, 0, false};
    const auto run = [&](const Wall& wall) {
      setup.walls = {wall};
      Engine engine(setup);
      engine.set_particles({seed});
      std::vector<Grain> path;
      for (int k = 0; k < 400; ++k) {
        advance(engine, 40);
        // One wall at any time.
        EXPECT_EQ(engine.collect_report().touching_walls, 1);
        path.push_back(grains(engine.particles())[0]);
      }
      return path;
    };
    const auto plane = run(PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 1});
    const auto mesh = run(mesh_wall(square(0.04)));
    ASSERT_LT(plane.front().position.x, plane.front().position.y);
    ASSERT_GT(plane.back().position.x, plane.back().position.y) << "it has to cross the edge";
    for (std::size_t k = 0; k < plane.size(); ++k) {
      // Round-off of 16,000 steps on the way; the edge itself adds nothing.
      EXPECT_LT(norm(mesh[k].position - plane[k].position), 1e-12) << k;
      EXPECT_LT(norm(mesh[k].velocity - plane[k].velocity), 1e-10) << k;
      EXPECT_LT(norm(mesh[k].spin - plane[k].spin), 1e-7) << k;
    }
    // It rolls on as fast as it began, but for rolling resistance: a = g µ_r/(1.4), 0.0143 × 0.08 s.
    EXPECT_NEAR(norm(plane.back().velocity), std::hypot(0.2, 0.02), 0.02);
  }
}

/// Angle from the lowest point of a sphere that rolls in a trough of radius 20 mm along y, every 2 ms.
std::vector<Real> swing(const Wall& trough, int samples) {
  const Real radius = 2e-3;
  auto setup = glass_setup({0.06, 0.04, 0.06}, 1e-5, 0.5, 0.5, 0);
  setup.domain.box = {{-0.03, -0.02, -0.03}, {0.03, 0.02, 0.03}};
  setup.gravity = {0, 0, -g};
  tests::let_contacts_remember(setup);
  setup.contacts.rolling = NoRolling{};
  setup.walls = {trough};
  const Real start = 0.3;
  const Real path = 0.02 - radius + overlap_at(glass_mass(radius) * g * std::cos(start), radius);
  Engine engine(setup);
  engine.set_particles({{{path * std::sin(start), 0, -path * std::cos(start)}, {}, {}, radius, 0, false}});
  std::vector<Real> angles;
  for (int k = 0; k < samples; ++k) {
    advance(engine, 200);
    const Vec3 x = grains(engine.particles())[0].position;
    angles.push_back(std::atan2(x.x, -x.z));
  }
  return angles;
}

/// Time at which a series crosses zero for the first time, in samples, by interpolation.
Real first_zero(const std::vector<Real>& series) {
  for (std::size_t k = 1; k < series.size(); ++k) {
    if (series[k] <= 0) return static_cast<Real>(k) + 1 - series[k] / (series[k] - series[k - 1]);
  }
  return -1;
}

TEST(Walls, SphereSwingsInATubeAsAPendulum) {
  // A sphere that rolls without slip in a trough is a pendulum of length (7/5)(R_c − R): a quarter of its period, with the
  // amplitude's second-order term, is when it first passes the lowest point.
  const RevolvedShape tube{{0, -0.02, 0}, {0, 1, 0}, 0.02, 0, 0.02, 0.04};
  const auto exact = swing(revolved_wall(tube), 250);
  const Real length = 1.4 * (0.02 - 0.002);
  const Real quarter = 0.5 * M_PI * std::sqrt(length / g) * (1 + 0.3 * 0.3 / 16);
  // The sphere sinks in by up to 1 % of its radius, and micro-slip delays it: 0.5 %.
  EXPECT_NEAR(0.002 * first_zero(exact), quarter, 0.005 * quarter);
  // It comes back as high as it was, but for what the spring loses.
  EXPECT_NEAR(*std::min_element(exact.begin(), exact.end()), -0.3, 0.01);
  // A tube of 180 flat strips, 2° each and 0.7 mm wide. At each crease a part sin²(2°) = 0.12 % of the energy at most is
  // lost in the small knock, 17 creases a swing: 2 % of the energy, 1 % of the angle; its middle radius is 1e-4 off.
  const auto mesh = swing(mesh_wall(tests::tube_triangles(0.02, -0.02, 0.02, 180)), 250);
  EXPECT_NEAR(0.002 * first_zero(mesh), quarter, 0.01 * quarter);
  for (std::size_t k = 0; k < 150; ++k) EXPECT_NEAR(mesh[k], exact[k], 0.02) << k;
}

/// A sphere on a turntable that spins at 40 rad/s about z through the origin, after every 1 ms.
std::vector<Vec3> ride(Wall table, int samples) {
  const Real radius = 2e-3;
  auto setup = glass_setup({0.2, 0.2, 0.04}, 1e-5, 0.5, 1.0, 0);
  setup.domain.box = {{-0.1, -0.1, -0.02}, {0.1, 0.1, 0.02}};
  setup.gravity = {0, 0, -g};
  tests::let_contacts_remember(setup);
  setup.contacts.rolling = NoRolling{};
  table.motion.spin = {0, 0, 40};
  setup.walls = {table};
  const Real height = radius - overlap_at(glass_mass(radius) * g, radius);
  Engine engine(setup);
  // At rest in the world, and rolling on the table: ω × l = −(Ω × r), so that there is no slip.
  const Vec3 x{0.02, 0, height};
  const Vec3 table_speed{0, 40 * 0.02, 0};
  // v + ω × (−l z) = table speed with v = 0: ω × z = −speed/l, ω = (ω_x, 0, 0), ω × z = −ω_x y.
  engine.set_particles({{x, {0.1, 0, 0}, {table_speed.y / height, 0.1 / height, 0}, radius, 0, false}});
  std::vector<Vec3> path;
  for (int k = 0; k < samples; ++k) {
    advance(engine, 100);
    path.push_back(grains(engine.particles())[0].velocity);
  }
  return path;
}

TEST(Walls, SphereOnATurntableGoesInCircles) {
  // A sphere that rolls on a plate that spins at Ω moves in a circle at κ Ω, κ = I/(I + m l²) (2/7 for l = R), whatever
  // the circle: its velocity turns at that rate. Weckesser, Am. J. Phys. 65 (1997) 736.
  const Real radius = 2e-3;
  const Real lever = radius - overlap_at(glass_mass(radius) * g, radius);
  const Real rate = 40 * 0.4 * radius * radius / (0.4 * radius * radius + lever * lever);
  const auto plate = ride(revolved_wall({{0, 0, 0}, {0, 0, 1}, 0, 0, 0.09, 0}), 150);
  // The same plate, but of two triangles that really turn.
  const Real s = 0.06;
  const auto mesh =
      ride(mesh_wall({{{-s, -s, 0}, {s, -s, 0}, {s, s, 0}}, {{-s, -s, 0}, {s, s, 0}, {-s, s, 0}}}), 150);
  for (std::size_t k = 9; k < plate.size(); k += 10) {
    const Real angle = rate * 1e-3 * static_cast<Real>(k + 1);
    // Micro-slip of the spring: 1 % of the speed, 0.02 rad of direction.
    const Vec3 expected{0.1 * std::cos(angle), 0.1 * std::sin(angle), 0};
    EXPECT_LT(norm(plate[k] - expected), 0.003) << k;
    EXPECT_LT(norm(mesh[k] - plate[k]), 1e-6) << k;
  }
}

TEST(Walls, SphereFollowsAVibratingFloor) {
  // Below free fall, 2 mm at 5 Hz: 2 m/s². The sphere is then carried along: the force is m (g + a), and it stands on the
  // floor with the overlap that goes with that force.
  const Real radius = 2e-3;
  const Real mass = glass_mass(radius);
  const Real amplitude = 2e-3, frequency = 5, phase = 0.4;
  const Real rate = 2 * M_PI * frequency;
  auto setup = glass_setup({0.04, 0.04, 0.04}, 1e-5, 0.3, 0.3, 0);
  setup.gravity = {0, 0, -g};
  for (const bool mesh : {false, true}) {
    Wall floor = mesh ? mesh_wall(square(0.04)) : Wall(PlaneWall{"floor", {0, 0, 0.01}, {0, 0, 1}, {}, 1});
    if (mesh) {
      auto lifted = square(0.04);
      for (auto& t : lifted) t = {t.a + Vec3{0, 0, 0.01}, t.b + Vec3{0, 0, 0.01}, t.c + Vec3{0, 0, 0.01}};
      floor = mesh_wall(lifted);
    }
    floor.motion.amplitude = {0, 0, amplitude};
    floor.motion.frequency = frequency;
    floor.motion.phase = phase;
    setup.walls = {floor};
    Engine engine(setup);
    const Real start = 0.01 + amplitude * std::sin(phase) + radius - overlap_at(mass * g, radius);
    engine.set_particles(
        {{{0.017, 0.021, start}, {0, 0, amplitude * rate * std::cos(phase)}, {}, radius, 0, false}});
    advance(engine, 10000);  // half a period: the small knock at the start has died away
    engine.collect_report();
    Real impulse = 0;
    for (int k = 1; k <= 100; ++k) {
      advance(engine, 200);
      const Real time = 0.1 + 0.002 * k;
      const Real angle = rate * time + phase;
      const Real push = mass * (g - amplitude * rate * rate * std::sin(angle));
      const Real expected = 0.01 + amplitude * std::sin(angle) + radius - overlap_at(push, radius);
      const Grain s = grains(engine.particles())[0];
      // A step's travel, 0.6 µm, and the sway of the overlap within the contact's own period.
      EXPECT_NEAR(s.position.z, expected, 2e-6) << k;
      EXPECT_NEAR(s.velocity.z, amplitude * rate * std::cos(angle), 2e-3) << k;
      impulse += engine.collect_report().walls.at(0).impulse.z;
    }
    // One period from 0.1 s on: the mean of m (g + a) is the weight, but for the sway.
    EXPECT_NEAR(impulse, -mass * g * 0.2, 0.002 * mass * g * 0.2);
  }
}

TEST(Walls, WhatTheWallsReceiveIsWhatTheParticlesLose) {
  // Grains fly about in a closed can (a tube, two discs) with a cone and a block in it, all with friction, without
  // gravity: momentum and angular momentum go to the walls, to the last digits.
  auto setup = glass_setup({0.04, 0.04, 0.04}, 2e-6, 0.9, 0.4, 0.05);
  setup.domain.box = {{-0.02, -0.02, -0.02}, {0.02, 0.02, 0.02}};
  tests::let_contacts_remember(setup);
  Wall can = revolved_wall({{0, 0, -0.015}, {0, 0, 1}, 0.015, 0, 0.015, 0.03});
  can.torque_about = {0.01, -0.02, 0.03};
  Wall lids;
  lids.name = "lids";
  lids.material = 1;
  lids.revolved = {{{0, 0, -0.015}, {0, 0, 1}, 0, 0, 0.015, 0}, {{0, 0, 0.015}, {0, 0, 1}, 0, 0, 0.015, 0}};
  lids.torque_about = can.torque_about;
  Wall inside = revolved_wall({{0, 0, -0.015}, {0, 0, 1}, 0.006, 0, 0, 0.006});
  inside.boxes = {{{0.004, 0.004, 0.004}, {0.008, 0.007, 0.006}}};
  inside.torque_about = can.torque_about;
  setup.walls = {can, lids, inside};
  std::vector<ParticleSeed> seeds;
  const auto centres =
      tests::scatter({{-0.009, -0.009, -0.007}, {0.009, 0.009, 0.003}}, std::vector<Real>(40, 0.001), 0, 61);
  for (std::size_t p = 0; p < centres.size(); ++p) {
    const int id = static_cast<int>(p);
    seeds.push_back(
        {centres[p], 2.0 * random_vector(62, id), 300.0 * random_vector(63, id), 0.001, 0, false});
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  const ParticleTotals start = engine.compute_totals();
  Vec3 momentum{}, angular{};
  std::int64_t contacts = 0;
  for (int k = 0; k < 500; ++k) {
    advance(engine, 20);
    const ContactReport report = engine.collect_report();
    for (const WallLoad& load : report.walls) {
      momentum += load.impulse;
      angular += load.angular_impulse;
    }
    contacts += report.touching_walls;
  }
  ASSERT_GT(contacts, 200);
  const ParticleTotals end = engine.compute_totals();
  EXPECT_LT(norm(start.momentum - end.momentum - momentum), 1e-12 * norm(momentum));
  // About the point that torques refer to. The integrator keeps h at half steps: forces act at the position of the step,
  // whose moment is that of the position half a step away but for v Δt/2 × F, which is along v and leaves second order.
  const auto about = [&](const ParticleTotals& t) {
    return t.angular_momentum - cross(can.torque_about, t.momentum);
  };
  EXPECT_LT(norm(about(start) - about(end) - angular), 1e-9 * norm(angular));
}

TEST(Walls, AHeapWeighsOnItsWalls) {
  // 150 grains settle in a cylinder, on a disc and on a block of mesh: after they rest, the walls carry their weight.
  auto setup = glass_setup({0.04, 0.04, 0.06}, 1e-5, 0.3, 0.4, 0.05);
  setup.domain.box = {{-0.02, -0.02, -0.01}, {0.02, 0.02, 0.05}};
  setup.gravity = {0, 0, -g};
  tests::let_contacts_remember(setup);
  setup.walls = {revolved_wall({{0, 0, 0}, {0, 0, 1}, 0.012, 0, 0.012, 0.05}),
                 revolved_wall({{0, 0, 0}, {0, 0, 1}, 0, 0, 0.012, 0}),
                 mesh_wall(tests::box_triangles({-0.003, -0.003, -0.001}, {0.003, 0.003, 0.004}))};
  std::vector<ParticleSeed> seeds;
  const auto centres =
      tests::scatter({{-0.007, -0.007, 0.006}, {0.007, 0.007, 0.046}}, std::vector<Real>(150, 0.001), 0, 65);
  seeds.reserve(centres.size());
  for (const Vec3& x : centres) seeds.push_back({x, {0, 0, -0.3}, {}, 0.001, 0, false});
  Engine engine(setup);
  engine.set_particles(seeds);
  advance(engine, 30000);
  engine.collect_report();
  const Vec3 before = engine.compute_totals().momentum;
  advance(engine, 5000);
  const ContactReport report = engine.collect_report();
  ASSERT_EQ(report.walls.size(), 3U);
  Vec3 sum{};
  for (const WallLoad& load : report.walls) sum += load.impulse;
  const Real weight = 150 * glass_mass(0.001) * g;
  // Settled: the rest of the motion is far below the weight times the time.
  EXPECT_LT(norm(engine.compute_totals().momentum - before), 1e-3 * weight * 0.05);
  EXPECT_NEAR(sum.z, -weight * 0.05, 1e-3 * weight * 0.05);
  EXPECT_LT(std::hypot(sum.x, sum.y), 1e-3 * weight * 0.05);
  EXPECT_LT(report.walls[1].impulse.z, 0) << "the disc carries a part";
  EXPECT_LT(report.walls[2].impulse.z, 0) << "and so does the block";
}

/// A busy mill: a mesh that turns, a floor that shakes, a tube and a cone, springs at all contacts.
EngineSetup mill_setup() {
  auto setup = glass_setup({0.05, 0.05, 0.06}, 5e-6, 0.6, 0.4, 0.05);
  setup.domain.box = {{-0.025, -0.025, -0.01}, {0.025, 0.025, 0.05}};
  setup.domain.open_max = {0, 0, 1};
  setup.gravity = {0, 1, -50};
  tests::let_contacts_remember(setup);
  Wall paddle = mesh_wall(tests::box_triangles({-0.007, -0.001, 0.0005}, {0.007, 0.001, 0.006}));
  paddle.motion.spin = {0, 0, 60};
  Wall floor = revolved_wall({{0, 0, 0}, {0, 0, 1}, 0, 0, 0.0135, 0});
  floor.motion.amplitude = {0, 0, 2e-4};
  floor.motion.frequency = 80;
  floor.motion.phase = 1;
  setup.walls = {paddle, floor, revolved_wall({{0, 0, -0.001}, {0, 0, 1}, 0.013, 0, 0.013, 0.031}),
                 revolved_wall({{0, 0, 0.03}, {0, 0, 1}, 0.013, 0, 0.024, 0.02})};
  return setup;
}

std::vector<ParticleSeed> mill_load() {
  std::vector<ParticleSeed> seeds;
  const auto centres =
      tests::scatter({{-0.007, -0.007, 0.0085}, {0.007, 0.007, 0.045}}, std::vector<Real>(250, 0.001), 0, 67);
  for (std::size_t p = 0; p < centres.size(); ++p)
    seeds.push_back({centres[p], 0.5 * random_vector(68, static_cast<int>(p)), {}, 0.001, 0, false});
  return seeds;
}

void run_outer_steps(Engine& engine, int count) {
  for (int k = 0; k < count; ++k) {
    engine.prepare_outer_step();
    advance(engine, 10);
  }
}

std::uint64_t hash_of(const Engine& engine, const ContactReport& report) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&hash](const void* data, std::size_t size) {
    for (std::size_t b = 0; b < size; ++b)
      hash = (hash ^ static_cast<const unsigned char*>(data)[b]) * 0x100000001b3;
  };
  for (const Grain& s : grains(engine.particles())) {
    add(&s.position, sizeof(Vec3));
    add(&s.velocity, sizeof(Vec3));
    add(&s.spin, sizeof(Vec3));
  }
  for (const WallLoad& load : report.walls) {
    add(&load.impulse, sizeof(Vec3));
    add(&load.angular_impulse, sizeof(Vec3));
  }
  return hash;
}

TEST(Walls, MovingOnesContinueBitForBitAfterACheckpoint) {
  const auto setup = mill_setup();
  Engine straight(setup);
  straight.set_particles(mill_load());
  run_outer_steps(straight, 500);
  straight.collect_report();
  straight.canonicalise();
  const tests::TemporaryFolder folder;
  {
    core::CheckpointWriter file(folder / "checkpoint.h5");
    straight.save(file);
    file.close();
  }
  run_outer_steps(straight, 200);
  const ContactReport report = straight.collect_report();
  EXPECT_GT(report.touching_walls, 10);
  Engine resumed(setup);
  core::CheckpointReader file(folder / "checkpoint.h5");
  resumed.load(file);
  run_outer_steps(resumed, 200);
  EXPECT_EQ(hash_of(straight, report), hash_of(resumed, resumed.collect_report()));
  // The springs matter: a run that forgets them at that point goes elsewhere.
  Engine forgets(setup);
  {
    auto without = mill_setup();
    without.contacts.tangential = ViscousCoulomb{};
    without.contacts.rolling = ConstantTorque{};
    Engine other(without);
    core::CheckpointReader again(folder / "checkpoint.h5");
    other.load(again);
    run_outer_steps(other, 200);
    EXPECT_NE(hash_of(straight, report), hash_of(other, other.collect_report()));
  }
}

TEST(Walls, AreTheSameBitForBitWithAnyNumberOfThreads) {
  if (tests::is_child()) {
    Engine engine(mill_setup());
    engine.set_particles(mill_load());
    run_outer_steps(engine, 400);
    tests::answer(
        fmt::format("{} threads {:016x}", Host().concurrency(), hash_of(engine, engine.collect_report())));
    return;
  }
  tests::expect_same_answer({1, 2});
}

TEST(Walls, MovingWallsMissNoContact) {
  // A plate, of mesh or a thin block, sweeps through a row of spheres that rest in space: it must meet each, however seldom lists are made.
  auto setup = glass_setup({0.1, 0.1, 0.02}, 1e-5, 0.9, 0, 0);
  setup.domain.box = {{-0.05, -0.05, -0.01}, {0.05, 0.05, 0.01}};
  Wall plate = mesh_wall(
      {{{0, 0, -0.01}, {0.04, 0, -0.01}, {0.04, 0, 0.01}}, {{0, 0, -0.01}, {0.04, 0, 0.01}, {0, 0, 0.01}}});
  Wall block;
  block.boxes = {{{0, -1e-4, -0.01}, {0.04, 1e-4, 0.01}}};
  std::vector<ParticleSeed> seeds;
  for (int i = 0; i < 8; ++i) {
    const Real angle = 0.35 + 0.6 * i;
    seeds.push_back({{0.03 * std::cos(angle), 0.03 * std::sin(angle), 0}, {}, {}, 0.001, 0, false});
  }
  // An impact at 0.03 × 20 = 0.6 m/s: a contact that began late would be deeper than the elastic one,
  // (15/16 m v²/(E* √R))^0.4.
  const Real elastic =
      std::pow(15.0 / 16 * glass_mass(0.001) * 0.36 / (glass_wall_modulus * std::sqrt(0.001)), 0.4) / 0.001;
  for (Wall wall : {plate, block}) {
    wall.motion.spin = {0, 0, 20};  // 0.8 m/s at its end
    wall.material = 1;
    setup.walls = {wall};
    Engine engine(setup);
    engine.set_particles(seeds);
    advance(engine, 24000);  // 4.8 rad
    const Real deepest = engine.collect_report().largest_overlap;
    int hit = 0;
    for (const Grain& s : grains(engine.particles())) {
      const Vec3 shift = s.position - seeds[static_cast<std::size_t>(s.id)].position;
      hit += norm(s.velocity) > 0 || norm(shift) > 0 ? 1 : 0;
    }
    // The sphere at 0.35 + 0.6 × 7 = 4.55 rad is the last one on the way.
    EXPECT_EQ(hit, 8);
    EXPECT_LT(deepest, 1.05 * elastic);
    EXPECT_GT(deepest, 0.8 * elastic);
  }
}

}  // namespace
}  // namespace pellicle::dem
