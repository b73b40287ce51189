// Resistance of a contact to rolling: stateless functions of scalars and vectors.
#pragma once

#include "core/model_list.hpp"
#include "dem/contact_state.hpp"
#include "dem/friction_laws.hpp"

namespace pellicle::dem {

/// The rolling torque on a body, and its spring as the next step finds it.
template <class Number>
struct SpringTorqueOf {
  Vector3<Number> torque;  ///< [N m]
  Vec3 spring;             ///< [rad]
};

using SpringTorque = SpringTorqueOf<Real>;

/// No rolling resistance.
struct NoRolling {
  static constexpr core::ModelInfo info{"none", "no rolling resistance", "-"};
  static constexpr bool active = false;
  static constexpr bool has_spring = false;
  static constexpr bool needs_compliance = false;

  Real time_step = 0;
};

/// M_r = −µ_r R* F_n ω_rel/|ω_rel| (PHYSICS.md 3; T 2.12), never so much that it reverses the relative spin within a
/// step, the stopping torque shared among the contacts of the two particles.
struct ConstantTorque {
  static constexpr core::ModelInfo info{"constant_torque",
                                        "constant directional torque, ratio to the reduced radius R*",
                                        "Zhou et al. 1999; thesis eq. 2.12"};
  static constexpr bool active = true;
  static constexpr bool has_spring = false;
  static constexpr bool needs_compliance = true;

  Real time_step = 0;  ///< particle step [s]

  /// Factor k of M_r = −k ω_rel [N m s]. `spin_compliance` is Σ n/I over the two particles [1/(kg m²)], n ≥ 1 the number
  /// of contacts of each: the torque that stops ω_rel if all n act alike is |ω_rel|/(Δt Σ n/I). Two thirds of it are
  /// allowed: the motion (dem/motion.hpp) sees a spin predicted with half a step of the last torque, so that a cap c
  /// gives ω' = (1 − 3c/2) ω + (c/2) ω_before, which changes sign for c > 2/3 and no longer decays at c = 1.
  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION Number operator()(const ContactStateOf<Number>& c, Same<Number> normal_force,
                                                Same<Number> relative_spin, Same<Number> spin_compliance,
                                                const Same<PairParametersOf<Number>>& p) const {
    const Number torque =
        p.rolling_friction * c.reduced_radius * (normal_force > 0 ? normal_force : Number(0));
    const Number steady = torque / (relative_spin + tiny<Number>);
    const Number stopping = Number(2.0 / 3.0) / (Number(time_step) * spin_compliance + tiny<Number>);
    return steady < stopping ? steady : stopping;
  }
};

/// M_r = −k_r θ, at most µ_r R* F_n; θ the relative rotation across the normal since the contact began, no longer than
/// what µ_r R* F_n bears, k_r = S_t R*² (PHYSICS.md 3; the elastic-plastic model C of Ai et al., Powder Technol. 206
/// (2011) 269, with the stiffness of Iwashita & Oda 1998 and no dashpot: with that stiffness rolling oscillations slip,
/// and friction's dashpot damps them, Wensrich & Katterfeld, Powder Technol. 217 (2012) 409). Rotation about the normal
/// is not resisted. The spring is kept half a step ahead as for Mindlin.
struct Epsd2 {
  static constexpr core::ModelInfo info{
      "epsd2", "elastic-plastic rolling spring with a limit, ratio to the reduced radius R*",
      "Ai et al. 2011; Wensrich & Katterfeld 2012"};
  static constexpr bool active = true;
  static constexpr bool has_spring = true;
  static constexpr bool needs_compliance = false;

  Real time_step = 0;  ///< particle step [s]

  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION SpringTorqueOf<Number> operator()(
      const ContactStateOf<Number>& c, const Same<NormalForceOf<Number>>& normal,
      const Same<Vector3<Number>>& n, const Same<Vector3<Number>>& relative_spin, const Vec3& spring,
      const Same<PairParametersOf<Number>>& p) const {
    const Vector3<Number> rolling = relative_spin - dot(relative_spin, n) * n;
    const Vector3<Number> half_step = Number(0.5 * time_step) * rolling;
    const Vec3 reached = spring + convert<Real>(half_step);
    const Number stiffness =
        p.tangential_stiffness_ratio * normal.stiffness * c.reduced_radius * c.reduced_radius;
    const Number limit =
        p.rolling_friction * c.reduced_radius * (normal.force > 0 ? normal.force : Number(0));
    const Number length = Kokkos::sqrt(norm_squared(convert<Number>(reached)));
    const Vec3 held = static_cast<Real>(shorten(stiffness * length, limit)) * reached;
    return {-stiffness * convert<Number>(held), held + convert<Real>(half_step)};
  }
};

}  // namespace pellicle::dem
