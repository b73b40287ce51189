#include "cfd/velocity_gradient.hpp"

namespace pellicle::cfd {

namespace {

// Component a of the velocity on the face of a boundary, as the cell beside it sees it.
Real boundary_velocity(const Boundaries& boundaries, const GasFields& fields, std::size_t side, Index place,
                       int axis, int a, Index c) {
  const BoundaryValue& value = boundaries.values[side][static_cast<std::size_t>(place)];
  // The given velocity through a boundary is superficial.
  const Real fixed = a == axis ? value.fixed[a] / fields.void_fraction(c) : value.fixed[a];
  return fixed + value.free[a] * fields.velocity(c + a * fields.cells);
}

}  // namespace

void compute_velocity_gradient(const FlowGeometry& geometry, const Boundaries& boundaries,
                               const GasFields& fields) {
  const Stencil& s = geometry.stencil;
  const Index n = fields.cells;
  for_rows("cfd::velocity_gradient::rows", s, [&](const Index r) {
    const Row row = s.row(r);
    const Index first_face[3] = {row.x_face, row.y_face, row.z_face};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const AxisMetrics& metrics = geometry.axis[a];
      const Index minus_row = axis == 1 ? row.y_minus : (axis == 2 ? row.z_minus : row.cell);
      const Index plus_row = axis == 1 ? row.y_plus : (axis == 2 ? row.z_plus : row.cell);
      along_row(row, s.n.x, [&](Index i, Index left, Index right) {
        const Index c = row.cell + i;
        const Index position = axis == 0 ? i : (axis == 1 ? row.j : row.k);
        const Index place = s.plane_index(axis, i, row.j, row.k);
        const Index f = first_face[axis] + i;
        const bool open[2] = {geometry.area[a](f) > 0, geometry.area[a](f + s.face_step(axis)) > 0};
        const Index beyond[2] = {minus_row + (axis == 0 ? left : i), plus_row + (axis == 0 ? right : i)};
        const bool at_end[2] = {position == 0, position == s.n[axis] - 1};
        const Real width = metrics.width[static_cast<std::size_t>(position)];
        for (int b = 0; b < 3; ++b) {
          const Real* u = &fields.velocity(b * n);
          Real change = 0;
          int halves = 0;
          for (std::size_t side = 0; side < 2; ++side) {
            if (!open[side]) continue;
            Real face = 0;
            if (at_end[side] && !s.periodic[a]) {
              face = boundary_velocity(boundaries, fields, 2 * a + side, place, axis, b, c);
            } else {
              const Real w = metrics.linear_minus[static_cast<std::size_t>(position) + side];
              const Real own = side == 0 ? 1 - w : w;
              face = own * u[c] + (1 - own) * u[beyond[side]];
            }
            change += side == 0 ? u[c] - face : face - u[c];
            ++halves;
          }
          fields.velocity_gradient(c + (3 * axis + b) * n) =
              halves == 0 ? 0 : change / (0.5 * halves * width);
        }
      });
    }
  });
}

void add_transposed_stress(const FlowGeometry& geometry, const Boundaries& boundaries,
                           const GasFields& fields, const FaceField& conductance,
                           const HostArray<Real>& source, std::vector<Vec3>& piece_force) {
  const Stencil& s = geometry.stencil;
  const Index n = fields.cells;
  const Real* g = fields.velocity_gradient.data();
  // d u_axis / d x_b less a third of the dilatation for the component along the axis, twice.
  const auto stress = [&](Index c, int axis, int b) {
    Real value = g[c + (3 * b + axis) * n];
    if (b == axis) value -= (2.0 / 3) * (g[c] + g[c + 4 * n] + g[c + 8 * n]);
    return value;
  };
  for_rows("cfd::velocity_gradient::stress", s, [&](const Index r) {
    const Row row = s.row(r);
    const Index first_face[3] = {row.x_face, row.y_face, row.z_face};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Index minus_row = axis == 1 ? row.y_minus : (axis == 2 ? row.z_minus : row.cell);
      const Index plus_row = axis == 1 ? row.y_plus : (axis == 2 ? row.z_plus : row.cell);
      along_row(row, s.n.x, [&](Index i, Index left, Index right) {
        const Index c = row.cell + i;
        const auto position = static_cast<std::size_t>(axis == 0 ? i : (axis == 1 ? row.j : row.k));
        const Index minus = first_face[axis] + i;
        const Index plus = minus + s.face_step(axis);
        const Index before = minus_row + (axis == 0 ? left : i);
        const Index after = plus_row + (axis == 0 ? right : i);
        // The conductance of boundary faces and of closed ones is 0.
        const Real pull_minus = conductance[a](minus) * geometry.distance[a](minus);
        const Real pull_plus = conductance[a](plus) * geometry.distance[a](plus);
        const Real wm = geometry.axis[a].linear_minus[position];
        const Real wp = geometry.axis[a].linear_minus[position + 1];
        for (int b = 0; b < 3; ++b) {
          const Real own = stress(c, axis, b);
          const Real at_minus =
              pull_minus == 0 ? 0 : pull_minus * (wm * stress(before, axis, b) + (1 - wm) * own);
          const Real at_plus =
              pull_plus == 0 ? 0 : pull_plus * (wp * own + (1 - wp) * stress(after, axis, b));
          source(c + b * n) += at_plus - at_minus;
        }
      });
    }
  });
  for (std::size_t k = 0; k < boundaries.pieces.size(); ++k) {
    const BoundaryPiece& piece = boundaries.pieces[k];
    piece_force[k] = {};
    if (piece.is_immersed() || (piece.kind != PieceKind::outlet && piece.kind != PieceKind::slip)) continue;
    const Index c = piece.cell;
    const Real pull = piece.outward * fields.viscosity(c) * fields.void_fraction(c) * piece.area;
    for (int b = 0; b < 3; ++b) {
      if (piece.kind == PieceKind::slip && b != piece.axis) continue;
      piece_force[k][b] = pull * stress(c, piece.axis, b);
      source(c + b * n) += piece_force[k][b];
    }
  }
}

}  // namespace pellicle::cfd
