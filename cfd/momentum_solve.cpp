// The linear system of the momentum equations. Where the time step dominates, a few sweeps over the rows of cells solve
// it, for corrections in single precision to a residual in double precision: what a sweep costs is the memory that it
// goes through. Elsewhere BiCGStab goes on from where the sweeps came to.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <vector>

#include "cfd/momentum.hpp"

namespace pellicle::cfd {

namespace {

constexpr Real sweeps_affordable = 24;   // BiCGStab: four to six iterations, each as long as ten sweeps
constexpr Real single_precision = 1e-6;  // of a correction
constexpr Real rough = 1e-5;             // a tolerance that single precision surely meets
constexpr Real sharper = 0.3;         // a correction is solved for by so much more closely than is asked for
constexpr Real least_progress = 0.1;  // of a correction
constexpr std::ptrdiff_t packed_values = 15;  // a cell: near, normal, inverse
constexpr Real one_sweep_leaves = 10;         // times a rough tolerance: no need for a second one
constexpr Real large_start = 1e6;             // right-hand side over solution

}  // namespace

// near u of one component in a row of cells: values of the own row, of the rows beside it, coefficients.
struct MomentumEquation::RowSum {
  RowSum(const MomentumEquation& equation, const Row& row, int component, const Real* u) {
    const Index n = equation.geometry_.stencil.cells();
    const auto shift = static_cast<std::ptrdiff_t>(component) * n;
    for (std::size_t d = 0; d < 6; ++d) {
      const auto& of = static_cast<int>(d / 2) == component ? equation.normal_ : equation.near_;
      coefficient[d] = of[d].data() + row.cell;
    }
    own = u + shift + row.cell;
    if (component == 0) ask_for_next(equation, row, u);
    y_minus = u + shift + row.y_minus;
    y_plus = u + shift + row.y_plus;
    z_minus = u + shift + row.z_minus;
    z_plus = u + shift + row.z_plus;
  }
  static void ask_for_next(const MomentumEquation& equation, const Row& row, const Real* u) {
    const Stencil& s = equation.geometry_.stencil;
    const Index next = row.cell + s.n.x;
    for (std::size_t d = 0; d < 6; ++d) {
      prefetch_row(equation.near_[d].data() + next, s.n.x);
      prefetch_row(equation.normal_[d].data() + next, s.n.x);
    }
    for (int a = 0; a < 3; ++a)
      prefetch_row(u + next + static_cast<std::ptrdiff_t>(a) * s.cells() + s.face_step(2), s.n.x);
  }
  Real operator()(Index i, Index left, Index right) const {
    return (coefficient[0][i] * own[left] + coefficient[1][i] * own[right]) +
           (coefficient[2][i] * y_minus[i] + coefficient[3][i] * y_plus[i]) +
           (coefficient[4][i] * z_minus[i] + coefficient[5][i] * z_plus[i]);
  }
  std::array<const Real*, 6> coefficient;
  const Real *own, *y_minus, *y_plus, *z_minus, *z_plus;
};

// Sum of term(i, left, right) along a row.
template <class T, class Term>
T MomentumEquation::sum_along_row(const Row& row, Term&& term) const {
  const Stencil& s = geometry_.stencil;
  const Index nx = s.n.x;
  const std::decay_t<Term> own = term;  // not read anew for every cell
  T sum = 0;
  if (open_ends_ && row.cell > 0 && row.cell + nx < s.cells()) {
#pragma omp simd reduction(+ : sum)
    for (Index i = 0; i < nx; ++i) sum += own(i, i - 1, i + 1);
    return sum;
  }
  along_row(row, nx, [&](Index i, Index left, Index right) { sum += own(i, left, right); });
  return sum;
}

// result(entry, near sum) for every cell and component.
template <class Result>
void MomentumEquation::apply(const char* label, const Real* u, Result&& result) const {
  const Stencil& s = geometry_.stencil;
  const Index n = s.cells();
  for_rows(label, s, [&](const Index r) {
    const Row row = s.row(r);
    for (int a = 0; a < 3; ++a) {
      const RowSum near(*this, row, a, u);
      const Index first = row.cell + a * n;
      const auto at = [=](Index i, Index left, Index right) { result(first + i, near(i, left, right)); };
      open_ends_ ? along_open_row(s, row, at) : along_row(row, s.n.x, at);
    }
  });
}

void MomentumEquation::compute_influx(const GasFields& fields, const HostArray<Real>& influx) const {
  Real* h = influx.data();
  const Real* source = source_.data();
  apply("cfd::momentum_solve::influx", fields.velocity.data(),
        [=](Index e, Real near) { h[e] = near + source[e]; });
}

// Residual over the diagonal, times `factor` in single precision, row by row; returns its sum of squares.
Real MomentumEquation::compute_defect(const Real* u, Real factor) {
  const Stencil& s = geometry_.stencil;
  const Index n = s.cells();
  const Index nx = s.n.x;
  const Real* inverse = inverse_.data();
  const Real* right_side = linear_solver_.right_side().data();
  for_rows("cfd::momentum_solve::defect", s, [&](const Index r) {
    const Row row = s.row(r);
    Real total = 0;
    for (int a = 0; a < 3; ++a) {
      const RowSum near(*this, row, a, u);
      const Index first = row.cell + a * n;
      prefetch_row(right_side + first + nx, nx);
      prefetch_row(inverse + first + nx, nx);
      const Real *b = right_side + first, *inv = inverse + first, *old = u + first;
      float* out = defect_.data() + (std::ptrdiff_t{3} * r + a) * nx;
      const auto at = [=](Index i, Index left, Index right) {
        const Real defect = b[i] + near(i, left, right) * inv[i] - old[i];
        out[i] = static_cast<float>(defect * factor);
        return defect * defect;
      };
      total += sum_along_row<Real>(row, at);
    }
    row_change_[static_cast<std::size_t>(r)] = total;
  });
  Real total = 0;
  for (const Real change : row_change_) total += change;
  return total;
}

// Coefficients in single precision, all of a row of cells together.
void MomentumEquation::pack(const Row& row) const {
  const Index n = geometry_.stencil.cells();
  const Index nx = geometry_.stencil.n.x;
  float* out = packed_.data() + packed_values * row.cell;
  const auto put = [&](const Real* from) {
#pragma GCC ivdep
    for (Index i = 0; i < nx; ++i) out[i] = static_cast<float>(from[i]);
    out += nx;
  };
  for (std::size_t d = 0; d < 6; ++d) put(near_[d].data() + row.cell);
  for (std::size_t d = 0; d < 6; ++d) put(normal_[d].data() + row.cell);
  for (int a = 0; a < 3; ++a) put(inverse_.data() + row.cell + static_cast<std::ptrdiff_t>(a) * n);
}

// What a solve begins with, in one go through memory: the equation divided by its diagonal, its defect as
// `compute_defect` has it; if it keeps the equation, also the coefficients of sweeps.
template <bool keeps>
MomentumEquation::Begun MomentumEquation::begin(const GasFields& fields, const Inertia& inertia,
                                                const Real* force, Real factor) {
  const Stencil& s = geometry_.stencil;
  const Index n = s.cells();
  const Index nx = s.n.x;
  const Real* u = fields.velocity.data();
  const Real* u_old = fields.velocity_old.data();
  const Real keep = inertia.keep;
  for_rows("cfd::momentum_solve::begin", s, [&](const Index r) {
    const Row row = s.row(r);
    const Real *all = inertia.all.data() + row.cell, *old = inertia.old.data() + row.cell;
    prefetch_row(all + nx, nx);
    prefetch_row(old + nx, nx);
    static thread_local std::vector<Real> scratch;
    if (!keeps) scratch.resize(std::size_t{2} * static_cast<std::size_t>(nx));
    Real defects = 0;
    Real sizes = 0;
    Real rate = 0;
    for (int a = 0; a < 3; ++a) {
      const Index first = row.cell + a * n;
      const RowSum near(*this, row, a, u);
      const Real *own = own_.data() + first, *source = source_.data() + first, *given = force + first;
      const Real *now = u + first, *before = u_old + first;
      for (const Real* field : {own, source, given, before}) prefetch_row(field + nx, nx);
      Real *inverse = scratch.data(), *right_side = scratch.data() + nx;
      if constexpr (keeps) {
        inverse = inverse_.data() + first;
        right_side = linear_solver_.right_side().data() + first;
        prefetch_row(inverse + nx, nx);
        prefetch_row(right_side + nx, nx);
      }
      const Real kept = keep;
      Real size = 0;
      Real largest = rate;
#pragma omp simd reduction(+ : size) reduction(max : largest)
      for (Index i = 0; i < nx; ++i) {
        const Real diagonal = own[i] + all[i];
        const Real held = kept * diagonal;
        const Real inv = 1 / (diagonal + held);
        const Real value = (source[i] + given[i] + old[i] * before[i] + held * now[i]) * inv;
        const Real share = own[i] * inv;
        inverse[i] = inv;
        right_side[i] = value;
        size += value * value;
        largest = share > largest ? share : largest;
      }
      sizes += size;
      rate = largest;
      float* out = defect_.data() + (std::ptrdiff_t{3} * r + a) * nx;
      const Real *b = right_side, *inv = inverse;
      defects += sum_along_row<Real>(row, [=](Index i, Index left, Index right) {
        const Real defect = b[i] + near(i, left, right) * inv[i] - now[i];
        out[i] = static_cast<float>(defect * factor);
        return defect * defect;
      });
    }
    if constexpr (keeps) pack(row);
    row_change_[static_cast<std::size_t>(r)] = defects;
    row_begun_[static_cast<std::size_t>(r)] = {sizes, rate};
  });
  Begun begun;
  for (const Real defects : row_change_) begun.defect += defects;
  for (const auto& [sizes, rate] : row_begun_) {
    begun.right_side += sizes;
    begun.rate = std::max(begun.rate, rate);
  }
  begun.defect = std::sqrt(begun.defect);
  begun.right_side = std::sqrt(begun.right_side);
  return begun;
}

// One sweep from a correction to the next: rows of one colour, as on a chess board of rows, then those of the other with
// what the first have come to; along a row all cells at once. Returns the sum of squares of the changes.
Real MomentumEquation::sweep(const float* d, float* next) {
  const Stencil& s = geometry_.stencil;
  const Index nx = s.n.x;
  for (int colour = 0; colour < 2; ++colour) {
    for_rows("cfd::momentum_solve::sweep", s, [&](const Index r) {
      const Row row = s.row(r);
      if (row.k % 2 != colour) return;
      const float* coefficients = packed_.data() + packed_values * row.cell;
      prefetch_row(coefficients + packed_values * nx, static_cast<Index>(packed_values) * nx);
      prefetch_row(defect_.data() + std::ptrdiff_t{3} * (row.cell + nx), 3 * nx);
      float total = 0;
      for (int a = 0; a < 3; ++a) {
        const auto coefficient = [&](int side) {
          return coefficients + std::ptrdiff_t{side / 2 == a ? side + 6 : side} * nx;
        };
        const float *xm = coefficient(0), *xp = coefficient(1), *ym = coefficient(2);
        const float *yp = coefficient(3), *zm = coefficient(4), *zp = coefficient(5);
        const float* inv = coefficients + std::ptrdiff_t{12 + a} * nx;
        const float* beside = colour == 1 && coloured_ ? next : d;
        const std::ptrdiff_t shift = std::ptrdiff_t{a} * nx;
        const auto values = [&](Index cell) {
          return (cell == row.cell ? d : beside) + std::ptrdiff_t{3} * cell + shift;
        };
        const float *own = d + std::ptrdiff_t{3} * row.cell + shift,
                    *y_minus = d + std::ptrdiff_t{3} * row.y_minus + shift;
        const float* y_plus = d + std::ptrdiff_t{3} * row.y_plus + shift;
        const float *z_minus = values(row.z_minus), *z_plus = values(row.z_plus);
        const float* b = defect_.data() + std::ptrdiff_t{3} * row.cell + shift;
        float* out = next + std::ptrdiff_t{3} * row.cell + shift;
        const auto update = [=](Index i, Index left, Index right) {
          const float near = (xm[i] * own[left] + xp[i] * own[right]) +
                             (ym[i] * y_minus[i] + yp[i] * y_plus[i]) +
                             (zm[i] * z_minus[i] + zp[i] * z_plus[i]);
          out[i] = b[i] + near * inv[i];
          const float change = out[i] - own[i];
          return change * change;
        };
        total += sum_along_row<float>(row, update);
      }
      row_change_[static_cast<std::size_t>(r)] = static_cast<Real>(total);
    });
  }
  Real total = 0;
  for (const Real change : row_change_) total += change;
  return total;
}

// The correction to the defect, until a sweep would leave `target`; its residual, of the size of what the next sweep would
// change. Beyond `affordable` it is given up.
MomentumEquation::Correction MomentumEquation::solve_correction(Real defect, Real target, int& sweeps) {
  Correction result{defect_.data(), defect, true};
  float* free[2] = {trial_[0].data(), trial_[1].data()};
  Real before = defect;
  for (int k = 0; result.residual > target; ++k) {
    const Real change = std::sqrt(sweep(result.values, free[k % 2]));
    result.values = free[k % 2];
    ++sweeps;
    // Each change is about the rate times the one before, and so is what is left.
    const Real rate = change / before;
    result.residual = change * std::min(rate, Real{1});
    before = change;
    if (result.residual <= target || result.residual <= single_precision * defect) break;
    const Real left = std::log(result.residual / target) / -std::log(std::min(rate, Real{1}));
    result.fast = left < sweeps_affordable - k;
    if (!result.fast) break;
  }
  return result;
}

TransportReport MomentumEquation::solve(const GasFields& fields, const Inertia& inertia,
                                        const HostArray<Real>& force, Real tolerance) {
  const Stencil& s = geometry_.stencil;
  const Index n = s.cells();
  const Index size = 3 * n;
  const Real* inverse = inverse_.data();
  Real* u = fields.velocity.data();
  const Real solution =
      std::sqrt(sum_("cfd::momentum_solve::norm_u", size, [u](Index e) { return u[e] * u[e]; }));
  // A power of two brings corrections to where single precision has them.
  const auto factor_for = [&](Real scale) {
    return scale > 0 && std::isfinite(scale)
               ? std::ldexp(1.0, -std::ilogb(scale / std::sqrt(static_cast<Real>(size))))
               : 1.0;
  };
  Real factor = factor_for(solution);
  // Where little is asked for, one sweep may do, and single precision cannot have spoilt it.
  const bool roughly = tolerance >= rough;
  const auto begin_with = [&](bool keeps) {
    return keeps ? begin<true>(fields, inertia, force.data(), factor)
                 : begin<false>(fields, inertia, force.data(), factor);
  };
  bool kept = !roughly || swept_roughly_;
  Begun begun = begin_with(kept);
  const Real scale = std::max(begun.right_side, solution);
  // A gas that starts from rest.
  if (scale > large_start * solution) {
    factor = factor_for(scale);
    begun = begin_with(kept);
  }
  const Real target = tolerance * scale;
  TransportReport report;
  if (scale == 0) return report;
  const Real back = 1 / factor;
  const auto add = [&](const float* d) {
    for_rows("cfd::momentum_solve::add", s, [&](const Index r) {
      for (int a = 0; a < 3; ++a) {
        Real* out = u + static_cast<std::ptrdiff_t>(r) * s.n.x + static_cast<std::ptrdiff_t>(a) * n;
        const float* change = d + (std::ptrdiff_t{3} * r + a) * s.n.x;
#pragma GCC ivdep
        for (Index i = 0; i < s.n.x; ++i) out[i] += back * static_cast<Real>(change[i]);
      }
    });
  };
  Real before = std::numeric_limits<Real>::infinity();
  Real defect = begun.defect;
  while (true) {
    report.residual = defect / scale;
    report.converged = defect <= target;
    if (report.converged || report.iterations >= options_.solver.max_linear_iterations) return report;
    if (!(defect < least_progress * before)) break;
    before = defect;
    if (roughly) swept_roughly_ = !(begun.rate * defect <= one_sweep_leaves * target);
    if (roughly && !swept_roughly_) {
      add(defect_.data());
      ++report.iterations;
      report.residual = begun.rate * defect / scale;
      report.converged = true;
      return report;
    }
    if (!kept) begin_with(true);
    kept = true;
    const Correction found = solve_correction(defect * factor, sharper * target * factor, report.iterations);
    add(found.values);
    if (!found.fast) break;
    if (roughly) {
      report.residual = found.residual * back / scale;
      report.converged = found.residual <= target * factor;
      return report;
    }
    defect = std::sqrt(compute_defect(u, factor));
  }
  const int done = report.iterations;
  report = linear_solver_.solve(
      u,
      [&](const Real* v, auto&& take) {
        apply("cfd::momentum_solve::near", v, [=](Index e, Real near) { take(e, near * inverse[e]); });
      },
      tolerance, options_.solver.max_linear_iterations);
  report.iterations += done;
  return report;
}

}  // namespace pellicle::cfd
