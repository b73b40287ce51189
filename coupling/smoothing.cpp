#include "coupling/smoothing.hpp"

#include <string>
#include <vector>

namespace pellicle::coupling {

namespace {

// Backward-Euler steps: with more, the kernel comes nearer to a Gaussian (docs/theory/coupling.md).
constexpr int steps = 3;

/// All steps along one line of cells, in place.
struct SmoothLine {
  Smoothing::Axis axis;
  DeviceArray<CellLoad> loads;

  KOKKOS_INLINE_FUNCTION void operator()(const Index line) const {
    const Index stride = axis.stride, last = axis.cells - 1;
    const Index first = (line / stride) * stride * axis.cells + line % stride;
    for (Index i = 0; i <= last; ++i) {  // to densities
      CellLoad& load = loads(first + i * stride);
      load = (1 / axis.factors(i).width) * load;
    }
    for (int step = 0; step < steps; ++step) solve(first, step == steps - 1);
  }

  /// One step; `to_loads` gives densities back as loads.
  KOKKOS_INLINE_FUNCTION void solve(Index first, bool to_loads) const {
    const Index stride = axis.stride, last = axis.cells - 1;
    CellLoad carried;
    for (Index i = 0; i <= last; ++i) {
      const Smoothing::CellFactors f = axis.factors(i);
      CellLoad density = f.own * loads(first + i * stride);
      density += f.previous * carried;
      loads(first + i * stride) = density;
      carried = density;
    }
    for (Index i = last - 1; i >= 0; --i) {
      CellLoad density = loads(first + i * stride);
      density += axis.factors(i).next * carried;
      loads(first + i * stride) = density;
      carried = density;
    }
    if (!axis.periodic && !to_loads) return;
    CellLoad difference = loads(first);
    difference += Real(-1) * loads(first + last * stride);
    for (Index i = 0; i <= last; ++i) {
      const Smoothing::CellFactors f = axis.factors(i);
      CellLoad density = loads(first + i * stride);
      if (axis.periodic) density += f.around * difference;
      loads(first + i * stride) = to_loads ? f.width * density : density;
    }
  }
};

/// Densities of a line without its periodic face: `load` in, density out.
std::vector<Real> solve_line(const std::vector<Smoothing::CellFactors>& factors, std::vector<Real> load) {
  const std::size_t cells = factors.size();
  for (std::size_t i = 0; i < cells; ++i) {
    load[i] *= factors[i].own / factors[i].width;
    if (i > 0) load[i] += factors[i].previous * load[i - 1];
  }
  for (std::size_t i = cells - 1; i-- > 0;) load[i] += factors[i].next * load[i + 1];
  return load;
}

/// The face between the ends of a periodic line is a change of rank one of the line without it (Sherman & Morrison):
/// with its conductance C, and z the answer to a unit load in the first cell and minus one in the last,
/// f = y - z C (y_first - y_last) / (1 + C (z_first - z_last)).
void close_line(std::vector<Smoothing::CellFactors>& factors, Real conductance) {
  const std::size_t last = factors.size() - 1;
  std::vector<Real> unit(factors.size(), 0);
  unit.front() = 1;
  std::vector<Real> z = solve_line(factors, unit);
  unit.front() = 0;
  unit[last] = 1;
  const std::vector<Real> from_last = solve_line(factors, unit);
  for (std::size_t i = 0; i <= last; ++i) z[i] -= from_last[i];
  for (std::size_t i = 0; i <= last; ++i) {
    factors[i].around = -z[i] * conductance / (1 + conductance * (z[0] - z[last]));
  }
}

std::vector<Smoothing::CellFactors> make_factors(const AxisLocator& axis, Real diffusion) {
  const auto faces = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), axis.faces);
  const auto cells = static_cast<std::size_t>(axis.cells);
  std::vector<Smoothing::CellFactors> factors(cells);
  for (std::size_t i = 0; i < cells; ++i) factors[i].width = faces(i + 1) - faces(i);
  const auto conductance = [&](std::size_t a, std::size_t b) {
    return diffusion / (0.5 * (factors[a].width + factors[b].width));
  };
  // The pivot of a cell is `kept` plus its conductance towards the next cell. Written so, without a difference, all
  // factors are accurate, and sums are kept, however large the conductances are.
  Real before = 0, kept_before = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    Smoothing::CellFactors& f = factors[i];
    const Real after = i + 1 < cells ? conductance(i, i + 1) : 0;
    const Real kept = f.width + (i > 0 ? before * kept_before / (kept_before + before) : 0);
    const Real pivot = kept + after;
    f.own = f.width / pivot;
    f.previous = before / pivot;
    f.next = after / pivot;
    before = after;
    kept_before = kept;
  }
  if (axis.periodic) close_line(factors, conductance(cells - 1, 0));
  return factors;
}

}  // namespace

Smoothing::Smoothing(const GridLocator& grid, Real length) : cell_count_(grid.cell_count()) {
  const Real diffusion = length * length / (4 * steps);  // D dt of a step [m2]
  Index stride = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisLocator& from = a == 0 ? grid.x : (a == 1 ? grid.y : grid.z);
    if (diffusion > 0 && from.cells > 1) {
      const std::vector<CellFactors> factors = make_factors(from, diffusion);
      Axis& made = axes_[a];
      const std::string label = std::string("coupling::smoothing::factors_") + "xyz"[a];
      made.factors =
          DeviceArray<CellFactors>(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), factors.size());
      const auto host = Kokkos::create_mirror_view(made.factors);
      for (std::size_t i = 0; i < factors.size(); ++i) host(i) = factors[i];
      Kokkos::deep_copy(made.factors, host);
      made.cells = from.cells;
      made.stride = stride;
      made.periodic = from.periodic;
    }
    stride *= from.cells;
  }
}

void Smoothing::apply(const DeviceArray<CellLoad>& loads) const {
  constexpr const char* labels[] = {"coupling::smoothing::smooth_x", "coupling::smoothing::smooth_y",
                                    "coupling::smoothing::smooth_z"};
  for (std::size_t a = 0; a < 3; ++a) {
    const Axis& axis = axes_[a];
    if (axis.cells == 0) continue;
    Kokkos::parallel_for(labels[a], DeviceRange(0, cell_count_ / axis.cells), SmoothLine{axis, loads});
  }
}

}  // namespace pellicle::coupling
