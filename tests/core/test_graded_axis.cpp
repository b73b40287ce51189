// Cells of an axis that grow away from zones.
#include "core/graded_axis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace pellicle {
namespace {

std::vector<Real> widths(const std::vector<Real>& faces) {
  std::vector<Real> w;
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) w.push_back(faces[i + 1] - faces[i]);
  return w;
}

Real largest_ratio(const std::vector<Real>& w, bool periodic) {
  Real ratio = 1;
  for (std::size_t i = 0; i + 1 < w.size(); ++i) ratio = std::max({ratio, w[i] / w[i + 1], w[i + 1] / w[i]});
  if (periodic) ratio = std::max({ratio, w.front() / w.back(), w.back() / w.front()});
  return ratio;
}

bool has_face(const std::vector<Real>& faces, Real at) {
  return std::find(faces.begin(), faces.end(), at) != faces.end();
}

/// Cells of a continuous grid, the integral of 1 / h: h grows with distance from zones with slope
/// 2 (growth - 1) / (growth + 1), as geometric cells do.
Real ideal_count(Real min, Real max, Real size, Real growth, const std::vector<SizeZone>& zones,
                 bool periodic) {
  const int samples = 200'000;
  const Real slope = 2 * (growth - 1) / (growth + 1);
  Real count = 0;
  for (int i = 0; i < samples; ++i) {
    const Real x = min + (max - min) * (i + 0.5) / samples;
    Real h = size;
    for (const SizeZone& zone : zones) {
      for (const Real shift : {-1.0, 0.0, 1.0}) {
        if (shift != 0 && !periodic) continue;
        const Real y = x + shift * (max - min);
        h = std::min(h, zone.size + slope * std::max({Real{0}, zone.min - y, y - zone.max}));
      }
    }
    count += (max - min) / samples / h;
  }
  return count;
}

void expect_good(Real min, Real max, Real size, Real growth, const std::vector<SizeZone>& zones,
                 bool periodic) {
  const std::vector<Real> faces = make_graded_faces(min, max, size, growth, zones, periodic);
  const std::vector<Real> w = widths(faces);
  EXPECT_EQ(faces.front(), min);
  EXPECT_EQ(faces.back(), max);
  // Faces are sums of sizes: round-off.
  EXPECT_LE(largest_ratio(w, periodic), growth * (1 + 1e-9));
  EXPECT_GT(*std::min_element(w.begin(), w.end()), 0);
  for (std::size_t i = 0; i < w.size(); ++i) {
    EXPECT_LE(w[i], size * (1 + 1e-8));
    for (const SizeZone& zone : zones) {
      const Real middle = 0.5 * (faces[i] + faces[i + 1]);
      if (middle < zone.min || middle > zone.max) continue;
      EXPECT_LE(w[i], zone.size * (1 + 1e-8)) << "cell " << i;
    }
  }
  for (const SizeZone& zone : zones) {
    for (const Real end : {zone.min, zone.max}) {
      if (end <= min || end >= max) continue;
      EXPECT_TRUE(has_face(faces, end)) << end;
    }
  }
}

TEST(GradedAxis, EqualCellsWithoutZones) {
  const auto faces = make_graded_faces(-0.1, 0.2, 0.01, 1.2, {}, false);
  ASSERT_EQ(faces.size(), 31U);
  for (const Real w : widths(faces)) EXPECT_NEAR(w, 0.01, 1e-15);
  EXPECT_EQ(make_graded_faces(0, 1, 0.3, 1.2, {}, true).size(), 5U);  // 0.25 <= 0.3
  EXPECT_EQ(make_graded_faces(0, 1, 3, 1.2, {}, false).size(), 2U);
}

TEST(GradedAxis, CellsOfAZoneAreEqualAndGrowAway) {
  const std::vector<SizeZone> zones{{0.1, 0.12, 0.001}};
  const auto faces = make_graded_faces(0, 0.25, 0.006, 1.15, zones, false);
  expect_good(0, 0.25, 0.006, 1.15, zones, false);
  const auto w = widths(faces);
  const auto first = static_cast<std::size_t>(std::find(faces.begin(), faces.end(), 0.1) - faces.begin());
  for (std::size_t i = first; i < first + 20; ++i) EXPECT_NEAR(w[i], 0.001, 1e-12);
  EXPECT_EQ(faces[first + 20], 0.12);
  // Away from the zone no cell is smaller than the one before it.
  for (std::size_t i = first + 20; i + 1 < w.size(); ++i) EXPECT_GE(w[i + 1], w[i] * (1 - 1e-9));
  for (std::size_t i = first; i > 0; --i) EXPECT_GE(w[i - 1], w[i] * (1 - 1e-9));
  // ln 6 / ln 1.15 = 12.8 cells from 1 to 6 mm over sizes that sum to (6 - 1) / 0.15 = 33 mm: then cells of full size.
  EXPECT_GT(w.back(), 0.0055);
  EXPECT_GT(w.front(), 0.0055);
}

TEST(GradedAxis, FewCellsMoreThanAContinuousGrid) {
  struct Case {
    Real size, growth;
    std::vector<SizeZone> zones;
    bool periodic;
  };
  const std::vector<Case> cases{{0.006, 1.15, {{0.1, 0.12, 0.001}}, false},
                                {0.006, 1.15, {{0.1, 0.12, 0.001}}, true},
                                {0.02, 1.3, {{0, 0.01, 0.0005}, {0.15, 0.16, 0.002}}, false},
                                {0.01, 1.05, {{0.05, 0.2, 0.002}, {0.1, 0.11, 0.0005}}, false},
                                {0.01, 1.1, {{0.24, 0.25, 0.001}}, true}};
  for (const Case& c : cases) {
    expect_good(0, 0.25, c.size, c.growth, c.zones, c.periodic);
    const auto count =
        static_cast<Real>(make_graded_faces(0, 0.25, c.size, c.growth, c.zones, c.periodic).size() - 1);
    const Real ideal = ideal_count(0, 0.25, c.size, c.growth, c.zones, c.periodic);
    EXPECT_GE(count, ideal - 1);
    // Whole numbers of cells between cuts, of which a zone has two, and half a step of growth lost at each.
    EXPECT_LE(count, 1.03 * ideal + 2 + 2 * static_cast<Real>(c.zones.size())) << ideal;
  }
}

TEST(GradedAxis, ZonesThatTouchOverlapOrLieOutside) {
  expect_good(0, 1, 0.1, 1.2, {{0.2, 0.4, 0.02}, {0.4, 0.5, 0.05}}, false);
  expect_good(0, 1, 0.1, 1.2, {{0.2, 0.4, 0.02}, {0.3, 0.7, 0.01}}, true);
  expect_good(0, 1, 0.1, 1.2, {{-1, 0.1, 0.02}, {0.9, 3, 0.05}}, false);
  expect_good(0, 1, 0.1, 1.2, {{-1, 3, 0.03}}, true);
  EXPECT_EQ(make_graded_faces(0, 1, 0.1, 1.2, {{2, 3, 0.01}}, false).size(), 11U);
  // Cuts close to each other, and apart by a round-off: a cell as thin as the gap, or none.
  expect_good(0, 1, 0.1, 1.2, {{0.2, 0.4, 0.02}, {0.401, 0.5, 0.02}}, false);
  const auto faces = make_graded_faces(0, 1, 0.1, 1.2, {{0.2, 0.4, 0.02}, {0.4 + 1e-13, 0.5, 0.02}}, false);
  const auto w = widths(faces);
  EXPECT_GT(*std::min_element(w.begin(), w.end()), 0.019);
}

TEST(GradedAxis, RandomZones) {
  std::mt19937 numbers(7);
  const auto draw = [&](Real low, Real high) {
    return low + (high - low) * static_cast<Real>(numbers()) / static_cast<Real>(std::mt19937::max());
  };
  for (int round = 0; round < 500; ++round) {
    std::vector<SizeZone> zones;
    const auto count = numbers() % 4;
    for (unsigned z = 0; z < count; ++z) {
      const Real a = draw(-0.2, 1.1);
      zones.push_back({a, a + std::exp(draw(-6, -0.5)), std::exp(draw(-6, -1))});
    }
    expect_good(0, 1, draw(0.02, 0.5), draw(1.03, 2), zones, numbers() % 2 == 0);
    if (HasFailure()) {
      ADD_FAILURE() << "round " << round;
      return;
    }
  }
}

TEST(GradedAxis, RefusesWhatMakesNoSense) {
  EXPECT_THROW(make_graded_faces(0, 1, 0.1, 1, {}, false), std::invalid_argument);
  EXPECT_THROW(make_graded_faces(0, 0, 0.1, 1.1, {}, false), std::invalid_argument);
  EXPECT_THROW(make_graded_faces(0, 1, 0, 1.1, {}, false), std::invalid_argument);
  EXPECT_THROW(make_graded_faces(0, 1, 0.1, 1.1, {{0, 1, 0}}, false), std::invalid_argument);
  EXPECT_THROW(make_graded_faces(0, 1, 1e-12, 1.1, {}, false), std::length_error);
  EXPECT_THROW(make_graded_faces(0, 1, 0.1, 1.1, {{0.5, 0.6, 1e-5}}, false, 1000), std::length_error);
}

}  // namespace
}  // namespace pellicle
