#include "cfd/gas_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "cfd/field_memory.hpp"
#include "cfd/gas_solver_impl.hpp"
#include "core/error.hpp"

namespace pellicle::cfd {

namespace {

// Relative, of the momentum solve of a step's first iteration. What it leaves is far less than what the new pressure
// changes.
constexpr Real rough_momentum_tolerance = 1e-4;

HostArray<Real> make_array(const char* label, Index size) {
  return make_field<Real>(label, static_cast<std::size_t>(size));
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
  for (const Real width : geometry.axis[0].width) inverse_width.push_back(1 / width);
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
  memory.close();
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

void GasSolver::Impl::check_exchange(const ParticleExchange& exchange) {
  const Real *eps = exchange.void_fraction.data(), *beta = exchange.exchange_coefficient.data();
  const auto is_bad = [=](Index c) {
    return !(eps[c] > 0 && eps[c] <= 1 + 1e-9 && beta[c] >= 0 && std::isfinite(beta[c]));
  };
  if (sum("cfd::gas_solver::bad_exchange", fields.cells, [=](Index c) { return is_bad(c) ? 1.0 : 0.0; }) == 0)
    return;
  Index c = 0;
  while (!is_bad(c)) ++c;
  if (!(eps[c] > 0 && eps[c] <= 1 + 1e-9)) fail(fmt::format("the void fraction is {}", eps[c]), c);
  fail(fmt::format("the momentum exchange coefficient is {}", beta[c]), c);
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
  check_exchange(exchange);
  for_entries("cfd::gas_solver::take_exchange", n, [&](Index c) {
    if (!(geometry.volume(c) > 0)) return;
    fields.void_fraction(c) = exchange.void_fraction(c);
    fields.exchange_coefficient(c) = exchange.exchange_coefficient(c);
    const Vec3 force = exchange.explicit_force(c);
    for (int a = 0; a < 3; ++a) fields.force(c + a * n) = force[a];
  });
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
  const Real *volume = geometry.volume.data(), *rho_old = fields.density_old.data();
  const Real *eps_old = fields.void_fraction_old.data(), *beta = fields.exchange_coefficient.data();
  const Real per_dt = 1 / dt;
  for (int a = 0; a < 3; ++a) {
    const Real* own = momentum.own().data() + a * n;
    Real *held = relaxation.data() + a * n, *sum_of = inertia.data() + a * n;
    for_entries("cfd::gas_solver::inertia", n, [=](Index c) {
      // A cell without gas takes part with a velocity of 0: any diagonal will do.
      const Real own_inertia = volume[c] > 0 ? volume[c] * (rho_old[c] * eps_old[c] * per_dt + beta[c]) : 1;
      held[c] = keep * (own[c] + own_inertia);
      sum_of[c] = own_inertia + held[c];
    });
  }
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

// Of the gas in a cell, over the density of reference, per volume of cell and second.
Real GasSolver::Impl::growth_of_gas(Real eps, Real eps_old, Real rho, Real rho_old, Real dt) const {
  const Real per_density = 1 / options.density;
  return (eps * (rho * per_density) - eps_old * (rho_old * per_density)) / dt;
}

// rhs = -(mass that leaves the cell + growth of its gas - vapour that becomes gas) per second, over the density of
// reference: a volume where the density is constant.
Real GasSolver::Impl::compute_continuity_residual(Real dt) {
  const Stencil& s = geometry.stencil;
  const Real per_density = 1 / options.density;
  const Real *eps = fields.void_fraction.data(), *eps_old = fields.void_fraction_old.data();
  const Real *rho = fields.density.data(), *rho_old = fields.density_old.data();
  const Real *volume = geometry.volume.data(), *given = fields.mass_source.data();
  Real* result = rhs.data();
  for_rows("cfd::gas_solver::continuity", s, [&](const Index r) {
    const Row row = s.row(r);
    const Index nx = s.n.x;
    const Index next = row.cell + nx;
    for (const Real* field : {eps, eps_old, rho, rho_old, volume, given}) prefetch_row(field + next, nx);
#pragma GCC ivdep
    for (Index c = row.cell; c < next; ++c) {
      result[c] =
          volume[c] * (given[c] * per_density - growth_of_gas(eps[c], eps_old[c], rho[c], rho_old[c], dt));
    }
    const Index first[3] = {row.x_face, row.y_face, row.z_face};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Index step = s.face_step(axis);
      // The density of boundary faces is 0: what flows there follows below.
      const Real* area = geometry.area[a].data() + first[axis];
      const Real* velocity = fields.superficial[a].data() + first[axis];
      const Real* density = fields.face_density[a].data() + first[axis];
      for (const Real* field : {area, velocity, density}) prefetch_row(field + nx + step, nx);
      Real* out = result + row.cell;
#pragma GCC ivdep
      for (Index i = 0; i < nx; ++i) {
        out[i] -= area[i + step] * velocity[i + step] * (density[i + step] * per_density) -
                  area[i] * velocity[i] * (density[i] * per_density);
      }
    }
  });
  for (std::size_t b = 0; b < boundaries.pieces.size(); ++b) {
    rhs(boundaries.pieces[b].cell) -= fields.piece_flow[b] * (fields.piece_density[b] / options.density);
  }
  return sum("cfd::gas_solver::continuity_sum", s.cells(), [&](Index c) { return std::abs(rhs(c)); });
}

// Volume flow through a typical section of the domain, plus what moving particles displace [m3/s].
Real GasSolver::Impl::gas_throughput(Real dt) {
  const Real *eps = fields.void_fraction.data(), *eps_old = fields.void_fraction_old.data();
  const Real *rho = fields.density.data(), *rho_old = fields.density_old.data(),
             *volume = geometry.volume.data();
  Real total = sum("cfd::gas_solver::displaced", fields.cells, [&](Index c) {
    return volume[c] * std::abs(growth_of_gas(eps[c], eps_old[c], rho[c], rho_old[c], dt));
  });
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

void GasSolver::Impl::solve_momentum(Real dt, Real tolerance, StepReport& report) {
  const Index n = fields.cells;
  faces.compute_cell_force(fields, momentum, cell_force);
  const Real *volume = geometry.volume.data(), *rho_old = fields.density_old.data();
  const Real* eps_old = fields.void_fraction_old.data();
  const Real per_dt = 1 / dt;
  for (int a = 0; a < 3; ++a) {
    Real* force = cell_force.data() + a * n;
    const Real *u = fields.velocity.data() + a * n, *u_old = fields.velocity_old.data() + a * n;
    const Real* relaxed = relaxation.data() + a * n;
    for_entries("cfd::gas_solver::cell_force", n, [=](Index c) {
      force[c] += rho_old[c] * eps_old[c] * volume[c] * per_dt * u_old[c] + relaxed[c] * u[c];
    });
  }
  const TransportReport linear = momentum.solve(fields, inertia, cell_force, tolerance);
  report.momentum_iterations += linear.iterations;
  report.momentum_residual = linear.residual;
  if (!linear.converged) {
    fail(fmt::format("the velocity did not converge in {} iterations (relative residual {:.3g})",
                     linear.iterations, linear.residual),
         worst_cell());
  }
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
  // pressure, so that a step ends with both balances closed. The first of several iterations only has to say what the
  // velocities will be like: they follow from its coefficients, roughly.
  bool done = false;
  while (!done) {
    ++report.outer_iterations;
    const bool first = report.outer_iterations == 1;
    const bool last = report.outer_iterations >= options.max_outer_iterations;
    const bool nearly_there = !first && !last && report.velocity_change < 10 * options.outer_tolerance;
    for (std::size_t a = 0; a < 3; ++a) Kokkos::deep_copy(s.before[a], s.fields.superficial[a]);
    // Later iterations go on with the coefficients of the momentum equation at hand.
    if (first) s.assemble_momentum(dt);
    const bool tightly = last || nearly_there;
    s.solve_pressure(dt, tightly, report);
    if (last || !first) s.assemble_momentum(dt);
    const Real rough = std::max(rough_momentum_tolerance, options.momentum_tolerance);
    const Real loose = first ? rough : 100 * options.momentum_tolerance;
    s.solve_momentum(dt, tightly ? options.momentum_tolerance : loose, report);
    // Before the last of a fixed number of iterations nothing follows from it.
    if (!first || last || options.max_outer_iterations > 2) report.velocity_change = s.face_velocity_change();
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

}  // namespace pellicle::cfd
