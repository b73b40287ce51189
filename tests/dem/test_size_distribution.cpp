// Size distributions: the moments of drawn diameters against closed forms, in units of their standard error, and the
// sampler's own figures against the same forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/random.hpp"
#include "dem/size_distribution.hpp"

namespace pellicle::dem {
namespace {

constexpr int draws = 100000;
// Each comparison fails once in 16000 if the form is right; the numbers are the same at every run.
constexpr Real standard_errors = 4;

std::vector<Real> draw(const SizeSampler& sizes) {
  std::vector<Real> diameters;
  for (int id = 0; id < draws; ++id) {
    diameters.push_back(sizes.diameter(core::random_uniform(11, core::Purpose::test, 3, id)));
  }
  return diameters;
}

Real mean_power(const std::vector<Real>& values, Real power) {
  Real sum = 0;
  for (const Real v : values) sum += std::pow(v, power);
  return sum / static_cast<Real>(values.size());
}

/// `moment(k)` is E[dᵏ] in closed form; the mean of dᵏ over N draws scatters by √((E[d²ᵏ] − E[dᵏ]²)/N).
template <class Moment>
void expect_moments(const SizeSampler& sizes, const Moment& moment) {
  const std::vector<Real> diameters = draw(sizes);
  for (const int k : {1, 2, 3}) {
    const Real expected = moment(k);
    const Real error = std::sqrt((moment(2 * k) - expected * expected) / draws);
    EXPECT_NEAR(mean_power(diameters, k), expected, standard_errors * error) << "power " << k;
  }
  EXPECT_GE(*std::min_element(diameters.begin(), diameters.end()), sizes.smallest());
  EXPECT_LE(*std::max_element(diameters.begin(), diameters.end()), sizes.largest());
  // 4096 classes with the exact share in each: what is left is the curvature within one, of the order of 1/4096².
  EXPECT_NEAR(sizes.mean_volume() / (M_PI / 6 * moment(3)), 1, 1e-6);
}

Real normal_share(Real x) { return 0.5 * (1 + std::erf(x / std::sqrt(2.0))); }
Real normal_density(Real x) { return std::exp(-0.5 * x * x) / std::sqrt(2 * M_PI); }

TEST(SizeDistribution, Uniform) {
  const Real a = 0.5, b = 2;
  const SizeSampler sizes(UniformSizes{a, b});
  expect_moments(sizes,
                 [&](int k) { return (std::pow(b, k + 1) - std::pow(a, k + 1)) / ((k + 1) * (b - a)); });
  EXPECT_NEAR(sizes.diameter(0.25), 0.875, 1e-15);
}

// Moments of a normal variable cut at both ends, by parts: m_k = µ m_(k-1) + (k - 1) σ² m_(k-2)
// − σ (b^(k-1) φ(β) − a^(k-1) φ(α))/Z (Johnson, Kotz & Balakrishnan, Continuous Univariate Distributions 1, 13.10).
TEST(SizeDistribution, NormalCutAtItsBounds) {
  const Real mean = 0.75, sd = 0.2, a = 0.5,
             b = 1;  // the thesis's radii of 250 to 500 µm, as diameters in mm
  const Real alpha = (a - mean) / sd, beta = (b - mean) / sd;
  const Real z = normal_share(beta) - normal_share(alpha);
  std::vector<Real> m{1, mean - sd * (normal_density(beta) - normal_density(alpha)) / z};
  for (int k = 2; k <= 6; ++k) {
    const auto at = [&](int i) { return m[static_cast<std::size_t>(i)]; };
    m.push_back(
        mean * at(k - 1) + (k - 1) * sd * sd * at(k - 2) -
        sd * (std::pow(b, k - 1) * normal_density(beta) - std::pow(a, k - 1) * normal_density(alpha)) / z);
  }
  expect_moments(SizeSampler(NormalSizes{mean, sd, a, b}),
                 [&](int k) { return m[static_cast<std::size_t>(k)]; });
  // Cut on one side of the mean only: the mean shifts by far more than a standard error if the cut were left out.
  const SizeSampler upper(NormalSizes{mean, sd, mean, 3});
  EXPECT_NEAR(mean_power(draw(upper), 1), mean + sd * std::sqrt(2 / M_PI), 4 * 0.12 / std::sqrt(draws));
}

/// E[dᵏ] of a log-normal variable cut at a and b.
Real log_normal_moment(Real median, Real s, Real a, Real b, int k) {
  const Real alpha = std::log(a / median) / s, beta = std::log(b / median) / s;
  return std::pow(median, k) * std::exp(0.5 * k * k * s * s) *
         (normal_share(beta - k * s) - normal_share(alpha - k * s)) /
         (normal_share(beta) - normal_share(alpha));
}

TEST(SizeDistribution, LogNormalByNumber) {
  const Real median = 0.3, s = std::log(1.5), a = 0.1, b = 0.9;
  expect_moments(SizeSampler(LogNormalSizes{median, 1.5, a, b, ShareOf::count}),
                 [&](int k) { return log_normal_moment(median, s, a, b, k); });
}

// By mass, the number is log-normal too, with the median times exp(−3 s²) (Hatch & Choate, J. Franklin Inst. 207
// (1929) 369), between the same bounds.
TEST(SizeDistribution, LogNormalByMass) {
  const Real median = 0.3, s = std::log(1.5), a = 0.1, b = 0.9;
  expect_moments(SizeSampler(LogNormalSizes{median, 1.5, a, b, ShareOf::mass}),
                 [&](int k) { return log_normal_moment(median * std::exp(-3 * s * s), s, a, b, k); });
}

// E[dᵏ] by number is ∫ dᵏ⁻³ q₃ / ∫ d⁻³ q₃ over the mass density q₃; by the midpoint rule in the share of mass, where
// d = size (−ln(1 − share))^(1/spread).
TEST(SizeDistribution, RosinRammler) {
  const Real size = 1, spread = 1.8, a = 0.4, b = 2;
  const auto finer = [&](Real d) { return 1 - std::exp(-std::pow(d / size, spread)); };
  const auto integral = [&](int power) {
    constexpr int steps = 100000;
    Real sum = 0;
    for (int i = 0; i < steps; ++i) {
      const Real share = finer(a) + (i + 0.5) / steps * (finer(b) - finer(a));
      sum += std::pow(size * std::pow(-std::log(1 - share), 1 / spread), power);
    }
    return sum;
  };
  const SizeSampler sizes(RosinRammlerSizes{size, spread, a, b});
  expect_moments(sizes, [&](int k) { return integral(k - 3) / integral(-3); });
  // And the name-giving figure itself: of the mass drawn, the share finer than `size` is 63.2 % before the cut. A sum
  // over draws of mass, each in or out: its standard error from the mean square of mass.
  const std::vector<Real> diameters = draw(sizes);
  const Real expected = (finer(size) - finer(a)) / (finer(b) - finer(a));
  Real below = 0, scatter = 0;
  for (const Real d : diameters) {
    const Real mass = d * d * d;
    below += d < size ? mass : 0;
    scatter += std::pow(mass * ((d < size ? 1 : 0) - expected), 2);
  }
  const Real all = mean_power(diameters, 3) * draws;
  EXPECT_NEAR(below / all, expected, standard_errors * std::sqrt(scatter) / all);
}

TEST(SizeDistribution, TableOfDiameters) {
  const std::vector<Real> diameters{1, 2, 4};
  for (const ShareOf by : {ShareOf::count, ShareOf::mass}) {
    // 2 : 1 : 5 by mass is 2 : 1/8 : 5/64 by number.
    const std::vector<Real> shares = by == ShareOf::count ? std::vector<Real>{2. / 8, 1. / 8, 5. / 8}
                                                          : std::vector<Real>{128. / 141, 8. / 141, 5. / 141};
    const SizeSampler sizes(TableSizes{diameters, {2, 1, 5}, {}, by});
    const std::vector<Real> drawn = draw(sizes);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto count = static_cast<Real>(std::count(drawn.begin(), drawn.end(), diameters[k]));
      EXPECT_NEAR(count / draws, shares[k], standard_errors * std::sqrt(shares[k] * (1 - shares[k]) / draws));
    }
    const Real cube = shares[0] + 8 * shares[1] + 64 * shares[2];
    EXPECT_NEAR(sizes.mean_volume(), M_PI / 6 * cube, 1e-12 * cube);
  }
}

// Two sieve classes with 30 % and 70 % by mass, in percent. Within a class mass is uniform in d, so that by number
// E[dᵏ] = Σ share ∫ dᵏ⁻³/(width) / Σ share ∫ d⁻³/(width).
TEST(SizeDistribution, SieveAnalysis) {
  const auto moment = [](int k) {
    const auto integral = [](Real a, Real b, int power) {
      return power == -1 ? std::log(b / a) / (b - a)
                         : (std::pow(b, power + 1) - std::pow(a, power + 1)) / ((power + 1) * (b - a));
    };
    return (0.3 * integral(1, 2, k - 3) + 0.7 * integral(2, 3.5, k - 3)) /
           (0.3 * integral(1, 2, -3) + 0.7 * integral(2, 3.5, -3));
  };
  expect_moments(SizeSampler(TableSizes{{1, 2, 3.5}, {}, {0, 30, 100}, ShareOf::mass}), moment);
  // By number, an empty class in the middle gets nothing.
  const SizeSampler gap(TableSizes{{1, 2, 3, 4}, {}, {0, 1, 1, 2}, ShareOf::count});
  for (const Real d : draw(gap)) EXPECT_TRUE(d <= 2 || d >= 3) << d;
}

TEST(SizeDistribution, EndsAreTheBounds) {
  const std::vector<SizeDistribution> all{
      UniformSizes{1, 2}, NormalSizes{1.5, 0.2, 1, 2}, LogNormalSizes{1.5, 1.2, 1, 2, ShareOf::mass},
      RosinRammlerSizes{1.5, 3, 1, 2}, TableSizes{{1, 2}, {}, {0, 1}, ShareOf::mass}};
  for (const auto& distribution : all) {
    const SizeSampler sizes(distribution);
    EXPECT_EQ(sizes.diameter(0), 1);
    EXPECT_NEAR(sizes.diameter(1 - 0x1.0p-53), 2, 1e-3);
    EXPECT_LE(sizes.diameter(1 - 0x1.0p-53), 2);
    Real last = 0;
    for (int i = 0; i < 1000; ++i) {
      const Real d = sizes.diameter(i / 1000.0);
      EXPECT_GT(d, last);
      last = d;
    }
  }
}

TEST(SizeDistribution, RefusesWhatMakesNoSense) {
  const auto message = [](const SizeDistribution& distribution) -> std::string {
    try {
      SizeSampler sizes(distribution);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message(UniformSizes{0, 1}), "min must be greater than 0");
  EXPECT_EQ(message(UniformSizes{2, 1}), "max must be greater than min");
  EXPECT_EQ(message(NormalSizes{1, 0, 1, 2}), "sd must be greater than 0");
  EXPECT_EQ(message(NormalSizes{1, 0.01, 3, 4}), "no share of the distribution is between its bounds");
  EXPECT_EQ(message(LogNormalSizes{1, 1, 1, 2}), "geometric_sd must be greater than 1");
  EXPECT_EQ(message(TableSizes{{2, 1}, {1, 1}, {}}), "diameters must increase");
  EXPECT_EQ(message(TableSizes{{1, 2}, {1}, {}}), "shares must have as many entries as diameters");
  EXPECT_EQ(message(TableSizes{{1, 2}, {0, 0}, {}}), "one of the shares must be greater than 0");
  EXPECT_EQ(message(TableSizes{{1, 2}, {}, {1, 0}}), "finer must not decrease");
  EXPECT_EQ(message(TableSizes{{1}, {}, {1}}), "finer must have as many entries as diameters, at least two");
}

}  // namespace
}  // namespace pellicle::dem
