// Algebraic multigrid by AMGCL (Demidov, Lobachevskii J. Math. 40 (2019) 535) in single precision as preconditioner.
#include <amgcl/adapter/crs_tuple.hpp>
#include <amgcl/amg.hpp>
#include <amgcl/backend/builtin.hpp>
#include <amgcl/coarsening/smoothed_aggregation.hpp>
#include <amgcl/relaxation/spai0.hpp>
#include <cstddef>
#include <memory>
#include <vector>

#include "cfd/pressure_system.hpp"

namespace pellicle::cfd {

namespace {

// spai0 and smoothed aggregation: neither depends on the number of threads, unlike Gauss-Seidel or ILU here.
using Hierarchy = amgcl::amg<amgcl::backend::builtin<float>, amgcl::coarsening::smoothed_aggregation,
                             amgcl::relaxation::spai0>;

class AmgclPreconditioner final : public PressurePreconditioner {
 public:
  explicit AmgclPreconditioner(const PressureMatrix& shape)
      : r_(static_cast<std::size_t>(shape.stencil.cells())), z_(r_.size()) {}

  void update(const PressureMatrix& matrix) override {
    if (hierarchy_ && !stale_) return;
    build(matrix);
    stale_ = false;
    fresh_iterations_ = -1;
  }

  Real apply(const HostArray<Real>& r, const HostArray<Real>& z, Real /*size*/) override {
    const auto n = static_cast<Index>(r_.size());
    for_entries("cfd::amgcl::to_float", n,
                [&](Index c) { r_[static_cast<std::size_t>(c)] = static_cast<float>(r(c)); });
    hierarchy_->apply(r_, z_);
    for_entries("cfd::amgcl::from_float", n, [&](Index c) { z(c) = z_[static_cast<std::size_t>(c)]; });
    return sum_("cfd::amgcl::dot_rz", n, [&](Index c) { return r(c) * z(c); });
  }

  // A hierarchy serves until it needs half as many iterations again as when it was new. Loose solves do not count.
  void solved(int iterations) override {
    if (fresh_iterations_ < 0) {
      fresh_iterations_ = iterations;
    } else if (iterations > fresh_iterations_ + fresh_iterations_ / 2 + 2) {
      stale_ = true;
    }
  }

  void drop() override { hierarchy_.reset(); }

 private:
  void build(const PressureMatrix& matrix) {
    const Stencil& s = matrix.stencil;
    const auto n = static_cast<std::size_t>(s.cells());
    std::vector<std::ptrdiff_t> start(1, 0), column;
    std::vector<float> value;
    start.reserve(n + 1);
    column.reserve(7 * n);
    value.reserve(7 * n);
    // In single precision round-off of the residual: scaled to numbers of about 1.
    scale_ = 0;
    for (std::size_t c = 0; c < n; ++c) scale_ = std::max(scale_, matrix.diagonal(c));
    const Real inverse = scale_ > 0 ? 1 / scale_ : 1;
    for (Index r = 0; r < s.rows(); ++r) {
      const Row row = s.row(r);
      along_row(row, s.n.x, [&](Index i, Index left, Index right) {
        const Index c = row.cell + i;
        const auto add = [&](Index to, Real coefficient) {
          if (to == c || coefficient == 0) return;
          column.push_back(to);
          value.push_back(static_cast<float>(-coefficient * inverse));
        };
        column.push_back(c);
        const Real d = matrix.diagonal(c) > 0 ? matrix.diagonal(c) : scale_;
        value.push_back(static_cast<float>(d * inverse * (matrix.singular ? 1 + 1e-5 : 1)));
        add(row.cell + left, matrix.coefficient[0](row.x_face + i));
        add(row.cell + right, matrix.coefficient[0](row.x_face + i + 1));
        add(row.y_minus + i, matrix.coefficient[1](row.y_face + i));
        add(row.y_plus + i, matrix.coefficient[1](row.y_face + i + s.face_step(1)));
        add(row.z_minus + i, matrix.coefficient[2](row.z_face + i));
        add(row.z_plus + i, matrix.coefficient[2](row.z_face + i + s.face_step(2)));
        start.push_back(static_cast<std::ptrdiff_t>(column.size()));
      });
    }
    Hierarchy::params parameters;
    parameters.coarse_enough = 500;
    hierarchy_ = std::make_unique<Hierarchy>(std::tie(n, start, column, value), parameters);
  }

  std::unique_ptr<Hierarchy> hierarchy_;
  std::vector<float> r_, z_;
  FixedSum sum_;
  Real scale_ = 1;
  int fresh_iterations_ = -1;
  bool stale_ = false;
};

}  // namespace

std::unique_ptr<PressurePreconditioner> make_amgcl_preconditioner(const PressureMatrix& shape) {
  return std::make_unique<AmgclPreconditioner>(shape);
}

}  // namespace pellicle::cfd
