// Backward-facing step made of a block among the walls of a case, whose top and end lie within cells: where the flow
// reattaches.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/graded_axis.hpp"
#include "tests/cfd/gas_for_tests.hpp"
#include "tests/verification/dem/verification_table.hpp"
#include "tools/pellicle/build_gas.hpp"
#include "tools/pellicle/case_file.hpp"

namespace pellicle::tools {
namespace {

std::string list_of(const std::vector<Real>& numbers) {
  std::string text;
  for (const Real number : numbers) text += fmt::format("{}{:.17g}", text.empty() ? "" : ", ", number);
  return "[" + text + "]";
}

// Step of height 1 in a channel of height 2, of which 6 lie before the step and 30 after it. With an odd number of rows the
// block's top halves a row and its end lies a third into a cell; with an even number both lie on the grid's lines. A parabola of mean velocity 1 comes in, one inlet a row with
// the mean over what is open of it. Reynolds number: that velocity and twice the height of the channel before the step.
std::string make_case(Real reynolds, Index rows) {
  const Real height = 2.0 / rows;
  std::vector<Real> vertical;
  for (Index k = 0; k <= rows; ++k) vertical.push_back(k * height);
  vertical.back() = 2;
  const Real shift = rows % 2 == 1 ? height / 3 : 0;
  const std::vector<Real> along = make_graded_faces(
      -6, 30, 16 * height, 1.1,
      {{-0.5 + shift, -0.5 + shift + std::ceil(1 / height) * height, height}, {0, 10, 2 * height}}, false);
  std::string inlets;
  for (Index k = rows / 2; k < rows; ++k) {
    const Real low = std::max<Real>(0, vertical[static_cast<std::size_t>(k)] - 1);
    const Real high = vertical[static_cast<std::size_t>(k) + 1] - 1;
    // The integral of 6 s (1 - s) is 3 s2 - 2 s3.
    const auto flow = [](Real s) { return s * s * (3 - 2 * s); };
    inlets += fmt::format(
        "    - {{name: row{}, on: left, region: {{box: {{min: [-6, 0, {:.17g}], max: [-6, 1, {:.17g}]}}}}, "
        "inlet: {{velocity: {:.17g}}}}}\n",
        k, 1 + low, 1 + high, (flow(high) - flow(low)) / (high - low));
  }
  return fmt::format(R"(domain: {{min: [-6, 0, 0], max: [30, 1, 2]}}
time: {{end: 1, gas_step: 0.1}}
walls:
  - {{name: step, block: {{min: [-7, -1, -1], max: [0, 2, 1]}}, material: wall}}
  - {{name: sides, box: domain, material: wall}}
gas:
  density: 1
  viscosity: {:.17g}
  inside: [1, 0.5, 1.5]
  velocity: [0.5, 0, 0]
  grid:
    faces:
      x: {}
      y: [0, 1]
      z: {}
  boundaries:
{}    - {{name: out, on: right, outlet: {{}}}}
    - {{name: near, on: front, symmetry: {{}}}}
    - {{name: far, on: back, symmetry: {{}}}}
)",
                     2 / reynolds, list_of(along), list_of(vertical), inlets);
}

struct Reattachment {
  Real place = 0;                        ///< from the step [its heights]
  std::vector<Real> distance, gradient;  ///< along the floor: of the velocity at it [1/s]
};

Reattachment run_step(Real reynolds, Index rows, Real dt) {
  const CaseSpec spec = parse_case(make_case(reynolds, rows), "step.yaml");
  cfd::GasSolver gas = make_gas_solver(spec, make_walls(spec));
  gas.initialise(spec.gas->velocity);
  const CartesianGrid& grid = gas.grid();
  const Index cut = gas.geometry().part_cells;  // an even number of rows: at the corner alone
  EXPECT_TRUE(rows % 2 == 1 ? cut > rows / 2 : cut <= 1) << cut;
  const cfd::ParticleExchange exchange = cfd::make_empty_exchange(grid);
  int steps = 0;
  // Until no velocity changes by more than 2e-5 in unit time.
  for (Real change = 1; change > 2e-5 * dt && steps * dt < 300; ++steps) {
    const auto before = cfd::copy_of(gas.state().velocity);
    gas.update(dt, exchange);
    change = cfd::largest_difference(before, gas.state().velocity);
  }
  const auto& patches = gas.balance().patches;
  Real in = 0, out = 0;
  for (const auto& patch : patches) in -= patch.mass_in, out -= patch.mass_out;
  gas.update(dt, exchange);
  for (const auto& patch : patches) in += patch.mass_in, out += patch.mass_out;
  EXPECT_NEAR(in, dt, 1e-10 * dt);  // mean velocity 1, height 1, width 1, density 1; a difference of sums
  EXPECT_NEAR(out, in, 1e-8 * in);
  Reattachment found;
  const Real height = grid.width(2, 0);
  for (Index i = grid.locate(0, 0.1); i < grid.cells().x; ++i) {
    // The parabola through the floor's 0 and the velocities half a row and one and a half above.
    const Real lower = gas.state().velocity(grid.index(i, 0, 0)).x;
    const Real upper = gas.state().velocity(grid.index(i, 0, 1)).x;
    found.distance.push_back(grid.center(0, i));
    found.gradient.push_back((9 * lower - upper) / (3 * height));
  }
  // Close to the corner a small eddy turns the other way: the last change of sign before the flow goes on forward.
  for (std::size_t i = 0; i + 1 < found.distance.size(); ++i) {
    const Real a = found.gradient[i], b = found.gradient[i + 1];
    if (a < 0 && b >= 0)
      found.place = found.distance[i] + (found.distance[i + 1] - found.distance[i]) * a / (a - b);
  }
  std::printf("Re %g, %d rows, %d x %d cells, %d steps of %g s: reattaches at %.4f\n", reynolds, rows,
              grid.cells().x, grid.cells().z, steps, dt, found.place);
  return found;
}

struct Erturk {
  Real reynolds, reattachment;
};

class CutStep : public testing::TestWithParam<Erturk> {};

// Erturk, Comput. Fluids 37 (2008) 633. Cut cells are of an order between 1 and 2 (docs/theory/immersed.md), and the corner is
// rounded by half a cell: errors of a few per cent with 33 rows, about half of it with 65.
TEST_P(CutStep, ReattachesWhereErturkFinds) {
  const auto [reynolds, expected] = GetParam();
  const Reattachment coarse = run_step(reynolds, 17, 0.4);
  const Reattachment middle = run_step(reynolds, 33, 0.2);
  const Reattachment fine = run_step(reynolds, 65, 0.1);
  const Reattachment along_lines = run_step(reynolds, 64, 0.1);
  const std::string name = "Re_" + tests::show(reynolds);
  tests::keep_curve("cut_step_" + name, {{"x", "gradient"}, {fine.distance, fine.gradient}});
  const std::string line = "step of a block, " + name + ": reattachment / height";
  tests::record_line(line + ", 17 rows", tests::show(expected), coarse.place, "Erturk 2008");
  tests::record_line(line + ", 33 rows", tests::show(expected), middle.place, "Erturk 2008");
  tests::expect_line(line + ", 65 rows", expected, fine.place, 0.02 * expected,
                     "Erturk 2008; not extrapolated");
  tests::expect_line(line + ", 64 rows, block along grid lines", expected, along_lines.place, 0.02 * expected,
                     "Erturk 2008; not extrapolated");
}

INSTANTIATE_TEST_SUITE_P(Reynolds, CutStep,
                         testing::Values(Erturk{100, 2.922}, Erturk{200, 4.982}, Erturk{300, 6.761},
                                         Erturk{400, 8.237}),
                         [](const auto& test) { return "Re" + tests::show(test.param.reynolds); });

}  // namespace
}  // namespace pellicle::tools
