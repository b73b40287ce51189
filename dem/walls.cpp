#include "dem/walls.hpp"

namespace pellicle::dem {

DeviceArray<DevicePlane> make_device_planes(const std::vector<PlaneWall>& walls) {
  DeviceArray<DevicePlane> planes("dem::walls::planes", walls.size());
  const auto host = Kokkos::create_mirror_view(planes);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    host(w) = {walls[w].normal, dot(walls[w].normal, walls[w].point), walls[w].velocity, walls[w].material};
  }
  Kokkos::deep_copy(planes, host);
  return planes;
}

}  // namespace pellicle::dem
