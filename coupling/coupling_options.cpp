#include "coupling/coupling_options.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace pellicle::coupling {

namespace {
std::array<bool, 3> periodic_axes(const CartesianGrid& grid) {
  return {grid.periodic(0), grid.periodic(1), grid.periodic(2)};
}
}  // namespace

CartesianGrid make_transfer_grid(const CartesianGrid& gas, Real cell_size) {
  if (!(cell_size > 0)) throw InputError("coupling.transfer_grid.cell_size: must be positive");
  Index3 cells;
  for (int axis = 0; axis < 3; ++axis) {
    const Real length = gas.box().max[axis] - gas.box().min[axis];
    cells[axis] = std::max(Index{1}, static_cast<Index>(std::lround(length / cell_size)));
  }
  return {gas.box(), cells, periodic_axes(gas)};
}

CartesianGrid make_transfer_grid(const CartesianGrid& gas, Index3 cells) {
  return {gas.box(), cells, periodic_axes(gas)};
}

}  // namespace pellicle::coupling
