// The benchmark series of Chung & Ooi (Granul. Matter 13 (2011) 643): tests 4 to 8: oblique impacts and spin.
//
// Their figures were read off by others (KratosMultiphysics, DEMApplication, benchmarks 1 to 8); a point read off is
// good to about 1 % of the axis. Closed forms are held to far less.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/verification/dem/impacts.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using namespace tests;

constexpr Solid aluminium_oxide{3.8e11, 0.23, 4000};

Real degrees(Real radians) { return radians * 180 / M_PI; }

ContactOptions with_mindlin() {
  ContactOptions laws;
  laws.tangential = Mindlin{};
  laws.rolling = NoRolling{};
  return laws;
}

/// Test 4: aluminium oxide, R 2.5 mm, 3.9 m/s at an angle to the normal, µ 0.092, e 0.98.
struct ObliqueResult {
  Real tangential_restitution, spin, rebound_angle;
};
constexpr Real oblique_speed = 3.9, oblique_radius = 0.0025, oblique_friction = 0.092,
               oblique_restitution = 0.98;

std::vector<ObliqueResult> run_test4(const ContactOptions& laws, const std::vector<Real>& angles) {
  ImpactSeries series{aluminium_oxide, oblique_radius};
  series.restitution = oblique_restitution;
  series.sliding_friction = oblique_friction;
  series.laws = laws;
  std::vector<ImpactState> before;
  for (const Real angle : angles) {
    const Real a = angle * M_PI / 180;
    before.push_back({{oblique_speed * std::sin(a), 0, -oblique_speed * std::cos(a)}, {}, {}});
  }
  std::vector<ObliqueResult> results;
  const auto after = run_impacts(series, before);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const Vec3 v = after[i].velocity;
    const Real w = after[i].spin.y;
    EXPECT_EQ(v.y, 0);
    EXPECT_EQ(after[i].spin.x, 0);
    // Rebound angle: of the contact point's velocity to the normal; their spin counts the other way round.
    results.push_back({v.x / before[i].velocity.x, -w, degrees(std::atan2(v.x - oblique_radius * w, v.z))});
  }
  return results;
}

/// Deviations from a sphere that slides throughout: e_t = 1 − µ(1 + e)/tan θ, R ω = −(5/2) µ(1 + e) v_n.
void check_sliding_branch(const ContactOptions& laws, const std::string& name,
                          const std::vector<Real>& angles) {
  const auto got = run_test4(laws, angles);
  Real restitution = 0, spin = 0, angle = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const Real a = angles[i] * M_PI / 180;
    const Real impulse = oblique_friction * (1 + oblique_restitution);
    const Real e_t = 1 - impulse / std::tan(a);
    const Real w = -2.5 * impulse * oblique_speed * std::cos(a) / oblique_radius;
    const Real recoil =
        std::atan2(e_t * std::sin(a) - 2.5 * impulse * std::cos(a), oblique_restitution * std::cos(a));
    restitution = std::max(restitution, std::abs(got[i].tangential_restitution - e_t));
    spin = std::max(spin, std::abs(got[i].spin / w - 1));
    angle = std::max(angle, std::abs(got[i].rebound_angle - degrees(recoil)));
  }
  expect_small("test 4, sliding branch, " + name + ": tangential restitution", restitution, 1e-5,
               "friction impulse µ(1+e) m v_n whatever the law; e scatters by 0.001 (20/1000)^1.25 = 8e-6");
  expect_small("test 4, sliding branch, " + name + ": spin, relative", spin, 0.0033,
               "the lever is R − δ: up to δ/R = 0.0032 shorter than in the rigid closed form");
  expect_small("test 4, sliding branch, " + name + ": rebound angle [deg]", angle, 0.2,
               "from the spin's deviation of 0.3 %, 2 m/s of 600 rad/s × R, times 180/π");
}

TEST(ChungOoi, Test4SlidingBranchWithoutHistory) {
  check_sliding_branch(ContactOptions{}, "viscous_coulomb", {35, 40, 45, 50, 60, 70, 80, 85});
}

/// One oblique impact on a rigid floor by the equations themselves, in the plane: (δ, v_n), the centre's v_t, the spin,
/// and the spring ξ of `mindlin` with Coulomb's limit. Explicit steps, so many that their size does not matter.
struct PlaneImpact {
  Real velocity, spin, normal_velocity;
};

PlaneImpact integrate_mindlin(const Solid& s, Real radius, Real e, Real friction, Real v_n, Real v_t,
                              Real w) {
  const Real modulus = wall_modulus(s);
  const Real shear = s.youngs_modulus / (2 * (2 - s.poisson_ratio) * (1 + s.poisson_ratio));
  const Real mass = sphere_mass(s, radius), inertia = 0.4 * mass * radius * radius;
  // Λ of the clipped contact by bisection of its closed form (e falls with Λ).
  Real low = 0, high = 0.999;
  for (int n = 0; n < 100; ++n) {
    const Real l = 0.5 * (low + high), q = std::sqrt(1 - l * l);
    (std::exp(-(l / q) * (M_PI - std::atan2(2 * l * q, 1 - 2 * l * l))) > e ? low : high) = l;
  }
  const HertzImpact hertz{mass, modulus, radius, v_n};
  const Real dt = hertz.contact_time() / 200000;
  Real overlap = 0, approach = v_n, spring = 0;
  for (int k = 0; k < 4000000; ++k) {
    overlap += approach * dt;
    if (overlap <= 0) break;
    const Real contact = std::sqrt(radius * overlap);
    const Real normal_stiffness = 2 * modulus * contact, tangential_stiffness = 8 * shear * contact;
    const Real damping = 2 * std::sqrt(5.0 / 6) * low;
    const Real normal = std::max(
        0.0, 2.0 / 3 * normal_stiffness * overlap + damping * std::sqrt(normal_stiffness * mass) * approach);
    const Real lever = radius - overlap;
    const Real slip = v_t - lever * w;
    const Real limit = friction * normal;
    spring = std::clamp(spring + slip * dt, -limit / tangential_stiffness, limit / tangential_stiffness);
    const Real force =
        std::clamp(-tangential_stiffness * spring - damping * std::sqrt(tangential_stiffness * mass) * slip,
                   -limit, limit);
    approach -= normal / mass * dt;
    v_t += force / mass * dt;
    w -= lever * force / inertia * dt;
  }
  return {v_t, w, -approach};
}

/// Of Mindlin's law as docs/theory/dem.md states it, at any angle and restitution, with spin before the impact. Two equal
/// spheres with opposite velocities and equal spins are each other's point reflection: what each does is what it would
/// do on a rigid floor; so stiff that they do not roll around each other in the contact (4e-8 m of 5 mm).
void check_oblique(Partner partner, const std::string& name) {
  Solid solid = aluminium_oxide;
  if (partner == Partner::equal_sphere) solid.youngs_modulus *= 1e8;
  Real velocity = 0, spin = 0, normal = 0;
  for (const Real e : {1.0, 0.98, 0.5}) {
    ImpactSeries series{solid, oblique_radius};
    series.partner = partner;
    series.restitution = e;
    series.sliding_friction = 0.2;
    series.laws = with_mindlin();
    series.steps_per_contact = 2000;
    std::vector<ImpactState> before;
    for (const Real tangent : {0.05, 0.2, 0.5, 1.0, 2.0, 5.0}) {
      const Vec3 spin_before{0, -0.9 * tangent / oblique_radius, 0};
      before.push_back({{tangent, 0, -1}, {}, {}});
      before.push_back({{0.1 * tangent, 0, -1}, spin_before, spin_before});
    }
    const auto after = run_impacts(series, before);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto expected =
          integrate_mindlin(solid, oblique_radius, e, 0.2, 1, before[i].velocity.x, before[i].spin.y);
      normal = std::max(normal, std::abs(after[i].velocity.z - expected.normal_velocity));
      velocity = std::max(velocity, std::abs(after[i].velocity.x - expected.velocity));
      spin = std::max(spin, oblique_radius * std::abs(after[i].spin.y - expected.spin));
    }
  }
  const std::string why = "equations of the law integrated apart from this code with 200000 steps; here 2000";
  EXPECT_LT(normal, 1e-4);  // the explicit steps of the comparison
  expect_small("oblique impacts " + name + ", mindlin, e 0.5 to 1: tangential velocity over v_n", velocity,
               2e-4, why);
  expect_small("oblique impacts " + name + ", mindlin: R times spin over v_n", spin, 5e-4, why);
}

TEST(ChungOoi, ObliqueImpactsOfTwoSpheresFollowTheEquations) {
  check_oblique(Partner::equal_sphere, "of two spheres");
}

constexpr Solid aluminium_of_test6{7e10, 0.33, 2700};

/// Spins at which the contact point moves at 0.2 m/s × tan θ, θ = 85, 80, …, 5 degrees.
std::vector<Real> tangents() {
  std::vector<Real> values;
  for (int i = 17; i > 0; --i) values.push_back(std::tan(i * 5 * M_PI / 180));
  return values;
}

ImpactSeries spin_series(const Solid& solid) {
  ImpactSeries series{solid, 0.1};
  series.restitution = 0.5;
  series.sliding_friction = 0.4;
  series.laws = with_mindlin();
  return series;
}

TEST(ChungOoi, Test7SpheresThatRollOnEachOther) {
  // Equal and opposite spins: the surfaces do not slip on each other, so that nothing tangential may happen.
  for (const Solid& solid : {aluminium_of_test6, Solid{1.2e11, 0.35, 8900}}) {
    std::vector<ImpactState> before;
    for (const Real t : tangents()) before.push_back({{0, 0, -0.2}, {0, 2 * t, 0}, {0, -2 * t, 0}});
    auto series = spin_series(solid);
    series.partner = Partner::equal_sphere;
    const auto after = run_impacts(series, before);
    for (std::size_t i = 0; i < after.size(); ++i) {
      EXPECT_EQ(after[i].velocity.x, 0);
      EXPECT_EQ(after[i].spin, before[i].spin);
      EXPECT_EQ(after[i].partner_spin, before[i].partner_spin);
      EXPECT_NEAR(after[i].velocity.z, 0.1, 1e-5);
    }
  }
  expect_small("test 7: change of spin and of tangential velocity, 34 pairs", HasFailure() ? 1 : 0, 0,
               "no slip, no tangential force: equal to the last bit");
}

}  // namespace
}  // namespace pellicle::dem
