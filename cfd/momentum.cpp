#include "cfd/momentum.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "cfd/field_memory.hpp"
#include "cfd/velocity_gradient.hpp"

namespace pellicle::cfd {

namespace {

HostArray<Real> make_array(const std::string& label, Index size) {
  return make_field<Real>(label, static_cast<std::size_t>(size));
}

}  // namespace

GasFields::GasFields(const FlowGeometry& geometry, std::size_t piece_count, bool is_turbulent)
    : cells(geometry.stencil.cells()) {
  velocity = make_array("cfd::gas_fields::velocity", 3 * cells);
  velocity_old = make_array("cfd::gas_fields::velocity_old", 3 * cells);
  pressure = make_array("cfd::gas_fields::pressure", cells);
  void_fraction = make_array("cfd::gas_fields::void_fraction", cells);
  void_fraction_old = make_array("cfd::gas_fields::void_fraction_old", cells);
  exchange_coefficient = make_array("cfd::gas_fields::exchange_coefficient", cells);
  force = make_array("cfd::gas_fields::force", 3 * cells);
  mass_source = make_array("cfd::gas_fields::mass_source", cells);
  density = make_array("cfd::gas_fields::density", cells);
  density_old = make_array("cfd::gas_fields::density_old", cells);
  excess_density = make_array("cfd::gas_fields::excess_density", cells);
  viscosity = make_array("cfd::gas_fields::viscosity", cells);
  molecular_viscosity = viscosity;
  if (is_turbulent) {
    molecular_viscosity = make_array("cfd::gas_fields::molecular_viscosity", cells);
    eddy_viscosity = make_array("cfd::gas_fields::eddy_viscosity", cells);
    velocity_gradient = make_array("cfd::gas_fields::velocity_gradient", 9 * cells);
    piece_layer.resize(piece_count);
    surface_layer.resize(geometry.pieces.size());
  }
  face_density = make_face_field(geometry.stencil, "cfd::gas_fields::face_density");
  face_density_old = make_face_field(geometry.stencil, "cfd::gas_fields::face_density_old");
  piece_density.assign(piece_count, 0);
  superficial = make_face_field(geometry.stencil, "cfd::gas_fields::superficial");
  superficial_old = make_face_field(geometry.stencil, "cfd::gas_fields::superficial_old");
  mass_flux = make_face_field(geometry.stencil, "cfd::gas_fields::mass_flux");
  piece_flow.assign(piece_count, 0);
  piece_flow_old.assign(piece_count, 0);
}

MomentumEquation::MomentumEquation(const FlowGeometry& geometry, const Boundaries& boundaries,
                                   const GasOptions& options)
    : geometry_(geometry),
      boundaries_(boundaries),
      options_(options),
      correction_(geometry),
      conductance_(make_face_field(geometry.stencil, "cfd::momentum::conductance")),
      tangential_conductance_(make_face_field(geometry.stencil, "cfd::momentum::tangential_conductance")),
      linear_solver_(3 * geometry.stencil.cells()) {
  wall_stress_.assign(boundaries.pieces.size(), 0);
  transposed_.assign(boundaries.pieces.size(), Vec3{});
  piece_of_.assign(geometry.is_cut ? static_cast<std::size_t>(geometry.stencil.cells()) : 0, -1);
  for (const SurfacePiece& piece : geometry.pieces) {
    const ImmersedSurface& surface = geometry.surfaces[static_cast<std::size_t>(piece.surface)];
    auto& largest = piece_of_[static_cast<std::size_t>(piece.cell)];
    if (surface.sticks && !boundaries.passes(surface_velocity_.size()) &&
        (largest < 0 || piece.area > geometry.pieces[static_cast<std::size_t>(largest)].area)) {
      largest = static_cast<std::int32_t>(surface_velocity_.size());
    }
    surface_velocity_.push_back(surface.velocity_at(piece.point, piece.normal));
  }
  const Index n = geometry.stencil.cells();
  for (std::size_t d = 0; d < 6; ++d) {
    near_[d] = make_array("cfd::momentum::near" + std::to_string(d), n);
    normal_[d] = make_array("cfd::momentum::normal" + std::to_string(d), n);
  }
  own_ = make_array("cfd::momentum::own", 3 * n);
  source_ = make_array("cfd::momentum::source", 3 * n);
  inverse_ = make_array("cfd::momentum::inverse", 3 * n);
  packed_ = make_field<float>("cfd::momentum::packed", std::size_t{15} * static_cast<std::size_t>(n));
  defect_ = make_field<float>("cfd::momentum::defect", std::size_t{3} * static_cast<std::size_t>(n));
  for (auto& one : trial_)
    one = make_field<float>("cfd::momentum::trial", std::size_t{3} * static_cast<std::size_t>(n));
  const Stencil& s = geometry.stencil;
  // Around an odd periodic axis two rows of one colour are neighbours.
  // A wall without shear mirrors the flow: beyond it a cell's neighbour is the cell itself, at the end of a row too.
  for (const BoundaryPiece& piece : boundaries.pieces) {
    if (piece.kind == PieceKind::slip && piece.axis == 0) open_ends_ = false;
  }
  if (s.periodic[0]) open_ends_ = false;
  coloured_ =
      !(s.periodic[1] && s.n.y % 2 == 1 && s.n.y > 1) && !(s.periodic[2] && s.n.z % 2 == 1 && s.n.z > 1);
  row_change_.assign(static_cast<std::size_t>(s.rows()), 0);
  row_begun_.assign(static_cast<std::size_t>(s.rows()), {});
}

void MomentumEquation::prepare(const GasFields& fields, Real dt) {
  const char* labels[] = {"cfd::momentum::prepare_x", "cfd::momentum::prepare_y", "cfd::momentum::prepare_z"};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const AxisMetrics& metrics = geometry_.axis[a];
    const Real* eps = fields.void_fraction.data();
    const Real* mu = fields.viscosity.data();
    for_faces(labels[a], geometry_.stencil, axis,
              [&](Index f, Index minus, Index plus, Index position, Index) {
                const auto at = static_cast<std::size_t>(position);
                const Real w = metrics.linear_minus[at];
                // A cell that is its own neighbour, alone along a periodic axis, does not act on itself: in the face
                // balance its term would not cancel.
                const Real viscosity = minus == plus ? 0 : mu[plus] + w * (mu[minus] - mu[plus]);
                conductance_[a](f) = viscosity * geometry_.area[a](f) / geometry_.distance[a](f);
                tangential_conductance_[a](f) = conductance_[a](f) * (w * eps[minus] + (1 - w) * eps[plus]);
              });
    copy_periodic_faces(geometry_.stencil, axis, conductance_[a]);
    copy_periodic_faces(geometry_.stencil, axis, tangential_conductance_[a]);
  }
  // Where nothing slips nothing changes along the boundary, and continuity alone gives the normal gradient of eps u.
  boundaries_.groups.for_each("cfd::momentum::wall_stress", [&](std::size_t b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    if (piece.is_immersed() || (piece.kind != PieceKind::no_slip && piece.kind != PieceKind::inlet)) return;
    const Index c = piece.cell;
    const Real thinning = fields.density_old(c) / fields.density(c);
    const Real growth = (fields.void_fraction(c) - thinning * fields.void_fraction_old(c)) / dt -
                        fields.mass_source(c) / fields.density(c);
    wall_stress_[b] = -piece.outward * fields.molecular_viscosity(c) * piece.area * growth;
  });
}

void MomentumEquation::assemble(const GasFields& fields) {
  compute_convection_correction(geometry_, boundaries_, options_.convection, fields, correction_);
  const Stencil& s = geometry_.stencil;
  const Index n = fields.cells;
  const Real* eps = fields.void_fraction.data();
  const bool corrected = options_.convection != Convection::upwind;
  for_rows("cfd::momentum::assemble", s, [&](const Index r) {
    const Row row = s.row(r);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Index step = s.face_step(axis);
      const Index faces = s.faces(axis);
      const Index first_face = axis == 0 ? row.x_face : (axis == 1 ? row.y_face : row.z_face);
      const Real* flux = fields.mass_flux[a].data() + first_face;
      const Real* conductance = conductance_[a].data() + first_face;
      const Real* tangential = tangential_conductance_[a].data() + first_face;
      const Real* extra = correction_.momentum_flux[a].data() + first_face;
      Real* near_minus = near_[2 * a].data() + row.cell;
      Real* near_plus = near_[2 * a + 1].data() + row.cell;
      Real* normal_minus = normal_[2 * a].data() + row.cell;
      Real* normal_plus = normal_[2 * a + 1].data() + row.cell;
      const Index minus_row = axis == 1 ? row.y_minus : (axis == 2 ? row.z_minus : row.cell);
      const Index plus_row = axis == 1 ? row.y_plus : (axis == 2 ? row.z_plus : row.cell);
      Real* own[3];
      Real* source[3];
      for (int b = 0; b < 3; ++b) {
        own[b] = &own_(row.cell + b * n);
        source[b] = &source_(row.cell + b * n);
      }
      const Index nx = s.n.x;
      for (const Real* next :
           {flux, conductance, tangential, extra, extra + faces, extra + std::ptrdiff_t{2} * faces}) {
        prefetch_row(next + nx + step, nx);
      }
      for (const Real* next : {near_minus, near_plus, normal_minus, normal_plus}) prefetch_row(next + nx, nx);
      if (axis == 0) {
        for (int b = 0; b < 3; ++b) {
          prefetch_row(own[b] + nx, nx);
          prefetch_row(source[b] + nx, nx);
        }
        prefetch_row(eps + row.cell + nx + s.face_step(2), nx);
      }
      const int t1 = (axis + 1) % 3;
      const int t2 = (axis + 2) % 3;
      along_open_row(s, row, [=](Index i, Index left, Index right) {
        const Real eps_own = eps[row.cell + i];
        const Real eps_minus = eps[minus_row + (axis == 0 ? left : i)];
        const Real eps_plus = eps[plus_row + (axis == 0 ? right : i)];
        const Real in_minus = std::max(flux[i], Real{0});
        const Real in_plus = std::max(-flux[i + step], Real{0});
        near_minus[i] = in_minus + tangential[i];
        near_plus[i] = in_plus + tangential[i + step];
        normal_minus[i] = in_minus * (eps_minus / eps_own) + conductance[i] * eps_minus;
        normal_plus[i] = in_plus * (eps_plus / eps_own) + conductance[i + step] * eps_plus;
        const Real across = near_minus[i] + near_plus[i];
        const Real along = in_minus + in_plus + (conductance[i] + conductance[i + step]) * eps_own;
        Real normal_source = 0;
        Real source1 = 0;
        Real source2 = 0;
        if (corrected) {
          normal_source = (extra[i + axis * faces] - extra[i + step + axis * faces]) / eps_own;
          source1 = extra[i + t1 * faces] - extra[i + step + t1 * faces];
          source2 = extra[i + t2 * faces] - extra[i + step + t2 * faces];
        }
        if (axis == 0) {
          own[0][i] = along;
          own[1][i] = across;
          own[2][i] = across;
          source[0][i] = normal_source;
          source[1][i] = source1;
          source[2][i] = source2;
        } else {
          own[axis][i] += along;
          own[t1][i] += across;
          own[t2][i] += across;
          source[axis][i] += normal_source;
          source[t1][i] += source1;
          source[t2][i] += source2;
        }
      });
    }
  });
  add_boundaries(fields);
}

// Momentum that comes in with the gas, and stress, as a coefficient of the cell's velocity and a given value.
namespace {

struct PieceTerms {
  Real inflow = 0;  ///< mass that enters [kg/s]
  Vec3 brought;     ///< with this velocity
  Real shear = 0;   ///< coefficient of the tangential slip [kg/s]
  Real mirror = 0;  ///< viscous conductance to the mirrored cell beyond a wall without shear [kg/s]
};

PieceTerms piece_terms(const GasFields& fields, const BoundaryPiece& piece, std::size_t b) {
  const Real flow = fields.piece_flow[b];
  const Real eps = fields.void_fraction(piece.cell);
  const Real viscosity = fields.viscosity(piece.cell);
  PieceTerms terms;
  if (piece.kind == PieceKind::inlet || piece.kind == PieceKind::outlet) {
    terms.inflow = fields.piece_density[b] * std::max(-flow, Real{0});
    // The superficial velocity is the same on both sides of the face; inside, the gas has eps of the room.
    if (piece.is_immersed()) {
      terms.brought = (-flow / (piece.area * eps)) * piece.normal;
      return terms;
    }
    terms.brought[piece.axis] = piece.outward * flow / (piece.area * eps);
  }
  if (piece.kind == PieceKind::inlet || piece.kind == PieceKind::no_slip) {
    const bool layered = !fields.piece_layer.empty() && fields.piece_layer[b].scale > 0;
    terms.shear =
        (layered ? fields.piece_layer[b].viscosity : viscosity) * eps * piece.area / piece.half_width;
  }
  if (piece.kind == PieceKind::slip) {
    terms.mirror = viscosity * eps * piece.area / (2 * piece.half_width);
  }
  return terms;
}

}  // namespace

void MomentumEquation::add_boundaries(const GasFields& fields) {
  const Index n = fields.cells;
  boundaries_.groups.for_each("cfd::momentum::boundaries", [&](std::size_t b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    const PieceTerms terms = piece_terms(fields, piece, b);
    if (piece.is_immersed()) {
      for (int a = 0; a < 3; ++a) {
        own_(piece.cell + a * n) += terms.inflow;
        source_(piece.cell + a * n) += terms.inflow * terms.brought[a];
      }
      return;
    }
    for (int a = 0; a < 3; ++a) {
      const Index c = piece.cell + a * n;
      const Real shear = a == piece.axis ? 0 : terms.shear;
      const Real wall_speed = a == piece.axis ? 0 : piece.velocity[a];
      own_(c) += terms.inflow + shear;
      source_(c) += terms.inflow * terms.brought[a] + shear * wall_speed;
    }
    source_(piece.cell + piece.axis * n) += wall_stress_[b];
    // The mirrored cell, of opposite normal velocity, is a neighbour like any other; it exerts no shear. Beyond a
    // boundary a cell's neighbour is the cell itself.
    const auto beyond = side_number(piece.axis, piece.outward);
    own_(piece.cell + piece.axis * n) += terms.mirror;
    normal_[beyond](piece.cell) -= terms.mirror;
  });
  add_surfaces(fields);
  add_skew_stress(fields);
  if (fields.velocity_gradient.extent(0) > 0) {
    compute_velocity_gradient(geometry_, boundaries_, fields);
    add_transposed_stress(geometry_, boundaries_, fields, tangential_conductance_, source_, transposed_);
  }
}

// The gas sticks to a surface. All of the slip counts, not its tangential part alone: the normal part vanishes with the
// square of the distance, as continuity wants it to, and the components stay apart from each other.
Real MomentumEquation::surface_conductance(const GasFields& fields, std::size_t b) const {
  const SurfacePiece& piece = geometry_.pieces[b];
  if (!geometry_.surfaces[static_cast<std::size_t>(piece.surface)].sticks || boundaries_.passes(b)) return 0;
  const Real viscosity =
      fields.surface_layer.empty() ? fields.viscosity(piece.cell) : fields.surface_layer[b].viscosity;
  return viscosity * fields.void_fraction(piece.cell) * piece.area / piece.distance;
}

void MomentumEquation::add_surfaces(const GasFields& fields) {
  for (std::size_t b = 0; b < geometry_.pieces.size(); ++b) {
    const SurfacePiece& piece = geometry_.pieces[b];
    const Real shear = surface_conductance(fields, b);
    for (int a = 0; a < 3; ++a) {
      const Index e = piece.cell + a * fields.cells;
      own_(e) += shear;
      source_(e) += shear * surface_velocity_[b][a];
    }
  }
}

// Between centroids that do not face each other the difference of velocities is in part that across the line between
// them: beside a wall, of the gradient that the wall makes. That part is no stress on the face.
void MomentumEquation::add_skew_stress(const GasFields& fields) {
  const Index n = fields.cells;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const SkewFace& skew : geometry_.skew_faces[axis]) {
      for (int a = 0; a < 3; ++a) {
        Real difference = 0;
        int sides = 0;
        for (const Index c : {skew.minus, skew.plus}) {
          const std::int32_t b = piece_of_[static_cast<std::size_t>(c)];
          if (b < 0) continue;
          const SurfacePiece& piece = geometry_.pieces[static_cast<std::size_t>(b)];
          const Real slip = fields.velocity(c + a * n) - surface_velocity_[static_cast<std::size_t>(b)][a];
          difference += slip / piece.distance * dot(piece.normal, skew.across);
          ++sides;
        }
        if (sides == 0) continue;
        const Real force = tangential_conductance_[axis](skew.face) * difference / sides;
        source_(skew.minus + a * n) -= force;
        source_(skew.plus + a * n) += force;
      }
    }
  }
}

Vec3 MomentumEquation::surface_shear(const GasFields& fields, std::size_t b) const {
  const SurfacePiece& piece = geometry_.pieces[b];
  const Index n = fields.cells;
  const Vec3 gas{fields.velocity(piece.cell), fields.velocity(piece.cell + n),
                 fields.velocity(piece.cell + 2 * n)};
  return surface_conductance(fields, b) * (surface_velocity_[b] - gas);
}

Vec3 MomentumEquation::convected_inflow(const GasFields& fields, std::size_t b) const {
  const BoundaryPiece& piece = boundaries_.pieces[b];
  const PieceTerms terms = piece_terms(fields, piece, b);
  const Real outflow = fields.piece_density[b] * std::max(fields.piece_flow[b], Real{0});
  Vec3 result;
  for (int a = 0; a < 3; ++a) {
    result[a] = terms.inflow * terms.brought[a] - outflow * fields.velocity(piece.cell + a * fields.cells);
  }
  return result;
}

Vec3 MomentumEquation::shear_force(const GasFields& fields, std::size_t b) const {
  const BoundaryPiece& piece = boundaries_.pieces[b];
  if (piece.is_immersed()) return {};
  const PieceTerms terms = piece_terms(fields, piece, b);
  Vec3 result;
  for (int a = 0; a < 3; ++a) {
    const Real slip =
        (a == piece.axis ? 0 : piece.velocity[a]) - fields.velocity(piece.cell + a * fields.cells);
    result[a] = (a == piece.axis ? 2 * terms.mirror : terms.shear) * slip;
  }
  result[piece.axis] += wall_stress_[b];
  return result + transposed_[b];
}

}  // namespace pellicle::cfd
