// From a case file to temperature and films of the particles, and their exchange with the gas.
#pragma once

#include <vector>

#include "dem/engine.hpp"
#include "heat/contact_conduction.hpp"
#include "heat/heat_options.hpp"
#include "heat/surface_state.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Of a case with heat.
heat::HeatOptions make_heat_options(const CaseSpec& spec);

/// Of a case with heat.contact_conduction.
heat::ConductionOptions make_conduction_options(const CaseSpec& spec);

/// Of a case with heat or spray; for the engine whose particles these are.
heat::SurfaceState make_surface(const CaseSpec& spec, const dem::Particles& particles);

/// Temperature [K] and film [kg] of a particle of this population and mass [kg].
Real initial_temperature(const CaseSpec& spec, const PopulationSpec& population);
heat::Film initial_film(const PopulationSpec& population, Real mass);

/// Gives every particle what its population begins with; `seeds` as make_particles made them.
void set_initial_surface(const CaseSpec& spec, const std::vector<dem::ParticleSeed>& seeds,
                         heat::SurfaceState& surface);

}  // namespace pellicle::tools
