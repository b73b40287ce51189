// A free cluster of grains that press, slide and roll on each other: what no law may change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "tests/verification/dem/impacts.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using namespace tests;

/// Every law of a family, by its default.
template <class Variant, std::size_t... I>
std::vector<Variant> all_of(std::index_sequence<I...>) {
  return {Variant{std::variant_alternative_t<I, Variant>{}}...};
}
template <class Variant>
std::vector<Variant> all_of() {
  return all_of<Variant>(std::make_index_sequence<std::variant_size_v<Variant>>{});
}

TEST(Cluster, KeepsMomentumAndAngularMomentumUnderAnyLaws) {
  // Grains of two materials and many sizes fly into each other, spinning. In 400 steps each sum gets 400 additions of
  // rounding 1e-16 of the gross amount, with random signs: some 2e-15.
  const int count = 100;
  std::vector<Real> radii;
  for (int p = 0; p < count; ++p) radii.push_back(0.001 + 0.0005 * random_vector(131, p).x);
  const auto centres = scatter({{-0.006, -0.006, -0.006}, {0.006, 0.006, 0.006}}, radii, 0.05, 132);
  std::vector<ParticleSeed> seeds;
  for (int p = 0; p < count; ++p) {
    const auto i = static_cast<std::size_t>(p);
    seeds.push_back({centres[i], -100.0 * centres[i] + random_vector(133, p), 200.0 * random_vector(134, p),
                     radii[i], p % 3 == 0 ? 2 : 0, false});
  }
  Real momentum = 0, angular = 0;
  std::size_t combinations = 0;
  for (const NormalLaw& normal : all_of<NormalLaw>()) {
    for (const TangentialLaw& tangential : all_of<TangentialLaw>()) {
      for (const RollingLaw& rolling : all_of<RollingLaw>()) {
        auto setup = glass_setup({0.1, 0.1, 0.1}, 2e-6);
        setup.domain.box = {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}};
        setup.materials.push_back({"heavy", 8000, 2e7, 0.3, false});
        setup.pairs = {{0, 0, 0.8, 0.4, 0.02, 2e3}, {0, 2, 0.7, 0.3, 0.05, 3e3}, {2, 2, 0.6, 0.5, 0.01, 4e3}};
        setup.contacts.normal = normal;
        setup.contacts.tangential = tangential;
        setup.contacts.rolling = rolling;
        setup.contacts.overlap_limit = 1;
        Engine engine(setup);
        engine.set_particles(seeds);
        const ParticleTotals start = engine.compute_totals();
        std::int64_t contacts = 0;
        Real gross = 0, angular_gross = 0;
        for (int block = 0; block < 40; ++block) {
          if (block % 10 == 0) engine.prepare_outer_step();
          advance(engine, 10);
          contacts += engine.collect_report().touching_pairs;
        }
        for (const Grain& s : grains(engine.particles())) {
          gross += s.mass * norm(s.velocity);
          angular_gross += norm(s.mass * cross(s.position, s.velocity)) +
                           0.4 * s.mass * s.radius * s.radius * norm(s.spin);
        }
        const ParticleTotals end = engine.compute_totals();
        EXPECT_GT(contacts, 500);
        momentum = std::max(momentum, norm(end.momentum - start.momentum) / gross);
        angular = std::max(angular, norm(end.angular_momentum - start.angular_momentum) / angular_gross);
        ++combinations;
      }
    }
  }
  const std::string what = "free cluster, " + std::to_string(combinations) + " combinations of laws: ";
  const std::string why = "exactly opposite forces; 400 sums of rounding 1e-16 each";
  expect_small(what + "momentum lost, over the sum of magnitudes", momentum, 1e-14, why);
  expect_small(what + "angular momentum lost, over the sum of magnitudes", angular, 1e-14,
               why + "; lever arms add up to the distance");
}

}  // namespace
}  // namespace pellicle::dem
