// Whether a step of the gas went well, and where not.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cfd/gas_solver_impl.hpp"
#include "core/error.hpp"

namespace pellicle::cfd {

namespace {

// Both together mean that the gas has gone astray; a flow that steps of any length march to its steady state has the
// Courant number of its inlets or some times that.
constexpr Real most_courant = 1000;
constexpr Real most_over_inlets = 100;

}  // namespace

Real GasSolver::Impl::face_velocity_change() {
  Real change = 0;
  Real fastest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const Real *now = fields.superficial[a].data(), *old = before[a].data();
    const auto [changed, fast] = sum.largest_two(
        "cfd::gas_solver::face_change", static_cast<Index>(before[a].extent(0)), [=](Index f) {
          return std::array{std::abs(now[f] - old[f]), std::abs(now[f])};
        });
    change = std::max(change, changed);
    fastest = std::max(fastest, fast);
  }
  return fastest > 0 ? change / fastest : 0;
}

// A cell beside the face whose velocity the last outer iteration changed most.
Index GasSolver::Impl::most_changed_cell() const {
  Index worst = 0;
  Real largest = -1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Index step = geometry.stencil.face_step(axis);
    for (Index r = 0; r < geometry.stencil.rows(); ++r) {
      const Row row = geometry.stencil.row(r);
      const Index first = axis == 0 ? row.x_face : (axis == 1 ? row.y_face : row.z_face);
      for (Index i = 0; i < geometry.stencil.n.x; ++i) {
        for (const Index f : {first + i, first + i + step}) {
          const Real change = std::abs(fields.superficial[a](f) - before[a](f));
          if (change <= largest) continue;
          largest = change;
          worst = row.cell + i;
        }
      }
    }
  }
  return worst;
}

// Relative change of a cell's gas in the step that the fluxes do not account for.
Real GasSolver::Impl::find_divergence(Real dt) {
  compute_continuity_residual(dt);
  const Real *volume = geometry.volume.data(), *residual = rhs.data();
  return sum.largest("cfd::gas_solver::divergence", fields.cells,
                     [=](Index c) { return volume[c] > 0 ? std::abs(residual[c]) * dt / volume[c] : 0; });
}

void GasSolver::Impl::fail(const std::string& what, Index cell) const {
  const Index3 at = geometry.grid.coordinates(cell);
  throw RunError(fmt::format("gas: {}, in cell ({}, {}, {}) at ({:.6g}, {:.6g}, {:.6g}) m, at t = {:.9g} s",
                             what, at.x, at.y, at.z, geometry.grid.center(0, at.x),
                             geometry.grid.center(1, at.y), geometry.grid.center(2, at.z), state.time));
}

// The cell that is not finite, else the one with the largest mass residual.
Index GasSolver::Impl::worst_cell() const {
  Index worst = 0;
  for (Index c = 0; c < fields.cells; ++c) {
    if (!std::isfinite(rhs(c) + fields.velocity(c))) return c;
    if (std::abs(rhs(c)) > std::abs(rhs(worst))) worst = c;
  }
  return worst;
}

Real GasSolver::Impl::check_and_find_courant(Real dt) {
  const Stencil& s = geometry.stencil;
  const Index n = s.cells();
  row_courant.resize(static_cast<std::size_t>(s.rows()));
  const Real *u = fields.velocity.data(), *p = fields.pressure.data(), *per_width = inverse_width.data();
  for_rows("cfd::gas_solver::courant", s, [&](const Index r) {
    const Row row = s.row(r);
    const Real per_y = 1 / geometry.axis[1].width[static_cast<std::size_t>(row.j)];
    const Real per_z = 1 / geometry.axis[2].width[static_cast<std::size_t>(row.k)];
    Real largest = 0;
    Real numbers = 0;  // stays 0 as long as all are finite
    const Real *ux = u + row.cell, *uy = ux + n, *uz = uy + n, *pressure = p + row.cell, *per_x = per_width;
    const Index nx = s.n.x;
#pragma omp simd reduction(max : largest) reduction(+ : numbers)
    for (Index i = 0; i < nx; ++i) {
      const Real own = std::abs(ux[i]) * per_x[i] + std::abs(uy[i]) * per_y + std::abs(uz[i]) * per_z;
      numbers += 0 * (own + pressure[i]);
      largest = own > largest ? own : largest;
    }
    row_courant[static_cast<std::size_t>(r)] = numbers == 0 ? dt * largest : numbers;
  });
  Real courant = 0;
  for (Index r = 0; r < s.rows(); ++r) {
    const Real own = row_courant[static_cast<std::size_t>(r)];
    if (!std::isfinite(own)) {
      for (Index c = s.row(r).cell; c < n; ++c) {
        if (!std::isfinite(u[c] + u[c + n] + u[c + 2 * n] + p[c])) {
          fail("velocity or pressure is no longer finite", c);
        }
      }
    }
    courant = std::max(courant, own);
  }
  if (courant > most_courant && courant > most_over_inlets * fastest_inlet(dt)) fail_for_courant(courant, dt);
  return courant;
}

// Courant number of the fastest inlet; infinite without inlets, where nothing says how fast the gas may be.
Real GasSolver::Impl::fastest_inlet(Real dt) const {
  Real fastest = 0;
  for (const BoundaryPiece& piece : boundaries.pieces) {
    if (piece.kind != PieceKind::inlet) continue;
    const Index3 at = geometry.grid.coordinates(piece.cell);
    const Real width =
        std::min({geometry.grid.width(0, at.x), geometry.grid.width(1, at.y), geometry.grid.width(2, at.z)});
    fastest = std::max(fastest, std::abs(piece.inward_speed()) * dt / width);
  }
  return fastest > 0 ? fastest : std::numeric_limits<Real>::infinity();
}

void GasSolver::Impl::fail_for_courant(Real courant, Real dt) const {
  const auto number = [&](Index c) {
    const Index3 at = geometry.grid.coordinates(c);
    Real sum_of_parts = 0;
    for (int a = 0; a < 3; ++a) {
      sum_of_parts += dt * std::abs(fields.velocity(c + a * fields.cells)) / geometry.grid.width(a, at[a]);
    }
    return sum_of_parts;
  };
  Index worst = 0;
  for (Index c = 1; c < fields.cells; ++c) {
    if (number(c) > number(worst)) worst = c;
  }
  fail(fmt::format(
           "the outer iterations do not converge: at a Courant number of {:.3g} a velocity of {:.3g} m/s is "
           "no solution; a smaller gas step (time.gas_step, time.courant) or a larger "
           "solver.max_outer_iterations would help",
           courant,
           norm(Vec3{fields.velocity(worst), fields.velocity(worst + fields.cells),
                     fields.velocity(worst + 2 * fields.cells)})),
       worst);
}

}  // namespace pellicle::cfd
