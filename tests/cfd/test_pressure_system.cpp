// The pressure equation's solvers against a dense factorisation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "cfd/flow_geometry.hpp"
#include "cfd/pressure_system.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

struct Problem {
  Problem(const CartesianGrid& grid, bool outlet, Real jump)
      : geometry(grid), matrix(geometry.stencil), b("tests::cfd::b", size()), x("tests::cfd::x", size()) {
    const Stencil& s = geometry.stencil;
    std::mt19937 random(7);
    std::uniform_real_distribution<Real> spread(0.8, 1.2);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      std::vector<Real> scatter(
          matrix.coefficient[a].extent(0));  // drawn here: the loop may have several threads
      for (Real& factor : scatter) factor = spread(random);
      for_faces("tests::cfd::coefficient", s, axis, [&](Index f, Index m, Index, Index position, Index) {
        const bool bed = grid.coordinates(m).z < s.n.z / 2;
        matrix.coefficient[a](f) = scatter[static_cast<std::size_t>(f)] * geometry.area[a](f) /
                                   geometry.axis[a].distance[static_cast<std::size_t>(position)] /
                                   (bed ? jump : 1);
      });
      copy_periodic_faces(s, axis, matrix.coefficient[a]);
    }
    if (outlet) {
      for (Index c = 0; c < s.stride(2); ++c) {
        const Index top = c + s.cells() - s.stride(2);
        matrix.boundary[2](top) = 2 * geometry.area[2](s.faces(2) - 1) / grid.width(2, s.n.z - 1);
      }
    }
    matrix.singular = !outlet;
    matrix.finish();
    for (std::size_t c = 0; c < size(); ++c) b(c) = spread(random) - 1;
  }
  std::size_t size() const { return static_cast<std::size_t>(geometry.stencil.cells()); }

  FlowGeometry geometry;
  PressureMatrix matrix;
  HostArray<Real> b, x;
};

using Dense = std::vector<std::vector<Real>>;

// The matrix from its action on unit vectors: tests multiply() against the definition at the same time.
Dense make_dense(const Problem& problem) {
  const std::size_t n = problem.size();
  Dense m(n, std::vector<Real>(n));
  HostArray<Real> unit("tests::cfd::unit", n), image("tests::cfd::image", n);
  for (std::size_t j = 0; j < n; ++j) {
    Kokkos::deep_copy(unit, 0.0);
    unit(j) = 1;
    multiply(problem.matrix, unit, image);
    for (std::size_t i = 0; i < n; ++i) m[i][j] = image(i);
  }
  return m;
}

// Gaussian elimination; the matrix is symmetric and positive definite, so without pivoting.
std::vector<Real> eliminate(Dense m, std::vector<Real> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = k + 1; i < n; ++i) {
      const Real factor = m[i][k] / m[k][k];
      if (factor == 0) continue;
      for (std::size_t j = k; j < n; ++j) m[i][j] -= factor * m[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t j = i + 1; j < n; ++j) b[i] -= m[i][j] * b[j];
    b[i] /= m[i][i];
  }
  return b;
}

void remove_mean(std::vector<Real>& v) {
  Real mean = 0;
  for (const Real e : v) mean += e / static_cast<Real>(v.size());
  for (Real& e : v) e -= mean;
}

class PressureSolvers : public testing::TestWithParam<PressureSolver> {};

TEST_P(PressureSolvers, AgreeWithDenseFactorisation) {
  const std::array<CartesianGrid, 5> grids{
      CartesianGrid(Box{{0, 0, 0}, {1, 0.2, 2}}, {7, 2, 12}),
      CartesianGrid(Box{{0, 0, 0}, {1, 1, 1}}, {5, 4, 9}, {true, true, false}),
      CartesianGrid(Box{{0, 0, 0}, {1, 1, 1}}, {1, 1, 50}),
      CartesianGrid(std::array<std::vector<Real>, 3>{
          {make_stretched_faces(1, 9), {0, 0.01}, make_stretched_faces(3, 13)}}),
      CartesianGrid(Box{{0, 0, 0}, {1, 1, 1}}, {2, 6, 8}, {true, false, false})};
  for (const CartesianGrid& grid : grids) {
    for (const bool outlet : {true, false}) {
      Problem problem(grid, outlet, 100);
      Dense m = make_dense(problem);
      PressureLinearSolver solver(problem.geometry, GetParam());
      const LinearReport report = solver.solve(problem.matrix, problem.b, problem.x, 1e-11, 200);
      EXPECT_TRUE(report.converged);
      std::vector<Real> b(problem.b.data(), problem.b.data() + problem.size());
      std::vector<Real> x(problem.x.data(), problem.x.data() + problem.size());
      if (!outlet) {
        // Known up to a constant: one diagonal entry more fixes it, the mean is taken off both.
        remove_mean(b);
        m[0][0] *= 2;
      }
      std::vector<Real> exact = eliminate(m, b);
      if (!outlet) {
        remove_mean(x);
        remove_mean(exact);
      }
      Real difference = 0;
      Real size = 0;
      for (std::size_t c = 0; c < x.size(); ++c) {
        difference = std::max(difference, std::abs(x[c] - exact[c]));
        size = std::max(size, std::abs(exact[c]));
      }
      // Residual 1e-11 times the condition number of some 1e5, relative.
      EXPECT_LT(difference, 1e-6 * size);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Both, PressureSolvers,
                         testing::Values(PressureSolver::multigrid, PressureSolver::amgcl));

// Multigrid's iterations hardly grow with the grid, also where drag jumps a hundredfold.
TEST(Multigrid, IterationsDoNotGrowWithTheGrid) {
  for (const Real jump : {1.0, 100.0}) {
    for (const Index n : {8, 16, 32}) {
      Problem problem(CartesianGrid(Box{{0, 0, 0}, {1, 1, 2}}, {n, n, 2 * n}), true, jump);
      PressureLinearSolver solver(problem.geometry, PressureSolver::multigrid);
      Real sum = 0;
      for (std::size_t c = 0; c < problem.size(); ++c) sum += std::abs(problem.b(c));
      const LinearReport report = solver.solve(problem.matrix, problem.b, problem.x, 1e-10 * sum, 100);
      EXPECT_TRUE(report.converged);
      EXPECT_LE(report.iterations, 20) << "n " << n << ", jump " << jump;
    }
  }
}

}  // namespace
}  // namespace pellicle::cfd
