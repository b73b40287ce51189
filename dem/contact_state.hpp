// What the contact laws work on: one contact, its pair of materials, and what a normal law hands on to the others.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::dem {

/// What the contact laws need of a pair of materials, worked out once.
struct PairParameters {
  Real effective_youngs_modulus = 0;  ///< E* [Pa]
  Real effective_shear_modulus = 0;   ///< G* [Pa]
  Real damping_ratio = 0;             ///< Λ [-], see compute_damping_ratio
  Real tangential_damping_ratio = 0;  ///< critical tangential damping over sqrt(S_n m*): 2 sqrt(S_t/S_n) [-]
  Real sliding_friction = 0;          ///< µ_s [-]
  Real rolling_friction = 0;          ///< µ_r [-]
  Real tangential_stiffness_ratio = 0;  ///< S_t/S_n = 4 G*/E* [-]
  Real normal_stiffness = 0;            ///< k [N/m], of the linear law
};

/// One contact as the laws see it. A wall has infinite radius and mass: R* = R, m* = m.
struct ContactState {
  Real overlap;         ///< δ > 0 [m]
  Real reduced_radius;  ///< R* [m]
  Real reduced_mass;    ///< m* [kg]
  Real approach_speed;  ///< v_n = dδ/dt [m/s], positive while the two approach
};

/// The normal force and what other laws take from it.
struct NormalForce {
  Real force;                ///< F_n >= 0 [N], repulsive
  Real stiffness_mass_root;  ///< √(S_n m*) [kg/s]
  Real stiffness = 0;        ///< S_n = dF/dδ of the elastic part [N/m]
  Real damping = 0;          ///< factor of v_n [kg/s]
};

/// The springs of one contact, seen from the body whose force is computed; the other body's copy has opposite signs.
/// Both are kept half a step ahead of the force that used them, see Mindlin.
struct ContactSprings {
  Vec3 tangential{};  ///< [m]
  Vec3 rolling{};     ///< [rad]
};

}  // namespace pellicle::dem
