// Where the bins of a line lie.
#pragma once

#include <vector>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// A line cut into equal bins. Across the line a bin is `thickness` wide, half on each side, in every direction but
/// the one that is averaged over, in which it has no bounds. Used on the device.
struct LineGeometry {
  Vec3 from;
  Vec3 direction;           ///< along the line, of length 1
  Vec3 across[2];           ///< perpendicular to it, of length 1
  int across_count = 0;     ///< 1 with depth averaging, else 2
  Real length = 0;          ///< [m]
  Real half_thickness = 0;  ///< [m]
  Index points = 0;

  /// Bin that holds the position, or -1. A bin holds its lower faces, not its upper ones.
  KOKKOS_INLINE_FUNCTION Index bin(const Vec3& position) const {
    const Vec3 offset = position - from;
    for (int n = 0; n < across_count; ++n) {
      const Real distance = dot(offset, across[n]);
      if (distance < -half_thickness || distance >= half_thickness) return -1;
    }
    const Real along = dot(offset, direction);
    if (along < 0 || along >= length) return -1;
    const auto b = static_cast<Index>(along / length * points);
    return b < points ? b : points - 1;
  }

  Real center_along(Index bin) const { return length * (bin + 0.5) / points; }
};

/// Throws InputError if the line has no length, no points or no thickness, or runs along the averaged direction.
LineGeometry make_line_geometry(const LineSpec& spec);

/// Positions [m] of the bins' centres: the coordinate along the axis for a line along an axis, else the distance from
/// `from`.
std::vector<double> line_positions(const LineSpec& spec, const LineGeometry& line);

/// A bin's share of a gas cell.
struct CellShare {
  Index cell;
  Real share;  ///< the shares of a bin add to 1
};

/// For each bin the gas cells that it overlaps, by volume; exact for lines along an axis, by 8 x 8 x 8 (along,
/// across, deep: 2 samples a cell) points for others. A bin outside the grid has none.
std::vector<std::vector<CellShare>> bin_cells(const LineSpec& spec, const LineGeometry& line,
                                              const CartesianGrid& grid);

}  // namespace pellicle::tools
