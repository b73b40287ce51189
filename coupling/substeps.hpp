// The particles' substeps in gas: a file of its own, since it holds the kernel that moves them.
#pragma once

#include "core/timers.hpp"
#include "coupling/fluid_force.hpp"
#include "dem/engine.hpp"

namespace pellicle::coupling {

/// Advances all particles by `count` substeps under contacts, gravity and the force of the gas; see
/// dem::Engine::advance for the hook.
void advance_particles(dem::Engine& particles, int count, const FluidForce& force, core::Timers& timers,
                       const dem::SubstepHook& before_motion = {});

}  // namespace pellicle::coupling
