#include "cfd/convection.hpp"

#include "cfd/convection_schemes.hpp"

namespace pellicle::cfd {

ConvectionCorrection::ConvectionCorrection(const FlowGeometry& geometry)
    : normal_value(make_face_field(geometry.stencil, "cfd::convection::normal_value")) {
  const char* labels[] = {"cfd::convection::momentum_flux/x", "cfd::convection::momentum_flux/y",
                          "cfd::convection::momentum_flux/z"};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto faces = static_cast<std::size_t>(geometry.stencil.faces(static_cast<int>(a)));
    momentum_flux[a] = HostArray<Real>(labels[a], 3 * faces);
  }
}

namespace {

template <Convection scheme>
void compute(const char* label, int axis, const FlowGeometry& geometry, const Boundaries& boundaries,
             const GasFields& fields, const ConvectionCorrection& result) {
  const Stencil& s = geometry.stencil;
  const auto ua = static_cast<std::size_t>(axis);
  const AxisMetrics& metrics = geometry.axis[ua];
  const bool periodic = s.periodic[ua];
  const Index n = s.n[axis];
  const Index stride = s.stride(axis);
  const Index faces = s.faces(axis);
  const Index cells = fields.cells;
  const Real* u = fields.velocity.data();
  const Real* eps = fields.void_fraction.data();
  const Real* flux = fields.mass_flux[ua].data();
  Real* correction = result.momentum_flux[ua].data();
  Real* normal_value = result.normal_value[ua].data();
  for_faces(label, s, axis, [&](Index f, Index minus, Index plus, Index position, Index place) {
    const bool forward = flux[f] >= 0;
    const Index central = forward ? minus : plus;
    const Index downstream = forward ? plus : minus;
    if constexpr (scheme == Convection::upwind) {
      normal_value[f] = eps[central] * u[central + axis * cells];
      return;
    }
    const auto at = static_cast<std::size_t>(position);
    const Real linear_central = forward ? metrics.linear_minus[at] : 1 - metrics.linear_minus[at];
    const auto& quick = forward ? metrics.quick_forward[at] : metrics.quick_backward[at];
    Index upstream_position = forward ? position - 2 : position + 1;
    const bool inside = upstream_position >= 0 && upstream_position < n;
    if (periodic) upstream_position = (upstream_position + 2 * n) % n;
    const Index upstream = plus + (upstream_position - position) * stride;
    const BoundaryValue* boundary = nullptr;
    if (!inside && !periodic) {
      boundary = &boundaries.values[2 * ua + (forward ? 0 : 1)][static_cast<std::size_t>(place)];
    }
    for (int a = 0; a < 3; ++a) {
      const Index shift = a * cells;
      const bool normal = a == axis;
      const auto value = [&](Index c) { return normal ? eps[c] * u[c + shift] : u[c + shift]; };
      const Real phi_c = value(central);
      const Real phi_d = value(downstream);
      Real face = linear_central * phi_c + (1 - linear_central) * phi_d;
      if constexpr (scheme != Convection::central) {
        Real phi_u = 0;
        if (boundary) {
          // The upstream cell would lie beyond the boundary: linear, limited with the value mirrored there.
          phi_u = 2 * (boundary->fixed[a] + boundary->free[a] * phi_c) - phi_c;
        } else {
          phi_u = value(upstream);
          face = quick[0] * phi_u + quick[1] * phi_c + quick[2] * phi_d;
        }
        if constexpr (scheme == Convection::ultimate_quickest)
          face = ultimate_limit(face, phi_u, phi_c, phi_d);
      }
      correction[f + a * faces] = flux[f] * (face - phi_c);
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
