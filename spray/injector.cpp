#include "spray/injector.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/random.hpp"

namespace pellicle::spray {
namespace {

constexpr Real two_pi = 6.283185307179586476925286766559;

struct AddParcels {
  NozzleView nozzle;
  DropletSizes sizes;
  std::int32_t number;
  std::uint64_t seed;
  std::int64_t first;  ///< number of the first parcel
  Real first_born;     ///< after the beginning of the outer step [s]
  Real interval;       ///< between two parcels [s]
  Real latest;         ///< [s]
  Index place;         ///< of the first in the arrays
  ParcelWater water;   ///< of each, where they evaporate
  Parcels parcels;

  KOKKOS_INLINE_FUNCTION void operator()(const Index i) const {
    const std::int64_t n = first + i;
    const core::RandomWords way = core::random_words(seed, core::Purpose::spray, n, number, 0);
    const core::RandomWords spot = core::random_words(seed, core::Purpose::spray, n, number, 1);
    const core::RandomWords size = core::random_words(seed, core::Purpose::spray, n, number, 2);
    // Uniform over the solid angle: the cosine of the angle to the axis is uniform.
    const Real share = core::to_uniform(way.word[0], way.word[1]);
    const Real cosine = nozzle.cosine_in - share * (nozzle.cosine_in - nozzle.cosine_out);
    const Real sine = Kokkos::sqrt(Kokkos::max((1 - cosine) * (1 + cosine), Real(0)));
    const Real azimuth = two_pi * core::to_uniform(way.word[2], way.word[3]);
    const Vec3 outward = Kokkos::cos(azimuth) * nozzle.side_a + Kokkos::sin(azimuth) * nozzle.side_b;
    Vec3 offset = nozzle.radius * outward;
    if (!nozzle.hollow) {
      const Real r = nozzle.radius * Kokkos::sqrt(core::to_uniform(spot.word[0], spot.word[1]));
      const Real angle = two_pi * core::to_uniform(spot.word[2], spot.word[3]);
      offset = (r * Kokkos::cos(angle)) * nozzle.side_a + (r * Kokkos::sin(angle)) * nozzle.side_b;
    }
    ParcelState made;
    made.position = nozzle.position + offset;
    made.velocity = nozzle.speed * (cosine * nozzle.axis + sine * outward);
    made.diameter = sizes.diameter(core::to_uniform(size.word[0], size.word[1]));
    made.droplets = 1;
    made.droplets = nozzle.parcel_mass / (nozzle.density * volume_of(made));
    if (parcels.evaporate) parcels.water(place + i) = water;
    const Real born = first_born + static_cast<Real>(i) * interval;
    parcels.state(place + i) = made;
    parcels.name(place + i) = ParcelName{n, number, 0};
    parcels.end(place + i) =
        ParcelEnd{ParcelFate::flying, -1, Kokkos::min(Kokkos::max(born, Real(0)), latest)};
  }
};

}  // namespace

Injector::Injector(const Nozzle& nozzle, std::int32_t number, std::uint64_t seed)
    : nozzle_(nozzle), number_(number), seed_(seed) {
  Real mean_volume = 0;
  sizes_ = make_droplet_sizes(nozzle.diameter, mean_volume);
  if (!(mean_volume > 0 && nozzle.density > 0 && nozzle.droplets_per_parcel > 0)) {
    throw std::invalid_argument("droplets must have a size, a density and a number per parcel");
  }
  view_.position = nozzle.position;
  view_.axis = nozzle.axis;
  view_.side_a = perpendicular_to(nozzle.axis);
  view_.side_b = cross(nozzle.axis, view_.side_a);
  view_.hollow = nozzle.pattern == SprayPattern::hollow;
  view_.cosine_in = view_.hollow ? std::cos(0.5 * nozzle.inner_cone_angle) : 1;
  view_.cosine_out = std::cos(0.5 * nozzle.cone_angle);
  view_.radius = nozzle.radius;
  view_.speed = nozzle.speed;
  view_.density = nozzle.density;
  view_.solids_fraction = nozzle.solids_fraction;
  view_.parcel_mass = nozzle.droplets_per_parcel * nozzle.density * mean_volume;
  view_.efficiency = nozzle.efficiency;
}

std::int64_t Injector::due(Real time) const {
  const Real open = std::min(time, nozzle_.to) - nozzle_.from;
  if (!(open > 0)) return 0;
  return static_cast<std::int64_t>(std::floor(nozzle_.mass_rate * open / view_.parcel_mass + 0.5));
}

void Injector::let_evaporate(Real solids_density, const DropletHeat& heat, const WholeUnits& units) {
  // Volumes add up: 1/density = s/solids_density + (1 - s)/liquid_density.
  const Real s = nozzle_.solids_fraction;
  const Real of_liquid = 1 / nozzle_.density - s / solids_density;
  if (s < 1 && !(of_liquid > 0)) {
    throw std::invalid_argument("droplets of this density and solids_fraction would have no room for liquid");
  }
  view_.liquid_density = s < 1 ? (1 - s) / of_liquid : nozzle_.density;
  view_.liquid_units = whole((1 - s) * view_.parcel_mass / units.water);
  if (s < 1) {
    if (view_.liquid_units < 1024)
      throw std::invalid_argument("parcels of one nozzle are too small beside those of another");
    view_.parcel_mass = units.water * static_cast<Real>(view_.liquid_units) / (1 - s);
  }
  view_.warmth = nozzle_.temperature - heat.water.reference;
  enthalpy_ = heat.capacity((1 - s) * view_.parcel_mass, s * view_.parcel_mass) * view_.warmth;
}

void Injector::add(Real begin, Real end, Parcels& parcels, const WholeUnits& units) {
  const std::int64_t count = due(end) - next_;
  if (count <= 0) return;
  const Real interval = view_.parcel_mass / nozzle_.mass_rate;
  const Real first_born = nozzle_.from + (static_cast<Real>(next_) + 0.5) * interval - begin;
  Kokkos::parallel_for(
      "spray::injector::add", DeviceRange(0, static_cast<Index>(count)),
      AddParcels{view_, sizes_, number_, seed_, next_, first_born, interval, end - begin, parcels.count,
                 ParcelWater{0, parcels.evaporate ? enthalpy(units) : 0}, parcels});
  parcels.count += static_cast<Index>(count);
  next_ += count;
}

}  // namespace pellicle::spray
