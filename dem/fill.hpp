// Placing particles in a region without overlap, on the host, before a run.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::dem {

/// A round region between two points of its axis.
struct CylinderRegion {
  Vec3 from, to;  ///< ends of the axis [m]
  Real radius = 0;
};

using FillRegion = std::variant<Box, CylinderRegion>;

enum class FillPattern { lattice, random };

/// Spheres that new ones must not overlap.
struct PlacedSphere {
  Vec3 position;
  Real radius = 0;
};

/// Places spheres of the given radii [m] wholly inside the region (to 1e-9 of a radius), touching neither each other nor `present`.
/// `lattice`: cubic, bottom layer first, pitch 1.001 of the largest diameter. `random`: uniform, one after the other
/// (random sequential addition), which fills to a solids fraction of about 0.30 (15 diameters wide) to 0.35. The result depends on the seed alone.
/// Returns the centres in the order of the radii. Fewer than asked for mean that only so many fit; a random fill tries
/// the largest spheres first, so that what it then returns is good for their number only.
std::vector<Vec3> fill_region(const FillRegion& region, FillPattern pattern, const std::vector<Real>& radii,
                              std::uint64_t seed, const std::vector<PlacedSphere>& present = {});

/// Volume of a region [m³].
Real region_volume(const FillRegion& region);

}  // namespace pellicle::dem
