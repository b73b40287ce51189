#include "dem/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellicle::dem {
namespace {

/// Height at which the vertical line through x meets a triangle, seen from above.
std::optional<Real> crossing(const TriangleShape& t, const Vec3& x) {
  const auto twice_area = [&](const Vec3& p, const Vec3& q) {
    return (p.x - x.x) * (q.y - x.y) - (q.x - x.x) * (p.y - x.y);
  };
  // Two triangles see their common edge with exactly opposite signs: a line is never lost between them.
  const Real a = twice_area(t.b, t.c), b = twice_area(t.c, t.a), c = twice_area(t.a, t.b);
  if (!((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0))) return std::nullopt;
  return (a * t.a.z + b * t.b.z + c * t.c.z) / (a + b + c);
}

}  // namespace

Obstacles::Obstacles(const std::vector<Wall>& walls) : geometry_(make_host_wall_geometry(walls)) {
  for (std::size_t g = 0; g < geometry_.grid.extent(0); ++g) {
    const MeshGrid& grid = geometry_.grid(g);
    const bool closed = walls[static_cast<std::size_t>(grid.wall)].mesh->closed;
    meshes_.push_back({grid, closed, Side::both});
  }
}

bool Obstacles::encloses(const MeshGrid& grid, const Vec3& point) const {
  // A line upwards crosses a closed mesh an odd number of times if it begins within. It is moved aside a little, by
  // shares that no mesh has, so that it meets no edge.
  const Vec3 size = grid.max - grid.min;
  const Vec3 x = point + 1e-7 * Vec3{0.7548776662466927 * size.x, 0.5698402909980532 * size.y, 0};
  for (int axis = 0; axis < 3; ++axis) {
    if (!(x[axis] >= grid.min[axis] && x[axis] <= grid.max[axis])) return false;
  }
  const Index i = grid.coordinate(0, x.x), j = grid.coordinate(1, x.y);
  int crossings = 0;
  for (Index k = grid.coordinate(2, x.z); k < grid.cells.z; ++k) {
    const Index cell = grid.first_cell + i + grid.cells.x * (j + grid.cells.y * k);
    for (std::int32_t entry = geometry_.cell_start(cell); entry < geometry_.cell_start(cell + 1); ++entry) {
      const auto height = crossing(geometry_.triangle(geometry_.cell_triangle(entry)), x);
      // A triangle may be in several cells of the column: it counts in the one where it is crossed.
      if (height && *height > x.z && grid.coordinate(2, *height) == k) ++crossings;
    }
  }
  return crossings % 2 == 1;
}

bool Obstacles::encloses(std::int32_t wall, const Vec3& point) const {
  for (const Mesh& mesh : meshes_) {
    if (mesh.grid.wall == wall) return encloses(mesh.grid, geometry_.pose(wall).to_wall(point));
  }
  return false;
}

std::vector<std::int32_t> Obstacles::closed_meshes() const {
  std::vector<std::int32_t> walls;
  for (const Mesh& mesh : meshes_) {
    if (mesh.closed) walls.push_back(mesh.grid.wall);
  }
  return walls;
}

void Obstacles::choose_sides(const FillRegion& region) {
  constexpr std::size_t samples = 512;
  const Room room(region);
  const Box box = region_bounds(region);
  std::vector<Vec3> points;
  // Roberts' sequence fills the box evenly: multiples of powers of 1/1.2207, the root of x^4 = x + 1.
  for (int n = 1; n <= 64 * static_cast<int>(samples) && points.size() < samples; ++n) {
    const Vec3 share{0.8191725133961645 * n, 0.6710436067037893 * n, 0.5497004779019703 * n};
    Vec3 x;
    for (int a = 0; a < 3; ++a)
      x[a] = box.min[a] + (share[a] - std::floor(share[a])) * (box.max[a] - box.min[a]);
    if (room.holds(x, 0)) points.push_back(x);
  }
  choose_sides(points);
}

void Obstacles::choose_sides(const std::vector<Vec3>& points) {
  for (Mesh& mesh : meshes_) {
    if (!mesh.closed) continue;
    std::size_t within = 0;
    for (const Vec3& x : points) within += encloses(mesh.grid.wall, x) ? 1 : 0;
    mesh.room = 2 * within >= points.size() ? Side::inside : Side::outside;
  }
}

void Obstacles::move_to(Real time) {
  for (std::size_t w = 0; w < geometry_.body.extent(0); ++w) {
    const WallBody& body = geometry_.body(w);
    geometry_.pose(w) =
        time < 0 ? compute_pose_at_rest(body.motion) : compute_pose(body.motion, body.turning, time);
  }
}

Real Obstacles::longest_period() const {
  Real longest = 0;
  for (std::size_t w = 0; w < geometry_.body.extent(0); ++w) {
    const WallBody& body = geometry_.body(w);
    const Real turns = norm(body.motion.spin) / (2 * std::numbers::pi);
    const Real swings = norm_squared(body.motion.amplitude) > 0 ? body.motion.frequency : 0;
    if (body.turning && turns > 0) longest = std::max(longest, 1 / turns);
    if (swings > 0) longest = std::max(longest, 1 / swings);
  }
  return longest;
}

std::optional<ClosestPoint> Obstacles::closest_on(const Mesh& mesh, const Vec3& c, Real reach) const {
  std::optional<ClosestPoint> nearest;
  visit_triangles(geometry_, mesh.grid, c, reach, [&](Index s) {
    const ClosestPoint at = geometry_.closest_in_wall(s, c);
    if (!nearest || at.distance < nearest->distance) nearest = at;
    return false;
  });
  return nearest;
}

std::optional<Obstacles::Overlap> Obstacles::deepest(const Vec3& centre, Real radius) const {
  Overlap deepest;
  const auto consider = [&](std::int32_t wall, const ClosestPoint& at) {
    if (radius - at.distance > deepest.depth) deepest = {wall, radius - at.distance, -at.towards};
  };
  for (Index s = 0; s < geometry_.primitives; ++s)
    consider(geometry_.wall_of(s), geometry_.closest(s, centre));
  for (const Mesh& mesh : meshes_) {
    const Vec3 c = geometry_.pose(mesh.grid.wall).to_wall(centre);
    const bool solid = mesh.room != Side::both && encloses(mesh.grid, c) != (mesh.room == Side::inside);
    if (!solid) {
      if (const auto at = closest_on(mesh, c, radius)) consider(mesh.grid.wall, *at);
      continue;
    }
    std::optional<ClosestPoint> at;
    for (Real reach = radius; !at; reach *= 2) at = closest_on(mesh, c, reach);
    // Within the solid: out through the nearest place.
    at->distance = -at->distance;
    at->towards = -at->towards;
    consider(mesh.grid.wall, *at);
  }
  if (deepest.depth > 0) return deepest;
  return std::nullopt;
}

bool Obstacles::push_out(Vec3& centre, Real radius) const {
  constexpr int most_walls = 3;  // that meet in a corner
  bool overlapped = false;
  for (int n = 0; n < most_walls; ++n) {
    const auto overlap = deepest(centre, radius);
    if (!overlap || overlap->depth <= slack * radius) break;
    centre += overlap->depth * overlap->out;
    overlapped = true;
  }
  return overlapped;
}

}  // namespace pellicle::dem
