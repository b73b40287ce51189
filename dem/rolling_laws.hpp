// Resistance of a contact to rolling: stateless functions of scalars and vectors.
#pragma once

#include "core/model_list.hpp"
#include "dem/contact_state.hpp"
#include "dem/friction_laws.hpp"

namespace pellicle::dem {

/// The rolling torque on a body, and its spring as the next step finds it.
struct SpringTorque {
  Vec3 torque;  ///< [N m]
  Vec3 spring;  ///< [rad]
};

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
  KOKKOS_FORCEINLINE_FUNCTION Real operator()(const ContactState& c, Real normal_force, Real relative_spin,
                                              Real spin_compliance, const PairParameters& p) const {
    const Real torque = p.rolling_friction * c.reduced_radius * (normal_force > 0 ? normal_force : Real(0));
    const Real steady = torque / (relative_spin + 1e-300);
    const Real stopping = (2.0 / 3.0) / (time_step * spin_compliance + 1e-300);
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

  KOKKOS_FORCEINLINE_FUNCTION SpringTorque operator()(const ContactState& c, const NormalForce& normal,
                                                      const Vec3& n, const Vec3& relative_spin,
                                                      const Vec3& spring, const PairParameters& p) const {
    const Vec3 rolling = relative_spin - dot(relative_spin, n) * n;
    const Vec3 half_step = (0.5 * time_step) * rolling;
    const Vec3 reached = spring + half_step;
    const Real stiffness =
        p.tangential_stiffness_ratio * normal.stiffness * c.reduced_radius * c.reduced_radius;
    const Real limit = p.rolling_friction * c.reduced_radius * (normal.force > 0 ? normal.force : Real(0));
    const Vec3 held = shorten(stiffness * Kokkos::sqrt(norm_squared(reached)), limit) * reached;
    return {-stiffness * held, held + half_step};
  }
};

}  // namespace pellicle::dem
