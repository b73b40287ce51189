// What the gas exchanges in a step, for the balance of its mass and momentum.
#include <cmath>

#include "cfd/gas_solver_impl.hpp"

namespace pellicle::cfd {

void GasSolver::Impl::update_stocks() {
  const Index n = fields.cells;
  const auto mass = [&](Index c) { return fields.density(c) * geometry.volume(c) * fields.void_fraction(c); };
  balance.mass = sum("cfd::gas_solver::mass", n, mass);
  for (int a = 0; a < 3; ++a) {
    balance.momentum[a] =
        sum("cfd::gas_solver::momentum", n, [&](Index c) { return mass(c) * fields.velocity(c + a * n); });
  }
}

void GasSolver::Impl::add_to_balance(Real dt, const ParticleExchange& exchange) {
  update_stocks();
  const Index n = fields.cells;
  Vec3 convected, pressed, sheared;
  for (std::size_t b = 0; b < boundaries.pieces.size(); ++b) {
    const BoundaryPiece& piece = boundaries.pieces[b];
    convected += dt * momentum.convected_inflow(fields, b);
    sheared += dt * momentum.shear_force(fields, b);
    if (!piece.is_immersed()) {
      pressed[piece.axis] -= dt * piece.outward * piece.area * faces.boundary_pressure(fields, b);
    }
    if (piece.patch < 0) continue;
    PatchBalance& patch = balance.patches[static_cast<std::size_t>(piece.patch)];
    const Real out = fields.piece_density[b] * fields.piece_flow[b] * dt;
    (out > 0 ? patch.mass_out : patch.mass_in) += std::abs(out);
  }
  Index done = -1;
  for (std::size_t b = 0; b < geometry.pieces.size(); ++b) {
    sheared += dt * momentum.surface_shear(fields, b);
    // Pieces come in the order of their cells.
    const Index c = geometry.pieces[b].cell;
    if (c != done) pressed += dt * faces.surface_pressure_force(fields, c);
    done = c;
  }
  const auto total = [&](const char* label, auto&& term) {
    Vec3 result;
    for (int a = 0; a < 3; ++a) {
      result[a] = dt * sum(label, n, [&](Index c) { return geometry.volume(c) * term(c, a); });
    }
    return result;
  };
  const Vec3 body = total("cfd::gas_solver::body_impulse", [&](Index c, int a) {
    return fields.void_fraction(c) * (options.body_force[a] + fields.excess_density(c) * options.gravity[a]);
  });
  const bool gaining = exchange.mass_source.extent(0) > 0;
  const Vec3 vapour = total("cfd::gas_solver::vapour_impulse", [&](Index c, int a) {
    return gaining ? exchange.mass_source_momentum(c)[a] : 0;
  });
  if (gaining) {
    balance.mass_given += dt * sum("cfd::gas_solver::mass_given", n,
                                   [&](Index c) { return geometry.volume(c) * exchange.mass_source(c); });
  }
  const Vec3 drag = total("cfd::gas_solver::drag_impulse", [&](Index c, int a) {
    const Real own = fields.exchange_coefficient(c) - fields.mass_source(c);
    const Real buoyancy = fields.void_fraction(c) * fields.excess_density(c) * options.gravity[a];
    return fields.force(c + a * n) - own * fields.velocity(c + a * n) - buoyancy -
           (gaining ? exchange.mass_source_momentum(c)[a] : 0);
  });
  const Vec3 particle_pressure = total("cfd::gas_solver::pressure_impulse", [&](Index c, int a) {
    return (1 - fields.void_fraction(c)) * state.pressure_gradient(c)[a];
  });
  for (const Vec3& part : {convected, pressed, sheared, body, drag, particle_pressure, vapour}) {
    for (int a = 0; a < 3; ++a) balance.gross[a] += std::abs(part[a]);
  }
  // Buoyancy lifts here and presses down there: what it exchanges is more than its sum.
  balance.gross += total("cfd::gas_solver::gross_buoyancy", [&](Index c, int a) {
    return fields.void_fraction(c) * std::abs(fields.excess_density(c) * options.gravity[a]);
  });
  balance.convected += convected;
  balance.boundary_pressure += pressed;
  balance.boundary_shear += sheared;
  balance.body_force += body;
  balance.drag += drag;
  balance.vapour += vapour;
  balance.particle_pressure += particle_pressure;
}

}  // namespace pellicle::cfd
