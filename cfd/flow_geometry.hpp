// Where the gas can be: open volume of cells, open area of faces, distances. The place where immersed boundaries
// come in: they reduce volumes and areas, nothing else here changes.
#pragma once

#include <array>
#include <vector>

#include "cfd/gas_state.hpp"
#include "cfd/stencil.hpp"
#include "core/cartesian_grid.hpp"

namespace pellicle::cfd {

/// Distances along one axis. Entry i of the face arrays belongs to the face between cells i - 1 and i; at a boundary
/// that is not periodic only `width` has a meaning.
struct AxisMetrics {
  std::vector<Real> width;     ///< of cell i [m], n
  std::vector<Real> distance;  ///< between the two cell centres [m], n + 1
  std::vector<Real>
      series_minus;  ///< share of that distance in the minus cell: weight of a piecewise constant
  std::vector<Real> linear_minus;  ///< weight of the minus cell in linear interpolation between centres
  /// Weights of the upstream, central and downstream cell in the quadratic through their centres; flow along +axis
  /// and along -axis (Leonard 1979, uneven spacing).
  std::vector<std::array<Real, 3>> quick_forward, quick_backward;
};

struct FlowGeometry {
  explicit FlowGeometry(const CartesianGrid& grid);

  CartesianGrid grid;
  Stencil stencil;
  std::array<AxisMetrics, 3> axis;
  HostArray<Real> volume;  ///< open volume of a cell [m3]
  FaceField area;          ///< open area of a face [m2]
};

/// A face field of zeros.
FaceField make_face_field(const Stencil& stencil, const char* label);

}  // namespace pellicle::cfd
