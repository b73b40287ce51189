// The gas solver of a case: walls as the gas sees them, and the point from which it spreads. Its exchange with particles.
#pragma once

#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "coupling/momentum_exchange.hpp"
#include "dem/walls.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// The walls of a case that cut the gas grid; the sides of the domain, which it ends at anyway, are not among them.
/// Throws InputError if there are such walls, but nothing says where the gas is.
cfd::ImmersedGeometry make_immersed(const CaseSpec& spec, const std::vector<dem::Wall>& walls);

/// The gas solver. `walls` are those of the case in their order. Throws InputError.
cfd::GasSolver make_gas_solver(const CaseSpec& spec, const std::vector<dem::Wall>& walls);

/// The exchange of momentum with the particles of a case. Throws InputError.
coupling::MomentumExchange make_exchange(const CaseSpec& spec, const cfd::GasSolver& gas);

/// The walls of a case; reads STL files.
std::vector<dem::Wall> make_walls(const CaseSpec& spec);

/// What the walls left of the grid, one line; empty if nothing cuts it.
std::string describe_cut(const cfd::FlowGeometry& geometry);

/// Sides of the domain that the gas reaches though no boundary and no wall of the case names them.
struct Leaks {
  bool is_open =
      false;  ///< a wall has gas on both sides: a vessel with a gap, not a body in the gas; not allowed
  std::string message;  ///< empty if there are no such sides
};
Leaks find_leaks(const CaseSpec& spec, const cfd::FlowGeometry& geometry);

}  // namespace pellicle::tools
