// One contact for each place where a sphere touches walls, however many surfaces meet there.
#pragma once

#include "dem/wall_geometry.hpp"

namespace pellicle::dem {

/// Contacts of one particle with one wall that are closer in direction than this (20°) are one: the deepest. So a mesh of a
/// round vessel, whose facets meet at small angles, acts like the vessel.
inline constexpr Real merge_cosine = 0.93969262078590843;

/// Two points no further apart than this share of a particle's radius are the same place.
inline constexpr Real same_place = 1e-6;

/// The most contacts that one particle has with walls; more than three walls hardly ever meet.
inline constexpr int most_wall_contacts = 8;

/// Where one particle overlaps a surface.
struct WallCandidate {
  ClosestPoint at;
  std::int32_t surface;
  std::int32_t wall;
};

/// The surfaces that a particle overlaps, nearest first.
class WallCandidates {
 public:
  /// Of more surfaces than this the nearest are kept. What can shadow a surface is nearer than it, so those that are left
  /// out change nothing but the contacts with other places that they were.
  static constexpr int capacity = 32;

  // The entries are not set: most particles need one or two of them, and zeroing all costs as much as a contact.
  KOKKOS_INLINE_FUNCTION WallCandidates() {
  }  // NOLINT(modernize-use-equals-default): a union's would be deleted

  KOKKOS_INLINE_FUNCTION int count() const { return count_; }
  KOKKOS_INLINE_FUNCTION bool crowded() const { return crowded_; }
  KOKKOS_INLINE_FUNCTION const WallCandidate& operator[](int i) const { return entry_[i]; }

  KOKKOS_INLINE_FUNCTION void insert(const WallCandidate& c) {
    int place = count_;
    while (place > 0 && before(c, entry_[place - 1])) --place;
    crowded_ = crowded_ || count_ == capacity;
    if (place == capacity) return;
    const int last = count_ < capacity ? count_ : capacity - 1;
    for (int i = last; i > place; --i) entry_[i] = entry_[i - 1];
    entry_[place] = c;
    count_ = count_ < capacity ? count_ + 1 : capacity;
  }

  /// Drops what is no place of its own, for a sphere of this radius:
  /// - a closest point on the rim of a surface through which a nearer surface passes: on the union of the two it is not
  ///   the closest point of its neighbourhood (edges and corners of a mesh, seams of walls);
  /// - a point where a nearer surface is touched already (two walls that lie in each other);
  /// - a contact of the same wall in nearly the same direction as a deeper one.
  KOKKOS_INLINE_FUNCTION void select(const WallGeometry& geometry, Real radius) {
    if (count_ < 2) return;
    bool keep[capacity];
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      keep[i] = kept < most_wall_contacts && !shadowed(geometry, i, same_place * radius) &&
                !merged(keep, i, same_place * radius);
      kept += keep[i] ? 1 : 0;
    }
    int next = 0;
    for (int i = 0; i < count_; ++i) {
      if (keep[i]) entry_[next++] = entry_[i];
    }
    count_ = next;
  }

 private:
  KOKKOS_INLINE_FUNCTION static bool before(const WallCandidate& a, const WallCandidate& b) {
    return a.at.distance < b.at.distance || (a.at.distance == b.at.distance && a.surface < b.surface);
  }
  KOKKOS_INLINE_FUNCTION bool shadowed(const WallGeometry& geometry, int i, Real slack) const {
    if (!entry_[i].at.rim) return false;
    for (int j = 0; j < i; ++j) {
      if (Kokkos::abs(geometry.closest(entry_[j].surface, entry_[i].at.point).distance) < slack) return true;
    }
    return false;
  }
  KOKKOS_INLINE_FUNCTION bool merged(const bool* keep, int i, Real slack) const {
    for (int j = 0; j < i; ++j) {
      if (!keep[j]) continue;
      if (entry_[j].wall == entry_[i].wall &&
          dot(entry_[j].at.towards, entry_[i].at.towards) > merge_cosine) {
        return true;
      }
      if (norm_squared(entry_[j].at.point - entry_[i].at.point) < slack * slack) return true;
    }
    return false;
  }

  union {
    WallCandidate entry_[capacity];
  };
  int count_ = 0;
  bool crowded_ = false;
};

}  // namespace pellicle::dem
