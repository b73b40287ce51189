// Walls of the engine from those of a case.
#pragma once

#include "dem/walls.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Reads the STL file, if there is one, and logs what it holds. Throws InputError where it cannot be used.
dem::Wall make_wall(const CaseSpec& spec, const WallSpec& wall);

}  // namespace pellicle::tools
