// Manufactured flows with a void fraction that varies in space and time, for each kind of boundary.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "cfd/boundary.hpp"
#include "tests/cfd/gas_for_tests.hpp"
#include "tests/verification/cfd/manufactured.hpp"

namespace pellicle::cfd {

// Superficial velocity U = rot(stream) + s' grad(swell), void fraction eps = mean + shape - s lap(swell): continuity
// d eps/dt + div U = 0 holds whatever the functions are. s(t) = sin(pulse t).
struct Flow {
  Product stream, swell, shape, pressure;
  Real through = 0;  ///< uniform superficial velocity along the second axis [m/s]
  Real mean_void_fraction = 0.6;
  Real pulse = 2;
  Real growth = 0.3;  ///< of the stream function per second, relative

  struct Point {
    Jet eps, a, b;  ///< void fraction, superficial velocity
  };
  Real s(Real t) const { return std::sin(pulse * t); }
  Real s_rate(Real t) const { return pulse * std::cos(pulse * t); }
  Point at(Real a, Real b, Real t, Real rate) const {
    const Jet eps =
        Jet{mean_void_fraction} + shape.jet(a, b) - s(t) * (swell.jet(a, b, 2, 0) + swell.jet(a, b, 0, 2));
    const Real strength = 1 + growth * t;
    return {eps, strength * stream.jet(a, b, 0, 1) + rate * swell.jet(a, b, 1, 0),
            Jet{through} - strength * stream.jet(a, b, 1, 0) + rate * swell.jet(a, b, 0, 1)};
  }
  // Of a cell: a closed domain keeps its gas to round-off only if cells hold exact means.
  Real mean_void_fraction_of(const std::array<Real, 2>& from, const std::array<Real, 2>& to, Real t) const {
    return mean_void_fraction + shape.mean(from, to) -
           s(t) * (swell.mean(from, to, 2, 0) + swell.mean(from, to, 0, 2));
  }
};

struct Setting {
  std::string name;
  Flow flow;
  std::array<int, 2> plane{0, 2};  ///< axes of the flow; along the third one the domain is one cell deep
  bool periodic = false;
  std::vector<BoundaryPatch> patches;
  Real dt = 0.02;  ///< [s]
};

// sin^2(pi x): it and its slope vanish on walls at 0 and 1.
inline const Wave bump{{{0.5, 0, 0}, {-0.5, 2, 0}}};
// sin^2(pi x) (1 + 1/5 sin 2 pi x).
inline const Wave lopsided{{{0.5, 0, 0}, {-0.5, 2, 0}, {0.1, 2, -M_PI / 2}, {-0.05, 4, -M_PI / 2}}};

inline Wave scaled(Wave wave, Real factor) {
  for (auto& term : wave.terms) term.amplitude *= factor;
  return wave;
}

inline Side low(int axis) { return static_cast<Side>(2 * axis); }
inline Side high(int axis) { return static_cast<Side>(2 * axis + 1); }

inline Setting make_periodic() {
  Flow f;
  f.stream = {scaled(bump, 0.3), lopsided};
  f.swell = {scaled(lopsided, 0.005), bump};
  f.shape = {{{{0.1, 2, 0.4}}}, {{{1, 2, -0.3}}}};
  f.pressure = {{{{0.5, 2, 0.2}}}, {{{1, 2, 0.9}}}};
  return {"periodic", f, {0, 2}, true, {}, 0.1};
}

// The void fraction changes on the walls too, and the pressure has a gradient there.
inline Setting make_box() {
  Setting s{"no-slip walls", make_periodic().flow, {2, 1}, false, symmetry_on({low(0), high(0)}), 0.02};
  s.flow.shape = {{{{0.15, 1.3, 0.4}}}, {{{1, 1.5, -0.3}}}};
  s.flow.pressure = {{{{0.5, 1, 0.4}}}, {{{1, 1.2, 0.9}}}};
  return s;
}

// Mirrored at every wall: U_a = sin(pi a) cos(pi b), and so on.
inline Setting make_slip_box() {
  Flow f;
  f.stream = {{{{0.2, 1, -M_PI / 2}}}, {{{1, 1, -M_PI / 2}, {0.3, 2, -M_PI / 2}}}};
  f.swell = {{{{0.02, 1, 0}}}, {{{1, 1, 0}}}};
  f.shape = {{{{0.15, 1, 0}}}, {{{1, 1, 0}}}};
  f.pressure = {{{{0.5, 1, 0}}}, {{{1, 2, 0}}}};
  return {"slip walls", f, {0, 1}, false, symmetry_on({low(0), high(0), low(1), high(1), low(2), high(2)})};
}

// Uniform inflow at b = 0; no pressure and no gradient of the velocity at b = 1.
inline Setting make_duct() {
  Flow f;
  f.through = 0.8;
  f.stream = {{{{0.1, 1, -M_PI / 2}}}, {{{8.0 / 9, 0, 0}, {-1, 1, 0}, {1.0 / 9, 3, 0}}}};
  f.shape = {{{{0.15, 1, 0}}}, {{{1, 0.5, -M_PI / 2}}}};
  f.pressure = {{{{0.5, 0, 0}, {0.3, 1, 0}}}, {{{1, 0.5, 0}}}};
  auto patches = symmetry_on({low(1), high(1), low(2), high(2)});
  patches.push_back({"inlet", low(0), {}, Inlet{0.8, {}}, "case.yaml:2"});
  patches.push_back({"outlet", high(0), {}, Outlet{0}, "case.yaml:3"});
  return {"inlet and outlet", f, {2, 0}, false, patches};
}

}  // namespace pellicle::cfd
