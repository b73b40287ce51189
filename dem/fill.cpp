#include "dem/fill.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.hpp"
#include "dem/fill_relaxation.hpp"
#include "dem/particles.hpp"

namespace pellicle::dem {
namespace {

/// Largest solids fraction that spheres are placed at one by one; above, random sequential addition gets slow and
/// ends at 0.30 to 0.38.
constexpr Real one_by_one_limit = 0.30;
constexpr Real fit_tolerance = 1e-9;  // of a radius

/// Cells as wide as the largest sphere, each with a chain of the spheres whose centre is in it.
class OverlapGrid {
 public:
  OverlapGrid(const Box& box, Real largest_diameter, std::size_t spheres)
      : box_(box), width_(largest_diameter) {
    // Wider cells where there would be many more of them than spheres.
    const Real most = 8 * static_cast<Real>(spheres) + 4096;
    for (;; width_ *= 1.26) {
      Real count = 1;
      for (int a = 0; a < 3; ++a) count *= std::floor((box.max[a] - box.min[a]) / width_) + 1;
      if (count <= most) break;
    }
    for (int a = 0; a < 3; ++a) cells_[a] = static_cast<Index>((box.max[a] - box.min[a]) / width_) + 1;
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
      c[a] =
          std::clamp(static_cast<Index>(std::floor((x[a] - box_.min[a]) / width_)), Index{0}, cells_[a] - 1);
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
  Real width_;
  Index3 cells_{1, 1, 1};
  std::vector<Index> head_, next_;
  std::vector<PlacedSphere> spheres_;
};

/// Sites along one axis, the first and the distance between two: as many as fit at least `pitch` apart.
struct SiteRow {
  Real first = 0, pitch = 0;
  Index count = 0;
};

/// Centres of spheres of radius `largest` in a box, one row an axis; upwards they start at the floor, across they are
/// spread over the width so that the layers stand free of the sides.
SiteRow row_of_lattice(const Box& box, int axis, Real largest, Real pitch) {
  const Real room = box.max[axis] - box.min[axis] - 2 * largest;
  if (room < -fit_tolerance * largest) return {};
  const auto count = static_cast<Index>(room / pitch + 0.25 * fit_tolerance) + 1;
  const Real slack = std::max(0.0, room - pitch * (count - 1));
  return {box.min[axis] + largest + (axis == 2 ? std::min(0.0005 * largest, slack) : 0.5 * slack), pitch,
          count};
}

constexpr Real lattice_pitch = 1.0005;  // of the largest diameter: neighbours do not touch

std::vector<Vec3> fill_lattice(const Room& room, const Box& box, const std::vector<Real>& radii, Real largest,
                               const OverlapGrid& present, const Obstacles& obstacles) {
  std::vector<Vec3> centres;
  const Real pitch = 2 * lattice_pitch * largest;
  const SiteRow x = row_of_lattice(box, 0, largest, pitch), y = row_of_lattice(box, 1, largest, pitch),
                z = row_of_lattice(box, 2, largest, pitch);
  if (x.count == 0 || y.count == 0) return centres;
  for (Index k = 0; k < z.count; ++k) {
    for (Index j = 0; j < y.count; ++j) {
      for (Index i = 0; i < x.count; ++i) {
        if (centres.size() == radii.size()) return centres;
        const Vec3 site{x.first + pitch * i, y.first + pitch * j, z.first + pitch * k};
        const Real radius = radii[centres.size()];
        if (room.holds(site, radius) && present.free(site, radius) && obstacles.clear(site, radius))
          centres.push_back(site);
      }
    }
  }
  return centres;
}

/// Layers of rows, each row in the gaps of the one before, each layer over the gaps of the one below (hexagonal close
/// packing), the rows along x.
std::vector<Vec3> fill_hexagonal(const Room& room, const Box& box, const std::vector<Real>& radii,
                                 Real largest, const OverlapGrid& present, const Obstacles& obstacles) {
  std::vector<Vec3> centres;
  const Real pitch = 2 * lattice_pitch * largest;
  const SiteRow x = row_of_lattice(box, 0, largest, pitch),
                y = row_of_lattice(box, 1, largest, pitch * std::sqrt(3.0) / 2),
                z = row_of_lattice(box, 2, largest, pitch * std::sqrt(2.0 / 3));
  if (x.count == 0 || y.count == 0) return centres;
  // Odd rows and layers stand half a pitch, or a third of a row, further: there the last site may not fit.
  const Real left = box.min.x + largest, front = box.min.y + largest;
  for (Index k = 0; k < z.count; ++k) {
    for (Index j = 0; j < y.count; ++j) {
      for (Index i = 0; i < x.count; ++i) {
        if (centres.size() == radii.size()) return centres;
        const Vec3 site{left + pitch * (i + 0.5 * ((j + k) % 2)), front + y.pitch * (j + (k % 2) / 3.0),
                        z.first + z.pitch * k};
        const Real radius = radii[centres.size()];
        if (room.holds(site, radius) && present.free(site, radius) && obstacles.clear(site, radius))
          centres.push_back(site);
      }
    }
  }
  return centres;
}

/// Random sequential addition.
std::vector<Vec3> fill_one_by_one(const Room& room, const Box& box, const std::vector<Real>& radii,
                                  std::uint64_t seed, OverlapGrid& grid, const Obstacles& obstacles) {
  constexpr int tries = 20000;  // a sphere; at 0.35 solids about one try in a thousand finds a gap
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
      if (!room.holds(x, radius) || !grid.free(x, radius) || !obstacles.clear(x, radius)) continue;
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

/// Sites of a cubic lattice spread over the region, at least as many as asked for: the widest pitch that has them.
std::vector<Vec3> spread_sites(const Room& room, const FillRegion& region, std::size_t count,
                               Real mean_radius, const OverlapGrid& present, const Obstacles& obstacles) {
  const Box box = region_bounds(region);
  std::vector<Vec3> sites;
  Real pitch = std::cbrt(region_volume(region) / static_cast<Real>(count));
  for (; sites.size() < count && pitch > 0.5 * mean_radius; pitch *= 0.99) {
    sites.clear();
    std::array<SiteRow, 3> rows;
    for (int a = 0; a < 3; ++a) {
      const Real width = std::max(0.0, box.max[a] - box.min[a] - 2 * mean_radius);
      const auto gaps = static_cast<Index>(width / pitch);
      rows[static_cast<std::size_t>(a)] = {
          gaps == 0 ? 0.5 * (box.min[a] + box.max[a]) : box.min[a] + mean_radius,
          gaps == 0 ? 0 : width / gaps, gaps + 1};
    }
    const auto& [x, y, z] = rows;
    for (Index k = 0; k < z.count; ++k) {
      for (Index j = 0; j < y.count; ++j) {
        for (Index i = 0; i < x.count; ++i) {
          const Vec3 site{x.first + x.pitch * i, y.first + y.pitch * j, z.first + z.pitch * k};
          Vec3 near = site;
          if (!room.bring_inside(near, mean_radius)) return {};
          if (norm(near - site) > 0.5 * pitch || !present.free(near, mean_radius)) continue;
          if (obstacles.clear(near, mean_radius)) sites.push_back(near);
        }
      }
    }
  }
  return sites;
}

/// Random places in the cells of a lattice, moved apart until none overlaps.
std::vector<Vec3> fill_densely(const Room& room, const FillRegion& region, const std::vector<Real>& radii,
                               std::uint64_t seed, const std::vector<PlacedSphere>& present,
                               const OverlapGrid& grid, const Obstacles& obstacles) {
  constexpr int most_sweeps = 2000;
  Real mean_radius = 0;
  for (const Real r : radii) mean_radius += r / static_cast<Real>(radii.size());
  std::vector<Vec3> sites = spread_sites(room, region, radii.size(), mean_radius, grid, obstacles);
  if (sites.size() < radii.size()) return {};
  const Real jitter = std::cbrt(region_volume(region) / static_cast<Real>(radii.size()));
  // Fisher-Yates: which site a sphere gets says nothing about its number or size, and those left over are anywhere.
  for (std::size_t p = 0; p < radii.size(); ++p) {
    const auto id = static_cast<std::int64_t>(p);
    const Real share = core::random_uniform(seed, core::Purpose::fill_position, 0, id, 1);
    std::swap(sites[p], sites[p + static_cast<std::size_t>(share * static_cast<Real>(sites.size() - p))]);
    const Vec3 shift = core::random_uniform3(seed, core::Purpose::fill_position, 0, id, 1);
    sites[p] += jitter * (shift - Vec3{0.5, 0.5, 0.5});
  }
  sites.resize(radii.size());
  for (std::size_t p = 0; p < radii.size(); ++p) room.bring_inside(sites[p], radii[p]);
  if (!relax_spheres(room, sites, radii, present, most_sweeps, obstacles).clear) sites.clear();
  return sites;
}

}  // namespace

std::vector<Vec3> fill_region(const FillRegion& region, FillPattern pattern, const std::vector<Real>& radii,
                              std::uint64_t seed, const std::vector<PlacedSphere>& present,
                              Obstacles obstacles) {
  if (radii.empty()) return {};
  obstacles.choose_sides(region);
  const Room room(region);
  const Box box = region_bounds(region);
  const Real largest = *std::max_element(radii.begin(), radii.end());
  Real reach = largest;
  for (const auto& s : present) reach = std::max(reach, s.radius);
  OverlapGrid grid(box, 2 * reach, radii.size() + present.size());
  for (const auto& s : present) grid.add(s);
  if (pattern == FillPattern::lattice) return fill_lattice(room, box, radii, largest, grid, obstacles);
  if (pattern == FillPattern::hexagonal) return fill_hexagonal(room, box, radii, largest, grid, obstacles);
  Real volume = 0;
  for (const Real r : radii) volume += sphere_volume(r);
  std::vector<Vec3> some;
  if (volume <= one_by_one_limit * region_volume(region)) {
    OverlapGrid filling = grid;
    some = fill_one_by_one(room, box, radii, seed, filling, obstacles);
    if (some.size() == radii.size()) return some;
  }
  const std::vector<Vec3> all = fill_densely(room, region, radii, seed, present, grid, obstacles);
  return all.size() == radii.size() ? all : some;
}

}  // namespace pellicle::dem
