// Backward-facing step of expansion ratio 2: where the flow reattaches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/graded_axis.hpp"
#include "tests/cfd/gas_for_tests.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::cfd {
namespace {

// Step of height 1 in a channel of height 2. The Reynolds number is that of Armaly et al.: mean velocity in the channel
// before the step and twice its height.
struct Step {
  Real reattachment = 0;  ///< from the step [its heights]
  std::vector<Real> place, wall_velocity;
};

struct StepCase {
  Real reynolds = 100;
  Index rows = 32;
  Real dt = 0.2;
  bool channel = true;  ///< before the step; else the gas comes in at the step
};

// The channel before the step has five times its height; below it the gas is held by a bed that lets nothing through.
// Such a bed begins half a cell below its first cells' tops, which is first order.
// Without it a parabola of mean velocity 1 comes in above the step, one inlet a row of cells with the mean over it.
std::vector<BoundaryPatch> step_boundaries(const StepCase& c, const std::vector<Real>& vertical) {
  auto patches = symmetry_on({Side::y_min, Side::y_max});
  patches.push_back({"outlet", Side::x_max, {}, Outlet{0}, "case.yaml:2"});
  const Real x = c.channel ? -5 : 0;
  if (c.channel)
    patches.push_back({"inlet", Side::x_min, Box{{x, 0, 1}, {x, 1, 2}}, Inlet{1, {}}, "case.yaml:1"});
  for (Index k = c.rows / 2; k < c.rows && !c.channel; ++k) {
    const Real low = vertical[static_cast<std::size_t>(k)] - 1;
    const Real high = vertical[static_cast<std::size_t>(k) + 1] - 1;
    // The integral of 6 s (1 - s) is 3 s2 - 2 s3.
    const auto flow = [](Real s) { return s * s * (3 - 2 * s); };
    const Real mean = (flow(high) - flow(low)) / (high - low);
    patches.push_back({"row" + std::to_string(k), Side::x_min, Box{{x, 0, 1 + low}, {x, 1, 1 + high}},
                       Inlet{mean, {}}, "case.yaml:1"});
  }
  return patches;
}

/// Iterates until no velocity changes by more than 5e-6 in unit time.
void make_steady(GasSolver& solver, const ParticleExchange& exchange, Real dt) {
  int steps = 0;
  for (Real change = 1; change > 5e-6 * dt && steps * dt < 500; ++steps) {
    const auto before = copy_of(solver.state().velocity);
    solver.update(dt, exchange);
    change = largest_difference(before, solver.state().velocity);
  }
  std::printf("%d steps of %g s\n", steps, dt);
}

Step run_step(const StepCase& c) {
  GasOptions options = make_air();
  options.density = 1;
  options.viscosity = 2 / c.reynolds;
  const Real height = 2.0 / c.rows;
  std::vector<Real> vertical;
  for (Index k = 0; k <= c.rows; ++k) vertical.push_back(k * height);
  vertical.back() = 2;
  const std::vector<Real> along = make_graded_faces(c.channel ? -5 : 0, 30, 16 * height, 1.1,
                                                    {{0, 10, 2 * height}, {-0.5, 0.5, height}}, false);
  const CartesianGrid grid({{along, {0, 1}, vertical}}, {false, false, false});
  GasSolver solver(grid, options, step_boundaries(c, vertical));
  solver.initialise(Vec3{0.5, 0, 0});
  const auto exchange = make_empty_exchange(grid);
  for (Index cell = 0; cell < grid.cell_count(); ++cell) {
    const Index3 at = grid.coordinates(cell);
    if (grid.center(0, at.x) < 0 && grid.center(2, at.z) < 1) exchange.exchange_coefficient(cell) = 1e8;
  }
  make_steady(solver, exchange, c.dt);
  Step step;
  for (Index i = grid.locate(0, 1e-6); i < grid.cells().x; ++i) {
    step.place.push_back(grid.center(0, i));
    step.wall_velocity.push_back(solver.state().velocity(grid.index(i, 0, 0)).x);
  }
  // Close to the corner a small eddy turns the other way: the last change of sign before the flow goes on forward.
  for (std::size_t i = 0; i + 1 < step.place.size(); ++i) {
    const Real a = step.wall_velocity[i];
    const Real b = step.wall_velocity[i + 1];
    if (a < 0 && b >= 0)
      step.reattachment = step.place[i] + (step.place[i + 1] - step.place[i]) * a / (a - b);
  }
  std::printf("Re %g, %d rows, %d x %d cells: reattaches at %.4f\n", c.reynolds, c.rows, grid.cells().x,
              grid.cells().z, step.reattachment);
  return step;
}

struct Erturk {
  Real reynolds, reattachment, allowed;
};

class BackwardStep : public testing::TestWithParam<Erturk> {};

// Erturk, Comput. Fluids 37 (2008) 633. What half a cell of step costs is first order: twice the difference that 32 rows
// make to 16 is taken off, which leaves second-order terms of some hundredths.
TEST_P(BackwardStep, ReattachesWhereErturkFinds) {
  const auto [reynolds, expected, allowed] = GetParam();
  const Step coarse = run_step({reynolds, 16, 0.4});
  const Step fine = run_step({reynolds, 32, 0.2});
  const std::string name = "Re_" + tests::show(reynolds);
  tests::keep_curve("step_" + name, {{"x", "velocity"}, {fine.place, fine.wall_velocity}});
  tests::expect_line("backward-facing step, " + name + ": reattachment / height of the step", expected,
                     2 * fine.reattachment - coarse.reattachment, allowed,
                     "Erturk 2008; 16 rows " + tests::show(coarse.reattachment) + ", 32 rows " +
                         tests::show(fine.reattachment) + ", extrapolated to first order");
}

// Without the channel nothing slows the gas near its lower wall before the step, and it is held straight there.
TEST(BackwardStepInlet, AtTheStepReattachesLater) {
  const Step step = run_step({100, 32, 0.2, false});
  tests::record_line("backward-facing step, Re_100, parabola at the step: reattachment / height", "2.922",
                     step.reattachment, "Erturk 2008, with a channel before the step");
  EXPECT_GT(step.reattachment, 2.922);
}

INSTANTIATE_TEST_SUITE_P(Reynolds, BackwardStep,
                         testing::Values(Erturk{100, 2.922, 0.05}, Erturk{200, 4.982, 0.1},
                                         Erturk{300, 6.761, 0.15}, Erturk{400, 8.237, 0.2}),
                         [](const auto& test) { return "Re" + tests::show(test.param.reynolds); });

}  // namespace
}  // namespace pellicle::cfd
