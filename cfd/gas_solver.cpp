#include "cfd/gas_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "cfd/gas_solver_impl.hpp"
#include "core/error.hpp"

namespace pellicle::cfd {

namespace {

HostArray<Real> make_array(const char* label, Index size) {
  return HostArray<Real>(std::string(label), static_cast<std::size_t>(size));
}

void check_options(const GasOptions& o) {
  const auto refuse = [](const char* what) { throw InputError(fmt::format("gas: {}", what)); };
  if (!(o.density > 0)) refuse("density is not positive; allowed: > 0 kg/m3");
  if (!(o.viscosity >= 0)) refuse("viscosity is negative; allowed: >= 0 Pa s");
  if (!(o.solver.velocity_relaxation > 0 && o.solver.velocity_relaxation <= 1)) {
    refuse("solver.velocity_relaxation is out of range; allowed: > 0 and <= 1");
  }
  if (o.solver.max_outer_iterations < 1) refuse("solver.max_outer_iterations is too small; allowed: >= 1");
}

// A mass flow is a flow rate at the density of the gas that comes in.
std::vector<BoundaryPatch> with_flow_rates(std::vector<BoundaryPatch> patches, const GasOptions& options) {
  for (BoundaryPatch& patch : patches) {
    auto* inlet = std::get_if<Inlet>(&patch.kind);
    if (!inlet || !inlet->mass_flow || inlet->velocity || inlet->flow_rate) continue;
    inlet->flow_rate = *inlet->mass_flow / incoming_density(patch, options);
    inlet->mass_flow.reset();
  }
  return patches;
}

}  // namespace

ParticleExchange make_empty_exchange(const CartesianGrid& grid) {
  const auto n = static_cast<std::size_t>(grid.cell_count());
  ParticleExchange exchange{HostArray<Real>("cfd::exchange::void_fraction", n),
                            HostArray<Real>("cfd::exchange::exchange_coefficient", n),
                            HostArray<Vec3>("cfd::exchange::explicit_force", n)};
  Kokkos::deep_copy(exchange.void_fraction, 1.0);
  return exchange;
}

GasSolver::Impl::Impl(const CartesianGrid& grid, const GasOptions& gas_options,
                      std::vector<BoundaryPatch> boundary_patches, const ImmersedGeometry& immersed)
    : geometry(grid, immersed),
      options(gas_options),
      patches(with_flow_rates(std::move(boundary_patches), options)),
      boundaries(cut_boundaries(geometry, patches)),
      fields(geometry, boundaries.pieces.size(), options.turbulence.has_value()),
      momentum(geometry, boundaries, options),
      faces(geometry, boundaries, options),
      pressure_matrix(geometry.stencil),
      pressure_solver(geometry, options.solver.pressure_solver),
      scalars(geometry, boundaries, patches, options) {
  check_options(options);
  if (options.turbulence) turbulence.emplace(geometry, boundaries, patches, options);
  const Index n = fields.cells;
  pressure_matrix.singular = !boundaries.has_outlet;
  influx = make_array("cfd::gas_solver::influx", 3 * n);
  inertia = make_array("cfd::gas_solver::inertia", 3 * n);
  relaxation = make_array("cfd::gas_solver::relaxation", 3 * n);
  cell_force = make_array("cfd::gas_solver::cell_force", 3 * n);
  rhs = make_array("cfd::gas_solver::rhs", n);
  correction = make_array("cfd::gas_solver::correction", n);
  before = make_face_field(geometry.stencil, "cfd::gas_solver::before");
  state.velocity = HostArray<Vec3>("cfd::gas_solver::velocity", static_cast<std::size_t>(n));
  state.pressure_gradient =
      HostArray<Vec3>("cfd::gas_solver::pressure_gradient", static_cast<std::size_t>(n));
  state.volume_flux = make_face_field(geometry.stencil, "cfd::gas_solver::volume_flux");
  state.pressure = fields.pressure;
  state.void_fraction = fields.void_fraction;
  state.void_fraction_old = fields.void_fraction_old;
  state.superficial_velocity = fields.superficial;
  for (const std::string& name : boundaries.patch_names) balance.patches.push_back({name, 0, 0});
  state.density = fields.density;
  for (const Scalar scalar : {Scalar::temperature, Scalar::moisture}) {
    if (scalars[scalar]) state.scalars[index_of(scalar)] = scalars[scalar]->value();
  }
  if (turbulence) {
    state.turbulent_kinetic_energy = turbulence->k();
    state.turbulent_dissipation = turbulence->epsilon();
    state.eddy_viscosity = fields.eddy_viscosity;
  }
}

void GasSolver::Impl::initialise(const HostArray<Real>& given_void_fraction) {
  const Index n = fields.cells;
  const HostArray<Real>& void_fraction = fields.void_fraction;
  Kokkos::deep_copy(void_fraction, given_void_fraction);
  for (Index c = 0; c < n; ++c) {
    if (geometry.volume(c) > 0) continue;
    void_fraction(c) = 1;
    for (int a = 0; a < 3; ++a) fields.velocity(c + a * n) = 0;
  }
  Kokkos::deep_copy(fields.void_fraction_old, void_fraction);
  scalars.initialise(fields);
  if (turbulence) turbulence->initialise(fields);
  Kokkos::deep_copy(fields.pressure, 0.0);
  Kokkos::deep_copy(state.pressure_gradient, Vec3{});
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Real* u = &fields.velocity(axis * n);
    for_faces("cfd::gas_solver::initial_faces", geometry.stencil, axis,
              [&](Index f, Index m, Index p, Index position, Index) {
                const Real wm = geometry.axis[a].series_minus[static_cast<std::size_t>(position)];
                const Real wl = geometry.axis[a].linear_minus[static_cast<std::size_t>(position)];
                const Real eps = 1 / (wm / void_fraction(m) + (1 - wm) / void_fraction(p));
                fields.superficial[a](f) = eps * (wl * u[m] + (1 - wl) * u[p]);
              });
    copy_periodic_faces(geometry.stencil, axis, fields.superficial[a]);
    for (const Index f : geometry.closed_faces[a]) fields.superficial[a](f) = 0;
  }
  for (std::size_t b = 0; b < boundaries.pieces.size(); ++b) {
    const BoundaryPiece& piece = boundaries.pieces[b];
    Real speed = 0;  // outward
    if (piece.kind == PieceKind::inlet) speed = -piece.inward_speed();
    if (piece.kind == PieceKind::outlet) {
      const Index c = piece.cell;
      speed = void_fraction(c) *
              piece.outward_part({fields.velocity(c), fields.velocity(c + n), fields.velocity(c + 2 * n)});
    }
    fields.piece_flow[b] = speed * piece.area;
  }
  set_boundary_velocities(geometry, boundaries, fields);
  update_mass_flux();
  copy_velocity_to_state();
  state.time = 0;
  balance = GasBalance{};
  for (const std::string& name : boundaries.patch_names) balance.patches.push_back({name, 0, 0});
  update_stocks();
  balance.mass_initial = balance.mass;
  balance.momentum_initial = balance.momentum;
}

void GasSolver::Impl::take_exchange(const ParticleExchange& exchange, Real dt) {
  const Index n = fields.cells;
  const auto size = static_cast<std::size_t>(n);
  if (exchange.void_fraction.extent(0) != size || exchange.exchange_coefficient.extent(0) != size ||
      exchange.explicit_force.extent(0) != size) {
    throw std::invalid_argument("the exchange fields have another size than the gas grid");
  }
  if (!(dt > 0)) throw std::invalid_argument("the gas step is not positive");
  Kokkos::deep_copy(fields.velocity_old, fields.velocity);
  Kokkos::deep_copy(fields.void_fraction_old, fields.void_fraction);
  for (std::size_t a = 0; a < 3; ++a) Kokkos::deep_copy(fields.superficial_old[a], fields.superficial[a]);
  fields.piece_flow_old = fields.piece_flow;
  for (Index c = 0; c < n; ++c) {
    const Real eps = exchange.void_fraction(c);
    const Real beta = exchange.exchange_coefficient(c);
    if (!(eps > 0 && eps <= 1 + 1e-9)) fail(fmt::format("the void fraction is {}", eps), c);
    if (!(beta >= 0 && std::isfinite(beta)))
      fail(fmt::format("the momentum exchange coefficient is {}", beta), c);
    if (!(geometry.volume(c) > 0)) continue;
    fields.void_fraction(c) = eps;
    fields.exchange_coefficient(c) = beta;
    const Vec3 force = exchange.explicit_force(c);
    for (int a = 0; a < 3; ++a) fields.force(c + a * n) = force[a];
  }
  scalars.prepare(fields);
  if (turbulence) turbulence->prepare(fields);
  for_entries("cfd::gas_solver::buoyancy", n, [&](Index c) {
    if (!(geometry.volume(c) > 0)) return;  // keeps its force, of 0
    const Real weight = fields.void_fraction(c) * fields.excess_density(c);
    for (int a = 0; a < 3; ++a) fields.force(c + a * n) += weight * options.gravity[a];
  });
  take_mass_source(exchange, dt);
}

// What becomes gas at the velocity v pulls the gas there with S (v - u), as drag does.
void GasSolver::Impl::take_mass_source(const ParticleExchange& exchange, Real dt) {
  const HostArray<Real>& source = exchange.mass_source;
  const Index n = fields.cells;
  if (source.extent(0) != exchange.mass_source_momentum.extent(0) ||
      (source.extent(0) > 0 && source.extent(0) != static_cast<std::size_t>(n))) {
    throw std::invalid_argument("the source of mass has another size than the gas grid");
  }
  if (source.extent(0) == 0) {
    Kokkos::deep_copy(fields.mass_source, 0.0);
    return;
  }
  Kokkos::deep_copy(fields.mass_source, source);
  for (Index c = 0; c < n; ++c) {
    if (!(geometry.volume(c) > 0)) {
      fields.mass_source(c) = 0;
      continue;
    }
    // Condensation leaves some gas.
    if (!(fields.density_old(c) * fields.void_fraction_old(c) + dt * source(c) > 0)) {
      fail(fmt::format("the source of mass is {} kg/m3/s", source(c)), c);
    }
    fields.exchange_coefficient(c) += source(c);
    for (int a = 0; a < 3; ++a) fields.force(c + a * n) += exchange.mass_source_momentum(c)[a];
  }
}

// Coefficients at the velocities and fluxes at hand; diagonal terms of time, drag and relaxation.
void GasSolver::Impl::assemble_momentum(Real dt) {
  momentum.assemble(fields);
  const Index n = fields.cells;
  const Real keep = (1 - options.solver.velocity_relaxation) / options.solver.velocity_relaxation;
  for_entries("cfd::gas_solver::inertia", n, [&](Index c) {
    // A cell without gas takes part with a velocity of 0: any diagonal will do.
    const Real own_inertia =
        geometry.volume(c) > 0
            ? geometry.volume(c) *
                  (fields.density_old(c) * fields.void_fraction_old(c) / dt + fields.exchange_coefficient(c))
            : 1;
    for (Index e = c; e < 3 * n; e += n) {
      relaxation(e) = keep * (momentum.own()(e) + own_inertia);
      inertia(e) = own_inertia + relaxation(e);
    }
  });
}

void GasSolver::Impl::update_mass_flux() {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for_faces("cfd::gas_solver::mass_flux", geometry.stencil, axis, [&](Index f, Index, Index, Index, Index) {
      fields.mass_flux[a](f) = fields.face_density[a](f) * geometry.area[a](f) * fields.superficial[a](f);
    });
    copy_periodic_faces(geometry.stencil, axis, fields.mass_flux[a]);
  }
}

// rhs = -(mass that leaves the cell + growth of its gas - vapour that becomes gas) per second, over the density of
// reference: a volume where the density is constant.
Real GasSolver::Impl::compute_continuity_residual(Real dt) {
  const Stencil& s = geometry.stencil;
  for_rows("cfd::gas_solver::continuity", s, [&](const Index r) {
    const Row row = s.row(r);
    for (Index i = 0; i < s.n.x; ++i) {
      const Index c = row.cell + i;
      Real out = geometry.volume(c) * (growth_of_gas(c, dt) - fields.mass_source(c) / options.density);
      const Index first[3] = {row.x_face + i, row.y_face + i, row.z_face + i};
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const Index f = first[axis];
        const Index g = f + s.face_step(axis);
        // The density of boundary faces is 0: what flows there follows below.
        out +=
            geometry.area[a](g) * fields.superficial[a](g) * (fields.face_density[a](g) / options.density) -
            geometry.area[a](f) * fields.superficial[a](f) * (fields.face_density[a](f) / options.density);
      }
      rhs(c) = -out;
    }
  });
  for (std::size_t b = 0; b < boundaries.pieces.size(); ++b) {
    rhs(boundaries.pieces[b].cell) -= fields.piece_flow[b] * (fields.piece_density[b] / options.density);
  }
  return sum("cfd::gas_solver::continuity_sum", s.cells(), [&](Index c) { return std::abs(rhs(c)); });
}

// Of the gas in a cell, over the density of reference, per volume of cell and second.
Real GasSolver::Impl::growth_of_gas(Index c, Real dt) const {
  return (fields.void_fraction(c) * (fields.density(c) / options.density) -
          fields.void_fraction_old(c) * (fields.density_old(c) / options.density)) /
         dt;
}

// Volume flow through a typical section of the domain, plus what moving particles displace [m3/s].
Real GasSolver::Impl::gas_throughput(Real dt) {
  Real total = sum("cfd::gas_solver::displaced", fields.cells,
                   [&](Index c) { return geometry.volume(c) * std::abs(growth_of_gas(c, dt)); });
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Index count = geometry.stencil.faces(axis);
    total += sum("cfd::gas_solver::through", count,
                 [&](Index f) { return geometry.area[a](f) * std::abs(fields.superficial[a](f)); }) /
             (geometry.stencil.n[axis] + 1);
  }
  return total;
}

void GasSolver::Impl::solve_pressure(Real dt, bool tightly, StepReport& report) {
  momentum.compute_influx(fields, influx);
  faces.predict(fields, momentum, influx, relaxation, dt, pressure_matrix);
  const Real residual = compute_continuity_residual(dt);
  const Real throughput = gas_throughput(dt);
  if (pressure_matrix.singular) {
    const Real surplus = sum("cfd::gas_solver::surplus", fields.cells, [&](Index c) { return rhs(c); });
    const Real volume =
        sum("cfd::gas_solver::volume", fields.cells, [&](Index c) { return geometry.volume(c); });
    // The second term: round-off of the void fraction in a gas at rest.
    if (std::abs(surplus) > 1e-8 * throughput + 1e-13 * volume / dt) {
      fail(
          fmt::format("the domain is closed, but the gas in it would have to change by {:.3g} m3/s", surplus),
          worst_cell());
    }
  }
  const Real tight = options.solver.pressure_tolerance * throughput;
  const Real target = tightly ? tight : std::max(tight, options.solver.loose_pressure_tolerance * residual);
  const LinearReport linear =
      pressure_solver.solve(pressure_matrix, rhs, correction, target, options.solver.max_linear_iterations);
  report.pressure_iterations += linear.iterations;
  if (!linear.converged) {
    fail(
        fmt::format("the pressure did not converge in {} iterations (mass residual {:.3g} of the throughput, "
                    "allowed {:.3g})",
                    linear.iterations, linear.residual / throughput, target / throughput),
        worst_cell());
  }
  faces.correct(fields, correction);
  update_mass_flux();
  report.continuity_residual = throughput > 0 ? linear.residual / throughput : 0;
}

void GasSolver::Impl::solve_momentum(Real dt, bool tightly, StepReport& report) {
  const Index n = fields.cells;
  faces.compute_cell_force(fields, momentum, cell_force);
  for_entries("cfd::gas_solver::cell_force", n, [&](Index c) {
    const Real mass = fields.density_old(c) * fields.void_fraction_old(c) * geometry.volume(c) / dt;
    for (Index e = c; e < 3 * n; e += n) {
      cell_force(e) += mass * fields.velocity_old(e) + relaxation(e) * fields.velocity(e);
    }
  });
  const TransportReport linear =
      momentum.solve(fields, inertia, cell_force, options.solver.momentum_tolerance * (tightly ? 1 : 100));
  report.momentum_iterations += linear.iterations;
  report.momentum_residual = linear.residual;
  if (!linear.converged) {
    fail(fmt::format("the velocity did not converge in {} iterations (relative residual {:.3g})",
                     linear.iterations, linear.residual),
         worst_cell());
  }
}

Real GasSolver::Impl::face_velocity_change() const {
  Real change = 0;
  Real largest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t f = 0; f < before[a].extent(0); ++f) {
      change = std::max(change, std::abs(fields.superficial[a](f) - before[a](f)));
      largest = std::max(largest, std::abs(fields.superficial[a](f)));
    }
  }
  return largest > 0 ? change / largest : 0;
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
  Real largest = 0;
  for (Index c = 0; c < fields.cells; ++c) {
    const Real volume = geometry.volume(c);
    if (volume > 0) largest = std::max(largest, std::abs(rhs(c)) * dt / volume);
  }
  return largest;
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

Real GasSolver::Impl::check_and_find_courant(Real dt) const {
  const Stencil& s = geometry.stencil;
  Real courant = 0;
  for (Index k = 0; k < s.n.z; ++k) {
    for (Index j = 0; j < s.n.y; ++j) {
      for (Index i = 0; i < s.n.x; ++i) {
        const Index c = s.cell(i, j, k);
        const Vec3 u = state.velocity(c);
        const Real own = dt * (std::abs(u.x) / geometry.axis[0].width[static_cast<std::size_t>(i)] +
                               std::abs(u.y) / geometry.axis[1].width[static_cast<std::size_t>(j)] +
                               std::abs(u.z) / geometry.axis[2].width[static_cast<std::size_t>(k)]);
        if (!std::isfinite(own + fields.pressure(c))) fail("velocity or pressure is no longer finite", c);
        courant = std::max(courant, own);
      }
    }
  }
  return courant;
}

void GasSolver::Impl::copy_velocity_to_state() {
  const Index n = fields.cells;
  for_entries("cfd::gas_solver::to_state", n, [&](Index c) {
    state.velocity(c) = {fields.velocity(c), fields.velocity(c + n), fields.velocity(c + 2 * n)};
  });
  for (std::size_t a = 0; a < 3; ++a) {
    for_entries("cfd::gas_solver::volume_flux", static_cast<Index>(state.volume_flux[a].extent(0)),
                [&](Index f) { state.volume_flux[a](f) = geometry.area[a](f) * fields.superficial[a](f); });
  }
}

void GasSolver::Impl::finish_step(Real dt, const ParticleExchange& exchange, StepReport& report) {
  faces.compute_pressure_gradient(fields, state.pressure_gradient);
  copy_velocity_to_state();
  report.courant_number = check_and_find_courant(dt);
  report.divergence = find_divergence(dt);
  add_to_balance(dt, exchange);
  const ScalarReport scalar = scalars.update(fields, dt, exchange.scalars);
  report.scalar_iterations = scalar.iterations;
  report.scalar_cells_returned = scalar.returned;
  if (turbulence) {
    const ScalarReport eddies = turbulence->update(fields, dt);
    report.scalar_iterations += eddies.iterations;
    report.scalar_cells_returned += eddies.returned;
  }
  state.time += dt;
}

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

GasSolver::GasSolver(const CartesianGrid& grid, const GasOptions& options, std::vector<BoundaryPatch> patches,
                     const ImmersedGeometry& immersed)
    : impl_(std::make_unique<Impl>(grid, options, std::move(patches), immersed)) {
  initialise();
}
GasSolver::~GasSolver() = default;
GasSolver::GasSolver(GasSolver&&) noexcept = default;
GasSolver& GasSolver::operator=(GasSolver&&) noexcept = default;

void GasSolver::initialise(const Vec3& velocity) {
  HostArray<Real> void_fraction("cfd::gas_solver::initial_void_fraction",
                                impl_->fields.void_fraction.extent(0));
  Kokkos::deep_copy(void_fraction, 1.0);
  initialise(velocity, void_fraction);
}

void GasSolver::initialise(const Vec3& velocity, const HostArray<Real>& void_fraction) {
  HostArray<Vec3> field("cfd::gas_solver::initial_velocity", impl_->fields.void_fraction.extent(0));
  Kokkos::deep_copy(field, velocity);
  initialise(field, void_fraction);
}

void GasSolver::initialise(const HostArray<Vec3>& velocity, const HostArray<Real>& void_fraction) {
  const Index n = impl_->fields.cells;
  if (velocity.extent(0) != static_cast<std::size_t>(n) ||
      void_fraction.extent(0) != static_cast<std::size_t>(n)) {
    throw std::invalid_argument("the initial fields have another size than the gas grid");
  }
  for (Index c = 0; c < n; ++c) {
    for (int a = 0; a < 3; ++a) impl_->fields.velocity(c + a * n) = velocity(c)[a];
  }
  impl_->initialise(void_fraction);
}

StepReport GasSolver::update(Real dt, const ParticleExchange& exchange) {
  Impl& s = *impl_;
  const GasSolverOptions& options = s.options.solver;
  StepReport report;
  s.take_exchange(exchange, dt);
  s.momentum.prepare(s.fields, dt);
  s.faces.prepare(s.fields);
  // SIMPLEC: fluxes first, then velocities that satisfy the momentum balance with these very fluxes and this
  // pressure, so that a step ends with both balances closed.
  bool done = false;
  while (!done) {
    ++report.outer_iterations;
    const bool last = report.outer_iterations >= options.max_outer_iterations;
    const bool nearly_there =
        report.outer_iterations > 1 && report.velocity_change < 10 * options.outer_tolerance;
    for (std::size_t a = 0; a < 3; ++a) Kokkos::deep_copy(s.before[a], s.fields.superficial[a]);
    // Later iterations go on with the coefficients of the momentum equation just solved.
    if (report.outer_iterations == 1) s.assemble_momentum(dt);
    const bool tightly = last || nearly_there;
    s.solve_pressure(dt, tightly, report);
    s.assemble_momentum(dt);
    s.solve_momentum(dt, tightly, report);
    report.velocity_change = s.face_velocity_change();
    done = last || (nearly_there && report.velocity_change < options.outer_tolerance);
  }
  report.converged = report.velocity_change < options.outer_tolerance;
  if (options.require_convergence && !report.converged) {
    s.fail(fmt::format("after {} outer iterations face velocities still change by {:.3g} of the largest; "
                       "solver.outer_tolerance {:.3g} is required",
                       report.outer_iterations, report.velocity_change, options.outer_tolerance),
           s.most_changed_cell());
  }
  s.finish_step(dt, exchange, report);
  return report;
}

Real GasSolver::courant_number(Real dt) const {
  const Impl& s = *impl_;
  const Stencil& stencil = s.geometry.stencil;
  Real largest = 0;
  for (Index r = 0; r < stencil.rows(); ++r) {
    const Row row = stencil.row(r);
    const Index first[3] = {row.x_face, row.y_face, row.z_face};
    for (Index i = 0; i < stencil.n.x; ++i) {
      const Index place[3] = {i, row.j, row.k};
      Real own = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const Index f = first[axis] + i;
        const Real fastest = std::max(std::abs(s.fields.superficial[a](f)),
                                      std::abs(s.fields.superficial[a](f + stencil.face_step(axis))));
        own += fastest / s.geometry.axis[a].width[static_cast<std::size_t>(place[axis])];
      }
      largest = std::max(largest, own * dt / s.fields.void_fraction(row.cell + i));
    }
  }
  return largest;
}

const CartesianGrid& GasSolver::grid() const { return impl_->geometry.grid; }
const FlowGeometry& GasSolver::geometry() const { return impl_->geometry; }
const GasOptions& GasSolver::options() const { return impl_->options; }

Vec3 GasSolver::surface_force(std::size_t surface) const { return surface_forces().at(surface); }

std::vector<Vec3> GasSolver::surface_forces() const {
  const Impl& s = *impl_;
  const auto& pieces = s.geometry.pieces;
  std::vector<Vec3> total(s.geometry.surfaces.size());
  for (std::size_t first = 0; first < pieces.size();) {
    // The pressure on the surfaces of a cell is shared by their areas.
    std::size_t end = first;
    Real all = 0;
    for (; end < pieces.size() && pieces[end].cell == pieces[first].cell; ++end) all += pieces[end].area;
    const Vec3 pressure = s.faces.surface_pressure_force(s.fields, pieces[first].cell);
    for (; first < end; ++first) {
      Vec3& own = total[static_cast<std::size_t>(pieces[first].surface)];
      own -= s.momentum.surface_shear(s.fields, first);
      if (all > 0) own -= (pieces[first].area / all) * pressure;
    }
  }
  return total;
}
const GasState& GasSolver::state() const { return impl_->state; }
const GasBalance& GasSolver::balance() const { return impl_->balance; }
const ScalarBalance* GasSolver::balance(Scalar scalar) const {
  const auto& transport = impl_->scalars[scalar];
  return transport ? &transport->balance() : nullptr;
}

Real GasSolver::patch_pressure(const std::string& name) const {
  const Impl& s = *impl_;
  const auto& names = s.boundaries.patch_names;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::invalid_argument("the gas has no boundary '" + name + "'");
  const int patch = static_cast<int>(found - names.begin());
  Real force = 0;
  Real area = 0;
  for (std::size_t b = 0; b < s.boundaries.pieces.size(); ++b) {
    const BoundaryPiece& piece = s.boundaries.pieces[b];
    if (piece.patch != patch) continue;
    Real pressure = piece.pressure;
    if (piece.kind != PieceKind::outlet) {
      pressure = piece.is_immersed() ? s.fields.pressure(piece.cell) : s.faces.boundary_pressure(s.fields, b);
    }
    force += piece.area * pressure;
    area += piece.area;
  }
  return force / area;
}

Real GasSolver::pressure_drop(const std::string& from, const std::string& to) const {
  return patch_pressure(from) - patch_pressure(to);
}

Real GasSolver::plane_pressure(int axis, Real coordinate) const {
  const Impl& s = *impl_;
  const Stencil& stencil = s.geometry.stencil;
  const CartesianGrid& grid = s.geometry.grid;
  const auto mean = [&](Index layer) {
    Real force = 0;
    Real area = 0;
    for (Index c = 0; c < stencil.cells(); ++c) {
      const Index3 at = grid.coordinates(c);
      if (at[axis] != layer) continue;
      const Real own = s.geometry.volume(c) / grid.width(axis, layer);
      force += own * s.fields.pressure(c);
      area += own;
    }
    return force / area;
  };
  const Index i = grid.locate(axis, coordinate);
  const Index other = coordinate >= grid.center(axis, i) ? i + 1 : i - 1;
  if (other < 0 || other >= stencil.n[axis]) return mean(i);
  const Real w = (coordinate - grid.center(axis, i)) / (grid.center(axis, other) - grid.center(axis, i));
  return (1 - w) * mean(i) + w * mean(other);
}

void GasSolver::drop_solver_hierarchies() { impl_->pressure_solver.drop(); }

}  // namespace pellicle::cfd
