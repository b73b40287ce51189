// When a path first touches a sphere: worked out by hand, and against the distance sampled along random paths.
#include <gtest/gtest.h>

#include <cmath>

#include "spray/swept_capture_laws.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::spray {
namespace {

TEST(SweptCapture, ByHand) {
  // Towards the centre from 5, over 10, sphere of 1: after 4.
  EXPECT_NEAR(first_touch({-5, 0, 0}, {10, 0, 0}, 1), 0.4, 1e-15);
  // 3-4-5: 3 beside the centre of a sphere of 5, met 4 before it.
  EXPECT_NEAR(first_touch({-10, 3, 0}, {8, 0, 0}, 5), 0.75, 1e-15);
  // Ends just before it, or has to go on a little.
  EXPECT_EQ(first_touch({-5, 0, 0}, {3.999, 0, 0}, 1), never);
  EXPECT_NEAR(first_touch({-5, 0, 0}, {4, 0, 0}, 1), 1, 1e-15);
  // Passes beside it, flies away, or rests.
  EXPECT_EQ(first_touch({-5, 1.0001, 0}, {10, 0, 0}, 1), never);
  EXPECT_EQ(first_touch({-5, 0, 0}, {-10, 0, 0}, 1), never);
  EXPECT_EQ(first_touch({-5, 0, 0}, {0, 0, 0}, 1), never);
  // Inside: at once, also on the way out and at rest; on the surface only on the way in.
  EXPECT_EQ(first_touch({0.5, 0, 0}, {10, 0, 0}, 1), 0);
  EXPECT_EQ(first_touch({0.5, 0, 0}, {0, 0, 0}, 1), 0);
  EXPECT_EQ(first_touch({1, 0, 0}, {-1, 0, 0}, 1), 0);
  EXPECT_EQ(first_touch({1, 0, 0}, {1, 0, 0}, 1), never);
}

TEST(SweptCapture, AgainstSampledDistance) {
  int touched = 0;
  for (int n = 0; n < 6000; ++n) {
    const Vec3 start = 3.0 * tests::random_vector(1, 2 * n);
    const Vec3 path = 4.0 * tests::random_vector(1, 2 * n + 1);
    if (norm(start) <= 1) continue;
    Real expected = never;
    const int samples = 20000;
    for (int k = 0; k <= samples && expected == never; ++k) {
      const Real share = static_cast<Real>(k) / samples;
      if (norm(start + share * path) <= 1) expected = share;
    }
    const Real share = first_touch(start, path, 1);
    if (expected == never) {
      // Between two samples it may dive in by less than (spacing/2)²/2.
      if (share <= 1) {
        EXPECT_GT(norm(start + share * path), 1 - 1e-7);
      }
      continue;
    }
    ++touched;
    EXPECT_NEAR(share, expected, 1.0001 / samples) << n;
    EXPECT_LE(share, expected + 1e-12);
  }
  EXPECT_GT(touched, 200);
}

TEST(SweptCapture, WeberNumberAndEfficiency) {
  // Water, 30 um, 10 m/s: 1000 * 100 * 3e-5 / 0.072 = 41.667.
  EXPECT_NEAR(weber_number(1000, 10, 30e-6, 0.072), 41.6666666666667, 1e-10);
  CaptureEfficiency all;
  EXPECT_EQ(all(1e9), 1);
  CaptureEfficiency table;
  table.points = 3;
  table.surface_tension = 0.072;
  const Real weber[] = {10, 20, 100};
  const Real share[] = {1, 0.5, 0.1};
  for (int i = 0; i < 3; ++i) {
    table.weber[i] = weber[i];
    table.share[i] = share[i];
  }
  EXPECT_EQ(table(0), 1);
  EXPECT_NEAR(table(15), 0.75, 1e-15);
  EXPECT_NEAR(table(20), 0.5, 1e-15);
  EXPECT_NEAR(table(60), 0.3, 1e-15);
  EXPECT_EQ(table(1e6), 0.1);
}

}  // namespace
}  // namespace pellicle::spray
