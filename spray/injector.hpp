// Parcels that leave the nozzles: how many follows from rate and time, what each is from its number.
#pragma once

#include <cstdint>
#include <vector>

#include "core/types.hpp"
#include "heat/surface_state.hpp"
#include "spray/droplet_evaporation_laws.hpp"
#include "spray/nozzle.hpp"
#include "spray/parcels.hpp"
#include "spray/whole_units.hpp"

namespace pellicle::spray {

/// What kernels need of a nozzle.
struct NozzleView {
  Vec3 position, axis;         ///< [m], unit vector
  Vec3 side_a, side_b;         ///< unit vectors at right angles to it and to each other
  Real cosine_in, cosine_out;  ///< of the half angles between which droplets go
  bool hollow;                 ///< droplets leave from the rim of the orifice, away from its centre
  Real radius, speed;          ///< [m], [m/s]
  Real density;                ///< of a droplet [kg/m3]
  Real solids_fraction;
  Real parcel_mass;  ///< [kg]
  // Where droplets evaporate, else 0.
  Real liquid_density;        ///< of the liquid part [kg/m3]
  Real warmth;                ///< with which they leave, over the reference [K]
  std::int64_t liquid_units;  ///< of liquid in a parcel, in whole units: what is dry has exactly none left
  CaptureEfficiency efficiency;
};

/// What is in a parcel [kg].
KOKKOS_INLINE_FUNCTION heat::Film content_of(const NozzleView& nozzle, const ParcelState& parcel) {
  const Real mass = nozzle.density * volume_of(parcel);
  const Real solids = nozzle.solids_fraction * mass;
  return {mass - solids, solids};
}
/// The same where it evaporates; `unit` of water [kg].
KOKKOS_INLINE_FUNCTION heat::Film content_of(const NozzleView& nozzle, const ParcelWater& water, Real unit) {
  return {unit * static_cast<Real>(nozzle.liquid_units - water.evaporated),
          nozzle.solids_fraction * nozzle.parcel_mass};
}
/// Content of parcel i, whichever way.
KOKKOS_INLINE_FUNCTION heat::Film content_of(const Parcels& parcels, Index i, const NozzleView& nozzle,
                                             const WholeUnits& units) {
  return parcels.evaporate ? content_of(nozzle, parcels.water(i), units.water)
                           : content_of(nozzle, parcels.state(i));
}
/// Mass [kg] of all droplets of parcel i.
KOKKOS_INLINE_FUNCTION Real mass_of(const Parcels& parcels, Index i, const NozzleView& nozzle,
                                    const WholeUnits& units) {
  if (!parcels.evaporate) return nozzle.density * volume_of(parcels.state(i));
  const heat::Film content = content_of(nozzle, parcels.water(i), units.water);
  return content.liquid + content.solids;
}

/// The droplets of one nozzle. The n-th parcel (n from 0) leaves when (n + 1/2) parcels' mass has come out since the nozzle
/// opened, so that the mass injected by any time is rate × time to within half a parcel, whatever the steps. Directions
/// are uniform over the solid angle of the cone, or between the two cones of a hollow one; places are uniform over the
/// orifice, or on its rim. All random numbers of a parcel follow from seed, nozzle and number.
class Injector {
 public:
  /// `number` is the nozzle's place in the list. Throws std::invalid_argument for sizes that make no sense.
  Injector(const Nozzle& nozzle, std::int32_t number, std::uint64_t seed);

  /// From here on droplets evaporate: `solids_density` [kg/m3] of what remains, `heat` for their enthalpy. The mass of a
  /// parcel changes by a few 1e-14 of the largest one's: its liquid becomes a whole number of units. Throws
  /// std::invalid_argument if no liquid of a positive density gives droplets of theirs together with such solids, and if
  /// a parcel's liquid is less than a unit.
  void let_evaporate(Real solids_density, const DropletHeat& heat, const WholeUnits& units);

  /// Number of parcels that have left by a time [s].
  std::int64_t due(Real time) const;
  /// Adds those due between two times [s] to the end of the arrays, which have room for them; `end.time` becomes the time
  /// of their birth after `begin`.
  void add(Real begin, Real end, Parcels& parcels, const WholeUnits& units);
  /// That each parcel brings along, in whole units.
  std::int64_t enthalpy(const WholeUnits& units) const { return whole(enthalpy_ / units.heat); }

  std::int64_t injected() const { return next_; }
  void set_injected(std::int64_t parcels) { next_ = parcels; }
  Real parcel_mass() const { return view_.parcel_mass; }
  const NozzleView& view() const { return view_; }
  const Nozzle& nozzle() const { return nozzle_; }

 private:
  Nozzle nozzle_;
  NozzleView view_{};
  DropletSizes sizes_;
  std::int32_t number_;
  std::uint64_t seed_;
  Real enthalpy_ = 0;      // of a new parcel, above the reference [J]
  std::int64_t next_ = 0;  // number of the next parcel
};

}  // namespace pellicle::spray
