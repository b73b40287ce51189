// Contact parameters against numbers worked out elsewhere with 30 digits from the equations of docs/theory/dem.md.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "dem/materials.hpp"

namespace pellicle::dem {
namespace {

// A dozen roundings and library functions good to an ulp.
constexpr Real round_off = 1e-13;

void expect_ratio(Real value, Real expected, Real tolerance) {
  EXPECT_NEAR(value / expected, 1, tolerance) << value << " instead of " << expected;
}

TEST(DampingRatio, WithClipInvertsTheClosedForm) {
  // Bisected to the last bit of Λ; e carries about 3 roundings, divided by |dln e/dln Λ| (0.03 at e 0.97).
  constexpr Real tolerance = 1e-12;
  expect_ratio(compute_damping_ratio(0.30, true), 0.497239394699294, tolerance);
  expect_ratio(compute_damping_ratio(0.70, true), 0.122214747787725, tolerance);
  expect_ratio(compute_damping_ratio(0.97, true), 0.00975559458989654, tolerance);
  expect_ratio(compute_damping_ratio(0.05, true), 1.94534618440771, tolerance);  // the branch Λ > 1
  EXPECT_EQ(compute_damping_ratio(1, true), 0);
}

TEST(DampingRatio, WithoutClipIsTheTextbookOne) {
  expect_ratio(compute_damping_ratio(0.30, false), 0.357857130503317, round_off);
  expect_ratio(compute_damping_ratio(0.97, false), 0.00969501120281556, round_off);
  EXPECT_EQ(compute_damping_ratio(1, false), 0);
}

TEST(DampingRatio, RefusesWhatIsNoRestitution) {
  for (const bool clip : {true, false}) {
    for (const Real e : {0.0, -0.5, 1.0001, std::numeric_limits<Real>::quiet_NaN()}) {
      EXPECT_THROW(compute_damping_ratio(e, clip), std::invalid_argument) << e;
    }
  }
}

/// Speed of separation over speed of approach of two bodies of reduced mass and radius 1 that meet at speed 1, E* = 1:
/// δ'' = −F(δ, δ') by the classical Runge-Kutta method until the force would pull (clip) or δ is 0 (no clip).
Real integrate_rebound(Real damping_ratio, bool clip) {
  PairParameters pair;
  pair.effective_youngs_modulus = 1;
  pair.damping_ratio = damping_ratio;
  const Hertz law{clip};
  const auto force = [&](Real overlap, Real speed) {
    return overlap > 0 ? law(ContactState{overlap, 1, 1, speed}, pair).force : Real(0);
  };
  const Real h = 2e-4;  // contact lasts about 2.9
  Real x = 0;
  Real v = 1;
  for (int step = 0; x >= 0 && step < 1000000; ++step) {
    const Real k1 = -force(x, v);
    const Real k2 = -force(x + 0.5 * h * v, v + 0.5 * h * k1);
    const Real k3 = -force(x + 0.5 * h * v + 0.25 * h * h * k1, v + 0.5 * h * k2);
    const Real k4 = -force(x + h * v + 0.5 * h * h * k2, v + h * k3);
    x += h * v + h * h / 6 * (k1 + k2 + k3);
    v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    if (clip && v < 0 && force(x, v) == 0) break;  // released: nothing acts any more
  }
  return -v;
}

TEST(DampingRatio, GivesBackTheRestitution) {
  // The power δ^(1/4) of the damping at first touch keeps the integration at about order 1.25: 1e-4 of the speed.
  constexpr Real tolerance = 1e-4;
  for (const Real e : {0.05, 0.3, 0.7, 0.97, 1.0}) {
    EXPECT_NEAR(integrate_rebound(compute_damping_ratio(e, true), true), e, tolerance);
    EXPECT_NEAR(integrate_rebound(compute_damping_ratio(e, false), false), e, tolerance);
  }
  // The textbook ratio with the clip rebounds faster than asked for.
  EXPECT_NEAR(integrate_rebound(compute_damping_ratio(0.30, false), true), 0.3971405, tolerance);
  EXPECT_NEAR(integrate_rebound(compute_damping_ratio(0.70, false), true), 0.71820136, tolerance);
  EXPECT_NEAR(integrate_rebound(compute_damping_ratio(0.83, false), true), 0.83585316, tolerance);
}

const std::vector<Material> materials{
    {"glass", 2505, 1e7, 0.22, false}, {"steel", 7800, 2e8, 0.3, false}, {"wall", 0, 0, 0, true}};

TEST(PairTable, HoldsEffectiveModuli) {
  const auto table = make_pair_table(
      materials, {{0, 0, 0.97, 0.3, 0.01}, {1, 0, 0.7, 0.2, 0.02}, {0, 2, 0.3, 0.1, 0.03}}, true);
  ASSERT_EQ(table.size(), 9U);
  const PairParameters& glass = table[0];
  expect_ratio(glass.effective_youngs_modulus, 5254308.532997058, round_off);
  expect_ratio(glass.effective_shear_modulus, 1151224.903297108, round_off);
  expect_ratio(glass.tangential_damping_ratio, 1.87232955900613, round_off);
  expect_ratio(glass.damping_ratio, 0.00975559458989654, 1e-12);
  EXPECT_EQ(glass.sliding_friction, 0.3);
  EXPECT_EQ(glass.rolling_friction, 0.01);
  const PairParameters& wall = table[2];  // the rigid side gives no compliance
  expect_ratio(wall.effective_youngs_modulus, 10508617.06599412, round_off);
  expect_ratio(wall.effective_shear_modulus, 2302449.806594216, round_off);
  EXPECT_EQ(wall.rolling_friction, 0.03);
  for (const std::size_t entry : {1U, 3U}) {  // both orders of the pair
    expect_ratio(table[entry].effective_youngs_modulus, 10029084.34459934, round_off);
    expect_ratio(table[entry].effective_shear_modulus, 2190964.462556417, round_off);
    expect_ratio(table[entry].tangential_damping_ratio, 1.869592753779284, round_off);
    EXPECT_EQ(table[entry].sliding_friction, 0.2);
  }
}

template <class F>
std::string refusal(F&& function) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PairTable, RefusesPairsThatCannotBe) {
  EXPECT_THROW(make_pair_table(materials, {{0, 3, 0.9, 0, 0}}, true), std::invalid_argument);
  EXPECT_THROW(make_pair_table(materials, {{-1, 0, 0.9, 0, 0}}, true), std::invalid_argument);
  EXPECT_THROW(make_pair_table(materials, {{0, 0, 0, 0, 0}}, true), std::invalid_argument);
  EXPECT_EQ(refusal([] {
              make_pair_table(materials, {{0, 1, 0.9, 0, 0}, {1, 0, 0.8, 0, 0}}, true);
            }),
            "contact pair between steel and glass is given twice");
}

TEST(PairTable, RequiresWhatCanMeetAndNoMore) {
  const std::vector<PairProperties> pairs{{0, 0, 0.9, 0, 0}, {2, 0, 0.9, 0, 0}};
  EXPECT_NO_THROW(require_pairs(materials, pairs, {true, false, false}, {false, false, true}));
  // Steel is a wall only: it never meets itself nor the other wall, but glass.
  EXPECT_EQ(refusal([&] {
              require_pairs(materials, pairs, {true, false, false}, {false, true, true});
            }),
            "no contact pair between glass and steel");
  EXPECT_EQ(refusal([&] {
              require_pairs(materials, {{2, 0, 0.9, 0, 0}}, {true, false, false}, {false, false, false});
            }),
            "no contact pair between glass and glass");
}

TEST(TimeStepBound, AgreesWithHandCalculation) {
  // 3 mm glass on a rigid wall: the wall contact is the shorter one, since the wall does not give.
  const auto glass = compute_time_step_bound({materials[0], materials[2]}, {0.0015, 0}, 3);
  expect_ratio(glass.rayleigh_time, 0.000127677862644288, round_off);
  expect_ratio(glass.contact_time, 0.000217916047902014, round_off);
  expect_ratio(glass.bound, 0.000217916047902014 / 20, round_off);
  // 3 mm glass and 2 mm steel: steel against steel is the shortest of both times; 0.2 T is above t_c/20.
  const auto both = compute_time_step_bound({materials[0], materials[1]}, {0.0015, 0.001}, 3);
  expect_ratio(both.rayleigh_time, 3.41804951461262e-5, round_off);
  expect_ratio(both.contact_time, 7.79007229974193e-5, round_off);
  expect_ratio(both.bound, 7.79007229974193e-5 / 20, round_off);
  // A slow bed is bound by the Rayleigh time: t_c grows as v^(-1/5).
  const auto slow = compute_time_step_bound({materials[0], materials[2]}, {0.0015, 0}, 3e-4);
  expect_ratio(slow.contact_time, 0.000217916047902014 * std::pow(1e4, 0.2), round_off);
  expect_ratio(slow.bound, 0.2 * 0.000127677862644288, round_off);
}

TEST(LinearStiffness, BoundsTheOverlap) {
  const Material glass{"glass", 2500, 1e7, 0.22, false};
  const Material wall{"wall", 0, 0, 0, true};
  const RadiusRange bead{0.005, 0.005};
  const Real mass = 2500 * 4.0 / 3.0 * M_PI * 0.005 * 0.005 * 0.005;
  // Without damping m* v²/2 becomes k δ²/2; δ = 1 % of R, m* = m/2 or, at a wall, m.
  const Real pair = compute_linear_stiffness(glass, bead, glass, bead, 0.01, 2);
  expect_ratio(pair, 0.5 * mass * 4 / (5e-5 * 5e-5), round_off);
  expect_ratio(compute_linear_stiffness(glass, bead, wall, {}, 0.01, 2), 2 * pair, round_off);
  expect_ratio(compute_linear_stiffness(wall, {}, glass, bead, 0.01, 2), 2 * pair, round_off);
  EXPECT_EQ(compute_linear_stiffness(wall, {}, wall, {}, 0.01, 2), 0);
  // Sizes from 1 to 3, and another density: no pair of them overlaps more, and one nearly as much.
  const Material heavy{"heavy", 8000, 1e7, 0.22, false};
  const Real stiffness = compute_linear_stiffness(glass, {0.001, 0.003}, heavy, {0.002, 0.004}, 0.01, 2);
  Real largest = 0;
  for (Real ra = 0.001; ra <= 0.003; ra += 7e-6) {
    for (Real rb = 0.002; rb <= 0.004; rb += 7e-6) {
      const Real inverse = (1 / (2500 * ra * ra * ra) + 1 / (8000 * rb * rb * rb)) * 3 / (4 * M_PI);
      largest = std::max(largest, 2 / std::sqrt(inverse * stiffness) / std::min(ra, rb));
    }
  }
  EXPECT_NEAR(largest, 0.01, 5e-5);  // 20 radii of each range against 290
}

TEST(LinearStiffness, BoundsTheTimeStep) {
  // t_c = π √(m*/k) = π δ/v for the stiffness above; the wall contact has the same, twice the mass and twice k. A pair of
  // materials without particles does not count.
  const std::vector<Material> both{{"glass", 2500, 1e7, 0.22, false}, {"wall", 0, 0, 0, true}};
  const RadiusRange bead{0.005, 0.005};
  std::vector<PairProperties> pairs{{0, 0, 0.9, 0, 0}, {0, 1, 0.9, 0, 0}, {1, 1, 0.9, 0, 0, 1e30}};
  pairs[0].normal_stiffness = compute_linear_stiffness(both[0], bead, both[0], bead, 0.01, 2);
  pairs[1].normal_stiffness = compute_linear_stiffness(both[0], bead, both[1], {}, 0.01, 2);
  const auto bound = compute_linear_time_step_bound(both, pairs, {0.005, 0});
  expect_ratio(bound.contact_time, M_PI * 5e-5 / 2, round_off);
  expect_ratio(bound.bound, M_PI * 5e-5 / 2 / 20, round_off);
  EXPECT_TRUE(std::isinf(bound.rayleigh_time));
  pairs[1].normal_stiffness *= 4;
  expect_ratio(compute_linear_time_step_bound(both, pairs, {0.005, 0}).contact_time, M_PI * 2.5e-5 / 2,
               round_off);
}

}  // namespace
}  // namespace pellicle::dem
