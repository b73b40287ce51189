// One grid of the pressure's multigrid, in single precision. Cells of one colour lie one after the other: with an odd
// number of entries a row and a plane (one at least belongs to no cell) the colour of a cell is the parity of its
// place, its neighbours are of the other colour, and every loop of the smoother runs over memory without a gap.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cfd/field_memory.hpp"
#include "cfd/pressure_system.hpp"
#include "cfd/stencil.hpp"

namespace pellicle::cfd {

/// A value per place; the places of one colour are contiguous.
struct SplitField {
  SplitField() = default;
  SplitField(const char* label, Index half_count)
      : half(half_count),
        values(make_field<float>(label, std::size_t{2} * static_cast<std::size_t>(half_count))) {}
  float* colour(Index c) const { return values.data() + std::ptrdiff_t{c} * half; }
  float& at(Index place) const { return values.data()[(place & 1) * half + (place >> 1)]; }

  Index half = 0;
  HostArray<float> values;
};

/// Cells of one colour in a row: i = first, first + 2, ...; from h on in the field of that colour.
struct HalfRow {
  Index first, h, count;
};

struct MultigridLevel {
  explicit MultigridLevel(const Stencil& stencil);

  Index place(Index i, Index j, Index k) const { return origin + i + row_length * (j + plane_rows * k); }
  HalfRow half_row(Index colour, Index j, Index k) const {
    const Index start = place(0, j, k);
    const Index first = (start + colour) & 1;
    return {first, (start + first) >> 1, (s.n.x - first + 1) / 2};
  }
  /// Places between a cell and its neighbour along an axis; odd.
  Index stride(int axis) const { return axis == 0 ? 1 : (axis == 1 ? row_length : row_length * plane_rows); }

  /// From the entry of a cell of colour c to that of its neighbour on the plus side in the other colour's field; the one
  /// on the minus side comes a stride before that.
  Index plus_step(int axis, Index c) const { return (stride(axis) - 1) / 2 + c; }
  /// Entries of a colour, from the first cell to the last.
  Index begin(Index c) const { return (origin + 1 - c) / 2; }
  Index end(Index c) const { return (origin + stride(2) * s.n.z + 1 - c) / 2; }

  /// Takes the coefficients; false if it holds exactly these already.
  bool take(const PressureMatrix& matrix);
  /// Coefficients of the coarser grid.
  void coarsen_to(MultigridLevel& coarse) const;
  /// Weights of what is carried between this grid and the coarser one.
  void set_weights();
  /// Diagonal and its inverse from the rest.
  void finish();

  /// Solution of the first half of a sweep that begins with x = 0.
  void start();
  void smooth(Index colour);
  void compute_residual();
  /// b of the coarser grid from the residual here; x here from x there. Transposes of each other.
  void restrict_to(MultigridLevel& coarse) const;
  void add_correction(const MultigridLevel& coarse);

  Stencil s;
  std::array<bool, 3> joined{false, false, false};  ///< cells in pairs along the axis on the coarser grid
  /// Around an odd periodic axis two cells of one colour touch; they see each other as before the half sweep.
  bool two_coloured = true;
  Index row_length = 1, plane_rows = 1, origin = 0, half = 0;
  std::array<SplitField, 3> coefficient;  ///< of the face on the cell's minus side
  std::array<SplitField, 3> outlet;       ///< towards outlets across the axis
  std::array<bool, 3> has_outlet{false, false, false};
  SplitField diagonal, inverse, x, b, r;
  /// Share of a cell's value that comes from the aggregate beside its own along the axis, and from its own.
  std::array<SplitField, 3> beside;
  SplitField own;
  HostArray<float>
      line;  ///< x or b in the order of cells, with one entry before the first and after the last

 private:
  /// Between a cell and the aggregate beside its own.
  struct Link {
    float conductance = 0;  ///< from middle to middle of the aggregates through one fine face
    float share = 0;        ///< of that way in the cell's own aggregate
  };
  Link link(int axis, Index3 at, bool towards_plus) const;
  Link outlet_link(int axis, Index3 at) const;
  void repeat_ends() const;
  struct Neighbours;
  std::vector<char> flags_;  ///< of planes
};

}  // namespace pellicle::cfd
