#include "tools/pellicle/simulation.hpp"

#include "core/error.hpp"

namespace pellicle::tools {

int run_simulation(const CaseSpec&, const RunOptions&) { throw RunError("this build cannot run cases"); }

}  // namespace pellicle::tools
