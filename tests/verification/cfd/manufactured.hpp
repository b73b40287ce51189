// Manufactured solutions: smooth fields with exact derivatives, and the sources that make them solve the equations.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::cfd {

/// A function of two coordinates at a point: value, first and second derivatives.
struct Jet {
  Real v = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;

  friend Jet operator+(const Jet& f, const Jet& g) {
    return {f.v + g.v, f.a + g.a, f.b + g.b, f.aa + g.aa, f.ab + g.ab, f.bb + g.bb};
  }
  friend Jet operator*(Real s, const Jet& f) {
    return {s * f.v, s * f.a, s * f.b, s * f.aa, s * f.ab, s * f.bb};
  }
  friend Jet operator-(const Jet& f, const Jet& g) { return f + -1.0 * g; }
  friend Jet operator*(const Jet& f, const Jet& g) {
    return {f.v * g.v,
            f.a * g.v + f.v * g.a,
            f.b * g.v + f.v * g.b,
            f.aa * g.v + 2 * f.a * g.a + f.v * g.aa,
            f.ab * g.v + f.a * g.b + f.b * g.a + f.v * g.ab,
            f.bb * g.v + 2 * f.b * g.b + f.v * g.bb};
  }
  friend Jet operator/(const Jet& f, const Jet& g) {
    const Real r = 1 / g.v;
    const Real r2 = r * r;
    return f * Jet{r,
                   -g.a * r2,
                   -g.b * r2,
                   (2 * g.a * g.a * r - g.aa) * r2,
                   (2 * g.a * g.b * r - g.ab) * r2,
                   (2 * g.b * g.b * r - g.bb) * r2};
  }
};

/// Sum of amplitude cos(pi half_waves x + phase).
struct Wave {
  struct Term {
    Real amplitude = 0, half_waves = 0, phase = 0;
  };
  std::vector<Term> terms;

  /// Order -1: an antiderivative.
  Real derivative(int order, Real x) const {
    Real sum = 0;
    for (const Term& t : terms) {
      const Real k = M_PI * t.half_waves;
      if (k == 0) {
        sum += order > 0 ? 0 : t.amplitude * std::cos(t.phase) * (order == 0 ? 1 : x);
      } else {
        sum += t.amplitude * std::pow(k, order) * std::cos(k * x + t.phase + 0.5 * M_PI * order);
      }
    }
    return sum;
  }
  /// Mean of a derivative between two places.
  Real mean(int order, Real from, Real to) const {
    return (derivative(order - 1, to) - derivative(order - 1, from)) / (to - from);
  }
};

/// f(a) g(b).
struct Product {
  Wave f, g;
  /// Mean of its derivative of order m in a and n in b over a rectangle.
  Real mean(const std::array<Real, 2>& from, const std::array<Real, 2>& to, int m = 0, int n = 0) const {
    return f.mean(m, from[0], to[0]) * g.mean(n, from[1], to[1]);
  }
  /// Of its derivative of order m in a and n in b.
  Jet jet(Real a, Real b, int m = 0, int n = 0) const {
    const auto F = [&](int k) { return f.derivative(m + k, a); };
    const auto G = [&](int k) { return g.derivative(n + k, b); };
    return {F(0) * G(0), F(1) * G(0), F(0) * G(1), F(2) * G(0), F(1) * G(1), F(0) * G(2)};
  }
};

/// A unit square in the plane of two axes, one cell deep, cells equal or stretched (widths up to 1 : 3).
inline CartesianGrid make_square(Index cells, std::array<int, 2> plane, bool stretched, bool periodic) {
  std::array<std::vector<Real>, 3> faces{{{0, 1}, {0, 1}, {0, 1}}};
  std::array<bool, 3> wraps{periodic, periodic, periodic};
  for (std::size_t d = 0; d < 2; ++d) {
    auto& own = faces[static_cast<std::size_t>(plane[d])];
    own.clear();
    for (Index i = 0; i <= cells; ++i) {
      const Real s = static_cast<Real>(i) / cells;
      // Not symmetric about the middle, else errors of first order might cancel.
      const Real shift = 0.07 * std::sin(2 * M_PI * s) + 0.03 * (1 - std::cos(2 * M_PI * s));
      own.push_back(stretched ? s + shift : s);
    }
    own.front() = 0;
    own.back() = 1;
  }
  return CartesianGrid(faces, wraps);
}

/// A line of the table: the order from the last two of errors made with steps halved each time is at least `least`.
inline void expect_order(const std::string& line, const std::vector<Real>& errors, Real least,
                         const std::string& steps) {
  const Real order = std::log2(errors[errors.size() - 2] / errors.back());
  std::string why = steps + ":";
  for (const Real error : errors) {
    char text[40];
    std::snprintf(text, sizeof text, " %.2e", error);
    why += text;
  }
  char bar[40];
  std::snprintf(bar, sizeof bar, "at least %.2f", least);
  tests::append_line(line, bar, tests::show(order), "-", order >= least, why);
  EXPECT_GE(order, least) << line << "; " << why;
}

}  // namespace pellicle::cfd
