#include "core/cartesian_grid.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pellicle {

CartesianGrid::CartesianGrid(const Box& box, Index3 cells, std::array<bool, 3> periodic)
    : periodic_(periodic) {
  for (int axis = 0; axis < 3; ++axis) {
    if (cells[axis] < 1) throw std::invalid_argument("a grid needs at least one cell along each axis");
    auto& f = faces_[static_cast<std::size_t>(axis)];
    f.resize(static_cast<std::size_t>(cells[axis]) + 1);
    for (Index i = 0; i <= cells[axis]; ++i) {
      f[static_cast<std::size_t>(i)] = box.min[axis] + (box.max[axis] - box.min[axis]) * i / cells[axis];
    }
    f.back() = box.max[axis];
  }
  check_and_finish();
}

CartesianGrid::CartesianGrid(std::array<std::vector<Real>, 3> faces, std::array<bool, 3> periodic)
    : faces_(std::move(faces)), periodic_(periodic) {
  check_and_finish();
}

void CartesianGrid::check_and_finish() {
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& f = faces_[a];
    const int axis = static_cast<int>(a);
    if (f.size() < 2) throw std::invalid_argument("a grid needs at least one cell along each axis");
    if (!std::is_sorted(f.begin(), f.end(), [](Real p, Real q) { return p <= q; })) {
      throw std::invalid_argument("grid face coordinates must increase strictly");
    }
    cells_[axis] = static_cast<Index>(f.size()) - 1;
    box_.min[axis] = f.front();
    box_.max[axis] = f.back();
    const Real mean = (f.back() - f.front()) / static_cast<Real>(cells_[axis]);
    uniform_[a] = true;
    for (Index i = 0; i < cells_[axis]; ++i) {
      uniform_[a] = uniform_[a] && std::abs(width(axis, i) - mean) <= 1e-9 * mean;
    }
  }
}

Index CartesianGrid::locate(int axis, Real coordinate) const {
  const auto& f = faces(axis);
  const Index n = cells_[axis];
  if (periodic(axis)) {
    const Real length = box_.max[axis] - box_.min[axis];
    coordinate -= length * std::floor((coordinate - box_.min[axis]) / length);
  }
  const auto next = std::upper_bound(f.begin(), f.end(), coordinate);
  const auto i = static_cast<Index>(next - f.begin()) - 1;
  return std::clamp(i, Index{0}, n - 1);
}

}  // namespace pellicle
