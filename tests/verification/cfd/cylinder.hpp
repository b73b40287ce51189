// A cylinder of 0.1 m in a channel of 0.41 m, somewhat off its middle: Schaefer & Turek, Benchmark computations of laminar
// flow around a cylinder (1996), test cases 2D-1 (Re 20) and 2D-2 (Re 100). A parabola comes in row by row.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/graded_axis.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {

// Steps until the velocity no longer changes, and says how well mass is kept then.
inline Real march_to_steady(GasSolver& gas, Real dt, int most) {
  const ParticleExchange exchange = make_empty_exchange(gas.grid());
  Real largest = 0;
  for (int step = 0; step < most; ++step) {
    std::vector<Vec3> before(gas.state().velocity.data(),
                             gas.state().velocity.data() + gas.grid().cell_count());
    gas.update(dt, exchange);
    Real change = 0;
    largest = 0;
    for (std::size_t c = 0; c < before.size(); ++c) {
      change = std::max(change, norm(gas.state().velocity(c) - before[c]));
      largest = std::max(largest, norm(before[c]));
    }
    if (change < 1e-6 * largest) break;
  }
  return largest;
}

class CylinderFlow {
 public:
  CylinderFlow(Index cells_per_diameter, Real mean_velocity)
      : mean_(mean_velocity), size_(diameter / cells_per_diameter), gas_(make()) {}

  GasSolver& gas() { return gas_; }
  Real drag() const { return scale() * gas_.surface_force(0).x; }
  Real lift() const { return scale() * gas_.surface_force(0).y; }

  /// Pressure in front of less that behind the cylinder, each carried on to it from two cells [Pa].
  Real pressure_difference() const {
    const CartesianGrid& grid = gas_.grid();
    const Index j = grid.locate(1, 0.2);
    const auto at_wall = [&](Real wall, int away) {
      const Index i = grid.locate(0, wall + away * 0.75 * size_);
      const Real p0 = gas_.state().pressure(grid.index(i, j, 0));
      const Real p1 = gas_.state().pressure(grid.index(i + away, j, 0));
      const Real share = (wall - grid.center(0, i)) / (grid.center(0, i + away) - grid.center(0, i));
      return p0 + share * (p1 - p0);
    };
    return at_wall(0.15, -1) - at_wall(0.25, 1);
  }

 private:
  static constexpr Real diameter = 0.1, height = 0.41, depth = 0.05;

  Real scale() const { return 2 / (depth * mean_ * mean_ * diameter); }

  GasSolver make() const {
    const std::vector<Real> x = make_graded_faces(0, 2.2, 0.05, 1.08, {{0.12, 0.34, size_}}, false);
    const std::vector<Real> y = make_graded_faces(0, height, 3 * size_, 1.08, {{0.12, 0.28, size_}}, false);
    const CartesianGrid grid({x, y, {0, depth}});
    ImmersedGeometry immersed;
    immersed.surfaces = {{"cylinder",
                          {RevolvedSurface{{0.2, 0.2, -1}, {0, 0, 1}, 0.5 * diameter, 0, 0.5 * diameter, 2}},
                          {},
                          {},
                          {}}};
    immersed.inside = {0.01, 0.2, 0.02};
    GasOptions options = make_air(Convection::quick);
    options.density = 1;
    options.viscosity = 1e-3;
    options.gravity = {};
    options.solver.momentum_tolerance = 1e-10;
    options.solver.max_outer_iterations = 3;
    std::vector<BoundaryPatch> patches = symmetry_on({Side::z_min, Side::z_max});
    const auto integral = [&](Real at) {
      return 6 * mean_ * (at * at / (2 * height) - at * at * at / (3 * height * height));
    };
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      patches.push_back({"row" + std::to_string(j), Side::x_min, Box{{0, y[j], 0}, {0, y[j + 1], depth}},
                         Inlet{(integral(y[j + 1]) - integral(y[j])) / (y[j + 1] - y[j]), {}}, "1"});
    }
    patches.push_back({"outlet", Side::x_max, {}, Outlet{0}, "2"});
    return {grid, options, patches, immersed};
  }

  Real mean_, size_;
  GasSolver gas_;
};

}  // namespace pellicle::cfd
