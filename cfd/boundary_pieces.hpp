// The boundaries cut into pieces: each piece is the part of one cell's boundary face that one patch takes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cfd/boundary.hpp"
#include "cfd/flow_geometry.hpp"

namespace pellicle::cfd {

enum class PieceKind { inlet, outlet, no_slip, slip };

struct BoundaryPiece {
  PieceKind kind = PieceKind::no_slip;
  int patch = -1;  ///< index of the patch; -1: a side without a patch, a wall at rest
  int axis = 0;
  Real outward = 1;  ///< +1 on a max side, -1 on a min side
  Index cell = 0;
  Index face = 0;
  Index place = 0;      ///< on the plane, see Stencil::plane_index
  Real area = 0;        ///< [m2]
  Real half_width = 0;  ///< from the cell centre to the face [m]
  Vec3 velocity;        ///< of a wall, or superficial of an inlet [m/s]
  Real pressure = 0;    ///< at an outlet [Pa]
  /// Of a boundary that is a surface within the domain: its piece there; -1: on a side. Then axis, outward, face and
  /// place have no meaning, half_width is the distance from the middle of the cell's gas, and the normal leads into it.
  std::int32_t surface_piece = -1;
  Vec3 normal;

  bool is_immersed() const { return surface_piece >= 0; }
  /// Speed of an inlet's gas into the domain, superficial [m/s].
  Real inward_speed() const { return is_immersed() ? dot(velocity, normal) : -outward * velocity[axis]; }
  /// Component along the outward normal.
  Real outward_part(const Vec3& v) const { return is_immersed() ? -dot(v, normal) : outward * v[axis]; }
};

/// Number of the side that lies across an axis, outward (+1 on a max side, -1 on a min side): 0 to 5.
inline std::size_t side_number(int axis, Real outward) {
  const int side = 2 * axis + (outward > 0 ? 1 : 0);
  return static_cast<std::size_t>(side);
}

/// Values that convection and gradients see at a boundary face: fixed + free * value in the cell.
struct BoundaryValue {
  Vec3 fixed;
  Vec3 free;
};

/// The pieces at each cell: those of group g are `pieces` from `begin[g]` to before `begin[g + 1]`, in order.
struct PieceGroups {
  std::vector<Index> begin{0};
  std::vector<Index> pieces;

  /// Calls f(piece) for all pieces; those of one cell, and so of one face, one after the other on one thread.
  template <class F>
  void for_each(const char* label, F&& f) const {
    for_entries(label, static_cast<Index>(begin.size()) - 1, [&](const Index g) {
      const auto group = static_cast<std::size_t>(g);
      for (auto i = static_cast<std::size_t>(begin[group]); i < static_cast<std::size_t>(begin[group + 1]);
           ++i) {
        f(static_cast<std::size_t>(pieces[i]));
      }
    });
  }
};

struct Boundaries {
  std::vector<BoundaryPiece> pieces;  ///< side by side, in the order of faces
  PieceGroups groups;
  std::vector<std::size_t> passable;  ///< pieces that are inlets or outlets
  /// Per side (min, max of each axis) and place on its plane; empty for periodic sides.
  std::array<std::vector<BoundaryValue>, 6> values;
  std::vector<std::string> patch_names;
  bool has_outlet = false;
  std::vector<char> open_pieces;  ///< of the geometry's surfaces: 1 where gas passes; empty if nowhere

  bool passes(std::size_t surface_piece) const {
    return !open_pieces.empty() && open_pieces[surface_piece] != 0;
  }
};

/// Cuts the sides of the grid along the patches' regions. Each face's pieces add up to its area exactly up to
/// round-off, so that an inlet whose edge cuts a face delivers the flow asked for.
/// Throws InputError as GasSolver says.
Boundaries cut_boundaries(const FlowGeometry& geometry, const std::vector<BoundaryPatch>& patches);

}  // namespace pellicle::cfd
