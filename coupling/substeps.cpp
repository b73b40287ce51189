#include "coupling/substeps.hpp"

namespace pellicle::coupling {

void advance_particles(dem::Engine& particles, int count, const FluidForce& force, core::Timers& timers,
                       const dem::SubstepHook& before_motion) {
  std::visit([&](const auto& chosen) { particles.advance(count, chosen, timers, before_motion); }, force);
}

}  // namespace pellicle::coupling
