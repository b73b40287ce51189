// Droplets that evaporate in flight: wet-bulb temperature and d2 law by themselves, and in a box where every gram and joule
// is looked for.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/checkpoint.hpp"
#include "spray/droplet_evaporation_laws.hpp"
#include "spray/droplet_gas.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/spray/rig.hpp"

namespace pellicle::spray {
namespace {

using tests::fixed_bead;
using tests::needle;
using tests::Rig;

DropletHeat water_in_air() {
  DropletHeat heat;
  heat.on = true;
  heat.water = {298.15, 2.4417e6, 1872, 4181};
  heat.solids_capacity = 1300;
  heat.dry_capacity = 1007;
  heat.conductivity = 0.0263;
  heat.diffusivity = 2.6e-5;
  heat.pressure = 101325;
  return heat;
}

/// Vapour mass fraction above water at a temperature [K]: Buck's pressure, and Dalton's law (M 18.015 and 28.965).
Real saturated(Real temperature) {
  const Real t = temperature - 273.15;
  const Real x = 611.21 * std::exp((18.678 - t / 234.5) * (t / (257.14 + t))) / 101325;
  return x * 18.015 / (x * 18.015 + (1 - x) * 28.965);
}

/// Where a droplet's heat and vapour balance with Nu = Sh = 2: k (T - y) = rho D L(y) (w*(y) - w).
Real wet_bulb(Real gas_temperature, Real vapour, Real density) {
  Real low = 250, high = gas_temperature;
  for (int round = 0; round < 80; ++round) {
    const Real y = 0.5 * (low + high);
    const Real latent = 2.4417e6 + (1872 - 4181) * (y - 298.15);
    const Real pull = 0.0263 * (gas_temperature - y) - density * 2.6e-5 * latent * (saturated(y) - vapour);
    (pull > 0 ? low : high) = y;
  }
  return low;
}

/// One droplet of 40 um that begins at 298.15 K, in gas that stays as it is.
struct LoneDroplet {
  DropletHeat heat = water_in_air();
  DropletLoad load{};
  Real density = 1000, solids_density = 1250, mass = 0, enthalpy = 0;

  explicit LoneDroplet(Real solids_fraction) {
    mass = density * M_PI / 6 * 64e-15;
    load = {(1 - solids_fraction) * mass, solids_fraction * mass, 0, 40e-6, 1};
  }
  void step(const DropletSurroundings& gas, Real slip, Real time) {
    const DropletExchange got = exchange_of(heat, load, gas, slip, time);
    enthalpy += got.heat - got.evaporated * heat.water.vapour(298.15 + load.warmth);
    load.liquid -= got.evaporated;
    if (load.liquid + load.solids > 0) load.warmth = enthalpy / heat.capacity(load.liquid, load.solids);
    load.diameter = std::cbrt(6 / M_PI * (load.liquid / density + load.solids / solids_density));
  }
};

TEST(DropletEvaporation, WetBulbAndTheSquareOfTheDiameter) {
  const DropletSurroundings gas{1.1, 1.9e-5, 333.15 - 298.15, 0.005};
  LoneDroplet droplet(0);
  // Its time constant is some 10 ms; the square of the diameter then falls by 8 rho D (w* - w) / rho_liquid.
  for (int k = 0; k < 600; ++k) droplet.step(gas, 0, 1e-4);
  const Real expected = wet_bulb(333.15, 0.005, 1.1);
  EXPECT_NEAR(298.15 + droplet.load.warmth, expected, 1e-3);
  const Real before = droplet.load.diameter * droplet.load.diameter;
  for (int k = 0; k < 500; ++k) droplet.step(gas, 0, 1e-4);
  const Real fell = before - droplet.load.diameter * droplet.load.diameter;
  const Real rate = 8 * 1.1 * 2.6e-5 * (saturated(expected) - 0.005) / 1000;
  // A step's loss is that of its beginning's diameter: first order in 1e-4 s over the lifetime of some 0.5 s.
  EXPECT_NEAR(fell / 0.05, rate, 2e-3 * rate);
  EXPECT_GT(droplet.load.liquid, 0.2 * droplet.mass);
}

// A drop of 1 mm at 3 m/s against steady wet-bulb temperatures with Stefan's flow and film properties, calculated apart from
// this code: 20 and 30 degC dry, 40 degC with 4.565 g/kg. Conductivity and diffusivity of air here are rounded values at the
// film temperature, 2 % apart between handbooks: that is 0.3 K of depressions of 15 to 22 K.
TEST(DropletEvaporation, WetBulbOfADropInWind) {
  struct Row {
    Real dry, humidity, drop;  // [degC], kg vapour per kg dry air
    Real density, viscosity, conductivity, diffusivity;
  };
  for (const Row& row : {Row{20, 0, 5.0066355, 1.235, 1.78e-5, 0.02530, 2.36e-5},
                         Row{30, 0, 9.5682485, 1.205, 1.81e-5, 0.02570, 2.44e-5},
                         Row{40, 0.0045653234, 17.76401, 1.165, 1.86e-5, 0.02635, 2.57e-5}}) {
    LoneDroplet drop(0);
    drop.heat.stefan_flow = true;
    drop.heat.conductivity = row.conductivity;
    drop.heat.diffusivity = row.diffusivity;
    const Real mass = drop.density * M_PI / 6 * 1e-9;
    drop.load = {mass, 0, 0, 1e-3, 1};
    const DropletSurroundings gas{row.density, row.viscosity, row.dry - 25,
                                  row.humidity / (1 + row.humidity)};
    for (int k = 0; k < 3000; ++k) drop.step(gas, 3, 1e-2);
    ASSERT_GT(drop.load.liquid, 0.2 * mass);
    EXPECT_NEAR(25 + drop.load.warmth, row.drop, 0.3) << row.dry;
  }
}

TEST(DropletEvaporation, SlipAndStefanFlowMakeItFaster) {
  const DropletSurroundings gas{1.1, 1.9e-5, 333.15 - 298.15, 0.005};
  LoneDroplet still(0), moving(0), stefan(0);
  stefan.heat.stefan_flow = true;
  for (int k = 0; k < 10; ++k) {
    still.step(gas, 0, 1e-5);
    moving.step(gas, 10, 1e-5);
    stefan.step(gas, 0, 1e-5);
  }
  const Real loss = still.mass - still.load.liquid;
  // Ranz and Marshall: Re = 1.1 10 40e-6 / 1.9e-5, Sc = 1.9e-5 / (1.1 2.6e-5); warmer by 0.1 K at most meanwhile.
  const Real sherwood = 2 + 0.6 * std::sqrt(1.1 * 10 * 40e-6 / 1.9e-5) * std::cbrt(1.9e-5 / (1.1 * 2.6e-5));
  EXPECT_NEAR((moving.mass - moving.load.liquid) / loss, sherwood / 2, 0.02 * sherwood / 2);
  const Real b = (saturated(298.15) - 0.005) / (1 - saturated(298.15));
  EXPECT_NEAR((stefan.mass - stefan.load.liquid) / loss, std::log1p(b) / (saturated(298.15) - 0.005), 1e-4);
}

TEST(DropletEvaporation, ShrinksToItsSolidsAndStaysThere) {
  const DropletSurroundings gas{1.0, 2e-5, 373.15 - 298.15, 0.0};
  for (const Real step : {1e-4, 1e-2, 1.0}) {
    LoneDroplet droplet(0.2);
    for (Real t = 0; t < 2; t += step) {
      droplet.step(gas, 0, step);
      ASSERT_GE(droplet.load.liquid, 0);
      ASSERT_LE(droplet.load.warmth, gas.warmth * (1 + 1e-9)) << step;
      ASSERT_GT(droplet.load.warmth, -30) << step;
    }
    EXPECT_EQ(droplet.load.liquid, 0) << step;
    // (0.2 1000 / 1250)^(1/3) of 40 um, as warm as the gas.
    EXPECT_NEAR(droplet.load.diameter, 40e-6 * std::cbrt(0.16), 1e-15);
    EXPECT_NEAR(droplet.load.warmth, gas.warmth, 1e-3);
  }
}

// --- in a box --------------------------------------------------------------------------------------------------

constexpr Real side = 0.02;

/// One cell of gas, closed: heat and vapour in it are as they are given.
struct ClosedGas {
  CartesianGrid grid{{{0, 0, 0}, {side, side, side}}, {1, 1, 1}};
  cfd::GasState state;
  HostArray<Real> volume{"test::volume", 1};
  Real dry, vapour, heat;  ///< [kg], [kg], [J]

  ClosedGas(Real temperature, Real fraction) {
    state.velocity = HostArray<Vec3>("test::velocity", 1);
    state.density = HostArray<Real>("test::density", 1);
    state.void_fraction = HostArray<Real>("test::void_fraction", 1);
    for (const cfd::Scalar s : {cfd::Scalar::temperature, cfd::Scalar::moisture})
      state.scalars[index_of(s)] = HostArray<Real>("test::scalar", 1);
    volume(0) = grid.volume(0, 0, 0);
    state.void_fraction(0) = 1;
    dry = (1 - fraction) * 1.1 * volume(0);
    vapour = fraction * 1.1 * volume(0);
    heat = (dry * 1007 + vapour * 1872) * (temperature - 298.15);
    update();
  }
  void update() {
    state.density(0) = (dry + vapour) / volume(0);
    state.scalars[index_of(cfd::Scalar::moisture)](0) = vapour / (dry + vapour);
    state.scalars[index_of(cfd::Scalar::temperature)](0) = 298.15 + heat / (dry * 1007 + vapour * 1872);
  }
  Real temperature() const { return state.scalars[index_of(cfd::Scalar::temperature)](0); }
  Real fraction() const { return state.scalars[index_of(cfd::Scalar::moisture)](0); }
  void take(const DropletGas& droplets, Real step) {
    cfd::ParticleExchange exchange = cfd::make_empty_exchange(grid);
    droplets.add_to(exchange);
    const Real came = step * volume(0) * exchange.scalars[index_of(cfd::Scalar::moisture)].rate(0);
    EXPECT_EQ(exchange.mass_source(0), exchange.scalars[index_of(cfd::Scalar::moisture)].rate(0));
    vapour += came;
    heat += step * volume(0) * exchange.scalars[index_of(cfd::Scalar::temperature)].rate(0);
    const Real mass = dry + vapour;
    const Vec3 before = (mass - came) * state.velocity(0);
    state.velocity(0) =
        1 / mass *
        (before + step * volume(0) * (exchange.explicit_force(0) + exchange.mass_source_momentum(0)));
    update();
  }
};

struct WetBox {
  ClosedGas gas;
  SprayOptions options;
  Rig rig;
  DropletGas droplets;

  static SprayOptions mist(Real droplets_per_parcel, Real solids_fraction, Real nozzle_temperature,
                           Real diameter = 30e-6) {
    SprayOptions made;
    made.nozzles = {needle({0.003, 0.004, 0.005}, {0.6, 0, 0.8}, 5, diameter)};
    made.nozzles[0].droplets_per_parcel = droplets_per_parcel;
    made.nozzles[0].mass_rate *= 5 * droplets_per_parcel;  // 50 in 0.1 ms
    made.nozzles[0].to = 1e-4;
    made.nozzles[0].solids_fraction = solids_fraction;
    made.nozzles[0].temperature = nozzle_temperature;
    made.watch_momentum = true;
    made.heat = water_in_air();
    made.solids_density = 1250;
    return made;
  }
  static dem::EngineSetup box() {
    dem::EngineSetup setup = tests::glass_setup({side, side, side}, 1e-5);
    setup.domain.periodic = {1, 1, 1};
    return setup;
  }
  WetBox(Real temperature, Real fraction, const SprayOptions& spray_options, int substeps = 10)
      : gas(temperature, fraction),
        options(spray_options),
        rig(box(), {fixed_bead({0.019, 0.001, 0.019}, 1e-5)}, options, substeps),
        droplets(make(gas, rig.spray)) {
    rig.droplets = &droplets;
    rig.gas_temperature = DeviceArray<Real>("test::gas_temperature", 1);
  }
  static DropletGas make(const ClosedGas& gas, const Spray& spray) {
    ParcelGas around;
    around.drag = {1.1, 1.9e-5};
    around.grid = coupling::GridLocator(gas.grid);
    return {{.two_way = true, .heat = water_in_air()}, around, gas.volume, spray.units(), {}};
  }
  void step() {
    droplets.sample(gas.state);
    rig.outer_step();
    gas.take(droplets, rig.substeps * 1e-5);
  }
  /// Of gas and droplets, as the ledger counts it: vapour with the latent heat at the reference [J].
  Real energy() const { return gas.heat + 2.4417e6 * gas.vapour + rig.spray.heat().in_flight; }
};

/// Liquid [kg] and temperature [K] of one droplet at rest in gas that stays as it is, by Runge and Kutta:
///   dm/dt = -2 pi d rho D (w*(y) - w),  (m c + m_s c_s) dy/dt = 2 pi d k (T - y) + L(y) dm/dt,  d from m and m_s.
struct FreeDroplet {
  Real solids, liquid_density, solids_density;
  Real gas_temperature, vapour, density;

  std::array<Real, 2> rates(const std::array<Real, 2>& now) const {
    const Real d = std::cbrt(6 / M_PI * (now[0] / liquid_density + solids / solids_density));
    const Real loss = 2 * M_PI * d * density * 2.6e-5 * (saturated(now[1]) - vapour);
    const Real latent = 2.4417e6 + (1872 - 4181) * (now[1] - 298.15);
    return {-loss, (2 * M_PI * d * 0.0263 * (gas_temperature - now[1]) - latent * loss) /
                       (now[0] * 4181 + solids * 1300)};
  }
  std::array<Real, 2> after(std::array<Real, 2> now, Real time, int steps) const {
    const Real h = time / steps;
    const auto moved = [](const std::array<Real, 2>& a, Real by, const std::array<Real, 2>& rate) {
      return std::array<Real, 2>{a[0] + by * rate[0], a[1] + by * rate[1]};
    };
    for (int k = 0; k < steps; ++k) {
      const auto k1 = rates(now), k2 = rates(moved(now, h / 2, k1)), k3 = rates(moved(now, h / 2, k2));
      const auto k4 = rates(moved(now, h, k3));
      for (std::size_t i = 0; i < 2; ++i) now[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    return now;
  }
};

// One droplet of 30 um at rest, 20 % solids, from 293.15 K, in so much gas that it notices nothing (1e-6 of it); it lives for
// 0.15 s. The flight takes the diameter of the beginning of each move of 1e-4 s: off by some 1e-3.
TEST(DropletEvaporation, AFreeDropletFollowsItsEquations) {
  SprayOptions options = WetBox::mist(1, 0.2, 293.15);
  options.nozzles[0].speed = 0;
  options.nozzles[0].mass_rate = options.nozzles[0].mass_rate / 50;  // one
  WetBox box(350, 0.004, options);
  const Real mass = 1000 * M_PI / 6 * 27e-15;
  // Volumes add up: 0.2/1250 + 0.8/x = 1/1000.
  const FreeDroplet free{0.2 * mass, 0.8 / (1e-3 - 0.2 / 1250), 1250, 350, 0.004, 1.1};
  box.step();
  // It leaves when half its mass has come out, 0.05 ms after the nozzle opens.
  for (const Real until : {2e-3, 10e-3, 40e-3, 80e-3}) {
    while (box.rig.time() < until - 1e-9) box.step();
    ASSERT_EQ(box.rig.spray.parcels().count, 1);
    const auto expected = free.after({0.8 * mass, 293.15}, until - 0.5e-4, 4000);
    const NozzleFigures f = box.rig.spray.figures()[0];
    const Real liquid = f.in_flight - f.in_flight_solids;
    EXPECT_NEAR(liquid, expected[0], 2e-3 * 0.8 * mass) << until;
    EXPECT_LT(expected[0], 0.8 * mass * (1 - 2 * until));
    const Real temperature = 298.15 + box.rig.spray.heat().in_flight / (liquid * 4181 + 0.2 * mass * 1300);
    // Within its first milliseconds it changes by a few K a millisecond, a move being 0.1 ms.
    EXPECT_NEAR(temperature, expected[1], 0.1) << until;
  }
}

// 50 parcels of 1e5 droplets, 7e-5 kg in all, are many times what the gas can take up: it ends saturated, as cold as they are.
TEST(DropletEvaporation, EveryGramAndJouleInAClosedBox) {
  WetBox box(330, 0.005, WetBox::mist(1e5, 0.2, 310));
  const Real vapour = box.gas.vapour;
  const Real energy = box.gas.heat + 2.4417e6 * vapour;
  for (int k = 0; k < 600; ++k) {
    box.step();
    const NozzleFigures f = box.rig.spray.figures()[0];
    ASSERT_NEAR(box.gas.vapour - vapour, f.evaporated, 1e-13 * f.injected) << k;
    ASSERT_NEAR(f.in_flight + f.evaporated + f.captured, f.injected, 1e-13 * f.injected);
    ASSERT_NEAR(f.in_flight_solids + f.captured_solids, 0.2 * f.injected, 1e-13 * f.injected);
    const SprayHeat heat = box.rig.spray.heat();
    // Heat is rounded to 2^-24 J/kg times a parcel's 1.4e-6 kg, twice for each of 30,000 exchanges: 1e-11 J at random.
    ASSERT_NEAR(box.energy() + heat.enthalpy, energy + heat.injected, 4e-11) << k;
    const ParcelMomentum p = box.rig.spray.momentum();
    const Vec3 total = (box.gas.dry + box.gas.vapour) * box.gas.state.velocity(0) + p.in_flight + p.captured;
    // The momentum of vapour is rounded to 2^-34 m/s times a parcel's mass, 50 times a step: of 5 m/s, 2e-12 to 2e-10 after
    // 600 steps, as errors add at random or all one way.
    ASSERT_LT(norm(total - p.injected), 2e-10 * norm(p.injected));
    ASSERT_LT(box.gas.fraction(), saturated(box.gas.temperature() + 12));
  }
  const NozzleFigures f = box.rig.spray.figures()[0];
  // 4181 J/kg/K 0.8 + 1300 0.2 of what was injected at 310 K.
  EXPECT_NEAR(box.rig.spray.heat().injected, f.injected * (0.8 * 4181 + 0.2 * 1300) * (310 - 298.15),
              1e-9 * box.rig.spray.heat().injected);
  EXPECT_GT(f.evaporated, 0);
  EXPECT_EQ(f.dried, 0);
  EXPECT_NEAR(box.gas.fraction(), saturated(box.gas.temperature()), 1e-3 * box.gas.fraction());
  const Real droplets = box.rig.spray.heat().in_flight /
                        ((f.in_flight - f.in_flight_solids) * 4181 + f.in_flight_solids * 1300);
  EXPECT_NEAR(298.15 + droplets, box.gas.temperature(), 0.05);
}

// The gas that droplets see changes with what they gave, move by move: a gas step of 100 moves leaves what 100 of one do. Dense
// mist that cools the gas by more than 10 K in 20 ms.
TEST(DropletEvaporation, LongGasStepsSeeTheGasThatDropletsMade) {
  WetBox fine(330, 0.005, WetBox::mist(1e5, 0.2, 290), 1),
      coarse(330, 0.005, WetBox::mist(1e5, 0.2, 290), 100);
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 100; ++j) fine.step();
    coarse.step();
  }
  const Real cooled = 330 - fine.gas.temperature(), wetter = fine.gas.fraction() - 0.005;
  EXPECT_GT(cooled, 10);
  EXPECT_GT(wetter, 2e-3);
  // What is kept back until the step's end is the change of the heat capacity with the vapour, and the rounding of the mean.
  EXPECT_NEAR(coarse.gas.temperature(), fine.gas.temperature(), 0.02 * cooled);
  EXPECT_NEAR(coarse.gas.fraction(), fine.gas.fraction(), 0.02 * wetter);
}

// Few droplets in hot dry gas: all become dust, which is as large as its solids.
TEST(DropletEvaporation, DropletsBecomeDust) {
  WetBox box(373, 0.0, WetBox::mist(100, 0.2, 293.15, 15e-6));
  for (int k = 0; k < 500; ++k) box.step();
  const NozzleFigures f = box.rig.spray.figures()[0];
  EXPECT_NEAR(f.evaporated, 0.8 * f.injected, 1e-12 * f.injected);
  EXPECT_NEAR(f.dried, 0.2 * f.injected, 1e-12 * f.injected);
  EXPECT_EQ(f.dust_captured, 0);
  const Parcels& parcels = box.rig.spray.parcels();
  ASSERT_GT(parcels.count, 45);
  EXPECT_NEAR(parcels.state(0).diameter, 15e-6 * std::cbrt(0.2 * 1000 / 1250), 1e-13);
}

TEST(DropletEvaporation, DropletsWithoutSolidsVanish) {
  WetBox box(373, 0.0, WetBox::mist(100, 0, 293.15, 15e-6));
  for (int k = 0; k < 700; ++k) box.step();
  const NozzleFigures f = box.rig.spray.figures()[0];
  EXPECT_EQ(box.rig.spray.parcels().count, 0);
  EXPECT_EQ(box.rig.spray.heat().in_flight, 0);
  EXPECT_EQ(f.in_flight, 0);
  EXPECT_NEAR(f.evaporated, f.injected, 1e-12 * f.injected);
  EXPECT_EQ(f.dried, 0);
}

// A bead of 1 mm catches droplets that come with 350 K into gas of 300 K: what they bring is their own heat.
TEST(DropletEvaporation, CapturedDropletsBringTheirOwnHeat) {
  SprayOptions options = WetBox::mist(1, 0.2, 350);
  options.nozzles[0].position = {0.008, 0.01, 0.01};
  options.nozzles[0].axis = {1, 0, 0};
  options.nozzles[0].speed = 20;
  ClosedGas gas(300, 0.01);
  dem::ParticleSeed bead;
  bead.position = {0.0101, 0.01, 0.01};
  bead.radius = 1e-3;
  Rig rig(WetBox::box(), {bead}, options);
  DropletGas droplets = WetBox::make(gas, rig.spray);
  rig.droplets = &droplets;
  rig.gas_temperature = DeviceArray<Real>("test::gas_temperature", 1);
  const heat::SurfaceTotals before = rig.surface.compute_totals();
  for (int k = 0; k < 3; ++k) {
    droplets.sample(gas.state);
    rig.outer_step();
  }
  const NozzleFigures f = rig.spray.figures()[0];
  ASSERT_EQ(f.in_flight, 0);
  const heat::SurfaceTotals after = rig.surface.compute_totals();
  EXPECT_NEAR(after.film.liquid, f.captured - f.captured_solids, 1e-13 * f.injected);
  EXPECT_GT(f.evaporated, 0);
  // The surface of the rig counts with heat capacities and a reference of its own: 273.15 K, 4186 and 1000 J/kg/K. Droplets of
  // 350 K brought warmth: less than they would without evaporation, more than a quarter of that.
  const Real most = f.captured * 4186 * (350 - 300);
  EXPECT_GT(rig.surface.temperature()(0), 300);
  EXPECT_LT(rig.spray.heat().enthalpy, f.injected * (0.8 * 4181 + 0.2 * 1300) * (350 - 298.15));
  EXPECT_GT(after.enthalpy - before.enthalpy, 0.25 * most);
  // Counted from the surface's reference the particle has exactly what the droplets had over theirs.
  EXPECT_NEAR(after.enthalpy - before.enthalpy, rig.spray.heat().enthalpy, 1e-12 * after.enthalpy);
  EXPECT_EQ(rig.spray.heat().free_heat, 0);
}

TEST(DropletEvaporation, GoesOnBitForBitFromACheckpoint) {
  const tests::TemporaryFolder folder;
  WetBox whole(373, 0.0, WetBox::mist(100, 0.2, 293.15, 15e-6));
  for (int k = 0; k < 100; ++k) whole.step();
  core::CheckpointWriter out(folder / "checkpoint.h5");
  whole.rig.engine.save(out);
  whole.rig.spray.save(out);
  whole.droplets.save(out);
  out.close();
  WetBox resumed(373, 0.0, WetBox::mist(100, 0.2, 293.15, 15e-6));
  core::CheckpointReader in(folder / "checkpoint.h5");
  resumed.rig.engine.load(in);
  resumed.rig.spray.load(in);
  resumed.droplets.load(in);
  resumed.rig.steps = whole.rig.steps;
  resumed.gas.dry = whole.gas.dry;
  resumed.gas.vapour = whole.gas.vapour;
  resumed.gas.heat = whole.gas.heat;
  Kokkos::deep_copy(resumed.gas.state.velocity, whole.gas.state.velocity);
  resumed.gas.update();
  for (int k = 0; k < 400; ++k) {
    whole.step();
    resumed.step();
  }
  ASSERT_EQ(whole.rig.spray.parcels().count, resumed.rig.spray.parcels().count);
  for (Index i = 0; i < whole.rig.spray.parcels().count; ++i) {
    const Parcels &a = whole.rig.spray.parcels(), &b = resumed.rig.spray.parcels();
    ASSERT_TRUE(a.state(i).position == b.state(i).position && a.state(i).diameter == b.state(i).diameter);
    ASSERT_EQ(a.water(i).evaporated, b.water(i).evaporated);
    ASSERT_EQ(a.water(i).enthalpy, b.water(i).enthalpy);
  }
  EXPECT_EQ(whole.gas.heat, resumed.gas.heat);
  const NozzleFigures a = whole.rig.spray.figures()[0], b = resumed.rig.spray.figures()[0];
  EXPECT_GT(a.dried, 0);
  EXPECT_EQ(a.dried, b.dried);
  EXPECT_EQ(a.evaporated, b.evaporated);
  EXPECT_EQ(a.dust_captured, b.dust_captured);
}

}  // namespace
}  // namespace pellicle::spray
