// Rows, cells and faces of a structured grid, and loops over them on the host.
#pragma once

#include <Kokkos_Core.hpp>
#include <array>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"

namespace pellicle::cfd {

/// One row of cells along x: where it, its neighbour rows and its faces begin. A neighbour that does not exist is
/// the row itself, so that it can be read; its coefficient is 0.
struct Row {
  Index j, k;
  Index cell;                              ///< of i = 0
  Index y_minus, y_plus, z_minus, z_plus;  ///< cell of i = 0 of the neighbour rows
  Index x_face, y_face, z_face;            ///< face on the minus side of cell i = 0
  Index before_first, after_last;          ///< i of the neighbours of the row's ends
};

/// Numbering of cells and faces of nx x ny x nz cells; see FaceField.
struct Stencil {
  Index3 n{0, 0, 0};
  std::array<bool, 3> periodic{false, false, false};

  Index cells() const { return n.x * n.y * n.z; }
  Index rows() const { return n.y * n.z; }
  Index faces(int axis) const { return cells() / n[axis] * (n[axis] + 1); }
  Index stride(int axis) const { return axis == 0 ? 1 : (axis == 1 ? n.x : n.x * n.y); }
  Index cell(Index i, Index j, Index k) const { return i + n.x * (j + n.y * k); }
  /// Number of the face on the minus side of cell (i, j, k) across the axis; the index along the axis may be n.
  Index face(int axis, Index i, Index j, Index k) const {
    if (axis == 0) return i + (n.x + 1) * (j + n.y * k);
    if (axis == 1) return i + n.x * (j + (n.y + 1) * k);
    return i + n.x * (j + n.y * k);
  }
  /// Distance in a face array from the face on the minus side of a cell to that on its plus side.
  Index face_step(int axis) const { return stride(axis); }
  /// Cells on a plane across the axis, and the place of (i, j, k) on it.
  Index plane_size(int axis) const { return cells() / n[axis]; }
  Index plane_index(int axis, Index i, Index j, Index k) const {
    return axis == 0 ? j + n.y * k : (axis == 1 ? i + n.x * k : i + n.x * j);
  }

  Row row(Index r) const {
    const Index j = r % n.y;
    const Index k = r / n.y;
    const Index jm = j > 0 ? j - 1 : (periodic[1] ? n.y - 1 : j);
    const Index jp = j < n.y - 1 ? j + 1 : (periodic[1] ? 0 : j);
    const Index km = k > 0 ? k - 1 : (periodic[2] ? n.z - 1 : k);
    const Index kp = k < n.z - 1 ? k + 1 : (periodic[2] ? 0 : k);
    return {j,
            k,
            cell(0, j, k),
            cell(0, jm, k),
            cell(0, jp, k),
            cell(0, j, km),
            cell(0, j, kp),
            face(0, 0, j, k),
            face(1, 0, j, k),
            face(2, 0, j, k),
            periodic[0] ? n.x - 1 : 0,
            periodic[0] ? 0 : n.x - 1};
  }
};

/// Below so many cells a loop runs on the calling thread: starting the others would take longer. Does not change
/// results: every entry is computed on its own.
inline constexpr Index serial_limit = 1500;

/// Calls f(row number) for every row of cells.
template <class F>
void for_rows(const char* label, const Stencil& s, F&& f) {
  if (s.cells() < serial_limit) {
    for (Index r = 0; r < s.rows(); ++r) f(r);
  } else {
    Kokkos::parallel_for(label, HostRange(0, s.rows()), [&](const Index r) { f(r); });
  }
}

/// Calls f(entry) for 0 <= entry < count.
template <class F>
void for_entries(const char* label, Index count, F&& f) {
  if (count < serial_limit) {
    for (Index c = 0; c < count; ++c) f(c);
  } else {
    Kokkos::parallel_for(label, HostRange(0, count), [&](const Index c) { f(c); });
  }
}

/// Asks for the values that begin at `first`, as far as a row of cells goes. A loop over rows that goes through more than a
/// handful of fields waits for memory unless it asks for the next row while it is at this one.
template <class T>
inline void prefetch_row(const T* first, Index count) {
  constexpr Index line = 64 / static_cast<Index>(sizeof(T));
  for (Index i = 0; i < count; i += line) __builtin_prefetch(first + i);
}

/// Calls op(i, left, right) along a row; left and right are the neighbours' i. No op may read what another one writes:
/// they run side by side.
template <class Op>
inline void along_row(const Row& row, Index nx, Op&& op) {
  if (nx == 1) {
    op(Index{0}, row.before_first, row.after_last);
    return;
  }
  op(Index{0}, row.before_first, Index{1});
#pragma GCC ivdep
  for (Index i = 1; i < nx - 1; ++i) op(i, i - 1, i + 1);
  op(nx - 1, nx - 2, row.after_last);
}

/// The same with left = i - 1 and right = i + 1 all along the row, in one loop that vectorises as a whole, where the row's
/// ends have no neighbours: what is read there belongs to another row, and the op must give it no weight.
template <class Op>
inline void along_open_row(const Stencil& s, const Row& row, Op&& op) {
  const Index nx = s.n.x;
  if (s.periodic[0] || row.cell == 0 || row.cell + nx == s.cells()) {
    along_row(row, nx, op);
    return;
  }
#pragma GCC ivdep
  for (Index i = 0; i < nx; ++i) op(i, i - 1, i + 1);
}

/// Calls f(face, minus cell, plus cell, position along the axis, place on the plane) for every face that has a cell
/// on both sides; of a periodic axis' first and last face only the first. No f may read what another one writes.
/// Before each row of cells ask(face, cell) is called with the first ones of the next row, see prefetch_row.
template <class F, class Ask>
void for_faces(const char* label, const Stencil& s, int axis, F&& f, Ask&& ask) {
  const Index first = s.periodic[static_cast<std::size_t>(axis)] ? 0 : 1;
  for_rows(label, s, [&](const Index r) {
    const Row row = s.row(r);
    ask((axis == 0 ? row.x_face : (axis == 1 ? row.y_face : row.z_face)) + s.n.x, row.cell + s.n.x);
    if (axis == 0) {
      if (first == 0) f(row.x_face, row.cell + s.n.x - 1, row.cell, Index{0}, r);
#pragma GCC ivdep
      for (Index i = 1; i < s.n.x; ++i) f(row.x_face + i, row.cell + i - 1, row.cell + i, i, r);
    } else {
      // One loop for both: of a large f called in several places the compiler makes a function, face by face.
      const Index position = axis == 1 ? row.j : row.k;
      if (position < first) return;
      const Index face = axis == 1 ? row.y_face : row.z_face;
      const Index minus = axis == 1 ? row.y_minus : row.z_minus;
      const Index place = s.n.x * (axis == 1 ? row.k : row.j);
#pragma GCC ivdep
      for (Index i = 0; i < s.n.x; ++i) f(face + i, minus + i, row.cell + i, position, place + i);
    }
  });
}

template <class F>
void for_faces(const char* label, const Stencil& s, int axis, F&& f) {
  for_faces(label, s, axis, f, [](Index, Index) {});
}

/// Gives the last face of a periodic axis the value of the first; nothing on other axes.
inline void copy_periodic_faces(const Stencil& s, int axis, const HostArray<Real>& field) {
  if (!s.periodic[static_cast<std::size_t>(axis)]) return;
  const Index n = s.n[axis];
  for (Index b = 0; b < (axis == 2 ? s.n.y : s.n.z); ++b) {
    for (Index a = 0; a < (axis == 0 ? s.n.y : s.n.x); ++a) {
      if (axis == 0) field(s.face(0, n, a, b)) = field(s.face(0, 0, a, b));
      if (axis == 1) field(s.face(1, a, n, b)) = field(s.face(1, a, 0, b));
      if (axis == 2) field(s.face(2, a, b, n)) = field(s.face(2, a, b, 0));
    }
  }
}

}  // namespace pellicle::cfd
