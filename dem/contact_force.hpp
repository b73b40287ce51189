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

/// The same before it is put together.
template <class Number>
struct ContactForceParts {
  Number normal;                     ///< F_n, along −n [N]
  Vector3<Number> friction{};        ///< [N]
  Vector3<Number> rolling_torque{};  ///< [N m]
};

/// n/I of a solid sphere with n contacts in the last substep, I = 0.4 m R² [1/(kg m²)]; 0 for a fixed particle. A contact
/// that has just begun is not among the n yet, but is one.
template <class Number>
KOKKOS_FORCEINLINE_FUNCTION Number spin_compliance_of(std::int32_t touching, Number inverse_mass,
                                                      Number radius) {
  return static_cast<Number>(touching > 1 ? touching : 1) * Number(2.5) * inverse_mass / (radius * radius);
}

/// The laws of a run, one of each family. They are inlined by force: one that the compiler leaves as a call, as it does
/// in a file of many instances, keeps the loop over contacts out of vector registers.
template <class Normal, class Tangential, class Rolling>
struct ContactLaws {
  /// Whether `spin_compliance` is asked for.
  static constexpr bool needs_compliance = Rolling::needs_compliance;
  /// Whether there are rolling torques.
  static constexpr bool rolls = Rolling::active;
  /// Springs that each contact keeps: the tangential one first.
  static constexpr int springs = (Tangential::has_spring ? 1 : 0) + (Rolling::has_spring ? 1 : 0);
  /// Their places among them, -1 without.
  static constexpr int tangential_spring = Tangential::has_spring ? 0 : -1;
  static constexpr int rolling_spring = Rolling::has_spring ? springs - 1 : -1;

  Normal normal;
  Tangential tangential;
  Rolling rolling;

  /// `n` unit vector from the body to its partner; `dv` velocity of the body minus that of its partner (surface speed
  /// for a wall); `lever_spin` l_i ω_i + l_j ω_j; `relative_spin` ω_i − ω_j; `mean_spin` (ω_i + ω_j)/2; `springs` those
  /// of the step before, overwritten with the new ones.
  /// Everything but n, dv, relative_spin and the springs is the same seen from both bodies, and these change sign
  /// exactly, so the two forces of a pair are opposite to the last bit (the build forbids fused multiply-add).
  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION ContactForceParts<Number> parts(
      const ContactStateOf<Number>& c, const PairParametersOf<Number>& p, const Vector3<Number>& n,
      const Vector3<Number>& dv, const Vector3<Number>& lever_spin, const Vector3<Number>& relative_spin,
      Number spin_compliance, const Vector3<Number>& mean_spin, ContactSprings& spring) const {
    const Vector3<Number> slip = dv + cross(lever_spin, n);
    const Vector3<Number> tangential_velocity = slip - dot(slip, n) * n;
    const NormalForceOf<Number> normal_force = normal(c, p);
    [[maybe_unused]] const Number twist = static_cast<Number>(tangential.time_step) * dot(mean_spin, n);
    ContactForceParts<Number> result;
    result.normal = normal_force.force;
    if constexpr (Tangential::has_spring) {
      const SpringForceOf<Number> answer =
          tangential(c, normal_force, tangential_velocity, turn_spring(spring.tangential, n, twist), p);
      result.friction = answer.force;
      spring.tangential = answer.spring;
    } else {
      const Number tangential_speed = Kokkos::sqrt(norm_squared(tangential_velocity));
      result.friction = -tangential(c, normal_force, tangential_speed, p) * tangential_velocity;
    }
    if constexpr (Rolling::has_spring) {
      const SpringTorqueOf<Number> answer =
          rolling(c, normal_force, n, relative_spin, turn_spring(spring.rolling, n, twist), p);
      result.rolling_torque = answer.torque;
      spring.rolling = answer.spring;
    } else if constexpr (Rolling::active) {
      const Number spin = Kokkos::sqrt(norm_squared(relative_spin));
      result.rolling_torque = -rolling(c, normal_force.force, spin, spin_compliance, p) * relative_spin;
    }
    return result;
  }

  /// The parts put together, for a body whose contact point is `lever` away from its centre.
  KOKKOS_FORCEINLINE_FUNCTION ContactForce operator()(const ContactState& c, const PairParameters& p,
                                                      const Vec3& n, const Vec3& dv, const Vec3& lever_spin,
                                                      Real lever, const Vec3& relative_spin,
                                                      Real spin_compliance, const Vec3& mean_spin,
                                                      ContactSprings& spring) const {
    const auto f = parts(c, p, n, dv, lever_spin, relative_spin, spin_compliance, mean_spin, spring);
    return {f.friction - f.normal * n, lever * cross(n, f.friction), f.rolling_torque};
  }
};

/// One pair of particles as its force needs it, seen from particle i.
template <class Number>
struct PairState {
  Vector3<Number> d;                ///< from i to j [m]
  Number gap;                       ///< (r_i + r_j)² − |d|², formed in double precision: > 0 [m²]
  Number ri, rj;                    ///< [m]
  Vector3<Number> dv;               ///< v_i − v_j [m/s]
  Vector3<Number> spin_sum;         ///< ω_i + ω_j [rad/s]
  Vector3<Number> spin_difference;  ///< ω_i − ω_j [rad/s]
  Number inverse_mass_sum;          ///< 1/m_i + 1/m_j [1/kg]
  Number spin_compliance = 0;       ///< Σ n/I of both [1/(kg m²)]
};

/// What the force of a pair is made of. The rest is double precision: force on i = −pull d + friction; torque on i
/// (1 + skew)/2 d × friction + rolling_torque, on j (1 − skew)/2 d × friction − rolling_torque. So momentum and angular
/// momentum are kept exactly, whatever the precision of the parts.
template <class Number>
struct PairForce {
  Number pull;                     ///< F_n/|d| [N/m]
  Vector3<Number> friction;        ///< on i [N]
  Number skew;                     ///< (l_i − l_j)/|d|, l the distances to the contact point
  Vector3<Number> rolling_torque;  ///< on i [N m]
  Number overlap;                  ///< [m]
  Number approach_speed;           ///< [m/s]
};

/// The force of a pair in contact. Seen from j, friction and rolling_torque have opposite signs to the last bit, and so has
/// skew; the springs change sign, too.
template <class Laws, class Number>
KOKKOS_FORCEINLINE_FUNCTION PairForce<Number> find_pair_force(const Laws& laws,
                                                              const PairParametersOf<Number>& parameters,
                                                              const PairState<Number>& pair,
                                                              ContactSprings& springs) {
  const Number s = Kokkos::sqrt(norm_squared(pair.d));
  const Number sum = pair.ri + pair.rj;
  const Number reach = s + sum;
  // One division instead of four, which would take longer than all else here.
  const Number lengths = s * reach;
  const Number weights = sum * pair.inverse_mass_sum;
  const Number inverse = 1 / (lengths * weights);
  const Number inverse_lengths = inverse * weights;
  const Number inverse_weights = inverse * lengths;
  const Number inverse_s = inverse_lengths * reach;
  const Vector3<Number> n = inverse_s * pair.d;
  ContactStateOf<Number> c;
  // The difference of sum and s, without the cancellation.
  c.overlap = pair.gap * (inverse_lengths * s);
  c.reduced_radius = pair.ri * pair.rj * (inverse_weights * pair.inverse_mass_sum);
  c.reduced_mass = inverse_weights * sum;
  c.approach_speed = dot(pair.dv, n);
  // Lever arms to the plane through the circle where the spheres meet: l_i + l_j = s, l_i² − l_j² = r_i² − r_j².
  const Number skew = (pair.ri - pair.rj) * sum * inverse_s;
  constexpr auto half = Number(0.5);
  const Vector3<Number> lever_spin = half * (s * pair.spin_sum + skew * pair.spin_difference);
  const ContactForceParts<Number> f = laws.parts(c, parameters, n, pair.dv, lever_spin, pair.spin_difference,
                                                 pair.spin_compliance, half * pair.spin_sum, springs);
  return {f.normal * inverse_s, f.friction, skew * inverse_s, f.rolling_torque, c.overlap, c.approach_speed};
}

}  // namespace pellicle::dem
