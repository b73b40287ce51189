// What of the gas depends on temperature and moisture: property laws against tables, density, buoyancy, vapour that
// becomes gas.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cfd/gas_property_laws.hpp"
#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

// ASHRAE's formulation (Hyland & Wexler), reference/saturation_clausius_clapeyron.csv; and the steam tables' 611.66 Pa
// at the triple point. The law of Buck is meant to be good to 0.2 % between 0 and 100 degC.
TEST(PropertyLaws, SaturationPressureIsThatOfTheTables) {
  const std::vector<std::array<Real, 2>> table{{273.16, 611.66},    {283.15, 1227.9953}, {293.15, 2338.8037},
                                               {303.15, 4246.0302}, {313.15, 7383.46},   {333.15, 19943.761},
                                               {353.15, 47411.611}, {363.15, 70180.013}, {373.15, 101418.72}};
  for (const auto& [temperature, pressure] : table) {
    EXPECT_NEAR(buck_saturation_pressure(temperature) / pressure, 1, 2e-3) << temperature;
  }
}

// Columns wstar_ASHRAE of the same table, at 101325 Pa: the tolerance is that of the saturation pressure, which counts
// up to 1/(1 - X) = 3.3 times at 90 degC (X = 0.69).
TEST(PropertyLaws, MoistureOfSaturatedAir) {
  const std::vector<std::array<Real, 2>> table{{283.15, 0.0075726229}, {293.15, 0.014482892},
                                               {298.15, 0.019686698},  {323.15, 0.079469988},
                                               {343.15, 0.2167315},    {363.15, 0.58359592}};
  for (const auto& [temperature, moisture] : table) {
    EXPECT_NEAR(humid_vapour_mass_fraction(1, temperature, standard_atmosphere) / moisture, 1, 5e-3)
        << temperature;
  }
  EXPECT_EQ(humid_vapour_mass_fraction(1, 380, standard_atmosphere), 1);
  EXPECT_EQ(humid_vapour_mass_fraction(0, 300, standard_atmosphere), 0);
  // Half the vapour pressure: X = 0.5 * 2338.8 / 101325, w = 0.622 X / (1 - 0.378 X).
  EXPECT_NEAR(humid_vapour_mass_fraction(0.5, 293.15, standard_atmosphere), 0.00721, 2e-5);
}

// U.S. Standard Atmosphere 1976: 1.2250 kg/m3 and 1.7894e-5 Pa s at 288.15 K; air tables at 400 K: 0.8826 kg/m3 at 1 atm,
// 2.30e-5 Pa s. Vapour at 400 K and 1 atm: M p / (R T) = 0.5489 kg/m3.
TEST(PropertyLaws, DensityAndViscosityOfAir) {
  EXPECT_NEAR(ideal_gas_density(101325, 288.15, 0), 1.2250, 1e-4);
  EXPECT_NEAR(ideal_gas_density(101325, 400, 0), 0.8826, 5e-4);
  EXPECT_NEAR(ideal_gas_density(101325, 400, 1), 0.5489, 1e-4);
  EXPECT_NEAR(sutherland_viscosity(288.15) / 1.7894e-5, 1, 1e-4);
  EXPECT_NEAR(sutherland_viscosity(400) / 2.30e-5, 1, 1e-2);
}

ScalarOptions& add_heat(GasOptions& options, Real initial) {
  ScalarOptions& heat = options.scalars[index_of(Scalar::temperature)].emplace();
  heat.capacity = 1006;
  heat.conductivity = 0.026;
  heat.initial = heat.reference = initial;
  return heat;
}

void make_ideal(GasOptions& options, Real temperature) {
  options.density_law = DensityLaw::ideal_gas;
  options.density = ideal_gas_density(options.reference_pressure, temperature, 0);
}

void set_temperature(std::vector<BoundaryPatch>& patches, const std::string& name, ScalarBoundary condition) {
  for (BoundaryPatch& patch : patches) {
    if (patch.name == name) patch.scalars[index_of(Scalar::temperature)] = condition;
  }
}

// Air heated on its way up a duct: c_p j T' = q, so that T is linear in the heat taken up, and density and velocity
// follow from j = rho u. The cells are uniform in j as far as the pressure is solved (1e-13).
TEST(IdealGas, HeatedDuctExpands) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.02, 0.02, 0.2}}, {1, 1, 20});
  GasOptions options = make_air(Convection::upwind);
  make_tight(options);
  options.viscosity = 0;
  add_heat(options, 300).conductivity = 0;
  make_ideal(options, 300);
  auto patches = make_duct(2);
  set_temperature(patches, "inlet", GivenValue{300});
  GasSolver solver(grid, options, patches);
  auto exchange = make_empty_exchange(grid);
  auto& heat = exchange.scalars[index_of(Scalar::temperature)];
  heat = {HostArray<Real>("tests::heat", 20), HostArray<Real>("tests::heat_coefficient", 20)};
  const Real flux = 2 * ideal_gas_density(101325, 300, 0);
  const Real rate = 1006 * flux * 100 / 0.2;  // heats the air by 100 K
  Kokkos::deep_copy(heat.rate, rate);
  advance(solver, exchange, 1e-3, 2000);
  for (Index k = 0; k < 20; ++k) {
    const Real expected = 300 + 5.0 * (k + 1);  // implicit upwind: a cell holds what leaves it
    EXPECT_NEAR(solver.state().scalars[index_of(Scalar::temperature)](k), expected, 1e-7);
    EXPECT_NEAR(solver.state().density(k), ideal_gas_density(101325, expected, 0), 1e-9);
    // The density of a face is the mean of its cells'. The velocity of a cell comes from its own momentum balance: near
    // the ends of 20 cells it is within 0.5 % of the mean of its faces'.
    const auto face = [&](Index f) {
      if (f == 20) return flux / solver.state().density(19);
      return f == 0 ? 2 : 2 * flux / (solver.state().density(f - 1) + solver.state().density(f));
    };
    EXPECT_NEAR(solver.state().velocity(k).z, 0.5 * (face(k) + face(k + 1)), 5e-3 * face(k + 1));
    EXPECT_NEAR(solver.state().volume_flux[2](k) / 4e-4, face(k), 1e-9);
  }
  EXPECT_LT(solver.balance().mass_defect(), 1e-12);
  EXPECT_LT(solver.balance(Scalar::temperature)->defect(), 1e-11);
  EXPECT_LT(solver.balance().mass, solver.balance().mass_initial);
  // Into the outlet goes what came in and what the heat drove out; the heat that leaves is that of 100 K.
  const ScalarBalance& balance = *solver.balance(Scalar::temperature);
  EXPECT_NEAR(balance.into[4], 0, 1e-9 * balance.sources);
  EXPECT_NEAR(balance.sources / (rate * 0.02 * 0.02 * 0.2 * 2), 1, 1e-12);
}

// All of the air in a closed duct with an open top is heated in one step by as much as thins it by a tenth; in the next it
// expands from rest. The mass says what passes a height z: rho u = (rho_old - rho) z / dt, so u = s z with
// s = (rho_old - rho) / (rho dt). Momentum, d(rho u)/dt + d(rho u^2)/dz = -dp/dz, is then
// rho s z / dt + 2 rho s^2 z = (2 rho_old - rho) s z / dt. With the density of the wrong time level in the inertia of the
// faces it would be 8 % less.
TEST(IdealGas, PressureOfAGasThatExpandsFromRest) {
  constexpr Index cells = 20;
  constexpr Real height = 0.2, dt = 1e-3, warmer = 30;
  const CartesianGrid grid(Box{{0, 0, 0}, {0.02, 0.02, height}}, {1, 1, cells});
  GasOptions options = make_air(Convection::central);
  make_tight(options);
  options.viscosity = 0;
  options.solver.max_outer_iterations = 40;
  options.solver.outer_tolerance = 1e-12;
  add_heat(options, 300).conductivity = 0;
  make_ideal(options, 300);
  auto patches = symmetry_on({Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min});
  patches.push_back({"top", Side::z_max, {}, Outlet{0}, "case.yaml:3"});
  GasSolver solver(grid, options, patches);
  auto exchange = make_empty_exchange(grid);
  auto& heat = exchange.scalars[index_of(Scalar::temperature)];
  heat = {HostArray<Real>("tests::heat", cells), HostArray<Real>("tests::heat_coefficient", cells)};
  const Real old = ideal_gas_density(101325, 300, 0), now = ideal_gas_density(101325, 300 + warmer, 0);
  Kokkos::deep_copy(heat.rate, 1006 * old * warmer / dt);
  advance(solver, exchange, dt, 2);
  const Real s = (old - now) / (now * dt);
  const Real slope = (2 * old - now) * s / dt;  // of -dp/dz over z
  for (Index k = 0; k < cells; ++k) {
    EXPECT_NEAR(solver.state().density(k) / now, 1, 1e-9);
    EXPECT_NEAR(solver.state().volume_flux[2](k) / (4e-4 * s * 0.01), k, 1e-6);
  }
  // Where gas expands, the convection of a face is that between its cells only up to rho s^2 dz / 4: 2.1 % of the lowest
  // difference, and less above; at the outlet the extrapolated velocity leaves 1.2 %.
  for (Index k = 0; k + 1 < cells; ++k) {
    const Real z = 0.01 * (k + 1);
    const Real difference = solver.state().pressure(k) - solver.state().pressure(k + 1);
    EXPECT_NEAR(difference / (slope * z * 0.01), 1, 0.025) << "face " << k + 1;
  }
  EXPECT_NEAR(solver.state().pressure(cells - 1) / (slope * height * 0.005), 1, 0.025) << "outlet";
}

// A volume flow rate is at the inlet's own temperature: the mass that comes in is that of hot air.
TEST(IdealGas, InletFlowIsAtItsOwnTemperature) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.1, 0.3}}, {2, 2, 6});
  GasOptions options = make_air();
  make_tight(options);
  add_heat(options, 290);
  make_ideal(options, 290);
  auto patches = make_duct(0);
  patches[4].kind = Inlet{{}, 0.01};
  set_temperature(patches, "inlet", GivenValue{350});
  GasSolver solver(grid, options, patches);
  advance(solver, make_empty_exchange(grid), 1e-2, 10);
  EXPECT_NEAR(solver.balance().mass_in() / (0.01 * 0.1 * ideal_gas_density(101325, 350, 0)), 1, 1e-12);
  EXPECT_LT(solver.balance().mass_defect(), 1e-12);
}

// A uniform temperature stays uniform while dry and moist air of other density and heat capacity mix and particles give
// off vapour of that temperature: every kilogram brings the heat that it needs.
TEST(IdealGas, UniformTemperatureStaysWhileMoistureDoesNot) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.065, 0.02, 0.19}}, {13, 2, 24});
  GasOptions options = make_air();
  add_heat(options, 320).vapour_capacity = 1872;
  options.scalars[0]->reference = 273.15;
  ScalarOptions& moisture = options.scalars[index_of(Scalar::moisture)].emplace();
  moisture.diffusivity = 2.6e-5;
  moisture.initial = 0.01;
  make_ideal(options, 320);
  std::vector<BoundaryPatch> patches{
      {"spout",
       Side::z_min,
       Box{{0.03, -1, -1}, {0.035, 1, 1}},
       Inlet{30.0, {}},
       "",
       {GivenValue{320}, GivenValue{0.3}}},
      {"floor", Side::z_min, {}, Inlet{1.5, {}}, "", {GivenValue{320}, GivenValue{0.0}}},
      {"top", Side::z_max, {}, Outlet{0}, "", {}}};
  GasSolver solver(grid, options, patches);
  auto exchange = make_empty_exchange(grid);
  const auto n = static_cast<std::size_t>(grid.cell_count());
  for (auto& source : exchange.scalars)
    source = {HostArray<Real>("tests::rate", n), HostArray<Real>("tests::none", n)};
  exchange.mass_source = exchange.scalars[1].rate;
  exchange.mass_source_momentum = HostArray<Vec3>("tests::vapour_momentum", n);
  set_moving_bed(grid, 0, exchange);
  solver.initialise(Vec3{0, 0, 1.5}, exchange.void_fraction);
  for (int step = 1; step <= 100; ++step) {
    set_moving_bed(grid, 1e-4 * step, exchange);
    for (Index c = 0; c < grid.cell_count(); ++c) {
      exchange.mass_source(c) = 3 * (1 - exchange.void_fraction(c)) - 0.1;  // condenses above the bed
      exchange.scalars[0].rate(c) = exchange.mass_source(c) * 1872 * (320 - 273.15);
    }
    solver.update(1e-4, exchange);
  }
  const auto& state = solver.state();
  const auto extent = [&](const HostArray<Real>& v) {
    const auto [low, high] = std::minmax_element(v.data(), v.data() + v.extent(0));
    return *high - *low;
  };
  EXPECT_GT(extent(state.scalars[1]), 0.2);
  EXPECT_GT(extent(state.density), 0.1);
  // Round-off of some hundred steps on 320.
  EXPECT_LT(extent(state.scalars[0]), 320 * 1e-12);
  EXPECT_LT(solver.balance(Scalar::temperature)->defect(), 1e-11);
  EXPECT_LT(solver.balance(Scalar::moisture)->defect(), 1e-12);
  EXPECT_LT(solver.balance().mass_defect(), 1e-10);
}

// Hot moist air blown past a block and a slanted wall: what is cut keeps heat and water as whole cells do, and a cell
// without gas has no part in it.
TEST(IdealGas, BalancesCloseAroundSurfaces) {
  for (const bool uniform : {false, true}) {
    const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.1, 0.2}}, {10, 10, 20});
    GasOptions options = make_air();
    make_tight(options);
    add_heat(options, 300).vapour_capacity = 1872;
    options.scalars[0]->reference = 290;
    ScalarOptions& moisture = options.scalars[index_of(Scalar::moisture)].emplace();
    moisture.diffusivity = 2.6e-5;
    moisture.initial = 0.01;
    make_ideal(options, 300);
    const std::vector<BoundaryPatch> patches{
        {"in", Side::z_min, {}, Inlet{3.0, {}}, "", {GivenValue{uniform ? 300.0 : 350.0}, GivenValue{0.05}}},
        {"out", Side::z_max, {}, Outlet{0}, "", {}}};
    ImmersedGeometry immersed;
    const Real slope = 0.5 * std::sqrt(2.0);
    immersed.surfaces = {{"block", {BoxSurface{{0.033, 0.033, 0.084}, {0.067, 0.067, 0.126}}}, {}, {}, {}},
                         {"roof", {PlaneSurface{{slope, 0, slope}, slope * 0.263}}, {}, {}, {}}};
    immersed.inside = {0.05, 0.05, 0.01};
    GasSolver solver(grid, options, patches, immersed);
    ASSERT_LT(solver.geometry().open_cells, grid.cell_count());
    advance(solver, make_empty_exchange(grid), 1e-3, 60);
    const HostArray<Real>& temperature = solver.state().scalars[0];
    for (Index c = 0; c < grid.cell_count(); ++c) {
      EXPECT_GE(temperature(c), 300 - 1e-7);
      EXPECT_LE(temperature(c), (uniform ? 300 : 350) + 1e-7);
      if (!(solver.geometry().volume(c) > 0)) {
        EXPECT_EQ(temperature(c), 300);
      }
      if (uniform) {
        EXPECT_NEAR(temperature(c), 300, 1e-10);
      }
    }
    EXPECT_LT(solver.balance().mass_defect(), 1e-12);
    EXPECT_LT(solver.balance(Scalar::temperature)->defect(), 1e-11);
    EXPECT_LT(solver.balance(Scalar::moisture)->defect(), 1e-12);
    EXPECT_GT(solver.balance(Scalar::moisture)->stock, 1.5 * solver.balance(Scalar::moisture)->initial);
  }
}

// Vapour becomes gas in a duct: what leaves is what came in and the vapour, and the gas speeds up by as much. With the
// momentum of gas at rest the vapour is sped up by the pressure: dp/dz = -S u - d(rho u u)/dz + S u = -2 rho u u'
// in all, so that p falls by rho (u_out^2 - u_in^2).
TEST(MassSource, SpeedsTheGasUp) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.01, 0.01, 0.4}}, {1, 1, 80});
  GasOptions options = make_air(Convection::quick);
  make_tight(options);
  options.viscosity = 0;
  GasSolver solver(grid, options, make_duct(1));
  auto exchange = make_empty_exchange(grid);
  exchange.mass_source = HostArray<Real>("tests::vapour", 80);
  exchange.mass_source_momentum = HostArray<Vec3>("tests::vapour_momentum", 80);
  Kokkos::deep_copy(exchange.mass_source, 1.2 / 0.4);  // as much as comes in
  advance(solver, exchange, 5e-3, 400);
  EXPECT_LT(solver.balance().mass_defect(), 1e-12);
  EXPECT_NEAR(solver.balance().mass_given / (1.2 * 1e-4 * 2), 1, 1e-12);
  EXPECT_NEAR(solver.state().volume_flux[2](80), 2e-4, 1e-15);
  // Within half of what it gains in a cell.
  for (Index k = 0; k < 80; ++k) EXPECT_NEAR(solver.state().velocity(k).z, 1 + (k + 0.5) / 80, 0.5 / 80);
  // rho (4 - 1) over the duct, less half a cell at each end: their u' = 2.5 /s.
  const Real drop = 1.2 * (std::pow(2 - 0.5 / 80, 2) - std::pow(1 + 0.5 / 80, 2));
  EXPECT_NEAR(solver.state().pressure(0) - solver.state().pressure(79), drop, 0.02 * drop);
  EXPECT_LT(solver.balance().momentum_defect(), 1e-3);
}

// Air that is warmer above is stable: nothing moves, and heat is conducted in a straight line.
TEST(Buoyancy, StableLayersStayStill) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.1, 0.1}}, {8, 3, 12});
  GasOptions options = make_air();
  make_tight(options);
  add_heat(options, 300).conductivity = 26;
  options.boussinesq = Boussinesq{1.0 / 300, 300};
  std::vector<BoundaryPatch> patches{
      {"below", Side::z_min, {}, NoSlip{}, "", {GivenValue{290}, Insulated{}}},
      {"above", Side::z_max, {}, NoSlip{}, "", {GivenValue{310}, Insulated{}}}};
  GasSolver solver(grid, options, patches);
  advance(solver, make_empty_exchange(grid), 0.05, 200);  // a step well below 1/sqrt(g 200/300) = 0.4 s
  Real speed = 0;
  for (Index c = 0; c < grid.cell_count(); ++c) {
    speed = std::max(speed, norm(solver.state().velocity(c)));
    const Real z = grid.center(2, grid.coordinates(c).z);
    EXPECT_NEAR(solver.state().scalars[0](c), 290 + 200 * z, 1e-6);
  }
  // What the first steps' pressure solves leave, of sqrt(g L 20/300) = 0.25 m/s.
  EXPECT_LT(speed, 1e-7);
  // dp/dz = rho g (T - 300)/300: p = 0.03924 (100 z2 - 10 z) Pa at cell centres, by symmetry the same at both ends.
  const auto p = [&](Index k) { return solver.state().pressure(grid.index(4, 1, k)); };
  EXPECT_NEAR(p(0) - p(11), 0, 1e-8);
  EXPECT_NEAR(p(5) - p(0), -0.03924 * 0.2083333, 1e-7);
}

// A bubble of warm air in a cold room rises, with the density of an ideal gas and with Boussinesq's; cold air sinks.
TEST(Buoyancy, WarmAirRises) {
  for (const bool ideal : {false, true}) {
    for (const Real sign : {1.0, -1.0}) {
      const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.1, 0.1}}, {9, 9, 9});
      GasOptions options = make_air();
      make_tight(options);
      options.solver.max_outer_iterations = 40;
      options.solver.outer_tolerance = 1e-12;
      add_heat(options, 300);
      if (ideal) {
        make_ideal(options, 300);
      } else {
        options.boussinesq = Boussinesq{1.0 / 300, 300};
      }
      GasSolver solver(grid, options,
                       {{"top", Side::z_max, {}, Outlet{0}, "", {GivenValue{300}, Insulated{}}}});
      auto exchange = make_empty_exchange(grid);
      auto& heat = exchange.scalars[0];
      heat = {HostArray<Real>("tests::heat", 729), HostArray<Real>("tests::none", 729)};
      const Index middle = grid.index(4, 4, 4);
      heat.rate(middle) = sign * 2e4;
      advance(solver, exchange, 2e-3, 20);
      // After 0.04 s the cell is 0.66 K warmer, which alone makes g 0.66/300 t/2 = 4.3e-4 m/s; the gas around it has to
      // move too (a sphere would have 2/3 of it left).
      const Real v = sign * solver.state().velocity(middle).z;
      EXPECT_GT(v, 1e-4) << ideal;
      EXPECT_LT(v, 3e-4) << ideal;
      // The impulse of buoyancy is what gas, walls and outlet got, to the tolerance of the outer iterations.
      const GasBalance& balance = solver.balance();
      EXPECT_GT(sign * balance.body_force.z, 0);
      EXPECT_LT(norm(balance.momentum_residual()), 1e-9 * std::abs(balance.body_force.z));
    }
  }
}

TEST(GasScalars, LawsWithoutATemperatureAreRefused) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.1, 0.1}}, {3, 3, 3});
  const auto refused = [&](const GasOptions& options, std::vector<BoundaryPatch> patches) {
    try {
      GasSolver(grid, options, std::move(patches));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  auto patches = make_duct(1);
  GasOptions options = make_air();
  options.density_law = DensityLaw::ideal_gas;
  EXPECT_NE(refused(options, patches).find("ideal gas needs a temperature"), std::string::npos);
  add_heat(options, 300);
  EXPECT_NE(refused(options, patches).find("inlet 'inlet' brings gas of no given value"), std::string::npos);
  set_temperature(patches, "inlet", GivenValue{300});
  EXPECT_EQ(refused(options, patches), "accepted");
  EXPECT_NE(refused(options, {}).find("needs an outlet"), std::string::npos);
  options.boussinesq = Boussinesq{1.0 / 300, 300};
  EXPECT_NE(refused(options, patches).find("own buoyancy"), std::string::npos);
  options = make_air();
  options.viscosity_law = ViscosityLaw::sutherland;
  EXPECT_NE(refused(options, patches).find("viscosity needs a temperature"), std::string::npos);
}

}  // namespace
}  // namespace pellicle::cfd
