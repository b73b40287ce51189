// A steady flow must not know with what step or relaxation it was reached.
#include <gtest/gtest.h>

#include <memory>
#include <tuple>
#include <utility>

#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

// A bed with an oblique edge, blown through a slot in the bottom: drag, void fraction, walls, a jet and stretched cells.
struct Bed {
  explicit Bed(GasOptions options, Real velocity_relaxation = 1)
      : grid({make_stretched_faces(0.06, 12), {0, 0.005}, make_stretched_faces(0.1, 16)}),
        exchange(make_empty_exchange(grid)) {
    make_tight(options);
    options.viscosity = 1e-3;  // laminar and steady: Reynolds number of the slot 12
    options.solver.velocity_relaxation = velocity_relaxation;
    auto patches = symmetry_on({Side::y_min, Side::y_max});
    patches.push_back(
        {"slot", Side::z_min, Box{{0.02, -1, -1}, {0.03, 1, 1}}, Inlet{1.0, {}}, "case.yaml:2"});
    patches.push_back({"bottom", Side::z_min, {}, Inlet{0.2, {}}, "case.yaml:2"});
    patches.push_back({"outlet", Side::z_max, {}, Outlet{0}, "case.yaml:3"});
    solver = std::make_unique<GasSolver>(grid, options, patches);
    for (Index c = 0; c < grid.cell_count(); ++c) {
      const Index3 at = grid.coordinates(c);
      if (grid.center(2, at.z) > 0.04 + 0.3 * grid.center(0, at.x)) continue;
      exchange.void_fraction(c) = 0.45;
      exchange.exchange_coefficient(c) = 800;
    }
    solver->initialise(Vec3{0, 0, 0.3}, exchange.void_fraction);
  }
  CartesianGrid grid;
  ParticleExchange exchange;
  std::unique_ptr<GasSolver> solver;
};

class SteadyFlow : public testing::TestWithParam<Convection> {};

// Two ways to look: going on from the steady state with other steps, and arriving from the start with other steps or
// with relaxed velocities. Tolerance: 1e-8 of the slot's velocity; linear solvers and settling leave less (1e-12).
TEST_P(SteadyFlow, IndependentOfStepAndRelaxation) {
  // The slowest motion settles in some tenths of L^2 / nu = 4 s.
  Bed reference(make_air(GetParam()));
  advance(*reference.solver, reference.exchange, 1e-2, 800);
  const auto steady = copy_of(reference.solver->state().velocity);
  for (const auto& [dt, steps] : {std::pair{1e-3, 500}, std::pair{1e-4, 1000}, std::pair{1e-5, 2000}}) {
    advance(*reference.solver, reference.exchange, dt, steps);
    EXPECT_LT(largest_difference(reference.solver->state().velocity, steady), 1e-8) << "step " << dt;
  }
  for (const auto& [dt, steps, relaxation] :
       {std::tuple{1e-3, 5000, 1.0}, std::tuple{1e-2, 800, 0.8}, std::tuple{2e-2, 800, 0.5}}) {
    Bed other(make_air(GetParam()), relaxation);
    advance(*other.solver, other.exchange, dt, steps);
    EXPECT_LT(largest_difference(other.solver->state().velocity, steady), 1e-8)
        << "step " << dt << ", relaxation " << relaxation;
  }
}

INSTANTIATE_TEST_SUITE_P(Schemes, SteadyFlow,
                         testing::Values(Convection::upwind, Convection::ultimate_quickest));

}  // namespace
}  // namespace pellicle::cfd
