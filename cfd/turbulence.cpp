#include "cfd/turbulence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cfd/velocity_gradient.hpp"
#include "core/checkpoint.hpp"
#include "core/error.hpp"

namespace pellicle::cfd {

namespace {

using Constants = KEpsilonConstants;

// k [m2/s2] and epsilon [m2/s3] never fall below: far below any turbulence that does something, far above round-off.
constexpr Real floor_of_k = 1e-12;
constexpr Real floor_of_epsilon = 1e-14;

HostArray<Real> make_array(const char* label, Index size) {
  return HostArray<Real>(std::string(label), static_cast<std::size_t>(size));
}

struct Incoming {
  std::vector<Real> k, epsilon;  // of each patch
  Real fastest = 0;              // [m/s]
};

// What each inlet brings, from its velocity and its area.
Incoming find_incoming(const Boundaries& boundaries, const std::vector<BoundaryPatch>& patches) {
  std::vector<Real> area(patches.size(), 0), flow(patches.size(), 0);
  for (const BoundaryPiece& piece : boundaries.pieces) {
    if (piece.kind != PieceKind::inlet) continue;
    area[static_cast<std::size_t>(piece.patch)] += piece.area;
    flow[static_cast<std::size_t>(piece.patch)] += piece.area * std::abs(piece.inward_speed());
  }
  Incoming incoming;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const InletTurbulence& given = patches[p].turbulence;
    const Real velocity = area[p] > 0 ? flow[p] / area[p] : 0;
    const Real length = given.length_scale.value_or(0.07 * std::sqrt(4 * area[p] / std::numbers::pi));
    const Real k = std::max(k_of_intensity(given.intensity, velocity), floor_of_k);
    incoming.k.push_back(k);
    incoming.epsilon.push_back(length > 0 ? std::max(dissipation_of_length(k, length), floor_of_epsilon)
                                          : floor_of_epsilon);
    incoming.fastest = std::max(incoming.fastest, velocity);
  }
  return incoming;
}

std::vector<ScalarBoundary> make_conditions(const std::vector<BoundaryPatch>& patches,
                                            const std::vector<Real>& values) {
  std::vector<ScalarBoundary> conditions(patches.size());
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (std::holds_alternative<Inlet>(patches[p].kind)) conditions[p] = GivenValue{values[p]};
  }
  return conditions;
}

ScalarOptions make_options(Real turbulent_number) {
  ScalarOptions options;
  options.viscous = true;
  options.turbulent_number = turbulent_number;
  options.tolerance = 1e-9;
  options.correction_tolerance = 1e-3;
  options.max_corrections = 2;
  return options;
}

// Both must not overshoot: a scheme that is not bounded gives way to the limited one.
Convection bounded(Convection scheme) {
  return scheme == Convection::upwind ? scheme : Convection::ultimate_quickest;
}

}  // namespace

KEpsilon::KEpsilon(const FlowGeometry& geometry, const Boundaries& boundaries,
                   const std::vector<BoundaryPatch>& patches, const GasOptions& options,
                   const ScalarScratch& scratch)
    : geometry_(geometry),
      boundaries_(boundaries),
      options_(options),
      fastest_inlet_(find_incoming(boundaries, patches).fastest),
      k_("turbulent_kinetic_energy", geometry, boundaries,
         make_conditions(patches, find_incoming(boundaries, patches).k), make_options(Constants::sigma_k),
         bounded(options.convection), scratch),
      epsilon_("turbulent_dissipation", geometry, boundaries,
               make_conditions(patches, find_incoming(boundaries, patches).epsilon),
               make_options(Constants::sigma_epsilon), bounded(options.convection), scratch) {
  const KEpsilonOptions& o = *options.turbulence;
  const auto refuse = [](const char* what) { throw InputError(fmt::format("gas: turbulence: {}", what)); };
  if (!(o.initial_k.value_or(1) > 0)) refuse("the initial k is not positive; allowed: > 0 m2/s2");
  if (!(o.initial_epsilon.value_or(1) > 0)) refuse("the initial epsilon is not positive; allowed: > 0 m2/s3");
  if (!(o.prandtl_number > 0 && o.schmidt_number > 0)) {
    refuse("the Prandtl or Schmidt number is not positive; allowed: > 0");
  }
  if (!(o.largest_viscosity_ratio > 0)) refuse("the largest viscosity ratio is not positive; allowed: > 0");
  const Index n = geometry.stencil.cells();
  production_ = make_array("cfd::turbulence::production", n);
  wall_dissipation_ = make_array("cfd::turbulence::wall_dissipation", n);
  floored_ = make_array("cfd::turbulence::floored", n);
  k_source_ = {make_array("cfd::turbulence::k_rate", n), make_array("cfd::turbulence::k_coefficient", n)};
  epsilon_source_ = {make_array("cfd::turbulence::epsilon_rate", n),
                     make_array("cfd::turbulence::epsilon_coefficient", n)};
  collect_walls();
}

void KEpsilon::collect_walls() {
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    if (piece.kind != PieceKind::no_slip || piece.is_immersed()) continue;
    WallPiece wall{piece.cell, b, false, piece.area, piece.half_width, piece.half_width, {}, piece.velocity};
    wall.normal[piece.axis] = -piece.outward;
    walls_.push_back(wall);
  }
  for (std::size_t b = 0; b < geometry_.pieces.size(); ++b) {
    const SurfacePiece& piece = geometry_.pieces[b];
    const ImmersedSurface& surface = geometry_.surfaces[static_cast<std::size_t>(piece.surface)];
    if (!surface.sticks || boundaries_.passes(b)) continue;
    const Index3 at = geometry_.grid.coordinates(piece.cell);
    const Real half = 0.5 * std::min({geometry_.grid.width(0, at.x), geometry_.grid.width(1, at.y),
                                      geometry_.grid.width(2, at.z)});
    walls_.push_back({piece.cell, b, true, piece.area, piece.distance, std::max(piece.distance, half),
                      piece.normal, surface.velocity_at(piece.point, piece.normal)});
  }
  std::stable_sort(walls_.begin(), walls_.end(),
                   [](const WallPiece& a, const WallPiece& b) { return a.cell < b.cell; });
}

void KEpsilon::initialise(GasFields& fields) {
  const KEpsilonOptions& o = *options_.turbulence;
  Real fastest = fastest_inlet_;
  for (Index c = 0; c < fields.cells; ++c) {
    const Vec3 u{fields.velocity(c), fields.velocity(c + fields.cells),
                 fields.velocity(c + 2 * fields.cells)};
    fastest = std::max(fastest, norm(u));
  }
  const Real k = o.initial_k.value_or(std::max(k_of_intensity(0.05, fastest), floor_of_k));
  const auto fill = [&](ScalarTransport& scalar, auto&& value) {
    for_entries("cfd::turbulence::initial", fields.cells, [&](Index c) { floored_(c) = value(c); });
    scalar.set_values(floored_);
  };
  fill(k_, [&](Index) { return k; });
  fill(epsilon_, [&](Index c) {
    // Ten times the viscosity of the gas.
    const Real own = Constants::c_mu * fields.density(c) * k * k / (10 * fields.molecular_viscosity(c));
    return o.initial_epsilon.value_or(std::max(own, floor_of_epsilon));
  });
  k_.initialise(fields);
  epsilon_.initialise(fields);
  compute_eddy_viscosity(fields);
  prepare(fields);
}

void KEpsilon::prepare(GasFields& fields) {
  for_entries("cfd::turbulence::viscosity", fields.cells, [&](Index c) {
    fields.viscosity(c) = fields.molecular_viscosity(c) + fields.eddy_viscosity(c);
  });
  compute_layers(fields);
}

void KEpsilon::compute_eddy_viscosity(const GasFields& fields) const {
  const Real ratio = options_.turbulence->largest_viscosity_ratio;
  const Real* k = k_.value().data();
  const Real* epsilon = epsilon_.value().data();
  for_entries("cfd::turbulence::eddy_viscosity", fields.cells, [&](Index c) {
    fields.eddy_viscosity(c) = geometry_.volume(c) > 0 ? eddy_viscosity(fields.density(c), k[c], epsilon[c],
                                                                        ratio * fields.molecular_viscosity(c))
                                                       : 0;
  });
}

// The shear of a wall is rho u slip / U*: a viscosity that gives it over the distance that the momentum counts with.
void KEpsilon::compute_layers(GasFields& fields) const {
  for (const WallPiece& wall : walls_) {
    const Index c = wall.cell;
    const Real scale = wall_velocity_scale(k_.value()(c));
    const Real mu = fields.molecular_viscosity(c);
    const Real y_star = fields.density(c) * scale * wall.log_distance / mu;
    const bool viscous = y_star < viscous_sublayer;
    WallLayer& layer = (wall.is_immersed ? fields.surface_layer : fields.piece_layer)[wall.piece];
    layer.scale = scale;
    layer.distance = viscous ? wall.distance : wall.log_distance;
    layer.viscosity =
        viscous ? mu : mu * (wall.distance / wall.log_distance) * (y_star / wall_velocity(y_star));
  }
}

const WallLayer& KEpsilon::layer_of(const GasFields& fields, const WallPiece& wall) {
  return (wall.is_immersed ? fields.surface_layer : fields.piece_layer)[wall.piece];
}

Real KEpsilon::wall_stress(const GasFields& fields, const WallPiece& wall) const {
  Vec3 slip;
  for (int a = 0; a < 3; ++a) slip[a] = fields.velocity(wall.cell + a * fields.cells) - wall.velocity[a];
  slip -= dot(slip, wall.normal) * wall.normal;
  return layer_of(fields, wall).viscosity * norm(slip) / wall.distance;
}

void KEpsilon::compute_production(const GasFields& fields) {
  const Index n = fields.cells;
  const Real* g = fields.velocity_gradient.data();
  for_entries("cfd::turbulence::production", n, [&](Index c) {
    const auto d = [&](int a, int b) { return g[c + (3 * a + b) * n]; };
    const Real dilatation = d(0, 0) + d(1, 1) + d(2, 2);
    const Real xy = d(0, 1) + d(1, 0);
    const Real yz = d(1, 2) + d(2, 1);
    const Real zx = d(2, 0) + d(0, 2);
    const Real along = d(0, 0) * d(0, 0) + d(1, 1) * d(1, 1) + d(2, 2) * d(2, 2);
    const Real strain = 2 * along + xy * xy + yz * yz + zx * zx - (2.0 / 3) * dilatation * dilatation;
    production_(c) = fields.eddy_viscosity(c) * std::max(strain, Real{0});
  });
  apply_wall_functions(fields);
}

// Beside walls production and dissipation are means over the wall's pieces by area.
void KEpsilon::apply_wall_functions(const GasFields& fields) {
  Kokkos::deep_copy(wall_dissipation_, -1.0);
  for (std::size_t first = 0; first < walls_.size();) {
    const Index c = walls_[first].cell;
    const Real rho = fields.density(c);
    const Real nu = fields.molecular_viscosity(c) / rho;
    const Real k = k_.value()(c);
    Real area = 0;
    Real production = 0;
    Real dissipation = 0;
    std::size_t end = first;
    for (; end < walls_.size() && walls_[end].cell == c; ++end) {
      const WallPiece& wall = walls_[end];
      const WallLayer& layer = layer_of(fields, wall);
      area += wall.area;
      production +=
          wall.area * wall_production(wall_stress(fields, wall), rho, layer.scale, layer.distance, nu);
      dissipation += wall.area * wall_dissipation(k, layer.scale, layer.distance, nu);
    }
    if (area > 0) {
      production_(c) = production / area;
      wall_dissipation_(c) = std::max(dissipation / area, floor_of_epsilon);
    }
    first = end;
  }
}

void KEpsilon::set_sources(const GasFields& fields, Real dt) {
  // Weight of a given value over what else acts on the cell: beyond the round-off of the rest.
  constexpr Real overwhelming = 1e12;
  const Real* k = k_.value().data();
  const Real* epsilon = epsilon_.value().data();
  for_entries("cfd::turbulence::epsilon_source", fields.cells, [&](Index c) {
    const Real eps = fields.void_fraction(c);
    const Real rho = fields.density(c);
    const Real rate = epsilon[c] / k[c];
    epsilon_source_.rate(c) = eps * Constants::c_1 * production_(c) * rate;
    epsilon_source_.coefficient(c) = eps * Constants::c_2 * rho * rate;
    if (wall_dissipation_(c) < 0) return;
    epsilon_source_.coefficient(c) = overwhelming * eps * rho / dt;
    epsilon_source_.rate(c) = epsilon_source_.coefficient(c) * wall_dissipation_(c);
  });
}

// Nothing but round-off and the tolerance of the linear solves can bring them there.
void KEpsilon::keep_above_floor() {
  const auto keep = [&](ScalarTransport& scalar, Real least) {
    bool below = false;
    for (std::size_t c = 0; c < scalar.value().extent(0); ++c) below = below || scalar.value()(c) < least;
    if (!below) return;
    for (std::size_t c = 0; c < scalar.value().extent(0); ++c) {
      floored_(c) = std::max(scalar.value()(c), least);
    }
    scalar.set_values(floored_);
  };
  keep(k_, floor_of_k);
  keep(epsilon_, floor_of_epsilon);
}

ScalarReport KEpsilon::update(GasFields& fields, Real dt) {
  compute_velocity_gradient(geometry_, boundaries_, fields);
  compute_production(fields);
  set_sources(fields, dt);
  ScalarReport report = epsilon_.update(fields, dt, epsilon_source_);
  const Real* k = k_.value().data();
  const Real* epsilon = epsilon_.value().data();
  for_entries("cfd::turbulence::k_source", fields.cells, [&](Index c) {
    const Real eps = fields.void_fraction(c);
    k_source_.rate(c) = eps * production_(c);
    k_source_.coefficient(c) = eps * fields.density(c) * std::max(epsilon[c], Real{0}) / k[c];
  });
  const ScalarReport second = k_.update(fields, dt, k_source_);
  keep_above_floor();
  compute_eddy_viscosity(fields);
  report.solves += second.solves;
  report.iterations += second.iterations;
  report.returned += second.returned;
  return report;
}

void KEpsilon::save(core::CheckpointWriter& writer) const {
  k_.save(writer);
  epsilon_.save(writer);
}

void KEpsilon::load(core::CheckpointReader& reader, GasFields& fields) {
  k_.load(reader, fields);
  epsilon_.load(reader, fields);
  compute_eddy_viscosity(fields);
  prepare(fields);
}

}  // namespace pellicle::cfd
