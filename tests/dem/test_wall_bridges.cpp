// Liquid bridges between particles and walls: how strong, how many, and how long they live.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/checkpoint.hpp"
#include "dem/wall_bridges.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/dem/bed.hpp"
#include "tests/dem/meshes.hpp"

namespace pellicle::dem {
namespace {

using tests::advance;
using tests::grains;

/// R_w = 2R = 1 mm: with V* = 1e-3 the force at a gap of 0.025 R_w is 2π R_w γ × 0.31225 (25 digits of Willett et al.
/// 2000, PHYSICS.md 3), at any smaller than 1 µm × 0.90979; the bridge breaks at R_w (0.1 + 0.1 × 0.01).
constexpr Real radius = 0.5e-3, gamma_water = 0.072;
constexpr Willett law{1e-12, gamma_water, 0};
constexpr Real force_at_gap = 2 * M_PI * 1e-3 * gamma_water * 0.3122502717867136;
constexpr Real rupture = 0.101e-3;

/// Nothing changes the speed of so heavy a sphere.
EngineSetup heavy_setup(const std::vector<Wall>& walls) {
  EngineSetup setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-6, 1.0, 0.3, 0);
  setup.materials[0].density = 1e20;
  setup.contacts.cohesion = law;
  setup.walls = walls;
  for (Wall& wall : setup.walls) wall.material = 1;
  return setup;
}

Wall mesh_wall(const std::vector<TriangleShape>& triangles) {
  Wall wall;
  wall.mesh = tests::loose_mesh(triangles);
  return wall;
}

/// A floor at z = 0.05 around x = y = 0.05, of each shape.
std::vector<std::pair<std::string, Wall>> floors() {
  std::vector<std::pair<std::string, Wall>> all;
  const Real z = 0.05, low = 0.03, high = 0.07;
  all.emplace_back("plane", PlaneWall{"floor", {0, 0, z}, {0, 0, 1}, {}, 1});
  Wall block;
  block.boxes = {{{low, low, 0.02}, {high, high, z}}};
  all.emplace_back("block", block);
  Wall disc;
  disc.revolved = {{{0.05, 0.05, z}, {0, 0, 1}, 0, 0, 0.02, 0}};
  all.emplace_back("disc", disc);
  // The sphere is over a corner of these four triangles, over an edge of these two, and over the face of one.
  const Vec3 a{low, low, z}, b{high, low, z}, c{high, high, z}, d{low, high, z}, m{0.05, 0.05, z};
  all.emplace_back("corner", mesh_wall({{a, b, m}, {b, c, m}, {c, d, m}, {d, a, m}}));
  all.emplace_back("edge", mesh_wall({{a, b, c}, {a, c, d}}));
  const Vec3 left{0.04, 0.0497, z}, right{0.06, 0.0497, z};
  all.emplace_back("face", mesh_wall({{left, right, c}, {left, c, d}, {a, b, right}, {a, right, left}}));
  // Across from the axis of a wide tube, and on top of a thin one.
  Wall within;
  within.revolved = {{{0.05, 0, z + 0.04}, {0, 1, 0}, 0.04, 0, 0.04, 0.1}};
  all.emplace_back("tube from within", within);
  Wall outside;
  outside.revolved = {{{0.05, 0, z - 0.01}, {0, 1, 0}, 0.01, 0, 0.01, 0.1}};
  all.emplace_back("tube from outside", outside);
  return all;
}

TEST(WallBridges, PullWithTheForceOfTheFitAtEveryShape) {
  for (auto& [name, floor] : floors()) {
    floor.torque_about = {0.03, 0.05, 0.05};  // 20 mm beside the sphere
    Engine engine(heavy_setup({floor}));
    // Up at 0.5 m/s from an overlap of 5 µm: the 61st substep sees a gap of 25 µm.
    engine.set_particles({{{0.05, 0.05, 0.05 + radius - 5e-6}, {0, 0, 0.5}, {}, radius, 0, false}});
    advance(engine, 60);
    (void)engine.collect_report();
    advance(engine, 1);
    const auto sphere = grains(engine.particles())[0];
    // The acceleration is kept in single precision; the gap is good to 1e-17 m.
    EXPECT_NEAR(sphere.mass * sphere.acceleration.z, -force_at_gap, 1e-6 * force_at_gap) << name;
    EXPECT_NEAR(sphere.mass * sphere.acceleration.x, 0, 1e-6 * force_at_gap) << name;
    const ContactReport report = engine.collect_report();
    EXPECT_EQ(report.wall_bridges, 1) << name;
    EXPECT_EQ(report.bridges, 0) << name;
    EXPECT_EQ(report.touching_walls, 0) << name;
    // The floor is pulled up for one step of 1 µs, at an arm of (20 mm, 0, 0): its torque is (20 mm, 0, 0) × (0, 0, F).
    EXPECT_NEAR(report.walls[0].impulse.z, 1e-6 * force_at_gap, 1e-14 * force_at_gap) << name;
    EXPECT_NEAR(report.wall_impulse.z, -1e-6 * force_at_gap, 1e-14 * force_at_gap) << name;
    EXPECT_NEAR(report.walls[0].angular_impulse.y, -2e-8 * force_at_gap, 1e-15 * force_at_gap) << name;
  }
}

TEST(WallBridges, LastFromTheTouchToTheRuptureThroughRestarts) {
  for (auto& [name, floor] : floors()) {
    const EngineSetup setup = heavy_setup({floor});
    Engine first(setup), second(setup);
    Engine* engine = &first;
    engine->set_particles({{{0.05, 0.05, 0.05 + radius + 2e-5}, {0, 0, -0.5}, {}, radius, 0, false}});
    // It comes near: there is none before the touch.
    advance(*engine, 30);
    EXPECT_EQ(engine->collect_report().wall_bridges, 0) << name;
    const tests::TemporaryFolder folder;
    engine->set_particles({{{0.05, 0.05, 0.05 + radius - 1.1e-6}, {0, 0, 0.5}, {}, radius, 0, false}});
    bool broken = false;
    int bridged = 0;
    for (int k = 0; k < 300; ++k) {
      if (k == 150) {  // at a gap of 74 µm
        engine->collect_report();
        engine->canonicalise();
        core::CheckpointWriter writer(folder / "checkpoint.h5");
        engine->save(writer);
        writer.close();
        core::CheckpointReader reader(folder / "checkpoint.h5");
        second.load(reader);
        engine = &second;
      }
      advance(*engine, 1);
      const Real gap = -1.1e-6 + 0.5e-6 * k;
      const bool spans = gap < rupture;
      EXPECT_EQ(engine->collect_report().wall_bridges, spans ? 1 : 0) << name << " at " << gap;
      const Real pull = -grains(engine->particles())[0].acceleration.z;
      EXPECT_TRUE(gap < 0 || (pull > 0) == spans) << name << " at " << gap;
      broken = broken || !spans;
      if (spans) ++bridged;
    }
    EXPECT_TRUE(broken);
    EXPECT_GT(bridged, 200);
    EXPECT_GE(second.list_builds(), 3) << "lists were to be rebuilt while the bridge lasts";
  }
}

TEST(WallBridges, AreTwoInACornerAndOneOnAnEdge) {
  // Against two sides of one wall, then away along the diagonal: each pulls towards its own side.
  Wall corner;
  corner.planes = {{{1, 0, 0}, 0.05}, {{0, 0, 1}, 0.05}};
  Engine engine(heavy_setup({corner}));
  const Real start = 0.05 + radius - 5e-6;
  engine.set_particles({{{start, 0.05, start}, {0.5, 0, 0.5}, {}, radius, 0, false}});
  advance(engine, 61);
  EXPECT_EQ(engine.collect_report().wall_bridges, 2);
  const auto sphere = grains(engine.particles())[0];
  EXPECT_NEAR(sphere.mass * sphere.acceleration.x, -force_at_gap, 1e-6 * force_at_gap);
  EXPECT_NEAR(sphere.mass * sphere.acceleration.z, -force_at_gap, 1e-6 * force_at_gap);
  // A block and a mesh of twelve triangles of the same box, from its edge outwards along the diagonal.
  const Real s = std::sqrt(0.5);
  Wall block;
  block.boxes = {{{0.02, 0.02, 0.02}, {0.05, 0.08, 0.05}}};
  for (const Wall& wall : {block, mesh_wall(tests::box_triangles({0.02, 0.02, 0.02}, {0.05, 0.08, 0.05}))}) {
    Engine edge(heavy_setup({wall}));
    const Real out = 0.05 + s * (radius - 5e-6);
    edge.set_particles({{{out, 0.05, out}, {0.5 * s, 0, 0.5 * s}, {}, radius, 0, false}});
    advance(edge, 61);
    EXPECT_EQ(edge.collect_report().wall_bridges, 1);
    const auto a = grains(edge.particles())[0];
    EXPECT_NEAR(a.mass * a.acceleration.x, -s * force_at_gap, 2e-6 * force_at_gap);
    EXPECT_NEAR(a.mass * a.acceleration.z, -s * force_at_gap, 2e-6 * force_at_gap);
  }
}

TEST(WallBridges, FormOnlyWhereTheParticleTouches) {
  // It touches the floor, and is 20 µm, within reach, from a side of the same wall; or from a slope beside the floor, another
  // wall that rises at 15°, less than the 25° by which a bridge is known.
  const Real rise = std::tan(15 * M_PI / 180), slant = std::cos(15 * M_PI / 180);
  Wall corner;
  corner.planes = {{{1, 0, 0}, 0.05 - radius - 2e-5}, {{0, 0, 1}, 0.05}};
  const Wall floor = PlaneWall{"floor", {0, 0, 0.05}, {0, 0, 1}, {}, 1};
  // The distance of the centre (0.05, 0.05, 0.05 + radius) from the slope is radius + 20 µm.
  const Vec3 up{-rise * slant, 0, slant};
  const Wall slope = PlaneWall{"slope", Vec3{0.05, 0.05, 0.05 + radius} - (radius + 2e-5) * up, up, {}, 1};
  for (const std::vector<Wall>& walls : {std::vector<Wall>{corner}, std::vector<Wall>{floor, slope}}) {
    Engine engine(heavy_setup(walls));
    engine.set_particles({{{0.05, 0.05, 0.05 + radius - 1e-7}, {}, {}, radius, 0, false}});
    for (int k = 0; k < 20; ++k) {
      advance(engine, 1);
      EXPECT_EQ(engine.collect_report().wall_bridges, 1);
    }
  }
}

TEST(WallBridges, SlideAlongFromOneWallToTheNext) {
  // Two walls side by side, x = 0.05 their seam: the sphere touches the first, then hovers at 25 µm across the seam.
  const Real z = 0.05;
  const Vec3 a{0.02, 0.02, z}, b{0.05, 0.02, z}, c{0.05, 0.08, z}, d{0.02, 0.08, z}, e{0.08, 0.02, z},
      f{0.08, 0.08, z};
  const EngineSetup setup =
      heavy_setup({mesh_wall({{a, b, c}, {a, c, d}}), mesh_wall({{b, e, f}, {b, f, c}})});
  Engine engine(setup);
  engine.set_particles({{{0.0485, 0.05, z + radius - 5e-6}, {1, 0, 0.01}, {}, radius, 0, false}});
  std::int64_t of_first = 0, of_second = 0;
  for (int k = 0; k < 3000; ++k) {
    advance(engine, 1);
    const ContactReport report = engine.collect_report();
    ASSERT_EQ(report.wall_bridges, 1) << k;
    if (report.walls[0].impulse.z != 0) ++of_first;
    if (report.walls[1].impulse.z != 0) ++of_second;
  }
  EXPECT_EQ(of_first + of_second, 3000);
  EXPECT_NEAR(static_cast<Real>(of_second), 1500, 2);
}

TEST(WallBridges, HangABeadFromACeiling) {
  // 2500 kg/m³ × 4π/3 × (0.5 mm)³ × 9.81 m/s² = 12.84 µN hang or fall: 2π × 1 mm × γ × 0.9097888 is 14.29 µN for
  // γ = 2.5 mN/m and 11.43 µN for 2.0 mN/m.
  for (const Real tension : {2.5e-3, 2.0e-3}) {
    auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 2e-6, 0.5, 0.3, 0);
    setup.gravity = {0, 0, -9.81};
    setup.contacts.cohesion = Willett{1e-12, tension, 0};
    setup.walls = {PlaneWall{"ceiling", {0, 0, 0.05}, {0, 0, -1}, {}, 1}};
    Engine engine(setup);
    engine.set_particles({{{0.05, 0.05, 0.05 - 0.9999 * radius}, {}, {}, radius, 0, false}});
    advance(engine, 10000);
    (void)engine.collect_report();
    advance(engine, 1000);
    const ContactReport report = engine.collect_report();
    const bool hangs = tension > 2.2e-3;
    EXPECT_EQ(report.wall_bridges, hangs ? 1 : 0);
    EXPECT_EQ(report.touching_walls, hangs ? 1 : 0);
    // The ceiling bears the weight for 2 ms. The dashpot has left nothing of the first bounces.
    const Real weight = 2500 * 4.0 / 3.0 * M_PI * radius * radius * radius * 9.81;
    EXPECT_NEAR(report.walls[0].impulse.z, hangs ? -weight * 2e-3 : 0, 1e-6 * weight * 2e-3);
  }
}

TEST(WallBridges, TouchNothingWithoutCohesion) {
  EXPECT_EQ(wall_bridge_reach(Willett{}, radius), 0);
  EXPECT_NEAR(wall_bridge_reach(law, radius), rupture, 1e-18);
}

}  // namespace
}  // namespace pellicle::dem
