// Filling a region: every property is checked on all spheres and all pairs of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dem/fill.hpp"

namespace pellicle::dem {
namespace {

// "Wholly inside" and "without overlap" hold to this share of a radius.
constexpr Real tolerance = 2e-9;

void expect_apart(const std::vector<Vec3>& centres, const std::vector<Real>& radii,
                  const std::vector<PlacedSphere>& present = {}) {
  for (std::size_t a = 0; a < centres.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      ASSERT_GE(norm(centres[a] - centres[b]), (radii[a] + radii[b]) * (1 - tolerance)) << a << " and " << b;
    }
    for (const PlacedSphere& s : present) {
      ASSERT_GE(norm(centres[a] - s.position), (radii[a] + s.radius) * (1 - tolerance)) << a;
    }
  }
}

void expect_inside(const Box& box, const std::vector<Vec3>& centres, const std::vector<Real>& radii) {
  for (std::size_t p = 0; p < centres.size(); ++p) {
    const Real margin = radii[p] * (1 - tolerance);
    for (int a = 0; a < 3; ++a) {
      ASSERT_GE(centres[p][a], box.min[a] + margin) << p;
      ASSERT_LE(centres[p][a], box.max[a] - margin) << p;
    }
  }
}

void expect_inside(const CylinderRegion& c, const std::vector<Vec3>& centres,
                   const std::vector<Real>& radii) {
  const Vec3 axis = (1 / norm(c.to - c.from)) * (c.to - c.from);
  for (std::size_t p = 0; p < centres.size(); ++p) {
    const Real margin = radii[p] * (1 - tolerance);
    const Vec3 x = centres[p] - c.from;
    ASSERT_GE(dot(x, axis), margin) << p;
    ASSERT_LE(dot(x, axis), norm(c.to - c.from) - margin) << p;
    ASSERT_LE(norm(cross(x, axis)), c.radius - margin) << p;
  }
}

const Box box{{-0.01, 0.02, 0.1}, {0.03, 0.05, 0.16}};

TEST(Fill, RandomInABoxNeitherOverlapsNorSticksOut) {
  // 645 spheres of 2 mm radius: a solids fraction of 0.30.
  const std::vector<Real> radii(645, 0.002);
  const auto centres = fill_region(box, FillPattern::random, radii, 7);
  ASSERT_EQ(centres.size(), radii.size());
  expect_apart(centres, radii);
  expect_inside(box, centres, radii);
  // They are everywhere: the mean is the middle of the box within 4 standard errors of a uniform spread, L/√(12 n).
  Vec3 mean{};
  for (const Vec3& x : centres) mean += (1.0 / 645) * x;
  for (int a = 0; a < 3; ++a) {
    const Real length = box.max[a] - box.min[a];
    EXPECT_NEAR(mean[a], 0.5 * (box.min[a] + box.max[a]), 4 * length / std::sqrt(12.0 * 645));
  }
}

TEST(Fill, RandomPolydisperseKeepsTheOrderOfTheRadii) {
  std::vector<Real> radii(600);
  for (std::size_t p = 0; p < 600; ++p) radii[p] = 0.0005 + 0.0002 * static_cast<Real>(p % 11);
  const auto centres = fill_region(box, FillPattern::random, radii, 8);
  ASSERT_EQ(centres.size(), radii.size());
  expect_apart(centres, radii);  // radius p belongs to centre p, else some would overlap or stick out
  expect_inside(box, centres, radii);
}

TEST(Fill, RandomInATiltedCylinderAroundWhatIsThere) {
  const CylinderRegion cylinder{{0.01, 0.02, 0.03}, {0.03, 0.05, 0.06}, 0.012};
  const std::vector<Real> radii(250, 0.0015);
  const std::vector<PlacedSphere> present{{{0.02, 0.035, 0.045}, 0.006}, {{0.01, 0.02, 0.03}, 0.004}};
  const auto centres = fill_region(cylinder, FillPattern::random, radii, 9, present);
  ASSERT_EQ(centres.size(), radii.size());
  expect_apart(centres, radii, present);
  expect_inside(cylinder, centres, radii);
}

TEST(Fill, RandomReachesThreeTenthsAndSaysWhenNoMoreFit) {
  // Random sequential addition of spheres jams at a solids fraction of 0.38 in unbounded space (Torquato, Random
  // Heterogeneous Materials, 2002); a cube of 15 diameters has (14/15)^3 of its volume for the centres.
  const Box cube{{0, 0, 0}, {0.03, 0.03, 0.03}};
  const Real radius = 0.001;
  const Real sphere = 4.0 / 3.0 * M_PI * radius * radius * radius;
  const auto fair = static_cast<std::size_t>(0.30 * region_volume(cube) / sphere);
  EXPECT_EQ(fill_region(cube, FillPattern::random, std::vector<Real>(fair, radius), 1).size(), fair);
  const auto half = static_cast<std::size_t>(0.5 * region_volume(cube) / sphere);
  const std::size_t fit = fill_region(cube, FillPattern::random, std::vector<Real>(half, radius), 1).size();
  EXPECT_GE(fit, fair);
  EXPECT_LT(fit, half);
}

TEST(Fill, DependsOnTheSeedAlone) {
  const std::vector<Real> radii(200, 0.002);
  const auto once = fill_region(box, FillPattern::random, radii, 3);
  const auto again = fill_region(box, FillPattern::random, radii, 3);
  const auto other = fill_region(box, FillPattern::random, radii, 4);
  EXPECT_EQ(once, again);
  EXPECT_NE(once, other);
}

TEST(Fill, LatticeStandsOnTheFloorInFullLayers) {
  // 4 x 3 x 6 cm at a pitch of 4.002 mm: 9 x 7 x 14 (room for centres 36, 26, 56 mm).
  std::vector<Real> radii(9 * 7 * 14 + 5, 0.002);
  const auto all = fill_region(box, FillPattern::lattice, radii, 1);
  EXPECT_EQ(all.size(), static_cast<std::size_t>(9 * 7 * 14));
  expect_apart(all, radii);
  expect_inside(box, all, radii);
  radii.resize(100);
  const auto some = fill_region(box, FillPattern::lattice, radii, 2);
  ASSERT_EQ(some.size(), 100U);
  const auto layer = [](const Vec3& x) { return std::lround((x.z - box.min.z - 0.002) / 0.004002); };
  for (std::size_t p = 0; p < some.size(); ++p) EXPECT_EQ(layer(some[p]), static_cast<long>(p / 63));
  const Real lowest = std::min_element(some.begin(), some.end(), [](auto a, auto b) { return a.z < b.z; })->z;
  EXPECT_NEAR(lowest, box.min.z + 0.002, 0.002 * 1e-3) << "nearly on the floor";
  // Centred between the sides.
  EXPECT_NEAR(0.5 * (some[0].x + some[8].x), 0.01, 1e-12);
  EXPECT_NEAR(0.5 * (some[0].y + some[62].y), 0.035, 1e-12);
}

TEST(Fill, LatticeInACylinderAndAroundWhatIsThere) {
  const CylinderRegion cylinder{{0.05, 0.05, 0}, {0.05, 0.05, 0.05}, 0.02};
  const std::vector<Real> radii(3000, 0.0015);
  const std::vector<PlacedSphere> present{{{0.05, 0.05, 0.02}, 0.008}};
  const auto centres = fill_region(cylinder, FillPattern::lattice, radii, 1, present);
  // As many as the cylinder less the sphere holds on a cubic lattice, roughly: half the volume is solids.
  const Real volume = region_volume(cylinder) - 4.0 / 3.0 * M_PI * std::pow(0.008, 3);
  const Real fraction = static_cast<Real>(centres.size()) * 4.0 / 3.0 * M_PI * std::pow(0.0015, 3) / volume;
  EXPECT_GT(fraction, 0.35);
  EXPECT_LT(fraction, M_PI / 6);
  expect_apart(centres, radii, present);
  expect_inside(cylinder, centres, radii);
}

TEST(Fill, ASlotOfOneDiameterHoldsALayer) {
  // Wherever the slot stands: 0.103 - 0.1 is a little less than 0.003 in binary.
  for (const Real y : {0.0, 0.1, 0.7, -0.3, 1.1}) {
    const Box slot{{0, y, 0}, {0.03, y + 0.003, 0.03}};
    const std::vector<Real> radii(40, 0.0015);
    EXPECT_EQ(fill_region(slot, FillPattern::lattice, radii, 1).size(), 40U) << y;
    EXPECT_EQ(fill_region(slot, FillPattern::random, radii, 1).size(), 40U) << y;
  }
}

TEST(Fill, WhatCannotFitDoesNot) {
  const Box flat{{0, 0, 0}, {0.03, 0.0029, 0.03}};
  for (const FillPattern pattern : {FillPattern::lattice, FillPattern::random}) {
    EXPECT_TRUE(fill_region(flat, pattern, {0.0015}, 1).empty());
    EXPECT_TRUE(fill_region(CylinderRegion{{0, 0, 0}, {0, 0, 1}, 0.0014}, pattern, {0.0015}, 1).empty());
    EXPECT_TRUE(fill_region(flat, pattern, {}, 1).empty());
  }
}

TEST(Fill, RegionVolumes) {
  EXPECT_NEAR(region_volume(box), 0.04 * 0.03 * 0.06, 1e-19);
  // |axis| = 3 by 1, 2, 2.
  EXPECT_NEAR(region_volume(CylinderRegion{{1, 1, 1}, {2, 3, 3}, 0.5}), 0.75 * M_PI, 1e-14);
}

}  // namespace
}  // namespace pellicle::dem
