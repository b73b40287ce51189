// Cells of one axis that are fine in given zones and grow away from them.
#pragma once

#include <vector>

#include "core/types.hpp"

namespace pellicle {

/// A part of an axis in which cells are at most so large.
struct SizeZone {
  Real min = 0, max = 0;  ///< [m]
  Real size = 0;          ///< [m]
};

/// Face coordinates of an axis [m], strictly increasing, from `min` to `max` exactly.
///
/// Cells are at most `size` wide, in a zone at most the zone's size; a face lies on each end of a zone that is inside
/// the axis; neighbours differ by a factor of `growth` at most, on a periodic axis also the last and the first cell.
/// Without zones all cells are equal. Zones may overlap; what lies outside the axis is left out.
/// Throws std::invalid_argument for growth <= 1 and for lengths or sizes that are not positive, std::length_error if it
/// would take more than `most` cells.
std::vector<Real> make_graded_faces(Real min, Real max, Real size, Real growth,
                                    const std::vector<SizeZone>& zones, bool periodic, Index most = 100'000);

}  // namespace pellicle
