// Heat and mass transfer between a sphere and the gas around it: Nusselt and Sherwood numbers as stateless functions.
//
// One law serves both: the Sherwood number is the Nusselt number with the Schmidt number in the place of the Prandtl
// number, in every term; so the powers of Re serve both. (The thesis prints Prandtl in the first term of Gunn's Sherwood number, eq. 2.21: not followed.)
#pragma once

#include <Kokkos_Core.hpp>

#include <variant>

#include "core/model_list.hpp"
#include "core/model_variant.hpp"
#include "core/types.hpp"

namespace pellicle::heat {

/// A law at the void fraction and Reynolds number of one particle: Nu = still + stirred Pr^(1/3), and Sh likewise with Sc.
struct TransferLine {
  Real still, stirred;
};

/// Gunn, Int. J. Heat Mass Transfer 21 (1978) 467 (thesis eq. 2.14): fixed and fluidised beds, void fractions from 0.35
/// to 1, Re up to 1e5.
struct Gunn {
  static constexpr core::ModelInfo info{"gunn", "Gunn: particles in beds, void fraction 0.35 to 1",
                                        "Gunn, Int. J. Heat Mass Transfer 21 (1978) 467"};
  /// Powers are taken in the precision of `reynolds`.
  template <class Number>
  KOKKOS_INLINE_FUNCTION TransferLine operator()(Real void_fraction, Number reynolds) const {
    const Real eps = void_fraction;
    const Number fifth = Kokkos::pow(reynolds, Number(0.2));
    const Number seven_tenths = fifth * Kokkos::sqrt(reynolds);
    const Real still = 7 - 10 * eps + 5 * eps * eps;
    return {still, still * 0.7 * static_cast<Real>(fifth) +
                       (1.33 - 2.4 * eps + 1.2 * eps * eps) * static_cast<Real>(seven_tenths)};
  }
};

/// Ranz & Marshall, Chem. Eng. Progr. 48 (1952) 141: a lone sphere, whatever the void fraction.
struct RanzMarshall {
  static constexpr core::ModelInfo info{"ranz_marshall", "Ranz & Marshall: lone sphere",
                                        "Ranz & Marshall, Chem. Eng. Progr. 48 (1952) 141"};
  template <class Number>
  KOKKOS_INLINE_FUNCTION TransferLine operator()(Real, Number reynolds) const {
    return {2, 0.6 * static_cast<Real>(Kokkos::sqrt(reynolds))};
  }
};

/// The family: what `heat.nusselt` and `heat.sherwood` may name. A new law is a struct above and an entry here.
using TransferLaw = std::variant<Gunn, RanzMarshall>;

/// The law at a position of the family's list. Re = gas density x void fraction x slip speed x diameter / viscosity, in
/// the precision that powers are to have: single costs half, and 1e-7 of the number.
template <class Number, std::size_t I = 0>
KOKKOS_INLINE_FUNCTION TransferLine transfer_line(int law, Real void_fraction, Number reynolds) {
  if constexpr (I < std::variant_size_v<TransferLaw>) {
    if (static_cast<int>(I) == law)
      return std::variant_alternative_t<I, TransferLaw>{}(void_fraction, reynolds);
    return transfer_line<Number, I + 1>(law, void_fraction, reynolds);
  } else {
    return {0, 0};
  }
}

/// Pr^(1/3) or Sc^(1/3) to 1e-7.
KOKKOS_INLINE_FUNCTION Real cube_root(Real ratio) {
  return static_cast<Real>(Kokkos::pow(static_cast<float>(ratio), 1.0F / 3));
}

}  // namespace pellicle::heat
