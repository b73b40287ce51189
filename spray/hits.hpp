// The parcels that particles captured in one outer step: sorted, so that what several bring to one particle is summed in
// the same order whatever the threads did.
#pragma once

#include <cstdint>

#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/particles.hpp"
#include "heat/surface_state.hpp"
#include "spray/hit_record.hpp"

namespace pellicle::spray {

/// One captured parcel, in a cache line. Sorted by particle, nozzle and number of the parcel.
struct alignas(64) Hit {
  std::int32_t id = 0;      ///< of the particle
  std::int32_t nozzle = 0;  ///< of the parcel
  std::int64_t number = 0;  ///< of the parcel
  Index particle = 0;       ///< its place in the arrays of particles
  Index cell = -1;          ///< of the gas grid, where the droplets were; -1: no gas
  Real time = 0;            ///< [s]
  heat::Film film{};        ///< what the parcel brings [kg]
  Real enthalpy =
      0;  ///< that the droplets bring, at the gas's temperature or their own, above the reference [J]
  Real free_heat = 0;  ///< what of it nothing gave: from the nozzle's temperature to the gas's [J]

  KOKKOS_INLINE_FUNCTION bool before(const Hit& b) const {
    if (id != b.id) return id < b.id;
    return nozzle != b.nozzle ? nozzle < b.nozzle : number < b.number;
  }
};

/// Memory for hits, kept from step to step.
class HitList {
 public:
  /// Makes room for so many; what is there is lost when it grows.
  void reserve(Index size);
  const DeviceArray<Hit>& hits() const { return hits_; }
  /// Sorts the first `count`: runs of a few by insertion, then runs are merged two by two, each hit finding its place by
  /// itself. All hits differ, so the result is unique.
  void sort(Index count);
  std::size_t bytes() const { return 2 * hits_.extent(0) * sizeof(Hit); }

 private:
  DeviceArray<Hit> hits_, aside_;
};

/// What hits change on particles.
struct HitTargets {
  dem::Particles particles;
  DeviceArray<heat::Film> film;
  DeviceArray<HitRecord> record;
  // With heat; without, the temperature array is empty and nothing is mixed.
  DeviceArray<Real> temperature;    ///< of particles [K]
  DeviceArray<Real> heat_capacity;  ///< by material [J/kg/K]
  heat::HeatCapacities capacities;
  DeviceArray<Real> gas_temperature;     ///< of the gas grid's cells [K]
  DeviceArray<Real> nozzle_temperature;  ///< with which droplets leave [K]
  bool own_heat = false;                 ///< droplets have a temperature: `enthalpy` of each hit is set
};

/// Adds the first `count` hits, which are sorted, to the particles: film, record, and with heat the temperature that
/// particle and droplets have together, the droplets having that of the gas; sets `enthalpy` and `free_heat` of each. With
/// `own_heat` the droplets have the temperature that their enthalpy says.
void add_hits(const DeviceArray<Hit>& hits, Index count, const HitTargets& targets);

/// What the droplets of some hits carry [J].
struct HitHeat {
  Real enthalpy = 0, free_heat = 0;
};

/// Sums over the first `count` hits, in blocks of a fixed size; `partial` is scratch that grows.
HitHeat sum_heat(const DeviceArray<Hit>& hits, Index count, DeviceArray<HitHeat>& partial);

}  // namespace pellicle::spray
