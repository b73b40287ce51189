// The contact loop of a CPU finds forces in single precision: how far they are from double precision, and that both forms
// of the loop agree over a bed.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "dem/contact_force.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

/// A number between -1 and 1.
Real uniform(std::uint64_t key, std::uint64_t index) {
  return 2 * core::random_uniform(20261122, static_cast<core::Purpose>(77), static_cast<std::int64_t>(key),
                                  static_cast<std::int64_t>(index)) -
         1;
}

Vec3 random_vector(std::uint64_t key, std::uint64_t index) {
  return {uniform(3 * key, index), uniform(3 * key + 1, index), uniform(3 * key + 2, index)};
}

constexpr Real time_step = 1e-5;
constexpr Real density = 2500;

/// Pairs of sizes up to 30 to 1, overlaps of 1e-7 to 0.1 radii, spins that turn much faster than the pair moves.
PairState<Real> random_pair(std::uint64_t index, Vec3& spin_i, Vec3& spin_j) {
  const Real ri = 1e-3;
  const Real rj = ri * std::pow(30.0, uniform(0, index));
  const Real overlap = std::min(ri, rj) * std::pow(10.0, -4 + 3 * uniform(1, index));
  const Vec3 n = random_vector(1, index);
  const Vec3 d = ((ri + rj - overlap) / norm(n)) * n;
  const auto inverse_mass = [](Real r) { return 1 / (density * 4 / 3 * M_PI * r * r * r); };
  spin_i = 300.0 * random_vector(2, index);
  spin_j = 300.0 * random_vector(3, index);
  PairState<Real> pair{d,
                       (ri + rj) * (ri + rj) - norm_squared(d),
                       ri,
                       rj,
                       0.5 * random_vector(4, index),
                       spin_i + spin_j,
                       spin_i - spin_j,
                       inverse_mass(ri) + inverse_mass(rj)};
  pair.spin_compliance =
      spin_compliance_of(4, inverse_mass(ri), ri) + spin_compliance_of(6, inverse_mass(rj), rj);
  return pair;
}

PairState<float> round_pair(const PairState<Real>& p) {
  const auto f = [](Real x) { return static_cast<float>(x); };
  return {convert<float>(p.d),
          f(p.gap),
          f(p.ri),
          f(p.rj),
          convert<float>(p.dv),
          convert<float>(p.spin_sum),
          convert<float>(p.spin_difference),
          f(p.inverse_mass_sum),
          f(p.spin_compliance)};
}

/// Largest error of force and torque of all pairs, in terms of what they are summed up from.
template <class Laws>
Real largest_error(const Laws& laws) {
  PairParameters parameters;
  parameters.effective_youngs_modulus = 5e6;
  parameters.effective_shear_modulus = 1.1e6;
  parameters.damping_ratio = 0.122;
  parameters.tangential_stiffness_ratio = 0.88;
  parameters.tangential_damping_ratio = 2 * std::sqrt(0.88);
  parameters.sliding_friction = 0.3;
  parameters.rolling_friction = 0.05;
  parameters.normal_stiffness = 2000;
  Real largest = 0;
  for (std::uint64_t index = 0; index < 20000; ++index) {
    Vec3 spin_i;
    Vec3 spin_j;
    const PairState<Real> pair = random_pair(index, spin_i, spin_j);
    ContactSprings springs;
    const Vec3 n = (1 / norm(pair.d)) * pair.d;
    const Vec3 slip = 1e-6 * random_vector(5, index);
    springs.tangential = slip - dot(slip, n) * n;
    springs.rolling = 1e-3 * springs.tangential;
    ContactSprings rounded = springs;
    const PairForce<Real> exact = find_pair_force(laws, parameters, pair, springs);
    const PairForce<float> force =
        find_pair_force(laws, convert<float>(parameters), round_pair(pair), rounded);
    const ContactState c{exact.overlap, pair.ri * pair.rj / (pair.ri + pair.rj), 1 / pair.inverse_mass_sum,
                         0};
    const NormalForce at_rest = laws.normal(c, parameters);
    // What the force would be if velocities did not cancel: of surfaces, |v| + |r ω| of both.
    const Real speed = norm(pair.dv) + pair.ri * norm(spin_i) + pair.rj * norm(spin_j);
    const Real stiffness = parameters.tangential_stiffness_ratio * at_rest.stiffness;
    const Real scale = at_rest.force + at_rest.damping * norm(pair.dv) +
                       parameters.tangential_damping_ratio * at_rest.stiffness_mass_root * speed +
                       stiffness * time_step * speed;
    const auto whole = [&](const auto& f) {
      return convert<Real>(f.friction) - static_cast<Real>(f.pull) * pair.d;
    };
    largest = std::max(largest, norm(whole(force) - whole(exact)) / scale);
    if constexpr (Laws::rolls) {
      const Real turning = c.reduced_radius *
                           (scale + stiffness * c.reduced_radius * time_step * (norm(spin_i) + norm(spin_j)));
      largest = std::max(largest, norm(convert<Real>(force.rolling_torque) - exact.rolling_torque) / turning);
    }
    largest =
        std::max(largest, norm(rounded.tangential - springs.tangential) / (norm(slip) + time_step * speed));
    EXPECT_NEAR(force.overlap, exact.overlap, 1e-6 * exact.overlap);
    EXPECT_NEAR(force.skew, exact.skew, 1e-6);
  }
  return largest;
}

TEST(ContactPrecision, SinglePrecisionIsCloseToDouble) {
  // A force is the end of a chain of at most 40 operations, each of which rounds by 2^-24 of terms that are no larger than
  // the scale: 40 × 6e-8 = 2.4e-6. (The bound asked for is 1e-5.)
  const Real bound = 2.4e-6;
  const auto check = [&](const auto& normal, const auto& tangential, const auto& rolling) {
    using Laws = ContactLaws<std::decay_t<decltype(normal)>, std::decay_t<decltype(tangential)>,
                             std::decay_t<decltype(rolling)>>;
    const Real error = largest_error(Laws{normal, tangential, rolling});
    EXPECT_LT(error, bound) << normal.info.name << ' ' << tangential.info.name << ' ' << rolling.info.name;
    // A loop that computed in double precision after all would not need to be tested.
    EXPECT_GT(error, 1e-9) << normal.info.name << ' ' << tangential.info.name << ' ' << rolling.info.name;
  };
  const ViscousCoulomb viscous{time_step};
  const Mindlin mindlin{time_step};
  const MindlinDeresiewicz softening{time_step};
  check(Hertz{true}, viscous, NoRolling{});
  check(Hertz{true}, viscous, ConstantTorque{time_step});
  check(Hertz{false}, viscous, Epsd2{time_step});
  check(Hertz{true}, mindlin, NoRolling{});
  check(Hertz{true}, mindlin, Epsd2{time_step});
  check(Hertz{true}, softening, NoRolling{});
  check(Linear{true}, viscous, ConstantTorque{time_step});
  check(Linear{true}, mindlin, Epsd2{time_step});
  check(Linear{true}, softening, Epsd2{time_step});
}

TEST(ContactPrecision, ASpringAtRestKeepsWhatItHas) {
  // 1e5 steps in which nothing moves: rounding must not wear the spring away. In double precision each step rounds by 1e-16
  // of it.
  const ContactLaws<Hertz, Mindlin, NoRolling> laws{Hertz{true}, Mindlin{time_step}, NoRolling{}};
  PairParameters parameters;
  parameters.effective_youngs_modulus = 5e6;
  parameters.tangential_stiffness_ratio = 0.88;
  parameters.tangential_damping_ratio = 2 * std::sqrt(0.88);
  parameters.sliding_friction = 0.3;
  Vec3 spin_i;
  Vec3 spin_j;
  PairState<Real> pair = random_pair(7, spin_i, spin_j);
  pair.dv = pair.spin_sum = pair.spin_difference = Vec3{};
  const Vec3 n = (1 / norm(pair.d)) * pair.d;
  const Vec3 slip{1e-9, 2e-9, -1e-9};
  ContactSprings springs;
  springs.tangential = slip - dot(slip, n) * n;
  const PairState<float> rounded = round_pair(pair);
  const PairParametersOf<float> rounded_parameters = convert<float>(parameters);
  const Vec3 start = springs.tangential;
  for (int step = 0; step < 100000; ++step) {
    find_pair_force(laws, rounded_parameters, rounded, springs);
  }
  // Once it is turned into the plane across a normal known to 1e-7.
  EXPECT_LT(norm(springs.tangential - start), 3e-7 * norm(start));
}

}  // namespace
}  // namespace pellicle::dem
