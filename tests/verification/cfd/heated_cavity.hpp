// Buoyancy-driven flow in a square cavity whose left wall is hot and whose right wall is cold.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "tests/cfd/gas_for_tests.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::cfd {

// De Vahl Davis, Int. J. Numer. Methods Fluids 3 (1983) 249, Pr 0.71, reference/devahldavis_cavity.csv: largest
// velocities on the centre lines over alpha/L, and the Nusselt number of the hot wall.
struct CavityBenchmark {
  Real rayleigh, horizontal, vertical, nusselt;
};

struct CavityFlow {
  Real horizontal = 0, vertical = 0, nusselt = 0, energy_defect = 0, change = 0;
};

// All in units of L, alpha and the temperature difference; the plane is that of x and z, gravity 1 along -z.
inline CavityFlow run_cavity(Real rayleigh, Index n, Real time, int steps) {
  constexpr Real prandtl = 0.71;
  GasOptions options = make_air();
  options.density = 1;
  options.viscosity = prandtl;
  options.gravity = {0, 0, -1};
  options.boussinesq = Boussinesq{rayleigh * prandtl, 0.5};
  ScalarOptions& heat = options.scalars[index_of(Scalar::temperature)].emplace();
  heat.conductivity = 1;
  heat.initial = heat.reference = 0.5;
  const CartesianGrid grid(Box{{0, 0, 0}, {1, 1, 1}}, {n, 1, n}, {false, true, false});
  GasSolver solver(grid, options,
                   {{"hot", Side::x_min, {}, NoSlip{}, "", {GivenValue{1}, Insulated{}}},
                    {"cold", Side::x_max, {}, NoSlip{}, "", {GivenValue{0}, Insulated{}}}});
  const auto exchange = make_empty_exchange(grid);
  const Real dt = time / steps;
  advance(solver, exchange, dt, steps - 1);
  const auto heat_in = [&](std::size_t wall) { return solver.balance(Scalar::temperature)->into[wall]; };
  const Real before = heat_in(0);
  const Real speed_before = solver.state().velocity(grid.index(n / 4, 0, n / 2)).z;
  advance(solver, exchange, dt, 1);
  CavityFlow flow;
  flow.nusselt = (heat_in(0) - before) / dt;
  flow.change = std::abs(solver.state().velocity(grid.index(n / 4, 0, n / 2)).z - speed_before);
  const auto& u = solver.state().velocity;
  for (Index i = 0; i < n; ++i) {
    flow.horizontal =
        std::max(flow.horizontal, 0.5 * (u(grid.index(n / 2 - 1, 0, i)).x + u(grid.index(n / 2, 0, i)).x));
    flow.vertical =
        std::max(flow.vertical, 0.5 * (u(grid.index(i, 0, n / 2 - 1)).z + u(grid.index(i, 0, n / 2)).z));
  }
  flow.energy_defect = solver.balance(Scalar::temperature)->defect();
  flow.change /= flow.vertical;
  return flow;
}

inline void compare_cavity(const CavityBenchmark& benchmark, Index n, Real time, int steps, Real tolerance) {
  const CavityFlow flow = run_cavity(benchmark.rayleigh, n, time, steps);
  const std::string at = "cavity at Ra " + tests::show(benchmark.rayleigh) + ", " + tests::show(n) + " x " +
                         tests::show(n) + " cells: ";
  const std::string why = "second order on these cells, and the maximum is taken at cell centres";
  tests::expect_line(at + "largest horizontal velocity", benchmark.horizontal, flow.horizontal,
                     tolerance * benchmark.horizontal, why);
  tests::expect_line(at + "largest vertical velocity", benchmark.vertical, flow.vertical,
                     tolerance * benchmark.vertical, why);
  tests::expect_line(at + "Nusselt number of the hot wall", benchmark.nusselt, flow.nusselt,
                     tolerance * benchmark.nusselt, why);
  tests::expect_small(at + "defect of the energy", flow.energy_defect, 1e-8, "bar of the project");
  tests::expect_small(at + "change in the last step", flow.change, 1e-5, "steady");
}

}  // namespace pellicle::cfd
