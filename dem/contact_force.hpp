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

/// n/I of a solid sphere with n contacts in the last substep, I = 0.4 m R² [1/(kg m²)]; 0 for a fixed particle. A contact
/// that has just begun is not among the n yet, but is one.
KOKKOS_INLINE_FUNCTION Real spin_compliance_of(std::int32_t touching, Real inverse_mass, Real radius) {
  return (touching > 1 ? touching : 1) * 2.5 * inverse_mass / (radius * radius);
}

/// The laws of a run, one of each family.
template <class Normal, class Tangential, class Rolling>
struct ContactLaws {
  static constexpr bool rolling_active = Rolling::active;

  Normal normal;
  Tangential tangential;
  Rolling rolling;

  /// `n` unit vector from the body to its partner; `dv` velocity of the body minus that of its partner (surface speed
  /// for a wall); `lever_spin` l_i ω_i + l_j ω_j; `lever` l_i, centre to contact point; `relative_spin` ω_i − ω_j.
  /// Everything but n, dv and relative_spin is the same seen from both bodies, and these change sign exactly, so the
  /// two forces of a pair are opposite to the last bit (the build forbids fused multiply-add).
  KOKKOS_INLINE_FUNCTION ContactForce operator()(ContactState c, const PairParameters& p, const Vec3& n,
                                                 const Vec3& dv, const Vec3& lever_spin, Real lever,
                                                 const Vec3& relative_spin, Real spin_compliance) const {
    const Vec3 slip = dv + cross(lever_spin, n);
    const Vec3 tangential_velocity = slip - dot(slip, n) * n;
    const Real tangential_speed = Kokkos::sqrt(norm_squared(tangential_velocity));
    const NormalForce normal_force = normal(c, p);
    const Real k = tangential(c, normal_force, tangential_speed, p);
    const Vec3 friction = -k * tangential_velocity;
    ContactForce result;
    result.force = friction - normal_force.force * n;
    result.torque = lever * cross(n, friction);
    if constexpr (Rolling::active) {
      const Real spin = Kokkos::sqrt(norm_squared(relative_spin));
      result.rolling_torque = -rolling(c, normal_force.force, spin, spin_compliance, p) * relative_spin;
    }
    return result;
  }
};

}  // namespace pellicle::dem
