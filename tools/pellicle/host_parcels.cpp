#include "tools/pellicle/host_parcels.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "spray/spray.hpp"

namespace pellicle::tools {

HostParcels copy_to_host(const spray::Spray& spray) {
  const spray::Parcels& parcels = spray.parcels();
  const std::pair<Index, Index> used(0, parcels.count);
  const auto state =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, Kokkos::subview(parcels.state, used));
  const auto name =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, Kokkos::subview(parcels.name, used));
  const auto count = static_cast<std::size_t>(parcels.count);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(name(a).nozzle, name(a).number) < std::pair(name(b).nozzle, name(b).number);
  });
  const DeviceArray<spray::ParcelWater> device_water =
      parcels.evaporate ? parcels.water : decltype(parcels.water){};
  const auto water = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, device_water);
  HostParcels all;
  for (const std::size_t i : order) {
    all.state.push_back(state(i));
    all.name.push_back(name(i));
    const spray::NozzleView& nozzle = spray.nozzle(name(i).nozzle);
    const heat::Film content = parcels.evaporate ? spray::content_of(nozzle, water(i), spray.units().water)
                                                 : spray::content_of(nozzle, state(i));
    all.mass.push_back(content.liquid + content.solids);
    all.liquid.push_back(content.liquid);
    const spray::DropletHeat& heat = spray.droplet_heat();
    all.temperature.push_back(
        parcels.evaporate ? heat.water.reference + spray.units().heat * static_cast<Real>(water(i).enthalpy) /
                                                       heat.capacity(content.liquid, content.solids)
                          : 0);
  }
  return all;
}

}  // namespace pellicle::tools
