#include "dem/fill.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace pellicle::dem {
namespace {

Box bounds(const FillRegion& region) {
  if (const auto* box = std::get_if<Box>(&region)) return *box;
  const auto& c = std::get<CylinderRegion>(region);
  Box box;
  const Vec3 axis = (1 / norm(c.to - c.from)) * (c.to - c.from);
  for (int a = 0; a < 3; ++a) {
    const Real reach = c.radius * std::sqrt(std::max(0.0, 1 - axis[a] * axis[a]));
    box.min[a] = std::min(c.from[a], c.to[a]) - reach;
    box.max[a] = std::max(c.from[a], c.to[a]) + reach;
  }
  return box;
}

/// Of a radius; a slot of exactly one diameter must hold a sphere whatever the last bit of its coordinates.
constexpr Real fit_tolerance = 1e-9;

bool fits(const FillRegion& region, const Vec3& x, Real sphere_radius) {
  const Real radius = (1 - fit_tolerance) * sphere_radius;
  if (const auto* box = std::get_if<Box>(&region)) {
    for (int a = 0; a < 3; ++a) {
      if (x[a] < box->min[a] + radius || x[a] > box->max[a] - radius) return false;
    }
    return true;
  }
  const auto& c = std::get<CylinderRegion>(region);
  const Real length = norm(c.to - c.from);
  const Vec3 axis = (1 / length) * (c.to - c.from);
  const Real along = dot(x - c.from, axis);
  if (along < radius || along > length - radius) return false;
  return norm(x - c.from - along * axis) <= c.radius - radius;
}

/// Cells as wide as the largest sphere, each with a chain of the spheres whose centre is in it.
class OverlapGrid {
 public:
  OverlapGrid(const Box& box, Real largest_diameter) : box_(box), size_(largest_diameter) {
    for (int a = 0; a < 3; ++a) {
      cells_[a] =
          std::max(Index{1}, static_cast<Index>(std::min((box.max[a] - box.min[a]) / size_, 1000.0)) + 1);
    }
    // A coarser grid than asked for where a box has more than 1000 cells along an axis.
    for (int a = 0; a < 3; ++a) width_[a] = std::max(size_, (box.max[a] - box.min[a]) / cells_[a]);
    head_.assign(static_cast<std::size_t>(cells_.x) * static_cast<std::size_t>(cells_.y) *
                     static_cast<std::size_t>(cells_.z),
                 -1);
  }

  bool free(const Vec3& x, Real radius) const {
    const Index3 c = cell(x);
    for (Index k = std::max(c.z - 1, 0); k <= std::min(c.z + 1, cells_.z - 1); ++k) {
      for (Index j = std::max(c.y - 1, 0); j <= std::min(c.y + 1, cells_.y - 1); ++j) {
        for (Index i = std::max(c.x - 1, 0); i <= std::min(c.x + 1, cells_.x - 1); ++i) {
          for (Index s = head_[flat({i, j, k})]; s >= 0; s = next_[static_cast<std::size_t>(s)]) {
            const PlacedSphere& other = spheres_[static_cast<std::size_t>(s)];
            const Real reach = radius + other.radius;
            if (norm_squared(other.position - x) < reach * reach) return false;
          }
        }
      }
    }
    return true;
  }

  void add(const PlacedSphere& sphere) {
    auto& head = head_[flat(cell(sphere.position))];
    next_.push_back(head);
    head = static_cast<Index>(spheres_.size());
    spheres_.push_back(sphere);
  }

 private:
  Index3 cell(const Vec3& x) const {
    Index3 c;
    for (int a = 0; a < 3; ++a) {
      c[a] = std::clamp(static_cast<Index>(std::floor((x[a] - box_.min[a]) / width_[a])), Index{0},
                        cells_[a] - 1);
    }
    return c;
  }
  std::size_t flat(const Index3& c) const {
    return static_cast<std::size_t>(c.x) +
           static_cast<std::size_t>(cells_.x) *
               (static_cast<std::size_t>(c.y) +
                static_cast<std::size_t>(cells_.y) * static_cast<std::size_t>(c.z));
  }

  Box box_;
  Real size_;
  Index3 cells_{1, 1, 1};
  Vec3 width_{};
  std::vector<Index> head_, next_;
  std::vector<PlacedSphere> spheres_;
};

std::vector<Vec3> fill_lattice(const FillRegion& region, const std::vector<Real>& radii, Real largest,
                               const OverlapGrid& present) {
  std::vector<Vec3> centres;
  const Box box = bounds(region);
  const Real pitch = 2.001 * largest;
  Index3 n;
  Vec3 first;
  for (int a = 0; a < 3; ++a) {
    const Real room = box.max[a] - box.min[a] - 2 * largest;
    if (room < -fit_tolerance * largest) return centres;
    n[a] = static_cast<Index>(room / pitch + 0.25 * fit_tolerance) + 1;
    // Spread over the width so that the layers stand free of the sides; upwards they start at the floor.
    const Real slack = std::max(0.0, room - pitch * (n[a] - 1));
    first[a] = box.min[a] + largest + (a == 2 ? std::min(0.0005 * largest, slack) : 0.5 * slack);
  }
  for (Index k = 0; k < n.z; ++k) {
    for (Index j = 0; j < n.y; ++j) {
      for (Index i = 0; i < n.x; ++i) {
        if (centres.size() == radii.size()) return centres;
        const Vec3 x{first.x + pitch * i, first.y + pitch * j, first.z + pitch * k};
        if (fits(region, x, radii[centres.size()]) && present.free(x, radii[centres.size()]))
          centres.push_back(x);
      }
    }
  }
  return centres;
}

std::vector<Vec3> fill_random(const FillRegion& region, const std::vector<Real>& radii, std::uint64_t seed,
                              OverlapGrid& grid) {
  constexpr int tries = 20000;  // a sphere; at 0.35 solids about one try in a thousand finds a gap
  const Box box = bounds(region);
  std::vector<Vec3> centres(radii.size());
  // Large ones first: small ones still find gaps when the region is nearly full.
  std::vector<std::size_t> order(radii.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return radii[a] > radii[b]; });
  for (std::size_t placed = 0; placed < order.size(); ++placed) {
    const Real radius = radii[order[placed]];
    bool found = false;
    for (int attempt = 0; attempt < tries && !found; ++attempt) {
      const Vec3 share = core::random_uniform3(seed, core::Purpose::fill_position, attempt,
                                               static_cast<std::int64_t>(order[placed]));
      Vec3 x;
      for (int a = 0; a < 3; ++a) {
        x[a] = box.min[a] + radius + share[a] * (box.max[a] - box.min[a] - 2 * radius);
      }
      if (!fits(region, x, radius) || !grid.free(x, radius)) continue;
      grid.add({x, radius});
      centres[order[placed]] = x;
      found = true;
    }
    if (!found) {
      centres.resize(placed);  // how many fit; the caller refuses an incomplete fill
      return centres;
    }
  }
  return centres;
}

}  // namespace

std::vector<Vec3> fill_region(const FillRegion& region, FillPattern pattern, const std::vector<Real>& radii,
                              std::uint64_t seed, const std::vector<PlacedSphere>& present) {
  if (radii.empty()) return {};
  Real largest = *std::max_element(radii.begin(), radii.end());
  Real reach = largest;
  for (const auto& s : present) reach = std::max(reach, s.radius);
  OverlapGrid grid(bounds(region), 2 * reach);
  for (const auto& s : present) grid.add(s);
  if (pattern == FillPattern::lattice) return fill_lattice(region, radii, largest, grid);
  return fill_random(region, radii, seed, grid);
}

Real region_volume(const FillRegion& region) {
  if (const auto* box = std::get_if<Box>(&region)) {
    const Vec3 l = box->max - box->min;
    return l.x * l.y * l.z;
  }
  const auto& c = std::get<CylinderRegion>(region);
  return std::numbers::pi * c.radius * c.radius * norm(c.to - c.from);
}

}  // namespace pellicle::dem
