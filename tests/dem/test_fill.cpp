// Filling a region: every property is checked on all spheres and all pairs of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/random.hpp"
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

Real sphere_volume(Real radius) { return 4.0 / 3.0 * M_PI * radius * radius * radius; }

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

TEST(Fill, RandomReachesDenseFluidsAndSaysWhenNoMoreFit) {
  // Hard spheres jam at random at a solids fraction of 0.64; 0.68 is out of reach, 0.30, 0.5 and 0.6 are placed one by
  // one, and by moving overlaps away. A cube of 15 diameters has (14/15)^3 of its volume for the centres.
  const Box cube{{0, 0, 0}, {0.03, 0.03, 0.03}};
  const auto radii = [&](Real fraction, Real radius) {
    return std::vector<Real>(static_cast<std::size_t>(fraction * region_volume(cube) / sphere_volume(radius)),
                             radius);
  };
  for (const Real fraction : {0.30, 0.5, 0.57}) {
    const auto wanted = radii(fraction, 0.001);
    const auto centres = fill_region(cube, FillPattern::random, wanted, 1);
    ASSERT_EQ(centres.size(), wanted.size()) << fraction;
    expect_apart(centres, wanted);
    expect_inside(cube, centres, wanted);
  }
  const auto tight = radii(0.68, 0.004);
  EXPECT_LT(fill_region(cube, FillPattern::random, tight, 1).size(), tight.size());
}

TEST(Fill, DensePolydisperseMixesSizesAllOver) {
  std::vector<Real> radii(4000);
  Real volume = 0;
  for (std::size_t p = 0; p < radii.size(); ++p) {
    radii[p] = 0.0005 * (1 + static_cast<Real>(p % 101) / 100);
    volume += sphere_volume(radii[p]);
  }
  const Real side = std::cbrt(volume / 0.5);
  const Box cube{{0.1, 0.2, -0.3}, {0.1 + side, 0.2 + side, -0.3 + side}};
  const auto centres = fill_region(cube, FillPattern::random, radii, 5);
  ASSERT_EQ(centres.size(), radii.size());
  expect_apart(centres, radii);
  expect_inside(cube, centres, radii);
  // Size and place have nothing to do with each other: correlations of 4000 independent pairs scatter by 1/sqrt(4000).
  for (int a = 0; a < 3; ++a) {
    Real sum_x = 0, sum_r = 0, sum_xx = 0, sum_rr = 0, sum_xr = 0;
    for (std::size_t p = 0; p < radii.size(); ++p) {
      sum_x += centres[p][a], sum_r += radii[p];
      sum_xx += centres[p][a] * centres[p][a], sum_rr += radii[p] * radii[p],
          sum_xr += centres[p][a] * radii[p];
    }
    const Real n = static_cast<Real>(radii.size());
    const Real correlation =
        (sum_xr / n - sum_x / n * sum_r / n) /
        std::sqrt((sum_xx / n - sum_x / n * sum_x / n) * (sum_rr / n - sum_r / n * sum_r / n));
    EXPECT_LT(std::abs(correlation), 4 / std::sqrt(n)) << a;
  }
}

// The dense fill starts from a lattice, of which nothing may be left: the structure factor |sum exp(i k x)|^2/N at the
// lattice's wave number is N for a lattice, 0.4 N at least for the nearest k that fits the window; for a fluid it is
// exponentially distributed around 3 at most (hard spheres of 0.5 at the first peak), above 36 once in 160000. Spheres
// near walls stand in layers, so the window keeps four diameters away from them.
TEST(Fill, DenseRandomIsNoLattice) {
  const std::vector<Real> radii(8000, 0.0005);
  const Real side = std::cbrt(8000 * sphere_volume(0.0005) / 0.5);
  const auto centres = fill_region(Box{{0, 0, 0}, {side, side, side}}, FillPattern::random, radii, 6);
  ASSERT_EQ(centres.size(), radii.size());
  const Real low = 0.004, high = side - 0.004;
  for (int a = 0; a < 3; ++a) {
    for (int wave = 9; wave <= 15; ++wave) {  // the lattice of 20 sites in `side` has 12.2 in the window
      const Real k = 2 * M_PI * wave / (high - low);
      Real cosine = 0, sine = 0, count = 0;
      for (const Vec3& x : centres) {
        if (std::min({x.x, x.y, x.z}) < low || std::max({x.x, x.y, x.z}) > high) continue;
        cosine += std::cos(k * x[a]), sine += std::sin(k * x[a]), ++count;
      }
      ASSERT_GT(count, 1500);
      EXPECT_LT((cosine * cosine + sine * sine) / count, 36) << a << " " << wave;
    }
  }
}

/// Distance of a point from the slanted side of a cone, in the plane of axis and point: from a line through two points.
Real distance_from_slant(const ConeRegion& c, const Vec3& x) {
  const Real length = norm(c.to - c.from);
  const Real along = dot(x - c.from, (1 / length) * (c.to - c.from));
  const Real out = std::sqrt(std::max(0.0, norm_squared(x - c.from) - along * along));
  const Real dz = length, dr = c.to_radius - c.from_radius;
  return (dz * (c.from_radius - out) + dr * along) / std::sqrt(dz * dz + dr * dr);
}

TEST(Fill, ConesHoldSpheresInside) {
  for (const ConeRegion& cone : {ConeRegion{{0.01, 0.02, 0.03}, {0.03, 0.05, 0.06}, 0.004, 0.02},
                                 ConeRegion{{0, 0, 0}, {0, 0, 0.04}, 0.02, 0}}) {
    const Real length = norm(cone.to - cone.from);
    EXPECT_NEAR(region_volume(cone),
                M_PI / 3 * length *
                    (cone.from_radius * cone.from_radius + cone.from_radius * cone.to_radius +
                     cone.to_radius * cone.to_radius),
                1e-12);
    for (const auto& [pattern, fraction] : {std::pair{FillPattern::random, 0.2},
                                            {FillPattern::random, 0.45},
                                            {FillPattern::lattice, 0.2},
                                            {FillPattern::hexagonal, 0.3}}) {
      const std::vector<Real> radii(
          static_cast<std::size_t>(fraction * region_volume(cone) / sphere_volume(0.001)), 0.001);
      const auto centres = fill_region(cone, pattern, radii, 3);
      ASSERT_EQ(centres.size(), radii.size()) << static_cast<int>(pattern) << " " << fraction;
      expect_apart(centres, radii);
      for (const Vec3& x : centres) {
        ASSERT_GE(distance_from_slant(cone, x), 0.001 * (1 - tolerance));
        const Real along = dot(x - cone.from, (1 / length) * (cone.to - cone.from));
        ASSERT_GE(along, 0.001 * (1 - tolerance));
        ASSERT_LE(along, length - 0.001 * (1 - tolerance));
      }
    }
  }
}

TEST(Fill, AnnuliHoldSpheresBetweenTheCylinders) {
  const AnnulusRegion annulus{{0, 0.01, 0}, {0, 0.01, 0.03}, 0.008, 0.015};
  EXPECT_NEAR(region_volume(annulus), M_PI * 0.03 * (0.015 * 0.015 - 0.008 * 0.008), 1e-18);
  for (const auto& [pattern, fraction] : {std::pair{FillPattern::random, 0.25},
                                          {FillPattern::random, 0.5},
                                          {FillPattern::lattice, 0.3},
                                          {FillPattern::hexagonal, 0.4}}) {
    const std::vector<Real> radii(
        static_cast<std::size_t>(fraction * region_volume(annulus) / sphere_volume(0.0006)), 0.0006);
    const auto centres = fill_region(annulus, pattern, radii, 4);
    ASSERT_EQ(centres.size(), radii.size()) << static_cast<int>(pattern) << " " << fraction;
    expect_apart(centres, radii);
    for (const Vec3& x : centres) {
      const Real out = std::hypot(x.x, x.y - 0.01);
      ASSERT_GE(out, 0.0086 * (1 - tolerance));
      ASSERT_LE(out, 0.0144 * (1 + tolerance));
      ASSERT_GE(x.z, 0.0006 * (1 - tolerance));
      ASSERT_LE(x.z, 0.0294 * (1 + tolerance));
    }
  }
  // A shell just wide enough for one sphere across.
  const AnnulusRegion shell{{0, 0, 0}, {0, 0, 0.02}, 0.008, 0.0092};
  const std::vector<Real> radii(500,
                                0.0006);  // a wall area of 17.2 x 20 mm, 0.62 of the shell's middle covered
  const auto centres = fill_region(shell, FillPattern::random, radii, 4);
  ASSERT_EQ(centres.size(), radii.size());
  expect_apart(centres, radii);
}

TEST(Fill, DenseAroundWhatIsThere) {
  const Box cube{{0, 0, 0}, {0.02, 0.02, 0.02}};
  const std::vector<PlacedSphere> present{
      {{0.01, 0.01, 0.01}, 0.005}, {{0.02, 0, 0}, 0.004}, {{0.005, 0.015, 0.02}, 0.001}};
  const Real volume =
      region_volume(cube) - sphere_volume(0.005) - sphere_volume(0.004) / 8 - sphere_volume(0.001) / 2;
  const std::vector<Real> radii(static_cast<std::size_t>(0.45 * volume / sphere_volume(0.0007)), 0.0007);
  const auto centres = fill_region(cube, FillPattern::random, radii, 2, present);
  ASSERT_EQ(centres.size(), radii.size());
  expect_apart(centres, radii, present);
  expect_inside(cube, centres, radii);
}

TEST(Fill, HexagonalIsClosePacked) {
  const Box cube{{0, 0, 0}, {0.03, 0.03, 0.03}};
  const std::vector<Real> radii(6000, 0.001);
  const auto centres = fill_region(cube, FillPattern::hexagonal, radii, 1);
  expect_apart(centres, std::vector<Real>(centres.size(), 0.001));
  expect_inside(cube, centres, radii);
  // Rows of 15 and 14 by turns, 17 of 14 sqrt(3)/2 pitches, 18 layers: ends and staggered rows cost a share of about
  // one diameter in 15 per direction of pi/sqrt(18) = 0.7405.
  const Real fraction = static_cast<Real>(centres.size()) * sphere_volume(0.001) / region_volume(cube);
  EXPECT_GT(fraction, 0.7405 * std::pow(14.0 / 15, 3));
  EXPECT_LT(fraction, 0.7405);
  // Twelve neighbours at one pitch, 1.0005 diameters, and none until sqrt(2).
  int inner = 0;
  for (std::size_t a = 0; a < centres.size(); ++a) {
    bool deep = true;
    for (int axis = 0; axis < 3; ++axis) {
      deep = deep && centres[a][axis] > 0.0045 && centres[a][axis] < 0.0255;
    }
    if (!deep) continue;
    ++inner;
    int near = 0, wider = 0;
    for (std::size_t b = 0; b < centres.size(); ++b) {
      const Real distance = norm(centres[a] - centres[b]);
      if (a != b && distance < 1.01 * 0.002) ++near;
      if (distance >= 1.01 * 0.002 && distance < 1.4 * 0.002) ++wider;
    }
    ASSERT_EQ(near, 12);
    ASSERT_EQ(wider, 0);
  }
  EXPECT_GT(inner, 500);
}

TEST(Fill, BringInsideMovesOnlyWhatIsOutside) {
  const std::vector<FillRegion> regions{box, CylinderRegion{{0.01, 0.02, 0.03}, {0.03, 0.05, 0.06}, 0.012},
                                        ConeRegion{{0, 0, 0}, {0, 0.03, 0}, 0.002, 0.02},
                                        AnnulusRegion{{0, 0, 0}, {0.03, 0, 0}, 0.005, 0.012}};
  for (const FillRegion& region : regions) {
    const Room room(region);
    int outside = 0;
    for (int draw = 0; draw < 2000; ++draw) {
      const Vec3 share = core::random_uniform3(5, core::Purpose::test, 0, draw);
      const Vec3 start{-0.02 + 0.09 * share.x, -0.02 + 0.09 * share.y, -0.02 + 0.2 * share.z};
      Vec3 moved = start;
      ASSERT_TRUE(room.bring_inside(moved, 0.0015));
      ASSERT_TRUE(room.holds(moved, 0.0015));
      if (room.holds(start, 0.0015)) {
        ASSERT_LT(norm(moved - start), 1e-9 * 0.0015 * 2);
      } else {
        ++outside;
      }
    }
    EXPECT_GT(outside, 100);
    Vec3 anywhere{};
    EXPECT_FALSE(room.bring_inside(anywhere, 0.05));
  }
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
  for (const FillPattern pattern : {FillPattern::lattice, FillPattern::random, FillPattern::hexagonal}) {
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
