// Face values of a convected quantity.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "cfd/flow_geometry.hpp"
#include "cfd/gas_options.hpp"
#include "core/types.hpp"

namespace pellicle::cfd {

/// Steepest allowed (phi_f - phi_U) / (phi_C - phi_U). In Leonard's ULTIMATE limiter this is 1 / Courant number, which
/// has no place in an implicit step; 3 is the slope of Gaskell & Lau (Int. J. Numer. Methods Fluids 8 (1988) 617).
inline constexpr Real ultimate_slope = 3;

/// ULTIMATE limiter (Leonard, Comput. Methods Appl. Mech. Eng. 88 (1991) 17): where upstream, central, downstream is
/// monotone, the face value stays between central and downstream and below the slope; elsewhere it is the upwind one.
inline Real ultimate_limit(Real face, Real upstream, Real central, Real downstream) {
  const Real ahead = downstream - central;
  const Real behind = central - upstream;
  if (!(ahead * behind > 0)) return central;
  const Real limit = std::min(std::abs(ahead), (ultimate_slope - 1) * std::abs(behind));
  const Real step = ahead > 0 ? face - central : central - face;
  const Real bounded = std::clamp(step, Real{0}, limit);
  return ahead > 0 ? central + bounded : central - bounded;
}

/// Where the value upstream of a face comes from.
struct Upstream {
  Real value =
      0;  ///< of the upstream cell; where that would lie beyond a boundary, the boundary value mirrored there
  bool beyond = false;  ///< it would lie there: linear in place of quadratic interpolation
};

/// Value at a face. `linear_central`: weight of the central cell in linear interpolation; `quick`: weights of the
/// upstream, central and downstream cell; upstream(): only called where the scheme needs it.
template <Convection scheme, class GetUpstream>
inline Real face_value(Real central, Real downstream, Real linear_central, const std::array<Real, 3>& quick,
                       GetUpstream&& upstream) {
  if constexpr (scheme == Convection::upwind) return central;
  Real face = linear_central * central + (1 - linear_central) * downstream;
  if constexpr (scheme != Convection::central) {
    const Upstream up = upstream();
    if (!up.beyond) face = quick[0] * up.value + quick[1] * central + quick[2] * downstream;
    if constexpr (scheme == Convection::ultimate_quickest)
      face = ultimate_limit(face, up.value, central, downstream);
  }
  return face;
}

/// The cells on both sides of a face as the flow sees them.
struct FaceNeighbours {
  Index central, downstream;
  Index upstream;  ///< of no meaning if beyond
  bool beyond;     ///< the upstream cell would lie beyond a boundary of the domain or a surface within it
  bool blocked;    ///< beyond a surface within it
  Real linear_central;
  const std::array<Real, 3>* quick;
};

/// For face f between cells minus and plus, at a position along the axis, with the flow along +axis or against it.
inline FaceNeighbours find_neighbours(const FlowGeometry& geometry, int axis, bool forward, Index f,
                                      Index minus, Index plus, Index position) {
  const Stencil& s = geometry.stencil;
  const AxisMetrics& metrics = geometry.axis[static_cast<std::size_t>(axis)];
  const auto at = static_cast<std::size_t>(position);
  const Index n = s.n[axis];
  FaceNeighbours result{};
  result.central = forward ? minus : plus;
  result.downstream = forward ? plus : minus;
  result.linear_central = forward ? metrics.linear_minus[at] : 1 - metrics.linear_minus[at];
  result.quick = forward ? &metrics.quick_forward[at] : &metrics.quick_backward[at];
  Index upstream_position = forward ? position - 2 : position + 1;
  const bool periodic = s.periodic[static_cast<std::size_t>(axis)];
  result.beyond = !periodic && (upstream_position < 0 || upstream_position >= n);
  if (periodic) upstream_position = (upstream_position + 2 * n) % n;
  result.upstream = plus + (upstream_position - position) * s.stride(axis);
  if (geometry.is_cut && !result.beyond) {
    Index upstream_face = forward ? position - 1 : position + 1;
    if (periodic) upstream_face = (upstream_face + n) % n;
    result.blocked = geometry.closed(axis, f + (upstream_face - position) * s.face_step(axis));
    result.beyond = result.blocked;
  }
  return result;
}

}  // namespace pellicle::cfd
