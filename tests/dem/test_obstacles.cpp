// Particles and walls before a run: how deep a sphere is inside a wall of each shape, and fills that keep clear of walls.
#include "dem/obstacles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "dem/fill.hpp"
#include "dem/stl.hpp"
#include "tests/dem/meshes.hpp"

namespace pellicle::dem {
namespace {

Wall wall_of(const RevolvedShape& shape) {
  Wall wall;
  wall.revolved = {shape};
  return wall;
}

Wall block(const Vec3& min, const Vec3& max) {
  Wall wall;
  wall.boxes = {{min, max}};
  return wall;
}

/// A mesh as it is read from a file, corners welded.
Wall mesh_of(const std::vector<TriangleShape>& triangles) {
  Wall wall;
  MeshReport report;
  wall.mesh = std::make_shared<TriangleMesh>(parse_stl(tests::binary_stl(triangles), 1, report));
  return wall;
}

void expect_overlap(const Wall& wall, const Vec3& centre, Real radius, Real depth, const Vec3& out) {
  const auto overlap =
      Obstacles({PlaneWall{"other", {0, 0, -9}, {0, 0, 1}, {}, 0}, wall}).deepest(centre, radius);
  ASSERT_TRUE(overlap) << "nothing overlaps";
  EXPECT_EQ(overlap->wall, 1);
  EXPECT_NEAR(overlap->depth, depth, 1e-7);
  EXPECT_NEAR(norm(overlap->out - out), 0, 1e-6);
}

TEST(Obstacles, DepthInEachShape) {
  const Real root = std::sqrt(0.5);
  const Wall tube = wall_of({{0, 0, 0}, {0, 0, 1}, 0.05, 0, 0.05, 0.1});
  expect_overlap(tube, {0.047, 0, 0.05}, 0.004, 0.001, {-1, 0, 0});
  expect_overlap(tube, {0, 0.053, 0.05}, 0.004, 0.001, {0, 1, 0});
  EXPECT_TRUE(Obstacles({tube}).clear({0.046, 0, 0.05}, 0.004));
  EXPECT_FALSE(Obstacles({tube}).clear({0.0461, 0, 0.05}, 0.004));
  // A cone of 45 degrees, from above: |r - z| / root 2 from its surface.
  const Wall cone = wall_of({{0, 0, 0}, {0, 0, 1}, 0.01, 0.01, 0.1, 0.1});
  expect_overlap(cone, {0.05, 0, 0.053}, 0.004, 0.004 - 0.003 * root, {-root, 0, root});
  const Wall plate = wall_of({{0, 0, 0.02}, {0, 0, 1}, 0.01, 0, 0.05, 0});
  expect_overlap(plate, {0.03, 0, 0.021}, 0.002, 0.001, {0, 0, 1});
  expect_overlap(plate, {0.03, 0, 0.0195}, 0.002, 0.0015, {0, 0, -1});
  EXPECT_TRUE(Obstacles({plate}).clear({0, 0, 0.02}, 0.009));  // through its hole
  const Wall solid = block({0, 0, 0}, {0.1, 0.1, 0.1});
  expect_overlap(solid, {0.05, 0.05, 0.101}, 0.002, 0.001, {0, 0, 1});
  expect_overlap(solid, {0.05, 0.05, 0.097}, 0.002, 0.005, {0, 0, 1});
  expect_overlap(PlaneWall{"floor", {0, 0, 0.01}, {0, 0, 1}, {}, 0}, {0, 0, 0.007}, 0.002, 0.005, {0, 0, 1});
}

TEST(Obstacles, WallsAreWhereTheyRestBeforeTheyMove) {
  Wall shaken = block({0, 0, 0}, {0.1, 0.1, 0.1});
  shaken.motion.amplitude = {0, 0, 0.01};
  shaken.motion.frequency = 50;
  shaken.motion.phase = M_PI / 2;
  expect_overlap(shaken, {0.05, 0.05, 0.111}, 0.002, 0.001, {0, 0, 1});
}

TEST(Obstacles, MeshesArePartedIntoWithinAndOutside) {
  const Vec3 low{0.02, 0.03, 0.04}, high{0.05, 0.07, 0.06};
  const Obstacles box({mesh_of(tests::box_triangles(low, high))});
  ASSERT_EQ(box.closed_meshes(), std::vector<std::int32_t>{0});
  // The tube about y has a polygon as its section, and no ends.
  EXPECT_TRUE(Obstacles({mesh_of(tests::tube_triangles(0.05, 0, 0.1, 24))}).closed_meshes().empty());
  int within = 0;
  for (int n = 0; n < 4000; ++n) {
    const Vec3 x = 0.1 * core::random_uniform3(5, core::Purpose::test, 0, n);
    const bool expected =
        x.x > low.x && x.x < high.x && x.y > low.y && x.y < high.y && x.z > low.z && x.z < high.z;
    EXPECT_EQ(box.encloses(0, x), expected) << x.x << " " << x.y << " " << x.z;
    within += expected ? 1 : 0;
  }
  EXPECT_GT(within, 50);
  // Straight below corners, edges and the diagonals of the sides.
  for (const Vec3& x :
       {low, high, Vec3{0.035, 0.05, 0}, Vec3{0.02, 0.05, 0}, Vec3{0.03, 0.03 + 0.04 / 3, 0}}) {
    EXPECT_FALSE(box.encloses(0, {x.x, x.y, 0.001}));
    EXPECT_FALSE(box.encloses(0, {x.x, x.y, 0.099}));
  }
  EXPECT_TRUE(box.encloses(0, {0.035, 0.05, 0.05}));
  // An octahedron: every side is slanted.
  std::vector<TriangleShape> sides;
  for (int s = 0; s < 8; ++s) {
    const Vec3 a{(s & 1) != 0 ? 1.0 : -1.0, 0, 0}, b{0, (s & 2) != 0 ? 1.0 : -1.0, 0},
        c{0, 0, (s & 4) != 0 ? 1.0 : -1.0};
    const bool outwards = dot(cross(b - a, c - a), a + b + c) > 0;
    sides.push_back(outwards ? TriangleShape{a, b, c} : TriangleShape{a, c, b});
  }
  const Obstacles octahedron({mesh_of(sides)});
  ASSERT_EQ(octahedron.closed_meshes().size(), 1U);
  for (int n = 0; n < 4000; ++n) {
    const Vec3 x = 2.0 * core::random_uniform3(6, core::Purpose::test, 0, n) - Vec3{1, 1, 1};
    EXPECT_EQ(octahedron.encloses(0, x), std::abs(x.x) + std::abs(x.y) + std::abs(x.z) < 1) << n;
  }
}

TEST(Obstacles, TheSideOfAMeshThatARegionIsOnIsRoom) {
  const Wall insert = mesh_of(tests::box_triangles({0.04, 0.04, 0.04}, {0.06, 0.06, 0.06}));
  Obstacles obstacles({insert});
  const Vec3 middle{0.05, 0.05, 0.057};
  EXPECT_TRUE(obstacles.clear(middle, 0.002));  // a thin surface, as far as is known
  obstacles.choose_sides(Box{{0, 0, 0}, {0.1, 0.1, 0.1}});
  const auto overlap = obstacles.deepest(middle, 0.002);
  ASSERT_TRUE(overlap);
  EXPECT_NEAR(overlap->depth, 0.005, 1e-8);
  EXPECT_NEAR(overlap->out.z, 1, 1e-6);
  EXPECT_TRUE(obstacles.clear({0.02, 0.02, 0.02}, 0.002));
  obstacles.choose_sides(Box{{0.041, 0.041, 0.041}, {0.062, 0.059, 0.059}});
  EXPECT_TRUE(obstacles.clear(middle, 0.002));
  const auto outside = obstacles.deepest({0.08, 0.05, 0.05}, 0.002);
  ASSERT_TRUE(outside);
  EXPECT_NEAR(outside->depth, 0.022, 1e-8);
  EXPECT_NEAR(outside->out.x, -1, 1e-6);
}

/// Distance of a point from a box, 0 inside.
Real distance_from(const Vec3& x, const Vec3& min, const Vec3& max) {
  Real squared = 0;
  for (int a = 0; a < 3; ++a) {
    const Real beyond = std::max({min[a] - x[a], Real{0}, x[a] - max[a]});
    squared += beyond * beyond;
  }
  return std::sqrt(squared);
}

TEST(Fill, KeepsClearOfWallsWithinItsRegion) {
  const Box region{{0, 0, 0}, {0.05, 0.05, 0.05}};
  const Vec3 low{0.015, 0.015, 0.015}, high{0.035, 0.035, 0.04};
  for (const Wall& insert : {block(low, high), mesh_of(tests::box_triangles(low, high))}) {
    for (const auto& [pattern, count] :
         {std::pair(FillPattern::random, 800), std::pair(FillPattern::random, 3000),
          std::pair(FillPattern::lattice, 2400), std::pair(FillPattern::hexagonal, 2400)}) {
      const std::vector<Real> radii(static_cast<std::size_t>(count), 0.0015);
      // Without the wall the same fill has spheres where it would be.
      const auto free = fill_region(region, pattern, radii, 3);
      ASSERT_EQ(free.size(), radii.size());
      const auto inside = [&](const Vec3& x) { return distance_from(x, low, high) < 0.0015; };
      EXPECT_GT(std::count_if(free.begin(), free.end(), inside), count / 20);
      const auto centres = fill_region(region, pattern, radii, 3, {}, Obstacles({insert}));
      ASSERT_EQ(centres.size(), radii.size());
      for (const Vec3& x : centres) {
        EXPECT_GE(distance_from(x, low, high), 0.0015 * (1 - 2e-6));
        EXPECT_GE(distance_from(x, {-1, -1, -1}, {0, 1, 1}), 0.0015 * (1 - 1e-8));
      }
      for (std::size_t p = 0; p < centres.size(); ++p) {
        for (std::size_t q = 0; q < p; ++q)
          ASSERT_GE(norm(centres[p] - centres[q]), 0.003 * (1 - 1e-9)) << p << " and " << q;
      }
    }
  }
}

TEST(Fill, RefusesWhatWallsLeaveNoRoomFor) {
  const Box region{{0, 0, 0}, {0.02, 0.02, 0.02}};
  const Obstacles all({block({0.001, 0.001, 0.001}, {0.019, 0.019, 0.019})});
  for (const FillPattern pattern : {FillPattern::random, FillPattern::lattice, FillPattern::hexagonal})
    EXPECT_LT(fill_region(region, pattern, std::vector<Real>(20, 0.0015), 1, {}, all).size(), 20U);
}

}  // namespace
}  // namespace pellicle::dem
