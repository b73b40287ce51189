// Packed layers in a duct: pressure drop, and cell velocities free of spikes where the layer's edge cuts a row of cells.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

constexpr Real density = 1.2;
constexpr Real viscosity = 1.8e-5;

// Ergun (Chem. Eng. Prog. 48 (1952) 89): pressure gradient over a bed at superficial velocity U, and the momentum
// exchange coefficient that gives it: -eps dp/dx = beta u with u = U / eps.
Real ergun_gradient(Real eps, Real diameter, Real superficial) {
  return 150 * viscosity * (1 - eps) * (1 - eps) * superficial / (eps * eps * eps * diameter * diameter) +
         1.75 * density * (1 - eps) * superficial * superficial / (eps * eps * eps * diameter);
}
Real ergun_coefficient(Real eps, Real diameter, Real superficial) {
  const Real solids = 1 - eps;
  return 150 * solids * solids * viscosity / (eps * diameter * diameter) +
         1.75 * density * solids * (superficial / eps) / diameter;
}

// The whole duct is bed: 2 % is what the issue asks for; the discrete bed is exact, so 1e-8 here (the inlet's and the
// outlet's halves of cells included).
TEST(PackedBed, PressureDropIsErguns) {
  for (const Real superficial : {0.05, 0.5, 2.0}) {
    const CartesianGrid grid(Box{{0, 0, 0}, {0.03, 0.02, 0.2}}, {3, 2, 20});
    GasSolver solver(grid, make_air(), make_duct(superficial));
    auto exchange = make_empty_exchange(grid);
    Kokkos::deep_copy(exchange.void_fraction, 0.42);
    Kokkos::deep_copy(exchange.exchange_coefficient, ergun_coefficient(0.42, 3e-3, superficial));
    solver.initialise(Vec3{}, exchange.void_fraction);
    advance(solver, exchange, 1e-3, 50);
    EXPECT_NEAR(solver.pressure_drop("inlet", "outlet") / (0.2 * ergun_gradient(0.42, 3e-3, superficial)), 1,
                1e-8);
  }
}

struct Layer {
  Layer(GasOptions options, Real superficial)
      : grid(std::array<std::vector<Real>, 3>{{{0, 0.005}, {0, 0.01}, make_stretched_faces(0.1, 20)}}),
        solver(grid, options, make_duct(superficial)),
        exchange(make_empty_exchange(grid)) {
    for (Index k = 0; k < 20; ++k) {
      const Real share =
          std::clamp((edge - grid.faces(2)[static_cast<std::size_t>(k)]) / grid.width(2, k), 0.0, 1.0) -
          std::clamp((0.03 - grid.faces(2)[static_cast<std::size_t>(k)]) / grid.width(2, k), 0.0, 1.0);
      exchange.void_fraction(k) = 1 - 0.6 * share;
      exchange.exchange_coefficient(k) = 3000 * share;
    }
    solver.initialise(Vec3{0, 0, superficial}, exchange.void_fraction);
  }
  // Between faces of the stretched grid, as 0.03 is.
  static constexpr Real edge = 0.0617;
  CartesianGrid grid;
  GasSolver solver;
  ParticleExchange exchange;
};

class PackedLayer : public testing::TestWithParam<Convection> {};

// Continuity fixes eps u at the faces; the cells have their own momentum equations and spike if these are not
// balanced as the faces are. Tolerance: relative 1e-7, the residue of a settling flow; a scheme that averages
// cell-centred pressure gradients is off by tens of per cent in the two cut cells.
TEST_P(PackedLayer, CellVelocitiesDoNotSpike) {
  for (const Real superficial : {0.01, 1.0}) {
    GasOptions options = make_air(GetParam());
    make_tight(options);
    Layer layer(options, superficial);
    advance(layer.solver, layer.exchange, superficial > 0.1 ? 1e-4 : 1e-2, 4000);
    for (Index k = 0; k < 20; ++k) {
      EXPECT_NEAR(layer.exchange.void_fraction(k) * layer.solver.state().velocity(k).z / superficial, 1, 1e-7)
          << "cell " << k;
    }
  }
}

// With next to no inertia the pressure falls linearly in the layer and is constant outside: p at a cell centre is the
// drag of all cells above, half the cell's own included. Computed here from the layer alone.
TEST_P(PackedLayer, PressureIsPiecewiseLinearWithoutConvection) {
  GasOptions options = make_air(GetParam());
  make_tight(options);
  options.density = 1e-9;
  Layer layer(options, 1.0);
  advance(layer.solver, layer.exchange, 1e-4, 50);
  Real expected = 0;
  for (Index k = 19; k >= 0; --k) {
    const Real eps = layer.exchange.void_fraction(k);
    const Real own_half = 0.5 * layer.grid.width(2, k) * layer.exchange.exchange_coefficient(k) / (eps * eps);
    expected += own_half;
    // Relative to the whole drop of about 600 Pa.
    EXPECT_NEAR(layer.solver.state().pressure(k), expected, 1e-5) << "cell " << k;
    expected += own_half;
  }
}

// Bernoulli: from cell to cell the drag's share of the pressure difference and -1/2 rho Delta(u^2), nothing else.
TEST_P(PackedLayer, ConvectionStepsThePressureByBernoulli) {
  GasOptions options = make_air(GetParam());
  make_tight(options);
  Layer layer(options, 3.0);
  advance(layer.solver, layer.exchange, 1e-4, 4000);
  Real drop_by_drag = 0;
  for (Index k = 0; k + 1 < 20; ++k) {
    const auto own = [&](Index c) {
      const Real eps = layer.exchange.void_fraction(c);
      return 0.5 * layer.grid.width(2, c) * layer.exchange.exchange_coefficient(c) * 3.0 / (eps * eps);
    };
    const Real u = 3.0 / layer.exchange.void_fraction(k);
    const Real u_next = 3.0 / layer.exchange.void_fraction(k + 1);
    const Real expected = -(own(k) + own(k + 1)) - 0.5 * density * (u_next * u_next - u * u);
    EXPECT_NEAR(layer.solver.state().pressure(k + 1) - layer.solver.state().pressure(k), expected, 1e-4)
        << "face " << k;
    drop_by_drag += own(k) + own(k + 1);
  }
  EXPECT_GT(drop_by_drag, 1000);
}

// What particles feel in the middle of the layer is its own gradient, right up to the edge but for the cut cell.
TEST_P(PackedLayer, GradientOfFullCellsIsNotSmeared) {
  GasOptions options = make_air(GetParam());
  make_tight(options);
  options.density = 1e-9;
  Layer layer(options, 1.0);
  advance(layer.solver, layer.exchange, 1e-4, 50);
  for (Index k = 0; k < 20; ++k) {
    const Real eps = layer.exchange.void_fraction(k);
    EXPECT_NEAR(layer.solver.state().pressure_gradient(k).z,
                -layer.exchange.exchange_coefficient(k) / (eps * eps), 0.01)
        << "cell " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, PackedLayer,
                         testing::Values(Convection::upwind, Convection::ultimate_quickest,
                                         Convection::central));

}  // namespace
}  // namespace pellicle::cfd
