// A pipe that leans by 1 in 4 between the bottom and the top of the domain, in steady laminar flow (Hagen and Poiseuille).
#pragma once

#include <cmath>
#include <numbers>

#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {

// Flow rate through the outlet less that of the inlets, relative, during one more step.
inline Real mass_error(GasSolver& gas, Real dt) {
  const Real in = gas.balance().mass_in();
  const Real out = gas.balance().mass_out();
  gas.update(dt, make_empty_exchange(gas.grid()));
  const Real flow = gas.balance().mass_in() - in;
  return std::abs(gas.balance().mass_out() - out - flow) / flow;
}

// Steps until what `figure` gives changes by less than 1e-6 of itself in each of five steps; so many steps it took.
template <class Figure>
int march_until_still(GasSolver& gas, Real dt, int most, Figure&& figure) {
  const ParticleExchange exchange = make_empty_exchange(gas.grid());
  Real before = 0;
  int still = 0;
  int step = 0;
  for (; step < most && still < 5; ++step) {
    gas.update(dt, exchange);
    const Real now = figure();
    still = std::abs(now - before) < 1e-6 * std::abs(now) ? still + 1 : 0;
    before = now;
  }
  EXPECT_EQ(still, 5) << "not steady after " << step << " steps";
  return step;
}

struct PipeResult {
  Real drop_error = 0;  // of the pressure gradient, relative to Hagen and Poiseuille's
  Real mass = 0;
};

// A pipe of radius R that leans by 1 in 4 from the bottom to the top of the domain.
inline PipeResult run_tilted_pipe(Index cells_per_radius) {
  constexpr Real radius = 0.1;
  constexpr Real flow = 1e-3;
  const Index n = 10 * cells_per_radius;  // over 1 m of height
  const Real h = 1.0 / n;
  const auto half_x = 2.5 * radius;
  const auto half_y = 1.25 * radius;
  const Index nx = static_cast<Index>(std::lround(2 * half_x / h));
  const Index ny = static_cast<Index>(std::lround(2 * half_y / h));
  const CartesianGrid grid(Box{{-half_x, -half_y, 0}, {half_x, half_y, 1}}, {nx, ny, n});
  const Vec3 along = (1 / std::sqrt(17.0)) * Vec3{1, 0, 4};
  ImmersedGeometry immersed;
  immersed.surfaces = {{"pipe", {RevolvedSurface{{-0.125, 0, 0}, along, radius, -1, radius, 3}}, {}, {}, {}}};
  immersed.inside = {-0.125, 0, 1e-4};
  GasOptions options = make_air(Convection::central);
  options.density = 1;
  options.viscosity = 0.01;
  options.gravity = {};
  make_tight(options);
  GasSolver gas(
      grid, options,
      {{"inlet", Side::z_min, {}, Inlet{{}, flow}, "1"}, {"outlet", Side::z_max, {}, Outlet{0}, "2"}},
      immersed);
  // Between planes that the lattice of cells maps onto each other.
  const auto gradient = [&] {
    return (gas.plane_pressure(2, 0.3) - gas.plane_pressure(2, 0.7)) / (0.4 * std::sqrt(17.0) / 4);
  };
  // Steps of a sixth of the time in which friction stops the gas, R^2/(5.8 nu): much longer ones converge slowly.
  march_until_still(gas, 0.03, 400, gradient);
  const Real exact = 8 * options.viscosity * flow / (std::numbers::pi * radius * radius * radius * radius);
  return {gradient() / exact - 1, mass_error(gas, 0.03)};
}

}  // namespace pellicle::cfd
