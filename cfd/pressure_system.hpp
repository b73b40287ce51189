// The linear system of the pressure correction and its solvers.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "cfd/fixed_sum.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_options.hpp"
#include "cfd/gas_state.hpp"
#include "cfd/stencil.hpp"

namespace pellicle::cfd {

/// Symmetric 7-point matrix: (A p)_P = sum over faces of c (p_P - p_N), p_N = 0 beyond an outlet.
struct PressureMatrix {
  explicit PressureMatrix(const Stencil& stencil);
  /// Fills `diagonal` from the rest.
  void finish();

  Stencil stencil;
  FaceField coefficient;                    ///< c >= 0 of faces with two cells; 0 on boundary faces
  std::array<HostArray<Real>, 3> boundary;  ///< per cell: sum of c towards outlets across each axis
  HostArray<Real> diagonal;
  bool singular = false;  ///< no outlet: the solution is known up to a constant
};

/// result = A x.
void multiply(const PressureMatrix& matrix, const HostArray<Real>& x, const HostArray<Real>& result);

/// z = M r with M symmetric positive definite, close to the inverse of A.
class PressurePreconditioner {
 public:
  virtual ~PressurePreconditioner() = default;
  /// Called before every solve; may keep what it has if that still serves.
  virtual void update(const PressureMatrix& matrix) = 0;
  /// `size`: mean of |r|. Returns the sum of r z.
  virtual Real apply(const HostArray<Real>& r, const HostArray<Real>& z, Real size) = 0;
  /// Told how many iterations the solve took.
  virtual void solved(int /*iterations*/) {}
  virtual void drop() {}
};

std::unique_ptr<PressurePreconditioner> make_multigrid(const PressureMatrix& shape);
std::unique_ptr<PressurePreconditioner> make_amgcl_preconditioner(const PressureMatrix& shape);

struct LinearReport {
  int iterations = 0;
  Real residual = 0;  ///< sum of |r| at the end
  bool converged = true;
};

/// Preconditioned conjugate gradients whose sums run over fixed blocks: the same bits for any number of threads.
class PressureLinearSolver {
 public:
  PressureLinearSolver(const FlowGeometry& geometry, PressureSolver kind);
  /// Solves A x = b from x = 0 until sum |b - A x| <= target. If A is singular, b is first made to sum to 0.
  LinearReport solve(const PressureMatrix& matrix, const HostArray<Real>& b, const HostArray<Real>& x,
                     Real target, int max_iterations);
  void drop() { preconditioner_->drop(); }

 private:
  void remove_mean(const PressureMatrix& matrix, const HostArray<Real>& v);
  Real precondition(const PressureMatrix& matrix, Real residual);

  std::unique_ptr<PressurePreconditioner> preconditioner_;
  HostArray<Real> r_, z_, p_, q_;
  std::vector<Real> row_sums_;
  FixedSum sum_;
};

}  // namespace pellicle::cfd
