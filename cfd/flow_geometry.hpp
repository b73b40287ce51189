// Where the gas can be: open volume of cells, open area of faces, distances, and the surfaces within the domain, which
// reduce volumes and areas.
#pragma once

#include <array>
#include <vector>

#include "cfd/cut_cells.hpp"
#include "cfd/gas_state.hpp"
#include "cfd/immersed_surface.hpp"
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

/// A cell one of whose faces across an axis, or both, nothing passes: of the two, what is open.
struct BlockedCell {
  Index cell = 0;
  Index face = 0;  ///< the face on its minus side
  bool minus_open = false;
  bool plus_open = false;
};

/// A face of which the gas on one side or both is not in the middle of its cell: the line between the centroids does not
/// run along the axis.
struct SkewFace {
  Index face = 0;
  Index minus = 0, plus = 0;  ///< cells
  Vec3 across;  ///< part of the way from the minus to the plus centroid that is not along the axis [m]
};

/// The surfaces within the domain and the point from which the gas spreads.
struct ImmersedGeometry {
  std::vector<ImmersedSurface> surfaces;
  Vec3 inside;  ///< a point in the gas [m]
};

struct FlowGeometry {
  explicit FlowGeometry(const CartesianGrid& grid);
  /// Cut by surfaces; throws std::invalid_argument as cut_cells does.
  FlowGeometry(const CartesianGrid& grid, const ImmersedGeometry& immersed);

  /// Whether a face towards the cell beyond it, across an axis, lets nothing through.
  bool closed(int a, Index face) const { return is_cut && area[static_cast<std::size_t>(a)](face) == 0; }

  CartesianGrid grid;
  Stencil stencil;
  std::array<AxisMetrics, 3> axis;
  HostArray<Real> volume;  ///< open volume of a cell [m3]; 0 where no gas is
  FaceField area;          ///< open area of a face [m2]
  FaceField distance;      ///< along the axis, between the centroids of the gas on both sides of a face [m]

  bool is_cut = false;                              ///< surfaces leave less than the whole domain
  std::array<std::vector<Index>, 3> closed_faces;   ///< faces between two cells that let nothing through
  std::array<std::vector<BlockedCell>, 3> blocked;  ///< open cells beside them
  std::array<std::vector<SkewFace>, 3> skew_faces;  ///< open ones
  std::vector<ImmersedSurface> surfaces;
  std::vector<SurfacePiece> pieces;  ///< of the surfaces, in the order of cells
  Index open_cells = 0;
  Index part_cells = 0;    ///< open cells of which the gas has only a part
  Real smallest_part = 1;  ///< smallest open share of a cell's volume
  Index thin_faces = 0;    ///< faces that a surface closes which has gas on both sides

 private:
  void cut(const ImmersedGeometry& immersed);
  void find_closed_faces();
};

/// A face field of zeros.
FaceField make_face_field(const Stencil& stencil, const char* label);

}  // namespace pellicle::cfd
