// Taking overlaps out of a dense packing.
#pragma once

#include <vector>

#include "dem/fill.hpp"
#include "dem/fill_region.hpp"

namespace pellicle::dem {

/// What taking out overlaps came to.
struct Relaxation {
  bool clear = false;  ///< nothing overlaps any more
  int sweeps = 0;
};

/// Moves spheres apart until none overlaps another, one of `fixed` or an obstacle, and all are inside: sweeps over all pairs that
/// come near, each pair that is too close is pushed to a little more than contact (Gauss-Seidel projection; the same
/// idea removes overlaps in Jodrey & Tory, Phys. Rev. A 32 (1985) 2347). Radii in m, one a centre. The
/// result depends on the input alone. Gives up after `most_sweeps`.
Relaxation relax_spheres(const Room& room, std::vector<Vec3>& centres, const std::vector<Real>& radii,
                         const std::vector<PlacedSphere>& fixed, int most_sweeps,
                         const Obstacles& obstacles = {});

}  // namespace pellicle::dem
