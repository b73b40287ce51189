// From what a case file says to what the engines are made of.
#pragma once

#include <vector>

#include "coupling/coupling_options.hpp"
#include "dem/engine.hpp"
#include "dem/feed.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Materials, contact models, walls and domain of the particles; time step in s (the one the loop really uses).
dem::EngineSetup make_engine_setup(const CaseSpec& spec, Real particle_step);

/// All particles of the case, populations in the order of the file. Throws InputError if they do not fit, or if one that
/// can move starts inside one of the walls, which are those of the case.
std::vector<dem::ParticleSeed> make_particles(const CaseSpec& spec, const std::vector<dem::Wall>& walls);

/// The feeds of the case, in the order of the file. Throws InputError where walls, which are those of the case, leave no
/// room for the largest particle.
std::vector<dem::Feed> make_feeds(const CaseSpec& spec, const dem::EngineSetup& engine);

coupling::CouplingOptions make_coupling_options(const CaseSpec& spec);

}  // namespace pellicle::tools
