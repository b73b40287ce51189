#include "dem/mesh_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace pellicle::dem {
namespace {

/// Corners closer than this share of the mesh's diagonal are one: files round to six digits or to float.
constexpr Real weld_share = 1e-6;

/// A triangle of less area than this share of its longest side squared has none: its normal would be noise.
constexpr Real least_area_share = 1e-9;

/// Corners by cells that are much wider than what is welded.
class Welder {
 public:
  Welder(const Vec3& min, Real slack) : min_(min), slack_(slack), cell_(32 * slack) {}

  std::int32_t add(const Vec3& corner, std::vector<Vec3>& corners) {
    // A corner near the side of a cell may belong to one in the next: look in every cell that its slack touches.
    std::array<std::array<std::int64_t, 2>, 3> range{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      range[a] = {cell_of(corner[axis] - slack_ - min_[axis]), cell_of(corner[axis] + slack_ - min_[axis])};
    }
    std::int32_t found = -1;
    for (std::int64_t k = range[2][0]; k <= range[2][1]; ++k) {
      for (std::int64_t j = range[1][0]; j <= range[1][1]; ++j) {
        for (std::int64_t i = range[0][0]; i <= range[0][1]; ++i) {
          const auto cell = cells_.find(key(i, j, k));
          if (cell == cells_.end()) continue;
          for (std::int32_t c = cell->second; c >= 0; c = next_[static_cast<std::size_t>(c)]) {
            const Vec3 gap = corners[static_cast<std::size_t>(c)] - corner;
            // The first of those that are near, so that the result depends on the file alone.
            if (norm_squared(gap) <= slack_ * slack_ && (found < 0 || c < found)) found = c;
          }
        }
      }
    }
    if (found >= 0) return found;
    const auto number = static_cast<std::int32_t>(corners.size());
    corners.push_back(corner);
    const auto [place, is_new] = cells_.try_emplace(
        key(cell_of(corner.x - min_.x), cell_of(corner.y - min_.y), cell_of(corner.z - min_.z)), -1);
    next_.push_back(place->second);
    place->second = number;
    return number;
  }

 private:
  std::int64_t cell_of(Real x) const { return static_cast<std::int64_t>(std::floor(x / cell_)); }
  static std::uint64_t key(std::int64_t i, std::int64_t j, std::int64_t k) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
    return (static_cast<std::uint64_t>(i + 1) & mask) | (static_cast<std::uint64_t>(j + 1) & mask) << 21 |
           (static_cast<std::uint64_t>(k + 1) & mask) << 42;
  }

  Vec3 min_;
  Real slack_, cell_;
  std::unordered_map<std::uint64_t, std::int32_t> cells_;
  std::vector<std::int32_t> next_;
};

void find_bounds(const std::vector<Facet>& facets, MeshReport& report) {
  report.min = report.max = facets[0].corner[0];
  for (const Facet& facet : facets) {
    for (const Vec3& corner : facet.corner) {
      for (int axis = 0; axis < 3; ++axis) {
        report.min[axis] = std::min(report.min[axis], corner[axis]);
        report.max[axis] = std::max(report.max[axis], corner[axis]);
      }
    }
  }
}

bool has_area(const TriangleShape& t) {
  const Real longest = std::max({norm_squared(t.b - t.a), norm_squared(t.c - t.b), norm_squared(t.a - t.c)});
  return 0.5 * norm(cross(t.b - t.a, t.c - t.a)) > least_area_share * longest;
}

/// Drops all but the first of triangles with the same three corners.
void drop_doubled(TriangleMesh& mesh, MeshReport& report) {
  std::vector<std::pair<std::array<std::int32_t, 3>, std::size_t>> sorted(mesh.triangles.size());
  for (std::size_t t = 0; t < sorted.size(); ++t) {
    sorted[t] = {mesh.triangles[t], t};
    std::sort(sorted[t].first.begin(), sorted[t].first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> keep(sorted.size(), true);
  for (std::size_t s = 1; s < sorted.size(); ++s) {
    if (sorted[s].first == sorted[s - 1].first) keep[sorted[s].second] = false;
  }
  std::size_t kept = 0;
  for (std::size_t t = 0; t < sorted.size(); ++t) {
    if (keep[t]) mesh.triangles[kept++] = mesh.triangles[t];
  }
  report.doubled = static_cast<std::int64_t>(sorted.size() - kept);
  mesh.triangles.resize(kept);
}

void look_at_edges(const TriangleMesh& mesh, MeshReport& report) {
  // Corners of an edge in ascending order, and whether its triangle runs that way.
  struct Edge {
    std::int32_t low, high;
    bool forward;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = t[i];
      const std::int32_t b = t[(i + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.low != b.low ? a.low < b.low : (a.high != b.high ? a.high < b.high : a.forward < b.forward);
  });
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first;
    while (last < edges.size() && edges[last].low == edges[first].low &&
           edges[last].high == edges[first].high)
      ++last;
    const std::size_t count = last - first;
    report.open_edges += count == 1 ? 1 : 0;
    report.crowded_edges += count > 2 ? 1 : 0;
    report.flipped_edges += count == 2 && edges[first].forward == edges[first + 1].forward ? 1 : 0;
    first = last;
  }
}

}  // namespace

TriangleMesh weld_facets(const std::vector<Facet>& facets, MeshReport& report) {
  report = MeshReport{};
  TriangleMesh mesh;
  if (facets.empty()) return mesh;
  find_bounds(facets, report);
  const Real slack = weld_share * norm(report.max - report.min);
  if (!(slack > 0)) {
    report.degenerate = static_cast<std::int64_t>(facets.size());
    return mesh;
  }
  Welder welder(report.min, slack);
  for (const Facet& facet : facets) {
    std::array<std::int32_t, 3> t{};
    for (std::size_t i = 0; i < 3; ++i) t[i] = welder.add(facet.corner[i], mesh.corners);
    mesh.triangles.push_back(t);
    const TriangleShape shape = mesh.triangle(mesh.triangles.size() - 1);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || !has_area(shape)) {
      ++report.degenerate;
      mesh.triangles.pop_back();
      continue;
    }
    if (dot(facet.normal, cross(shape.b - shape.a, shape.c - shape.a)) < 0) ++report.wrong_normals;
  }
  drop_doubled(mesh, report);
  look_at_edges(mesh, report);
  report.triangles = static_cast<std::int64_t>(mesh.triangles.size());
  report.corners = static_cast<std::int64_t>(mesh.corners.size());
  mesh.closed = report.watertight();
  if (mesh.closed) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const TriangleShape shape = mesh.triangle(t);
      report.volume += dot(shape.a - report.min, cross(shape.b - report.min, shape.c - report.min)) / 6;
    }
  }
  return mesh;
}

std::string describe_mesh(const MeshReport& report) {
  const Vec3 size = report.max - report.min;
  std::string text = fmt::format("{} triangles, {} corners, {:.4g} x {:.4g} x {:.4g} m", report.triangles,
                                 report.corners, size.x, size.y, size.z);
  if (report.watertight()) {
    text += fmt::format(", watertight, around {:.4g} m3, normals point {}", std::abs(report.volume),
                        report.volume < 0 ? "inwards" : "outwards");
  } else {
    text += fmt::format(", not watertight ({} open edges)", report.open_edges);
  }
  return text;
}

std::string doubts_about_mesh(const MeshReport& report) {
  std::string text;
  const auto add = [&](std::int64_t count, const char* what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(report.degenerate, "triangles without area (dropped)");
  add(report.doubled, "triangles that are there twice (dropped once)");
  add(report.crowded_edges, "edges of more than two triangles");
  add(report.flipped_edges, "edges whose two triangles face opposite ways");
  add(report.wrong_normals, "normals that contradict the order of the corners");
  return text;
}

}  // namespace pellicle::dem
