#include "cfd/field_memory.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <cstdint>

namespace pellicle::cfd {

namespace {

constexpr std::size_t huge_page = std::size_t{1} << 21;
constexpr std::size_t slab_bytes = 16 * huge_page;  // untouched parts take no memory
constexpr std::size_t large_bytes = std::size_t{1} << 17;
// Between two fields, so that the same cell of many fields does not fall into the same set of the cache.
constexpr std::size_t apart_bytes = 5 * 64;

thread_local FieldMemory* current_memory = nullptr;

}  // namespace

FieldMemory::FieldMemory() : before_(current_memory) { current_memory = this; }

void FieldMemory::close() {
  if (current_memory == this) current_memory = before_;
}

FieldMemory* FieldMemory::current() { return current_memory; }

template <class T>
HostArray<T> FieldMemory::take(std::size_t count) {
  auto& slab = std::get<Slab<T>>(slabs_);
  const std::size_t wanted = (count * sizeof(T) + 63) / 64 * 64 / sizeof(T) + apart_bytes / sizeof(T);
  if (slab.used + wanted > slab.memory.extent(0)) {
    const std::size_t size = std::max(slab_bytes, wanted * sizeof(T)) / sizeof(T);
    slab.memory =
        HostArray<T>(Kokkos::view_alloc(Kokkos::WithoutInitializing, "cfd::field_memory::slab"), size);
    slab.used = 0;
    const auto begin = reinterpret_cast<std::uintptr_t>(slab.memory.data());
    const std::uintptr_t first = (begin + huge_page - 1) / huge_page * huge_page;
    const std::uintptr_t last = (begin + size * sizeof(T)) / huge_page * huge_page;
    // A request; without huge pages the fields work as well, only more slowly.
    if (last > first) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
  }
  const HostArray<T> field =
      Kokkos::subview(slab.memory, Kokkos::pair<std::size_t, std::size_t>(slab.used, slab.used + count));
  slab.used += wanted;
  Kokkos::deep_copy(field, T{0});
  return field;
}

template <class T>
HostArray<T> make_field(const std::string& label, std::size_t count) {
  FieldMemory* memory = FieldMemory::current();
  if (memory == nullptr || count * sizeof(T) < large_bytes) return HostArray<T>(label, count);
  return memory->take<T>(count);
}

template HostArray<Real> make_field<Real>(const std::string&, std::size_t);
template HostArray<float> make_field<float>(const std::string&, std::size_t);

}  // namespace pellicle::cfd
