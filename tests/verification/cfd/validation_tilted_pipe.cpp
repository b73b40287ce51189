// The tilted pipe of test_immersed_bodies.cpp on more and finer grids: a minute, so not part of the tests that always run.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/verification/cfd/tilted_pipe.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::cfd {
namespace {

// Cut cells are of an order between 1 and 2 (docs/theory/immersed.md); how the grid happens to cut the pipe scatters the
// errors, so the order is that of a line through the logarithms of all of them.
TEST(TiltedPipe, ConvergesToHagenPoiseuille) {
  const std::vector<Index> sizes{4, 5, 6, 8, 10, 12};
  Real x = 0, y = 0, xx = 0, xy = 0;
  for (const Index cells : sizes) {
    const PipeResult result = run_tilted_pipe(cells);
    tests::record_line("tilted pipe, " + std::to_string(cells) + " cells a radius: pressure gradient", "0",
                       result.drop_error, "relative to Hagen-Poiseuille");
    EXPECT_LT(result.mass, 1e-10);
    const Real a = std::log(static_cast<Real>(cells)), b = std::log(std::abs(result.drop_error));
    x += a, y += b, xx += a * a, xy += a * b;
  }
  const auto n = static_cast<Real>(sizes.size());
  const Real order = -(n * xy - x * y) / (n * xx - x * x);
  tests::append_line("tilted pipe: order of the pressure gradient, 4 to 12 cells a radius", "at least 1",
                     tests::show(order), "-", order >= 1, "slope of the logarithms, least squares");
  EXPECT_GT(order, 1);
}

}  // namespace
}  // namespace pellicle::cfd
