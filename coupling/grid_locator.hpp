// What a kernel needs to find its way in a Cartesian grid.
#pragma once

#include <Kokkos_Core.hpp>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"

namespace pellicle::coupling {

/// One axis of a grid, uniform or stretched, on the device.
struct AxisLocator {
  DeviceArray<Real> faces;  ///< coordinates, cells + 1 [m]
  Real min = 0, max = 0;    ///< [m]
  Real cells_per_metre = 0;
  Index cells = 0;
  bool uniform = true, periodic = false;

  /// The coordinate inside the axis's range if the axis is periodic; unchanged otherwise.
  KOKKOS_INLINE_FUNCTION Real wrap(Real x) const {
    if (!periodic || (x >= min && x < max)) return x;
    const Real length = max - min;
    return x - length * Kokkos::floor((x - min) / length);
  }
  /// Cell that holds a coordinate; the nearest one if the coordinate is outside.
  KOKKOS_INLINE_FUNCTION Index locate(Real x) const {
    if (!(x > min)) return 0;
    if (x >= max) return cells - 1;
    if (uniform) {
      const auto i = static_cast<Index>((x - min) * cells_per_metre);
      return i < cells ? i : cells - 1;
    }
    Index low = 0, high = cells;  // faces(low) <= x < faces(high)
    while (high - low > 1) {
      const Index middle = (low + high) / 2;
      if (faces(middle) <= x) {
        low = middle;
      } else {
        high = middle;
      }
    }
    return low;
  }
};

/// A grid on the device. Cells are numbered i + nx (j + ny k).
struct GridLocator {
  AxisLocator x, y, z;

  GridLocator() = default;
  /// Copies the face coordinates to the device.
  explicit GridLocator(const CartesianGrid& grid);

  KOKKOS_INLINE_FUNCTION Index cell_count() const { return x.cells * y.cells * z.cells; }
  KOKKOS_INLINE_FUNCTION Index index(Index i, Index j, Index k) const {
    return i + x.cells * (j + y.cells * k);
  }
  KOKKOS_INLINE_FUNCTION Real volume(Index i, Index j, Index k) const {
    return (x.faces(i + 1) - x.faces(i)) * (y.faces(j + 1) - y.faces(j)) * (z.faces(k + 1) - z.faces(k));
  }
};

/// Whether two grids have the same cells (face coordinates equal to 1e-9 of a grid's length, same periodic axes).
bool same_cells(const CartesianGrid& a, const CartesianGrid& b);

}  // namespace pellicle::coupling
