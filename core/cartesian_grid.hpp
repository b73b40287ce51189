// A Cartesian (tensor-product) grid: the gas grid and the transfer grid are both one of these.
#pragma once

#include <array>
#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle {

struct Box {
  Vec3 min, max;
};

/// Cells of a box, numbered i + nx (j + ny k), each axis with its own, possibly stretched, face coordinates.
class CartesianGrid {
 public:
  CartesianGrid() = default;
  /// Equal cells over the box.
  CartesianGrid(const Box& box, Index3 cells, std::array<bool, 3> periodic = {false, false, false});
  /// Strictly increasing face coordinates [m] per axis (cells + 1 each); throws std::invalid_argument otherwise.
  CartesianGrid(std::array<std::vector<Real>, 3> faces, std::array<bool, 3> periodic = {false, false, false});

  Index3 cells() const { return cells_; }
  Index cell_count() const { return cells_.x * cells_.y * cells_.z; }
  const Box& box() const { return box_; }
  bool periodic(int axis) const { return periodic_[static_cast<std::size_t>(axis)]; }
  /// Face coordinates of an axis [m], size cells + 1.
  const std::vector<Real>& faces(int axis) const { return faces_[static_cast<std::size_t>(axis)]; }
  bool uniform(int axis) const { return uniform_[static_cast<std::size_t>(axis)]; }

  Index index(Index i, Index j, Index k) const { return i + cells_.x * (j + cells_.y * k); }
  Index3 coordinates(Index cell) const {
    return {cell % cells_.x, (cell / cells_.x) % cells_.y, cell / (cells_.x * cells_.y)};
  }
  Real width(int axis, Index i) const {
    const auto& f = faces(axis);
    return f[static_cast<std::size_t>(i) + 1] - f[static_cast<std::size_t>(i)];
  }
  Real center(int axis, Index i) const {
    const auto& f = faces(axis);
    return 0.5 * (f[static_cast<std::size_t>(i) + 1] + f[static_cast<std::size_t>(i)]);
  }
  Real volume(Index i, Index j, Index k) const { return width(0, i) * width(1, j) * width(2, k); }
  /// Index along an axis of the cell that holds the coordinate; clamped to the grid, or wrapped if periodic.
  Index locate(int axis, Real coordinate) const;

 private:
  void check_and_finish();

  std::array<std::vector<Real>, 3> faces_;
  std::array<bool, 3> periodic_{false, false, false};
  std::array<bool, 3> uniform_{true, true, true};
  Index3 cells_{0, 0, 0};
  Box box_{};
};

}  // namespace pellicle
