// What a step says about its convergence and its Courant number.
#include <gtest/gtest.h>

#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

/// A jet of 2 m/s into a box of 6 x 1 x 8 cells of 1 cm, at rest before.
GasSolver make_jet(const GasOptions& options) {
  auto patches = symmetry_on({Side::y_min, Side::y_max});
  patches.push_back({"jet", Side::z_min, Box{{0.02, 0, 0}, {0.04, 0.01, 0}}, Inlet{2, {}}, "case.yaml:1"});
  patches.push_back({"out", Side::z_max, {}, Outlet{0}, "case.yaml:2"});
  return GasSolver(CartesianGrid(Box{{0, 0, 0}, {0.06, 0.01, 0.08}}, {6, 1, 8}), options, patches);
}

TEST(GasConvergence, StepsSayWhetherTheyConverged) {
  GasOptions options = make_air();
  options.solver.outer_tolerance = 1e-6;
  options.solver.max_outer_iterations = 2;
  GasSolver loose = make_jet(options);
  const auto exchange = make_empty_exchange(loose.grid());
  const StepReport first = loose.update(1e-3, exchange);
  EXPECT_FALSE(first.converged);
  EXPECT_GT(first.velocity_change, 1e-6);

  options.solver.max_outer_iterations = 100;
  options.solver.require_convergence = true;
  GasSolver tight = make_jet(options);
  for (int step = 0; step < 5; ++step) {
    const StepReport report = tight.update(1e-3, exchange);
    EXPECT_TRUE(report.converged);
    EXPECT_LT(report.velocity_change, 1e-6);
    EXPECT_GT(report.outer_iterations, 2);
  }
}

TEST(GasConvergence, RequiredStopsTheRunAndSaysWhere) {
  GasOptions options = make_air();
  options.solver.require_convergence = true;
  GasSolver solver = make_jet(options);
  const auto exchange = make_empty_exchange(solver.grid());
  try {
    solver.update(1e-3, exchange);
    FAIL() << "nothing was thrown";
  } catch (const RunError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("after 2 outer iterations face velocities still change by"), std::string::npos)
        << what;
    EXPECT_NE(what.find("solver.outer_tolerance 1e-06 is required, in cell ("), std::string::npos) << what;
    EXPECT_NE(what.find(") m, at t = 0 s"), std::string::npos) << what;
  }
}

// 2 m/s are 20 cells in a step of 0.1 s and nothing to stop for; gas that already moves with 20 km/s is.
TEST(GasConvergence, GasGoneAstrayStopsTheRunAndSaysWhere) {
  GasSolver sound = make_jet(make_air());
  const auto exchange = make_empty_exchange(sound.grid());
  for (int step = 0; step < 20; ++step) sound.update(0.1, exchange);
  GasSolver astray = make_jet(make_air());
  astray.initialise({0, 0, 2e4});
  try {
    for (int step = 0; step < 3; ++step) astray.update(1e-3, exchange);
    FAIL() << "nothing was thrown";
  } catch (const RunError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("gas: the outer iterations do not converge: at a Courant number of "),
              std::string::npos)
        << what;
    EXPECT_NE(what.find("in cell ("), std::string::npos) << what;
  }
}

// The pressure solve leaves so much: a looser one leaves more, within a decade of its tolerance times the throughput.
TEST(GasConvergence, DivergenceFollowsThePressureTolerance) {
  std::vector<Real> divergence;
  for (const Real tolerance : {1e-3, 1e-6, 1e-9}) {
    GasOptions options = make_air();
    options.solver.pressure_tolerance = tolerance;
    GasSolver solver = make_jet(options);
    const StepReport report = advance(solver, make_empty_exchange(solver.grid()), 1e-3, 3);
    // All residuals together are at most tolerance x throughput: about 2 m/s x 2 cells of 1e-4 m2 upwards, twice that
    // with what goes sideways, plus what goes on beyond; a cell has 1e-6 m3 and the step is 1e-3 s.
    EXPECT_LT(report.divergence, tolerance * 4 * (2 * 2e-4) * 1e-3 / 1e-6) << tolerance;
    divergence.push_back(report.divergence);
  }
  EXPECT_GT(divergence[0], 10 * divergence[1]);
  EXPECT_GT(divergence[1], 10 * divergence[2]);
}

// Sweeps in single precision solve for the velocities of short steps, BiCGStab for those of long ones; the residual that
// is reported is one in double precision, far below what single precision (6e-8) can have of the velocities alone.
TEST(GasConvergence, MomentumComesDownToItsTolerance) {
  for (const Real dt : {1e-5, 1e-3, 1e-1, 1e2}) {
    for (const Real tolerance : {1e-4, 1e-8, 1e-12}) {
      GasOptions options = make_air();
      options.solver.momentum_tolerance = tolerance;
      GasSolver solver = make_jet(options);
      const StepReport report = solver.update(dt, make_empty_exchange(solver.grid()));
      EXPECT_LE(report.momentum_residual, tolerance) << dt;
      EXPECT_GT(report.momentum_iterations, 0) << dt;
    }
  }
}

TEST(GasConvergence, CourantNumberOfAStepCountsInletsBeforeTheFirstStep) {
  GasSolver solver = make_jet(make_air());
  // Only the inlet's faces move: 2 m/s over 1 cm.
  EXPECT_NEAR(solver.courant_number(1e-3), 0.2, 1e-12);
  EXPECT_NEAR(solver.courant_number(1e-2), 2, 1e-12);
  // Uniform flow across all three axes, with half the room: |u| dt / width, added up.
  const CartesianGrid grid(Box{{0, 0, 0}, {0.08, 0.05, 0.03}}, {8, 10, 6}, {true, true, true});
  GasSolver periodic(grid, make_air(), {});
  auto exchange = make_empty_exchange(grid);
  Kokkos::deep_copy(exchange.void_fraction, 0.5);
  periodic.initialise(Vec3{1, -0.5, 0.25}, exchange.void_fraction);
  EXPECT_NEAR(periodic.courant_number(1e-3), 1e-3 * (1 / 0.01 + 0.5 / 0.005 + 0.25 / 0.005), 1e-12);
}

}  // namespace
}  // namespace pellicle::cfd
