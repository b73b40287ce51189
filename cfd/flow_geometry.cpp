#include "cfd/flow_geometry.hpp"

#include <string>

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
    field[a] = HostArray<Real>(std::string(label) + names[a],
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
  volume = HostArray<Real>("cfd::flow_geometry::volume", static_cast<std::size_t>(stencil.cells()));
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
}

}  // namespace pellicle::cfd
