// What contacts remember: springs and liquid bridges that live with the neighbour list, and how they get from one list to
// the next.
#pragma once

#include "core/checkpoint.hpp"
#include "core/views.hpp"
#include "dem/neighbour_list.hpp"

namespace pellicle::dem {

/// Springs of all contacts as the contact loop sees them, one array a component. Where both particles of a pair have it in
/// their rows, both keep a copy, of opposite signs. Empty for laws without springs.
struct SpringSlots {
  DeviceArray<Real>
      spring;  ///< component e of spring s of a neighbour list's slot: entry (3 s + e) stride + slot
  DeviceArray<bool> held;    ///< per slot: it touched in the last substep, so its springs mean something
  DeviceArray<bool> bridge;  ///< per slot: a liquid bridge spans it
  std::size_t stride = 0;    ///< whole vectors of eight beyond the last slot can be read

  KOKKOS_INLINE_FUNCTION Real* component(int component) const {
    return spring.data() + static_cast<std::size_t>(component) * stride;
  }
  KOKKOS_INLINE_FUNCTION Vec3 get(int s, std::int32_t slot) const {
    return {component(3 * s)[slot], component(3 * s + 1)[slot], component(3 * s + 2)[slot]};
  }
  KOKKOS_INLINE_FUNCTION void set(int s, std::int32_t slot, const Vec3& value) const {
    component(3 * s)[slot] = value.x;
    component(3 * s + 1)[slot] = value.y;
    component(3 * s + 2)[slot] = value.z;
  }
};

/// Carries springs of touching contacts and bridges from one neighbour list to the next, through re-sorts of memory, particles
/// that leave, and checkpoints: they are packed before the list is lost, in rows by particle, each with the index
/// of the partner, and found again by partner in the rows of the next list.
class ContactHistory {
 public:
  explicit ContactHistory(int springs = 0, bool bridges = false) : springs_(springs), bridges_(bridges) {}

  /// Forgets all contacts.
  void clear() { place_ = Place::nowhere; }

  /// Packs what `list` has slots for. Nothing happens if they are packed already, or if there are none.
  void pack(const NeighbourList& list);

  /// Follows a re-sort of packed particles: the new entry p < count is what `order(p)` was among `before`. Contacts with
  /// particles that are not in `order` are forgotten; particles that came after the packing have none.
  void reorder(const DeviceArray<std::int32_t>& order, Index before, Index count);

  /// Gives every slot of a new list what it remembers, and makes room for that.
  void unpack(const NeighbourList& list);

  const SpringSlots& slots() const { return slots_; }

  /// Device memory held [bytes].
  std::size_t bytes() const;

  /// Writes or reads what is packed. It must be.
  void save(core::CheckpointWriter& file) const;
  void load(const core::CheckpointReader& file);

 private:
  enum class Place { nowhere, slots, packed };

  bool remembers() const { return springs_ > 0 || bridges_; }

  int springs_;
  bool bridges_;
  Place place_ = Place::nowhere;
  SpringSlots slots_;
  // Packed: rows of what `packed_rows_` particles were at the time, and where each present particle's row is.
  Index packed_rows_ = 0;
  Index particles_ = 0;
  DeviceArray<std::int32_t> offset_;   // packed_rows_ + 1
  DeviceArray<std::int32_t> partner_;  // present index, -1 if gone
  DeviceArray<Vec3> spring_;           // entry × springs + s
  DeviceArray<std::int32_t> state_;    // of the entry: 1 springs, 2 a bridge, 3 both; only with bridges
  DeviceArray<std::int32_t> row_;      // particle -> row, -1 without
  DeviceArray<std::int32_t> row_next_, new_place_;
};

}  // namespace pellicle::dem
