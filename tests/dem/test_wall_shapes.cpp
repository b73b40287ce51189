// Closest points of the wall shapes, against numbers worked out by hand and against a dense sampling of each shape.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "dem/wall_shapes.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

using tests::random_vector;

// A dozen roundings of numbers of order one.
constexpr Real round_off = 1e-14;

void expect_near(const Vec3& value, const Vec3& expected, Real tolerance, const char* what) {
  EXPECT_LE(norm(value - expected), tolerance)
      << what << ": (" << value.x << ", " << value.y << ", " << value.z << ") instead of (" << expected.x
      << ", " << expected.y << ", " << expected.z << ")";
}

struct Expected {
  Vec3 from;
  Vec3 point, towards;
  Real distance;
  bool rim;
};

template <class Shape>
void check(const Shape& shape, const std::vector<Expected>& cases) {
  for (const Expected& e : cases) {
    const ClosestPoint got = shape.closest(e.from);
    SCOPED_TRACE(testing::Message() << "from (" << e.from.x << ", " << e.from.y << ", " << e.from.z << ")");
    expect_near(got.point, e.point, round_off, "point");
    expect_near(got.towards, e.towards, round_off, "direction");
    EXPECT_NEAR(got.distance, e.distance, round_off);
    EXPECT_EQ(got.rim, e.rim);
  }
}

TEST(WallShapes, PlaneIsSolidBehind) {
  // 3-4-5: normal (0.6, 0, 0.8) through (1, 7, 2), offset 2.2.
  check(PlaneShape{{0.6, 0, 0.8}, 2.2}, {
                                            {{2.2, 5, 3.6}, {1, 5, 2}, {-0.6, 0, -0.8}, 2, false},
                                            {{0.4, 5, 1.2}, {1, 5, 2}, {-0.6, 0, -0.8}, -1, false},
                                        });
}

TEST(WallShapes, CylinderFromInsideOutsideAndBeyondItsEnds) {
  // Radius 2 about the line x = 1, y = -1, from z = 3 to 6.
  const RevolvedShape cylinder{{1, -1, 3}, {0, 0, 1}, 2, 0, 2, 3};
  const Real root = std::sqrt(2.0);
  check(cylinder, {
                      {{1.5, -1, 4}, {3, -1, 4}, {1, 0, 0}, 1.5, false},         // inside
                      {{1, 3, 4}, {1, 1, 4}, {0, -1, 0}, 2, false},              // outside
                      {{1.6, -0.2, 5}, {2.2, 0.6, 5}, {0.6, 0.8, 0}, 1, false},  // inside, 3-4-5
                      {{1, -2, 7}, {1, -3, 6}, {0, -1 / root, -1 / root}, root, true},
                      {{4, -1, 2}, {3, -1, 3}, {-1 / root, 0, 1 / root}, root, true},
                      {{3, -1, 4.5}, {3, -1, 4.5}, {1, 0, 0}, 0, false},  // on it
                  });
}

TEST(WallShapes, DiscAndAnnulusHaveTwoSidesAndAnEdge) {
  // About the axis along y through (0, 5, 0).
  const RevolvedShape disc{{0, 5, 0}, {0, 1, 0}, 0, 0, 2, 0};
  check(disc, {
                  {{1, 6, 0}, {1, 5, 0}, {0, -1, 0}, 1, false},
                  {{0, 3, -1.5}, {0, 5, -1.5}, {0, 1, 0}, 2, false},
                  {{0, 8, 0}, {0, 5, 0}, {0, -1, 0}, 3, false},  // above the middle, which is no rim
                  {{3, 9, 4}, {1.2, 5, 1.6}, {-0.36, -0.8, -0.48}, 5, true},
                  {{0.5, 5, 0.5}, {0.5, 5, 0.5}, {0, -1, 0}, 0, false},  // on it: either side
              });
  // Seen from (3, 9, 4): 5 from the axis, 3 beyond the edge, 4 above: 3-4-5 again.
  const RevolvedShape annulus{{0, 5, 0}, {0, 1, 0}, 1, 0, 2, 0};
  check(annulus,
        {
            {{1.5, 6, 0}, {1.5, 5, 0}, {0, -1, 0}, 1, false},
            {{0, 5.75, 0.25}, {0, 5, 1}, {0, -std::sqrt(0.5), std::sqrt(0.5)}, 0.75 * std::sqrt(2.0), true},
        });
}

TEST(WallShapes, ConeFrustum) {
  // Radius 1 at z = 0, 4 at z = 4: the wall runs along (3, 4)/5, its normal is (4, -3)/5.
  const RevolvedShape cone{{0, 0, 0}, {0, 0, 1}, 1, 0, 4, 4};
  check(cone, {
                  // 1 to the inside of the middle (2.5, 2) of the wall
                  {{1.7, 0, 2.6}, {2.5, 0, 2}, {0.8, 0, -0.6}, 1, false},
                  // 2 to the outside of it, at azimuth 3-4-5: r = 4.1
                  {{0.6 * 4.1, 0.8 * 4.1, 0.8}, {1.5, 2, 2}, {-0.48, -0.64, 0.6}, 2, false},
                  {{1, 0, -2}, {1, 0, 0}, {0, 0, 1}, 2, true},
                  {{4, 0, 5}, {4, 0, 4}, {0, 0, -1}, 1, true},
              });
}

TEST(WallShapes, SolidBox) {
  const BoxShape box{{0, 0, 0}, {2, 4, 6}};
  check(box, {
                 {{1, 1, 8}, {1, 1, 6}, {0, 0, -1}, 2, false},
                 {{-3, 1, 1}, {0, 1, 1}, {1, 0, 0}, 3, false},
                 {{5, 8, 3}, {2, 4, 3}, {-0.6, -0.8, 0}, 5, true},
                 {{4, 5, -2}, {2, 4, 0}, {-2.0 / 3, -1.0 / 3, 2.0 / 3}, 3, true},
                 {{1.5, 2, 3}, {2, 2, 3}, {-1, 0, 0}, -0.5, false},
                 {{1, 0.25, 3}, {1, 0, 3}, {0, 1, 0}, -0.25, false},
             });
}

TEST(WallShapes, TriangleFaceEdgesAndCorners) {
  const TriangleShape triangle{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};
  check(triangle, {
                      {{1, 1, 2}, {1, 1, 0}, {0, 0, -1}, 2, false},
                      {{1, 1, -2}, {1, 1, 0}, {0, 0, 1}, 2, false},
                      {{2, -3, 4}, {2, 0, 0}, {0, 0.6, -0.8}, 5, true},
                      {{-4, 1, 3}, {0, 1, 0}, {0.8, 0, -0.6}, 5, true},
                      // Beyond the long side, whose middle is (2, 1.5) and whose normal (0.6, 0.8).
                      {{2.6, 2.3, 0}, {2, 1.5, 0}, {-0.6, -0.8, 0}, 1, true},
                      {{-2, -1, 2}, {0, 0, 0}, {2.0 / 3, 1.0 / 3, -2.0 / 3}, 3, true},
                      {{6, -1, 2}, {4, 0, 0}, {-2.0 / 3, 1.0 / 3, -2.0 / 3}, 3, true},
                      {{-1, 5, -2}, {0, 3, 0}, {1.0 / 3, -2.0 / 3, 2.0 / 3}, 3, true},
                      {{1, 1, 0}, {1, 1, 0}, {0, 0, 1}, 0, false},
                  });
}

/// Smallest distance of a point from a surface, sampled at (n + 1)² parameters in [0, 1]².
template <class Surface>
Real sampled_distance(const Vec3& from, const Surface& surface, int n) {
  Real smallest = std::numeric_limits<Real>::infinity();
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      smallest = std::min(smallest, norm_squared(surface(Real(i) / n, Real(j) / n) - from));
  }
  return std::sqrt(smallest);
}

TEST(WallShapes, AgreeWithADenseSampling) {
  // A sample is at most half a spacing of n = 400 from the true closest point, which makes the sampled distance too large
  // by at most h²/(2 distance) + … < h for h = 0.03; never too small.
  const Real spacing = 0.03;
  const Vec3 axis{2.0 / 3, 1.0 / 3, 2.0 / 3};
  const Vec3 side = perpendicular_to(axis);
  const Vec3 other = cross(axis, side);
  EXPECT_NEAR(norm(side), 1, round_off);
  EXPECT_NEAR(dot(side, axis), 0, round_off);
  const RevolvedShape cone{{0.1, 0.2, -0.3}, axis, 0.4, -0.5, 1.2, 0.7};
  const TriangleShape triangle{{-1, 0.2, 0.3}, {1.2, 0.5, -0.4}, {0.1, -0.9, 1.1}};
  for (int k = 0; k < 60; ++k) {
    const Vec3 from = 2.0 * random_vector(71, k);
    const auto on_cone = [&](Real s, Real t) {
      const Real r = cone.r0 + s * (cone.r1 - cone.r0);
      const Real z = cone.z0 + s * (cone.z1 - cone.z0);
      return cone.origin + z * axis + (r * std::cos(2 * M_PI * t)) * side +
             (r * std::sin(2 * M_PI * t)) * other;
    };
    const ClosestPoint a = cone.closest(from);
    const Real sampled_a = sampled_distance(from, on_cone, 400);
    EXPECT_LE(a.distance, sampled_a + round_off);
    EXPECT_GT(a.distance, sampled_a - spacing);
    const auto on_triangle = [&](Real s, Real t) {
      return triangle.a + s * (triangle.b - triangle.a) + (t * (1 - s)) * (triangle.c - triangle.a);
    };
    const ClosestPoint b = triangle.closest(from);
    const Real sampled_b = sampled_distance(from, on_triangle, 400);
    EXPECT_LE(b.distance, sampled_b + round_off);
    EXPECT_GT(b.distance, sampled_b - spacing);
    for (const ClosestPoint& c : {a, b}) {
      expect_near(from + c.distance * c.towards, c.point, 4 * round_off, "point along the direction");
      EXPECT_NEAR(norm(c.towards), 1, round_off);
    }
  }
}

}  // namespace
}  // namespace pellicle::dem
