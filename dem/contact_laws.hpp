// Contact laws: stateless functions of scalars, for a pair of particles or a particle and a wall.
#pragma once

#include <Kokkos_Core.hpp>
#include <variant>

#include "core/model_list.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::dem {

/// What the contact laws need of a pair of materials, worked out once.
struct PairParameters {
  Real effective_youngs_modulus = 0;  ///< E* [Pa]
  Real effective_shear_modulus = 0;   ///< G* [Pa]
  Real damping_ratio = 0;             ///< Λ [-], see compute_damping_ratio
  Real tangential_damping_ratio = 0;  ///< critical tangential damping over sqrt(S_n m*): 2 sqrt(4 G*/E*) [-]
  Real sliding_friction = 0;          ///< µ_s [-]
  Real rolling_friction = 0;          ///< µ_r [-]
};

/// One contact as the laws see it. A wall has infinite radius and mass: R* = R, m* = m.
struct ContactState {
  Real overlap;         ///< δ > 0 [m]
  Real reduced_radius;  ///< R* [m]
  Real reduced_mass;    ///< m* [kg]
  Real approach_speed;  ///< v_n = dδ/dt [m/s], positive while the two approach
};

/// The normal force and what tangential laws take from it.
struct NormalForce {
  Real force;                ///< F_n >= 0 [N], repulsive
  Real stiffness_mass_root;  ///< √(S_n m*) [kg/s]
};

/// Hertz with viscous damping, F_n = (4/3) E* √R* δ^(3/2) + 2√(5/6) Λ √(S_n m*) v_n, S_n = 2 E* √(R* δ), clipped at
/// zero unless `clip` is off (PHYSICS.md 3; T 2.8-2.10).
struct Hertz {
  static constexpr core::ModelInfo info{"hertz",
                                        "Hertz spring, damping for a restitution that holds at any speed",
                                        "Hertz 1882; Tsuji et al. 1992; thesis eq. 2.8-2.10"};

  bool clip = true;

  KOKKOS_INLINE_FUNCTION NormalForce operator()(const ContactState& c, const PairParameters& p) const {
    constexpr Real damping_factor = 1.8257418583505538;  // 2 √(5/6)
    const Real stiffness = 2 * p.effective_youngs_modulus * Kokkos::sqrt(c.reduced_radius * c.overlap);
    const Real root = Kokkos::sqrt(stiffness * c.reduced_mass);
    // (4/3) E* √R* δ^(3/2) = (2/3) S_n δ
    const Real force =
        (2.0 / 3.0) * stiffness * c.overlap + damping_factor * p.damping_ratio * root * c.approach_speed;
    return {clip && force < 0 ? Real(0) : force, root};
  }
};

/// F_t = −min(µ_s F_n, η_t |v_t|) v_t/|v_t|, without history (PHYSICS.md 3; T 2.2.1). η_t is the smaller of the
/// critical damping of the tangential stiffness, 2 √(S_t m*), S_t = 8 G* √(R* δ), and the bound for an explicit step
/// with many contacts, (2/7) m*/(6 Δt).
struct ViscousCoulomb {
  static constexpr core::ModelInfo info{"viscous_coulomb",
                                        "Coulomb friction, viscous below the limit, without history",
                                        "thesis section 2.2.1"};

  Real time_step = 0;  ///< particle step [s]

  /// Returns the factor k of F_t = −k v_t [kg/s].
  KOKKOS_INLINE_FUNCTION Real operator()(const ContactState& c, const NormalForce& normal,
                                         Real tangential_speed, const PairParameters& p) const {
    const Real critical = p.tangential_damping_ratio * normal.stiffness_mass_root;
    const Real stable = c.reduced_mass / (21 * time_step);  // (2/7)/6 = 1/21
    const Real viscous = critical < stable ? critical : stable;
    const Real friction = normal.force > 0 ? p.sliding_friction * normal.force : Real(0);
    const Real sliding = friction / (tangential_speed + 1e-300);
    return sliding < viscous ? sliding : viscous;
  }
};

/// No rolling resistance.
struct NoRolling {
  static constexpr core::ModelInfo info{"none", "no rolling resistance", "-"};
  static constexpr bool active = false;

  Real time_step = 0;

  KOKKOS_INLINE_FUNCTION Real operator()(const ContactState&, Real, Real, Real, const PairParameters&) const {
    return 0;
  }
};

/// M_r = −µ_r R* F_n ω_rel/|ω_rel| (PHYSICS.md 3; T 2.12), never so much that it reverses the relative spin within a
/// step, the stopping torque shared among the contacts of the two particles.
struct ConstantTorque {
  static constexpr core::ModelInfo info{"constant_torque",
                                        "constant directional torque, ratio to the reduced radius R*",
                                        "Zhou et al. 1999; thesis eq. 2.12"};
  static constexpr bool active = true;

  Real time_step = 0;  ///< particle step [s]

  /// Factor k of M_r = −k ω_rel [N m s]. `spin_compliance` is Σ n/I over the two particles [1/(kg m²)], n ≥ 1 the number
  /// of contacts of each: the torque that stops ω_rel if all n act alike is |ω_rel|/(Δt Σ n/I). Two thirds of it are
  /// allowed: the motion (dem/motion.hpp) sees a spin predicted with half a step of the last torque, so that a cap c
  /// gives ω' = (1 − 3c/2) ω + (c/2) ω_before, which changes sign for c > 2/3 and no longer decays at c = 1.
  KOKKOS_INLINE_FUNCTION Real operator()(const ContactState& c, Real normal_force, Real relative_spin,
                                         Real spin_compliance, const PairParameters& p) const {
    const Real torque = p.rolling_friction * c.reduced_radius * (normal_force > 0 ? normal_force : Real(0));
    const Real steady = torque / (relative_spin + 1e-300);
    const Real stopping = (2.0 / 3.0) / (time_step * spin_compliance + 1e-300);
    return steady < stopping ? steady : stopping;
  }
};

using NormalLaw = std::variant<Hertz>;
using TangentialLaw = std::variant<ViscousCoulomb>;
using RollingLaw = std::variant<ConstantTorque, NoRolling>;

/// The contact models of a case, chosen by name.
struct ContactOptions {
  NormalLaw normal = Hertz{};
  TangentialLaw tangential = ViscousCoulomb{};
  RollingLaw rolling = ConstantTorque{};
  bool clip = true;  ///< no attraction at the end of a contact
  Real overlap_limit =
      0.5;  ///< largest overlap, as a fraction of the smaller radius; beyond it the run stops
};

}  // namespace pellicle::dem
