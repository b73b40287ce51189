// Plane channel flow: the parabola, on uniform and stretched grids, along each axis.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

// Largest deviation from u = f / (2 mu) y (1 - y), of the maximum f / (8 mu). The flow goes along `along`, the walls
// are across `across`.
Real channel_deviation(Index n, int along, int across, bool stretched) {
  GasOptions options = make_air();
  options.density = 1;
  options.viscosity = 0.1;
  options.body_force[along] = 1;
  make_tight(options);
  std::array<std::vector<Real>, 3> faces{{{0, 1}, {0, 1}, {0, 1}}};
  faces[static_cast<std::size_t>(across)] = make_stretched_faces(1, n);
  if (!stretched) {
    for (Index i = 0; i <= n; ++i)
      faces[static_cast<std::size_t>(across)][static_cast<std::size_t>(i)] = static_cast<Real>(i) / n;
  }
  const CartesianGrid grid(faces, {across != 0, across != 1, across != 2});
  GasSolver solver(grid, options, {});
  advance(solver, make_empty_exchange(grid), 100, 30);
  Real worst = 0;
  for (Index i = 0; i < n; ++i) {
    const Real y = grid.center(across, i);
    worst = std::max(worst, std::abs(solver.state().velocity(i)[along] - 5 * y * (1 - y)));
  }
  return worst / 1.25;
}

// Second order: halving the cells divides the deviation by 4; 1.9 leaves room for grids that are not yet fine.
TEST(Channel, ParabolaWithSecondOrder) {
  for (const bool stretched : {false, true}) {
    for (const auto& [along, across] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{2, 0}}) {
      std::vector<Real> deviation;
      for (const Index n : {8, 16, 32, 64})
        deviation.push_back(channel_deviation(n, along, across, stretched));
      std::printf("channel along %d across %d %s: deviation at 64 cells %.3g, orders", along, across,
                  stretched ? "stretched" : "uniform", deviation.back());
      for (std::size_t l = 1; l < deviation.size(); ++l) {
        const Real order = std::log2(deviation[l - 1] / deviation[l]);
        EXPECT_GT(order, 1.9) << "axes " << along << across << " stretched " << stretched;
        std::printf(" %.3f", order);
      }
      std::printf("\n");
      EXPECT_LT(deviation.back(), 1e-3);
    }
  }
}

// Flow driven by an inlet, developing to the parabola: mean velocity 1 between plates, pressure gradient 12 mu.
TEST(Channel, DevelopsFromAnInlet) {
  GasOptions options = make_air();
  options.density = 1;
  options.viscosity = 0.1;
  const CartesianGrid grid(Box{{0, 0, 0}, {4, 1, 1}}, {40, 1, 20});
  auto patches = symmetry_on({Side::y_min, Side::y_max});
  patches.push_back({"inlet", Side::x_min, {}, Inlet{{}, 1.0}, "case.yaml:2"});
  patches.push_back({"outlet", Side::x_max, {}, Outlet{7}, "case.yaml:3"});
  GasSolver solver(grid, options, patches);
  solver.initialise(Vec3{1, 0, 0});
  const auto exchange = make_empty_exchange(grid);
  advance(solver, exchange, 0.05, 400);
  for (Index k = 0; k < 20; ++k) {
    const Real z = grid.center(2, k);
    // 20 cells: the wall cells' second-order error is 1/400 of the maximum 1.5, twice over.
    EXPECT_NEAR(solver.state().velocity(grid.index(35, 0, k)).x, 6 * z * (1 - z), 0.01);
  }
  EXPECT_NEAR((solver.plane_pressure(0, 3.0) - solver.plane_pressure(0, 3.5)) / 0.5, 12 * 0.1, 0.01);
  EXPECT_NEAR(solver.patch_pressure("outlet"), 7, 1e-12);
  EXPECT_LT(solver.balance().mass_defect(), 1e-10);
}

}  // namespace
}  // namespace pellicle::cfd
