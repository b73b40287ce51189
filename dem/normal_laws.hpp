// Normal forces of a contact: stateless functions of scalars.
#pragma once

#include "core/model_list.hpp"
#include "dem/contact_state.hpp"

namespace pellicle::dem {

/// Hertz with viscous damping, F_n = (4/3) E* √R* δ^(3/2) + 2√(5/6) Λ √(S_n m*) v_n, S_n = 2 E* √(R* δ), clipped at
/// zero unless `clip` is off (PHYSICS.md 3; T 2.8-2.10).
struct Hertz {
  static constexpr core::ModelInfo info{"hertz",
                                        "Hertz spring, damping for a restitution that holds at any speed",
                                        "Hertz 1882; Tsuji et al. 1992; thesis eq. 2.8-2.10"};

  bool clip = true;

  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION NormalForceOf<Number> operator()(
      const ContactStateOf<Number>& c, const Same<PairParametersOf<Number>>& p) const {
    constexpr auto damping_factor = Number(1.8257418583505538);  // 2 √(5/6)
    const Number stiffness = 2 * p.effective_youngs_modulus * Kokkos::sqrt(c.reduced_radius * c.overlap);
    const Number root = Kokkos::sqrt(stiffness * c.reduced_mass);
    const Number damping = damping_factor * p.damping_ratio * root;
    // (4/3) E* √R* δ^(3/2) = (2/3) S_n δ
    const Number force = Number(2.0 / 3.0) * stiffness * c.overlap + damping * c.approach_speed;
    return {clip && force < 0 ? Number(0) : force, root, stiffness, damping};
  }
};

/// Linear spring with viscous damping, F_n = k δ + 2 Λ √(k m*) v_n, clipped at zero unless `clip` is off; Λ as for
/// Hertz (PHYSICS.md 3; Cundall & Strack, Géotechnique 29 (1979) 47).
struct Linear {
  static constexpr core::ModelInfo info{
      "linear", "linear spring of a given stiffness, damping for the restitution", "Cundall & Strack 1979"};

  bool clip = true;

  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION NormalForceOf<Number> operator()(
      const ContactStateOf<Number>& c, const Same<PairParametersOf<Number>>& p) const {
    const Number stiffness = p.normal_stiffness;
    const Number root = Kokkos::sqrt(stiffness * c.reduced_mass);
    const Number damping = 2 * p.damping_ratio * root;
    const Number force = stiffness * c.overlap + damping * c.approach_speed;
    return {clip && force < 0 ? Number(0) : force, root, stiffness, damping};
  }
};

}  // namespace pellicle::dem
