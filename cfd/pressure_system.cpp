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

void multiply(const PressureMatrix& matrix, const HostArray<Real>& x_array, const HostArray<Real>& result) {
  const Stencil& s = matrix.stencil;
  const Real* cx = matrix.coefficient[0].data();
  const Real* cy = matrix.coefficient[1].data();
  const Real* cz = matrix.coefficient[2].data();
  const Real* d = matrix.diagonal.data();
  const Real* x = x_array.data();
  Real* y = result.data();
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
  });
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

LinearReport PressureLinearSolver::solve(const PressureMatrix& matrix, const HostArray<Real>& b,
                                         const HostArray<Real>& x, Real target, int max_iterations) {
  const Index n = matrix.stencil.cells();
  Real* r = r_.data();
  Real* z = z_.data();
  Real* p = p_.data();
  Real* q = q_.data();
  Real* xs = x.data();
  const Real* bs = b.data();
  for_entries("cfd::pressure_system::start", n, [&](Index c) {
    xs[c] = 0;
    r[c] = bs[c];
  });
  if (matrix.singular) remove_mean(matrix, r_);
  const auto magnitude = [&](Index c) { return std::abs(r[c]); };
  LinearReport report;
  report.residual = sum_("cfd::pressure_system::magnitude", n, magnitude);
  if (!(report.residual > target)) {
    report.converged = report.residual <= target;
    return report;
  }
  preconditioner_->update(matrix);
  Real rho = 0;
  report.converged = false;
  while (report.iterations < max_iterations) {
    preconditioner_->apply(r_, z_, report.residual / static_cast<Real>(n));
    if (matrix.singular) remove_mean(matrix, z_);
    const Real rho_new = sum_("cfd::pressure_system::dot_rz", n, [&](Index c) { return r[c] * z[c]; });
    const Real beta = report.iterations == 0 ? 0 : rho_new / rho;
    rho = rho_new;
    for_entries("cfd::pressure_system::turn", n, [&](Index c) { p[c] = z[c] + beta * p[c]; });
    multiply(matrix, p_, q_);
    const Real alpha = rho / sum_("cfd::pressure_system::dot_pq", n, [&](Index c) { return p[c] * q[c]; });
    for_entries("cfd::pressure_system::advance", n, [&](Index c) {
      xs[c] += alpha * p[c];
      r[c] -= alpha * q[c];
    });
    ++report.iterations;
    report.residual = sum_("cfd::pressure_system::magnitude_again", n, magnitude);
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
