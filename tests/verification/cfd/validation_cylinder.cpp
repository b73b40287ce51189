// Vortices behind a cylinder at Re 100, with steps of three lengths: some minutes, so not part of the tests that always run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/csv.hpp"
#include "tests/verification/cfd/cylinder.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::cfd {
namespace {

// Schaefer & Turek's bounds of 2D-2: largest drag 3.22 to 3.24, largest lift 0.99 to 1.01, Strouhal number 0.295 to 0.305.
class ShedsVortices : public testing::TestWithParam<int> {};

TEST_P(ShedsVortices, AtRe100) {
  const Real dt = 1e-3 * GetParam();
  CylinderFlow flow(24, 1.0);
  const ParticleExchange exchange = make_empty_exchange(flow.gas().grid());
  Real largest_drag = 0, largest_lift = 0, before = 0;
  std::vector<Real> rises;  // times at which the lift goes through zero upwards
  core::CsvTable curve{{"time [s]", "drag coefficient [-]", "lift coefficient [-]"}, {{}, {}, {}}};
  for (int step = 1; step * dt <= 8; ++step) {
    flow.gas().update(dt, exchange);
    const Real time = step * dt;
    const Real drag = flow.drag();
    const Real lift = flow.lift();
    if (step % (20 / GetParam()) == 0) {
      curve.columns[0].push_back(time);
      curve.columns[1].push_back(drag);
      curve.columns[2].push_back(lift);
    }
    if (time > 6) {
      largest_drag = std::max(largest_drag, drag);
      largest_lift = std::max(largest_lift, lift);
      if (before < 0 && lift >= 0) rises.push_back(time - dt * lift / (lift - before));
    }
    before = lift;
  }
  ASSERT_GT(rises.size(), 2u);
  const Real period = (rises.back() - rises.front()) / static_cast<Real>(rises.size() - 1);
  const std::string steps = std::to_string(GetParam()) + " ms";
  const std::string why = "DFG 2D-2, 24 cells a diameter, implicit Euler";
  tests::record_line("cylinder at Re 100, steps of " + steps + ": largest drag coefficient", "3.22 to 3.24",
                     largest_drag, why);
  tests::record_line("cylinder at Re 100, steps of " + steps + ": largest lift coefficient", "0.99 to 1.01",
                     largest_lift, why);
  tests::record_line("cylinder at Re 100, steps of " + steps + ": Strouhal number", "0.295 to 0.305",
                     0.1 / period, why);
  tests::keep_curve("cylinder_re100_" + std::to_string(GetParam()) + "ms", curve);
  EXPECT_NEAR(0.1 / period, 0.3, 0.03);
}

// Implicit Euler damps: at a period of 0.33 s the amplitude of the lift shows it.
INSTANTIATE_TEST_SUITE_P(Cylinder, ShedsVortices, testing::Values(4, 2, 1));

}  // namespace
}  // namespace pellicle::cfd
