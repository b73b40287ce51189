// What the contact laws work on: one contact, its pair of materials, and what a normal law hands on to the others; in the
// precision that the caller computes in.
#pragma once

#include <Kokkos_Core.hpp>
#include <type_traits>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::dem {

/// What the contact laws need of a pair of materials, worked out once.
template <class Number>
struct PairParametersOf {
  Number effective_youngs_modulus = 0;  ///< E* [Pa]
  Number effective_shear_modulus = 0;   ///< G* [Pa]
  Number damping_ratio = 0;             ///< Λ [-], see compute_damping_ratio
  Number tangential_damping_ratio =
      0;                        ///< critical tangential damping over sqrt(S_n m*): 2 sqrt(S_t/S_n) [-]
  Number sliding_friction = 0;  ///< µ_s [-]
  Number rolling_friction = 0;  ///< µ_r [-]
  Number tangential_stiffness_ratio = 0;  ///< S_t/S_n = 4 G*/E* [-]
  Number normal_stiffness = 0;            ///< k [N/m], of the linear law
};
using PairParameters = PairParametersOf<Real>;

template <class Number>
KOKKOS_FORCEINLINE_FUNCTION PairParametersOf<Number> convert(const PairParameters& p) {
  return {static_cast<Number>(p.effective_youngs_modulus),
          static_cast<Number>(p.effective_shear_modulus),
          static_cast<Number>(p.damping_ratio),
          static_cast<Number>(p.tangential_damping_ratio),
          static_cast<Number>(p.sliding_friction),
          static_cast<Number>(p.rolling_friction),
          static_cast<Number>(p.tangential_stiffness_ratio),
          static_cast<Number>(p.normal_stiffness)};
}

/// One contact as the laws see it. A wall has infinite radius and mass: R* = R, m* = m.
template <class Number>
struct ContactStateOf {
  Number overlap;         ///< δ > 0 [m]
  Number reduced_radius;  ///< R* [m]
  Number reduced_mass;    ///< m* [kg]
  Number approach_speed;  ///< v_n = dδ/dt [m/s], positive while the two approach
};
using ContactState = ContactStateOf<Real>;

/// The normal force and what other laws take from it.
template <class Number>
struct NormalForceOf {
  Number force;                ///< F_n >= 0 [N], repulsive
  Number stiffness_mass_root;  ///< √(S_n m*) [kg/s]
  Number stiffness = 0;        ///< S_n = dF/dδ of the elastic part [N/m]
  Number damping = 0;          ///< factor of v_n [kg/s]
};
using NormalForce = NormalForceOf<Real>;

/// The springs of one contact, seen from the body whose force is computed; the other body's copy has opposite signs.
/// Both are kept half a step ahead of the force that used them, see Mindlin. They are double precision whatever the forces
/// are found in: a contact at rest must keep what it has gathered, though each step adds little or nothing to it.
struct ContactSprings {
  Vec3 tangential{};  ///< [m]
  Vec3 rolling{};     ///< [rad]
};

/// T, for arguments that have the precision of the contact and do not decide about it.
template <class T>
using Same = std::type_identity_t<T>;

/// Added to divisors that may vanish: beside any other it is nothing.
template <class Number>
inline constexpr Number tiny = std::is_same_v<Number, float> ? Number(1e-37) : Number(1e-300);

}  // namespace pellicle::dem
