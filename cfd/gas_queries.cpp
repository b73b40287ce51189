// What others ask the gas solver.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cfd/gas_solver_impl.hpp"

namespace pellicle::cfd {

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

std::array<Vec3, 6> GasSolver::side_forces() const {
  const Impl& s = *impl_;
  std::array<Vec3, 6> total{};
  for (std::size_t b = 0; b < s.boundaries.pieces.size(); ++b) {
    const BoundaryPiece& piece = s.boundaries.pieces[b];
    if (piece.is_immersed() || piece.kind == PieceKind::inlet || piece.kind == PieceKind::outlet) continue;
    const bool mirrors = piece.patch >= 0 && std::holds_alternative<Symmetry>(
                                                 s.patches[static_cast<std::size_t>(piece.patch)].kind);
    if (mirrors) continue;
    Vec3& own = total[side_number(piece.axis, piece.outward)];
    own -= s.momentum.shear_force(s.fields, b);
    own[piece.axis] += piece.outward * piece.area * s.faces.boundary_pressure(s.fields, b);
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

void GasSolver::drop_solver_hierarchies() {
  impl_->pressure_solver.drop();
  impl_->still_steps = 0;
}

}  // namespace pellicle::cfd
