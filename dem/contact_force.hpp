// The force of one contact, put together from the chosen laws; for pairs and for walls, on host and device.
#pragma once

#include "dem/contact_laws.hpp"

namespace pellicle::dem {

/// What one contact does to the first of the two bodies; the second gets −force.
struct ContactForce {
  Vec3 force;           ///< [N]
  Vec3 torque;          ///< of the tangential force on the first body, about its centre [N m]
  Vec3 rolling_torque;  ///< on the first body [N m]; the second gets the opposite
};

/// n/I of a solid sphere with n contacts in the last substep, I = 0.4 m R²; 0 for a fixed particle. A contact that has
/// just begun is not among the n yet, but is one.
KOKKOS_FORCEINLINE_FUNCTION Real spin_compliance_of(std::int32_t touching, Real inverse_mass, Real radius) {
  return (touching > 1 ? touching : 1) * 2.5 * inverse_mass / (radius * radius);
}

/// The laws of a run, one of each family. They are inlined by force: one that the compiler leaves as a call, as it does
/// in a file of many instances, keeps the loop over contacts out of vector registers.
template <class Normal, class Tangential, class Rolling>
struct ContactLaws {
  /// Whether `spin_compliance` is asked for.
  static constexpr bool needs_compliance = Rolling::needs_compliance;
  /// Springs that each contact keeps: the tangential one first.
  static constexpr int springs = (Tangential::has_spring ? 1 : 0) + (Rolling::has_spring ? 1 : 0);
  /// Their places among them, -1 without.
  static constexpr int tangential_spring = Tangential::has_spring ? 0 : -1;
  static constexpr int rolling_spring = Rolling::has_spring ? springs - 1 : -1;

  Normal normal;
  Tangential tangential;
  Rolling rolling;

  /// `n` unit vector from the body to its partner; `dv` velocity of the body minus that of its partner (surface speed
  /// for a wall); `lever_spin` l_i ω_i + l_j ω_j; `lever` l_i, centre to contact point; `relative_spin` ω_i − ω_j;
  /// `mean_spin` (ω_i + ω_j)/2; `springs` those of the step before, overwritten with the new ones.
  /// Everything but n, dv, relative_spin and the springs is the same seen from both bodies, and these change sign
  /// exactly, so the two forces of a pair are opposite to the last bit (the build forbids fused multiply-add).
  KOKKOS_FORCEINLINE_FUNCTION ContactForce operator()(const ContactState& c, const PairParameters& p,
                                                      const Vec3& n, const Vec3& dv, const Vec3& lever_spin,
                                                      Real lever, const Vec3& relative_spin,
                                                      Real spin_compliance, const Vec3& mean_spin,
                                                      ContactSprings& spring) const {
    const Vec3 slip = dv + cross(lever_spin, n);
    const Vec3 tangential_velocity = slip - dot(slip, n) * n;
    const NormalForce normal_force = normal(c, p);
    [[maybe_unused]] const Real twist = tangential.time_step * dot(mean_spin, n);
    Vec3 friction;
    if constexpr (Tangential::has_spring) {
      const SpringForce answer =
          tangential(c, normal_force, tangential_velocity, turn_spring(spring.tangential, n, twist), p);
      friction = answer.force;
      spring.tangential = answer.spring;
    } else {
      const Real tangential_speed = Kokkos::sqrt(norm_squared(tangential_velocity));
      friction = -tangential(c, normal_force, tangential_speed, p) * tangential_velocity;
    }
    ContactForce result;
    result.force = friction - normal_force.force * n;
    result.torque = lever * cross(n, friction);
    if constexpr (Rolling::has_spring) {
      const SpringTorque answer =
          rolling(c, normal_force, n, relative_spin, turn_spring(spring.rolling, n, twist), p);
      result.rolling_torque = answer.torque;
      spring.rolling = answer.spring;
    } else if constexpr (Rolling::active) {
      const Real spin = Kokkos::sqrt(norm_squared(relative_spin));
      result.rolling_torque = -rolling(c, normal_force.force, spin, spin_compliance, p) * relative_spin;
    }
    return result;
  }

  /// Springs of a contact as stored, `springs` vectors side by side; zero for a contact that has just begun.
  KOKKOS_FORCEINLINE_FUNCTION static ContactSprings unpack([[maybe_unused]] const Vec3* stored,
                                                           [[maybe_unused]] bool goes_on) {
    ContactSprings result;
    if constexpr (Tangential::has_spring)
      result.tangential = goes_on ? stored[tangential_spring] : Vec3{0, 0, 0};
    if constexpr (Rolling::has_spring) result.rolling = goes_on ? stored[rolling_spring] : Vec3{0, 0, 0};
    return result;
  }
  KOKKOS_FORCEINLINE_FUNCTION static void pack([[maybe_unused]] const ContactSprings& spring,
                                               [[maybe_unused]] Vec3* stored) {
    if constexpr (Tangential::has_spring) stored[tangential_spring] = spring.tangential;
    if constexpr (Rolling::has_spring) stored[rolling_spring] = spring.rolling;
  }
};

}  // namespace pellicle::dem
