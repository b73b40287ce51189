// Fluxes that satisfy continuity to round-off, for tests of what the gas carries without the gas solver.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "cfd/boundary_pieces.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_fields.hpp"
#include "cfd/scalar_transport.hpp"

namespace pellicle::cfd {

/// Grid, boundaries and fields of a gas whose flow is given by hand.
class PrescribedFlow {
 public:
  PrescribedFlow(const CartesianGrid& grid, const std::vector<BoundaryPatch>& patches, Real gas_density)
      : geometry(grid),
        boundaries(cut_boundaries(geometry, patches)),
        fields(geometry, boundaries.pieces.size()),
        density(gas_density) {
    Kokkos::deep_copy(fields.void_fraction, 1.0);
    Kokkos::deep_copy(fields.void_fraction_old, 1.0);
    Kokkos::deep_copy(fields.density, density);
    Kokkos::deep_copy(fields.density_old, density);
    std::fill(fields.piece_density.begin(), fields.piece_density.end(), density);
  }

  /// Sets the flow: flow_through(axis, i, j, k) is the volume flow along +axis through a face [m3/s].
  template <class Flow>
  void set_flow(Flow&& flow_through) {
    const Index3 n = geometry.stencil.n;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      Index3 last = n;
      if (geometry.stencil.periodic[a]) last[axis] += 1;
      for (Index k = 0; k < last.z; ++k) {
        for (Index j = 0; j < last.y; ++j) {
          for (Index i = 0; i < last.x; ++i) {
            const Index3 at{i, j, k};
            if (at[axis] == 0 && !geometry.stencil.periodic[a]) continue;
            fields.mass_flux[a](geometry.stencil.face(axis, i, j, k)) = density * flow_through(axis, i, j, k);
          }
        }
      }
    }
    for (std::size_t b = 0; b < boundaries.pieces.size(); ++b) {
      const BoundaryPiece& piece = boundaries.pieces[b];
      Index3 at = geometry.grid.coordinates(piece.cell);
      if (piece.outward > 0) at[piece.axis] += 1;
      fields.piece_flow[b] = piece.outward * flow_through(piece.axis, at.x, at.y, at.z);
    }
  }

  FlowGeometry geometry;
  Boundaries boundaries;
  GasFields fields;
  Real density;
};

/// A duct of unit section along x with gas that flows at one superficial velocity; insulated at the sides.
inline PrescribedFlow make_plug_flow(Index cells, Real length, Real velocity, Real density) {
  const CartesianGrid grid(Box{{0, 0, 0}, {length, 1, 1}}, {cells, 1, 1});
  PrescribedFlow flow(grid,
                      {{"inlet", Side::x_min, {}, Inlet{velocity, {}}, "case.yaml:1"},
                       {"outlet", Side::x_max, {}, Outlet{0}, "case.yaml:2"}},
                      density);
  flow.set_flow([&](int axis, Index, Index, Index) { return axis == 0 ? velocity : 0.0; });
  return flow;
}

}  // namespace pellicle::cfd
