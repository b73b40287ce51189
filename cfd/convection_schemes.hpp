// Face values of a convected quantity.
#pragma once

#include <algorithm>
#include <cmath>

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

}  // namespace pellicle::cfd
