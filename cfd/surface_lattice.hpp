// Which points of a grid the gas reaches, and where the surfaces cross the lines between them.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cfd/immersed_surface.hpp"
#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::cfd {

/// The corners, edge middles, face centres and centres of a grid's cells: 2 n + 1 points along an axis, and the edges
/// between neighbours. A point is wet if the gas reaches it from the seed along edges that no surface crosses; that
/// tells inside from outside for surfaces of any orientation, thin ones too.
class SurfaceLattice {
 public:
  /// A place on an edge where a surface crosses it.
  struct Crossing {
    float first = 0;           ///< share of the edge before its first crossing, seen from the minus end
    float last = 0;            ///< share before the last one
    std::int32_t surface = 0;  ///< of the first
    Vec3 normal;               ///< of the first, of either sense
  };

  /// Finds the crossings of all surfaces with all edges.
  SurfaceLattice(const CartesianGrid& grid, const std::vector<ImmersedSurface>& surfaces);

  /// Wets what the gas reaches from a point [m]. Returns false if that point has no way to a point of the lattice.
  bool wet_from(const Vec3& seed);

  /// Whether the gas that has spread reaches a point [m] from the lattice.
  bool gas_reaches(const Vec3& point) const;

  std::array<std::size_t, 3> size() const { return size_; }
  std::size_t point(std::size_t i, std::size_t j, std::size_t k) const {
    return i + size_[0] * (j + size_[1] * k);
  }
  std::size_t stride(int axis) const { return axis == 0 ? 1 : (axis == 1 ? size_[0] : size_[0] * size_[1]); }
  const std::vector<Real>& at(int axis) const { return at_[static_cast<std::size_t>(axis)]; }
  bool wet(std::size_t point) const { return wet_[point] != 0; }
  /// Crossing of the edge from a point to the next one along the axis; nullptr: none.
  const Crossing* crossing(int axis, std::size_t point) const;

 private:
  void add_surface(const std::vector<ImmersedSurface>& surfaces, std::int32_t number, int axis);
  bool clear(int axis, const Vec3& from, Real to) const;
  bool reaches(const Vec3& seed, const std::array<std::size_t, 3>& corner) const;
  void spread(std::size_t start);
  std::array<std::array<std::size_t, 3>, 8> corners_around(const Vec3& point) const;

  const std::vector<ImmersedSurface>& surfaces_;
  std::array<bool, 3> periodic_;
  std::array<std::size_t, 3> size_;
  std::array<std::vector<Real>, 3> at_;      ///< coordinates of the points [m]
  std::array<std::vector<Real>, 3> probed_;  ///< where crossings are looked for: a trifle beside the points
  std::vector<std::uint8_t> wet_;
  std::array<std::vector<std::uint8_t>, 3> crossed_;
  std::array<std::unordered_map<std::size_t, Crossing>, 3> crossings_;
};

}  // namespace pellicle::cfd
