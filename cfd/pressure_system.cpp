#include "cfd/pressure_system.hpp"

#include <cmath>
#include <string>

#include "cfd/field_memory.hpp"

namespace pellicle::cfd {

namespace {

HostArray<Real> make_array(const char* label, Index size) {
  return make_field<Real>(label, static_cast<std::size_t>(size));
}

// The empty domain: conductance of a face is area / distance.
std::unique_ptr<PressurePreconditioner> make_preconditioner(const FlowGeometry& geometry,
                                                            PressureSolver kind) {
  PressureMatrix shape(geometry.stencil);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for_faces("cfd::pressure_system::shape", geometry.stencil, axis,
              [&](Index f, Index, Index, Index position, Index) {
                shape.coefficient[a](f) =
                    geometry.area[a](f) / geometry.axis[a].distance[static_cast<std::size_t>(position)];
              });
    copy_periodic_faces(geometry.stencil, axis, shape.coefficient[a]);
  }
  shape.finish();
  return kind == PressureSolver::multigrid ? make_multigrid(shape) : make_amgcl_preconditioner(shape);
}

}  // namespace

PressureMatrix::PressureMatrix(const Stencil& s) : stencil(s) {
  const char* face_labels[] = {"cfd::pressure_system::coefficient_x", "cfd::pressure_system::coefficient_y",
                               "cfd::pressure_system::coefficient_z"};
  const char* boundary_labels[] = {"cfd::pressure_system::boundary_x", "cfd::pressure_system::boundary_y",
                                   "cfd::pressure_system::boundary_z"};
  for (std::size_t a = 0; a < 3; ++a) {
    coefficient[a] = make_array(face_labels[a], s.faces(static_cast<int>(a)));
    boundary[a] = make_array(boundary_labels[a], s.cells());
  }
  diagonal = make_array("cfd::pressure_system::diagonal", s.cells());
}

void PressureMatrix::finish() {
  const Stencil& s = stencil;
  const Real* cx = coefficient[0].data();
  const Real* cy = coefficient[1].data();
  const Real* cz = coefficient[2].data();
  const Index sy = s.face_step(1);
  const Index sz = s.face_step(2);
  // A face that joins a cell to itself (one cell along a periodic axis) carries no flow by pressure.
  const Real wx = s.n.x > 1 ? 1 : 0;
  const Real wy = s.n.y > 1 ? 1 : 0;
  const Real wz = s.n.z > 1 ? 1 : 0;
  for_rows("cfd::pressure_system::finish", s, [&](const Index r) {
    const Row row = s.row(r);
    for (Index i = 0; i < s.n.x; ++i) {
      const Index c = row.cell + i;
      const Index fx = row.x_face + i;
      const Index fy = row.y_face + i;
      const Index fz = row.z_face + i;
      diagonal(c) = wx * (cx[fx] + cx[fx + 1]) + wy * (cy[fy] + cy[fy + sy]) + wz * (cz[fz] + cz[fz + sz]) +
                    (boundary[0](c) + boundary[1](c) + boundary[2](c));
    }
  });
}

namespace {

// result = A x; after_row(r, row) is called when a row of it is there.
template <class AfterRow>
void multiply_rows(const PressureMatrix& matrix, const Real* x, Real* y, AfterRow&& after_row) {
  const Stencil& s = matrix.stencil;
  const Real* cx = matrix.coefficient[0].data();
  const Real* cy = matrix.coefficient[1].data();
  const Real* cz = matrix.coefficient[2].data();
  const Real* d = matrix.diagonal.data();
  const Index sy = s.face_step(1);
  const Index sz = s.face_step(2);
  const Real wx = s.n.x > 1 ? 1 : 0;
  const Real wy = s.n.y > 1 ? 1 : 0;
  const Real wz = s.n.z > 1 ? 1 : 0;
  for_rows("cfd::pressure_system::multiply", s, [&](const Index r) {
    const Row row = s.row(r);
    along_open_row(s, row, [=](Index i, Index left, Index right) {
      const Index c = row.cell + i;
      const Index fx = row.x_face + i;
      const Index fy = row.y_face + i;
      const Index fz = row.z_face + i;
      y[c] = d[c] * x[c] - wx * (cx[fx] * x[row.cell + left] + cx[fx + 1] * x[row.cell + right]) -
             wy * (cy[fy] * x[row.y_minus + i] + cy[fy + sy] * x[row.y_plus + i]) -
             wz * (cz[fz] * x[row.z_minus + i] + cz[fz + sz] * x[row.z_plus + i]);
    });
    after_row(r, row);
  });
}

}  // namespace

void multiply(const PressureMatrix& matrix, const HostArray<Real>& x, const HostArray<Real>& result) {
  multiply_rows(matrix, x.data(), result.data(), [](Index, const Row&) {});
}

PressureLinearSolver::PressureLinearSolver(const FlowGeometry& geometry, PressureSolver kind)
    : preconditioner_(make_preconditioner(geometry, kind)),
      r_(make_array("cfd::pressure_system::residual", geometry.stencil.cells())),
      z_(make_array("cfd::pressure_system::preconditioned", geometry.stencil.cells())),
      p_(make_array("cfd::pressure_system::direction", geometry.stencil.cells())),
      q_(make_array("cfd::pressure_system::image", geometry.stencil.cells())) {}

// Over the cells that take part: one that nothing can enter has no row.
void PressureLinearSolver::remove_mean(const PressureMatrix& matrix, const HostArray<Real>& v) {
  const auto n = static_cast<Index>(v.extent(0));
  const auto takes_part = [&](Index c) { return matrix.diagonal(c) > 0; };
  const Real count =
      sum_("cfd::pressure_system::count", n, [&](Index c) { return takes_part(c) ? 1.0 : 0.0; });
  if (!(count > 0)) return;
  const Real mean =
      sum_("cfd::pressure_system::mean", n, [&](Index c) { return takes_part(c) ? v(c) : 0.0; }) / count;
  for_entries("cfd::pressure_system::remove_mean", n, [&](Index c) {
    if (takes_part(c)) v(c) -= mean;
  });
}

// z from r; returns the sum of r z.
Real PressureLinearSolver::precondition(const PressureMatrix& matrix, Real residual) {
  const Index n = matrix.stencil.cells();
  const Real product = preconditioner_->apply(r_, z_, residual / static_cast<Real>(n));
  if (!matrix.singular) return product;
  remove_mean(matrix, z_);
  const Real *r = r_.data(), *z = z_.data();
  return sum_("cfd::pressure_system::dot_rz", n, [=](Index c) { return r[c] * z[c]; });
}

LinearReport PressureLinearSolver::solve(const PressureMatrix& matrix, const HostArray<Real>& b,
                                         const HostArray<Real>& x, Real target, int max_iterations) {
  const Index n = matrix.stencil.cells();
  const Index nx = matrix.stencil.n.x;
  Real* r = r_.data();
  Real* z = z_.data();
  Real* p = p_.data();
  Real* q = q_.data();
  Real* xs = x.data();
  const Real* bs = b.data();
  row_sums_.assign(static_cast<std::size_t>(matrix.stencil.rows()), 0);
  for_entries("cfd::pressure_system::start", n, [&](Index c) {
    xs[c] = 0;
    r[c] = bs[c];
  });
  if (matrix.singular) remove_mean(matrix, r_);
  LinearReport report;
  report.residual = sum_("cfd::pressure_system::magnitude", n, [&](Index c) { return std::abs(r[c]); });
  if (!(report.residual > target)) {
    report.converged = report.residual <= target;
    return report;
  }
  preconditioner_->update(matrix);
  Real rho = 0;
  report.converged = false;
  while (report.iterations < max_iterations) {
    const Real rho_new = precondition(matrix, report.residual);
    const Real beta = report.iterations == 0 ? 0 : rho_new / rho;
    rho = rho_new;
    for_entries("cfd::pressure_system::turn", n, [&](Index c) { p[c] = z[c] + beta * p[c]; });
    multiply_rows(matrix, p, q, [&](Index line, const Row& row) {
      const Real *direction = p + row.cell, *image = q + row.cell;
      const Index count = nx;
      Real product = 0;
#pragma omp simd reduction(+ : product)
      for (Index i = 0; i < count; ++i) product += direction[i] * image[i];
      row_sums_[static_cast<std::size_t>(line)] = product;
    });
    Real pq = 0;
    for (const Real product : row_sums_) pq += product;
    const Real alpha = rho / pq;
    report.residual = sum_.several<1>("cfd::pressure_system::advance", n,
                                      [=](Index begin, Index end, std::array<Real, 1>& total) {
                                        Real magnitude = 0;
                                        Real *solution = xs, *left = r;
                                        const Real *direction = p, *image = q;
                                        const Real step = alpha;
#pragma omp simd reduction(+ : magnitude)
                                        for (Index c = begin; c < end; ++c) {
                                          solution[c] += step * direction[c];
                                          left[c] -= step * image[c];
                                          magnitude += std::abs(left[c]);
                                        }
                                        total[0] += magnitude;
                                      })[0];
    ++report.iterations;
    if (report.residual <= target) {
      report.converged = true;
      break;
    }
    if (!std::isfinite(report.residual)) break;
  }
  preconditioner_->solved(report.iterations);
  return report;
}

}  // namespace pellicle::cfd
