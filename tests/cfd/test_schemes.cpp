// Face interpolation and operators on fields that they must reproduce exactly.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "cfd/convection.hpp"
#include "cfd/convection_schemes.hpp"
#include "cfd/flow_geometry.hpp"
#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

// The quadratic through three cell centres reproduces quadratics, on any spacing and for both directions of flow.
TEST(Quick, WeightsReproduceQuadratics) {
  const CartesianGrid grid(
      std::array<std::vector<Real>, 3>{{{0, 1}, {0, 1}, {0, 0.1, 0.3, 0.45, 0.9, 1.7, 2.0}}});
  const FlowGeometry geometry(grid);
  const auto f = [](Real z) { return 3 - 2 * z + 1.5 * z * z; };
  for (Index i = 2; i < 5; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const Real exact = f(grid.faces(2)[at]);
    const auto& forward = geometry.axis[2].quick_forward[at];
    const auto& backward = geometry.axis[2].quick_backward[at];
    const auto value = [&](Index cell) { return f(grid.center(2, cell)); };
    EXPECT_NEAR(forward[0] * value(i - 2) + forward[1] * value(i - 1) + forward[2] * value(i), exact, 1e-14);
    EXPECT_NEAR(backward[0] * value(i + 1) + backward[1] * value(i) + backward[2] * value(i - 1), exact,
                1e-14);
  }
  // Equal cells: Leonard's -1/8, 6/8, 3/8.
  const FlowGeometry equal(CartesianGrid(Box{{0, 0, 0}, {1, 1, 1}}, {1, 1, 8}));
  EXPECT_NEAR(equal.axis[2].quick_forward[4][0], -0.125, 1e-14);
  EXPECT_NEAR(equal.axis[2].quick_forward[4][1], 0.75, 1e-14);
  EXPECT_NEAR(equal.axis[2].quick_forward[4][2], 0.375, 1e-14);
}

TEST(UltimateLimiter, BoundsTheFaceValue) {
  EXPECT_EQ(ultimate_limit(0.6, 0, 0.4, 1), 0.6);                   // smooth: untouched
  EXPECT_EQ(ultimate_limit(1.2, 0, 0.4, 1), 1);                     // not beyond the downstream cell
  EXPECT_EQ(ultimate_limit(0.3, 0, 0.4, 1), 0.4);                   // not before the central cell
  EXPECT_EQ(ultimate_limit(0.9, 0, 0.1, 1), 0.1 * ultimate_slope);  // not steeper than the slope
  EXPECT_EQ(ultimate_limit(0.6, 0.5, 0.4, 1), 0.4);                 // extremum: upwind
  EXPECT_EQ(ultimate_limit(0.7, 0.7, 0.7, 0.7), 0.7);
  EXPECT_EQ(ultimate_limit(-0.6, 0, -0.4, -1), -0.6);  // the same mirrored
  EXPECT_EQ(ultimate_limit(-1.2, 0, -0.4, -1), -1);
}

// A step carried through a duct: the bounded schemes make no new extrema, the unbounded ones do.
TEST(Convection, BoundedSchemesMakeNoOvershoot) {
  for (const auto& [scheme, bounded] :
       {std::pair{Convection::upwind, true}, std::pair{Convection::ultimate_quickest, true},
        std::pair{Convection::central, false}, std::pair{Convection::quick, false}}) {
    const CartesianGrid grid(Box{{0, 0, 0}, {1, 1, 1}}, {1, 40, 1}, {true, true, true});
    GasOptions options = make_air(scheme);
    options.viscosity = 0;
    GasSolver solver(grid, options, {});
    HostArray<Vec3> start("tests::cfd::start", 40);
    for (Index j = 0; j < 40; ++j) start(j) = {j >= 5 && j < 15 ? 1.0 : 0.0, 1, 0};
    auto exchange = make_empty_exchange(grid);
    solver.initialise(start, exchange.void_fraction);
    advance(solver, exchange, 0.01, 40);
    Real least = 1, largest = 0;
    for (Index j = 0; j < 40; ++j) {
      least = std::min(least, solver.state().velocity(j).x);
      largest = std::max(largest, solver.state().velocity(j).x);
    }
    // Deferred correction leaves the limiter one iteration late: overshoots of the size of that lag.
    if (bounded) {
      EXPECT_GT(least, -2e-3);
      EXPECT_LT(largest, 1 + 2e-3);
    } else {
      EXPECT_LT(least, -0.01);
    }
    EXPECT_GT(largest, 0.5);
  }
}

// Uniform flow through a stretched, periodic grid stays what it is, to round-off; with particles as well.
TEST(Operators, UniformFlowStaysUniform) {
  for (const Real eps : {1.0, 0.5}) {
    const CartesianGrid grid(
        std::array<std::vector<Real>, 3>{
            {make_stretched_faces(1, 7), make_stretched_faces(1, 6), make_stretched_faces(1, 5)}},
        {true, true, true});
    GasSolver solver(grid, make_air(), {});
    auto exchange = make_empty_exchange(grid);
    Kokkos::deep_copy(exchange.void_fraction, eps);
    const Vec3 velocity{1.5, -0.7, 0.3};
    solver.initialise(velocity, exchange.void_fraction);
    advance(solver, exchange, 0.05, 20);
    for (Index c = 0; c < grid.cell_count(); ++c) {
      EXPECT_NEAR(norm(solver.state().velocity(c) - velocity), 0, 1e-12);
      EXPECT_NEAR(solver.state().pressure(c), 0, 1e-12);
    }
  }
}

// A force in a closed box is held up by a linear pressure: gradient exact in every cell, walls included, gas at rest.
TEST(Operators, LinearPressureIsExact) {
  const CartesianGrid grid(std::array<std::vector<Real>, 3>{
      {make_stretched_faces(0.1, 6), make_stretched_faces(0.2, 5), make_stretched_faces(1, 8)}});
  GasOptions options = make_air();
  options.body_force = {2, -3, -11};
  make_tight(options);
  GasSolver solver(grid, options, {});
  auto exchange = make_empty_exchange(grid);
  for (Index c = 0; c < grid.cell_count(); ++c) exchange.void_fraction(c) = c % 3 == 0 ? 0.4 : 0.9;
  solver.initialise(Vec3{}, exchange.void_fraction);
  advance(solver, exchange, 1e-3, 3);
  for (Index c = 0; c < grid.cell_count(); ++c) {
    const Index3 at = grid.coordinates(c);
    // Round-off of pressures of about 10 Pa over cells of 1 cm.
    EXPECT_NEAR(norm(solver.state().pressure_gradient(c) - Vec3{2, -3, -11}), 0, 1e-8);
    // Free, the gas would gain 0.01 m/s a step; two outer iterations leave 3e-8 of it.
    EXPECT_LT(norm(solver.state().velocity(c)), 1e-9);
    const Real linear = 2 * grid.center(0, at.x) - 3 * grid.center(1, at.y) - 11 * grid.center(2, at.z);
    const Real first = 2 * grid.center(0, 0) - 3 * grid.center(1, 0) - 11 * grid.center(2, 0);
    EXPECT_NEAR(solver.state().pressure(c) - solver.state().pressure(0), linear - first, 1e-8);
  }
}

// Gas at rest under gravity, particles or not: not one bit moves, since gravity is inside the pressure.
TEST(Operators, StillGasStaysStill) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.02, 0.3}}, {5, 2, 9});
  GasSolver solver(grid, make_air(), {{"top", Side::z_max, {}, Outlet{0}, "case.yaml:3"}});
  auto exchange = make_empty_exchange(grid);
  for (Index c = 0; c < 40; ++c) {
    exchange.void_fraction(c) = 0.4;
    exchange.exchange_coefficient(c) = 2000;
  }
  solver.initialise(Vec3{}, exchange.void_fraction);
  const StepReport report = advance(solver, exchange, 1e-4, 10);
  for (Index c = 0; c < grid.cell_count(); ++c) {
    EXPECT_TRUE(solver.state().velocity(c) == Vec3{});
    EXPECT_EQ(solver.state().pressure(c), 0);
  }
  EXPECT_EQ(report.pressure_iterations, 0);
}

}  // namespace
}  // namespace pellicle::cfd
