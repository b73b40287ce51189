#include "cfd/scalar_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "cfd/convection_schemes.hpp"
#include "cfd/field_memory.hpp"
#include "cfd/turbulence_laws.hpp"
#include "core/error.hpp"

namespace pellicle::cfd {

namespace {

constexpr Real solve_over_change = 1e-2;  // tolerances of linear solves and of the deferred correction

HostArray<Real> make_array(const std::string& label, Index size) {
  return make_field<Real>(label, static_cast<std::size_t>(size));
}

}  // namespace

ScalarTransport::ScalarTransport(std::string name, const FlowGeometry& geometry, const Boundaries& boundaries,
                                 const std::vector<ScalarBoundary>& patches, const ScalarOptions& options,
                                 Convection scheme)
    : ScalarTransport(std::move(name), geometry, boundaries, patches, options, scheme,
                      ScalarScratch(geometry.stencil)) {}

ScalarTransport::ScalarTransport(std::string name, const FlowGeometry& geometry, const Boundaries& boundaries,
                                 const std::vector<ScalarBoundary>& patches, const ScalarOptions& options,
                                 Convection scheme, const ScalarScratch& scratch)
    : name_(std::move(name)),
      geometry_(geometry),
      boundaries_(boundaries),
      options_(options),
      scheme_(scheme),
      carrier_(scratch.carrier),
      conductance_(scratch.conductance),
      correction_(scratch.correction),
      near_(scratch.near),
      own_(scratch.own),
      base_(scratch.base),
      rhs_(scratch.rhs),
      storage_(scratch.storage),
      content_old_(scratch.content_old),
      gain_(scratch.gain),
      linear_solver_(scratch.linear_solver) {
  const Index n = geometry.stencil.cells();
  value_ = make_array("cfd::scalar_transport::value", n);
  excess_ = make_array("cfd::scalar_transport::excess", n);
  old_ = make_array("cfd::scalar_transport::old", n);
  content_ = make_array("cfd::scalar_transport::content", n);
  carrier_out_.assign(boundaries.pieces.size(), 0);
  flagged_.assign(static_cast<std::size_t>(n), 0);
  for (std::size_t d = 0; d < 6; ++d) {
    boundary_values_[d].resize(boundaries.values[d].size());
  }
  for (const BoundaryPiece& piece : boundaries.pieces) {
    piece_conditions_.push_back(piece.patch < 0 ? ScalarBoundary{}
                                                : patches.at(static_cast<std::size_t>(piece.patch)));
  }
  balance_.into.assign(patches.size(), 0);
  check(patches);
  set_values();
}

void ScalarTransport::check(const std::vector<ScalarBoundary>& patches) const {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("gas: {}: {}", name_, what));
  };
  if (!(options_.capacity > 0)) refuse("the heat capacity is not positive; allowed: > 0 J/kg/K");
  if (!(options_.vapour_capacity.value_or(1) > 0)) {
    refuse("the heat capacity of vapour is not positive; allowed: > 0 J/kg/K");
  }
  if (!(options_.conductivity >= 0)) refuse("the conductivity is negative; allowed: at least 0");
  if (!(options_.diffusivity >= 0)) refuse("the diffusivity is negative; allowed: at least 0");
  if (!std::isfinite(options_.initial) || !std::isfinite(options_.reference)) {
    refuse("the initial or the reference value is no finite number; allowed: a number");
  }
  if (patches.size() != boundaries_.patch_names.size()) {
    throw std::invalid_argument("a scalar needs as many boundary conditions as there are patches");
  }
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    const bool inward = piece.kind == PieceKind::inlet && piece.inward_speed() > 0;
    if (inward && !std::holds_alternative<GivenValue>(piece_conditions_[b])) {
      refuse(fmt::format("inlet '{}' brings gas of no given value; allowed: a value",
                         boundaries_.patch_names[static_cast<std::size_t>(piece.patch)]));
    }
    if (const auto* wall = std::get_if<Surroundings>(&piece_conditions_[b])) {
      if (!(wall->coefficient >= 0)) refuse("a transfer coefficient is negative; allowed: at least 0");
    }
  }
}

void ScalarTransport::set_values() {
  Kokkos::deep_copy(excess_, options_.initial - options_.reference);
  publish();
}

void ScalarTransport::set_values(const HostArray<Real>& value) {
  if (value.extent(0) != value_.extent(0)) {
    throw std::invalid_argument("the initial scalar has another size than the gas grid");
  }
  for (std::size_t c = 0; c < value.extent(0); ++c) excess_(c) = value(c) - options_.reference;
  publish();
}

void ScalarTransport::initialise(const GasFields& fields, const ScalarTransport* vapour) {
  compute_content(fields, vapour);
  balance_ = ScalarBalance{};
  balance_.into.assign(boundaries_.patch_names.size(), 0);
  update_stock();
  balance_.initial = balance_.stock;
}

Real ScalarTransport::conductivity(const GasFields& fields, Index c) const {
  Real conductivity = options_.conductivity + fields.density(c) * options_.diffusivity;
  if (fields.eddy_viscosity.extent(0) > 0) {
    if (options_.viscous) conductivity += fields.molecular_viscosity(c);
    conductivity += options_.capacity * fields.eddy_viscosity(c) / options_.turbulent_number;
  }
  return fields.void_fraction(c) * conductivity;
}

// Of the gas between a boundary and the centre of its cell.
Real ScalarTransport::half_conductance(const GasFields& fields, std::size_t b) const {
  const BoundaryPiece& piece = boundaries_.pieces[b];
  if (!fields.piece_layer.empty()) {
    const WallLayer& layer = piece.is_immersed()
                                 ? fields.surface_layer[static_cast<std::size_t>(piece.surface_piece)]
                                 : fields.piece_layer[b];
    if (layer.scale > 0) return layer_coefficient(fields, piece.cell, layer) * piece.area;
  }
  return conductivity(fields, piece.cell) * piece.area / piece.half_width;
}

// Flux per area and difference over the layer between a wall and the centre of the cell: wall functions for what is
// carried.
Real ScalarTransport::layer_coefficient(const GasFields& fields, Index c, const WallLayer& layer) const {
  const Real own = options_.conductivity + fields.density(c) * options_.diffusivity;
  if (!(own > 0)) return 0;
  const Real mu = fields.molecular_viscosity(c);
  const Real prandtl = mu * options_.capacity / own;
  const Real y_star = fields.density(c) * layer.scale * layer.distance / mu;
  const Real resistance = wall_temperature(y_star, prandtl, options_.turbulent_number);
  return fields.void_fraction(c) * own * prandtl * y_star / (resistance * layer.distance);
}

// Half cells in series, as drag and pressure are at the faces: at a jump of eps the gas-poor side decides.
void ScalarTransport::prepare(const GasFields& fields) {
  const char* labels[] = {"cfd::scalar_transport::prepare_x", "cfd::scalar_transport::prepare_y",
                          "cfd::scalar_transport::prepare_z"};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const AxisMetrics& metrics = geometry_.axis[a];
    for_faces(labels[a], geometry_.stencil, axis, [&](Index f, Index m, Index p, Index position, Index) {
      const auto at = static_cast<std::size_t>(position);
      const Real wm = metrics.series_minus[at];
      const Real minus = conductivity(fields, m);
      const Real plus = conductivity(fields, p);
      const Real both = wm * plus + (1 - wm) * minus;
      const Real series = both > 0 ? minus * plus / both : 0;
      conductance_[a](f) = series * geometry_.area[a](f) / geometry_.distance[a](f);
    });
    copy_periodic_faces(geometry_.stencil, axis, conductance_[a]);
  }
}

ScalarTransport::PieceTerms ScalarTransport::piece_terms(const GasFields& fields, std::size_t b) const {
  const BoundaryPiece& piece = boundaries_.pieces[b];
  const ScalarBoundary& condition = piece_conditions_[b];
  const Real half = half_conductance(fields, b);
  PieceTerms terms;
  if (const auto* given = std::get_if<GivenValue>(&condition)) {
    terms.given = given->value - options_.reference;
    const bool open = piece.kind == PieceKind::inlet || piece.kind == PieceKind::outlet;
    if (open) terms.inflow = std::max(-carrier_out_[b], Real{0});
    // Through an open face nothing is conducted against gas that leaves, nor through an outlet.
    if (!open || (piece.kind == PieceKind::inlet && terms.inflow > 0)) terms.conductance = half;
  }
  if (const auto* wall = std::get_if<Surroundings>(&condition)) {
    terms.given = wall->value - options_.reference;
    // The surface and the half cell in series.
    const Real surface = wall->coefficient * piece.area;
    terms.conductance = surface + half > 0 ? surface * half / (surface + half) : 0;
  }
  return terms;
}

void ScalarTransport::set_boundary_values(const GasFields& fields) {
  for (auto& side : boundary_values_) std::fill(side.begin(), side.end(), FaceOfBoundary{});
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    if (piece.is_immersed()) continue;
    const PieceTerms terms = piece_terms(fields, b);
    const auto side = side_number(piece.axis, piece.outward);
    const Real share = piece.area / geometry_.area[static_cast<std::size_t>(piece.axis)](piece.face);
    // How far the face's value is from the cell's towards the given one.
    Real towards = terms.inflow > 0 ? 1 : 0;
    const Real half = half_conductance(fields, b);
    if (terms.conductance > 0) towards = terms.conductance / half;
    FaceOfBoundary& value = boundary_values_[side][static_cast<std::size_t>(piece.place)];
    value.fixed += share * towards * terms.given;
    value.free += share * (1 - towards);
  }
}

// (own) v = sum of near v_N + base, without the correction of the convection scheme.
void ScalarTransport::assemble(const GasFields& fields, Real dt, const ScalarSource& source) {
  const Stencil& s = geometry_.stencil;
  const bool sources = source.rate.extent(0) > 0;
  const Real* volume = geometry_.volume.data();
  for_entries("cfd::scalar_transport::storage", s.cells(), [&](Index c) {
    // A cell without gas keeps its value.
    const Real inertia = volume[c] > 0 ? content_old_(c) / dt : 1;
    const Real taken = sources ? volume[c] * source.coefficient(c) : 0;
    storage_(c) = inertia + taken + gain_(c);
    base_(c) = inertia * old_(c);
    if (sources) base_(c) += volume[c] * source.rate(c) - taken * options_.reference;
  });
  for_rows("cfd::scalar_transport::assemble", s, [&](const Index r) {
    const Row row = s.row(r);
    for (Index i = 0; i < s.n.x; ++i) own_(row.cell + i) = storage_(row.cell + i);
    const Index first[3] = {row.x_face, row.y_face, row.z_face};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Index step = s.face_step(axis);
      for (Index i = 0; i < s.n.x; ++i) {
        const Index c = row.cell + i;
        const Index f = first[axis] + i;
        const Real minus = std::max(carrier_[a](f), Real{0}) + conductance_[a](f);
        const Real plus = std::max(-carrier_[a](f + step), Real{0}) + conductance_[a](f + step);
        near_[2 * a](c) = minus;
        near_[2 * a + 1](c) = plus;
        own_(c) += minus + plus;
      }
    }
  });
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    const Index c = boundaries_.pieces[b].cell;
    const PieceTerms terms = piece_terms(fields, b);
    own_(c) += terms.inflow + terms.conductance;
    base_(c) += (terms.inflow + terms.conductance) * terms.given;
  }
}

template <Convection scheme>
void ScalarTransport::compute_correction() {
  const char* labels[] = {"cfd::scalar_transport::correction_x", "cfd::scalar_transport::correction_y",
                          "cfd::scalar_transport::correction_z"};
  const Stencil& s = geometry_.stencil;
  const Real* v = excess_.data();
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for_faces(labels[a], s, axis, [&](Index f, Index minus, Index plus, Index position, Index place) {
      const Real flux = carrier_[a](f);
      const bool forward = flux >= 0;
      const FaceNeighbours near = find_neighbours(geometry_, axis, forward, f, minus, plus, position);
      const Real central = v[near.central];
      const Real face =
          face_value<scheme>(central, v[near.downstream], near.linear_central, *near.quick, [&] {
            if (near.blocked) return Upstream{central, true};
            if (!near.beyond) return Upstream{v[near.upstream], false};
            const FaceOfBoundary& edge =
                boundary_values_[2 * a + (forward ? 0 : 1)][static_cast<std::size_t>(place)];
            return Upstream{2 * (edge.fixed + edge.free * central) - central, true};
          });
      correction_[a](f) = flux * (face - central);
    });
    copy_periodic_faces(s, axis, correction_[a]);
  }
}

void ScalarTransport::compute_correction() {
  switch (scheme_) {
    case Convection::upwind:
      for (const auto& axis : correction_) Kokkos::deep_copy(axis, 0.0);  // of who had the memory before
      break;
    case Convection::ultimate_quickest:
      compute_correction<Convection::ultimate_quickest>();
      break;
    case Convection::central:
      compute_correction<Convection::central>();
      break;
    case Convection::quick:
      compute_correction<Convection::quick>();
      break;
  }
}

void ScalarTransport::collect_right_side() {
  const Stencil& s = geometry_.stencil;
  for_rows("cfd::scalar_transport::right_side", s, [&](const Index r) {
    const Row row = s.row(r);
    const Index first[3] = {row.x_face, row.y_face, row.z_face};
    for (Index i = 0; i < s.n.x; ++i) {
      Real in = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const auto& flux = correction_[static_cast<std::size_t>(axis)];
        in += flux(first[axis] + i) - flux(first[axis] + i + s.face_step(axis));
      }
      rhs_(row.cell + i) = base_(row.cell + i) + in;
    }
  });
}

// take(cell, sum of near x_N) for every cell.
template <class Take>
void ScalarTransport::apply(const char* label, const Real* x, Take&& take) const {
  const Stencil& s = geometry_.stencil;
  for_rows(label, s, [&](const Index r) {
    const Row row = s.row(r);
    const auto coefficient = [&](std::size_t d) { return near_[d].data() + row.cell; };
    const Real *xm = coefficient(0), *xp = coefficient(1), *ym = coefficient(2), *yp = coefficient(3),
               *zm = coefficient(4), *zp = coefficient(5);
    const Real *own = x + row.cell, *y_minus = x + row.y_minus, *y_plus = x + row.y_plus;
    const Real *z_minus = x + row.z_minus, *z_plus = x + row.z_plus;
    along_row(row, s.n.x, [&](Index i, Index left, Index right) {
      take(row.cell + i, (xm[i] * own[left] + xp[i] * own[right]) + (ym[i] * y_minus[i] + yp[i] * y_plus[i]) +
                             (zm[i] * z_minus[i] + zp[i] * z_plus[i]));
    });
  });
}

TransportReport ScalarTransport::solve(Real tolerance) {
  collect_right_side();
  Real* right_side = linear_solver_.right_side().data();
  for_entries("cfd::scalar_transport::divide", geometry_.stencil.cells(),
              [&](Index c) { right_side[c] = rhs_(c) / own_(c); });
  constexpr int max_iterations = 1000;
  const TransportReport report = linear_solver_.solve(
      excess_.data(),
      [&](const Real* x, auto&& take) {
        apply("cfd::scalar_transport::near", x, [&](Index c, Real near) { take(c, near / own_(c)); });
      },
      tolerance, max_iterations);
  if (!report.converged) {
    throw RunError(fmt::format("gas: the {} did not converge in {} iterations (relative residual {:.3g})",
                               name_, report.iterations, report.residual));
  }
  return report;
}

// The discrete maximum principle: a value lies between those at the boundaries and those that the cells would get from
// what they had and from their sources alone.
ScalarTransport::Bounds ScalarTransport::find_bounds(const GasFields& fields, Real dt,
                                                     const ScalarSource& source) {
  const bool sources = source.rate.extent(0) > 0;
  const auto alone = [&](Index c) {
    Real amount = content_old_(c) / dt * old_(c);
    if (sources) {
      amount += geometry_.volume(c) * (source.rate(c) - source.coefficient(c) * options_.reference);
    }
    return amount / storage_(c);
  };
  // From a first value on, since sums of the largest begin at 0.
  const Index n = geometry_.stencil.cells();
  Index first = 0;
  while (first < n && !(geometry_.volume(first) > 0)) ++first;
  const Real start = first < n ? alone(first) : std::numeric_limits<Real>::quiet_NaN();
  const auto beyond = sum_.largest_two("cfd::scalar_transport::bounds", n, [&](Index c) {
    const Real more = geometry_.volume(c) > 0 ? alone(c) - start : 0;
    return std::array<Real, 2>{-more, more};
  });
  Bounds bounds{start - beyond[0], start + beyond[1]};
  const auto include = [&](Real v) {
    bounds.low = std::min(bounds.low, v);
    bounds.high = std::max(bounds.high, v);
  };
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    const PieceTerms terms = piece_terms(fields, b);
    if (terms.inflow + terms.conductance > 0) include(terms.given);
  }
  return bounds;
}

// Flags the cells that are out of bounds; returns how many were not flagged before.
int ScalarTransport::flag_cells_beyond(const Bounds& bounds) {
  // Ten times what a linear solve leaves.
  const Real slack = 10 * options_.tolerance * std::max(std::abs(bounds.low), std::abs(bounds.high));
  const Real low = bounds.low - slack, high = bounds.high + slack;
  const Real *volume = geometry_.volume.data(), *value = excess_.data();
  char* flagged = flagged_.data();
  const Real found = sum_("cfd::scalar_transport::flag", geometry_.stencil.cells(), [=](Index c) {
    if (flagged[c] != 0 || !(volume[c] > 0) || !(value[c] < low || value[c] > high)) return Real{0};
    flagged[c] = 1;
    return Real{1};
  });
  return static_cast<int>(found);
}

void ScalarTransport::drop_flagged_corrections() {
  const char* labels[] = {"cfd::scalar_transport::drop_x", "cfd::scalar_transport::drop_y",
                          "cfd::scalar_transport::drop_z"};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for_faces(labels[a], geometry_.stencil, axis, [&](Index f, Index m, Index p, Index, Index) {
      if (flagged_[static_cast<std::size_t>(m)] != 0 || flagged_[static_cast<std::size_t>(p)] != 0) {
        correction_[a](f) = 0;
      }
    });
    copy_periodic_faces(geometry_.stencil, axis, correction_[a]);
  }
}

// The limiter keeps the value within bounds once the deferred correction has converged; it need not have. Where the
// value is out of bounds the cell's faces go back to upwind, for which it cannot be: the balance stays closed.
void ScalarTransport::stay_within_bounds(const Bounds& bounds, ScalarReport& report) {
  std::fill(flagged_.begin(), flagged_.end(), char{0});
  // Every round flags further cells, so this ends: with all of them flagged the scheme is upwind.
  while (const int found = flag_cells_beyond(bounds)) {
    report.returned += found;
    drop_flagged_corrections();
    report.iterations += solve(options_.tolerance).iterations;
    ++report.solves;
  }
}

ScalarReport ScalarTransport::update(const GasFields& fields, Real dt, const ScalarSource& source,
                                     const ScalarTransport* vapour) {
  if (source.rate.extent(0) != source.coefficient.extent(0) ||
      (source.rate.extent(0) > 0 && source.rate.extent(0) != value_.extent(0))) {
    throw std::invalid_argument("the scalar's source has another size than the gas grid");
  }
  Kokkos::deep_copy(old_, excess_);
  prepare_carrier(fields, vapour);
  prepare(fields);
  set_boundary_values(fields);
  assemble(fields, dt, source);
  const Bounds bounds = find_bounds(fields, dt, source);
  const Real range = bounds.high - bounds.low;
  // As long as corrections follow, solves need only be closer than the change that ends them.
  const Real largest = std::max(std::abs(bounds.low), std::abs(bounds.high));
  const Real close_enough =
      largest > 0 ? solve_over_change * options_.correction_tolerance * range / largest : 0;
  const Real tolerance =
      scheme_ == Convection::upwind ? options_.tolerance : std::max(options_.tolerance, close_enough);
  ScalarReport report;
  HostArray<Real>& before = value_;  // written anew at the end of the step
  bool done = false;
  while (!done) {
    Kokkos::deep_copy(before, excess_);
    compute_correction();
    report.iterations += solve(tolerance).iterations;
    ++report.solves;
    const Real *now = excess_.data(), *then = before.data();
    const Real change = sum_.largest("cfd::scalar_transport::change", geometry_.stencil.cells(),
                                     [=](Index c) { return std::abs(now[c] - then[c]); });
    done = scheme_ == Convection::upwind || report.solves >= options_.max_corrections ||
           !(change > options_.correction_tolerance * range);
  }
  if (tolerance > options_.tolerance) report.iterations += solve(options_.tolerance).iterations;
  if (scheme_ == Convection::ultimate_quickest) stay_within_bounds(bounds, report);
  finish(fields, dt, source);
  return report;
}

// The balance of what was exchanged, and the value once more in flux form: what the linear solve leaves would add up
// in the balance over many steps.
void ScalarTransport::finish(const GasFields& fields, Real dt, const ScalarSource& source) {
  if (!flux_out_.empty()) compute_flux(fields);
  add_boundaries_to_balance(fields, dt);
  add_leftover_to_balance(dt);
  Real* residual = linear_solver_.right_side().data();
  apply("cfd::scalar_transport::residual", excess_.data(),
        [&](Index c, Real near) { residual[c] = rhs_(c) + near - own_(c) * excess_(c); });
  const Index n = geometry_.stencil.cells();
  for_entries("cfd::scalar_transport::flux_form", n,
              [&](Index c) { excess_(c) += residual[c] / storage_(c); });
  if (source.rate.extent(0) > 0) {
    const auto given = [&](Index c) {
      return geometry_.volume(c) *
             (source.rate(c) - source.coefficient(c) * (options_.reference + excess_(c)));
    };
    balance_.sources += dt * sum_("cfd::scalar_transport::sources", n, given);
    balance_.gross +=
        dt * sum_("cfd::scalar_transport::gross", n, [&](Index c) { return std::abs(given(c)); });
  }
  publish();
  update_stock();
  const Real* value = value_.data();
  const auto is_bad = [=](Index c) { return !std::isfinite(value[c]); };
  if (sum_("cfd::scalar_transport::not_finite", n, [=](Index c) { return is_bad(c) ? 1.0 : 0.0; }) == 0)
    return;
  Index c = 0;
  while (!is_bad(c)) ++c;
  const Index3 at = geometry_.grid.coordinates(c);
  throw RunError(
      fmt::format("gas: the {} is no longer finite, in cell ({}, {}, {})", name_, at.x, at.y, at.z));
}

void ScalarTransport::publish() {
  for_entries("cfd::scalar_transport::publish", geometry_.stencil.cells(),
              [&](Index c) { value_(c) = options_.reference + excess_(c); });
}

}  // namespace pellicle::cfd
