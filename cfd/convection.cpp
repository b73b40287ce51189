#include "cfd/convection.hpp"

#include "cfd/convection_schemes.hpp"
#include "cfd/field_memory.hpp"

namespace pellicle::cfd {

ConvectionCorrection::ConvectionCorrection(const FlowGeometry& geometry)
    : normal_value(make_face_field(geometry.stencil, "cfd::convection::normal_value")) {
  const char* labels[] = {"cfd::convection::momentum_flux/x", "cfd::convection::momentum_flux/y",
                          "cfd::convection::momentum_flux/z"};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto faces = static_cast<std::size_t>(geometry.stencil.faces(static_cast<int>(a)));
    momentum_flux[a] = make_field<Real>(labels[a], 3 * faces);
  }
}

namespace {

template <Convection scheme>
void compute(const char* label, int axis, const FlowGeometry& geometry, const Boundaries& boundaries,
             const GasFields& fields, const ConvectionCorrection& result) {
  const Stencil& s = geometry.stencil;
  const auto ua = static_cast<std::size_t>(axis);
  const Index faces = s.faces(axis);
  const Index cells = fields.cells;
  const Real* u = fields.velocity.data();
  const Real* eps = fields.void_fraction.data();
  const Real* flux = fields.mass_flux[ua].data();
  Real* correction = result.momentum_flux[ua].data();
  Real* normal_value = result.normal_value[ua].data();
  for_faces(label, s, axis, [&](Index f, Index minus, Index plus, Index position, Index place) {
    const bool forward = flux[f] >= 0;
    if constexpr (scheme == Convection::upwind) {
      const Index central = forward ? minus : plus;
      normal_value[f] = eps[central] * u[central + axis * cells];
      return;
    }
    const FaceNeighbours near = find_neighbours(geometry, axis, forward, f, minus, plus, position);
    const BoundaryValue* boundary = nullptr;
    if (near.beyond && !near.blocked)
      boundary = &boundaries.values[2 * ua + (forward ? 0 : 1)][static_cast<std::size_t>(place)];
    for (int a = 0; a < 3; ++a) {
      const Index shift = a * cells;
      const bool normal = a == axis;
      const auto value = [&](Index c) { return normal ? eps[c] * u[c + shift] : u[c + shift]; };
      const Real central = value(near.central);
      const Real face =
          face_value<scheme>(central, value(near.downstream), near.linear_central, *near.quick, [&] {
            if (near.blocked) return Upstream{central, true};
            return boundary ? Upstream{2 * (boundary->fixed[a] + boundary->free[a] * central) - central, true}
                            : Upstream{value(near.upstream), false};
          });
      correction[f + a * faces] = flux[f] * (face - central);
      if (normal) normal_value[f] = face;
    }
  });
  copy_periodic_faces(s, axis, result.normal_value[ua]);
  if (scheme != Convection::upwind) {
    for (int a = 0; a < 3; ++a) {
      const auto part =
          Kokkos::subview(result.momentum_flux[ua], Kokkos::pair<Index, Index>(a * faces, (a + 1) * faces));
      copy_periodic_faces(s, axis, part);
    }
  }
}

template <Convection scheme>
void compute_all(const FlowGeometry& geometry, const Boundaries& boundaries, const GasFields& fields,
                 const ConvectionCorrection& result) {
  compute<scheme>("cfd::convection::x", 0, geometry, boundaries, fields, result);
  compute<scheme>("cfd::convection::y", 1, geometry, boundaries, fields, result);
  compute<scheme>("cfd::convection::z", 2, geometry, boundaries, fields, result);
}

}  // namespace

void compute_convection_correction(const FlowGeometry& geometry, const Boundaries& boundaries,
                                   Convection scheme, const GasFields& fields,
                                   const ConvectionCorrection& result) {
  switch (scheme) {
    case Convection::upwind:
      compute_all<Convection::upwind>(geometry, boundaries, fields, result);
      break;
    case Convection::ultimate_quickest:
      compute_all<Convection::ultimate_quickest>(geometry, boundaries, fields, result);
      break;
    case Convection::central:
      compute_all<Convection::central>(geometry, boundaries, fields, result);
      break;
    case Convection::quick:
      compute_all<Convection::quick>(geometry, boundaries, fields, result);
      break;
  }
}

}  // namespace pellicle::cfd
