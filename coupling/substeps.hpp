// The particles' substeps in gas: a file of its own, since it holds the kernel that moves them.
#pragma once

#include "core/timers.hpp"
#include "coupling/fluid_force.hpp"
#include "dem/engine.hpp"

namespace pellicle::coupling {

/// Advances all particles by `count` substeps under contacts, gravity and the force of the gas.
void advance_particles(dem::Engine& particles, int count, const FluidForce& force, core::Timers& timers);

}  // namespace pellicle::coupling
