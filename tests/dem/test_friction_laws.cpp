// Laws with springs as functions of scalars and vectors, against numbers worked out elsewhere with 30 digits from the
// equations of docs/theory/dem.md.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/contact_force.hpp"

namespace pellicle::dem {
namespace {

// The laws: a dozen roundings.
constexpr Real round_off = 1e-13;

// A contact of glass beads of 3 mm that overlap by 4 % of R*, and its Hertz force: S_n = 1500 N/m, S_t = 1320 N/m.
constexpr ContactState contact{3e-5, 7.5e-4, 1.77e-5, 0};
constexpr PairParameters glass{5e6, 1.1e6, 0.122, 1.876166303929372, 0.3, 0.05, 0.88, 1000};
constexpr NormalForce normal{0.03, 0.1629417073680032, 1500, 0.0362937184647701812};
constexpr Real time_step = 1e-6;

void expect_vector(const Vec3& value, const Vec3& expected) {
  const Real tolerance = round_off * norm(expected);
  EXPECT_LE(norm(value - expected), tolerance)
      << value.x << ", " << value.y << ", " << value.z << " instead of " << expected.x << ", " << expected.y
      << ", " << expected.z;
}

TEST(Hertz, HandsOnStiffnessAndDamping) {
  const NormalForce force = Hertz{}(contact, glass);
  EXPECT_NEAR(force.stiffness, 1500, 1500 * round_off);  // 2 E* √(R* δ)
  EXPECT_NEAR(force.damping, normal.damping, 0.04 * round_off);
}

TEST(Linear, AddsSpringAndDamping) {
  const Linear law;
  ContactState c = contact;
  EXPECT_NEAR(law(c, glass).force, 0.03, 0.03 * round_off);  // k δ
  c.approach_speed = 0.4;                                    // 2 Λ √(k m*) v_n = 0.01298 N
  EXPECT_NEAR(law(c, glass).force, 0.0429848354629545, 0.043 * round_off);
  EXPECT_EQ(law(c, glass).stiffness, 1000);
  c.approach_speed = -1;
  EXPECT_EQ(law(c, glass).force, 0);
  EXPECT_NEAR(Linear{false}(c, glass).force, 0.03 - 2.5 * 0.0129848354629545, 0.03 * round_off);
}

TEST(Mindlin, IsASpringWithADashpotBelowTheLimit) {
  const SpringForce f = Mindlin{time_step}(contact, normal, {0.02, 0.01, 0}, {1e-6, -2e-6, 0}, glass);
  // −S_t (ξ + v Δt/2) − η_t v, η_t = 2√(5/6) Λ √(S_t m*) = 0.03405 kg/s; below µ F_n = 0.009 N.
  expect_vector(f.force, {-0.00201413051627901, 0.00229293474186049467, 0});
  expect_vector(f.spring, {1.02e-6, -1.99e-6, 0});
}

TEST(Mindlin, SlipsAtTheLimitAndShortensTheSpring) {
  const SpringForce f = Mindlin{time_step}(contact, normal, {0.1, 0.2, 0}, {3e-5, 0, 0}, glass);
  expect_vector(f.force, {-0.00788145215246981124, -0.00434542425642525488, 0});
  EXPECT_NEAR(norm(f.force), 0.3 * 0.03, 0.009 * round_off);
  // At the time of the force µ F_n/S_t long, and half a step on.
  expect_vector(f.spring, {6.86814406565516713e-6, 1.22689331333295065e-7, 0});
  EXPECT_NEAR(norm(f.spring - 0.5e-6 * Vec3{0.1, 0.2, 0}), 0.009 / 1320, 1e-5 * round_off);
  // Nothing holds where the normal force is clipped, or without friction.
  EXPECT_EQ(norm(Mindlin{time_step}(contact, {0, 0.16, 1500, 0.04}, {0.1, 0, 0}, {1e-6, 0, 0}, glass).force),
            0);
  PairParameters smooth = glass;
  smooth.sliding_friction = 0;
  EXPECT_EQ(norm(Mindlin{time_step}(contact, normal, {0.1, 0, 0}, {1e-6, 0, 0}, smooth).force), 0);
}

TEST(Mindlin, UnloadsAlongTheSpringItHolds) {
  // Pulled far past the limit, then back at the same speed, without damping: the force falls along the same stiffness,
  // reaches −µ F_n after 2 µ F_n/S_t of way back and stays there.
  PairParameters elastic = glass;
  elastic.damping_ratio = 0;
  const NormalForce undamped{0.03, 0.163, 1500, 0};
  const Mindlin law{time_step};
  Vec3 spring{};
  for (int step = 0; step < 1000; ++step) {
    spring = law(contact, undamped, {0.05, 0, 0}, spring, elastic).spring;
  }
  Real force = 0;
  for (int step = 1; step <= 1000; ++step) {
    const SpringForce f = law(contact, undamped, {-0.05, 0, 0}, spring, elastic);
    spring = f.spring;
    force = f.force.x;
    // Midway between the two speeds half a step of each cancels: ξ = ξ_max − (step − 1) 0.05 µm.
    const Real elongation = 0.009 / 1320 - (step - 1) * 0.05e-6;
    EXPECT_NEAR(force, std::min(0.009, -1320 * elongation), 0.009 * 1e-12) << step;
  }
  EXPECT_NEAR(force, 0.009, 0.009 * round_off);
}

TEST(MindlinDeresiewicz, SoftensTowardsTheLimit) {
  const MindlinDeresiewicz law{time_step};
  const SpringForce f = law(contact, normal, {0.02, 0, 0}, {4e-6, 0, 0}, glass);
  // ξ_max = µ δ E*/(4 G*) = 10.23 µm, x = 0.39209: elastic 0.0047342 N, dashpot 0.00069428 N.
  expect_vector(f.force, {-0.00542845501959690538, 0, 0});
  expect_vector(f.spring, {4.02e-6, 0, 0});
  // Without speed and hardly stretched it is S_t ξ, 1.5 times less (1 − x/4 …) x.
  const Real x = 1e-6;
  const SpringForce start = law(contact, normal, {}, {x * 1.02272727272727e-5, 0, 0}, glass);
  EXPECT_NEAR(start.force.x, -0.0135 * x * (1 - x / 4), 1e-9 * 0.0135 * x);  // a difference of 1e-6 in 1
  // Beyond ξ_max it slides: µ F_n, no dashpot, and a spring of ξ_max.
  const SpringForce slide = law(contact, normal, {0.02, 0, 0}, {0, 3e-5, 0}, glass);
  EXPECT_NEAR(norm(slide.force), 0.009, 0.009 * round_off);
  EXPECT_NEAR(norm(slide.spring - Vec3{1e-8, 0, 0}), 1.02272727272727273e-5, 1e-5 * round_off);
  EXPECT_EQ(norm(law(contact, {0, 0.16, 1500, 0.04}, {0.1, 0, 0}, {1e-6, 0, 0}, glass).force), 0);
  PairParameters smooth = glass;
  smooth.sliding_friction = 0;
  EXPECT_EQ(norm(law(contact, normal, {0.1, 0, 0}, {1e-6, 0, 0}, smooth).force), 0);
}

TEST(Epsd2, IsAnElasticPlasticSpring) {
  const Epsd2 law{time_step};
  const Vec3 n{0, 0, 1};
  // k_r = S_t R*² = 7.425e-4 N m; the spin about the normal counts for nothing.
  const SpringTorque held = law(contact, normal, n, {10, 0, 70}, {1e-3, 0, 0}, glass);
  expect_vector(held.torque, {-7.425e-4 * 1.005e-3, 0, 0});
  expect_vector(held.spring, {1.01e-3, 0, 0});
  // µ_r R* F_n = 1.125e-6 N m is reached at 1.515e-3 rad.
  const SpringTorque slips = law(contact, normal, n, {10, 0, 0}, {2e-3, 0, 0}, glass);
  expect_vector(slips.torque, {-1.125e-6, 0, 0});
  expect_vector(slips.spring, {1.51515151515151515e-3 + 5e-6, 0, 0});
  EXPECT_EQ(norm(law(contact, {0, 0.16, 1500, 0.04}, n, {10, 0, 0}, {1e-3, 0, 0}, glass).torque), 0);
}

TEST(TurnSpring, FollowsAContactThatTurns) {
  // A quarter of a turn about y in steps of 1e-3 rad carries x to −z and leaves y; the length stays to round-off.
  const int steps = 1571;
  const Real angle = 0.5 * M_PI / steps;
  Vec3 spring{3e-6, 4e-6, 0};
  for (int k = 1; k <= steps; ++k) {
    spring = turn_spring(spring, {std::sin(k * angle), 0, std::cos(k * angle)}, 0);
  }
  EXPECT_NEAR(norm(spring), 5e-6, 5e-6 * steps * 1e-16);
  // Each step keeps the length of the whole, not that of each component: 1e-6 a step, of one sign.
  EXPECT_LE(norm(spring - Vec3{0, 4e-6, -3e-6}), 5e-6 * steps * angle * angle);
}

TEST(TurnSpring, FollowsABodyThatSpinsAboutTheNormal) {
  const int steps = 1571;
  const Real angle = 0.5 * M_PI / steps;
  Vec3 spring{3e-6, 4e-6, 0};
  for (int k = 0; k < steps; ++k) spring = turn_spring(spring, {0, 0, 1}, angle);
  EXPECT_NEAR(norm(spring), 5e-6, 5e-6 * steps * 1e-16);
  // tan and angle differ by angle³/3 a step.
  EXPECT_LE(norm(spring - Vec3{-4e-6, 3e-6, 0}), 5e-6 * steps * angle * angle * angle / 2);
  EXPECT_EQ(turn_spring(Vec3{0, 0, 0}, {0, 0, 1}, angle), (Vec3{0, 0, 0}));
}

}  // namespace
}  // namespace pellicle::dem
