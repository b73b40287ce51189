// The exchange of heat and vapour as a whole: exact solutions for one particle, equilibria worked out from the balances,
// and bounds that no step may break.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/heat/box_of_gas.hpp"

namespace pellicle::heat {
namespace {

using namespace tests;

constexpr Real pi = 3.14159265358979323846;
const CartesianGrid one_cell(Box{{0, 0, 0}, {0.02, 0.02, 0.02}}, {1, 1, 1});

Real sphere_mass(Real radius) { return particle_density * 4 / 3 * pi * radius * radius * radius; }
Real saturated(Real temperature) { return saturated_fraction(Buck{}, temperature, atmosphere).value; }

TEST(HeatExchange, OneParticleInConstantGasFollowsTheExactExponential) {
  HeatOptions options = make_options();
  options.evaporation = false;
  options.one_way = true;
  constexpr Real radius = 1e-3, air = 350;
  // At rest Nu = 2: H = 2 k pi d.
  const Real rate =
      2 * options.gas.conductivity * pi * 2 * radius / (sphere_mass(radius) * particle_capacity);
  for (const Real dt : {1e-3, 0.1, 20.0}) {  // the time constant is 17 s
    BoxOfGas box(one_cell, one_cell, options, {{{0.01, 0.01, 0.01}, radius, 290}}, air, 0);
    for (int n = 1; n <= 200; ++n) {
      box.step(dt);
      const Real exact = air + (290 - air) * std::exp(-rate * n * dt);
      ASSERT_NEAR((box.temperature() - 290) / (exact - 290), 1, 1e-9) << dt << " s, step " << n;
    }
  }
}

/// Gunn in a stream: H by hand. 0.2 m/s past a bead of 2 mm at rest in a void fraction of 0.99948 (one bead in 8 cm3).
TEST(HeatExchange, OneParticleInAStreamFollowsGunn) {
  HeatOptions options = make_options();
  options.nusselt = Gunn{};
  options.evaporation = false;
  options.one_way = true;
  constexpr Real radius = 1e-3, air = 350, speed = 0.2, dt = 0.01;
  const Real eps = 1 - 4. / 3 * pi * 1e-9 / 8e-6;
  const Real re = 1.2 * eps * speed * 2 * radius / options.gas.viscosity;
  const Real pr = options.gas.viscosity * options.gas.capacity / options.gas.conductivity;
  const Real nu = (7 - 10 * eps + 5 * eps * eps) * (1 + 0.7 * std::pow(re, 0.2) * std::cbrt(pr)) +
                  (1.33 - 2.4 * eps + 1.2 * eps * eps) * std::pow(re, 0.7) * std::cbrt(pr);
  const Real rate =
      nu * options.gas.conductivity * pi * 2 * radius / (sphere_mass(radius) * particle_capacity);
  BoxOfGas box(one_cell, one_cell, options, {{{0.01, 0.01, 0.01}, radius, 290}}, air, 0, {0, 0, speed});
  for (int n = 1; n <= 300; ++n) box.step(dt);
  EXPECT_NEAR((box.temperature() - air) / (290 - air), std::exp(-rate * 3), 1e-6);
  // What moves with the gas feels no stream: Nu of gas at rest.
  BoxOfGas along(one_cell, one_cell, options, {{{0.01, 0.01, 0.01}, radius, 290, {}, {0, 0, speed}}}, air, 0,
                 {0, 0, speed});
  for (int n = 1; n <= 300; ++n) along.step(dt);
  const Real still = 7 - 10 * eps + 5 * eps * eps;
  EXPECT_NEAR((along.temperature() - air) / (290 - air), std::exp(-rate * still / nu * 3), 1e-6);
}

/// Particle and gas of one cell: their difference decays with H (1/C_p + 1/C_g), exactly. The gas is implicit: first order.
TEST(HeatExchange, GasOfACellWarmsTheParticleAndCools) {
  HeatOptions options = make_options();
  options.evaporation = false;
  constexpr Real radius = 1e-3, end = 4;
  const Real particle = sphere_mass(radius) * particle_capacity;
  const Real gas = 1.2 * (8e-6 - 4. / 3 * pi * 1e-9) * options.gas.capacity;
  const Real conductance = 2 * options.gas.conductivity * pi * 2 * radius;
  const Real mean = (particle * 290 + gas * 350) / (particle + gas);
  const Real left = std::exp(-conductance * (1 / particle + 1 / gas) * end);
  const Real exact = mean + (290 - mean) * left;
  Real before = 0;
  for (const int steps : {40, 80, 160}) {
    BoxOfGas box(one_cell, one_cell, options, {{{0.01, 0.01, 0.01}, radius, 290}}, 350, 0);
    const Real energy = box.energy();
    for (int n = 0; n < steps; ++n) box.step(end / steps);
    EXPECT_NEAR(box.energy() / energy, 1, 1e-13);
    const Real error = std::abs(box.temperature() - exact);
    EXPECT_LT(error, 0.05 * std::abs(exact - 290));
    if (before > 0) {
      EXPECT_NEAR(before / error, 2, 0.1) << steps;
    }
    before = error;
  }
}

/// In constant gas of 25 degC and half saturated: down to the wet-bulb temperature, found here by bisection of the balance
/// of heat at rest, where it dries at a constant rate, then up to the temperature of the gas.
TEST(HeatExchange, WetParticleFallsToTheWetBulbDriesAndHeats) {
  HeatOptions options = make_options();
  options.one_way = true;
  constexpr Real radius = 1e-3, dt = 0.05;
  const Real vapour = cfd::humid_vapour_mass_fraction(0.5, reference, atmosphere);
  const Real heat = 2 * options.gas.conductivity * pi * 2 * radius;
  const Real transfer = 2 * 1.2 * options.gas.diffusivity * pi * 2 * radius;
  Real low = 273.15, high = reference;
  for (int n = 0; n < 60; ++n) {
    const Real t = (low + high) / 2;
    const Real latent = water.latent + (water.vapour_capacity - water.liquid_capacity) * (t - reference);
    (heat * (reference - t) > latent * transfer * (saturated(t) - vapour) ? low : high) = t;
  }
  const Real wet_bulb = low;
  const Real rate = transfer * (saturated(wet_bulb) - vapour);

  BoxOfGas box(one_cell, one_cell, options, {{{0.01, 0.01, 0.01}, radius, reference, {4e-7, 0}}}, reference,
               vapour);
  for (int n = 0; n < 2000; ++n) box.step(dt);  // 100 s, of the 370 s that the liquid lasts
  EXPECT_NEAR(box.temperature(), wet_bulb, 2e-3);
  const Real liquid = box.film().liquid;
  for (int n = 0; n < 2000; ++n) box.step(dt);
  EXPECT_NEAR((liquid - box.film().liquid) / (100 * rate), 1, 1e-3);
  // Then an exponential of the particle alone.
  for (int n = 0; n < 3700; ++n) box.step(dt);
  EXPECT_EQ(box.film().liquid, 0);
  const Real before = box.temperature();
  EXPECT_GT(before, wet_bulb + 1);
  for (int n = 0; n < 200; ++n) box.step(dt);
  const Real left = std::exp(-heat / (sphere_mass(radius) * particle_capacity) * 200 * dt);
  EXPECT_NEAR((box.temperature() - reference) / (before - reference), left, 1e-9);
}

/// The equilibrium of a closed box of air, beads and water from its balances of water and energy alone.
struct Equilibrium {
  Real temperature, vapour;
};
Equilibrium find_equilibrium(Real dry_air, Real water_mass, Real energy, Real dry_heat_capacity,
                             const HeatOptions& options) {
  const auto vapour_mass = [&](Real t) {
    const Real w = saturated(t);
    return std::min(water_mass, dry_air * w / (1 - w));
  };
  const auto energy_at = [&](Real t) {
    const Real v = vapour_mass(t);
    return (dry_air * options.gas.capacity + v * water.vapour_capacity +
            (water_mass - v) * water.liquid_capacity + dry_heat_capacity) *
               (t - reference) +
           v * water.latent;
  };
  Real low = 250, high = 372;
  for (int n = 0; n < 80; ++n) {
    const Real t = (low + high) / 2;
    (energy_at(t) < energy ? low : high) = t;
  }
  const Real v = vapour_mass(low);
  return {low, v / (v + dry_air)};
}

TEST(HeatExchange, ClosedBoxReachesItsEquilibrium) {
  const HeatOptions options = make_options();
  // Cool and wet in warm air; so little liquid that all of it evaporates; warm beads in air that they saturate.
  struct Start {
    Real particles, air, vapour, liquid;
  };
  for (const Start& start : {Start{290, 340, 0.002, 2e-7}, Start{300, 345, 0.002, 2e-8},
                             Start{330, 300, 0.01, 1e-7}, Start{285, 340, 0.08, 0}}) {
    for (const Real dt : {0.2, 5.0}) {
      std::vector<Grain> grains;
      grains.reserve(8);
      for (int i = 0; i < 8; ++i) {
        grains.push_back({{0.005 + 0.01 * (i & 1), 0.005 + 0.005 * (i & 2), 0.005 + 0.0025 * (i & 4)},
                          0.5e-3 + 0.1e-3 * i,
                          start.particles,
                          {start.liquid, 1e-8}});
      }
      BoxOfGas box(one_cell, one_cell, options, grains, start.air, start.vapour);
      const Real water_mass = box.water_mass(), energy = box.energy();
      Real beads = 0;
      for (const Grain& g : grains) {
        beads += sphere_mass(g.radius) * particle_capacity + g.film.solids * solids_capacity;
      }
      const Equilibrium expected =
          find_equilibrium(box.gas_mass(0) * (1 - start.vapour), water_mass, energy, beads, options);
      const int steps = dt < 1 ? 2500 : 300;
      for (int n = 0; n < steps; ++n) box.step(dt);
      // At rest every step rounds the same way.
      EXPECT_NEAR(box.water_mass() / water_mass, 1, 2.2e-16 * steps);
      EXPECT_NEAR(box.energy() / energy, 1, 1e-15 * steps);
      EXPECT_NEAR(box.gas().scalars[0](0) / expected.temperature, 1, 1e-6) << start.air << ", " << dt;
      EXPECT_NEAR(box.gas().scalars[1](0) / expected.vapour, 1, 1e-6) << start.air << ", " << dt;
      for (const Real t : box.temperatures()) EXPECT_NEAR(t / expected.temperature, 1, 1e-6);
    }
  }
}

/// Beads across cells of different gas, transfer grid coarser than the gas grid, steps up to 1e5 times what the smallest
/// films take to dry and ten times what the air of a cell takes to follow its beads: nothing below zero, no temperature beyond those that there were but for evaporation's cooling.
TEST(HeatExchange, StaysWithinBoundsWhateverTheStep) {
  std::mt19937_64 generator(3);
  int most_rounds = 0;
  std::uniform_real_distribution<Real> unit(0, 1);
  const CartesianGrid gas_grid(Box{{0, 0, 0}, {0.012, 0.012, 0.012}}, {6, 6, 6});
  const CartesianGrid transfer_grid(Box{{0, 0, 0}, {0.012, 0.012, 0.012}}, {2, 2, 2});
  for (const bool one_grid : {true, false}) {
    for (const bool stefan : {false, true}) {
      for (const Real dt : {1e-5, 1e-3, 0.1, 10.0}) {
        HeatOptions options = make_options();
        options.nusselt = Gunn{};
        options.stefan_flow = stefan;
        std::vector<Grain> grains;
        grains.reserve(200);
        for (int p = 0; p < 200; ++p) {
          const Vec3 place{0.012 * unit(generator), 0.012 * unit(generator), 0.012 * unit(generator)};
          const Real liquid = p % 3 == 0 ? 0 : std::pow(10, -13 + 6 * unit(generator));
          grains.push_back({place, 2e-4 + 3e-4 * unit(generator), 290 + 40 * unit(generator), {liquid, 0}});
        }
        BoxOfGas box(gas_grid, one_grid ? gas_grid : transfer_grid, options, grains, 300, 0.005);
        for (Index c = 0; c < gas_grid.cell_count(); ++c) {
          box.gas().scalars[0](c) = 290 + 60 * unit(generator);
          box.gas().scalars[1](c) = 0.01 * unit(generator);
        }
        const Real water_mass = box.water_mass(), energy = box.energy();
        for (int n = 0; n < 20; ++n) {
          box.step(dt);
          for (const Film& film : box.films()) ASSERT_GE(film.liquid, 0);
          for (const Real t : box.temperatures()) {
            ASSERT_LT(t, 350.2)
                << dt;  // 0.2 K: what the chord's end and vapour of another temperature may add
            ASSERT_GT(t, 273.15) << dt;  // the wet bulb of dry air of 290 K is 277 K
          }
          for (Index c = 0; c < gas_grid.cell_count(); ++c) {
            ASSERT_LT(box.gas().scalars[0](c), 350.2) << dt;
            ASSERT_GT(box.gas().scalars[0](c), 273.15) << dt;
            ASSERT_GE(box.gas().scalars[1](c), 0);
            ASSERT_LT(box.gas().scalars[1](c), saturated(350.2));
          }
          most_rounds = std::max(most_rounds, box.heat().rounds());
        }
        EXPECT_NEAR(box.water_mass() / water_mass, 1, 1e-12) << dt;
        EXPECT_NEAR(box.energy() / energy, 1, 1e-11) << dt;
      }
    }
  }
  EXPECT_GE(most_rounds, 2);
  EXPECT_LE(most_rounds, 10);
}

/// A drying time of a thousandth of the step: it is dry after one step and as warm as the balance says, not beyond the gas.
TEST(HeatExchange, DriesWithinAStep) {
  HeatOptions options = make_options();
  options.one_way = true;
  BoxOfGas box(one_cell, one_cell, options, {{{0.01, 0.01, 0.01}, 1e-4, 300, {3e-11, 0}}}, 340, 0.001);
  box.step(100);
  EXPECT_EQ(box.film().liquid, 0);
  EXPECT_LE(box.temperature(), 340);
  EXPECT_GT(box.temperature(), 339);
  // And a film of liquid heavier than its particle.
  BoxOfGas drop(one_cell, one_cell, options, {{{0.01, 0.01, 0.01}, 1e-4, 300, {3e-8, 0}}}, 340, 0.001);
  for (int n = 0; n < 300; ++n) {
    drop.step(5);
    ASSERT_LE(drop.temperature(), 340) << n;
    ASSERT_GT(drop.temperature(), 285) << n;
  }
  EXPECT_EQ(drop.film().liquid, 0);
}

/// A cold dry bead in humid air.
TEST(HeatExchange, VapourCondensesOnAColdParticle) {
  HeatOptions options = make_options();
  options.one_way = true;
  BoxOfGas box(one_cell, one_cell, options, {{{0.01, 0.01, 0.01}, 1e-3, 280}}, 310, 0.035);
  box.step(0.1);
  // G (w - w*) by hand at the start: Sh = 2.
  const Real transfer = 2 * 1.2 * options.gas.diffusivity * pi * 2e-3;
  EXPECT_NEAR(box.film().liquid / (0.1 * transfer * (0.035 - saturated(280))), 1, 5e-3);
  // As it warms past the dew point the liquid evaporates again.
  for (int n = 0; n < 20000; ++n) box.step(0.1);
  EXPECT_EQ(box.film().liquid, 0);
  EXPECT_NEAR(box.temperature(), 310, 1e-6);
}

}  // namespace
}  // namespace pellicle::heat
