// Materials, what holds between two of them, and the options of the contact models.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"
#include "dem/contact_laws.hpp"

namespace pellicle::dem {

/// A solid. A rigid one (a wall whose material the case does not list) has neither modulus nor ratio.
struct Material {
  std::string name;
  Real density = 0;         ///< [kg/m3]
  Real youngs_modulus = 0;  ///< [Pa]
  Real poisson_ratio = 0;   ///< [-]
  bool rigid = false;
};

/// Contact properties of a pair of materials, by index into the materials; order does not matter.
struct PairProperties {
  int material_a = 0;
  int material_b = 0;
  Real restitution = 1;       ///< [-], in (0, 1]
  Real sliding_friction = 0;  ///< [-]
  Real rolling_friction = 0;  ///< [-], a ratio to the reduced radius R*
  Real normal_stiffness = 0;  ///< k [N/m] of the linear normal law
};

/// Λ that makes a Hertz or linear contact with damping 2√(5/6) Λ √(S_n m*) (linear: 2 Λ √(k m*)) rebound with the
/// given restitution. With `clip` (no attraction at the end of the contact) it inverts PHYSICS.md 3's closed form;
/// without, it is the textbook Λ = −ln e/√(ln² e + π²). Restitution in (0, 1]; throws std::invalid_argument.
Real compute_damping_ratio(Real restitution, bool clip);

/// Square table of pair parameters, entry a * materials.size() + b; zeros for a pair that is not listed. A pair listed
/// twice, or of a material that does not exist, throws std::invalid_argument.
std::vector<PairParameters> make_pair_table(const std::vector<Material>& materials,
                                            const std::vector<PairProperties>& pairs, bool clip);

/// Throws std::invalid_argument naming both materials where no pair is listed although the two can meet: a material
/// of particles and another one of particles or of walls. Both flags are one a material.
void require_pairs(const std::vector<Material>& materials, const std::vector<PairProperties>& pairs,
                   const std::vector<bool>& of_particles, const std::vector<bool>& of_walls);

/// Throws std::invalid_argument naming both materials of a pair without the stiffness that the linear law needs.
void require_stiffness(const std::vector<Material>& materials, const std::vector<PairProperties>& pairs);

/// Radii of the particles of a material [m]; a material of walls alone has none.
struct RadiusRange {
  Real smallest = 0, largest = 0;
  bool any() const { return largest > 0; }
};

/// Stiffness k [N/m] of the linear law with which no impact at `speed` [m/s] between bodies of two materials overlaps by
/// more than `largest_overlap` of the smaller radius: m* v² = k δ² for the worst pair of radii. Without particles in `b`
/// it is that of walls; without any in either, 0.
Real compute_linear_stiffness(const Material& a, const RadiusRange& radii_a, const Material& b,
                              const RadiusRange& radii_b, Real largest_overlap, Real speed);

/// Largest stable particle time step [s]: min(0.2 T_Rayleigh, t_c/20) over all materials and pairs (PHYSICS.md 3).
struct TimeStepBound {
  Real bound = 0;          ///< [s]
  Real rayleigh_time = 0;  ///< shortest, [s]; infinite for the linear law
  Real contact_time = 0;   ///< shortest, at the impact speed, [s]
};

/// `smallest_radius` [m] per material (infinite or zero where no particle has it); impact speed [m/s].
TimeStepBound compute_time_step_bound(const std::vector<Material>& materials,
                                      const std::vector<Real>& smallest_radius, Real impact_speed);

/// The bound for linear springs, t_c/20 with t_c = π √(m*/k), the half period of an undamped contact; the smallest over
/// pairs, each with its stiffness. `smallest_radius` as above.
TimeStepBound compute_linear_time_step_bound(const std::vector<Material>& materials,
                                             const std::vector<PairProperties>& pairs,
                                             const std::vector<Real>& smallest_radius);

}  // namespace pellicle::dem
