// A hole in a packed bed draws gas in from the sides: what makes a bubble a bubble and not a gap.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

// A round hole of radius a in an unbounded bed in which the gas obeys Darcy's law is an inclusion without resistance
// (2-D; Maxwell 1873): its middle plane carries twice the superficial flux from far away. Symmetry walls a distance W
// apart put a row of images beside it, which take 2 zeta(2) (a/W)^2 = 2.3 % off what reaches the hole (first order in
// the images). The edge is a staircase, a = 4 cells: an area error of a few per cent, which 5 % bounds. 100 steps of
// 1e-4 s are ten times what the gas in the hole needs to get going.
TEST(HoleInBed, DrawsTwiceTheSuperficialVelocity) {
  constexpr Index n = 40;
  constexpr Real width = 0.12, radius = 0.012, superficial = 0.1;
  const CartesianGrid grid(Box{{0, 0, 0}, {width, 0.01, width}}, {n, 1, n});
  GasSolver solver(grid, make_air(), make_duct(superficial));
  auto exchange = make_empty_exchange(grid);
  const auto from_centre = [](Index i, Real sub) {
    return (static_cast<Real>(i) + sub) * width / n - width / 2;
  };
  for (Index k = 0; k < n; ++k) {
    for (Index i = 0; i < n; ++i) {
      constexpr int samples = 20;
      int inside = 0;
      for (int s = 0; s < samples * samples; ++s) {
        const Real x = from_centre(i, (s % samples + 0.5) / samples);
        const Real z = from_centre(k, (s / samples + 0.5) / samples);
        inside += x * x + z * z < radius * radius ? 1 : 0;
      }
      const Real share = static_cast<Real>(inside) / (samples * samples);
      exchange.void_fraction(i + n * k) = 0.42 + share * 0.58;
      exchange.exchange_coefficient(i + n * k) = 3000 * (1 - share);
    }
  }
  solver.initialise(Vec3{0, 0, superficial}, exchange.void_fraction);
  advance(solver, exchange, 1e-4, 100);
  // Through the middle plane, which lies between two rows of cells: the mean of the two.
  Real flux = 0;
  for (const Index k : {n / 2 - 1, n / 2}) {
    for (Index i = 0; i < n; ++i) {
      const Real share = std::clamp(0.5 + (radius - std::abs(from_centre(i, 0.5))) * n / width, 0.0, 1.0);
      flux +=
          0.5 * share * exchange.void_fraction(i + n * k) * solver.state().velocity(i + n * k).z * width / n;
    }
  }
  EXPECT_NEAR(flux / (2 * radius * superficial), 2 * (1 - 0.023), 0.1);
}

}  // namespace
}  // namespace pellicle::cfd
