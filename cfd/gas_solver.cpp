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

std::optional<ScalarScratch> make_scalar_scratch(const Stencil& stencil, const GasOptions& options) {
  const bool needed = options.turbulence ||
                      std::ranges::any_of(options.scalars, [](const auto& one) { return one.has_value(); });
  return needed ? std::optional<ScalarScratch>(stencil) : std::nullopt;
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
      scalar_scratch(make_scalar_scratch(geometry.stencil, options)),
      scalars(geometry, boundaries, patches, options, scalar_scratch) {
  check_options(options);
  if (options.turbulence) turbulence.emplace(geometry, boundaries, patches, options, *scalar_scratch);
  const Index n = fields.cells;
  pressure_matrix.singular = !boundaries.has_outlet;
  influx = make_array("cfd::gas_solver::influx", 3 * n);
  inertia.all = make_array("cfd::gas_solver::inertia", n);
  inertia.old = make_array("cfd::gas_solver::old_inertia", n);
  inertia.keep = (1 - options.solver.velocity_relaxation) / options.solver.velocity_relaxation;
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
  still_steps = 0;
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

// Nothing that the coefficients of the momentum equation depend on, besides the flow, changes in the coming step.
bool GasSolver::Impl::stays_as_it_is(const ParticleExchange& exchange) {
  if (turbulence || scalars.has_varying_density() || options.viscosity_law != ViscosityLaw::constant ||
      exchange.mass_source.extent(0) > 0) {
    return false;
  }
  const Real *now = exchange.void_fraction.data(), *held = fields.void_fraction.data();
  const Real* volume = geometry.volume.data();
  return sum.largest("cfd::gas_solver::void_fraction_change", fields.cells,
                     [=](Index c) { return volume[c] > 0 ? std::abs(now[c] - held[c]) : 0; }) == 0;
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
  still_steps = stays_as_it_is(exchange) ? still_steps + 1 : 0;
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

// What stays the same for a whole step: see Inertia, and the volume that the growth of the gas displaces.
void GasSolver::Impl::prepare_inertia(Real dt) {
  const Real *volume = geometry.volume.data(), *rho = fields.density.data();
  const Real *rho_old = fields.density_old.data(), *eps = fields.void_fraction.data();
  const Real *eps_old = fields.void_fraction_old.data(), *beta = fields.exchange_coefficient.data();
  Real *all = inertia.all.data(), *old = inertia.old.data();
  const Real per_dt = 1 / dt;
  const auto sums =
      sum.several<1>("cfd::gas_solver::inertia", fields.cells, [=](Index begin, Index end, auto& total) {
        const Index count = end - begin;
        const Real *v = volume + begin, *r = rho + begin, *r_old = rho_old + begin, *e = eps + begin;
        const Real *e_old = eps_old + begin, *drag = beta + begin;
        Real *on_diagonal = all + begin, *held = old + begin;
        const Real per_step = per_dt;
        Real grown = 0;
#pragma omp simd reduction(+ : grown)
        for (Index i = 0; i < count; ++i) {
          const Real mass = v[i] * r_old[i] * e_old[i] * per_step;
          held[i] = mass;
          // A cell without gas takes part with a velocity of 0: any diagonal will do.
          on_diagonal[i] = v[i] > 0 ? mass + v[i] * drag[i] : 1;
          grown += v[i] * std::abs(e[i] * r[i] - e_old[i] * r_old[i]);
        }
        total[0] += grown;
      });
  displaced = sums[0] * per_dt / options.density;
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
// reference: a volume where the density is constant. The mass fluxes need not be those of the face velocities yet.
Real GasSolver::Impl::compute_continuity_residual(Real dt) {
  const Stencil& s = geometry.stencil;
  const Real per_density = 1 / options.density;
  const Real *eps = fields.void_fraction.data(), *eps_old = fields.void_fraction_old.data();
  const Real *rho = fields.density.data(), *rho_old = fields.density_old.data();
  const Real *volume = geometry.volume.data(), *given = fields.mass_source.data();
  Real* result = rhs.data();
  row_through.resize(static_cast<std::size_t>(s.rows()));
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
    const Index last[3] = {nx - 1, row.j == s.n.y - 1 ? 0 : nx, row.k == s.n.z - 1 ? 0 : nx};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Index step = s.face_step(axis);
      // The density of boundary faces is 0: what flows there follows below.
      const Real* area = geometry.area[a].data() + first[axis];
      const Real* velocity = fields.superficial[a].data() + first[axis];
      const Real* density = fields.face_density[a].data() + first[axis];
      for (const Real* field : {area, velocity, density}) prefetch_row(field + nx + step, nx);
      Real* out = result + row.cell;
      const Real scale = per_density;
      Real through = 0;
#pragma omp simd reduction(+ : through)
      for (Index i = 0; i < nx; ++i) {
        const Real flow = area[i] * velocity[i];
        out[i] -=
            area[i + step] * velocity[i + step] * (density[i + step] * scale) - flow * (density[i] * scale);
        through += std::abs(flow);
      }
      // Faces that no cell has on its minus side.
      for (Index i = last[axis]; i < nx; ++i) through += std::abs(area[i + step] * velocity[i + step]);
      row_through[static_cast<std::size_t>(r)][a] = through;
    }
  });
  for (const std::size_t b : boundaries.passable) {
    rhs(boundaries.pieces[b].cell) -= fields.piece_flow[b] * (fields.piece_density[b] / options.density);
  }
  return sum("cfd::gas_solver::continuity_sum", s.cells(), [&](Index c) { return std::abs(rhs(c)); });
}

// Volume flow through a typical section of the domain, plus what moving particles displace [m3/s]; after
// compute_continuity_residual.
Real GasSolver::Impl::gas_throughput() const {
  std::array<Real, 3> through{};
  for (const auto& row : row_through) {
    for (std::size_t a = 0; a < 3; ++a) through[a] += row[a];
  }
  Real total = displaced;
  for (int axis = 0; axis < 3; ++axis) {
    total += through[static_cast<std::size_t>(axis)] / (geometry.stencil.n[axis] + 1);
  }
  return total;
}

void GasSolver::Impl::solve_pressure(Real dt, bool tightly, StepReport& report) {
  momentum.compute_influx(fields, influx);
  faces.predict(fields, momentum, influx, inertia, dt, pressure_matrix);
  const Real residual = compute_continuity_residual(dt);
  const Real throughput = gas_throughput();
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
  report.continuity_residual = throughput > 0 ? linear.residual / throughput : 0;
}

void GasSolver::Impl::solve_momentum(Real tolerance, StepReport& report) {
  faces.compute_cell_force(fields, momentum, cell_force);
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
  s.prepare_inertia(dt);
  // A step that begins as the last one ended begins with its coefficients too.
  const bool coefficients_stand = s.still_steps >= 2;
  if (!coefficients_stand) s.momentum.prepare(s.fields, dt);
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
    // Before the last of a fixed number of iterations nothing follows from the change.
    const bool watched = !first || last || options.max_outer_iterations > 2;
    for (std::size_t a = 0; watched && a < 3; ++a) Kokkos::deep_copy(s.before[a], s.fields.superficial[a]);
    // Later iterations go on with the coefficients of the momentum equation at hand.
    if (first && !coefficients_stand) s.momentum.assemble(s.fields);
    const bool tightly = last || nearly_there;
    s.solve_pressure(dt, tightly, report);
    if (last || !first) s.momentum.assemble(s.fields);
    const Real rough = std::max(rough_momentum_tolerance, options.momentum_tolerance);
    const Real loose = first ? rough : 100 * options.momentum_tolerance;
    s.solve_momentum(tightly ? options.momentum_tolerance : loose, report);
    if (watched) report.velocity_change = s.face_velocity_change();
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
