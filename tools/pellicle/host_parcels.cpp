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
  HostParcels all;
  for (const std::size_t i : order) {
    all.state.push_back(state(i));
    all.name.push_back(name(i));
    all.mass.push_back(spray.nozzle(name(i).nozzle).density * spray::volume_of(state(i)));
  }
  return all;
}

}  // namespace pellicle::tools
