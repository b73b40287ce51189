// Heat and mass transfer between a sphere and the gas around it: Nusselt and Sherwood numbers as stateless functions.
//
// One law serves both: the Sherwood number is the Nusselt number with the Schmidt number in the place of the Prandtl
// number, in every term. (The thesis prints Prandtl in the first term of Gunn's Sherwood number, eq. 2.21: not followed.)
#pragma once

#include <Kokkos_Core.hpp>

#include <variant>

#include "core/model_list.hpp"
#include "core/model_variant.hpp"
#include "core/types.hpp"

namespace pellicle::heat {

/// What of the flow around one particle the laws depend on.
struct TransferFlow {
  Real void_fraction;  ///< of the gas around the particle, in (0, 1]
  Real reynolds;       ///< superficial: gas density x void fraction x slip speed x diameter / viscosity
  Real prandtl;        ///< mu c_p / k of the gas for heat, mu / (rho D) for vapour
};

/// Gunn, Int. J. Heat Mass Transfer 21 (1978) 467 (thesis eq. 2.14): fixed and fluidised beds, void fractions from 0.35
/// to 1, Re up to 1e5.
struct Gunn {
  static constexpr core::ModelInfo info{"gunn", "Gunn: particles in beds, void fraction 0.35 to 1",
                                        "Gunn, Int. J. Heat Mass Transfer 21 (1978) 467"};
  KOKKOS_INLINE_FUNCTION Real operator()(const TransferFlow& f) const {
    const Real eps = f.void_fraction;
    const Real cube_root = Kokkos::cbrt(f.prandtl);
    return (7 - 10 * eps + 5 * eps * eps) * (1 + 0.7 * Kokkos::pow(f.reynolds, 0.2) * cube_root) +
           (1.33 - 2.4 * eps + 1.2 * eps * eps) * Kokkos::pow(f.reynolds, 0.7) * cube_root;
  }
};

/// Ranz & Marshall, Chem. Eng. Progr. 48 (1952) 141: a lone sphere, whatever the void fraction.
struct RanzMarshall {
  static constexpr core::ModelInfo info{"ranz_marshall", "Ranz & Marshall: lone sphere",
                                        "Ranz & Marshall, Chem. Eng. Progr. 48 (1952) 141"};
  KOKKOS_INLINE_FUNCTION Real operator()(const TransferFlow& f) const {
    return 2 + 0.6 * Kokkos::sqrt(f.reynolds) * Kokkos::cbrt(f.prandtl);
  }
};

/// The family: what `heat.nusselt` and `heat.sherwood` may name. A new law is a struct above and an entry here.
using TransferLaw = std::variant<Gunn, RanzMarshall>;

/// The number by the law at a position of the family's list.
template <std::size_t I = 0>
KOKKOS_INLINE_FUNCTION Real transfer_number(int law, const TransferFlow& f) {
  if constexpr (I < std::variant_size_v<TransferLaw>) {
    if (static_cast<int>(I) == law) return std::variant_alternative_t<I, TransferLaw>{}(f);
    return transfer_number<I + 1>(law, f);
  } else {
    return 0;
  }
}

}  // namespace pellicle::heat
