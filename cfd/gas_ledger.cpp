// What the gas exchanges in a step, for the balance of its mass and momentum.
#include <array>
#include <cmath>

#include "cfd/gas_solver_impl.hpp"

namespace pellicle::cfd {

namespace {

// Sum of term(cell) over a block.
template <class Term>
Real sum_over(Index begin, Index end, const Term& term) {
  const Term own = term;  // not read anew for every cell
  Real total = 0;
#pragma omp simd reduction(+ : total)
  for (Index c = begin; c < end; ++c) total += own(c);
  return total;
}

template <std::size_t n>
Vec3 vector_from(const std::array<Real, n>& sums, std::size_t first) {
  return {sums[first], sums[first + 1], sums[first + 2]};
}

}  // namespace

void GasSolver::Impl::update_stocks() {
  const Index n = fields.cells;
  const Real *rho = fields.density.data(), *volume = geometry.volume.data();
  const Real *eps = fields.void_fraction.data(), *u = fields.velocity.data();
  const auto sums = sum.several<4>("cfd::gas_solver::stocks", n, [=](Index begin, Index end, auto& total) {
    total[3] += sum_over(begin, end, [=](Index c) { return rho[c] * volume[c] * eps[c]; });
    for (int a = 0; a < 3; ++a) {
      const Real* along = u + static_cast<std::ptrdiff_t>(a) * n;
      total[static_cast<std::size_t>(a)] +=
          sum_over(begin, end, [=](Index c) { return rho[c] * volume[c] * eps[c] * along[c]; });
    }
  });
  balance.momentum = vector_from(sums, 0);
  balance.mass = sums[3];
}

void GasSolver::Impl::add_to_balance(Real dt, const ParticleExchange& exchange) {
  update_stocks();
  const Index n = fields.cells;
  const auto add = [](auto& sums, std::size_t first, const Vec3& v) {
    for (int a = 0; a < 3; ++a) sums[first + static_cast<std::size_t>(a)] += v[a];
  };
  const auto outside = sum.several<9>(
      "cfd::gas_solver::boundary_impulse", static_cast<Index>(boundaries.pieces.size()),
      [&](Index begin, Index end, auto& sums) {
        for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b) {
          const BoundaryPiece& piece = boundaries.pieces[b];
          add(sums, 0, momentum.convected_inflow(fields, b));
          add(sums, 3, momentum.shear_force(fields, b));
          if (piece.is_immersed()) continue;
          sums[6 + static_cast<std::size_t>(piece.axis)] -=
              piece.outward * piece.area * faces.boundary_pressure(fields, b);
        }
      });
  const auto within = sum.several<6>(
      "cfd::gas_solver::surface_impulse", static_cast<Index>(geometry.pieces.size()),
      [&](Index begin, Index end, auto& sums) {
        for (auto b = static_cast<std::size_t>(begin); b < static_cast<std::size_t>(end); ++b) {
          add(sums, 0, momentum.surface_shear(fields, b));
          // Pieces come in the order of their cells.
          const Index c = geometry.pieces[b].cell;
          if (b == 0 || c != geometry.pieces[b - 1].cell)
            add(sums, 3, faces.surface_pressure_force(fields, c));
        }
      });
  const Vec3 convected = dt * vector_from(outside, 0);
  const Vec3 sheared = dt * (vector_from(outside, 3) + vector_from(within, 0));
  const Vec3 pressed = dt * (vector_from(outside, 6) + vector_from(within, 3));
  for (const std::size_t b : boundaries.passable) {
    const int p = boundaries.pieces[b].patch;
    if (p < 0) continue;
    PatchBalance& patch = balance.patches[static_cast<std::size_t>(p)];
    const Real out = fields.piece_density[b] * fields.piece_flow[b] * dt;
    (out > 0 ? patch.mass_out : patch.mass_in) += std::abs(out);
  }
  const bool gaining = exchange.mass_source.extent(0) > 0;
  const Real *volume = geometry.volume.data(), *eps = fields.void_fraction.data();
  const Real *excess = fields.excess_density.data(), *beta = fields.exchange_coefficient.data();
  const Real *source = fields.mass_source.data(), *force = fields.force.data(), *u = fields.velocity.data();
  const Vec3 gravity = options.gravity;
  const Vec3 body_force = options.body_force;
  const auto sums = sum.several<16>("cfd::gas_solver::impulse", n, [&](Index begin, Index end, auto& total) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Real g = gravity[axis];
      const Real given = body_force[axis];
      const std::ptrdiff_t shift = static_cast<std::ptrdiff_t>(axis) * n;
      const Real *along = u + shift, *pushed = force + shift;
      const Vec3* gradient = state.pressure_gradient.data();
      total[a] +=
          sum_over(begin, end, [=](Index c) { return volume[c] * (eps[c] * (given + excess[c] * g)); });
      total[3 + a] += sum_over(begin, end, [=](Index c) {
        const Real own = beta[c] - source[c];
        return volume[c] * (pushed[c] - own * along[c] - eps[c] * excess[c] * g);
      });
      total[6 + a] +=
          sum_over(begin, end, [=](Index c) { return volume[c] * ((1 - eps[c]) * gradient[c][axis]); });
      // Buoyancy lifts here and presses down there: what it exchanges is more than its sum.
      total[9 + a] +=
          sum_over(begin, end, [=](Index c) { return volume[c] * (eps[c] * std::abs(excess[c] * g)); });
      if (!gaining) continue;
      const Vec3* brought = exchange.mass_source_momentum.data();
      total[12 + a] += sum_over(begin, end, [=](Index c) { return volume[c] * brought[c][axis]; });
    }
    if (!gaining) return;
    const Real* gained = exchange.mass_source.data();
    total[15] += sum_over(begin, end, [=](Index c) { return volume[c] * gained[c]; });
  });
  const Vec3 body = dt * vector_from(sums, 0);
  const Vec3 vapour = dt * vector_from(sums, 12);
  const Vec3 drag = dt * vector_from(sums, 3) - vapour;
  const Vec3 particle_pressure = dt * vector_from(sums, 6);
  balance.mass_given += dt * sums[15];
  for (const Vec3& part : {convected, pressed, sheared, body, drag, particle_pressure, vapour}) {
    for (int a = 0; a < 3; ++a) balance.gross[a] += std::abs(part[a]);
  }
  balance.gross += dt * vector_from(sums, 9);
  balance.convected += convected;
  balance.boundary_pressure += pressed;
  balance.boundary_shear += sheared;
  balance.body_force += body;
  balance.drag += drag;
  balance.vapour += vapour;
  balance.particle_pressure += particle_pressure;
}

}  // namespace pellicle::cfd
