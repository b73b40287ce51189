// Surfaces within the domain as inlets and outlets: exact flows, plug flow between two planes, what inlets carry, refusals.
#include <gtest/gtest.h>

#include <cmath>

#include "cfd/gas_solver.hpp"
#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

BoundaryPatch on_wall(std::string name, std::string wall, std::variant<Inlet, Outlet> kind) {
  BoundaryPatch patch;
  patch.name = std::move(name);
  patch.wall = std::move(wall);
  patch.where = "case.yaml:2";
  if (const auto* inlet = std::get_if<Inlet>(&kind)) patch.kind = *inlet;
  if (const auto* outlet = std::get_if<Outlet>(&kind)) patch.kind = *outlet;
  return patch;
}

// A duct along x with symmetry at its sides, of which two planes through cells are the ends.
struct Duct {
  CartesianGrid grid{Box{{0, 0, 0}, {1, 0.2, 0.1}}, {20, 4, 2}};
  ImmersedGeometry immersed;
  std::vector<BoundaryPatch> patches = symmetry_on({Side::y_min, Side::y_max, Side::z_min, Side::z_max});
  GasOptions options = make_air();
  explicit Duct(Inlet inlet) {
    immersed.surfaces = {{"low", {PlaneSurface{{1, 0, 0}, 0.113}}, {}, {}, {}},
                         {"high", {PlaneSurface{{1, 0, 0}, 0.882}}, {}, {}, {}}};
    immersed.inside = {0.5, 0.1, 0.05};
    patches.push_back(on_wall("in", "low", inlet));
    patches.push_back(on_wall("out", "high", Outlet{3}));
    make_tight(options);
  }
};

TEST(WallOpenings, PlugFlowBetweenTwoPlanes) {
  const Duct duct(Inlet{2.0, {}});
  GasSolver gas(duct.grid, duct.options, duct.patches, duct.immersed);
  gas.initialise({2, 0, 0});
  advance(gas, make_empty_exchange(duct.grid), 0.02, 100);
  for (Index c = 0; c < duct.grid.cell_count(); ++c) {
    if (!(gas.geometry().volume(c) > 0)) continue;
    EXPECT_NEAR(gas.state().velocity(c).x, 2, 1e-6);
    EXPECT_NEAR(gas.state().velocity(c).y, 0, 1e-6);
    EXPECT_NEAR(gas.state().pressure(c), 3, 1e-4);
  }
  EXPECT_NEAR(gas.patch_pressure("in"), 3, 1e-4);
  EXPECT_NEAR(gas.pressure_drop("in", "out"), 0, 1e-4);
  const Real moved = 2.0 * 0.2 * 0.1 * 1.2 * 0.02 * 100;
  EXPECT_NEAR(gas.balance().patches[4].mass_in, moved, 1e-12 * moved);
  EXPECT_NEAR(gas.balance().patches[5].mass_out, moved, 1e-10 * moved);
  EXPECT_LT(gas.balance().mass_defect(), 1e-12);
  EXPECT_LT(gas.balance().momentum_defect(), 1e-9);
}

// Drag less a force of the gas's own makes the pressure fall along the duct. What a wall's opening shows is the pressure of
// the gas in its cells, all alike here: not that of a side of the domain, to which the force would carry it on.
TEST(WallOpenings, PressureOfAnInletIsThatOfTheGasInItsCells) {
  Duct duct(Inlet{2.0, {}});
  duct.options.body_force = {4, 0, 0};
  GasSolver gas(duct.grid, duct.options, duct.patches, duct.immersed);
  gas.initialise({2, 0, 0});
  ParticleExchange exchange = make_empty_exchange(duct.grid);
  Kokkos::deep_copy(exchange.exchange_coefficient, 8);
  advance(gas, exchange, 0.02, 100);
  const Index beside = 2;  // from 0.1 to 0.15 m; the plane is at 0.113 m
  const Real drop = gas.state().pressure(beside) - 3;
  // beta u - 4 Pa a metre; the velocity of the cells beside a plane misses some percent.
  EXPECT_NEAR(drop, (8 * 2 - 4) * (0.882 - 0.113), 0.05 * drop);
  // Across the duct the flow still settles.
  EXPECT_NEAR(gas.patch_pressure("in"), 3 + drop, 1e-4);
  EXPECT_NEAR(gas.pressure_drop("in", "out"), drop, 1e-4);
}

// A ball that blows: 4 pi R^2 of surface in cells cut every way. What comes in is what was asked for, and leaves at the top.
TEST(WallOpenings, FlowRatesAndMassFlowsAreExact) {
  const CartesianGrid grid(Box{{-0.1, -0.1, 0}, {0.1, 0.1, 0.3}}, {14, 13, 18});
  GasOptions options = make_air();
  make_tight(options);
  ImmersedGeometry immersed;
  // A closed cylinder, a nozzle that stands in the gas.
  immersed.surfaces = {{"nozzle",
                        {RevolvedSurface{{0, 0, 0}, {0, 0.1, 0.9950371902}, 0.03, 0.05, 0.03, 0.1},
                         RevolvedSurface{{0, 0, 0}, {0, 0.1, 0.9950371902}, 0, 0.05, 0.03, 0.05},
                         RevolvedSurface{{0, 0, 0}, {0, 0.1, 0.9950371902}, 0, 0.1, 0.03, 0.1}},
                        {},
                        {},
                        {}}};
  immersed.inside = {0.08, 0.08, 0.2};
  for (const bool by_mass : {false, true}) {
    Inlet inlet{{}, 0.01, 0.5};
    if (by_mass) inlet = Inlet{.velocity = {}, .flow_rate = {}, .share = 0.5, .mass_flow = 0.012};
    GasSolver gas(grid, options,
                  {on_wall("jets", "nozzle", inlet), {"top", Side::z_max, {}, Outlet{0}, "case.yaml:3"}},
                  immersed);
    const StepReport report = advance(gas, make_empty_exchange(grid), 1e-3, 20);
    const Real moved = 0.5 * 0.012 * 0.02;
    EXPECT_NEAR(gas.balance().patches[0].mass_in, moved, 1e-13 * moved);
    EXPECT_NEAR(gas.balance().patches[1].mass_out, moved, 1e-10 * moved);
    EXPECT_LT(gas.balance().mass_defect(), 1e-12);
    EXPECT_LT(gas.balance().momentum_defect(), 1e-8);
    EXPECT_LT(report.continuity_residual, 1e-12);
  }
}

// Warm, moist gas from a wall fills the duct; the balance of heat closes.
TEST(WallOpenings, InletsBringTheirTemperatureAndMoisture) {
  Duct duct(Inlet{2.0, {}});
  duct.patches[4].scalars = {GivenValue{350}, GivenValue{0.02}};
  ScalarOptions heat;
  heat.capacity = 1007;
  heat.conductivity = 0.026;
  heat.initial = heat.reference = 300;
  duct.options.scalars[0] = heat;
  duct.options.scalars[1] = ScalarOptions{};
  GasSolver gas(duct.grid, duct.options, duct.patches, duct.immersed);
  gas.initialise({2, 0, 0});
  advance(gas, make_empty_exchange(duct.grid), 0.02, 100);
  for (Index c = 0; c < duct.grid.cell_count(); ++c) {
    if (!(gas.geometry().volume(c) > 0)) continue;
    EXPECT_NEAR(gas.state().scalars[0](c), 350, 1e-6);
    EXPECT_NEAR(gas.state().scalars[1](c), 0.02, 1e-10);
  }
  EXPECT_LT(gas.balance(Scalar::temperature)->defect(), 1e-10);
  // By flow alone, since what is conducted at first flows in later: 2 m/s of 50 K.
  EXPECT_GT(gas.balance(Scalar::temperature)->into[4], 2 * 0.02 * 1.2 * 1007 * 50 * 2 * 0.99);
}

// Still gas between two planes, one of a given temperature, the other with surroundings behind a resistance: in steady state
// the flux is (T_hot - T_out) / (L/k + 1/h), and the temperature falls linearly.
TEST(WallTemperatures, ConductionBetweenTwoPlanes) {
  constexpr Real low = 0.113, high = 0.882, k = 0.5, h = 2, hot = 400, outside = 300;
  const CartesianGrid grid(Box{{0, 0, 0}, {1, 0.2, 0.1}}, {20, 4, 2});
  ImmersedGeometry immersed;
  immersed.surfaces = {{"low", {PlaneSurface{{1, 0, 0}, low}}, {}, {}, {}},
                       {"high", {PlaneSurface{{1, 0, 0}, high}}, {}, {}, {}}};
  immersed.inside = {0.5, 0.1, 0.05};
  auto patches = symmetry_on({Side::y_min, Side::y_max, Side::z_min, Side::z_max});
  for (const char* name : {"low", "high"}) {
    BoundaryPatch patch{name, Side::z_min, {}, NoSlip{}, "case.yaml:2"};
    patch.wall = name;
    patches.push_back(patch);
  }
  patches[4].scalars[0] = GivenValue{hot};
  patches[5].scalars[0] = Surroundings{outside, h};
  GasOptions options = make_air();
  ScalarOptions heat;
  heat.capacity = 1;
  heat.conductivity = k;
  heat.initial = heat.reference = 350;
  options.scalars[0] = heat;
  GasSolver gas(grid, options, patches, immersed);
  const ParticleExchange exchange = make_empty_exchange(grid);
  advance(gas, exchange, 10, 30);
  const Real before = gas.balance(Scalar::temperature)->into[4];
  gas.update(10, exchange);
  const Real flux = (hot - outside) / ((high - low) / k + 1 / h);
  // Cells that the planes cut are linear too: the gas of each has its own middle and distance.
  EXPECT_NEAR((gas.balance(Scalar::temperature)->into[4] - before) / 10, flux * 0.02, 1e-6 * flux * 0.02);
  const Index middle = grid.index(9, 1, 1);
  EXPECT_NEAR(gas.state().scalars[0](middle), hot - flux / k * (0.475 - low), 1e-4);
  EXPECT_LT(gas.balance(Scalar::temperature)->defect(), 1e-10);
  // The surfaces are walls all the same.
  for (Index c = 0; c < grid.cell_count(); ++c) EXPECT_EQ(norm(gas.state().velocity(c)), 0);
}

TEST(WallOpenings, WhatCannotBeIsRefusedByName) {
  const Duct duct(Inlet{2.0, {}});
  const auto says = [&](const std::vector<BoundaryPatch>& patches, const std::string& what) {
    try {
      GasSolver(duct.grid, duct.options, patches, duct.immersed);
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
      return;
    }
    ADD_FAILURE() << "accepted, though " << what;
  };
  auto patches = duct.patches;
  patches[4].wall = "lid";
  says(patches, "boundary 'in' is wall 'lid', which the gas does not see");
  patches = duct.patches;
  patches[5].wall = "low";
  says(patches, "boundary 'out' is wall 'low', as boundary 'in' is");
  patches = duct.patches;
  patches[4].kind = FreeSlip{};
  says(patches, "boundary 'in' is the whole of wall 'low'");
  patches[4].kind = NoSlip{{0, 1, 0}};
  says(patches, "boundary 'in' has a velocity, which wall 'low' itself has");
  patches = duct.patches;
  patches[4].kind = Inlet{2.0, 1.0};
  says(patches, "exactly one of velocity, flow_rate and mass_flow");
  patches = duct.patches;
  patches.pop_back();
  says(patches, "which has no way out");
  // Two-sided and untouched walls.
  Duct other(Inlet{2.0, {}});
  other.immersed.surfaces.push_back(
      {"plate", {RevolvedSurface{{0.51, 0.1, 0.05}, {1, 0, 0}, 0, 0, 0.03, 0}}, {}, {}, {}});
  other.patches[4].wall = "plate";
  EXPECT_THROW(GasSolver(other.grid, other.options, other.patches, other.immersed), InputError);
  other.immersed.surfaces.back().shapes = {PlaneSurface{{1, 0, 0}, 0.03}};
  EXPECT_THROW(GasSolver(other.grid, other.options, other.patches, other.immersed), InputError);
}

}  // namespace
}  // namespace pellicle::cfd
