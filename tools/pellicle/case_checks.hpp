// Checks across the keys of a case.
#pragma once

#include <cstdint>

#include "core/key_reader.hpp"
#include "dem/materials.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Reports everything in a case that contradicts something else in it. What is doubtful, but can be run, goes to
/// `spec.warnings`.
void check_case(CaseSpec& spec, core::InputProblems& problems);

/// What heat and films of the particles need of the rest of the case; a part of check_case.
void check_heat(const CaseSpec& spec, core::InputProblems& problems);

/// Whether particles of one material can touch particles or a wall of the other.
bool can_meet(const CaseSpec& spec, int material_a, int material_b);

/// Mean volume of the particles of a fill, expected for a distribution [m3].
Real mean_particle_volume(const PopulationSpec& population);

/// How many particles the fill of a population comes to. By total mass the last particle is the one that brings the
/// sum nearest to it; by solids fraction none more than fits below it. The place of a population among all is part of
/// what its random diameters depend on.
std::int64_t count_fill(const CaseSpec& spec, std::size_t population);

/// Diameter of the particle `id` of a population with a distribution [m].
Real draw_diameter(const CaseSpec& spec, std::size_t population, const dem::SizeSampler& sizes,
                   std::int64_t id);
/// Radii of all particles of a population's fill [m].
std::vector<Real> draw_radii(const CaseSpec& spec, std::size_t population);

/// Particles at the start.
std::int64_t particle_count(const PopulationSpec& population);
std::int64_t particle_count(const CaseSpec& spec);
/// Particles that feeds are to bring in, about.
std::int64_t fed_count(const CaseSpec& spec, const PopulationSpec& population);
std::int64_t fed_count(const CaseSpec& spec);

/// Diameters of the smallest and largest particle [m], those that a distribution allows; 0 without particles.
struct DiameterRange {
  Real smallest = 0, largest = 0;
};
DiameterRange diameter_range(const PopulationSpec& population);
DiameterRange diameter_range(const CaseSpec& spec);

/// Smallest width of a periodic domain [m]: no particle may meet two images of another one.
Real least_periodic_width(const CaseSpec& spec);

/// The materials as the engine knows them, with their true moduli where given, or with those that contacts have.
std::vector<dem::Material> make_materials(const CaseSpec& spec, bool true_moduli = false);

/// Properties of all pairs of materials: those given, with the stiffness that the linear law comes to, and arbitrary ones
/// for pairs that cannot meet.
std::vector<dem::PairProperties> make_pairs(const CaseSpec& spec);

/// Largest stable particle step of the case [s], see dem::compute_time_step_bound; infinite if nothing can touch.
dem::TimeStepBound particle_step_bound(const CaseSpec& spec, bool true_moduli = false);

/// `a fifth of the Rayleigh time 0.1 s, …`: where a bound comes from.
std::string describe_bound(const CaseSpec& spec, const dem::TimeStepBound& bound);

}  // namespace pellicle::tools
