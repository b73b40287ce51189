// What comes out of a nozzle: how much by when, in which directions, of which sizes. Statistical bounds are those that a
// correct injector would break once in more than a thousand seeds; the seed is fixed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "spray/injector.hpp"

namespace pellicle::spray {
namespace {

Nozzle water_nozzle() {
  Nozzle nozzle;
  nozzle.name = "gun";
  nozzle.position = {0.1, 0.2, 0.3};
  nozzle.axis = {0.6, 0, 0.8};
  nozzle.cone_angle = 30 * std::numbers::pi / 180;
  nozzle.radius = 1e-3;
  nozzle.speed = 20;
  nozzle.mass_rate = 1e-4;
  nozzle.diameter = Real(30e-6);
  nozzle.droplets_per_parcel = 10;
  return nozzle;
}

/// All parcels of a nozzle in one go, `count` of them.
struct Burst {
  Parcels parcels;
  std::vector<ParcelState> state;
  std::vector<ParcelEnd> end;
  Burst(const Nozzle& nozzle, Index count, std::uint64_t seed = 7) {
    Injector injector(nozzle, 0, seed);
    reserve(parcels, count);
    injector.add(0, (count + 0.25) * injector.parcel_mass() / nozzle.mass_rate, parcels, {});
    EXPECT_EQ(parcels.count, count);
    const auto copy = [&](const auto& array, auto& to) {
      const auto host = Kokkos::create_mirror_view_and_copy(
          Kokkos::HostSpace{}, Kokkos::subview(array, std::pair<Index, Index>(0, parcels.count)));
      to.assign(host.data(), host.data() + parcels.count);
    };
    copy(parcels.state, state);
    copy(parcels.end, end);
  }
};

/// Largest distance between the distribution of some numbers and the uniform one between 0 and 1; beyond 1.95/√n once in
/// a thousand (Kolmogorov & Smirnov).
Real distance_from_uniform(std::vector<Real> numbers) {
  std::sort(numbers.begin(), numbers.end());
  Real largest = 0;
  const auto n = static_cast<Real>(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto k = static_cast<Real>(i);
    largest = std::max({largest, (k + 1) / n - numbers[i], numbers[i] - k / n});
  }
  return largest;
}

TEST(Injector, MassIsRateTimesTimeToWithinHalfAParcelWhateverTheSteps) {
  Nozzle nozzle = water_nozzle();
  nozzle.from = 0.01;
  nozzle.to = 0.13;
  // pi/6 (30 um)^3 * 1000 * 10 = 1.413717e-10 kg.
  const Injector once(nozzle, 0, 1);
  EXPECT_NEAR(once.parcel_mass(), 1.41371669e-10, 1e-18);
  for (const Real step : {1e-4, 3.7e-5, 1e-2}) {
    Injector injector(nozzle, 0, 1);
    Parcels parcels;
    Real time = 0;
    while (time < 0.2) {
      reserve(parcels, static_cast<Index>(injector.due(time + step)));
      injector.add(time, time + step, parcels, {});
      time += step;
      const Real open = std::clamp(time, 0.01, 0.13) - 0.01;
      const Real injected = static_cast<Real>(injector.injected()) * injector.parcel_mass();
      ASSERT_NEAR(injected, 1e-4 * open, 0.5000001 * injector.parcel_mass());
    }
    EXPECT_EQ(injector.injected(), parcels.count);
    EXPECT_EQ(injector.injected(), once.due(1));
  }
}

TEST(Injector, AParcelIsTheSameWhicheverStepItIsBornIn) {
  const Nozzle nozzle = water_nozzle();
  Injector whole(nozzle, 3, 5);
  Injector parts(nozzle, 3, 5);
  Parcels a;
  Parcels b;
  reserve(a, 1000);
  reserve(b, 1000);
  const Real end = 1e-3;
  whole.add(0, end, a, {});
  for (int k = 0; k < 10; ++k) parts.add(k * end / 10, (k + 1) * end / 10, b, {});
  ASSERT_EQ(a.count, b.count);
  ASSERT_GT(a.count, 500);
  for (Index i = 0; i < a.count; ++i) {
    ASSERT_TRUE(a.state(i).velocity == b.state(i).velocity && a.state(i).position == b.state(i).position);
    ASSERT_EQ(a.name(i).number, b.name(i).number);
    const Real step = end / 10;
    const Real born = b.end(i).time + std::floor(a.end(i).time / step * (1 + 1e-12)) * step;
    ASSERT_NEAR(born, a.end(i).time, 1e-15);
  }
  Injector other(nozzle, 4, 5);  // another nozzle draws other numbers
  Parcels c;
  reserve(c, 1000);
  other.add(0, end, c, {});
  EXPECT_FALSE(a.state(0).velocity == c.state(0).velocity);
}

TEST(Injector, FullConeIsUniformOverTheSolidAngleAndTheOrifice) {
  const Nozzle nozzle = water_nozzle();
  const Index count = 40000;
  const Burst burst(nozzle, count);
  const Real bound = 1.95 / std::sqrt(static_cast<Real>(count));
  const Vec3 a = perpendicular_to(nozzle.axis);
  const Vec3 b = cross(nozzle.axis, a);
  std::vector<Real> polar, azimuth, ring, round;
  Real largest = 0;
  for (const ParcelState& p : burst.state) {
    EXPECT_NEAR(norm(p.velocity), 20, 1e-12);
    const Real cosine = dot(p.velocity, nozzle.axis) / 20;
    largest = std::max(largest, std::acos(std::min(cosine, 1.0)));
    polar.push_back((1 - cosine) / (1 - std::cos(0.5 * nozzle.cone_angle)));
    azimuth.push_back(0.5 + std::atan2(dot(p.velocity, b), dot(p.velocity, a)) / (2 * std::numbers::pi));
    const Vec3 offset = p.position - nozzle.position;
    EXPECT_NEAR(dot(offset, nozzle.axis), 0, 1e-16);
    ring.push_back(norm_squared(offset) / (nozzle.radius * nozzle.radius));
    round.push_back(0.5 + std::atan2(dot(offset, b), dot(offset, a)) / (2 * std::numbers::pi));
  }
  // The cone angle as measured: the outermost of 40000 droplets is within 1 % of it (that none is, is e^-400).
  EXPECT_LE(2 * largest, nozzle.cone_angle * (1 + 1e-12));
  EXPECT_GT(2 * largest, 0.99 * nozzle.cone_angle);
  EXPECT_LT(distance_from_uniform(polar), bound);
  EXPECT_LT(distance_from_uniform(azimuth), bound);
  EXPECT_LT(distance_from_uniform(ring), bound);
  EXPECT_LT(distance_from_uniform(round), bound);
}

TEST(Injector, HollowConeLeavesItsInsideFreeAndDivergesFromTheRim) {
  Nozzle nozzle = water_nozzle();
  nozzle.pattern = SprayPattern::hollow;
  nozzle.cone_angle = 60 * std::numbers::pi / 180;
  nozzle.inner_cone_angle = 48 * std::numbers::pi / 180;
  const Index count = 20000;
  const Burst burst(nozzle, count);
  std::vector<Real> polar;
  for (const ParcelState& p : burst.state) {
    const Real cosine = dot(p.velocity, nozzle.axis) / 20;
    polar.push_back((std::cos(24 * std::numbers::pi / 180) - cosine) /
                    (std::cos(24 * std::numbers::pi / 180) - std::cos(30 * std::numbers::pi / 180)));
    ASSERT_GT(polar.back(), -1e-12);
    ASSERT_LT(polar.back(), 1 + 1e-12);
    const Vec3 offset = p.position - nozzle.position;
    ASSERT_NEAR(norm(offset), nozzle.radius, 1e-15);
    const Vec3 across = p.velocity - (20 * cosine) * nozzle.axis;
    ASSERT_NEAR(dot(across, offset), norm(across) * norm(offset), 1e-14);
  }
  EXPECT_LT(distance_from_uniform(polar), 1.95 / std::sqrt(static_cast<Real>(count)));
}

/// Share of droplets, by number, that are finer than d.
Real finer(const std::vector<ParcelState>& parcels, Real d) {
  Real below = 0;
  Real all = 0;
  for (const ParcelState& p : parcels) {
    all += p.droplets;
    if (p.diameter <= d) below += p.droplets;
  }
  return below / all;
}

TEST(Injector, SizesAreSpreadByNumberAsTheDistributionSays) {
  Nozzle nozzle = water_nozzle();
  const Index count = 100000;
  // Parcels of equal mass: shares by number scatter more than √(p (1 − p)/n) where small droplets weigh much. 0.01 is
  // over three standard deviations of each (between 8 and 60 um a weight varies by 60/8 cubed at most, but rarely).
  const Real bound = 0.01;
  {
    const dem::NormalSizes sizes{30e-6, 8e-6, 10e-6, 50e-6};
    nozzle.diameter = dem::SizeDistribution(sizes);
    const Burst burst(nozzle, count);
    const auto normal = [](Real d) { return 0.5 * std::erfc(-(d - 30e-6) / 8e-6 / std::numbers::sqrt2); };
    for (const Real d : {20e-6, 26e-6, 30e-6, 34e-6, 40e-6}) {
      const Real expected = (normal(d) - normal(10e-6)) / (normal(50e-6) - normal(10e-6));
      EXPECT_NEAR(finer(burst.state, d), expected, bound) << d;
    }
    const Real parcel_mass = Injector(nozzle, 0, 1).parcel_mass();
    for (const ParcelState& p : burst.state) {
      ASSERT_NEAR(p.droplets * std::numbers::pi / 6 * 1000 * std::pow(p.diameter, 3), parcel_mass, 1e-22);
    }
  }
  {
    nozzle.diameter = dem::SizeDistribution(dem::UniformSizes{20e-6, 40e-6});
    const Burst burst(nozzle, count);
    for (const Real d : {22e-6, 25e-6, 30e-6, 37e-6}) {
      EXPECT_NEAR(finer(burst.state, d), (d - 20e-6) / 20e-6, bound) << d;
    }
  }
  {
    // By mass: the share of mass finer than d, without any weights, is the share of parcels.
    nozzle.diameter = dem::SizeDistribution(dem::RosinRammlerSizes{35e-6, 3, 10e-6, 60e-6});
    const Burst burst(nozzle, count);
    const auto rosin = [](Real d) { return 1 - std::exp(-std::pow(d / 35e-6, 3)); };
    for (const Real d : {20e-6, 30e-6, 40e-6}) {
      const auto below = std::count_if(burst.state.begin(), burst.state.end(),
                                       [d](const ParcelState& p) { return p.diameter <= d; });
      const Real expected = (rosin(d) - rosin(10e-6)) / (rosin(60e-6) - rosin(10e-6));
      // Three standard deviations of a share are 0.005 at most.
      EXPECT_NEAR(static_cast<Real>(below) / count, expected, 0.005) << d;
    }
  }
  {
    nozzle.diameter = dem::SizeDistribution(dem::TableSizes{{20e-6, 40e-6}, {3, 1}, {}, dem::ShareOf::count});
    const Burst burst(nozzle, count);
    EXPECT_NEAR(finer(burst.state, 21e-6), 0.75, bound);
    // 3 : 1 by number is 3 : 8 by mass.
    const auto below = std::count_if(burst.state.begin(), burst.state.end(),
                                     [](const ParcelState& p) { return p.diameter < 21e-6; });
    EXPECT_NEAR(static_cast<Real>(below) / count, 3.0 / 11, 0.005);
  }
}

}  // namespace
}  // namespace pellicle::spray
