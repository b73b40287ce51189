// Areas that discs, annuli and rectangles share, against closed forms and against counting points.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "cfd/plane_region.hpp"

namespace pellicle::cfd {
namespace {

constexpr Real pi = std::numbers::pi;

TEST(PlaneRegion, CircleAndRectangle) {
  const Rectangle quarter{{0, 0}, {5, 5}};
  EXPECT_NEAR(circle_rectangle_area({0, 0}, 2, quarter), pi, 1e-14);
  EXPECT_NEAR(circle_rectangle_area({1, 1}, 0.5, quarter), pi / 4, 1e-14);        // all of it
  EXPECT_NEAR(circle_rectangle_area({0.5, 0.5}, 2, {{0, 0}, {1, 1}}), 1, 1e-14);  // all of the square
  EXPECT_EQ(circle_rectangle_area({-3, 2}, 2, quarter), 0);
  EXPECT_EQ(circle_rectangle_area({-1, -1}, 1.4, quarter), 0);  // the corner is 1.41 away
  // A segment of height 0.5 of a unit circle: acos(1/2) - 1/2 sqrt(3/4).
  EXPECT_NEAR(circle_rectangle_area({0, 0}, 1, {{-2, 0.5}, {2, 3}}), std::acos(0.5) - 0.5 * std::sqrt(0.75),
              1e-14);
  // A strip that cuts both sides.
  const Real strip = pi - 2 * (std::acos(0.3) - 0.3 * std::sqrt(1 - 0.09));
  EXPECT_NEAR(circle_rectangle_area({0, 0}, 1, {{-2, -0.3}, {2, 0.3}}), strip, 1e-14);
}

// Any way to divide a rectangle into parts gives the same area.
TEST(PlaneRegion, PartsAddUp) {
  Real sum = 0;
  for (int i = 0; i < 17; ++i) {
    for (int j = 0; j < 13; ++j) {
      sum +=
          circle_rectangle_area({0.52, 0.47}, 0.31, {{i / 17.0, j / 13.0}, {(i + 1) / 17.0, (j + 1) / 13.0}});
    }
  }
  EXPECT_NEAR(sum, pi * 0.31 * 0.31, 1e-14);
}

// Against 2000 x 2000 points, of which a step of the edge is one in a thousand of the radius.
TEST(PlaneRegion, CircleAndRectangleByCounting) {
  const std::vector<Rectangle> rectangles{
      {{-2, -2}, {2, 2}},   {{0.5, -2}, {2, 2}},  {{-0.3, 0.2}, {0.4, 0.9}},  {{0.6, 0.6}, {1, 1}},
      {{0.8, 0.8}, {1, 1}}, {{-2, 0.95}, {2, 3}}, {{-0.1, -0.1}, {0.1, 0.1}}, {{-1.5, -0.9}, {-0.2, 0.1}}};
  for (const Rectangle& r : rectangles) {
    const int n = 2000;
    int inside = 0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const Real x = -1 + 2 * (i + 0.5) / n;
        const Real y = -1 + 2 * (j + 0.5) / n;
        if (x * x + y * y < 1 && x > r.min[0] && x < r.max[0] && y > r.min[1] && y < r.max[1]) ++inside;
      }
    }
    EXPECT_NEAR(circle_rectangle_area({0, 0}, 1, r), 4.0 * inside / (n * n), 3e-3)
        << r.min[0] << " " << r.min[1] << " " << r.max[0] << " " << r.max[1];
  }
}

TEST(PlaneRegion, TwoCircles) {
  // Unit circles one apart: 2 pi / 3 - sqrt(3) / 2.
  EXPECT_NEAR(circle_circle_area({0, 0}, 1, {1, 0}, 1), 2 * pi / 3 - std::sqrt(3.0) / 2, 1e-14);
  EXPECT_EQ(circle_circle_area({0, 0}, 1, {2.1, 0}, 1), 0);
  EXPECT_NEAR(circle_circle_area({0, 0}, 3, {1, 0}, 1), pi, 1e-14);
}

TEST(PlaneRegion, AnnuliShareNothingWhereOneEndsAndTheNextBegins) {
  const PlaneRegion disc({0, 0}, 1, 0);
  const PlaneRegion ring({0, 0}, 2, 1);
  EXPECT_NEAR(disc.area_within(ring), 0, 1e-14);
  EXPECT_NEAR(ring.area_within(ring), 3 * pi, 1e-13);
  EXPECT_NEAR(ring.area_within(PlaneRegion({0, 0}, 1.5, 0.5)), (2.25 - 1) * pi, 1e-13);
  EXPECT_NEAR(ring.area_within(Rectangle{{0, 0}, {5, 5}}), 3 * pi / 4, 1e-13);
  EXPECT_NEAR(PlaneRegion(Rectangle{{0, 0}, {5, 5}}).area_within(ring), 3 * pi / 4, 1e-13);
}

}  // namespace
}  // namespace pellicle::cfd
