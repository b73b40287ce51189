// The diameters of the droplets of a nozzle, drawn on the device.
#pragma once

#include <variant>

#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/size_distribution.hpp"

namespace pellicle::spray {

/// One diameter, or how diameters are spread, by number.
using DropletDiameter = std::variant<Real, dem::SizeDistribution>;

/// Draws diameters by mass: parcels have equal mass, so that a parcel stands for the more droplets the smaller they are,
/// and the droplets are then spread by number as the distribution says.
struct DropletSizes {
  DeviceArray<Real> edges;       ///< of classes, or the diameters themselves [m]
  DeviceArray<Real> cumulative;  ///< share of the mass up to the upper edge of each class, up to 1
  bool discrete = true;
  bool constant_by_mass = false;  ///< within a class; else by number

  /// Diameter [m] for a number in [0, 1): the inverse of the cumulative distribution by mass.
  KOKKOS_INLINE_FUNCTION Real diameter(Real share) const {
    Index low = 0;
    Index high = static_cast<Index>(cumulative.extent(0)) - 1;  // the first class beyond `share`
    while (low < high) {
      const Index middle = (low + high) / 2;
      if (cumulative(middle) > share) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    if (discrete) return edges(low);
    const Real below = low == 0 ? Real(0) : cumulative(low - 1);
    const Real within = (share - below) / (cumulative(low) - below);
    const Real a = edges(low);
    const Real b = edges(low + 1);
    if (constant_by_mass) return a + within * (b - a);
    // Constant by number is d³ by mass, whose integral from a is (d⁴ − a⁴)/4.
    const Real a4 = a * a * a * a;
    const Real d = Kokkos::sqrt(Kokkos::sqrt(a4 + within * (b * b * b * b - a4)));
    return Kokkos::min(Kokkos::max(d, a), b);
  }
};

/// Copies a distribution to the device; `mean_volume` [m3] becomes that of a droplet, by number. Throws
/// std::invalid_argument where the distribution makes no sense.
DropletSizes make_droplet_sizes(const DropletDiameter& diameter, Real& mean_volume);

}  // namespace pellicle::spray
