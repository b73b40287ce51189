// The parcels of all nozzles: device arrays, one entry a parcel, compacted once an outer step.
#pragma once

#include <cstdint>

#include "core/checkpoint.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"

namespace pellicle::spray {

/// What a parcel of equal droplets is, in one cache line.
struct alignas(64) ParcelState {
  Vec3 position;      ///< [m]
  Vec3 velocity;      ///< [m/s]
  Real diameter = 0;  ///< of each droplet [m]
  Real droplets = 0;  ///< that it stands for; no whole number
};

/// Which parcel it is: the n-th of a nozzle.
struct ParcelName {
  std::int64_t number = 0;
  std::int32_t nozzle = 0;
  std::int32_t unused = 0;  ///< no padding: the struct is written to checkpoints as it is
};

/// What has become of a parcel in the present outer step.
enum class ParcelFate : std::int32_t { flying, captured, wall_loss, overspray, evaporated };
inline constexpr int fate_count = 5;

struct ParcelEnd {
  ParcelFate fate = ParcelFate::flying;
  std::int32_t particle = -1;  ///< that captured it: its place in the arrays of particles
  Real time =
      0;  ///< when, since the beginning of the outer step; of a new parcel that flies: when it is born [s]
};

/// What a parcel has exchanged with the gas, in whole units; where droplets evaporate.
struct ParcelWater {
  std::int64_t evaporated = 0;  ///< less what condensed
  std::int64_t enthalpy = 0;    ///< it has now, above that at the reference temperature
};

/// Arrays are at least `count` long; entry i of each belongs to the same parcel. Their order is that of birth, nozzle by
/// nozzle within an outer step.
struct Parcels {
  Index count = 0;
  DeviceArray<ParcelState> state;
  DeviceArray<ParcelName> name;
  DeviceArray<ParcelEnd> end;
  bool evaporate = false;
  DeviceArray<ParcelWater> water;  ///< empty unless they evaporate

  std::size_t capacity() const { return state.extent(0); }
  std::size_t bytes() const;
};

/// Makes room for so many parcels, in chunks; the present ones are kept.
void reserve(Parcels& parcels, Index size);

/// Volume [m3] of all droplets of a parcel.
KOKKOS_INLINE_FUNCTION Real volume_of(const ParcelState& parcel) {
  return parcel.droplets * (3.14159265358979323846 / 6) * parcel.diameter * parcel.diameter * parcel.diameter;
}

void save(const Parcels& parcels, core::CheckpointWriter& file);
void load(Parcels& parcels, const core::CheckpointReader& file);

}  // namespace pellicle::spray
