#include "coupling/substeps.hpp"

namespace pellicle::coupling {

void advance_particles(dem::Engine& particles, int count, const FluidForce& force, core::Timers& timers) {
  std::visit([&](const auto& chosen) { particles.advance(count, chosen, timers); }, force);
}

}  // namespace pellicle::coupling
