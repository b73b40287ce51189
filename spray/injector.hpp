// Parcels that leave the nozzles: how many follows from rate and time, what each is from its number.
#pragma once

#include <cstdint>
#include <vector>

#include "core/types.hpp"
#include "spray/nozzle.hpp"
#include "spray/parcels.hpp"

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
  CaptureEfficiency efficiency;
};

/// The droplets of one nozzle. The n-th parcel (n from 0) leaves when (n + 1/2) parcels' mass has come out since the nozzle
/// opened, so that the mass injected by any time is rate × time to within half a parcel, whatever the steps. Directions
/// are uniform over the solid angle of the cone, or between the two cones of a hollow one; places are uniform over the
/// orifice, or on its rim. All random numbers of a parcel follow from seed, nozzle and number.
class Injector {
 public:
  /// `number` is the nozzle's place in the list. Throws std::invalid_argument for sizes that make no sense.
  Injector(const Nozzle& nozzle, std::int32_t number, std::uint64_t seed);

  /// Number of parcels that have left by a time [s].
  std::int64_t due(Real time) const;
  /// Adds those due between two times [s] to the end of the arrays, which have room for them; `end.time` becomes the time
  /// of their birth after `begin`.
  void add(Real begin, Real end, Parcels& parcels);

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
  std::int64_t next_ = 0;  // number of the next parcel
};

}  // namespace pellicle::spray
