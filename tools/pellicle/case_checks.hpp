// Checks across the keys of a case.
#pragma once

#include <cstdint>

#include "core/key_reader.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Reports everything in a case that contradicts something else in it. What is doubtful, but can be run, goes to
/// `spec.warnings`.
void check_case(CaseSpec& spec, core::InputProblems& problems);

/// Whether particles of one material can touch particles or a wall of the other.
bool can_meet(const CaseSpec& spec, int material_a, int material_b);

/// Volume of the region of a fill [m3].
Real region_volume(const FillSpec& fill);

/// Number of particles of a population; a fill by mass or solids fraction is rounded to whole particles.
std::int64_t particle_count(const CaseSpec& spec, const PopulationSpec& population);
std::int64_t particle_count(const CaseSpec& spec);

/// Diameters of the smallest and largest particle [m]; 0 without particles.
struct DiameterRange {
  Real smallest = 0, largest = 0;
};
DiameterRange diameter_range(const CaseSpec& spec);

/// Smallest width of a periodic domain [m]: no particle may meet two images of another one.
Real least_periodic_width(const CaseSpec& spec);

/// Largest stable particle step of the case [s], see dem::compute_time_step_bound; infinite if nothing can touch.
struct StepBound {
  Real bound = 0, rayleigh_time = 0, contact_time = 0;  ///< [s]
};
StepBound particle_step_bound(const CaseSpec& spec);

}  // namespace pellicle::tools
