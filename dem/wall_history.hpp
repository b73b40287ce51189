// What contacts and bridges with walls remember: it lives with the list of particles near walls.
#pragma once

#include <string>
#include <utility>

#include "core/checkpoint.hpp"
#include "core/views.hpp"
#include "dem/wall_candidates.hpp"
#include "dem/wall_list.hpp"

namespace pellicle::dem {

/// Contacts (or liquid bridges) of one particle with walls in the last substep.
struct WallMemory {
  static constexpr std::int32_t any_wall = -1;

  std::int32_t count = 0;
  std::int32_t padding = 0;  ///< so that the bytes of a checkpoint are all meant
  std::int32_t wall[most_wall_contacts] = {};
  Vec3 towards[most_wall_contacts] = {};  ///< unit vectors from the particle to the wall

  /// A contact is known by its wall and its direction: it lives on when the particle rolls from one triangle to the next,
  /// and a wall that touches twice in a corner has two. Returns the entry that is nearest in direction, within 25°, and
  /// not taken yet; -1 for a contact that has just begun.
  KOKKOS_INLINE_FUNCTION int find(std::int32_t of_wall, const Vec3& direction, unsigned taken) const {
    int best = -1;
    Real largest = 0.9;
    for (int i = 0; i < count; ++i) {
      const Real cosine = dot(towards[i], direction);
      if ((of_wall != any_wall && wall[i] != of_wall) || ((taken >> i) & 1U) != 0 || !(cosine > largest))
        continue;
      largest = cosine;
      best = i;
    }
    return best;
  }
};

/// Rows of a wall list's particles as the kernel sees them. Empty where nothing is to be remembered.
struct WallSprings {
  DeviceArray<WallMemory> memory;  ///< of row k of the list
  DeviceArray<Vec3> spring;        ///< entry (k × most_wall_contacts + contact) × springs + s
};

/// Carries contacts and their springs, or bridges, from one wall list to the next, as ContactHistory does for pairs.
class WallHistory {
 public:
  /// Remembers nothing.
  WallHistory() = default;
  /// `name` is the group in checkpoints. Bridges have no springs.
  WallHistory(std::string name, int springs) : remembers_(true), springs_(springs), name_(std::move(name)) {}

  /// Forgets all contacts.
  void clear() { place_ = Place::nowhere; }
  /// Puts the rows of `list` aside. Nothing happens if they are already, or if there are none.
  void pack(const WallList& list, Index particles);
  /// Follows a re-sort: the new entry p < count is what `order(p)` was. Particles that came after the packing have
  /// nothing to remember.
  void reorder(const DeviceArray<std::int32_t>& order, Index count);
  /// Gives every row of a new list what its particle remembers, and makes room for it.
  void unpack(const WallList& list);

  const WallSprings& rows() const { return rows_; }

  /// Device memory held [bytes].
  std::size_t bytes() const;

  /// Writes or reads what was put aside. It must have been.
  void save(core::CheckpointWriter& file) const;
  void load(const core::CheckpointReader& file);

 private:
  enum class Place { nowhere, rows, packed };

  bool remembers_ = false;
  int springs_ = 0;
  std::string name_;
  Place place_ = Place::nowhere;
  WallSprings rows_;
  // Put aside: rows as they were, and where each present particle's row is.
  WallSprings packed_;
  Index packed_rows_ = 0;
  Index particles_ = 0;
  DeviceArray<std::int32_t> row_;  // particle -> packed row, -1 without
  DeviceArray<std::int32_t> row_next_;
};

}  // namespace pellicle::dem
