#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/running_moments.hpp"

using pellicle::Real;
using pellicle::core::RunningMoments;

namespace {

struct TwoPass {
  long double mean = 0, deviation = 0;
};

/// Mean first, then the deviations from it, in long double.
TwoPass two_pass(const std::vector<Real>& values) {
  const auto count = static_cast<long double>(values.size());
  long double sum = 0, squares = 0;
  for (const Real v : values) sum += v;
  for (const Real v : values) squares += (v - sum / count) * (v - sum / count);
  return {sum / count, std::sqrt(squares / count)};
}

RunningMoments moments_of(const std::vector<Real>& values) {
  RunningMoments moments;
  for (const Real v : values) moments.add(v);
  return moments;
}

/// a + b sin(phase) at phases that are no equal parts of anything.
std::vector<Real> wave(Real a, Real b, int count) {
  std::vector<Real> values;
  Real phase = 0;
  for (int n = 0; n < count; ++n) {
    phase += 0.01 + 0.005 * std::cos(0.37 * n * n);
    values.push_back(a + b * std::sin(phase));
  }
  return values;
}

}  // namespace

TEST(RunningMoments, ByHand) {
  const RunningMoments moments = moments_of({1, 2, 4, 9});
  EXPECT_EQ(moments.samples, 4);
  EXPECT_EQ(moments.mean, 4);
  EXPECT_DOUBLE_EQ(moments.squares, 9 + 4 + 0 + 25);
  EXPECT_DOUBLE_EQ(moments.deviation(), std::sqrt(38.0 / 4));
}

TEST(RunningMoments, AgreeWithTwoPasses) {
  const auto values = wave(3, 2, 100'000);
  const TwoPass expected = two_pass(values);
  const RunningMoments moments = moments_of(values);
  // Round-off of each of n updates, of either sign: sqrt(n) 1e-16, some times that.
  EXPECT_NEAR(moments.mean, static_cast<Real>(expected.mean), 1e-12);
  EXPECT_NEAR(moments.deviation(), static_cast<Real>(expected.deviation), 1e-12);
}

// The mean is rounded to 1.2e-7 of the fluctuation; squares of the values, to 100 times the fluctuation's own square.
TEST(RunningMoments, SmallFluctuationOfALargeMean) {
  const auto values = wave(1e9, 1, 10'000);
  const TwoPass expected = two_pass(values);
  const RunningMoments moments = moments_of(values);
  EXPECT_NEAR(moments.deviation() / static_cast<Real>(expected.deviation), 1, 1e-5);
  Real sum = 0, squares = 0;
  for (const Real v : values) {
    sum += v;
    squares += v * v;
  }
  const Real count = static_cast<Real>(values.size());
  const Real naive = squares / count - (sum / count) * (sum / count);
  EXPECT_GT(std::abs(naive), 10) << "the series is too easy: it shows nothing";
}

TEST(RunningMoments, AConstantHasNoDeviation) {
  const RunningMoments moments = moments_of(std::vector<Real>(1000, 0.1));
  EXPECT_EQ(moments.mean, 0.1);
  EXPECT_EQ(moments.deviation(), 0);
}

TEST(RunningMoments, NoSamplesNoNumber) {
  EXPECT_TRUE(std::isnan(RunningMoments{}.deviation()));
  EXPECT_TRUE(std::isnan(RunningMoments{}.mean_or_nan()));
  EXPECT_EQ(moments_of({7}).deviation(), 0);
}
