#include "coupling/grid_locator.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace pellicle::coupling {

namespace {

AxisLocator make_axis(const CartesianGrid& grid, int axis) {
  const std::vector<Real>& faces = grid.faces(axis);
  AxisLocator made;
  const std::string label = std::string("coupling::grid_locator::faces_") + "xyz"[axis];
  made.faces = DeviceArray<Real>(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), faces.size());
  const auto faces_host = Kokkos::create_mirror_view(made.faces);
  for (std::size_t i = 0; i < faces.size(); ++i) faces_host(i) = faces[i];
  Kokkos::deep_copy(made.faces, faces_host);
  made.min = faces.front();
  made.max = faces.back();
  made.cells = grid.cells()[axis];
  made.cells_per_metre = made.cells / (made.max - made.min);
  made.uniform = grid.uniform(axis);
  made.periodic = grid.periodic(axis);
  return made;
}

}  // namespace

GridLocator::GridLocator(const CartesianGrid& grid)
    : x(make_axis(grid, 0)), y(make_axis(grid, 1)), z(make_axis(grid, 2)) {}

bool same_cells(const CartesianGrid& a, const CartesianGrid& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.cells()[axis] != b.cells()[axis] || a.periodic(axis) != b.periodic(axis)) return false;
    const std::vector<Real>&p = a.faces(axis), &q = b.faces(axis);
    const Real tolerance = 1e-9 * (p.back() - p.front());
    if (!std::equal(p.begin(), p.end(), q.begin(),
                    [&](Real s, Real t) { return std::abs(s - t) <= tolerance; })) {
      return false;
    }
  }
  return true;
}

}  // namespace pellicle::coupling
