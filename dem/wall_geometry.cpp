#include "dem/wall_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace pellicle::dem {
namespace {

template <class Space, class T>
Kokkos::View<T*, Space> copy_to(const char* label, const std::vector<T>& values) {
  Kokkos::View<T*, Space> array(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)),
                                values.size());
  const auto host = Kokkos::create_mirror_view(array);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(array, host);
  return array;
}

/// Entries of all cells over the triangles: slender triangles at an angle have boxes that meet many cells.
constexpr Real most_entries = 12;

/// What is gathered on the host before it goes to the device.
struct HostGeometry {
  std::vector<WallSurface> surfaces;
  std::vector<WallBody> bodies;
  std::vector<TriangleShape> triangles;
  std::vector<std::int32_t> triangle_wall;
  std::vector<MeshGrid> grids;
  std::vector<std::int32_t> cell_start, cell_triangle;
};

struct CellRange {
  Index3 low, high;
  std::int64_t count() const {
    return std::int64_t{high.x - low.x + 1} * (high.y - low.y + 1) * (high.z - low.z + 1);
  }
};

CellRange cells_of(const MeshGrid& grid, const TriangleShape& t) {
  CellRange range{};
  for (int axis = 0; axis < 3; ++axis) {
    range.low[axis] = grid.coordinate(axis, std::min({t.a[axis], t.b[axis], t.c[axis]}));
    range.high[axis] = grid.coordinate(axis, std::max({t.a[axis], t.b[axis], t.c[axis]}));
  }
  return range;
}

MeshGrid grid_with_cells(const Vec3& min, const Vec3& max, Real size) {
  MeshGrid grid{};
  grid.min = min;
  grid.max = max;
  for (int axis = 0; axis < 3; ++axis) {
    const Real length = max[axis] - min[axis];
    grid.cells[axis] = static_cast<Index>(std::clamp(std::floor(length / size), 1.0, 4096.0));
    grid.inverse_cell_size[axis] = length > 0 ? grid.cells[axis] / length : 0;
  }
  return grid;
}

/// Cells about as large as a triangle, coarser where that makes too many cells or entries.
MeshGrid choose_grid(const TriangleShape* triangles, std::size_t count) {
  Vec3 min = triangles[0].a;
  Vec3 max = min;
  Real extent = 0;
  for (std::size_t t = 0; t < count; ++t) {
    Real largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& [a, b, c] = triangles[t];
      const Real low = std::min({a[axis], b[axis], c[axis]});
      const Real high = std::max({a[axis], b[axis], c[axis]});
      min[axis] = std::min(min[axis], low);
      max[axis] = std::max(max[axis], high);
      largest = std::max(largest, high - low);
    }
    extent += largest;
  }
  const auto number = static_cast<Real>(count);
  const Real whole = std::max({max.x - min.x, max.y - min.y, max.z - min.z});
  // Large triangles must not make large cells: a box of twelve is cut into some cells too.
  Real size = std::min(extent / number, whole / std::max(1.0, std::cbrt(number)));
  for (;; size *= 1.5) {
    const MeshGrid grid = grid_with_cells(min, max, size);
    const auto cells = static_cast<Real>(grid.cells.x) * grid.cells.y * grid.cells.z;
    if (cells > 64 + 8 * number) continue;
    std::int64_t entries = 0;
    for (std::size_t t = 0; t < count; ++t) entries += cells_of(grid, triangles[t]).count();
    if (static_cast<Real>(entries) <= 1024 + most_entries * number || cells <= 1) return grid;
  }
}

template <class Visit>
void visit_cells(const MeshGrid& grid, const TriangleShape& triangle, const Visit& visit) {
  const CellRange range = cells_of(grid, triangle);
  for (Index k = range.low.z; k <= range.high.z; ++k) {
    for (Index j = range.low.y; j <= range.high.y; ++j) {
      for (Index i = range.low.x; i <= range.high.x; ++i) {
        const Index cell = i + grid.cells.x * (j + grid.cells.y * k);
        visit(static_cast<std::size_t>(cell));
      }
    }
  }
}

void add_mesh(const TriangleMesh& mesh, std::int32_t wall, HostGeometry& geometry) {
  if (mesh.triangles.empty()) return;
  const std::size_t first = geometry.triangles.size();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    geometry.triangles.push_back(mesh.triangle(t));
    geometry.triangle_wall.push_back(wall);
  }
  const TriangleShape* const triangles = geometry.triangles.data() + first;
  MeshGrid grid = choose_grid(triangles, mesh.triangles.size());
  grid.wall = wall;
  // Cells of all meshes share one array of offsets.
  if (geometry.cell_start.empty()) geometry.cell_start.push_back(0);
  grid.first_cell = static_cast<std::int32_t>(geometry.cell_start.size() - 1);
  const auto cells = static_cast<std::size_t>(grid.cells.x) * static_cast<std::size_t>(grid.cells.y) *
                     static_cast<std::size_t>(grid.cells.z);
  std::vector<std::int64_t> start(cells + 1, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    visit_cells(grid, triangles[t], [&](std::size_t cell) { ++start[cell + 1]; });
  for (std::size_t cell = 0; cell < cells; ++cell) start[cell + 1] += start[cell];
  const std::size_t before = geometry.cell_triangle.size();
  const std::size_t total = before + static_cast<std::size_t>(start[cells]);
  if (total > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::invalid_argument("the meshes of the walls have more triangles than can be numbered");
  }
  geometry.cell_triangle.resize(total);
  for (std::size_t cell = 0; cell < cells; ++cell)
    geometry.cell_start.push_back(
        static_cast<std::int32_t>(static_cast<std::int64_t>(before) + start[cell + 1]));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    visit_cells(grid, triangles[t], [&](std::size_t cell) {
      geometry.cell_triangle[before + static_cast<std::size_t>(start[cell]++)] =
          static_cast<std::int32_t>(first + t);
    });
  }
  geometry.grids.push_back(grid);
}

void add_primitives(const Wall& wall, std::int32_t number, std::vector<WallSurface>& surfaces) {
  using Kind = WallSurface::Kind;
  for (const PlaneShape& p : wall.planes)
    surfaces.push_back({Kind::plane, number, p.normal, {}, p.offset, 0, 0, 0});
  for (const RevolvedShape& r : wall.revolved)
    surfaces.push_back({Kind::revolved, number, r.origin, r.axis, r.r0, r.z0, r.r1, r.z1});
  for (const BoxShape& b : wall.boxes) surfaces.push_back({Kind::box, number, b.min, b.max, 0, 0, 0, 0});
}

HostGeometry gather(const std::vector<Wall>& walls) {
  HostGeometry host;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const Wall& wall = walls[w];
    const auto number = static_cast<std::int32_t>(w);
    host.bodies.push_back({wall.motion, wall.torque_about, wall.material, has_to_turn(wall), 0});
    add_primitives(wall, number, host.surfaces);
    if (wall.mesh) add_mesh(*wall.mesh, number, host);
  }
  return host;
}

template <class Space>
BasicWallGeometry<Space> make_geometry(const std::vector<Wall>& walls) {
  const HostGeometry host = gather(walls);
  std::vector<WallPose> poses;
  for (const WallBody& body : host.bodies) poses.push_back(compute_pose_at_rest(body.motion));
  BasicWallGeometry<Space> geometry;
  geometry.primitives = static_cast<Index>(host.surfaces.size());
  geometry.surface = copy_to<Space>("dem::wall_geometry::surface", host.surfaces);
  geometry.body = copy_to<Space>("dem::wall_geometry::body", host.bodies);
  geometry.pose = copy_to<Space>("dem::wall_geometry::pose", poses);
  geometry.triangle = copy_to<Space>("dem::wall_geometry::triangle", host.triangles);
  geometry.triangle_wall = copy_to<Space>("dem::wall_geometry::triangle_wall", host.triangle_wall);
  geometry.grid = copy_to<Space>("dem::wall_geometry::grid", host.grids);
  geometry.cell_start = copy_to<Space>("dem::wall_geometry::cell_start", host.cell_start);
  geometry.cell_triangle = copy_to<Space>("dem::wall_geometry::cell_triangle", host.cell_triangle);
  return geometry;
}

}  // namespace

WallGeometry make_wall_geometry(const std::vector<Wall>& walls) { return make_geometry<Device>(walls); }

BasicWallGeometry<Host> make_host_wall_geometry(const std::vector<Wall>& walls) {
  return make_geometry<Host>(walls);
}

void update_poses(const WallGeometry& geometry, Real time) {
  const auto body = geometry.body;
  const auto pose = geometry.pose;
  Kokkos::parallel_for(
      "dem::wall_geometry::update_poses", DeviceRange(0, static_cast<Index>(body.extent(0))),
      KOKKOS_LAMBDA(const Index w) {
        pose(w) = time < 0 ? compute_pose_at_rest(body(w).motion)
                           : compute_pose(body(w).motion, body(w).turning, time);
      });
}

}  // namespace pellicle::dem
