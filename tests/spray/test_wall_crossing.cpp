// Where paths cross walls: every shape by hand and against its own closest point sampled along random paths; meshes are
// watertight at edges and corners; walls that move; paths that end and go on at a wall.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "spray/wall_crossing.hpp"
#include "tests/dem/bed.hpp"
#include "tests/dem/meshes.hpp"

namespace pellicle::spray {
namespace {

using tests::random_vector;

// A dozen roundings of numbers of order one.
constexpr Real round_off = 1e-14;

TEST(WallCrossing, PlaneByHand) {
  // 3-4-5: normal (0.6, 0, 0.8), 2.2 from the origin; 2 in front of it, 3 behind it.
  const dem::PlaneShape plane{{0.6, 0, 0.8}, 2.2};
  EXPECT_NEAR(first_crossing(plane, {2.2, 5, 3.6}, {-0.8, 5, -0.4}), 0.4, round_off);
  EXPECT_EQ(first_crossing(plane, {2.2, 5, 3.6}, {2.2, 9, 3.5}), never);
  const dem::PlaneShape floor{{0, 0, 1}, 0};
  EXPECT_EQ(first_crossing(floor, {0, 0, 1}, {5, 0, 0}), 1);  // ends on it
  EXPECT_EQ(first_crossing(floor, {0, 0, 0}, {5, 0, 1}), never);
  EXPECT_EQ(first_crossing(floor, {0, 0, 0}, {5, 0, -1}), 0);
  EXPECT_EQ(first_crossing(floor, {0, 0, -1}, {5, 0, -2}), 0);     // inside the solid
  EXPECT_EQ(first_crossing(floor, {0, 0, -1}, {5, 0, 1}), never);  // on its way out
}

TEST(WallCrossing, BoxByHand) {
  const dem::BoxShape box{{0, 0, 0}, {2, 4, 6}};
  EXPECT_NEAR(first_crossing(box, {-1, 1, 1}, {4, 1, 1}), 0.2, round_off);
  EXPECT_NEAR(first_crossing(box, {1, 1, 10}, {1, 1, 2}), 0.5, round_off);
  EXPECT_NEAR(first_crossing(box, {-1, -1, 3}, {3, 3, 3}), 0.25, round_off);  // through an edge
  EXPECT_EQ(first_crossing(box, {-1, 5, 1}, {4, 5, 1}), never);
  EXPECT_EQ(first_crossing(box, {-1, 1, 1}, {-0.001, 1, 1}), never);
  EXPECT_EQ(first_crossing(box, {-1, 1, 1}, {0, 1, 1}), 1);     // ends on a side
  EXPECT_EQ(first_crossing(box, {1, 1, 6}, {1, 1, 9}), never);  // leaves the top
  EXPECT_EQ(first_crossing(box, {1, 1, 6}, {1, 1, 5}), 0);      // enters it
  EXPECT_EQ(first_crossing(box, {1, 1, 6}, {5, 1, 6}), never);  // slides along it
  EXPECT_EQ(first_crossing(box, {1, 1, 1}, {9, 1, 1}), 0);      // inside
}

TEST(WallCrossing, CylinderByHand) {
  // Radius 2 about the line x = 1, y = -1, from z = 3 to 6.
  const dem::RevolvedShape tube{{1, -1, 3}, {0, 0, 1}, 2, 0, 2, 3};
  EXPECT_NEAR(first_crossing(tube, {1, -1, 4}, {6, -1, 4}), 0.4, round_off);      // from inside
  EXPECT_NEAR(first_crossing(tube, {6, -1, 4}, {-4, -1, 4}), 0.3, round_off);     // from outside, through
  EXPECT_NEAR(first_crossing(tube, {6, 0.2, 5}, {-4, 0.2, 5}), 0.34, round_off);  // 1.2 aside: 1.6 out
  EXPECT_EQ(first_crossing(tube, {6, -1, 7}, {-4, -1, 7}), never);                // above it
  EXPECT_EQ(first_crossing(tube, {1, -1, 4}, {1, -1, 9}), never);                 // out of its end
  EXPECT_EQ(first_crossing(tube, {6, 1.5, 4}, {-4, 1.5, 4}), never);              // beside it
  // Over the top edge and in: through the wall at the far side, 1 below the edge.
  EXPECT_NEAR(first_crossing(tube, {-2, -1, 8}, {4, -1, 4.25}), 5.0 / 6, round_off);
  EXPECT_EQ(first_crossing(tube, {3, -1, 4}, {2, -1, 4}), never);  // begins on it
  EXPECT_NEAR(first_crossing(tube, {3, -1, 4}, {-5, -1, 4}), 0.5, round_off);
  EXPECT_EQ(first_crossing(tube, {2, -1, 4}, {3, -1, 4}), 1);  // ends on it
}

TEST(WallCrossing, DiscAnnulusAndConeByHand) {
  const dem::RevolvedShape disc{{0, 5, 0}, {0, 1, 0}, 0, 0, 2, 0};
  EXPECT_NEAR(first_crossing(disc, {1, 4, 1}, {1, 8, 1}), 0.25, round_off);
  EXPECT_NEAR(first_crossing(disc, {1, 8, 1}, {1, 4, 1}), 0.75, round_off);
  EXPECT_EQ(first_crossing(disc, {1.5, 4, 1.5}, {1.5, 8, 1.5}), never);
  const dem::RevolvedShape annulus{{0, 5, 0}, {0, 1, 0}, 1, 0, 2, 0};
  EXPECT_EQ(first_crossing(annulus, {0.5, 4, 0.5}, {0.5, 8, 0.5}), never);
  EXPECT_NEAR(first_crossing(annulus, {1, 4, 1}, {1, 8, 1}), 0.25, round_off);
  // Radius 1 at z = 0, 4 at z = 4: at z = 2 it is 2.5.
  const dem::RevolvedShape cone{{0, 0, 0}, {0, 0, 1}, 1, 0, 4, 4};
  EXPECT_NEAR(first_crossing(cone, {0, 0, 2}, {5, 0, 2}), 0.5, round_off);
  EXPECT_NEAR(first_crossing(cone, {0, 5, 2}, {0, -5, 2}), 0.25, round_off);
  // Down along the radius 2.5: the wall is there at z = 2.
  EXPECT_NEAR(first_crossing(cone, {2.5, 0, 4}, {2.5, 0, 0}), 0.5, round_off);
  // From the left, |x| = 4 - 3 s meets 1 + 3/4 (1 + 4 s).
  EXPECT_NEAR(first_crossing(cone, {-4, 0, 1}, {-1, 0, 5}), 0.375, round_off);
  // Parallel to the wall at the right, along (3, 4)/5: 4 - 6 s = 1 + 6 s at the left; and inside, where only the cone
  // below its end would be met.
  EXPECT_NEAR(first_crossing(cone, {-4, 0, 0}, {2, 0, 8}), 0.25, round_off);
  EXPECT_EQ(first_crossing(cone, {-1.5, 0, -2}, {4.5, 0, 6}), never);
  // The other half of the double cone, below its apex at z = -4/3, is no wall.
  EXPECT_EQ(first_crossing(cone, {0, 0, -3}, {5, 0, -3}), never);
}

TEST(WallCrossing, TriangleByHand) {
  const dem::TriangleShape triangle{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};
  EXPECT_NEAR(first_crossing(triangle, {1, 1, 1}, {1, 1, -3}), 0.25, round_off);
  EXPECT_NEAR(first_crossing(triangle, {1, 1, -3}, {1, 1, 1}), 0.75, round_off);
  EXPECT_EQ(first_crossing(triangle, {3, 1, 1}, {3, 1, -3}), never);
  EXPECT_EQ(first_crossing(triangle, {1, 1, 1}, {1, 1, 0.1}), never);
  EXPECT_EQ(first_crossing(triangle, {1, 1, 1}, {1, 1, 0}), 1);
  EXPECT_EQ(first_crossing(triangle, {1, 1, 0}, {1, 1, -1}), never);
  EXPECT_NEAR(first_crossing(triangle, {2, 0, 1}, {2, 0, -1}), 0.5, round_off);  // on an edge
  EXPECT_NEAR(first_crossing(triangle, {0, 0, 1}, {0, 0, -1}), 0.5, round_off);  // on a corner
}

/// Where a path is first closer to the shape than it can be without crossing, and on another side: its closest point's
/// direction turns round between two samples.
template <class Shape>
Real sampled_crossing(const Shape& shape, const Vec3& from, const Vec3& to, int samples, bool& grazes) {
  dem::ClosestPoint before = shape.closest(from);
  const Real spacing = norm(to - from) / samples;
  grazes = false;
  for (int k = 1; k <= samples; ++k) {
    const Vec3 at = from + (static_cast<Real>(k) / samples) * (to - from);
    const dem::ClosestPoint now = shape.closest(at);
    if (now.distance < 0 && before.distance >= 0) return static_cast<Real>(k) / samples;
    const bool near = before.distance + now.distance <= 1.001 * spacing;
    if (near && (before.rim || now.rim)) grazes = true;
    if (near && !before.rim && !now.rim && dot(before.towards, now.towards) < -0.9) {
      return static_cast<Real>(k) / samples;
    }
    if (near && norm(before.towards + now.towards) > 0.2 && now.distance < 0.1 * spacing) grazes = true;
    before = now;
  }
  return never;
}

template <class Shape>
void compare_with_samples(const Shape& shape, int seed) {
  int crossed = 0;
  int compared = 0;
  for (int n = 0; n < 1500; ++n) {
    const Vec3 from = 3.0 * random_vector(seed, 2 * n);
    const Vec3 to = from + 3.0 * random_vector(seed, 2 * n + 1);
    if (shape.closest(from).distance < 0) continue;
    const int samples = 4000;
    bool grazes = false;
    const Real expected = sampled_crossing(shape, from, to, samples, grazes);
    if (grazes) continue;  // along an edge, or at a sharp angle: sampling cannot tell
    ++compared;
    const Real got = first_crossing(shape, from, to);
    if (expected == never) {
      // Sampling may miss a corner that is cut by less than a spacing.
      if (got <= 1) {
        const dem::ClosestPoint at = shape.closest(from + got * (to - from));
        EXPECT_LT(std::abs(at.distance), 1e-6) << n;
      }
      continue;
    }
    ++crossed;
    EXPECT_NEAR(got, expected, 1.01 / samples) << n;
  }
  EXPECT_GT(crossed, 60);
  EXPECT_GT(compared, 400);
}

TEST(WallCrossing, EveryShapeAgainstSampledPaths) {
  const Real s = std::sqrt(0.5);
  compare_with_samples(dem::PlaneShape{{s, 0, s}, 0.3}, 11);
  compare_with_samples(dem::BoxShape{{-1, -0.5, -2}, {1, 1.5, 0.5}}, 12);
  compare_with_samples(dem::RevolvedShape{{0.1, 0.2, -1}, {0, s, s}, 1.2, 0, 1.2, 2}, 13);
  compare_with_samples(dem::RevolvedShape{{0, 0, -1}, {s, 0, s}, 0.4, 0, 1.9, 2.2}, 14);
  compare_with_samples(dem::RevolvedShape{{0, 0, 0}, {0, 0, 1}, 1.9, -1, 0.4, 1}, 15);
  compare_with_samples(dem::RevolvedShape{{0, 0.3, 0}, {0, s, -s}, 0.5, 0, 2.5, 0}, 16);
  compare_with_samples(dem::TriangleShape{{-2, -1, 0.5}, {2, -1.5, -0.5}, {0, 2, 1}}, 17);
}

/// One wall of a mesh, and paths against it.
struct MeshWall {
  dem::WallGeometry geometry;
  explicit MeshWall(const std::vector<dem::TriangleShape>& triangles) {
    dem::Wall wall;
    wall.mesh = tests::loose_mesh(triangles);
    geometry = dem::make_wall_geometry({wall});
  }
  Real crossing(const Vec3& from, const Vec3& to) const {
    return first_wall_crossing({geometry, geometry.pose}, from, to);
  }
};

TEST(WallCrossing, MeshesAreWatertightAtEdgesAndCorners) {
  const auto box = tests::box_triangles({-1, -1.3, -0.7}, {1.1, 0.9, 1.7});
  const auto tube = tests::tube_triangles(0.8, -3, 3, 24);
  int number = 0;
  for (const auto* triangles : {&box, &tube}) {
    const MeshWall wall(*triangles);
    for (const dem::TriangleShape& t : *triangles) {
      for (int k = 0; k < 40; ++k) {
        // From a point inside through a point of an edge, or a corner, to beyond.
        const Real share = k < 4 ? 0.0 : 0.5 * (random_vector(21, number).x + 1);
        const Vec3 target = k % 2 == 0 ? t.a + share * (t.b - t.a) : t.c + share * (t.a - t.c);
        if (std::abs(target.y) > 2.9) continue;  // the tube has no ends
        const Vec3 from = 0.5 * random_vector(22, number++);
        ASSERT_LE(wall.crossing(from, target + (target - from)), 1) << number;
        ASSERT_LE(wall.crossing(target + 0.7 * (target - from), from), 1) << number;
      }
    }
  }
}

TEST(WallCrossing, AWanderingPathDoesNotLeakOnALatticeOfEdges) {
  // Steps between lattice points, on which all sides, edges and corners of the box lie: the worst there is. A path ends
  // when it crosses; until then it has to stay inside.
  const MeshWall mesh(tests::box_triangles({-2, -2, -2}, {2, 2, 2}));
  dem::Wall shell;
  shell.revolved = {{{0, 0, -2}, {0, 0, 1}, 2, 0, 2, 4},
                    {{0, 0, -2}, {0, 0, 1}, 0, 0, 2, 0},
                    {{0, 0, 2}, {0, 0, 1}, 0, 0, 2, 0}};
  const dem::WallGeometry can = dem::make_wall_geometry({shell});
  for (int walk = 0; walk < 400; ++walk) {
    for (const bool is_mesh : {true, false}) {
      Vec3 at{0, 0, 0};
      bool crossed = false;
      for (int k = 0; k < 200 && !crossed; ++k) {
        const Vec3 draw = random_vector(31, 200 * walk + k);
        const Vec3 next =
            at + Vec3{std::round(1.49 * draw.x), std::round(1.49 * draw.y), std::round(1.49 * draw.z)};
        crossed = (is_mesh ? mesh.crossing(at, next) : first_wall_crossing({can, can.pose}, at, next)) <= 1;
        if (crossed) break;
        at = next;
        const bool inside = is_mesh ? std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) < 2
                                    : std::abs(at.z) < 2 && at.x * at.x + at.y * at.y < 4;
        ASSERT_TRUE(inside) << "walk " << walk << (is_mesh ? " of the mesh" : " of the can") << " is out at "
                            << at.x << " " << at.y << " " << at.z;
      }
      EXPECT_TRUE(crossed);
    }
  }
}

TEST(WallCrossing, AMovingWallMeetsARestingPoint) {
  // A disc that swings by 1 about z = 0: from z = 0 to 1 in a quarter of its period passes a point at 0.5 half-way.
  dem::Wall wall;
  wall.revolved = {{{0, 0, 0}, {0, 0, 1}, 0, 0, 2, 0}};
  wall.motion.amplitude = {0, 0, 1};
  wall.motion.frequency = 1;
  const dem::WallGeometry geometry = dem::make_wall_geometry({wall});
  dem::update_poses(geometry, 0);
  const DeviceArray<dem::WallPose> later("tests::spray::later", 1);
  later(0) = dem::compute_pose(geometry.body(0).motion, false, 0.25);
  EXPECT_NEAR(first_wall_crossing({geometry, later}, {1, 0, 0.5}, {1, 0, 0.5}), 0.5, round_off);
  EXPECT_EQ(first_wall_crossing({geometry, later}, {1, 0, 1.5}, {1, 0, 1.5}), never);
  // One that runs ahead of it is not met.
  EXPECT_EQ(first_wall_crossing({geometry, later}, {1, 0, 0.1}, {1, 0, 1.1}), never);
}

TEST(WallCrossing, ATurningMeshMeetsARestingPoint) {
  // A blade in the plane y = 0, x from 0.5 to 2, that turns about z by 90 degrees: it passes (1, 1) at 45 degrees.
  dem::Wall wall;
  wall.mesh =
      tests::loose_mesh({{{0.5, 0, -1}, {2, 0, -1}, {2, 0, 1}}, {{0.5, 0, -1}, {2, 0, 1}, {0.5, 0, 1}}});
  wall.motion.spin = {0, 0, 0.5 * M_PI};
  const dem::WallGeometry geometry = dem::make_wall_geometry({wall});
  ASSERT_TRUE(geometry.body(0).turning);
  dem::update_poses(geometry, 0);
  const DeviceArray<dem::WallPose> later("tests::spray::later", 1);
  later(0) = dem::compute_pose(geometry.body(0).motion, true, 1);
  const Real share = first_wall_crossing({geometry, later}, {1, 1, 0}, {1, 1, 0});
  // Straight in the frame of the blade, from (1, 1) to (1, -1): half-way.
  EXPECT_NEAR(share, 0.5, round_off);
  EXPECT_EQ(first_wall_crossing({geometry, later}, {-1, -1, 0}, {-1, -1, 0}), never);
}

}  // namespace
}  // namespace pellicle::spray
