#include "cfd/surface_lattice.hpp"

#include <algorithm>
#include <cmath>

namespace pellicle::cfd {

namespace {

// Surfaces often lie exactly on grid planes. Looking for crossings a trifle beside the points decides on which side
// such a point is, the same for all its edges. The trifle leads inwards at both sides of the domain, so that a vessel
// as large as the domain does not close the inlets in its bottom and the outlet in its top; at periodic sides, which are
// one, it is the same. It differs from axis to axis, lest it run along a tilted surface.
constexpr Real trifle = 1e-7;
constexpr std::array<Real, 3> of_axis{1, 0.7321, 0.5477};

std::vector<Real> probe_beside(const std::vector<Real>& at, int axis, bool periodic) {
  Real smallest = at.back() - at.front();
  for (std::size_t i = 1; i < at.size(); ++i) smallest = std::min(smallest, at[i] - at[i - 1]);
  const Real step = trifle * of_axis[static_cast<std::size_t>(axis)] * smallest;
  std::vector<Real> probed(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Real share = (at[i] - at.front()) / (at.back() - at.front());
    probed[i] = at[i] + step * (periodic ? 0.3719 : 1.3719 - 2 * share);
  }
  return probed;
}

LineLattice lines_along(int axis, const std::array<std::vector<Real>, 3>& at) {
  LineLattice lines;
  lines.axis = axis;
  lines.across = axis == 0   ? std::array<int, 2>{1, 2}
                 : axis == 1 ? std::array<int, 2>{0, 2}
                             : std::array<int, 2>{0, 1};
  for (std::size_t d = 0; d < 2; ++d) lines.at[d] = at[static_cast<std::size_t>(lines.across[d])];
  return lines;
}

}  // namespace

SurfaceLattice::SurfaceLattice(const CartesianGrid& grid, const std::vector<ImmersedSurface>& surfaces)
    : surfaces_(surfaces) {
  std::size_t points = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    periodic_[a] = grid.periodic(axis);
    for (Index i = 0; i < grid.cells()[axis]; ++i) {
      at_[a].push_back(grid.faces(axis)[static_cast<std::size_t>(i)]);
      at_[a].push_back(grid.center(axis, i));
    }
    at_[a].push_back(grid.faces(axis).back());
    probed_[a] = probe_beside(at_[a], axis, periodic_[a]);
    size_[a] = at_[a].size();
    points *= size_[a];
  }
  wet_.assign(points, 0);
  for (int axis = 0; axis < 3; ++axis) {
    crossed_[static_cast<std::size_t>(axis)].assign(points, 0);
    for (std::size_t s = 0; s < surfaces.size(); ++s)
      add_surface(surfaces, static_cast<std::int32_t>(s), axis);
  }
}

void SurfaceLattice::add_surface(const std::vector<ImmersedSurface>& surfaces, std::int32_t number,
                                 int axis) {
  const auto ua = static_cast<std::size_t>(axis);
  const LineLattice lines = lines_along(axis, probed_);
  const std::vector<Real>& along = probed_[ua];
  for (const SurfaceShape& shape : surfaces[static_cast<std::size_t>(number)].shapes) {
    find_crossings(shape, lines, [&](std::size_t a, std::size_t b, Real position, const Vec3& normal) {
      if (!(position >= along.front() && position < along.back())) return;
      const auto next = std::upper_bound(along.begin(), along.end(), position);
      const auto i = static_cast<std::size_t>(next - along.begin()) - 1;
      const auto share = static_cast<float>((position - along[i]) / (along[i + 1] - along[i]));
      const std::size_t p = i * stride(axis) + a * stride(lines.across[0]) + b * stride(lines.across[1]);
      crossed_[ua][p] = 1;
      const auto [entry, is_new] = crossings_[ua].try_emplace(p, Crossing{share, share, number, normal});
      if (is_new) return;
      Crossing& held = entry->second;
      if (share < held.first) held = {share, held.last, number, normal};
      held.last = std::max(held.last, share);
    });
  }
}

const SurfaceLattice::Crossing* SurfaceLattice::crossing(int axis, std::size_t point) const {
  const auto a = static_cast<std::size_t>(axis);
  if (crossed_[a][point] == 0) return nullptr;
  return &crossings_[a].find(point)->second;
}

// Whether nothing lies on the way along an axis.
bool SurfaceLattice::clear(int axis, const Vec3& from, Real to) const {
  std::array<std::vector<Real>, 3> one;
  for (std::size_t a = 0; a < 3; ++a) one[a] = {from[static_cast<int>(a)]};
  const LineLattice line = lines_along(axis, one);
  const auto [low, high] = std::minmax(from[axis], to);
  bool free = true;
  for (const ImmersedSurface& surface : surfaces_) {
    for (const SurfaceShape& shape : surface.shapes) {
      find_crossings(shape, line, [&](std::size_t, std::size_t, Real position, const Vec3&) {
        if (position >= low && position <= high) free = false;
      });
    }
  }
  return free;
}

bool SurfaceLattice::reaches(const Vec3& seed, const std::array<std::size_t, 3>& corner) const {
  Vec3 at = seed;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Real to = probed_[a][corner[a]];
    if (!clear(axis, at, to)) return false;
    at[axis] = to;
  }
  return true;
}

// Of the part of the lattice that a point lies in.
std::array<std::array<std::size_t, 3>, 8> SurfaceLattice::corners_around(const Vec3& point) const {
  std::array<std::size_t, 3> low{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& along = at_[a];
    const auto next = std::upper_bound(along.begin(), along.end(), point[static_cast<int>(a)]);
    const auto i = static_cast<std::size_t>(next - along.begin());
    low[a] = i == 0 ? 0 : std::min(i - 1, along.size() - 2);
  }
  std::array<std::array<std::size_t, 3>, 8> corners{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    corners[corner] = {low[0] + (corner & 1), low[1] + ((corner >> 1) & 1), low[2] + (corner >> 2)};
  }
  return corners;
}

bool SurfaceLattice::wet_from(const Vec3& seed) {
  for (const auto& to : corners_around(seed)) {
    if (!reaches(seed, to)) continue;
    spread(point(to[0], to[1], to[2]));
    return true;
  }
  return false;
}

bool SurfaceLattice::gas_reaches(const Vec3& from) const {
  const auto corners = corners_around(from);
  return std::any_of(corners.begin(), corners.end(),
                     [&](const auto& to) { return wet(point(to[0], to[1], to[2])) && reaches(from, to); });
}

void SurfaceLattice::spread(std::size_t start) {
  std::vector<std::size_t> open{start};
  wet_[start] = 1;
  while (!open.empty()) {
    const std::size_t p = open.back();
    open.pop_back();
    const std::size_t place[3] = {p % size_[0], (p / size_[0]) % size_[1], p / (size_[0] * size_[1])};
    const auto wet_it = [&](std::size_t q) {
      if (wet_[q] != 0) return;
      wet_[q] = 1;
      open.push_back(q);
    };
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t step = stride(static_cast<int>(a));
      const std::size_t last = size_[a] - 1;
      if (place[a] < last && crossed_[a][p] == 0) wet_it(p + step);
      if (place[a] > 0 && crossed_[a][p - step] == 0) wet_it(p - step);
      // Along a periodic axis the first and the last point are one.
      if (periodic_[a] && place[a] == 0) wet_it(p + last * step);
      if (periodic_[a] && place[a] == last) wet_it(p - last * step);
    }
  }
}

}  // namespace pellicle::cfd
