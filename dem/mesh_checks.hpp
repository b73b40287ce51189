// From loose triangles to a mesh: corners that are meant to be one become one, and what does not fit is counted.
#pragma once

#include <array>
#include <vector>

#include "dem/stl.hpp"

namespace pellicle::dem {

/// A triangle as a file has it.
struct Facet {
  Vec3 normal{};  ///< may be zero
  std::array<Vec3, 3> corner{};
};

/// Welds corners, drops triangles without area and doubled ones, and looks at the edges of the others. The order of the
/// triangles and of their corners stays.
TriangleMesh weld_facets(const std::vector<Facet>& facets, MeshReport& report);

}  // namespace pellicle::dem
