// Walls of several surfaces: which of them a sphere meets, through the grid of a mesh, and how many contacts it then has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dem/wall_candidates.hpp"
#include "dem/wall_history.hpp"
#include "dem/wall_system.hpp"
#include "tests/dem/bed.hpp"
#include "tests/dem/meshes.hpp"

namespace pellicle::dem {
namespace {

using tests::loose_mesh;
using tests::random_vector;

Wall mesh_wall(const std::vector<TriangleShape>& triangles) {
  Wall wall;
  wall.mesh = loose_mesh(triangles);
  return wall;
}

/// Contacts of a sphere with all surfaces of some walls.
WallCandidates contacts_of(const std::vector<Wall>& walls, const Vec3& centre, Real radius) {
  const WallGeometry geometry = make_wall_geometry(walls);
  Kokkos::fence();
  WallCandidates found;
  const auto surfaces = geometry.primitives + static_cast<Index>(geometry.triangle.extent(0));
  for (Index s = 0; s < surfaces; ++s) {
    const ClosestPoint at = geometry.closest(s, centre);
    if (at.distance < radius) found.insert({at, s, geometry.wall_of(s)});
  }
  found.select(geometry, radius);
  return found;
}

TEST(MeshGrid, FindsEveryTriangleInReachOnce) {
  // Triangles of all sizes and directions, some as large as the whole mesh.
  std::vector<TriangleShape> triangles;
  for (int t = 0; t < 400; ++t) {
    const Vec3 x = random_vector(91, t);
    const Real size = std::pow(10.0, -2 * std::abs(random_vector(92, t).x));
    triangles.push_back({x, x + size * random_vector(93, t), x + size * random_vector(94, t)});
  }
  Wall wall = mesh_wall(triangles);
  const WallGeometry geometry = make_wall_geometry({PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 0}, wall});
  Kokkos::fence();
  ASSERT_EQ(geometry.grid.extent(0), 1U);
  const MeshGrid grid = geometry.grid(0);
  EXPECT_GT(grid.cells.x * grid.cells.y * grid.cells.z, 20);
  EXPECT_EQ(geometry.primitives, 1);
  std::size_t total = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3 c = 1.5 * random_vector(95, k);
    const Real reach = 0.3 * std::abs(random_vector(96, k).x);
    std::vector<Index> expected, found;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (triangles[t].closest(c).distance < reach) expected.push_back(1 + static_cast<Index>(t));
    }
    visit_triangles(geometry, grid, c, reach, [&](Index s) {
      found.push_back(s);
      return false;
    });
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    total += expected.size();
  }
  EXPECT_GT(total, 200U);
}

TEST(WallContacts, OneOnAFlatMesh) {
  // A square of two triangles, and one of four that meet in its middle; over a face, an edge, a corner, from both sides.
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{1, 1, 0}, d{0, 1, 0}, m{0.5, 0.5, 0};
  for (const auto& square : {std::vector<TriangleShape>{{a, b, c}, {a, c, d}},
                             std::vector<TriangleShape>{{a, b, m}, {b, c, m}, {c, d, m}, {d, a, m}}}) {
    for (const Vec3& x :
         {Vec3{0.7, 0.2, 0}, Vec3{0.4, 0.4, 0}, m, Vec3{0.4, 0.4000001, 0}, Vec3{0.5, 0.45, 0}}) {
      for (const Real height : {0.09, -0.06}) {
        const WallCandidates found = contacts_of({mesh_wall(square)}, x + Vec3{0, 0, height}, 0.1);
        ASSERT_EQ(found.count(), 1);
        EXPECT_NEAR(found[0].at.distance, std::abs(height), 1e-15);
        EXPECT_NEAR(found[0].at.towards.z, height > 0 ? -1 : 1, 1e-15);
      }
    }
  }
}

TEST(WallContacts, OneOnAConvexEdgeTwoInACorner) {
  const auto box = mesh_wall(tests::box_triangles({0, 0, 0}, {1, 1, 1}));
  // Outside, beyond the edge x = z = 1 and beyond the corner: one contact, towards the edge, the corner.
  const WallCandidates edge = contacts_of({box}, {1.03, 0.3, 1.04}, 0.1);
  ASSERT_EQ(edge.count(), 1);
  EXPECT_NEAR(edge[0].at.distance, 0.05, 1e-15);
  EXPECT_NEAR(edge[0].at.towards.x, -0.6, 1e-14);
  const WallCandidates corner = contacts_of({box}, {1.02, 1.01, 1.02}, 0.1);
  ASSERT_EQ(corner.count(), 1);
  EXPECT_NEAR(corner[0].at.distance, 0.03, 1e-15);
  // Inside, at the same edge and corner: two and three walls.
  EXPECT_EQ(contacts_of({box}, {0.95, 0.3, 0.94}, 0.1).count(), 2);
  const WallCandidates three = contacts_of({box}, {0.95, 0.92, 0.94}, 0.1);
  ASSERT_EQ(three.count(), 3);
  EXPECT_NEAR(three[0].at.distance, 0.05, 1e-15);  // nearest first
  EXPECT_NEAR(three[2].at.distance, 0.08, 1e-15);
}

TEST(WallContacts, FacetsThatMeetAtLessThanTwentyDegreesAreOne) {
  // A valley along y of two slopes, each tilted by half the angle; a sphere over its middle is as near to both.
  for (const Real degrees : {10.0, 19.0, 21.0, 45.0}) {
    const Real rise = std::tan(0.5 * degrees * M_PI / 180);
    const Vec3 a{0, -1, 0}, b{0, 1, 0}, left_a{-1, -1, rise}, left_b{-1, 1, rise}, right_a{1, -1, rise},
        right_b{1, 1, rise};
    const auto valley =
        mesh_wall({{a, b, left_b}, {a, left_b, left_a}, {a, right_b, b}, {a, right_a, right_b}});
    EXPECT_EQ(contacts_of({valley}, {0, 0.1, 0.09}, 0.1).count(), degrees < 20 ? 1 : 2) << degrees;
    // The two slopes as walls of their own are two contacts at any angle.
    const auto left = mesh_wall({{a, b, left_b}, {a, left_b, left_a}});
    const auto right = mesh_wall({{a, right_b, b}, {a, right_a, right_b}});
    EXPECT_EQ(contacts_of({left, right}, {0, 0.1, 0.09}, 0.1).count(), 2) << degrees;
  }
}

TEST(WallMemory, KnowsAContactByItsWallAndDirection) {
  const auto tilted = [](Real degrees) {
    return Vec3{std::sin(degrees * M_PI / 180), 0, -std::cos(degrees * M_PI / 180)};
  };
  WallMemory memory;
  EXPECT_EQ(memory.find(0, tilted(0), 0), -1);
  memory.count = 3;
  memory.wall[0] = memory.wall[1] = 4;
  memory.wall[2] = 5;
  memory.towards[0] = tilted(0);
  memory.towards[1] = tilted(40);
  memory.towards[2] = tilted(0);
  EXPECT_EQ(memory.find(4, tilted(0), 0), 0);
  EXPECT_EQ(memory.find(5, tilted(0), 0), 2);
  EXPECT_EQ(memory.find(6, tilted(0), 0), -1);
  EXPECT_EQ(memory.find(WallMemory::any_wall, tilted(41), 0), 1);
  // The nearer of two, unless it is taken; none further away than 25° (cosine 0.9: 25.8°).
  EXPECT_EQ(memory.find(4, tilted(19), 0), 0);
  EXPECT_EQ(memory.find(4, tilted(21), 0), 1);
  EXPECT_EQ(memory.find(4, tilted(19), 0b1), 1);
  EXPECT_EQ(memory.find(4, tilted(19), 0b11), -1);
  EXPECT_EQ(memory.find(4, tilted(-25), 0), 0);
  EXPECT_EQ(memory.find(4, tilted(-27), 0), -1);
  EXPECT_EQ(memory.find(5, tilted(90), 0), -1);
}

TEST(WallContacts, RollingIsAgainstTheSpinOfTheWall) {
  // At the bottom of a drum that turns about y, its contact point as fast as the drum: where the sphere turns as the drum
  // does, nothing rolls; at rest it is carried along by µ_r R F_n, F_n of a rigid wall (4/3) E* √R δ^(3/2).
  const Real radius = 0.002, overlap = 1e-5, drum = 0.05, rate = 30;
  auto setup = tests::glass_setup({0.2, 0.2, 0.2}, 1e-7, 1, 0.3, 0.1);
  Wall wall;
  wall.material = 1;
  wall.revolved = {{{0.1, 0, 0.1}, {0, 1, 0}, drum, 0, drum, 0.2}};
  wall.motion.spin = {0, rate, 0};
  wall.motion.through = {0.1, 0, 0.1};
  setup.walls = {wall};
  for (const bool turns : {true, false}) {
    Engine engine(setup);
    // ω × (0, 0, −drum) = (−rate drum, 0, 0); the sphere's own spin adds ω × (0, 0, −(R − δ)) there.
    const Vec3 spin{0, turns ? rate : 0, 0};
    const Real speed = -rate * drum + spin.y * (radius - overlap);
    engine.set_particles(
        {{{0.1, 0.1, 0.1 - drum + radius - overlap}, {speed, 0, 0}, spin, radius, 0, false}});
    tests::advance(engine, 1);
    const auto sphere = tests::grains(engine.particles())[0];
    const Real force = 4.0 / 3 * tests::glass_wall_modulus * std::sqrt(radius) * std::pow(overlap, 1.5);
    const Real inertia = 0.4 * tests::glass_mass(radius) * radius * radius;
    const Real carried = 0.1 * radius * force / inertia;  // [rad/s²]
    // Single precision of the acceleration; friction, of the contact point's speed by rounding alone, is far smaller.
    EXPECT_NEAR(sphere.angular_acceleration.y, turns ? 0 : carried, 1e-6 * carried);
    EXPECT_NEAR(sphere.angular_acceleration.x, 0, 1e-6 * carried);
    EXPECT_NEAR(sphere.angular_acceleration.z, 0, 1e-6 * carried);
  }
}

TEST(WallContacts, SeamsOfDifferentWallsAreShadowedToo) {
  // A tube of radius 1 that stands on a disc of the same radius, and goes on as a cone.
  Wall tube, disc, cone, plane;
  tube.revolved = {{{0, 0, 0}, {0, 0, 1}, 1, 0, 1, 1}};
  disc.revolved = {{{0, 0, 0}, {0, 0, 1}, 0, 0, 1, 0}};
  cone.revolved = {{{0, 0, 0}, {0, 0, 1}, 1, 1, 2, 1.5}};
  const std::vector<Wall> all{tube, disc, cone};
  EXPECT_EQ(contacts_of(all, {0, 0.95, 0.5}, 0.1).count(), 1);
  EXPECT_EQ(contacts_of(all, {0, 0.95, 0.06}, 0.1).count(), 2);  // tube and disc
  EXPECT_EQ(contacts_of(all, {0.93, 0, 1.01}, 0.1).count(),
            1);  // above the seam of tube and cone, nearest to it
  EXPECT_EQ(contacts_of(all, {0, -1.03, -0.04}, 0.1).count(), 1);  // outside, below: the rim of both
  // A disc that lies in a plane: one floor.
  plane.planes = {{{0, 0, 1}, 0}};
  EXPECT_EQ(contacts_of({plane, disc}, {0.3, 0, 0.05}, 0.1).count(), 1);
  EXPECT_EQ(contacts_of({plane, disc}, {1.02, 0, 0.05}, 0.1).count(), 1);
}

TEST(WallContacts, AMeshOfManyTrianglesIsOneWall) {
  // A round plate of 64 triangles that meet in the middle: more than are compared.
  std::vector<TriangleShape> fan;
  const auto rim = [](int i) { return Vec3{std::cos(2 * M_PI * i / 64), std::sin(2 * M_PI * i / 64), 0}; };
  fan.reserve(64);
  for (int i = 0; i < 64; ++i) fan.push_back({{0, 0, 0}, rim(i), rim(i + 1)});
  for (const Vec3& x : {Vec3{0, 0, 0.08}, Vec3{0.003, 0.001, 0.08}, Vec3{0.3, 0, 0.08}}) {
    const WallCandidates found = contacts_of({mesh_wall(fan)}, x, 0.1);
    ASSERT_EQ(found.count(), 1);
    EXPECT_NEAR(found[0].at.distance, 0.08, 1e-15);
  }
  // From the inside of a tube of 72 facets, 5° each, a sphere that touches three of them has one contact.
  const auto tube = mesh_wall(tests::tube_triangles(1, -1, 1, 72));
  const WallCandidates found = contacts_of({tube}, {0.01, 0.3, -0.92}, 0.1);
  ASSERT_EQ(found.count(), 1);
  EXPECT_NEAR(found[0].at.distance, 1 - 0.92, 1e-3);
}

TEST(WallMotion, PosesInClosedForm) {
  WallMotion motion;
  motion.spin = {0, 0, 2};
  motion.through = {1, 0, 0};
  motion.amplitude = {0.03, 0, 0.1};
  motion.frequency = 5;
  motion.phase = 0.3;
  const Real time = M_PI / 4;  // a quarter turn
  const WallPose pose = compute_pose(motion, true, time);
  const Real height = 0.1 * std::sin(10 * M_PI * time + 0.3);
  const Vec3 moved = pose.to_world({3, 0, 7});
  EXPECT_LT(norm(moved - Vec3{1 + 0.3 * height, 2, 7 + height}), 1e-14);
  EXPECT_LT(norm(pose.to_wall(moved) - Vec3{3, 0, 7}), 1e-14);
  // Its velocity is the difference quotient of its path, to second order.
  const Real h = 1e-5;
  const Vec3 before = compute_pose(motion, true, time - h).to_world({3, 0, 7});
  const Vec3 after = compute_pose(motion, true, time + h).to_world({3, 0, 7});
  EXPECT_LT(norm(pose.velocity_at(moved, {1, 0, 0}) - 1 / (2 * h) * (after - before)), 1e-7);
  // A belt moves along its surface only.
  motion = WallMotion{};
  motion.surface_velocity = {3, 4, 5};
  EXPECT_LT(norm(compute_pose(motion, false, 1).velocity_at({0, 0, 0}, {0, 0, 1}) - Vec3{3, 4, 0}), 1e-15);
  EXPECT_EQ(compute_pose_at_rest(motion).velocity_at({0, 0, 0}, {0, 0, 1}), (Vec3{0, 0, 0}));
}

TEST(WallMotion, AListHoldsUntilAWallHasMovedByItsAllowance) {
  // A floor that swings by 1 mm at 50.1 Hz, from the phase 0.4 on, and has waited there. Its allowance: the way at top speed
  // in ten steps of 0.1 ms, 0.3148 mm.
  Wall floor = PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 0};
  floor.motion.amplitude = {0, 0, 1e-3};
  floor.motion.frequency = 50.1;
  floor.motion.phase = 0.4;
  WallSystem walls({floor}, {{0, 0, 0}, {1, 1, 1}});
  SkinOptions skin;
  skin.steps = 10;
  skin.smallest_fraction = 0;
  skin.largest_fraction = 1;
  walls.set_allowances(skin, 1e-4, 1, 1);
  const Real allowance = 10 * 1e-4 * 2 * M_PI * 50.1 * 1e-3;
  const auto height = [](Real time) { return 1e-3 * std::sin(2 * M_PI * 50.1 * std::max(time, 0.0) + 0.4); };
  int outdated = 0;
  for (const Real built : {-1.0, 0.0, 0.013}) {
    walls.move_to(built);
    walls.build_list(Particles{}, NeighbourList{}, 1);
    EXPECT_FALSE(walls.list_outdated());
    for (int k = 0; k < 200; ++k) {
      const Real time = std::max(built, 0.0) + 1e-4 * k;
      walls.move_to(time);
      const bool beyond = std::abs(height(time) - height(built)) > allowance;
      EXPECT_EQ(walls.list_outdated(), beyond) << "built at " << built << ", at " << time;
      outdated += beyond ? 1 : 0;
    }
  }
  EXPECT_GT(outdated, 100);
}

TEST(WallMotion, OnlyShapesThatChangeByItTurn) {
  Wall disc;
  disc.revolved = {{{1, 2, 3}, {0, 0, 1}, 0, 0, 2, 0}};
  EXPECT_FALSE(has_to_turn(disc));
  disc.motion.spin = {0, 0, -3};
  disc.motion.through = {1, 2, 9};
  EXPECT_FALSE(has_to_turn(disc));
  disc.motion.through = {1.1, 2, 9};
  EXPECT_TRUE(has_to_turn(disc)) << "about another axis";
  disc.motion.through = {1, 2, 9};
  disc.motion.spin = {0, 1, -3};
  EXPECT_TRUE(has_to_turn(disc)) << "about a slanted axis";
  Wall mesh = mesh_wall(tests::box_triangles({0, 0, 0}, {1, 1, 1}));
  mesh.motion.spin = {0, 0, 1};
  EXPECT_TRUE(has_to_turn(mesh));
  EXPECT_NEAR(largest_arm(mesh, {}, {}), std::sqrt(2.0), 1e-15);
}

}  // namespace
}  // namespace pellicle::dem
