// Scalars in one dimension: a step that is carried along, and profiles of convection and conduction with closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "cfd/scalar_transport.hpp"
#include "tests/cfd/prescribed_flow.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::cfd {
namespace {

struct Front {
  Real low = 0, high = 0;  ///< extremes over all steps
  Real diffusivity = 0;    ///< numerical, over velocity times cell width
  Real balance = 0;        ///< defect
};

// A step from 0 to 1 enters a duct of 200 cells and travels 100 of them. Without conduction the variance of -dv/dx grows
// by twice the numerical diffusivity per second.
Front carry_step(Convection scheme, Real courant) {
  constexpr Index cells = 200;
  PrescribedFlow gas = make_plug_flow(cells, cells, 1, 1.2);
  ScalarOptions options;
  ScalarTransport scalar("moisture", gas.geometry, gas.boundaries, {GivenValue{1}, Insulated{}}, options,
                         scheme);
  scalar.initialise(gas.fields);
  Front front;
  const auto variance = [&] {
    Real mean = 0, square = 0, before = 1;
    for (Index i = 0; i < cells; ++i) {
      const Real step = before - scalar.value()(i);
      mean += step * i;
      square += step * i * i;
      before = scalar.value()(i);
    }
    return square - mean * mean;
  };
  // From when the front has left the inlet's first cells.
  const int from = static_cast<int>(std::lround(40 / courant));
  const int until = static_cast<int>(std::lround(100 / courant));
  Real at_start = 0;
  for (int step = 1; step <= until; ++step) {
    scalar.update(gas.fields, courant, {});
    for (Index i = 0; i < cells; ++i) {
      front.low = std::min(front.low, scalar.value()(i));
      front.high = std::max(front.high, scalar.value()(i));
    }
    if (step == from) at_start = variance();
  }
  front.diffusivity = (variance() - at_start) / (2 * (until - from) * courant);
  front.balance = scalar.balance().defect();
  return front;
}

// Implicit Euler itself diffuses with half a Courant number, upwind with 1/2 more (from the moments of one step).
TEST(ScalarFront, StaysWithinBoundsAndSharperThanUpwind) {
  for (const Real courant : {0.1, 0.5, 1.0, 2.5}) {
    const std::string at = "step profile, Courant number " + tests::show(courant) + ", ";
    const Front upwind = carry_step(Convection::upwind, courant);
    const Front limited = carry_step(Convection::ultimate_quickest, courant);
    tests::expect_line(at + "upwind: numerical diffusivity / (u dx)", 0.5 * (1 + courant), upwind.diffusivity,
                       1e-4,
                       "(1 + Co)/2: moments of one implicit step; at Co 2.5 the tail is still in the inlet");
    tests::expect_between(at + "ultimate_quickest: the same", 0.5 * courant - 1e-4, 0.5 * courant + 0.1,
                          limited.diffusivity,
                          "Co/2 is that of implicit Euler; the limiter adds at most 0.1");
    tests::expect_small(at + "ultimate_quickest: beyond the bounds 0 and 1",
                        std::max(-limited.low, limited.high - 1), 1e-10,
                        "a hundred times the linear solver's tolerance");
    tests::expect_small(at + "ultimate_quickest: defect of the balance", limited.balance, 1e-13,
                        "round-off of the sums");
  }
}

// Without limiter the same profile overshoots: the limiter is what keeps it within.
TEST(ScalarFront, OvershootsWithoutLimiter) {
  const Front quick = carry_step(Convection::quick, 0.1);
  const Front central = carry_step(Convection::central, 0.1);
  tests::expect_between("step profile, quick: overshoot", 0.01, 0.3, quick.high - 1, "not bounded");
  tests::expect_between("step profile, central: overshoot", 0.05, 0.6, central.high - 1, "not bounded");
}

// rho c u v' = k v'' - b v with v(0) = 1 and v'(L) = 0: a sum of two exponentials.
TEST(ScalarProfile, ConvectionConductionAndSink) {
  constexpr Real density = 1.2, capacity = 1000, velocity = 0.02, k = 0.5, sink = 60, length = 0.3;
  const Real p = density * capacity * velocity / (2 * k);
  const Real q = std::sqrt(p * p + sink / k);
  const Real plus = p + q, minus = p - q;
  // v = A e^(plus x) + B e^(minus x); plus > 0 is anchored at the outlet so that nothing overflows.
  const Real ratio = -minus / plus * std::exp((minus - plus) * length);
  const auto exact = [&](Real x) { return (ratio * std::exp(plus * x) + std::exp(minus * x)) / (1 + ratio); };
  std::vector<Real> errors;
  for (const Index cells : {30, 60, 120}) {
    PrescribedFlow gas = make_plug_flow(cells, length, velocity, density);
    ScalarOptions options;
    options.capacity = capacity;
    options.conductivity = k;
    options.correction_tolerance = 1e-12;
    options.max_corrections = 100;
    ScalarTransport scalar("temperature", gas.geometry, gas.boundaries, {GivenValue{1}, Insulated{}}, options,
                           Convection::quick);
    scalar.initialise(gas.fields);
    const auto n = static_cast<std::size_t>(cells);
    ScalarSource source{HostArray<Real>("tests::rate", n), HostArray<Real>("tests::coefficient", n)};
    Kokkos::deep_copy(source.coefficient, sink);
    for (int step = 0; step < 200; ++step) scalar.update(gas.fields, 10, source);
    Real worst = 0;
    for (Index i = 0; i < cells; ++i) {
      worst = std::max(worst, std::abs(scalar.value()(i) - exact(gas.geometry.grid.center(0, i))));
    }
    errors.push_back(worst);
  }
  tests::expect_small("steady convection, conduction and sink, 120 cells: largest deviation", errors.back(),
                      2e-4, "second order: 30 cells are off by 16 times as much");
  tests::expect_between("the same: order", 1.9, 2.2, std::log2(errors[1] / errors[2]), "60, 120 cells");
}

// A slab, insulated at x = 0, with surroundings at x = L: v = sum C_n exp(-z_n^2 Fo) cos(z_n x / L), z tan z = Bi,
// C_n = 4 sin z / (2 z + sin 2 z) (Carslaw & Jaeger, Conduction of Heat in Solids, 1959, section 3.11).
Real cooled_slab(Real biot, Real fourier, Real place) {
  Real sum = 0;
  for (int n = 0; n < 60; ++n) {
    Real left = n * M_PI, right = n * M_PI + M_PI / 2;
    for (int i = 0; i < 100; ++i) {
      const Real z = 0.5 * (left + right);
      (z * std::sin(z) < biot * std::cos(z)) == (std::cos(n * M_PI) > 0) ? left = z : right = z;
    }
    const Real z = 0.5 * (left + right);
    sum += 4 * std::sin(z) / (2 * z + std::sin(2 * z)) * std::exp(-z * z * fourier) * std::cos(z * place);
  }
  return sum;
}

TEST(ScalarProfile, SlabCooledThroughItsWall) {
  constexpr Real density = 1.2, capacity = 1000, k = 0.025, length = 0.02, eps = 0.4, hot = 350, cold = 300;
  constexpr Real biot = 2;
  constexpr Index cells = 40;
  const Real time = 0.3 * density * capacity * length * length / k;
  const auto deviation = [&](int steps) {
    PrescribedFlow gas(CartesianGrid(Box{{0, 0, 0}, {length, 1, 1}}, {cells, 1, 1}),
                       {{"wall", Side::x_max, {}, NoSlip{}, "case.yaml:1"}}, density);
    Kokkos::deep_copy(gas.fields.void_fraction, eps);
    Kokkos::deep_copy(gas.fields.void_fraction_old, eps);
    ScalarOptions options;
    options.capacity = capacity;
    options.conductivity = k;
    options.initial = hot;
    options.reference = 290;
    ScalarTransport scalar("temperature", gas.geometry, gas.boundaries,
                           {Surroundings{cold, biot * eps * k / length}}, options,
                           Convection::ultimate_quickest);
    scalar.initialise(gas.fields);
    for (int step = 0; step < steps; ++step) scalar.update(gas.fields, time / steps, {});
    EXPECT_LT(scalar.balance().defect(), 1e-13);
    EXPECT_LT(scalar.balance().into[0], 0);
    Real worst = 0;
    for (Index i = 0; i < cells; ++i) {
      const Real exact = cooled_slab(biot, 0.3, gas.geometry.grid.center(0, i) / length);
      worst = std::max(worst, std::abs((scalar.value()(i) - cold) / (hot - cold) - exact));
    }
    return worst;
  };
  const Real coarse = deviation(50), fine = deviation(400);
  // Implicit Euler: z_1^4 Fo^2 / (2 steps) = 1.16 * 0.09 / 800 = 1.5e-4 of the leading term at 400 steps.
  tests::expect_small("slab cooled through its wall, Bi 2, Fo 0.3, 400 steps: largest deviation", fine, 3e-4,
                      "implicit Euler leaves 2e-4, 40 cells a tenth of that");
  tests::expect_between("the same: deviation of 50 over that of 400 steps", 6, 10, coarse / fine,
                        "first order in time: 8, less what the cells leave");
}

}  // namespace
}  // namespace pellicle::cfd
