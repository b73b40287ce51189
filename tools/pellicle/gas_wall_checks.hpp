// What walls may not ask of the gas: to follow their motion, or to pass a tube thinner than its cells.
#pragma once

#include <vector>

#include "dem/walls.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// The gas takes every wall as standing still where the case places it. Throws InputError for a wall whose motion would
/// change the room of the gas: a shape that turns, or a swing wider than half a cell; warns of smaller swings and of meshes
/// that turn, which may be round. `walls` as make_walls gives them.
void check_wall_motion(const CaseSpec& spec, const std::vector<dem::Wall>& walls);

/// Throws InputError for a tube, cylinder or cone, so thin that no cell of the gas may have its middle within it: the gas
/// would not see it.
void check_tubes(const CaseSpec& spec);

}  // namespace pellicle::tools
