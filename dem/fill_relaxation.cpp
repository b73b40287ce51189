#include "dem/fill_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pellicle::dem {
namespace {

/// Pairs are pushed to this much beyond contact, as a share of the sum of radii, so that a pair which others push back
/// a little is clear all the same. It costs three times as much of the solids fraction that can be reached.
constexpr Real margin = 2e-3;
/// How far a sphere moves until the pairs are searched again, over the mean radius.
constexpr Real skin_fraction = 0.4;
/// Of the push that would part a pair if nothing else held it. A fluid at a solids fraction of 0.5 takes 160 sweeps
/// with 1.0, 110 with 1.3, 30 with 1.8.
constexpr Real over_relaxation = 1.8;

/// Spheres sorted by cell, and the pairs among them that come near; sphere a of each row is the lower one.
class Pairs {
 public:
  struct Sphere {
    Vec3 x;
    Real r;
  };

  void build(std::vector<Sphere>& spheres, std::vector<std::int32_t>& place, std::size_t movable, Real skin) {
    bin(spheres, place, skin);
    first_.assign(spheres.size() + 1, 0);
    partner_.clear();
    const std::int32_t movable_count = static_cast<std::int32_t>(movable);
    for (std::size_t a = 0; a < spheres.size(); ++a) {
      const Index3 c = cell_of(spheres[a].x);
      for (std::int32_t dz = -1; dz <= 1; ++dz) {
        const Index k = c.z + dz;
        if (k < 0 || k >= cells_.z) continue;
        for (std::int32_t dy = -1; dy <= 1; ++dy) {
          const Index j = c.y + dy;
          if (j < 0 || j >= cells_.y) continue;
          // Cells that are neighbours along x are neighbours in memory.
          const std::size_t low = flat({std::max(c.x - 1, 0), j, k});
          const std::size_t high = flat({std::min(c.x + 1, cells_.x - 1), j, k});
          const auto end = static_cast<std::size_t>(start_[high + 1]);
          for (auto b = std::max(a + 1, static_cast<std::size_t>(start_[low])); b < end; ++b) {
            const Real reach = (spheres[a].r + spheres[b].r) * (1 + margin) + skin;
            if (norm_squared(spheres[b].x - spheres[a].x) >= reach * reach) continue;
            if (place[a] >= movable_count && place[b] >= movable_count) continue;
            partner_.push_back(static_cast<std::int32_t>(b));
          }
        }
      }
      first_[a + 1] = static_cast<std::int64_t>(partner_.size());
    }
  }

  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t a = 0; a + 1 < first_.size(); ++a) {
      for (auto s = first_[a]; s < first_[a + 1]; ++s) {
        visit(a, static_cast<std::size_t>(partner_[static_cast<std::size_t>(s)]));
      }
    }
  }

 private:
  /// Counting sort into cells as wide as the farthest that a pair reaches.
  void bin(std::vector<Sphere>& spheres, std::vector<std::int32_t>& place, Real skin) {
    Vec3 low = spheres.front().x, high = low;
    Real largest = 0;
    for (const Sphere& s : spheres) {
      for (int a = 0; a < 3; ++a) {
        low[a] = std::min(low[a], s.x[a]);
        high[a] = std::max(high[a], s.x[a]);
      }
      largest = std::max(largest, s.r);
    }
    low_ = low;
    width_ = 2 * largest * (1 + margin) + skin;
    const auto most = 4 * static_cast<Real>(spheres.size()) + 64;
    for (;; width_ *= 1.26) {  // no more cells than memory bears where spheres are far apart
      Real count = 1;
      for (int a = 0; a < 3; ++a) count *= std::floor((high[a] - low[a]) / width_) + 1;
      if (count <= most) break;
    }
    for (int a = 0; a < 3; ++a) cells_[a] = static_cast<Index>((high[a] - low[a]) / width_) + 1;
    start_.assign(flat({0, 0, cells_.z}) + 1, 0);
    std::vector<std::size_t> cell(spheres.size());
    for (std::size_t p = 0; p < spheres.size(); ++p) ++start_[(cell[p] = flat(cell_of(spheres[p].x))) + 1];
    for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
    std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
    std::vector<Sphere> sorted(spheres.size());
    std::vector<std::int32_t> sorted_place(spheres.size());
    for (std::size_t p = 0; p < spheres.size(); ++p) {
      const auto slot = static_cast<std::size_t>(next[cell[p]]++);
      sorted[slot] = spheres[p];
      sorted_place[slot] = place[p];
    }
    spheres.swap(sorted);
    place.swap(sorted_place);
  }
  Index3 cell_of(const Vec3& x) const {
    Index3 c;
    for (int a = 0; a < 3; ++a) {
      c[a] = std::clamp(static_cast<Index>((x[a] - low_[a]) / width_), Index{0}, cells_[a] - 1);
    }
    return c;
  }
  std::size_t flat(const Index3& c) const {
    return static_cast<std::size_t>(c.x) +
           static_cast<std::size_t>(cells_.x) *
               (static_cast<std::size_t>(c.y) +
                static_cast<std::size_t>(cells_.y) * static_cast<std::size_t>(c.z));
  }

  Vec3 low_{};
  Real width_ = 0;
  Index3 cells_{1, 1, 1};
  std::vector<std::int32_t> start_, partner_;
  std::vector<std::int64_t> first_;
};

bool none_overlaps(const Pairs& pairs, const std::vector<Pairs::Sphere>& spheres) {
  bool none = true;
  pairs.for_each([&](std::size_t a, std::size_t b) {
    const Real touch = spheres[a].r + spheres[b].r;
    none = none && norm_squared(spheres[b].x - spheres[a].x) >= touch * touch;
  });
  return none;
}

}  // namespace

Relaxation relax_spheres(const Room& room, std::vector<Vec3>& centres, const std::vector<Real>& radii,
                         const std::vector<PlacedSphere>& fixed, int most_sweeps,
                         const Obstacles& obstacles) {
  Relaxation result;
  if (centres.empty()) return {true, 0};
  const std::size_t movable = centres.size();
  std::vector<Pairs::Sphere> spheres(movable + fixed.size());
  std::vector<std::int32_t> place(spheres.size());
  Real mean_radius = 0;
  for (std::size_t p = 0; p < movable; ++p) {
    spheres[p] = {centres[p], radii[p]};
    mean_radius += radii[p] / static_cast<Real>(movable);
  }
  for (std::size_t p = 0; p < fixed.size(); ++p) spheres[movable + p] = {fixed[p].position, fixed[p].radius};
  for (std::size_t p = 0; p < place.size(); ++p) place[p] = static_cast<std::int32_t>(p);
  const auto is_fixed = [&](std::size_t p) { return static_cast<std::size_t>(place[p]) >= movable; };
  const Real skin = skin_fraction * mean_radius;
  const bool inside_all = std::all_of(radii.begin(), radii.end(), [&](Real r) {
    Vec3 somewhere = centres.front();
    return room.bring_inside(somewhere, r);
  });
  if (!inside_all) return result;

  Pairs pairs;
  std::vector<Vec3> built_at(spheres.size());
  std::vector<char> near_wall(spheres.size(), 0);  // may meet one before the pairs are searched again
  bool outdated = true;
  for (; result.sweeps < most_sweeps && !result.clear; ++result.sweeps) {
    if (outdated) {
      pairs.build(spheres, place, movable, skin);
      for (std::size_t p = 0; p < spheres.size(); ++p) {
        built_at[p] = spheres[p].x;
        if (!obstacles.empty() && !is_fixed(p))
          near_wall[p] = obstacles.deepest(spheres[p].x, spheres[p].r + skin) ? 1 : 0;
      }
    }
    bool pushed = false;
    pairs.for_each([&](std::size_t a, std::size_t b) {
      const Vec3 d = spheres[b].x - spheres[a].x;
      const Real touch = spheres[a].r + spheres[b].r;
      const Real reach = touch * (1 + margin);
      const Real squared = norm_squared(d);
      if (squared >= reach * reach) return;
      const Real distance = std::sqrt(squared);
      if (distance < touch) pushed = true;
      const Real push = over_relaxation * (reach - distance);
      const Vec3 n = distance > 0 ? (1 / distance) * d : Vec3{0, 0, 1};
      // The smaller one gives way more.
      const Real share = is_fixed(a) ? 0 : (is_fixed(b) ? 1 : spheres[b].r / touch);
      spheres[a].x -= (push * share) * n;
      spheres[b].x += (push * (1 - share)) * n;
    });
    outdated = false;
    const Real allowance = 0.25 * skin * skin;
    for (std::size_t p = 0; p < spheres.size(); ++p) {
      if (is_fixed(p)) continue;
      room.bring_inside(spheres[p].x, spheres[p].r);
      if (near_wall[p] != 0 && obstacles.push_out(spheres[p].x, spheres[p].r)) {
        room.bring_inside(spheres[p].x, spheres[p].r);
        pushed = pushed || !obstacles.clear(spheres[p].x, spheres[p].r);
      }
      outdated = outdated || norm_squared(spheres[p].x - built_at[p]) > allowance;
    }
    // A push may have closed a gap that had been looked at before.
    result.clear = !pushed && !outdated && none_overlaps(pairs, spheres);
  }
  for (std::size_t p = 0; p < spheres.size(); ++p) {
    if (!is_fixed(p)) centres[static_cast<std::size_t>(place[p])] = spheres[p].x;
  }
  return result;
}

}  // namespace pellicle::dem
