// Long: a gas of elastic spheres through a million collisions.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/verification/dem/impacts.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using namespace tests;

/// Kinetic energy of translation and elastic energy of the contacts (Hertz), by all pairs [J].
Real total_energy(const std::vector<Grain>& all, Real width, Real pair_modulus) {
  Real kinetic = 0, elastic = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    kinetic += 0.5 * all[i].mass * norm_squared(all[i].velocity);
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      Vec3 d = all[j].position - all[i].position;
      for (int axis = 0; axis < 3; ++axis) d[axis] -= width * std::round(d[axis] / width);
      const Real overlap = 2 * all[i].radius - norm(d);
      if (overlap > 0)
        elastic += 8.0 / 15.0 * pair_modulus * std::sqrt(all[i].radius / 2) * std::pow(overlap, 2.5);
    }
  }
  return kinetic + elastic;
}

TEST(ElasticGas, EnergyOverAMillionCollisions) {
  const Real radius = 0.0015;
  const int count = 500;
  const Solid glass{1e7, 0.25, 2500};
  const Real width = 0.036;  // solids fraction 0.15
  const Real spread =
      1 / std::sqrt(3.0);  // standard deviation of a velocity component that is uniform in ±1 m/s
  const HertzImpact at_one{sphere_mass(glass, radius) / 2, wall_modulus(glass) / 2, radius / 2, 1.0};
  const Real step = at_one.contact_time() / 40;
  auto setup = glass_setup({width, width, width}, step, 1, 0);
  setup.domain.periodic = {1, 1, 1};
  const auto centres = scatter({{0, 0, 0}, {width - 2 * radius, width - 2 * radius, width - 2 * radius}},
                               std::vector<Real>(count, radius), 0, 91);
  std::vector<ParticleSeed> seeds;
  for (int p = 0; p < count; ++p) {
    seeds.push_back({centres[static_cast<std::size_t>(p)], random_vector(92, p), {}, radius, 0, false});
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  const Real start = total_energy(grains(engine.particles()), width, at_one.modulus);
  const Vec3 momentum = engine.compute_totals().momentum;
  // A contact lasts t(1 m/s) v^(-1/5); for a Maxwell gas the normal speeds at impact are Rayleigh's with the scale
  // √2 σ, whose mean of v^(-1/5) is (2σ)^(-1/5) Γ(0.9).
  const Real mean_time = at_one.contact_time() * std::pow(2 * spread, -0.2) * std::tgamma(0.9);
  core::CsvTable curve{{"collisions", "energy / initial energy - 1"}, {{0}, {0}}};
  Real collisions = 0, largest = 0;
  const int samples = 4;  // of the contacts, in each block of 10 steps of which every second is watched
  for (int block = 0; collisions < 1e6; ++block) {
    engine.prepare_outer_step();
    Real touching = 0;
    for (int s = 0; s < samples; ++s) {
      advance(engine, 5);
      touching += static_cast<Real>(engine.collect_report().touching_pairs);
    }
    collisions += touching / samples * (5 * samples * step) / mean_time;
    if (block % 100 == 99) {
      const Real error = total_energy(grains(engine.particles()), width, at_one.modulus) / start - 1;
      largest = std::max(largest, std::abs(error));
      curve.columns[0].push_back(collisions);
      curve.columns[1].push_back(error);
      ASSERT_LT(block, 200000);
    }
  }
  Real last = 0;  // mean of the last tenth: without the ripple of the contacts of the moment
  const std::size_t tenth = curve.rows() / 10;
  for (std::size_t i = curve.rows() - tenth; i < curve.rows(); ++i) last += curve.columns[1][i];
  last /= static_cast<Real>(tenth);
  keep_curve("elastic_gas", curve);
  expect_small("elastic gas, 500 spheres, 1e6 collisions: largest relative deviation of the energy", largest,
               1e-3, "asked for; 40 steps a contact, kinetic and elastic energy at any moment");
  record_line("elastic gas: relative drift of the energy over 1e6 collisions", "0", last,
              "mean of the last tenth; velocity-Verlet has no dissipation of its own");
  const Vec3 lost = engine.compute_totals().momentum - momentum;
  Real gross = 0;
  for (const Grain& g : grains(engine.particles())) gross += g.mass * norm(g.velocity);
  expect_small("elastic gas: momentum lost, over the sum of magnitudes", norm(lost) / gross, 1e-13,
               "exactly opposite forces; a sum of 1e6 steps with 1e-16 each, random signs");
}

}  // namespace
}  // namespace pellicle::dem
