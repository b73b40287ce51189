// What surfaces within the domain leave of its cells: open volumes, open areas of faces, and the surface in each cell.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cfd/immersed_surface.hpp"
#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::cfd {

/// The part of a surface that the gas of one cell touches.
struct SurfacePiece {
  Index cell = 0;
  std::int32_t surface = 0;  ///< index into the surfaces
  Vec3 normal;               ///< unit vector into the gas
  Vec3 point;                ///< its middle [m]
  Real area = 0;             ///< [m2]
  Real distance = 0;         ///< from the middle of the cell's gas to the surface [m]
  Index beyond = -1;  ///< of a thin surface: the cell on its other side, beyond the face that it closes
};

/// A cell of which the gas has only a part.
struct PartCell {
  Index cell = 0;
  Real open_share = 0;  ///< of its volume
  Vec3 centroid;        ///< of the open part [m]
};

struct CutCells {
  std::vector<std::uint8_t> open;               ///< per cell: 1 if it holds gas
  std::vector<PartCell> parts;                  ///< open cells that are not whole, in the order of cells
  std::array<std::vector<Real>, 3> open_share;  ///< of every face, numbered as in FaceField
  std::vector<SurfacePiece> pieces;             ///< in the order of cells
  Index open_cells = 0;
  Index closed_faces = 0;  ///< faces between two open cells that a thin surface closes
};

/// Cells whose open share is less are left out: closed on all sides, so that nothing is lost through them.
inline constexpr Real smallest_open_share = 1e-3;

/// Cuts the cells of a grid with surfaces. The gas is what can be reached from `seed` [m]. A surface that has gas on
/// both sides within a cell (thinner than a cell) closes the faces that it crosses between their cells' centres; else a
/// cell keeps the part that the gas reaches, with the surface taken as straight between the lines of a lattice of twice
/// the grid's fineness. Open areas and volumes of a cell belong to one closed polyhedron, so that the sum of its
/// outward areas is zero. Throws std::invalid_argument if the seed lies on a surface.
CutCells cut_cells(const CartesianGrid& grid, const std::vector<ImmersedSurface>& surfaces, const Vec3& seed);

/// Which points [m] gas can spread between: of each point the number of its group, counted from 0 as they come; -1 on a
/// surface.
std::vector<int> group_points(const CartesianGrid& grid, const std::vector<ImmersedSurface>& surfaces,
                              const std::vector<Vec3>& points);

}  // namespace pellicle::cfd
