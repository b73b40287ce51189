// Drag laws: the momentum exchange coefficient between gas and particles, as stateless functions of scalars.
//
// Every law returns K = beta / eps_p [kg m-3 s-1], so that the drag force on a particle of volume V is
// V K (gas velocity - particle velocity). It is written in a form that is finite everywhere: at eps = 1 (no other
// particle near) and at zero slip, where K takes its Stokes value instead of 0/0. All are for model A, in which the
// particle also feels the pressure gradient. Symbols: eps void fraction, eps_p = 1 - eps, d particle diameter,
// rho, mu gas density and viscosity, s slip speed, Re = rho eps d s / mu (superficial).
#pragma once

#include <Kokkos_Core.hpp>

#include <variant>

#include "core/model_list.hpp"
#include "core/model_variant.hpp"
#include "core/types.hpp"

namespace pellicle::coupling {

/// The flow that one particle sees.
struct ParticleFlow {
  Real void_fraction;      ///< of the gas around the particle, in (0, 1]
  Real slip_speed;         ///< |gas velocity - particle velocity| [m/s]
  Real particle_diameter;  ///< [m]
  Real gas_density;        ///< [kg/m3]
  Real gas_viscosity;      ///< dynamic [Pa s]

  /// Superficial particle Reynolds number, rho eps d s / mu (thesis eq. 2.15).
  KOKKOS_INLINE_FUNCTION Real reynolds() const {
    return gas_density * void_fraction * particle_diameter * slip_speed / gas_viscosity;
  }
  /// Solids fraction; not below 0 if rounding has put the void fraction above 1.
  KOKKOS_INLINE_FUNCTION Real solids_fraction() const {
    return void_fraction < 1 ? 1 - void_fraction : Real(0);
  }
  /// K of a lone sphere in creeping flow, 18 mu / d2 [kg m-3 s-1].
  KOKKOS_INLINE_FUNCTION Real stokes() const {
    return 18 * gas_viscosity / (particle_diameter * particle_diameter);
  }
};

/// C_D Re / 24 of a lone sphere, Schiller & Naumann, Z. Ver. Deutsch. Ing. 77 (1933) 318, with Newton's constant value
/// 0.44 above Re = 1000 (thesis eq. 2.27).
KOKKOS_INLINE_FUNCTION Real sphere_drag_over_stokes(Real reynolds) {
  return reynolds <= 1000 ? 1 + 0.15 * Kokkos::pow(reynolds, 0.687) : 0.44 / 24 * reynolds;
}

/// Ergun, Chem. Eng. Progr. 48 (1952) 89: packed beds.
struct Ergun {
  static constexpr core::ModelInfo info{"ergun", "Ergun's packed-bed equation at every void fraction",
                                        "Ergun, Chem. Eng. Progr. 48 (1952) 89"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    const Real d = f.particle_diameter;
    return 150 * f.solids_fraction() * f.gas_viscosity / (f.void_fraction * d * d) +
           1.75 * f.gas_density * f.slip_speed / d;
  }
};

/// Wen & Yu, Chem. Eng. Progr. Symp. Ser. 62 (1966) 100, as used by Gidaspow: 3/4 C_D rho eps s eps^-2.65 / d.
/// The thesis prints it without the factor eps (eq. 2.26).
struct WenYu {
  static constexpr core::ModelInfo info{"wen_yu", "Wen & Yu: lone sphere times eps^-2.65",
                                        "Wen & Yu, Chem. Eng. Progr. Symp. Ser. 62 (1966) 100"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    return f.stokes() * sphere_drag_over_stokes(f.reynolds()) * Kokkos::pow(f.void_fraction, -2.65);
  }
};

/// Gidaspow, Multiphase Flow and Fluidization (1994): Ergun up to eps = 0.8, Wen & Yu above, with a jump between them.
struct ErgunWenYu {
  static constexpr core::ModelInfo info{"ergun_wen_yu",
                                        "Ergun for void fractions up to 0.8, Wen & Yu above; jumps at 0.8",
                                        "Gidaspow, Multiphase Flow and Fluidization (1994)"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    return f.void_fraction <= 0.8 ? Ergun{}(f) : WenYu{}(f);
  }
};

/// Another name for ErgunWenYu.
struct Gidaspow : ErgunWenYu {
  static constexpr core::ModelInfo info{"gidaspow", "the same as ergun_wen_yu", ErgunWenYu::info.source};
};

/// Huilin & Gidaspow, Chem. Eng. Sci. 58 (2003) 3777: the two branches of Gidaspow blended smoothly around 0.8.
struct GidaspowBlend {
  static constexpr core::ModelInfo info{"gidaspow_blend",
                                        "Ergun and Wen & Yu blended smoothly around void fraction 0.8",
                                        "Huilin & Gidaspow, Chem. Eng. Sci. 58 (2003) 3777"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    const Real share_of_wen_yu =
        0.5 + Kokkos::atan(262.5 * (f.void_fraction - 0.8)) / Kokkos::numbers::pi_v<Real>;
    return (1 - share_of_wen_yu) * Ergun{}(f) + share_of_wen_yu * WenYu{}(f);
  }
};

/// Koch & Hill, Annu. Rev. Fluid Mech. 33 (2001) 619: K = 18 mu eps2 / d2 (F0 + F3 Re / 2), with the coefficients that
/// the thesis rounds (eqs. 2.28-2.30).
struct KochHill {
  static constexpr core::ModelInfo info{"koch_hill", "Koch & Hill, from lattice-Boltzmann simulations",
                                        "Koch & Hill, Annu. Rev. Fluid Mech. 33 (2001) 619"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    const Real eps = f.void_fraction;
    const Real eps_p = f.solids_fraction();
    const Real f3 = 0.0673 + 0.212 * eps_p + 0.0232 / Kokkos::pow(eps, 5);
    return f.stokes() * eps * eps * (creeping(eps, eps_p) + 0.5 * f3 * f.reynolds());
  }

 private:
  /// F0, the creeping-flow part.
  KOKKOS_INLINE_FUNCTION static Real creeping(Real eps, Real eps_p) {
    if (eps_p >= 0.4) return 10 * eps_p / (eps * eps * eps);
    const Real x_ln_x = eps_p > 0 ? eps_p * Kokkos::log(eps_p) : Real(0);
    return (1 + 3 * Kokkos::sqrt(0.5 * eps_p) + 135. / 64 * x_ln_x + 16.14 * eps_p) /
           (1 + eps_p * (0.681 + eps_p * (-8.48 + 8.16 * eps_p)));
  }
};

/// Beetstra, van der Hoef & Kuipers, AIChE J. 53 (2007) 489: K = 18 mu eps / d2 F. The thesis prints the inertial term
/// without 1/eps (eqs. 2.31-2.33), up to 50 % less at Re of several hundred in a dense bed.
struct Beetstra {
  static constexpr core::ModelInfo info{
      "beetstra", "Beetstra, van der Hoef & Kuipers, from lattice-Boltzmann simulations",
      "Beetstra, van der Hoef & Kuipers, AIChE J. 53 (2007) 489"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    const Real eps = f.void_fraction;
    const Real eps2 = eps * eps;
    const Real eps_p = f.solids_fraction();
    const Real re = f.reynolds();
    const Real creeping = 10 * eps_p / eps2 + eps2 * (1 + 1.5 * Kokkos::sqrt(eps_p));
    // 0.413 Re / (24 eps2) [1/eps + 3 eps eps_p + 8.4 Re^-0.343] / [1 + 10^(3 eps_p) Re^-m], m = (1 + 4 eps_p) / 2,
    // multiplied through by Re^m so that it is finite at Re = 0.
    const Real re_m = Kokkos::pow(re, 0.5 + 2 * eps_p);
    const Real bracket = re * (1 / eps + 3 * eps * eps_p) + 8.4 * Kokkos::pow(re, 1 - 0.343);
    const Real inertial = 0.413 / (24 * eps2) * bracket * re_m / (re_m + Kokkos::pow(Real(10), 3 * eps_p));
    return f.stokes() * eps * (creeping + inertial);
  }
};

/// exp(-(1.5 - log10 Re)^2 / 2), the bell around Re = 32 in the voidage functions of Di Felice and Rong; 0 at Re = 0.
KOKKOS_INLINE_FUNCTION Real voidage_bell(Real reynolds) {
  if (!(reynolds > 0)) return 0;
  const Real x = 1.5 - Kokkos::log10(reynolds);
  return Kokkos::exp(-0.5 * x * x);
}

/// 3/4 C_D rho s eps^(2 - chi) / d with Dallavalle's C_D = (0.63 + 4.8 / sqrt(Re))2, written as
/// (3/4) (mu / d2) eps^(1 - chi) (0.63 sqrt(Re) + 4.8)2.
KOKKOS_INLINE_FUNCTION Real dallavalle_with_voidage_exponent(const ParticleFlow& f, Real reynolds, Real chi) {
  const Real root = 0.63 * Kokkos::sqrt(reynolds) + 4.8;
  return 0.75 * f.gas_viscosity / (f.particle_diameter * f.particle_diameter) *
         Kokkos::pow(f.void_fraction, 1 - chi) * root * root;
}

/// Di Felice, Int. J. Multiphase Flow 20 (1994) 153.
struct DiFelice {
  static constexpr core::ModelInfo info{"di_felice", "Di Felice: lone sphere times eps^(2 - chi(Re))",
                                        "Di Felice, Int. J. Multiphase Flow 20 (1994) 153"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    const Real re = f.reynolds();
    return dallavalle_with_voidage_exponent(f, re, 3.7 - 0.65 * voidage_bell(re));
  }
};

/// Rong, Dong & Yu, Chem. Eng. Sci. 99 (2013) 44: Di Felice's form with an exponent that depends on eps too.
struct Rong {
  static constexpr core::ModelInfo info{"rong", "Rong, Dong & Yu: Di Felice's form, exponent also of eps",
                                        "Rong, Dong & Yu, Chem. Eng. Sci. 99 (2013) 44"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    const Real eps = f.void_fraction;
    const Real re = f.reynolds();
    const Real chi = 2.65 * (eps + 1) - (5.3 - 3.5 * eps) * eps * eps * voidage_bell(re);
    return dallavalle_with_voidage_exponent(f, re, chi);
  }
};

/// Schiller & Naumann for a lone sphere: no influence of the neighbours, Re without the factor eps.
struct SchillerNaumann {
  static constexpr core::ModelInfo info{"schiller_naumann", "lone sphere, whatever the void fraction",
                                        "Schiller & Naumann, Z. Ver. Deutsch. Ing. 77 (1933) 318"};
  KOKKOS_INLINE_FUNCTION Real operator()(const ParticleFlow& f) const {
    const Real re = f.gas_density * f.particle_diameter * f.slip_speed / f.gas_viscosity;
    return f.stokes() * sphere_drag_over_stokes(re);
  }
};

/// The family: what `coupling.drag` may name. A new law is a struct above and an entry here.
using DragLaw = std::variant<Beetstra, DiFelice, Ergun, ErgunWenYu, Gidaspow, GidaspowBlend, KochHill, Rong,
                             SchillerNaumann, WenYu>;

/// K of the law at a position of the family's list, for device code that chooses the law at run time.
template <std::size_t I = 0>
KOKKOS_INLINE_FUNCTION Real momentum_exchange_coefficient(int law, const ParticleFlow& f) {
  if constexpr (I < std::variant_size_v<DragLaw>) {
    if (static_cast<int>(I) == law) return std::variant_alternative_t<I, DragLaw>{}(f);
    return momentum_exchange_coefficient<I + 1>(law, f);
  } else {
    return 0;
  }
}

}  // namespace pellicle::coupling
