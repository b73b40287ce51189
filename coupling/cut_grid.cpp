#include "coupling/cut_grid.hpp"

#include <vector>

#include "cfd/flow_geometry.hpp"
#include "core/to_device.hpp"

namespace pellicle::coupling {

namespace {

/// Calls f(side, neighbour) for the cells across a cell's sides, open or not.
template <class F>
void for_neighbours(const cfd::FlowGeometry& geometry, Index cell, F&& f) {
  const cfd::Stencil& s = geometry.stencil;
  const Index3 at = geometry.grid.coordinates(cell);
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    Index3 to = at;
    to[axis] += side % 2 == 0 ? -1 : 1;
    if (to[axis] < 0 || to[axis] >= s.n[axis]) {
      if (!s.periodic[static_cast<std::size_t>(axis)]) continue;
      to[axis] = to[axis] < 0 ? s.n[axis] - 1 : 0;
    }
    f(side, s.cell(to.x, to.y, to.z));
  }
}

std::vector<std::uint8_t> find_open_sides(const cfd::FlowGeometry& geometry) {
  std::vector<std::uint8_t> open(static_cast<std::size_t>(geometry.stencil.cells()), 0);
  for (Index c = 0; c < geometry.stencil.cells(); ++c) {
    const Index3 at = geometry.grid.coordinates(c);
    for_neighbours(geometry, c, [&](int side, Index) {
      const int axis = side / 2;
      const Index minus = geometry.stencil.face(axis, at.x, at.y, at.z);
      const Index face = side % 2 == 0 ? minus : minus + geometry.stencil.face_step(axis);
      if (geometry.closed(axis, face)) return;
      auto& own = open[static_cast<std::size_t>(c)];
      own = static_cast<std::uint8_t>(own | (1u << static_cast<unsigned>(side)));
    });
  }
  return open;
}

/// Breadth first from all open cells at once, in the order of cells and sides.
std::vector<Index> find_nearest_open(const cfd::FlowGeometry& geometry) {
  const Index cells = geometry.stencil.cells();
  std::vector<Index> nearest(static_cast<std::size_t>(cells), -1);
  std::vector<Index> queue;
  queue.reserve(nearest.size());
  for (Index c = 0; c < cells; ++c) {
    if (!(geometry.volume(c) > 0)) continue;
    nearest[static_cast<std::size_t>(c)] = c;
    queue.push_back(c);
  }
  for (std::size_t next = 0; next < queue.size(); ++next) {
    const Index from = nearest[static_cast<std::size_t>(queue[next])];
    for_neighbours(geometry, queue[next], [&](int, Index to) {
      if (nearest[static_cast<std::size_t>(to)] >= 0) return;
      nearest[static_cast<std::size_t>(to)] = from;
      queue.push_back(to);
    });
  }
  return nearest;
}

}  // namespace

CutGrid make_cut_grid(const cfd::FlowGeometry& geometry) {
  CutGrid made;
  if (!geometry.is_cut) return made;
  const Index cells = geometry.stencil.cells();
  const std::vector<Real> volume(geometry.volume.data(), geometry.volume.data() + cells);
  std::vector<Index> begin(static_cast<std::size_t>(cells) + 1, 0);
  std::vector<ThinWall> walls;
  for (const cfd::SurfacePiece& piece : geometry.pieces) {  // in the order of cells
    if (piece.beyond < 0) continue;
    walls.push_back({piece.point, piece.normal, piece.beyond});
    ++begin[static_cast<std::size_t>(piece.cell) + 1];
  }
  for (std::size_t c = 1; c < begin.size(); ++c) begin[c] += begin[c - 1];
  made.volume = to_device("coupling::cut_grid::volume", volume);
  made.open_sides = to_device("coupling::cut_grid::open_sides", find_open_sides(geometry));
  made.nearest_open = to_device("coupling::cut_grid::nearest_open", find_nearest_open(geometry));
  made.walls_begin = to_device("coupling::cut_grid::walls_begin", begin);
  made.walls = to_device("coupling::cut_grid::walls", walls);
  return made;
}

}  // namespace pellicle::coupling
