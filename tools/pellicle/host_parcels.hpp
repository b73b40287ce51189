// A host copy of the spray's parcels, for output.
#pragma once

#include <vector>

#include "core/types.hpp"
#include "spray/parcels.hpp"

namespace pellicle::spray {
class Spray;
}

namespace pellicle::tools {

/// Parcels in flight, sorted by nozzle and number; entry i of each belongs to the same parcel.
struct HostParcels {
  std::vector<spray::ParcelState> state;
  std::vector<spray::ParcelName> name;
  std::vector<Real> mass;         ///< of all its droplets [kg]
  std::vector<Real> liquid;       ///< of this [kg]
  std::vector<Real> temperature;  ///< [K]; 0 unless droplets have one of their own
  std::size_t count() const { return state.size(); }
};

HostParcels copy_to_host(const spray::Spray& spray);

}  // namespace pellicle::tools
