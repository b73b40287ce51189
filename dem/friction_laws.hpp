// Friction of a contact: stateless functions of scalars and vectors, with or without a spring that remembers.
#pragma once

#include "core/model_list.hpp"
#include "dem/contact_state.hpp"

namespace pellicle::dem {

/// The tangential force on a body, and its spring as the next step finds it.
template <class Number>
struct SpringForceOf {
  Vector3<Number> force;  ///< [N]
  Vec3 spring;            ///< [m]
};

using SpringForce = SpringForceOf<Real>;

/// Turns a spring with its contact: by `twist` [rad] about the normal, as the two bodies do on average, then into the
/// plane across n, its length kept (Luding, Granul. Matter 10 (2008) 235, eq. 18). What changes is small beside the spring
/// and added to it, so that rounding it to Number does no harm.
template <class Number = Real>
KOKKOS_FORCEINLINE_FUNCTION Vec3 turn_spring(const Vec3& spring, const Vector3<Number>& n,
                                             Same<Number> twist) {
  const Vector3<Number> rounded = convert<Number>(spring);
  const Vector3<Number> turn = twist * cross(n, rounded);
  const Vector3<Number> change = turn - dot(rounded + turn, n) * n;
  const Vec3 tangential = spring + convert<Real>(change);
  // |spring|²/|tangential|² = 1 − growth; √(1 − growth) − 1 without cancellation.
  const Number growth = (2 * dot(rounded, change) + norm_squared(change)) /
                        (norm_squared(convert<Number>(tangential)) + tiny<Number>);
  const Number stretch = -growth / (1 + Kokkos::sqrt(1 - growth));
  return tangential + static_cast<Real>(stretch) * tangential;
}

/// Factor <= 1 that brings a vector of a given length down to `limit`.
template <class Number>
KOKKOS_FORCEINLINE_FUNCTION Number shorten(Number length, Same<Number> limit) {
  return limit < length ? limit / (length + tiny<Number>) : Number(1);
}

/// Coulomb's limit µ_s F_n [N]; none where the normal force pulls.
template <class Number>
KOKKOS_FORCEINLINE_FUNCTION Number sliding_limit(const NormalForceOf<Number>& normal,
                                                 const Same<PairParametersOf<Number>>& p) {
  return normal.force > 0 ? p.sliding_friction * normal.force : Number(0);
}

/// F_t = −min(µ_s F_n, η_t |v_t|) v_t/|v_t|, without history (PHYSICS.md 3; T 2.2.1). η_t is the smaller of the
/// critical damping of the tangential stiffness, 2 √(S_t m*), S_t = 8 G* √(R* δ), and the bound for an explicit step
/// with many contacts, (2/7) m*/(6 Δt).
struct ViscousCoulomb {
  static constexpr core::ModelInfo info{"viscous_coulomb",
                                        "Coulomb friction, viscous below the limit, without history",
                                        "thesis section 2.2.1"};
  static constexpr bool has_spring = false;

  Real time_step = 0;  ///< particle step [s]

  /// Returns the factor k of F_t = −k v_t [kg/s].
  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION Number operator()(const ContactStateOf<Number>& c,
                                                const Same<NormalForceOf<Number>>& normal,
                                                Same<Number> tangential_speed,
                                                const Same<PairParametersOf<Number>>& p) const {
    const Number critical = p.tangential_damping_ratio * normal.stiffness_mass_root;
    const Number stable = c.reduced_mass / Number(21 * time_step);  // (2/7)/6 = 1/21
    const Number viscous = critical < stable ? critical : stable;
    const Number sliding = sliding_limit(normal, p) / (tangential_speed + tiny<Number>);
    return sliding < viscous ? sliding : viscous;
  }
};

/// F_t = −k_t ξ − η_t v_t, at most µ_s F_n; k_t = S_t = 8 G* √(R* δ), η_t = 2√(5/6) Λ √(S_t m*), ξ the slip since the
/// contact began, no longer than what µ_s F_n bears (PHYSICS.md 3; Mindlin 1949; Tsuji et al. 1992). With the linear
/// normal law S_t/S_n is the same 4 G*/E*, and η_t loses its √(5/6) as the normal damping does.
///
/// The spring comes and goes half a step ahead: ξ at the time of the force is the spring kept plus v_t Δt/2, and
/// v_t Δt/2 more is kept. This is the trapezoidal rule; whole steps of v_t Δt would act as a damping of k_t Δt/2.
struct Mindlin {
  static constexpr core::ModelInfo info{
      "mindlin", "spring of the no-slip stiffness at the present overlap, with Coulomb's limit",
      "Mindlin 1949; Tsuji et al. 1992"};
  static constexpr bool has_spring = true;

  Real time_step = 0;  ///< particle step [s]

  /// `spring` lies across the normal.
  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION SpringForceOf<Number> operator()(
      const ContactStateOf<Number>&, const Same<NormalForceOf<Number>>& normal,
      const Same<Vector3<Number>>& tangential_velocity, const Vec3& spring,
      const Same<PairParametersOf<Number>>& p) const {
    const Vector3<Number> half_step = Number(0.5 * time_step) * tangential_velocity;
    const Vec3 reached = spring + convert<Real>(half_step);
    const Number stiffness = p.tangential_stiffness_ratio * normal.stiffness;
    const Number damping = Number(0.5) * p.tangential_damping_ratio * normal.damping;
    const Number limit = sliding_limit(normal, p);
    const Number length = Kokkos::sqrt(norm_squared(convert<Number>(reached)));
    const Vec3 held = static_cast<Real>(shorten(stiffness * length, limit)) * reached;
    const Vector3<Number> wanted = -stiffness * convert<Number>(held) - damping * tangential_velocity;
    return {shorten(Kokkos::sqrt(norm_squared(wanted)), limit) * wanted, held + convert<Real>(half_step)};
  }
};

/// F_t = −µ_s F_n [1 − (1 − x)^(3/2)] ξ/|ξ| − c_t [6 µ_s m* F_n √(1 − x)/ξ_max]^½ v_t, at most µ_s F_n; x = |ξ|/ξ_max at
/// most 1, ξ_max = µ_s δ E*/(4 G*), ξ the slip since the contact began (PHYSICS.md 3; P Table 1). There is no branch for
/// unloading, as in P. c_t = (2√5/(3√2)) Λ is what P's equal c_n = c_t means in terms of Λ. The spring is kept half a
/// step ahead as for Mindlin.
struct MindlinDeresiewicz {
  static constexpr core::ModelInfo info{
      "mindlin_deresiewicz", "softens from the no-slip stiffness to Coulomb's limit, no unloading branch",
      "Mindlin & Deresiewicz 1953; plume paper, table 1"};
  static constexpr bool has_spring = true;

  Real time_step = 0;  ///< particle step [s]

  template <class Number>
  KOKKOS_FORCEINLINE_FUNCTION SpringForceOf<Number> operator()(
      const ContactStateOf<Number>& c, const Same<NormalForceOf<Number>>& normal,
      const Same<Vector3<Number>>& tangential_velocity, const Vec3& spring,
      const Same<PairParametersOf<Number>>& p) const {
    constexpr auto damping_ratio_factor = Number(1.0540925533894598);  // 2√5/(3√2)
    const Vector3<Number> half_step = Number(0.5 * time_step) * tangential_velocity;
    const Vec3 reached = spring + convert<Real>(half_step);
    const Number limit = sliding_limit(normal, p);
    const Number longest = p.sliding_friction * c.overlap / p.tangential_stiffness_ratio;
    const Number length = Kokkos::sqrt(norm_squared(convert<Number>(reached)));
    const Vec3 held = static_cast<Real>(shorten(length, longest)) * reached;
    const Number held_length = length < longest ? length : longest;
    const Number left = length < longest ? 1 - length / longest : Number(0);
    const Number root = Kokkos::sqrt(left);
    const Number elastic = limit * (1 - left * root) / (held_length + tiny<Number>);
    // µ_s F_n/ξ_max = F_n 4 G*/(E* δ), without µ_s, which may be zero.
    const Number force = normal.force > 0 ? normal.force : Number(0);
    const Number damping =
        damping_ratio_factor * p.damping_ratio *
        Kokkos::sqrt(6 * c.reduced_mass * force * p.tangential_stiffness_ratio / c.overlap * root);
    const Vector3<Number> wanted = -elastic * convert<Number>(held) - damping * tangential_velocity;
    return {shorten(Kokkos::sqrt(norm_squared(wanted)), limit) * wanted, held + convert<Real>(half_step)};
  }
};

}  // namespace pellicle::dem
