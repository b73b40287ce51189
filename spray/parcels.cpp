#include "spray/parcels.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace pellicle::spray {
namespace {

/// Fewest parcels that memory grows by.
constexpr Index chunk = 4096;

template <class T>
void grow(DeviceArray<T>& array, Index used, std::size_t size, const char* label) {
  DeviceArray<T> grown(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)), size);
  if (used > 0) {
    const std::pair<Index, Index> kept(0, used);
    Kokkos::deep_copy(Kokkos::subview(grown, kept), Kokkos::subview(array, kept));
  }
  array = grown;
}

template <class T>
auto host_copy(const DeviceArray<T>& array, Index count) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{},
                                             Kokkos::subview(array, std::pair<Index, Index>(0, count)));
}

template <class T>
void read(const core::CheckpointReader& file, const char* name, Index count, const DeviceArray<T>& array) {
  const auto part = Kokkos::subview(array, std::pair<Index, Index>(0, count));
  const auto host = Kokkos::create_mirror_view(part);
  file.read_into(name, host);
  Kokkos::deep_copy(part, host);
}

}  // namespace

std::size_t Parcels::bytes() const {
  return capacity() * (sizeof(ParcelState) + sizeof(ParcelName) + sizeof(ParcelEnd)) +
         water.extent(0) * sizeof(ParcelWater);
}

void reserve(Parcels& parcels, Index size) {
  if (static_cast<std::size_t>(size) <= parcels.capacity()) return;
  const auto wanted = static_cast<std::size_t>(size + std::max(chunk, size / 2));
  grow(parcels.state, parcels.count, wanted, "spray::parcels::state");
  grow(parcels.name, parcels.count, wanted, "spray::parcels::name");
  grow(parcels.end, parcels.count, wanted, "spray::parcels::end");
  if (parcels.evaporate) grow(parcels.water, parcels.count, wanted, "spray::parcels::water");
}

void save(const Parcels& parcels, core::CheckpointWriter& file) {
  file.write("spray/parcels", std::int64_t{parcels.count});
  if (parcels.count == 0) return;
  file.write("spray/state", host_copy(parcels.state, parcels.count));
  file.write("spray/name", host_copy(parcels.name, parcels.count));
  if (parcels.evaporate) {
    // As two columns: a checkpoint holds numbers.
    const auto water = host_copy(parcels.water, parcels.count);
    std::vector<std::int64_t> numbers;
    for (std::size_t i = 0; i < water.extent(0); ++i)
      numbers.insert(numbers.end(), {water(i).evaporated, water(i).enthalpy});
    file.write("spray/water", numbers);
  }
}

void load(Parcels& parcels, const core::CheckpointReader& file) {
  parcels.count = static_cast<Index>(file.read_int64("spray/parcels"));
  const Index count = parcels.count;
  if (count == 0) return;
  parcels.count = 0;  // nothing is to be kept
  reserve(parcels, count);
  parcels.count = count;
  read(file, "spray/state", count, parcels.state);
  read(file, "spray/name", count, parcels.name);
  if (parcels.evaporate) {
    std::vector<std::int64_t> numbers(2 * static_cast<std::size_t>(count));
    file.read_into("spray/water", numbers);
    const auto part = Kokkos::subview(parcels.water, std::pair<Index, Index>(0, count));
    const auto water = Kokkos::create_mirror_view(part);
    for (std::size_t i = 0; i < water.extent(0); ++i) water(i) = {numbers[2 * i], numbers[2 * i + 1]};
    Kokkos::deep_copy(part, water);
  }
  // Between two outer steps all parcels fly, since its beginning.
  Kokkos::deep_copy(Kokkos::subview(parcels.end, std::pair<Index, Index>(0, count)), ParcelEnd{});
}

}  // namespace pellicle::spray
