// Buoyancy in a heated cavity, and heat transfer from the walls of a channel.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/verification/cfd/heated_cavity.hpp"

namespace pellicle::cfd {
namespace {

TEST(NaturalConvection, MatchesDeVahlDavisAtRa1e3) {
  compare_cavity({1e3, 3.649, 3.696, 1.117}, 32, 1, 100, 0.01);
}
TEST(NaturalConvection, MatchesDeVahlDavisAtRa1e4) {
  compare_cavity({1e4, 16.178, 19.617, 2.238}, 40, 0.8, 400, 0.01);
}

// Fully developed laminar flow between plates of one temperature: Nu = h 2H/k = 7.541 (Shah & London, Laminar Flow
// Forced Convection in Ducts, 1978), where the heat transfer coefficient counts from the bulk temperature. The Peclet
// number of 100 leaves conduction along the channel without influence, and at x = 12 H the profile has developed
// (x/(2H Pe) = 0.06).
TEST(HeatedChannel, HasTheNusseltNumberOfParallelPlates) {
  constexpr Index nx = 60, nz = 32;
  constexpr Real conductivity = 0.02, wall = 1;
  GasOptions options = make_air();
  options.density = 1;
  options.viscosity = 0.02;
  ScalarOptions& heat = options.scalars[index_of(Scalar::temperature)].emplace();
  heat.conductivity = conductivity;
  const CartesianGrid grid(Box{{0, 0, 0}, {15, 1, 1}}, {nx, 1, nz}, {false, true, false});
  GasSolver solver(grid, options,
                   {{"in", Side::x_min, {}, Inlet{1.0, {}}, "", {GivenValue{0}, Insulated{}}},
                    {"out", Side::x_max, {}, Outlet{0}, "", {}},
                    {"below", Side::z_min, {}, NoSlip{}, "", {GivenValue{wall}, Insulated{}}},
                    {"above", Side::z_max, {}, NoSlip{}, "", {GivenValue{wall}, Insulated{}}}});
  solver.initialise(Vec3{1, 0, 0});
  advance(solver, make_empty_exchange(grid), 0.1, 500);
  const auto& t = solver.state().scalars[index_of(Scalar::temperature)];
  const Index i = 48;  // centre at 12.1 H
  Real flow = 0, carried = 0;
  for (Index k = 0; k < nz; ++k) {
    const Real u = solver.state().velocity(grid.index(i, 0, k)).x;
    flow += u;
    carried += u * t(grid.index(i, 0, k));
  }
  const Real bulk = carried / flow;
  const Real flux = conductivity * (wall - t(grid.index(i, 0, 0))) / (0.5 / nz);
  tests::expect_line("channel between plates of one temperature: Nusselt number", 7.541,
                     flux / (wall - bulk) * 2 / conductivity, 0.01 * 7.541,
                     "second order on 32 cells; developed to e^-10");
  const ScalarBalance& balance = *solver.balance(Scalar::temperature);
  tests::expect_small("the same: defect of the energy", balance.defect(), 1e-8, "bar of the project");
  tests::expect_line("the same: heat through the lower wall over that through the upper", 1,
                     balance.into[2] / balance.into[3], 1e-8,
                     "symmetry, to the tolerance of the linear solves");
}

}  // namespace
}  // namespace pellicle::cfd
