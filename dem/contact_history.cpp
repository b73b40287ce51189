#include "dem/contact_history.hpp"

#include <stdexcept>
#include <utility>

#include "dem/engine_arrays.hpp"

namespace pellicle::dem {
namespace {

/// What a slot remembers, in bits: 1 its springs, 2 a bridge.
struct HeldState {
  SpringSlots slots;
  bool springs, bridges;

  KOKKOS_INLINE_FUNCTION std::int32_t operator()(std::int32_t slot) const {
    return (springs && slots.held(slot) ? 1 : 0) + (bridges && slots.bridge(slot) ? 2 : 0);
  }
};

/// Lengths of the packed rows, summed up to offsets; returns how many slots remember something.
std::int32_t find_offsets(const NeighbourList& list, const HeldState& state,
                          const DeviceArray<std::int32_t>& offset) {
  const Index count = list.count;
  const auto row = list.offset;
  Kokkos::parallel_for(
      "dem::contact_history::count_held", DeviceRange(0, count), KOKKOS_LAMBDA(const Index p) {
        std::int32_t found = 0;
        for (std::int32_t slot = row(p); slot < row(p + 1); ++slot) found += state(slot) != 0 ? 1 : 0;
        offset(p) = found;
      });
  std::int32_t total = 0;
  Kokkos::parallel_scan(
      "dem::contact_history::offsets", DeviceRange(0, count + 1),
      KOKKOS_LAMBDA(const Index p, std::int32_t& sum, const bool final) {
        const std::int32_t length = p < count ? offset(p) : 0;
        if (final) offset(p) = sum;
        sum += length;
      },
      total);
  return total;
}

/// Copies what is remembered into packed rows.
struct PackRows {
  int springs;
  NeighbourList list;
  HeldState held;
  DeviceArray<std::int32_t> offset, partner, row, state;
  DeviceArray<Vec3> spring;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    row(p) = p;
    std::int32_t entry = offset(p);
    for (std::int32_t slot = list.offset(p); slot < list.offset(p + 1); ++slot) {
      const std::int32_t bits = held(slot);
      if (bits == 0) continue;
      partner(entry) = list.partner(slot);
      if (held.bridges) state(entry) = bits;
      // A bridge without contact has no springs.
      for (int s = 0; s < springs; ++s) {
        spring(entry * springs + s) = (bits & 1) != 0 ? held.slots.get(s, slot) : Vec3{0, 0, 0};
      }
      ++entry;
    }
  }
};

/// Finds what each slot remembers in the packed row of its particle or, of half lists, in that of its partner.
struct UnpackRows {
  int springs;
  bool bridges;
  Index particles;  ///< that have a row or none; later ones have none
  NeighbourList list;
  SpringSlots slots;
  DeviceArray<std::int32_t> offset, partner, row, state;
  DeviceArray<Vec3> spring;

  /// The packed entry of a particle's row with this partner, -1 if there is none.
  KOKKOS_INLINE_FUNCTION std::int32_t find(Index p, Index q) const {
    const std::int32_t from = p < particles ? row(p) : -1;
    if (from < 0) return -1;
    for (std::int32_t entry = offset(from); entry < offset(from + 1); ++entry) {
      if (partner(entry) == q) return entry;
    }
    return -1;
  }

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    for (std::int32_t slot = list.offset(p); slot < list.offset(p + 1); ++slot) {
      const std::int32_t q = list.partner(slot);
      std::int32_t entry = find(p, q);
      Real sign = 1;
      if (entry < 0) {
        entry = find(q, p);
        sign = -1;
      }
      const std::int32_t bits = entry < 0 ? 0 : (bridges ? state(entry) : 1);
      if (springs > 0) slots.held(slot) = (bits & 1) != 0;
      if (bridges) slots.bridge(slot) = (bits & 2) != 0;
      if (bits == 0) continue;
      for (int s = 0; s < springs; ++s) slots.set(s, slot, sign * spring(entry * springs + s));
    }
  }
};

/// Where each of the old particles goes, -1 for those that leave.
void invert_order(const DeviceArray<std::int32_t>& order, Index count,
                  const DeviceArray<std::int32_t>& new_place) {
  Kokkos::deep_copy(new_place, -1);
  Kokkos::parallel_for(
      "dem::contact_history::invert_order", DeviceRange(0, count),
      KOKKOS_LAMBDA(const Index p) { new_place(order(p)) = p; });
}

}  // namespace

void ContactHistory::pack(const NeighbourList& list) {
  if (!remembers() || place_ != Place::slots) return;
  const auto n = static_cast<std::size_t>(list.count);
  ensure_size(offset_, n + 1, "dem::contact_history::offset");
  ensure_size(row_, n, "dem::contact_history::row");
  const HeldState state{slots_, springs_ > 0, bridges_};
  const auto total = static_cast<std::size_t>(find_offsets(list, state, offset_));
  ensure_size(partner_, total, "dem::contact_history::partner");
  ensure_size(spring_, total * static_cast<std::size_t>(springs_), "dem::contact_history::packed_spring");
  ensure_size(state_, bridges_ ? total : 0, "dem::contact_history::state");
  Kokkos::parallel_for("dem::contact_history::pack", DeviceRange(0, list.count),
                       PackRows{springs_, list, state, offset_, partner_, row_, state_, spring_});
  packed_rows_ = particles_ = list.count;
  place_ = Place::packed;
}

void ContactHistory::reorder(const DeviceArray<std::int32_t>& order, Index before, Index count) {
  if (place_ != Place::packed) return;
  ensure_size(new_place_, static_cast<std::size_t>(before), "dem::contact_history::new_place");
  invert_order(order, count, new_place_);
  follow_rows(order, particles_, count, row_, row_next_);
  const auto new_place = new_place_;
  const auto partner = partner_;
  const auto offset = offset_;
  Kokkos::parallel_for(
      "dem::contact_history::follow_partners", DeviceRange(0, packed_rows_), KOKKOS_LAMBDA(const Index r) {
        for (std::int32_t entry = offset(r); entry < offset(r + 1); ++entry) {
          partner(entry) = partner(entry) < 0 ? -1 : new_place(partner(entry));
        }
      });
  particles_ = count;
}

void ContactHistory::unpack(const NeighbourList& list) {
  if (!remembers()) return;
  const std::size_t entries = list.partner.extent(0);
  slots_.stride = entries + 8;
  ensure_size(slots_.held, springs_ > 0 ? entries : 0, "dem::contact_history::held");
  ensure_size(slots_.bridge, bridges_ ? entries : 0, "dem::contact_history::bridge");
  ensure_size(slots_.spring, 3 * slots_.stride * static_cast<std::size_t>(springs_),
              "dem::contact_history::spring");
  const Index known = place_ == Place::packed ? particles_ : 0;
  Kokkos::parallel_for(
      "dem::contact_history::unpack", DeviceRange(0, list.count),
      UnpackRows{springs_, bridges_, known, list, slots_, offset_, partner_, row_, state_, spring_});
  place_ = Place::slots;
}

std::size_t ContactHistory::bytes() const {
  return bytes_of(slots_.spring) + bytes_of(slots_.held) + bytes_of(slots_.bridge) + bytes_of(offset_) +
         bytes_of(partner_) + bytes_of(spring_) + bytes_of(state_) + bytes_of(row_) + bytes_of(row_next_) +
         bytes_of(new_place_);
}

void ContactHistory::save(core::CheckpointWriter& file) const {
  if (!remembers()) return;
  if (place_ == Place::slots) throw std::logic_error("contacts are saved before they are packed");
  const bool any = place_ == Place::packed;
  file.write("dem/history/packed_rows", std::int64_t{any ? packed_rows_ : 0});
  file.write("dem/history/particles", std::int64_t{any ? particles_ : 0});
  if (!any) return;
  std::int32_t total = 0;
  Kokkos::deep_copy(total, Kokkos::subview(offset_, packed_rows_));
  file.write("dem/history/offset", host_copy(offset_, packed_rows_ + 1));
  file.write("dem/history/row", host_copy(row_, particles_));
  file.write("dem/history/partner", host_copy(partner_, total));
  if (springs_ > 0) file.write("dem/history/spring", host_copy(spring_, total * springs_));
  if (bridges_) file.write("dem/history/state", host_copy(state_, total));
}

void ContactHistory::load(const core::CheckpointReader& file) {
  clear();
  if (!remembers()) return;
  packed_rows_ = static_cast<Index>(file.read_int64("dem/history/packed_rows"));
  particles_ = static_cast<Index>(file.read_int64("dem/history/particles"));
  if (packed_rows_ == 0) return;
  read_array(file, "dem/history/offset", packed_rows_ + 1, offset_, "dem::contact_history::offset_loaded");
  read_array(file, "dem/history/row", particles_, row_, "dem::contact_history::row_loaded");
  std::int32_t total = 0;
  Kokkos::deep_copy(total, Kokkos::subview(offset_, packed_rows_));
  read_array(file, "dem/history/partner", total, partner_, "dem::contact_history::partner_loaded");
  if (springs_ > 0) {
    read_array(file, "dem/history/spring", total * springs_, spring_, "dem::contact_history::spring_loaded");
  }
  if (bridges_) read_array(file, "dem/history/state", total, state_, "dem::contact_history::state_loaded");
  place_ = Place::packed;
}

}  // namespace pellicle::dem
