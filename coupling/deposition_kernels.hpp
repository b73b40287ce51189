// Deposition kernels: how the volume of a particle is shared among the cells of a grid.
//
// A kernel divides the particle into pieces of equal volume and puts each piece whole into the cell that holds its
// centre. Weights are therefore whole numbers of pieces: they sum to exactly 1. What a cell gets is found without
// visiting the pieces: per axis, the pieces whose centres lie below a cell face are a bit mask, and the number of
// pieces in a cell is the number of bits in the intersection of three masks.
#pragma once

#include <Kokkos_Core.hpp>

#include <cstdint>
#include <variant>

#include "core/model_list.hpp"
#include "core/model_variant.hpp"
#include "core/types.hpp"

namespace pellicle::coupling {

/// One bit a piece.
using PieceMask = std::uint64_t;

/// The whole particle goes into the cell of its centre.
struct Centroid {
  static constexpr core::ModelInfo info{"centroid", "the whole particle into the cell of its centre",
                                        "thesis section 3.3.1, first method"};
  static constexpr int pieces = 1;
  /// Most cells along an axis that can hold a piece.
  static constexpr int most_cells_along_axis = 1;
  /// Largest offset of a piece's centre along an axis, in particle radii.
  KOKKOS_INLINE_FUNCTION static constexpr Real extent(int /*axis*/) { return 0; }
  /// Pieces whose centres lie below `offset` along the axis, measured from the particle's centre in its radii.
  KOKKOS_INLINE_FUNCTION static constexpr PieceMask pieces_below(int /*axis*/, Real offset) {
    return 0 < offset ? 1u : 0u;
  }
};

/// 33 pieces of equal volume: a core of radius 33^(-1/3) R = 0.3118 R and two shells that meet at (17/33)^(1/3) R =
/// 0.8016 R, each of 8 azimuthal x 2 polar pieces (thesis Fig. 3.4). The polar axis is z, the first azimuthal cut the
/// x axis. Each piece stands where its volume's centroid is: with the shell's mean radius rho = 3/4 (r2^4 - r1^4) /
/// (r2^3 - r1^3), a piece is at z = +- rho/2 and, in x and y, at rho sin(pi/4) and rho (1 - cos(pi/4)).
struct Divided {
  static constexpr core::ModelInfo info{"divided",
                                        "33 pieces of equal volume, each into the cell of its centre",
                                        "thesis section 3.3.1, Fig. 3.4"};
  static constexpr int pieces = 33;
  static constexpr int most_cells_along_axis = 9;

  static constexpr Real inner_mean_radius =
      0.62419129822949903;  ///< rho of the inner shell, in particle radii
  static constexpr Real outer_mean_radius = 0.90806967268228822;

  KOKKOS_INLINE_FUNCTION static constexpr Real extent(int axis) {
    return axis == 2 ? 0.5 * outer_mean_radius : far * outer_mean_radius;
  }

  KOKKOS_INLINE_FUNCTION static constexpr PieceMask pieces_below(int axis, Real offset) {
    PieceMask mask = 0 < offset ? core_piece : 0;
    if (axis == 2) {
      mask |= shell_below(offset / inner_mean_radius, 0.5, inner_up, 0, 0, inner_up << 8);
      mask |= shell_below(offset / outer_mean_radius, 0.5, outer_up, 0, 0, outer_up << 8);
      return mask;
    }
    // Azimuthal pieces by the coordinate of their centres: far and near on the positive side, near and far on the
    // negative side; bit a is the piece between 45 a and 45 (a + 1) degrees.
    const PieceMask far_up = axis == 0 ? 0x81u : 0x06u, near_up = axis == 0 ? 0x42u : 0x09u;
    const PieceMask near_down = axis == 0 ? 0x24u : 0x90u, far_down = axis == 0 ? 0x18u : 0x60u;
    const Real inner = offset / inner_mean_radius, outer = offset / outer_mean_radius;
    mask |= shell_below(inner, far, far_up * inner_both, near_up * inner_both, near_down * inner_both,
                        far_down * inner_both);
    mask |= shell_below(outer, far, far_up * outer_both, near_up * outer_both, near_down * outer_both,
                        far_down * outer_both);
    return mask;
  }

 private:
  // Bits: 0 the core; 1-8 and 9-16 the inner shell's upper and lower halves by azimuth; 17-24 and 25-32 the outer's.
  static constexpr PieceMask core_piece = 1;
  static constexpr PieceMask inner_up = PieceMask{0xff} << 1, outer_up = PieceMask{0xff} << 17;
  static constexpr PieceMask inner_both = PieceMask{0x0101} << 1, outer_both = PieceMask{0x0101} << 17;
  static constexpr Real far =
      0.70710678118654752;               // sin(pi/4): centres at 2 sin(pi/8) cos(pi/8) of the shell's rho
  static constexpr Real near = 1 - far;  // 2 sin(pi/8) sin(pi/8)

  KOKKOS_INLINE_FUNCTION static constexpr PieceMask shell_below(Real offset, Real distance, PieceMask far_up,
                                                                PieceMask near_up, PieceMask near_down,
                                                                PieceMask far_down) {
    return (-distance < offset ? far_down : 0) | (-near < offset ? near_down : 0) |
           (near < offset ? near_up : 0) | (distance < offset ? far_up : 0);
  }
};

/// The family: what `coupling.deposition` may name.
using Deposition = std::variant<Divided, Centroid>;

}  // namespace pellicle::coupling
