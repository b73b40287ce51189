// Small gas cases that several tests use.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cfd/gas_solver.hpp"

namespace pellicle::cfd {

inline GasOptions make_air(Convection scheme = Convection::ultimate_quickest) {
  GasOptions options;
  options.density = 1.2;
  options.viscosity = 1.8e-5;
  options.convection = scheme;
  return options;
}

/// Tolerances at which only round-off is left.
inline void make_tight(GasOptions& options) {
  options.solver.pressure_tolerance = 1e-13;
  options.solver.loose_pressure_tolerance = 1e-3;
  options.solver.momentum_tolerance = 1e-14;
}

inline std::vector<BoundaryPatch> symmetry_on(const std::vector<Side>& sides) {
  std::vector<BoundaryPatch> patches;
  patches.reserve(sides.size());
  for (const Side side : sides)
    patches.push_back({std::string(name_of(side)), side, {}, Symmetry{}, "case.yaml:1"});
  return patches;
}

/// A duct along z with symmetry walls, an inlet below and an outlet above.
inline std::vector<BoundaryPatch> make_duct(Real inlet_velocity) {
  auto patches = symmetry_on({Side::x_min, Side::x_max, Side::y_min, Side::y_max});
  patches.push_back({"inlet", Side::z_min, {}, Inlet{inlet_velocity, {}}, "case.yaml:2"});
  patches.push_back({"outlet", Side::z_max, {}, Outlet{0}, "case.yaml:3"});
  return patches;
}

/// Face coordinates from 0 to `length`, cells growing by up to three times and shrinking again.
inline std::vector<Real> make_stretched_faces(Real length, Index cells) {
  std::vector<Real> faces;
  for (Index i = 0; i <= cells; ++i) {
    const Real s = static_cast<Real>(i) / cells;
    faces.push_back(length * (s + 0.08 * std::sin(2 * M_PI * s)));
  }
  faces.front() = 0;
  faces.back() = length;
  return faces;
}

inline StepReport advance(GasSolver& solver, const ParticleExchange& exchange, Real dt, int steps) {
  StepReport report;
  for (int i = 0; i < steps; ++i) report = solver.update(dt, exchange);
  return report;
}

inline Real largest_difference(const HostArray<Vec3>& a, const HostArray<Vec3>& b) {
  Real largest = 0;
  for (std::size_t c = 0; c < a.extent(0); ++c) largest = std::max(largest, norm(a(c) - b(c)));
  return largest;
}

inline HostArray<Vec3> copy_of(const HostArray<Vec3>& a) {
  HostArray<Vec3> b("tests::cfd::copy", a.extent(0));
  Kokkos::deep_copy(b, a);
  return b;
}

/// A bed whose solids move to and fro (a spout of fewer of them in the middle), as the exchange at a time [s] tells the gas.
inline void set_moving_bed(const CartesianGrid& grid, Real time, ParticleExchange& exchange) {
  for (Index c = 0; c < grid.cell_count(); ++c) {
    const Index3 at = grid.coordinates(c);
    const Real x = grid.center(0, at.x);
    const Real z = grid.center(2, at.z);
    const bool spout = std::abs(x - 0.033) < 0.006;
    const Real solids = z > 0.1 ? 0 : (spout ? 0.1 : 0.5) + 0.08 * std::sin(60 * time + 200 * z + 150 * x);
    exchange.void_fraction(c) = 1 - solids;
    exchange.exchange_coefficient(c) = 5000 * solids;
    exchange.explicit_force(c) = {0, 10 * solids, -300 * solids};
  }
}

}  // namespace pellicle::cfd
