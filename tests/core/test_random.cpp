#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include "core/random.hpp"

using namespace pellicle;
using namespace pellicle::core;

namespace {

void expect_words(const RandomWords& actual, const std::array<std::uint32_t, 4>& expected) {
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(actual.word[i], expected[i]);
}

}  // namespace

// Known-answer vectors published with the Random123 library (kat_vectors, "philox4x32 10").
TEST(Random, PhiloxKnownAnswers) {
  expect_words(philox4x32_10({{0, 0, 0, 0}}, 0, 0), {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  expect_words(philox4x32_10({{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}}, 0xffffffff, 0xffffffff),
               {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  expect_words(philox4x32_10({{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}}, 0xa4093822, 0x299f31d0),
               {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST(Random, UniformEndsOfTheInterval) {
  EXPECT_EQ(to_uniform(0, 0), 0.0);
  EXPECT_EQ(to_uniform(0x80000000u, 0), 0.5);
  EXPECT_LT(to_uniform(0xffffffffu, 0xffffffffu), 1.0);
}

TEST(Random, EveryArgumentMatters) {
  std::set<Real> seen;
  seen.insert(random_uniform(1, Purpose::test, 5, 7));
  seen.insert(random_uniform(2, Purpose::test, 5, 7));
  seen.insert(random_uniform(std::uint64_t{1} << 40, Purpose::test, 5, 7));
  seen.insert(random_uniform(1, Purpose::diameter, 5, 7));
  seen.insert(random_uniform(1, Purpose::test, 6, 7));
  seen.insert(random_uniform(1, Purpose::test, std::int64_t{5} + (std::int64_t{1} << 32), 7));
  seen.insert(random_uniform(1, Purpose::test, 5, 8));
  seen.insert(random_uniform(1, Purpose::test, 5, 7, 1));
  EXPECT_EQ(seen.size(), 8u);
  EXPECT_EQ(random_uniform(1, Purpose::test, 5, 7), random_uniform(1, Purpose::test, 5, 7));
}

// Moments of 1e5 draws: bounds are 4 standard deviations of each moment's sampling error, 1/sqrt(12 n) for a
// uniform mean, 1/sqrt(n) for a normal mean, sqrt(2/n) for a normal variance.
TEST(Random, Moments) {
  const int n = 100000;
  Real uniform = 0, normal = 0, square = 0;
  Vec3 mean{}, product{};
  for (int i = 0; i < n; ++i) {
    uniform += random_uniform(3, Purpose::test, 0, i);
    const Real g = random_normal(3, Purpose::test, 1, i);
    normal += g;
    square += g * g;
    const Vec3 u = random_uniform3(3, Purpose::test, 2, i) - Vec3{0.5, 0.5, 0.5};
    mean += u;
    product += Vec3{u.x * u.y, u.y * u.z, u.z * u.x};
  }
  EXPECT_NEAR(uniform / n, 0.5, 4 / std::sqrt(12.0 * n));
  EXPECT_NEAR(normal / n, 0, 4 / std::sqrt(1.0 * n));
  EXPECT_NEAR(square / n, 1, 4 * std::sqrt(2.0 / n));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis] / n, 0, 4 / std::sqrt(12.0 * n));
    // Product of two independent uniforms around 0: standard deviation 1/12.
    EXPECT_NEAR(product[axis] / n, 0, 4.0 / 12 / std::sqrt(1.0 * n));
  }
}
