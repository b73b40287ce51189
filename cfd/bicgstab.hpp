// BiCGStab for the transport equations: nonsymmetric, dominated by their diagonal.
#pragma once

#include <algorithm>
#include <cmath>

#include "cfd/field_memory.hpp"
#include "cfd/fixed_sum.hpp"
#include "cfd/stencil.hpp"
#include "core/types.hpp"
#include "core/views.hpp"

namespace pellicle::cfd {

struct TransportReport {
  int iterations = 0;
  Real residual = 0;  ///< root of the sum of squares, relative to that of right-hand side or solution
  bool converged = true;
};

/// BiCGStab (van der Vorst 1992) for x - N x = b, an equation divided by its diagonal. Its sums run over fixed blocks:
/// the same bits for any number of threads.
class BiCGStab {
 public:
  explicit BiCGStab(Index size)
      : size_(size),
        r_(make_field<Real>("cfd::bicgstab::r", static_cast<std::size_t>(size))),
        r0_(make_field<Real>("cfd::bicgstab::r0", static_cast<std::size_t>(size))),
        p_(make_field<Real>("cfd::bicgstab::p", static_cast<std::size_t>(size))),
        v_(make_field<Real>("cfd::bicgstab::v", static_cast<std::size_t>(size))),
        s_(make_field<Real>("cfd::bicgstab::s", static_cast<std::size_t>(size))),
        t_(make_field<Real>("cfd::bicgstab::t", static_cast<std::size_t>(size))) {}

  /// Where the right-hand side b is to be put before each solve; the solve overwrites it.
  const HostArray<Real>& right_side() const { return t_; }

  /// Solves from the x given. near(y, take) calls take(entry, (N y)_entry) for every entry.
  template <class Near>
  TransportReport solve(Real* x, Near&& near, Real tolerance, int max_iterations) {
    Real *r = r_.data(), *r0 = r0_.data(), *p = p_.data(), *v = v_.data(), *s = s_.data(), *t = t_.data();
    near(x, [=](Index e, Real value) {
      r[e] = t[e] + value - x[e];
      r0[e] = r[e];
      p[e] = r[e];
    });
    const auto norm_of = [&](const char* label, const Real* y) {
      return std::sqrt(sum_(label, size_, [y](Index e) { return y[e] * y[e]; }));
    };
    const Real scale = std::max(norm_of("cfd::bicgstab::norm_b", t), norm_of("cfd::bicgstab::norm_x", x));
    TransportReport report;
    Real residual = norm_of("cfd::bicgstab::norm_r", r);
    const Real target = tolerance * scale;
    Real rho = residual * residual;
    Real shadow = residual;  // norm of r0
    const auto begin_anew = [&] {
      for_entries("cfd::bicgstab::restart", size_, [&](Index e) { r0[e] = p[e] = r[e]; });
      rho = residual * residual;
      shadow = residual;
    };
    while (residual > target && report.iterations < max_iterations) {
      near(p, [=](Index e, Real value) { v[e] = p[e] - value; });
      const Real alpha = rho / sum_("cfd::bicgstab::dot_r0v", size_, [&](Index e) { return r0[e] * v[e]; });
      if (!(std::abs(alpha) < largest_step)) {
        begin_anew();
        ++report.iterations;
        continue;
      }
      for_entries("cfd::bicgstab::half_step", size_, [&](Index e) { s[e] = r[e] - alpha * v[e]; });
      near(s, [=](Index e, Real value) { t[e] = s[e] - value; });
      const Real tt = sum_("cfd::bicgstab::dot_tt", size_, [&](Index e) { return t[e] * t[e]; });
      const Real ts = sum_("cfd::bicgstab::dot_ts", size_, [&](Index e) { return t[e] * s[e]; });
      const Real omega = tt > 0 ? ts / tt : 0;
      for_entries("cfd::bicgstab::step", size_, [&](Index e) {
        x[e] += alpha * p[e] + omega * s[e];
        r[e] = s[e] - omega * t[e];
      });
      ++report.iterations;
      residual = norm_of("cfd::bicgstab::norm_again", r);
      if (residual <= target || !std::isfinite(residual)) break;
      const Real rho_new = sum_("cfd::bicgstab::dot_r0r", size_, [&](Index e) { return r0[e] * r[e]; });
      if (std::abs(rho_new) < orthogonal * shadow * residual || omega == 0) {
        begin_anew();
        continue;
      }
      const Real beta = (rho_new / rho) * (alpha / omega);
      rho = rho_new;
      for_entries("cfd::bicgstab::turn", size_, [&](Index e) { p[e] = r[e] + beta * (p[e] - omega * v[e]); });
    }
    report.residual = scale > 0 ? residual / scale : 0;
    report.converged = residual <= target;
    return report;
  }

 private:
  // Breakdown: r is at right angles to r0 but for round-off, as where a front has left what r0 saw; or a step is far
  // larger than the unit diagonal allows.
  static constexpr Real orthogonal = 1e-14;
  static constexpr Real largest_step = 1e6;

  Index size_;
  HostArray<Real> r_, r0_, p_, v_, s_, t_;
  FixedSum sum_;
};

}  // namespace pellicle::cfd
