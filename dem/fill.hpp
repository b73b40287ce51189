// Placing particles in a region without overlap, on the host, before a run.
#pragma once

#include <cstdint>
#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "dem/fill_region.hpp"
#include "dem/obstacles.hpp"

namespace pellicle::dem {

enum class FillPattern { lattice, random, hexagonal };

/// Spheres that new ones must not overlap.
struct PlacedSphere {
  Vec3 position;
  Real radius = 0;
};

/// Places spheres of the given radii [m] wholly inside the region (to 1e-9 of a radius), touching neither each other
/// nor `present` nor a wall of `obstacles`, whose sides are chosen here. The result depends on the seed alone.
/// - `lattice`: cubic, bottom layer first, pitch 1.0005 of the largest diameter; `hexagonal`: likewise, close-packed.
/// - `random`: up to a solids fraction of 0.30 of the region uniform, one after the other, the largest first (random
///   sequential addition); above, random places in the cells of a lattice are moved apart (see relax_spheres), which
///   reaches 0.60.
/// Returns the centres in the order of the radii. Fewer than asked for mean that not all fit; a random fill then
/// returns a number at best, no places.
std::vector<Vec3> fill_region(const FillRegion& region, FillPattern pattern, const std::vector<Real>& radii,
                              std::uint64_t seed, const std::vector<PlacedSphere>& present = {},
                              Obstacles obstacles = {});

}  // namespace pellicle::dem
