#include "cfd/immersed_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pellicle::cfd {

namespace {

// Ends of a shape are drawn out by this share of its size, so that no line slips through where two shapes meet.
constexpr Real joint = 1e-9;

struct IndexRange {
  std::size_t first, last;  // first <= i < last
};

IndexRange find_range(const std::vector<Real>& at, Real low, Real high) {
  const auto first = std::lower_bound(at.begin(), at.end(), low);
  const auto last = std::upper_bound(first, at.end(), high);
  return {static_cast<std::size_t>(first - at.begin()), static_cast<std::size_t>(last - at.begin())};
}

Vec3 point_of(const LineLattice& lines, std::size_t a, std::size_t b) {
  Vec3 p{};
  p[lines.across[0]] = lines.at[0][a];
  p[lines.across[1]] = lines.at[1][b];
  return p;
}

void cross_plane(const PlaneSurface& plane, const LineLattice& lines, const CrossingFound& found) {
  const Real along = plane.normal[lines.axis];
  if (along == 0) return;
  for (std::size_t b = 0; b < lines.at[1].size(); ++b) {
    for (std::size_t a = 0; a < lines.at[0].size(); ++a) {
      found(a, b, (plane.offset - dot(plane.normal, point_of(lines, a, b))) / along, plane.normal);
    }
  }
}

// Where one line crosses a revolved segment: the roots of r(s)^2 = (r0 + k (z(s) - z0))^2 between its ends.
class RevolvedLine {
 public:
  RevolvedLine(const RevolvedSurface& s, const Vec3& p, int axis) : surface_(s) {
    const Vec3 from = p - s.origin;
    z_ = dot(from, s.axis);
    dz_ = s.axis[axis];
    w_ = from - z_ * s.axis;
    Vec3 direction{};
    direction[axis] = 1;
    d_ = direction - dz_ * s.axis;
    slack_ = joint * (std::abs(s.r0) + std::abs(s.r1) + std::abs(s.z1 - s.z0));
  }

  template <class Found>
  void solve(Found&& found) const {
    const RevolvedSurface& s = surface_;
    if (std::abs(s.z1 - s.z0) <= slack_) {
      // A disc or an annulus. A line within its plane does not cross it.
      if (dz_ == 0) return;
      const Real at = (s.z0 - z_) / dz_;
      const Real r = norm(w_ + at * d_);
      if (r >= std::min(s.r0, s.r1) - slack_ && r <= std::max(s.r0, s.r1) + slack_) found(at, s.axis);
      return;
    }
    const Real k = (s.r1 - s.r0) / (s.z1 - s.z0);
    const Real q = s.r0 + k * (z_ - s.z0);
    const Real a = dot(d_, d_) - k * k * dz_ * dz_;
    const Real b = dot(w_, d_) - q * k * dz_;
    const Real c = dot(w_, w_) - q * q;
    if (std::abs(a) <= 1e-14) {
      if (b != 0) take(-0.5 * c / b, k, q, found);
      return;
    }
    const Real discriminant = b * b - a * c;
    if (discriminant < 0) return;
    // Without cancellation: one root from the sum of equal signs, the other from the product of both.
    const Real root = b + std::copysign(std::sqrt(discriminant), b);
    take(-root / a, k, q, found);
    if (root != 0) take(-c / root, k, q, found);
  }

 private:
  template <class Found>
  void take(Real at, Real k, Real q, Found&& found) const {
    const RevolvedSurface& s = surface_;
    const Real z = z_ + at * dz_;
    const Real radius = q + at * k * dz_;
    if (z < std::min(s.z0, s.z1) - slack_ || z > std::max(s.z0, s.z1) + slack_ || radius < -slack_) return;
    const Vec3 across = w_ + at * d_;
    const Real r = norm(across);
    const Vec3 outward = r > 0 ? (1 / r) * across : Vec3{};
    const Vec3 normal = outward - k * s.axis;
    const Real length = norm(normal);
    if (length > 0) found(at, (1 / length) * normal);
  }

  const RevolvedSurface& surface_;
  Vec3 w_, d_;
  Real z_, dz_, slack_;
};

// Bounds of a revolved surface: along a coordinate its circles reach r sqrt(1 - axis^2) beyond their centres.
std::pair<Vec3, Vec3> bounds(const RevolvedSurface& s) {
  Vec3 low{}, high{};
  for (int a = 0; a < 3; ++a) {
    const Real reach = std::sqrt(std::max(Real{0}, 1 - s.axis[a] * s.axis[a]));
    const Real c0 = s.origin[a] + s.z0 * s.axis[a];
    const Real c1 = s.origin[a] + s.z1 * s.axis[a];
    const Real slack = joint * (s.r0 + s.r1 + std::abs(s.z1 - s.z0));
    low[a] = std::min(c0 - reach * s.r0, c1 - reach * s.r1) - slack;
    high[a] = std::max(c0 + reach * s.r0, c1 + reach * s.r1) + slack;
  }
  return {low, high};
}

void cross_revolved(const RevolvedSurface& surface, const LineLattice& lines, const CrossingFound& found) {
  const auto [low, high] = bounds(surface);
  const IndexRange a_range = find_range(lines.at[0], low[lines.across[0]], high[lines.across[0]]);
  const IndexRange b_range = find_range(lines.at[1], low[lines.across[1]], high[lines.across[1]]);
  for (std::size_t b = b_range.first; b < b_range.last; ++b) {
    for (std::size_t a = a_range.first; a < a_range.last; ++a) {
      const RevolvedLine line(surface, point_of(lines, a, b), lines.axis);
      line.solve([&](Real at, const Vec3& normal) { found(a, b, at, normal); });
    }
  }
}

void cross_box(const BoxSurface& box, const LineLattice& lines, const CrossingFound& found) {
  const auto range = [&](std::size_t d) {
    return find_range(lines.at[d], box.min[lines.across[d]], box.max[lines.across[d]]);
  };
  const IndexRange a_range = range(0);
  const IndexRange b_range = range(1);
  Vec3 normal{};
  normal[lines.axis] = 1;
  for (std::size_t b = b_range.first; b < b_range.last; ++b) {
    for (std::size_t a = a_range.first; a < a_range.last; ++a) {
      found(a, b, box.min[lines.axis], normal);
      found(a, b, box.max[lines.axis], normal);
    }
  }
}

// A triangle as seen along the axis: lines through its shadow cross it.
void cross_triangle(const std::array<Vec3, 3>& corner, const LineLattice& lines, const CrossingFound& found) {
  const int u = lines.across[0];
  const int v = lines.across[1];
  const Vec3 area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const Real size = norm(area);
  if (!(size > 0)) return;
  const Real shadow = area[lines.axis];
  if (std::abs(shadow) <= 1e-12 * size) return;
  const auto extent = [&](int axis) {
    return std::minmax({corner[0][axis], corner[1][axis], corner[2][axis]});
  };
  const auto [u_low, u_high] = extent(u);
  const auto [v_low, v_high] = extent(v);
  const Real slack = joint * std::sqrt(size);
  const IndexRange a_range = find_range(lines.at[0], u_low - slack, u_high + slack);
  const IndexRange b_range = find_range(lines.at[1], v_low - slack, v_high + slack);
  const Vec3 normal = (1 / size) * area;
  for (std::size_t b = b_range.first; b < b_range.last; ++b) {
    for (std::size_t a = a_range.first; a < a_range.last; ++a) {
      Vec3 p = point_of(lines, a, b);
      p[lines.axis] = corner[0][lines.axis];
      // Shares of the corners: areas of the shadow's parts. On an edge both of its triangles count the line.
      const auto share = [&](const Vec3& from, const Vec3& to) {
        return cross(to - from, p - from)[lines.axis] / shadow;
      };
      const Real w0 = share(corner[1], corner[2]);
      const Real w1 = share(corner[2], corner[0]);
      const Real w2 = share(corner[0], corner[1]);
      if (std::min({w0, w1, w2}) < -joint) continue;
      found(a, b, w0 * corner[0][lines.axis] + w1 * corner[1][lines.axis] + w2 * corner[2][lines.axis],
            normal);
    }
  }
}

void cross_mesh(const MeshSurface& mesh, const LineLattice& lines, const CrossingFound& found) {
  for (const auto& t : *mesh.triangles) {
    const auto corner = [&](std::size_t i) { return (*mesh.corners)[static_cast<std::size_t>(t[i])]; };
    cross_triangle({corner(0), corner(1), corner(2)}, lines, found);
  }
}

}  // namespace

void find_crossings(const SurfaceShape& shape, const LineLattice& lines, const CrossingFound& found) {
  if (const auto* plane = std::get_if<PlaneSurface>(&shape)) cross_plane(*plane, lines, found);
  if (const auto* revolved = std::get_if<RevolvedSurface>(&shape)) cross_revolved(*revolved, lines, found);
  if (const auto* box = std::get_if<BoxSurface>(&shape)) cross_box(*box, lines, found);
  if (const auto* mesh = std::get_if<MeshSurface>(&shape)) cross_mesh(*mesh, lines, found);
}

}  // namespace pellicle::cfd
