#include "dem/wall_history.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

void note_rows(const WallList& list, const DeviceArray<WallMemory>& memory,
               const DeviceArray<std::int32_t>& row) {
  Kokkos::parallel_for(
      "dem::wall_history::note_rows", DeviceRange(0, list.count), KOKKOS_LAMBDA(const Index k) {
        if (memory(k).count > 0) row(list.particle(k)) = k;
      });
}

void fill_rows(const WallList& list, const DeviceArray<std::int32_t>& row, Index known, int springs,
               const WallSprings& from, const WallSprings& to) {
  Kokkos::parallel_for(
      "dem::wall_history::fill_rows", DeviceRange(0, list.count), KOKKOS_LAMBDA(const Index k) {
        const Index p = list.particle(k);
        const std::int32_t old = p < known ? row(p) : -1;
        if (old < 0) {
          to.memory(k).count = 0;
          return;
        }
        to.memory(k) = from.memory(old);
        const int entries = most_wall_contacts * springs;
        for (int e = 0; e < to.memory(k).count * springs; ++e)
          to.spring(k * entries + e) = from.spring(old * entries + e);
      });
}

}  // namespace

void WallHistory::pack(const WallList& list, Index particles) {
  if (!remembers_ || place_ != Place::rows) return;
  ensure_size(row_, static_cast<std::size_t>(particles), "dem::wall_history::row");
  Kokkos::deep_copy(row_, -1);
  note_rows(list, rows_.memory, row_);
  std::swap(rows_, packed_);
  packed_rows_ = list.count;
  particles_ = particles;
  place_ = Place::packed;
}

void WallHistory::reorder(const DeviceArray<std::int32_t>& order, Index count) {
  if (place_ != Place::packed) return;
  follow_rows(order, particles_, count, row_, row_next_);
  particles_ = count;
}

void WallHistory::unpack(const WallList& list) {
  if (!remembers_) return;
  const auto rows = static_cast<std::size_t>(list.count);
  ensure_size(rows_.memory, rows, "dem::wall_history::memory");
  ensure_size(rows_.spring, rows * static_cast<std::size_t>(most_wall_contacts * springs_),
              "dem::wall_history::spring");
  fill_rows(list, row_, place_ == Place::packed ? particles_ : 0, springs_, packed_, rows_);
  place_ = Place::rows;
}

std::size_t WallHistory::bytes() const {
  return bytes_of(rows_.memory) + bytes_of(rows_.spring) + bytes_of(packed_.memory) +
         bytes_of(packed_.spring) + bytes_of(row_) + bytes_of(row_next_);
}

void WallHistory::save(core::CheckpointWriter& file) const {
  if (!remembers_) return;
  if (place_ == Place::rows) throw std::logic_error("contacts with walls are saved before they are packed");
  const bool any = place_ == Place::packed;
  file.write(name_ + "/rows", std::int64_t{any ? packed_rows_ : 0});
  file.write(name_ + "/particles", std::int64_t{any ? particles_ : 0});
  if (!any) return;
  file.write(name_ + "/row", host_copy(row_, particles_));
  const auto memory = host_copy(packed_.memory, packed_rows_);
  const auto spring = host_copy(packed_.spring, packed_rows_ * most_wall_contacts * springs_);
  // Contacts that are not there hold what memory held.
  std::vector<WallMemory> meant(static_cast<std::size_t>(packed_rows_));
  std::vector<Vec3> meant_spring(spring.size());
  for (Index r = 0; r < packed_rows_; ++r) {
    const WallMemory& from = memory(r);
    WallMemory& to = meant[static_cast<std::size_t>(r)];
    to.count = from.count;
    std::copy_n(from.wall, from.count, to.wall);
    std::copy_n(from.towards, from.count, to.towards);
    const Index first = r * most_wall_contacts * springs_;
    std::copy_n(spring.data() + first, from.count * springs_, meant_spring.data() + first);
  }
  file.write(name_ + "/memory", meant);
  if (springs_ > 0) file.write(name_ + "/spring", meant_spring);
}

void WallHistory::load(const core::CheckpointReader& file) {
  clear();
  if (!remembers_) return;
  packed_rows_ = static_cast<Index>(file.read_int64(name_ + "/rows"));
  particles_ = static_cast<Index>(file.read_int64(name_ + "/particles"));
  if (particles_ == 0) return;
  read_array(file, (name_ + "/row").c_str(), particles_, row_, "dem::wall_history::row_loaded");
  read_array(file, (name_ + "/memory").c_str(), packed_rows_, packed_.memory,
             "dem::wall_history::memory_loaded");
  if (springs_ > 0) {
    read_array(file, (name_ + "/spring").c_str(), packed_rows_ * most_wall_contacts * springs_,
               packed_.spring, "dem::wall_history::spring_loaded");
  }
  place_ = Place::packed;
}

}  // namespace pellicle::dem
