// Drag of droplets: against closed forms, published values of the drag law, and a fine integration.
#include <gtest/gtest.h>

#include <cmath>

#include "spray/parcel_motion_laws.hpp"

namespace pellicle::spray {
namespace {

constexpr Real density = 1000;
constexpr DragGas air{1.2, 1.8e-5};

TEST(ParcelMotionLaws, DragOverStokes) {
  // 1 + 0.15 Re^0.687 by hand: 10^0.687 = 4.864072, 100^0.687 = 23.6592.
  EXPECT_NEAR(drag_over_stokes(1), 1.15, 1e-15);
  EXPECT_NEAR(drag_over_stokes(10), 1.7296108, 1e-6);
  EXPECT_NEAR(drag_over_stokes(100), 4.548880, 1e-5);
  // Beyond 1000 the drag coefficient, 24/Re times this, is 0.44.
  EXPECT_NEAR(24 / 5000.0 * drag_over_stokes(5000), 0.44, 1e-15);
}

TEST(ParcelMotionLaws, RelaxesAsTheExponentialWhereStokesHolds) {
  // No slip in the Reynolds number: the rate is Stokes's. 30 um: rho d^2 / (18 mu) = 2.7778 ms.
  const Real rate = relaxation_rate(air, density, 30e-6, 0);
  EXPECT_NEAR(1 / rate, 9e-7 / 3.24e-4, 1e-15);
  const Vec3 gas{3, -1, 10};
  Vec3 velocity{-2, 4, 0};
  Vec3 place{0, 0, 0};
  const Vec3 slip = velocity - gas;
  const int steps = 700;
  const Real dt = 1e-5;
  for (int k = 0; k < steps; ++k) {
    const DropletStep step = move_droplet(velocity, gas, rate, {0, 0, 0}, dt);
    velocity = step.velocity;
    place += step.path;
  }
  const Real t = steps * dt;
  const Vec3 expected = gas + std::exp(-rate * t) * slip;
  const Vec3 expected_place = t * gas + ((1 - std::exp(-rate * t)) / rate) * slip;
  EXPECT_LT(norm(velocity - expected), 1e-12);  // 700 roundings of numbers up to 10
  EXPECT_LT(norm(place - expected_place), 1e-14);
}

TEST(ParcelMotionLaws, AStepMayBeFarLongerThanTheRelaxation) {
  // A droplet of 5 um, 0.077 ms, in one step of 10 ms: it has the gas's velocity, less what it falls.
  const Real rate = relaxation_rate(air, density, 5e-6, 0);
  const Vec3 gravity{0, 0, -9.81};
  const DropletStep step = move_droplet({50, 0, 0}, {0, 0, 2}, rate, gravity, 0.01);
  EXPECT_NEAR(step.velocity.x, 0, 1e-12);
  EXPECT_NEAR(step.velocity.z, 2 - 9.81 / rate, 1e-12);
  EXPECT_NEAR(step.path.x, 50 / rate, 1e-12);
}

TEST(ParcelMotionLaws, SeriesAndFormulaAgreeWhereTheyMeet) {
  for (const Real x : {1e-3 * (1 - 1e-12), 1e-3 * (1 + 1e-12)}) {
    const DropletStep step = move_droplet({1, 0, 0}, {0, 0, 0}, x, {0, 0, 0}, 1);
    EXPECT_NEAR(step.velocity.x, std::exp(-x), 1e-15);
    // 1 - x/2 + x^2/6 - x^3/24 + ...: what is left out is below 1e-16; x - 1 + e^-x keeps 13 digits of 1e-3.
    EXPECT_NEAR(step.path.x, 1 - x / 2 + x * x / 6 - x * x * x / 24, 1e-12);
  }
}

TEST(ParcelMotionLaws, WithoutGasADropletFallsAsAStone) {
  EXPECT_EQ(relaxation_rate({}, density, 30e-6, 50), 0);
  const DropletStep step = move_droplet({1, 0, 2}, {0, 0, 0}, 0, {0, 0, -10}, 0.5);
  EXPECT_NEAR(step.velocity.z, -3, 1e-15);
  EXPECT_NEAR(step.path.x, 0.5, 1e-15);
  EXPECT_NEAR(step.path.z, -0.25, 1e-15);
}

/// A droplet from rest in still or moving air over many steps.
Vec3 fly(Real diameter, Vec3 velocity, const Vec3& gas, const Vec3& gravity, Real duration, int steps) {
  for (int k = 0; k < steps; ++k) {
    const Real rate = relaxation_rate(air, density, diameter, norm(gas - velocity));
    velocity = move_droplet(velocity, gas, rate, gravity, duration / steps).velocity;
  }
  return velocity;
}

TEST(ParcelMotionLaws, TerminalSpeedOfSchillerAndNaumann) {
  // 18 mu w (1 + 0.15 Re^0.687) / (rho d^2) = g: for 100 um, w = 0.24777 m/s at Re 1.652 (solved apart, by bisection).
  const Real d = 1e-4;
  Real low = 0;
  Real high = 1;
  for (int i = 0; i < 100; ++i) {
    const Real w = 0.5 * (low + high);
    const Real reynolds = 1.2 * d * w / 1.8e-5;
    (18 * 1.8e-5 * w * (1 + 0.15 * std::pow(reynolds, 0.687)) < 1000 * d * d * 9.81 ? low : high) = w;
  }
  EXPECT_NEAR(low, 0.248, 0.002);
  const Vec3 end = fly(d, {0, 0, 0}, {0, 0, 0}, {0, 0, -9.81}, 1, 1000);
  EXPECT_NEAR(end.z, -low, 1e-12);
}

TEST(ParcelMotionLaws, DragThatFollowsTheSlipConvergesAtFirstOrder) {
  // 40 um droplet thrown at 50 m/s into still air for 2 ms: the coefficient is that at the beginning of each step.
  const auto speed = [](int steps) { return fly(40e-6, {50, 0, 0}, {0, 0, 0}, {0, 0, 0}, 2e-3, steps).x; };
  const Real fine = speed(1 << 18);
  const Real error = std::abs(speed(200) - fine);  // steps of 1e-5 s
  EXPECT_LT(error, 0.01 * fine);
  EXPECT_NEAR(std::abs(speed(400) - fine) / error, 0.5, 0.02);
}

}  // namespace
}  // namespace pellicle::spray
