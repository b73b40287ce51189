// Decaying Taylor-Green vortices: order of the scheme in space and in time.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

struct Vortices {
  Real deviation = 0;  ///< root mean square, of the maximum velocity
  Real amplitude = 0;  ///< projection on the initial field
};

// u = cos x sin z e^(-2 nu t), w = -sin x cos z e^(-2 nu t) in a periodic square of 2 pi.
Vortices decay(Index n, Real viscosity, Real dt, Real end, Convection scheme, bool stretched,
               int outer_iterations) {
  GasOptions options = make_air(scheme);
  options.density = 1;
  options.viscosity = viscosity;
  options.solver.max_outer_iterations = outer_iterations;
  const Real length = 2 * M_PI;
  std::array<std::vector<Real>, 3> faces;
  for (int a = 0; a < 3; ++a) {
    const Index cells = a == 1 ? 1 : n;
    for (Index i = 0; i <= cells; ++i) {
      const Real s = static_cast<Real>(i) / cells;
      faces[static_cast<std::size_t>(a)].push_back(
          length * (s + (stretched && a != 1 ? 0.03 * std::sin(length * s) : 0)));
    }
  }
  const CartesianGrid grid(faces, {true, true, true});
  GasSolver solver(grid, options, {});
  const auto exchange = make_empty_exchange(grid);
  HostArray<Vec3> initial("tests::cfd::initial", static_cast<std::size_t>(grid.cell_count()));
  for (Index c = 0; c < grid.cell_count(); ++c) {
    const Index3 at = grid.coordinates(c);
    const Real x = grid.center(0, at.x);
    const Real z = grid.center(2, at.z);
    initial(c) = {std::cos(x) * std::sin(z), 0, -std::sin(x) * std::cos(z)};
  }
  solver.initialise(initial, exchange.void_fraction);
  advance(solver, exchange, dt, static_cast<int>(std::lround(end / dt)));
  const Real factor = std::exp(-2 * viscosity * end);
  Real square = 0, projected = 0, own = 0;
  for (Index c = 0; c < grid.cell_count(); ++c) {
    square += norm_squared(solver.state().velocity(c) - factor * initial(c));
    projected += dot(solver.state().velocity(c), initial(c));
    own += norm_squared(initial(c));
  }
  return {std::sqrt(square / grid.cell_count()), projected / own};
}

void expect_orders(const char* what, const std::vector<Real>& deviation, Real least_order) {
  std::printf("Taylor-Green, %s: deviation", what);
  for (const Real d : deviation) std::printf(" %.3e", d);
  std::printf("; orders");
  for (std::size_t l = 1; l < deviation.size(); ++l) {
    const Real order = std::log2(deviation[l - 1] / deviation[l]);
    std::printf(" %.2f", order);
    EXPECT_GT(order, least_order) << what << ", level " << l;
  }
  std::printf("\n");
}

TEST(TaylorGreen, OrderInSpace) {
  // The step is so small that its error, 2 (2 nu)^2 end dt / 2 = 2e-6, does not show.
  const auto at = [](Index n, Convection scheme, bool stretched) {
    return decay(n, 0.05, 0.002, 0.2, scheme, stretched, 2).deviation;
  };
  const auto levels = [&](Convection scheme, bool stretched) {
    std::vector<Real> deviation;
    for (const Index n : {16, 32, 64}) deviation.push_back(at(n, scheme, stretched));
    return deviation;
  };
  // Upwind is of first order; 0.9 and 1.9 leave room for grids that are not yet fine.
  expect_orders("upwind", levels(Convection::upwind, false), 0.9);
  expect_orders("ultimate_quickest", levels(Convection::ultimate_quickest, false), 1.9);
  expect_orders("central", levels(Convection::central, false), 1.9);
  expect_orders("quick", levels(Convection::quick, false), 1.9);
  expect_orders("quick, stretched", levels(Convection::quick, true), 1.9);
}

// Implicit Euler: the amplitude's error is linear in the step. The spatial error cancels in the differences.
TEST(TaylorGreen, OrderInTime) {
  std::vector<Real> amplitude;
  for (const Real dt : {0.2, 0.1, 0.05, 0.025}) {
    amplitude.push_back(decay(32, 0.5, dt, 0.8, Convection::central, false, 10).amplitude);
  }
  std::vector<Real> differences;
  for (std::size_t l = 1; l < amplitude.size(); ++l)
    differences.push_back(std::abs(amplitude[l] - amplitude[l - 1]));
  expect_orders("in time", differences, 0.9);
  // The same by arithmetic: (1 + 2 nu dt)^-n of implicit Euler against e^(-2 nu t), within the spatial error.
  EXPECT_NEAR(amplitude[3], std::pow(1 + 0.025, -32), 0.004);
}

}  // namespace
}  // namespace pellicle::cfd
