#include "cfd/face_balance.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <type_traits>

namespace pellicle::cfd {

FaceBalance::FaceBalance(const FlowGeometry& geometry, const Boundaries& boundaries,
                         const GasOptions& options)
    : geometry_(geometry),
      boundaries_(boundaries),
      options_(options),
      void_fraction_(make_face_field(geometry.stencil, "cfd::face_balance::void_fraction")),
      void_fraction_old_(make_face_field(geometry.stencil, "cfd::face_balance::void_fraction_old")),
      resistance_(make_face_field(geometry.stencil, "cfd::face_balance::resistance")),
      force_(make_face_field(geometry.stencil, "cfd::face_balance::force")),
      kinetic_(make_face_field(geometry.stencil, "cfd::face_balance::kinetic")),
      mobility_(make_face_field(geometry.stencil, "cfd::face_balance::mobility")),
      inertial_(make_face_field(geometry.stencil, "cfd::face_balance::inertial")),
      jump_(make_face_field(geometry.stencil, "cfd::face_balance::jump")),
      outlet_mobility_(boundaries.pieces.size(), 0) {}

void FaceBalance::prepare(const GasFields& fields) {
  const char* labels[] = {"cfd::face_balance::prepare_x", "cfd::face_balance::prepare_y",
                          "cfd::face_balance::prepare_z"};
  const Real* eps = fields.void_fraction.data();
  const Real* eps_old = fields.void_fraction_old.data();
  const Real* beta = fields.exchange_coefficient.data();
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Real* force = &fields.force(axis * fields.cells);
    const Real body = options_.body_force[axis];
    for_faces(labels[a], geometry_.stencil, axis, [&](Index f, Index m, Index p, Index position, Index) {
      const Real wm = geometry_.axis[a].series_minus[static_cast<std::size_t>(position)];
      const Real wp = 1 - wm;
      void_fraction_[a](f) = 1 / (wm / eps[m] + wp / eps[p]);
      void_fraction_old_[a](f) = 1 / (wm / eps_old[m] + wp / eps_old[p]);
      const Real inverse_m = 1 / (eps[m] * eps[m]);
      const Real inverse_p = 1 / (eps[p] * eps[p]);
      resistance_[a](f) = wm * beta[m] * inverse_m + wp * beta[p] * inverse_p;
      force_[a](f) = wm * force[m] / eps[m] + wp * force[p] / eps[p] + body;
      kinetic_[a](f) = inverse_p - inverse_m;
    });
  }
}

void FaceBalance::predict(GasFields& fields, const MomentumEquation& momentum, const HostArray<Real>& influx,
                          const Inertia& inertia, Real dt, PressureMatrix& matrix) {
  const char* labels[] = {"cfd::face_balance::predict_x", "cfd::face_balance::predict_y",
                          "cfd::face_balance::predict_z"};
  const Index cells = fields.cells;
  const Real* eps = fields.void_fraction.data();
  const Real* pressure = fields.pressure.data();
  const Real* volume = geometry_.volume.data();
  const Real per_density = 1 / options_.density;
  const Real per_dt = 1 / dt;
  const Real* held = inertia.all.data();
  const Real keep = inertia.keep;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const AxisMetrics& metrics = geometry_.axis[a];
    const Real* own = &momentum.own()(axis * cells);
    const Real* in = &influx(axis * cells);
    const Real* normal_value = momentum.convection().normal_value[a].data();
    Real* velocity = fields.superficial[a].data();
    const Real* velocity_old = fields.superficial_old[a].data();
    const auto predict_along = [&](auto relaxes) {
      for_faces(
          labels[a], geometry_.stencil, axis,
          [&](Index f, Index m, Index p, Index position, Index) {
            const auto at = static_cast<std::size_t>(position);
            const Real wm = metrics.linear_minus[at];
            const Real wp = 1 - wm;
            const Real distance = metrics.distance[at];
            const Real eps_f = void_fraction_[a](f);
            const Real scale_m = wm / (volume[m] * eps[m]);
            const Real scale_p = wp / (volume[p] * eps[p]);
            const Real transport = scale_m * own[m] + scale_p * own[p];
            Real relaxed = 0;
            if constexpr (relaxes) {
              relaxed = keep * (scale_m * (own[m] + held[m]) + scale_p * (own[p] + held[p]));
            }
            const Real inflow = scale_m * eps[m] * in[m] + scale_p * eps[p] * in[p];
            const Real rho = fields.face_density[a](f);
            const Real rho_old = fields.face_density_old[a](f);
            const Real transient = rho_old * void_fraction_old_[a](f) * per_dt / eps_f;
            // The convective pressure step: implicit where it slows the face down, explicit where it speeds it up.
            const Real kinetic = 0.5 * rho * normal_value[f] * kinetic_[a](f) * eps_f / distance;
            const Real braking = std::max(kinetic, Real{0});
            const Real speeding = std::max(-kinetic, Real{0});
            const Real stiffness = transient + eps_f * resistance_[a](f) + relaxed + braking;
            const Real pull = inflow + rho_old * velocity_old[f] * per_dt +
                              (relaxed + speeding) * velocity[f] +
                              eps_f * ((pressure[m] - pressure[p]) / distance + force_[a](f));
            velocity[f] = pull / (stiffness + transport);
            mobility_[a](f) = eps_f / (stiffness * distance);
            matrix.coefficient[a](f) = geometry_.area[a](f) * mobility_[a](f) * (rho * per_density);
          },
          [&](Index face, Index cell) {
            const Index nx = geometry_.stencil.n.x;
            for (const FaceField* field : std::initializer_list<const FaceField*>{
                     &void_fraction_, &void_fraction_old_, &fields.face_density, &fields.face_density_old,
                     &kinetic_, &resistance_, &force_, &mobility_, &geometry_.area}) {
              prefetch_row((*field)[a].data() + face, nx);
            }
            for (const Real* field : {normal_value, static_cast<const Real*>(velocity), velocity_old,
                                      static_cast<const Real*>(matrix.coefficient[a].data())}) {
              prefetch_row(field + face, nx);
            }
            for (const Real* field : {volume, eps, own, in, pressure}) prefetch_row(field + cell, nx);
          });
    };
    keep > 0 ? predict_along(std::true_type{}) : predict_along(std::false_type{});
    copy_periodic_faces(geometry_.stencil, axis, fields.superficial[a]);
    copy_periodic_faces(geometry_.stencil, axis, mobility_[a]);
    copy_periodic_faces(geometry_.stencil, axis, matrix.coefficient[a]);
  }
  clear_closed_faces(fields.superficial);
  clear_closed_faces(mobility_);
  clear_closed_faces(matrix.coefficient);
  predict_outlets(fields, momentum, influx, inertia, dt, matrix);
  set_boundary_velocities(geometry_, boundaries_, fields);
  matrix.finish();
}

// Loops over all faces compute faces that a surface closes like all others; what they found there is no flow.
void FaceBalance::clear_closed_faces(const FaceField& field) const {
  for (std::size_t a = 0; a < 3; ++a) {
    for (const Index f : geometry_.closed_faces[a]) field[a](f) = 0;
  }
}

// Static pressure just inside the outlet. Gas that comes back in starts from rest at the outlet's pressure.
Real FaceBalance::outlet_pressure(const GasFields& fields, std::size_t b) const {
  const BoundaryPiece& piece = boundaries_.pieces[b];
  const Real inside =
      std::min(fields.piece_flow[b], Real{0}) / (piece.area * fields.void_fraction(piece.cell));
  return piece.pressure - 0.5 * fields.piece_density[b] * inside * inside;
}

namespace {

Vec3 vector_at(const HostArray<Real>& field, Index c, Index cells, Real over) {
  return {field(c) / over, field(c + cells) / over, field(c + 2 * cells) / over};
}

// Of a coefficient that each component has its own of, what the velocity through the piece has.
Real normal_part(const BoundaryPiece& piece, const HostArray<Real>& coefficient, Index cells) {
  if (!piece.is_immersed()) return coefficient(piece.cell + piece.axis * cells);
  const Vec3& n = piece.normal;
  return n.x * n.x * coefficient(piece.cell) + n.y * n.y * coefficient(piece.cell + cells) +
         n.z * n.z * coefficient(piece.cell + 2 * cells);
}

}  // namespace

void FaceBalance::predict_outlets(GasFields& fields, const MomentumEquation& momentum,
                                  const HostArray<Real>& influx, const Inertia& inertia, Real dt,
                                  PressureMatrix& matrix) {
  for (const std::size_t b : boundaries_.passable) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    matrix.boundary[static_cast<std::size_t>(piece.axis)](piece.cell) = 0;
  }
  for (const std::size_t b : boundaries_.passable) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    if (piece.kind != PieceKind::outlet) continue;
    const Index c = piece.cell;
    const Real eps = fields.void_fraction(c);
    const Real volume = geometry_.volume(c);
    const Real speed = fields.piece_flow[b] / piece.area;
    const Real transport = normal_part(piece, momentum.own(), fields.cells) / (volume * eps);
    const Real relaxed = inertia.keep * (transport + inertia.all(c) / (volume * eps));
    const Real rho = fields.piece_density[b];
    const Real rho_old = fields.density_old(c);
    const Real braking = 0.5 * rho * std::max(-speed, Real{0}) / (eps * piece.half_width);
    const Real stiffness = rho_old * fields.void_fraction_old(c) / (dt * eps) +
                           fields.exchange_coefficient(c) / eps + relaxed + braking;
    const Real outward_force = piece.outward_part(vector_at(fields.force, c, fields.cells, eps)) +
                               piece.outward_part(options_.body_force);
    const Real pull = piece.outward_part(vector_at(influx, c, fields.cells, 1)) / volume +
                      rho_old * fields.piece_flow_old[b] / (piece.area * dt) + relaxed * speed +
                      eps * ((fields.pressure(c) - piece.pressure) / piece.half_width + outward_force);
    outlet_mobility_[b] = eps / (stiffness * piece.half_width);
    fields.piece_flow[b] = piece.area * pull / (stiffness + transport);
    matrix.boundary[static_cast<std::size_t>(piece.axis)](c) +=
        piece.area * outlet_mobility_[b] * (rho / options_.density);
  }
}

void set_boundary_velocities(const FlowGeometry& geometry, const Boundaries& boundaries,
                             const GasFields& fields) {
  // Nothing ever passes through the others' faces.
  for (const std::size_t b : boundaries.passable) {
    const BoundaryPiece& piece = boundaries.pieces[b];
    if (!piece.is_immersed()) fields.superficial[static_cast<std::size_t>(piece.axis)](piece.face) = 0;
  }
  for (const std::size_t b : boundaries.passable) {
    const BoundaryPiece& piece = boundaries.pieces[b];
    if (piece.is_immersed()) continue;
    const auto a = static_cast<std::size_t>(piece.axis);
    fields.superficial[a](piece.face) += piece.outward * fields.piece_flow[b] / geometry.area[a](piece.face);
  }
}

void FaceBalance::correct(GasFields& fields, const HostArray<Real>& correction) {
  const char* labels[] = {"cfd::face_balance::correct_x", "cfd::face_balance::correct_y",
                          "cfd::face_balance::correct_z"};
  const char* cell_labels[] = {"cfd::face_balance::correct_cells_x", "cfd::face_balance::correct_cells_y",
                               "cfd::face_balance::correct_cells_z"};
  const Stencil& s = geometry_.stencil;
  const Real* change = correction.data();
  // The change of each face's velocity goes where its inertial force will be computed anew.
  boundaries_.groups.for_each("cfd::face_balance::clear_boundary", [&](std::size_t b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    if (!piece.is_immersed()) inertial_[static_cast<std::size_t>(piece.axis)](piece.face) = 0;
  });
  for (const std::size_t b : boundaries_.passable) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    if (piece.kind != PieceKind::outlet) continue;
    const auto a = static_cast<std::size_t>(piece.axis);
    const Real flow = piece.area * outlet_mobility_[b] * change[piece.cell];
    fields.piece_flow[b] += flow;
    if (piece.is_immersed()) continue;
    inertial_[a](piece.face) += piece.outward * flow / geometry_.area[a](piece.face);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for_faces(labels[a], s, axis, [&](Index f, Index m, Index p, Index, Index) {
      const Real delta = mobility_[a](f) * (change[m] - change[p]);
      inertial_[a](f) = delta;
      fields.superficial[a](f) += delta;
      fields.mass_flux[a](f) = fields.face_density[a](f) * geometry_.area[a](f) * fields.superficial[a](f);
    });
    copy_periodic_faces(s, axis, fields.superficial[a]);
    copy_periodic_faces(s, axis, fields.mass_flux[a]);
    copy_periodic_faces(s, axis, inertial_[a]);
    const Index step = s.face_step(axis);
    for_rows(cell_labels[a], s, [&](const Index r) {
      const Row row = s.row(r);
      const Index first = axis == 0 ? row.x_face : (axis == 1 ? row.y_face : row.z_face);
      const Real* delta = inertial_[a].data() + first;
      const Real* eps = fields.void_fraction.data() + row.cell;
      Real* u = &fields.velocity(row.cell + axis * fields.cells);
      for (Index i = 0; i < s.n.x; ++i) u[i] += 0.5 * (delta[i] + delta[i + step]) / eps[i];
    });
  }
  for_entries("cfd::face_balance::correct_pressure", fields.cells,
              [&](Index c) { fields.pressure(c) += change[c]; });
  set_boundary_velocities(geometry_, boundaries_, fields);
}

// No-slip walls and inlets: the inertial force of the cell's other face, so that the pressure goes on linearly. Walls
// without shear: none, since they mirror the flow and the normal velocity is odd across them.
void FaceBalance::set_boundary_inertia(const GasFields& fields) {
  const Stencil& s = geometry_.stencil;
  const auto behind = [&](const BoundaryPiece& piece) {
    const Index other = piece.face - static_cast<Index>(piece.outward) * s.face_step(piece.axis);
    return s.n[piece.axis] > 1 ? inertial_[static_cast<std::size_t>(piece.axis)](other) : 0;
  };
  boundaries_.groups.for_each("cfd::face_balance::boundary_inertia", [&](std::size_t b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    if (!piece.is_immersed()) inertial_[static_cast<std::size_t>(piece.axis)](piece.face) = behind(piece);
  });
  boundaries_.groups.for_each("cfd::face_balance::free_boundary_inertia", [&](std::size_t b) {
    const BoundaryPiece& piece = boundaries_.pieces[b];
    if (piece.is_immersed() || (piece.kind != PieceKind::outlet && piece.kind != PieceKind::slip)) return;
    const auto a = static_cast<std::size_t>(piece.axis);
    const Real share = piece.area / geometry_.area[a](piece.face);
    const Real base = behind(piece);
    if (piece.kind == PieceKind::slip) {
      inertial_[a](piece.face) -= share * base;
      return;
    }
    const Index c = piece.cell;
    const Real eps = fields.void_fraction(c);
    const Real gradient = (outlet_pressure(fields, b) - fields.pressure(c)) / piece.half_width;
    const Real outward = eps * (piece.outward * options_.body_force[piece.axis] - gradient) +
                         piece.outward * fields.force(c + piece.axis * fields.cells) -
                         fields.exchange_coefficient(c) / eps * fields.piece_flow[b] / piece.area;
    inertial_[a](piece.face) += share * (piece.outward * outward - base);
  });
}

void FaceBalance::compute_cell_force(const GasFields& fields, const MomentumEquation& momentum,
                                     const HostArray<Real>& force) {
  const char* labels[] = {"cfd::face_balance::inertial_x", "cfd::face_balance::inertial_y",
                          "cfd::face_balance::inertial_z"};
  const char* cell_labels[] = {"cfd::face_balance::cell_force_x", "cfd::face_balance::cell_force_y",
                               "cfd::face_balance::cell_force_z"};
  const Stencil& s = geometry_.stencil;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const AxisMetrics& metrics = geometry_.axis[a];
    const Real *density = fields.face_density[a].data(), *velocity = fields.superficial[a].data();
    // Pressure step from the minus to the plus side: -1/2 rho Delta(u^2), with the superficial velocity the same on both.
    const Real *normal_value = momentum.convection().normal_value[a].data(), *kinetic = kinetic_[a].data();
    for_faces(
        labels[a], s, axis,
        [&](Index f, Index m, Index p, Index position, Index) {
          const Real distance = metrics.distance[static_cast<std::size_t>(position)];
          jump_[a](f) = -0.5 * density[f] * velocity[f] * normal_value[f] * kinetic[f];
          inertial_[a](f) =
              void_fraction_[a](f) * ((fields.pressure(m) - fields.pressure(p) + jump_[a](f)) / distance +
                                      force_[a](f) - resistance_[a](f) * velocity[f]);
        },
        [&](Index face, Index cell) {
          const Index nx = s.n.x;
          for (const FaceField* field : {&void_fraction_, &force_, &resistance_, &jump_, &inertial_}) {
            prefetch_row((*field)[a].data() + face, nx);
          }
          for (const Real* field : {density, velocity, normal_value, kinetic}) prefetch_row(field + face, nx);
          prefetch_row(fields.pressure.data() + cell, nx);
        });
    copy_periodic_faces(s, axis, jump_[a]);
    copy_periodic_faces(s, axis, inertial_[a]);
  }
  clear_closed_faces(jump_);
  clear_closed_faces(inertial_);
  set_boundary_inertia(fields);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Index step = s.face_step(axis);
    for_rows(cell_labels[a], s, [&](const Index r) {
      const Row row = s.row(r);
      const Index first = axis == 0 ? row.x_face : (axis == 1 ? row.y_face : row.z_face);
      const Real* inertial = inertial_[a].data() + first;
      const Real* velocity = fields.superficial[a].data() + first;
      const Real* eps = fields.void_fraction.data() + row.cell;
      const Real* beta = fields.exchange_coefficient.data() + row.cell;
      const Real* volume = geometry_.volume.data() + row.cell;
      Real* out = &force(row.cell + axis * fields.cells);
      for (Index i = 0; i < s.n.x; ++i) {
        out[i] = 0.5 * volume[i] *
                 ((inertial[i] + inertial[i + step]) + beta[i] / eps[i] * (velocity[i] + velocity[i + step]));
      }
    });
  }
  block_cell_force(fields, force);
}

// Beside a face that a surface closes a cell has the inertial force of its other face, as beside a wall of the domain.
void FaceBalance::block_cell_force(const GasFields& fields, const HostArray<Real>& force) const {
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Index step = geometry_.stencil.face_step(axis);
    for (const BlockedCell& blocked : geometry_.blocked[a]) {
      const Index c = blocked.cell;
      Real inertial = 0;
      Real velocity = 0;
      if (blocked.minus_open || blocked.plus_open) {
        const Index open = blocked.face + (blocked.plus_open ? step : 0);
        inertial = 2 * inertial_[a](open);
        velocity = fields.superficial[a](open);
      }
      force(c + axis * fields.cells) =
          0.5 * geometry_.volume(c) *
          (inertial + fields.exchange_coefficient(c) / fields.void_fraction(c) * velocity);
    }
  }
}

// Gradient in the half of a cell that ends at a face: inertia, drag and force of the gas there hold it up.
Real FaceBalance::gradient_from(const GasFields& fields, Index c, int axis, Real inertial,
                                Real velocity) const {
  const Real eps = fields.void_fraction(c);
  return options_.body_force[axis] + (fields.force(c + axis * fields.cells) - inertial -
                                      fields.exchange_coefficient(c) / eps * velocity) /
                                         eps;
}

Real FaceBalance::side_gradient(const GasFields& fields, Index c, int axis, Index f) const {
  const auto a = static_cast<std::size_t>(axis);
  return gradient_from(fields, c, axis, inertial_[a](f), fields.superficial[a](f));
}

// Of both halves of a cell beside a closed face.
std::array<Real, 2> FaceBalance::side_gradients(const GasFields& fields, const BlockedCell& blocked,
                                                int axis) const {
  const auto a = static_cast<std::size_t>(axis);
  const Index step = geometry_.stencil.face_step(axis);
  const bool any = blocked.minus_open || blocked.plus_open;
  const Real inertial = any ? inertial_[a](blocked.face + (blocked.plus_open ? step : 0)) : 0;
  const auto side = [&](bool open, Index face) {
    return gradient_from(fields, blocked.cell, axis, inertial, open ? fields.superficial[a](face) : 0);
  };
  return {side(blocked.minus_open, blocked.face), side(blocked.plus_open, blocked.face + step)};
}

void FaceBalance::compute_pressure_gradient(const GasFields& fields, const HostArray<Vec3>& gradient) const {
  const Stencil& s = geometry_.stencil;
  const Index n = s.cells();
  const Index nx = s.n.x;
  const Real *eps = fields.void_fraction.data(), *beta = fields.exchange_coefficient.data();
  constexpr Index part = 64;  // cells of a row at a time
  for_rows("cfd::face_balance::pressure_gradient", s, [&](const Index r) {
    const Row row = s.row(r);
    for (Index begin = 0; begin < nx; begin += part) {
      const Index count = std::min(part, nx - begin);
      const Index cell = row.cell + begin;
      Real found[3][part];
      Real around[part + 2];  // void fraction along the row, with the neighbours of its ends
      for (Index i = 0; i < count; ++i) around[i + 1] = eps[cell + i];
      around[0] = eps[row.cell + (begin > 0 ? begin - 1 : row.before_first)];
      around[count + 1] = eps[row.cell + (begin + count < nx ? begin + count : row.after_last)];
      prefetch_row(beta + cell + nx, count);
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const Index step = s.face_step(axis);
        const Index face = (axis == 0 ? row.x_face : (axis == 1 ? row.y_face : row.z_face)) + begin;
        const Real* minus = axis == 0 ? around : eps + begin + (axis == 1 ? row.y_minus : row.z_minus);
        const Real* plus = axis == 0 ? around + 2 : eps + begin + (axis == 1 ? row.y_plus : row.z_plus);
        const Real *jump = jump_[a].data() + face, *inertial = inertial_[a].data() + face;
        const Real *velocity = fields.superficial[a].data() + face, *drag = beta + cell;
        const Real* force = fields.force.data() + static_cast<std::ptrdiff_t>(axis) * n + cell;
        const Real body = options_.body_force[axis];
        const Real* width = geometry_.axis[a].width.data();
        const Index along = axis == 0 ? begin : (axis == 1 ? row.j : row.k);
        for (const Real* field : {jump, inertial, velocity}) prefetch_row(field + nx + step, count);
        prefetch_row(force + nx, count);
        Real* out = found[axis];
        for (Index i = 0; i < count; ++i) {
          const Real own = around[i + 1];
          // The step of the convective acceleration is shared so that the gas loses what its momentum flux, the mean of
          // both sides', gains: eps_P J eps_N / (eps_P + eps_N) on each side.
          const Real jumps =
              jump[i] * minus[i] / (own + minus[i]) + jump[i + step] * plus[i] / (own + plus[i]);
          const Real held =
              inertial[i] + inertial[i + step] + drag[i] / own * (velocity[i] + velocity[i + step]);
          out[i] = body + (force[i] - 0.5 * held) / own + jumps / width[axis == 0 ? along + i : along];
        }
      }
      for (Index i = 0; i < count; ++i) gradient(cell + i) = {found[0][i], found[1][i], found[2][i]};
    }
  });
  // The same with both sides' gradients as they are beside closed faces, whose jump is 0.
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Index step = s.face_step(axis);
    for (const BlockedCell& blocked : geometry_.blocked[a]) {
      const auto [minus, plus] = side_gradients(fields, blocked, axis);
      Real& held = gradient(blocked.cell)[axis];
      held += 0.5 * (minus - side_gradient(fields, blocked.cell, axis, blocked.face));
      held += 0.5 * (plus - side_gradient(fields, blocked.cell, axis, blocked.face + step));
    }
  }
}

// -V grad p of the cell and the pressures on its faces belong together as in a whole cell, where the areas are the same
// on both sides and nothing is left.
Vec3 FaceBalance::surface_pressure_force(const GasFields& fields, Index c) const {
  const Stencil& s = geometry_.stencil;
  const Index3 at = geometry_.grid.coordinates(c);
  Vec3 force{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Index minus = s.face(axis, at.x, at.y, at.z);
    const Index plus = minus + s.face_step(axis);
    const Real half = 0.5 * geometry_.grid.width(axis, at[axis]);
    std::array<Real, 2> side{side_gradient(fields, c, axis, minus), side_gradient(fields, c, axis, plus)};
    const auto& cells = geometry_.blocked[a];
    const auto found = std::lower_bound(cells.begin(), cells.end(), c,
                                        [](const BlockedCell& b, Index cell) { return b.cell < cell; });
    if (found != cells.end() && found->cell == c) side = side_gradients(fields, *found, axis);
    const Real p = fields.pressure(c);
    force[axis] = geometry_.area[a](plus) * (p + half * side[1]) -
                  geometry_.area[a](minus) * (p - half * side[0]) -
                  0.5 * geometry_.volume(c) * (side[0] + side[1]);
    // Steps of the convective acceleration (compute_pressure_gradient) act on the gas over the open area of a face, on
    // particles over the cell's width: in a cut cell what these are short of stays with the wall.
    const Real mean_area = 0.5 * geometry_.volume(c) / half;
    const Real own = fields.void_fraction(c);
    const auto add_step = [&](Index face, Index neighbour) {
      const Real other = fields.void_fraction(neighbour);
      force[axis] +=
          (1 - own) * (geometry_.area[a](face) - mean_area) * jump_[a](face) * other / (own + other);
    };
    const Index last = s.n[axis] - 1, around = last * s.stride(axis);
    if (at[axis] > 0 || s.periodic[a]) add_step(minus, at[axis] > 0 ? c - s.stride(axis) : c + around);
    if (at[axis] < last || s.periodic[a]) add_step(plus, at[axis] < last ? c + s.stride(axis) : c - around);
  }
  return force;
}

Real FaceBalance::boundary_pressure(const GasFields& fields, std::size_t b) const {
  const BoundaryPiece& piece = boundaries_.pieces[b];
  return fields.pressure(piece.cell) +
         piece.outward * piece.half_width * side_gradient(fields, piece.cell, piece.axis, piece.face);
}

}  // namespace pellicle::cfd
