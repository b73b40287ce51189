// What contacts remember: springs that live with the neighbour list, and how they get from one list to the next.
#pragma once

#include "core/checkpoint.hpp"
#include "core/views.hpp"
#include "dem/neighbour_list.hpp"

namespace pellicle::dem {

/// Springs of all contacts as the contact loop sees them: those of a list entry side by side. Both particles of a pair
/// keep a copy, of opposite signs. Empty for laws without springs.
struct SpringSlots {
  DeviceArray<Vec3> spring;  ///< entry slot × springs + s of a neighbour list's slot
  DeviceArray<bool> held;    ///< per slot: it touched in the last substep, so its springs mean something

  KOKKOS_INLINE_FUNCTION Vec3* at(int springs, std::int32_t slot) const {
    return spring.data() + static_cast<std::size_t>(springs) * static_cast<std::size_t>(slot);
  }
};

/// Carries the springs of touching contacts from one neighbour list to the next, through re-sorts of memory, particles
/// that leave, and checkpoints: they are packed before the list is lost, in rows by particle, each spring with the index
/// of the partner, and found again by partner in the rows of the next list.
class ContactHistory {
 public:
  explicit ContactHistory(int springs = 0) : springs_(springs) {}

  /// Forgets all contacts.
  void clear() { place_ = Place::nowhere; }

  /// Packs the springs that `list` has slots for. Nothing happens if they are packed already, or if there are none.
  void pack(const NeighbourList& list);

  /// Follows a re-sort of packed particles: the new entry p < count is what `order(p)` was among `before`. Contacts with
  /// particles that are not in `order` are forgotten; particles that came after the packing have none.
  void reorder(const DeviceArray<std::int32_t>& order, Index before, Index count);

  /// Gives every slot of a new list its springs, and makes room for them.
  void unpack(const NeighbourList& list);

  const SpringSlots& slots() const { return slots_; }

  /// Writes or reads the packed springs. They must be packed.
  void save(core::CheckpointWriter& file) const;
  void load(const core::CheckpointReader& file);

 private:
  enum class Place { nowhere, slots, packed };

  int springs_;
  Place place_ = Place::nowhere;
  SpringSlots slots_;
  // Packed: rows of what `packed_rows_` particles were at the time, and where each present particle's row is.
  Index packed_rows_ = 0;
  Index particles_ = 0;
  DeviceArray<std::int32_t> offset_;   // packed_rows_ + 1
  DeviceArray<std::int32_t> partner_;  // present index, -1 if gone
  DeviceArray<Vec3> spring_;           // entry × springs + s
  DeviceArray<std::int32_t> row_;      // particle -> row, -1 without
  DeviceArray<std::int32_t> row_next_, new_place_;
};

}  // namespace pellicle::dem
