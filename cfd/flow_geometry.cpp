#include "cfd/flow_geometry.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "cfd/field_memory.hpp"

namespace pellicle::cfd {

namespace {

// Weights at x of the quadratic through three points.
std::array<Real, 3> quadratic_weights(Real x, Real upstream, Real central, Real downstream) {
  const auto lagrange = [x](Real own, Real a, Real b) { return (x - a) * (x - b) / ((own - a) * (own - b)); };
  return {lagrange(upstream, central, downstream), lagrange(central, upstream, downstream),
          lagrange(downstream, upstream, central)};
}

AxisMetrics make_metrics(const CartesianGrid& grid, int axis) {
  const Index n = grid.cells()[axis];
  const bool periodic = grid.periodic(axis);
  AxisMetrics m;
  const auto size = static_cast<std::size_t>(n);
  m.width.resize(size);
  for (Index i = 0; i < n; ++i) m.width[static_cast<std::size_t>(i)] = grid.width(axis, i);
  m.distance.assign(size + 1, 0);
  m.series_minus.assign(size + 1, 0.5);
  m.linear_minus.assign(size + 1, 0.5);
  m.quick_forward.assign(size + 1, {0, 1, 0});
  m.quick_backward.assign(size + 1, {0, 1, 0});
  const auto width = [&](Index i) { return m.width[static_cast<std::size_t>((i + 2 * n) % n)]; };
  for (Index i = 0; i <= n; ++i) {
    if (!periodic && (i == 0 || i == n)) continue;
    const auto f = static_cast<std::size_t>(i);
    const Real minus = width(i - 1);
    const Real plus = width(i);
    m.distance[f] = 0.5 * (minus + plus);
    m.series_minus[f] = minus / (minus + plus);
    m.linear_minus[f] = plus / (minus + plus);
    if (periodic || i >= 2) {
      m.quick_forward[f] = quadratic_weights(0, -minus - 0.5 * width(i - 2), -0.5 * minus, 0.5 * plus);
    }
    if (periodic || i <= n - 2) {
      m.quick_backward[f] = quadratic_weights(0, plus + 0.5 * width(i + 1), 0.5 * plus, -0.5 * minus);
    }
  }
  return m;
}

}  // namespace

FaceField make_face_field(const Stencil& stencil, const char* label) {
  FaceField field;
  const char* names[] = {"/x", "/y", "/z"};
  for (std::size_t a = 0; a < 3; ++a) {
    field[a] = make_field<Real>(std::string(label) + names[a],
                                static_cast<std::size_t>(stencil.faces(static_cast<int>(a))));
  }
  return field;
}

FlowGeometry::FlowGeometry(const CartesianGrid& g) : grid(g) {
  stencil.n = grid.cells();
  for (int a = 0; a < 3; ++a) {
    stencil.periodic[static_cast<std::size_t>(a)] = grid.periodic(a);
    axis[static_cast<std::size_t>(a)] = make_metrics(grid, a);
  }
  volume = make_field<Real>("cfd::flow_geometry::volume", static_cast<std::size_t>(stencil.cells()));
  area = make_face_field(stencil, "cfd::flow_geometry::area");
  const Index3 n = stencil.n;
  for (Index k = 0; k < n.z; ++k) {
    for (Index j = 0; j < n.y; ++j) {
      for (Index i = 0; i < n.x; ++i) volume(stencil.cell(i, j, k)) = grid.volume(i, j, k);
    }
  }
  for (int a = 0; a < 3; ++a) {
    const Index3 m{n.x + (a == 0 ? 1 : 0), n.y + (a == 1 ? 1 : 0), n.z + (a == 2 ? 1 : 0)};
    for (Index k = 0; k < m.z; ++k) {
      for (Index j = 0; j < m.y; ++j) {
        for (Index i = 0; i < m.x; ++i) {
          const Real wx = a == 0 ? 1 : grid.width(0, i);
          const Real wy = a == 1 ? 1 : grid.width(1, j);
          const Real wz = a == 2 ? 1 : grid.width(2, k);
          area[static_cast<std::size_t>(a)](stencil.face(a, i, j, k)) = wx * wy * wz;
        }
      }
    }
  }
  distance = make_face_field(stencil, "cfd::flow_geometry::distance");
  for (int a = 0; a < 3; ++a) {
    const auto ua = static_cast<std::size_t>(a);
    for_faces("cfd::flow_geometry::distance", stencil, a, [&](Index f, Index, Index, Index position, Index) {
      distance[ua](f) = axis[ua].distance[static_cast<std::size_t>(position)];
    });
    copy_periodic_faces(stencil, a, distance[ua]);
  }
  open_cells = stencil.cells();
}

FlowGeometry::FlowGeometry(const CartesianGrid& g, const ImmersedGeometry& immersed) : FlowGeometry(g) {
  if (!immersed.surfaces.empty()) cut(immersed);
}

void FlowGeometry::cut(const ImmersedGeometry& immersed) {
  CutCells cells = cut_cells(grid, immersed.surfaces, immersed.inside);
  surfaces = immersed.surfaces;
  pieces = std::move(cells.pieces);
  open_cells = cells.open_cells;
  part_cells = static_cast<Index>(cells.parts.size());
  thin_faces = cells.closed_faces;
  is_cut = open_cells < stencil.cells() || part_cells > 0 || thin_faces > 0;
  for (Index c = 0; c < stencil.cells(); ++c) {
    if (cells.open[static_cast<std::size_t>(c)] == 0) volume(c) = 0;
  }
  // How far the gas of a cell is from the cell's centre.
  std::vector<Vec3> shift(cells.open.size());
  for (const PartCell& part : cells.parts) {
    const Index3 at = grid.coordinates(part.cell);
    volume(part.cell) *= part.open_share;
    smallest_part = std::min(smallest_part, part.open_share);
    shift[static_cast<std::size_t>(part.cell)] =
        part.centroid - Vec3{grid.center(0, at.x), grid.center(1, at.y), grid.center(2, at.z)};
  }
  for (int a = 0; a < 3; ++a) {
    const auto ua = static_cast<std::size_t>(a);
    for (std::size_t f = 0; f < area[ua].extent(0); ++f) area[ua](f) *= cells.open_share[ua][f];
    std::vector<SkewFace> skew(area[ua].extent(0));
    for_faces("cfd::flow_geometry::centroids", stencil, a,
              [&](Index f, Index m, Index p, Index position, Index) {
                const Real centres = axis[ua].distance[static_cast<std::size_t>(position)];
                const Real between =
                    centres + shift[static_cast<std::size_t>(p)][a] - shift[static_cast<std::size_t>(m)][a];
                distance[ua](f) = std::max(between, 0.1 * centres);
                Vec3 across = shift[static_cast<std::size_t>(p)] - shift[static_cast<std::size_t>(m)];
                across[a] = 0;
                if (area[ua](f) > 0) skew[static_cast<std::size_t>(f)] = {f, m, p, across};
              });
    for (const SkewFace& face : skew) {
      if (norm(face.across) > 0) skew_faces[ua].push_back(face);
    }
    copy_periodic_faces(stencil, a, distance[ua]);
  }
  find_closed_faces();
}

void FlowGeometry::find_closed_faces() {
  for (int a = 0; a < 3; ++a) {
    const auto ua = static_cast<std::size_t>(a);
    const Index n = stencil.n[a];
    const bool periodic = stencil.periodic[ua];
    for (Index c = 0; c < stencil.cells(); ++c) {
      const Index3 at = grid.coordinates(c);
      const Index minus = stencil.face(a, at.x, at.y, at.z);
      const Index plus = minus + stencil.face_step(a);
      const bool minus_inside = periodic || at[a] > 0;
      const bool plus_inside = periodic || at[a] < n - 1;
      const bool minus_closed = minus_inside && area[ua](minus) == 0;
      const bool plus_closed = plus_inside && area[ua](plus) == 0;
      if (minus_closed) closed_faces[ua].push_back(minus);
      if (periodic && at[a] == n - 1 && plus_closed) closed_faces[ua].push_back(plus);
      if (volume(c) > 0 && (minus_closed || plus_closed)) {
        blocked[ua].push_back({c, minus, !minus_closed, !plus_closed});
      }
    }
  }
}

}  // namespace pellicle::cfd
