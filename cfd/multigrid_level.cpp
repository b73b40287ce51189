#include "cfd/multigrid_level.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cfd/multigrid_loops.hpp"

namespace pellicle::cfd {

namespace {

// Entries a row of cells takes, an odd number; a periodic axis has its ends repeated beyond them.
Index padded(Index n, bool periodic) {
  if (n == 1) return 1;
  const Index least = n + (periodic ? 2 : 1);
  return least % 2 == 1 ? least : least + 1;
}

}  // namespace

MultigridLevel::MultigridLevel(const Stencil& stencil) : s(stencil) {
  row_length = padded(s.n.x, s.periodic[0]);
  plane_rows = padded(s.n.y, s.periodic[1]);
  const Index plane = row_length * plane_rows;
  origin = plane + 1;  // even
  half = (origin + plane * (s.n.z + 1)) / 2 + 2;
  for (std::size_t a = 0; a < 3; ++a) {
    const Index n = s.n[static_cast<int>(a)];
    if (s.periodic[a] && n % 2 == 1 && n > 1) two_coloured = false;
    coefficient[a] = SplitField("cfd::multigrid_level::coefficient", half);
    outlet[a] = SplitField("cfd::multigrid_level::outlet", half);
    beside[a] = SplitField("cfd::multigrid_level::beside", half);
  }
  diagonal = SplitField("cfd::multigrid_level::diagonal", half);
  inverse = SplitField("cfd::multigrid_level::inverse", half);
  own = SplitField("cfd::multigrid_level::own", half);
  x = SplitField("cfd::multigrid_level::x", half);
  b = SplitField("cfd::multigrid_level::b", half);
  r = SplitField("cfd::multigrid_level::r", half);
  line = make_field<float>("cfd::multigrid_level::line", static_cast<std::size_t>(s.cells() + 2));
}

bool MultigridLevel::take(const PressureMatrix& matrix) {
  constexpr char has_changed = 1;
  // A bit for each axis that leads to an outlet follows.
  const auto take_row = [](const SplitField& field, Index start, Index count, const Real* values) {
    float difference = 0;
    float size = 0;
    for (Index c = 0; c < 2; ++c) {
      const Index first = (start + c) & 1;
      float* held = field.colour(c) + ((start + first) >> 1);
      const Index n = (count - first + 1) / 2;
      const Real* from = values + first;
#pragma omp simd reduction(+ : difference, size)
      for (Index m = 0; m < n; ++m) {
        const auto value = static_cast<float>(from[2 * m]);
        difference += std::abs(held[m] - value);
        size += std::abs(value);
        held[m] = value;
      }
    }
    return std::pair{!(difference == 0), !(size == 0)};
  };
  flags_.assign(static_cast<std::size_t>(s.n.z), 0);
  const auto take_plane = [&](const Index k) {
    char flags = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      for (Index j = 0; j < s.n.y; ++j) {
        const Real* out = matrix.boundary[a].data() + s.cell(0, j, k);
        prefetch_row(out + s.n.x, s.n.x);
        const auto [changed, any] = take_row(outlet[a], place(0, j, k), s.n.x, out);
        if (changed) flags |= has_changed;
        if (any) flags = static_cast<char>(flags | (2 << axis));
      }
      // A face that joins a cell to itself carries no flow by pressure.
      if (s.n[axis] < 2) continue;
      const Index planes = axis == 2 && k == s.n.z - 1 ? 2 : 1;
      const Index rows = s.n.y + (axis == 1 ? 1 : 0);
      for (Index kk = k; kk < k + planes; ++kk) {
        for (Index j = 0; j < rows; ++j) {
          const Real* c = matrix.coefficient[a].data() + s.face(axis, 0, j, kk);
          prefetch_row(c + s.n.x, s.n.x);
          if (take_row(coefficient[a], place(0, j, kk), s.n.x + (axis == 0 ? 1 : 0), c).first)
            flags |= has_changed;
        }
      }
    }
    flags_[static_cast<std::size_t>(k)] = flags;
  };
  for_planes("cfd::multigrid_level::take", s, take_plane);
  char all = 0;
  for (const char flags : flags_) all |= flags;
  for (int axis = 0; axis < 3; ++axis) has_outlet[static_cast<std::size_t>(axis)] = (all & (2 << axis)) != 0;
  return (all & has_changed) != 0;
}

void MultigridLevel::coarsen_to(MultigridLevel& coarse) const {
  const Stencil& sc = coarse.s;
  coarse.has_outlet = has_outlet;
  for_lines("cfd::multigrid_level::coarsen_to", sc, [&](Index j, Index k) {
    for (Index i = 0; i < sc.n.x; ++i) {
      const Index3 at{i, j, k};
      const Index e = coarse.place(i, j, k);
      Index3 lo, hi;
      for (int a = 0; a < 3; ++a) {
        lo[a] = first_child(at[a], joined[static_cast<std::size_t>(a)]);
        hi[a] = last_child(at[a], joined[static_cast<std::size_t>(a)], s.n[a]);
      }
      const auto sum_over = [](Index3 from, Index3 to, auto&& term) {
        float sum = 0;
        for (Index kf = from.z; kf <= to.z; ++kf) {
          for (Index jf = from.y; jf <= to.y; ++jf) {
            for (Index f = from.x; f <= to.x; ++f) sum += term(Index3{f, jf, kf});
          }
        }
        return sum;
      };
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (has_outlet[a]) {
          coarse.outlet[a].at(e) =
              sum_over(lo, hi, [&](Index3 f) { return outlet_link(axis, f).conductance; });
        }
        if (sc.n[axis] < 2 || (at[axis] == 0 && !sc.periodic[a])) continue;
        Index3 to = hi;
        to[axis] = lo[axis];
        const float sum = sum_over(lo, to, [&](Index3 f) { return link(axis, f, false).conductance; });
        coarse.coefficient[a].at(e) = sum;
        if (at[axis] == 0) coarse.coefficient[a].at(e + sc.n[axis] * coarse.stride(axis)) = sum;
      }
    }
  });
}

void MultigridLevel::finish() {
  for_lines("cfd::multigrid_level::finish", s, [&](Index j, Index k) {
    for (Index c = 0; c < 2; ++c) {
      const HalfRow row = half_row(c, j, k);
      float* d = diagonal.colour(c) + row.h;
      float* inv = inverse.colour(c) + row.h;
      for (Index m = 0; m < row.count; ++m) d[m] = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const float* minus = coefficient[a].colour(c) + row.h;
        const float* plus = coefficient[a].colour(1 - c) + row.h + plus_step(axis, c);
        const float* out = outlet[a].colour(c) + row.h;
        for (Index m = 0; m < row.count; ++m) d[m] += minus[m] + plus[m] + out[m];
      }
      for (Index m = 0; m < row.count; ++m) inv[m] = d[m] > 0 ? 1 / d[m] : 0.0F;
    }
  });
}

// What the six neighbours of the cells of one colour contribute.
struct MultigridLevel::Neighbours {
  Neighbours(const MultigridLevel& level, Index c)
      : cxm(level.coefficient[0].colour(c)),
        cym(level.coefficient[1].colour(c)),
        czm(level.coefficient[2].colour(c)),
        cxp(level.coefficient[0].colour(1 - c) + level.plus_step(0, c)),
        cyp(level.coefficient[1].colour(1 - c) + level.plus_step(1, c)),
        czp(level.coefficient[2].colour(1 - c) + level.plus_step(2, c)),
        xm(level.x.colour(1 - c) + level.plus_step(0, c) - 1),
        xp(xm + 1),
        ym(level.x.colour(1 - c) + level.plus_step(1, c) - level.row_length),
        yp(ym + level.row_length),
        zm(level.x.colour(1 - c) + level.plus_step(2, c) - level.stride(2)),
        zp(zm + level.stride(2)) {}
  float operator()(Index h) const {
    return (cxm[h] * xm[h] + cxp[h] * xp[h]) + (cym[h] * ym[h] + cyp[h] * yp[h]) +
           (czm[h] * zm[h] + czp[h] * zp[h]);
  }
  const float *cxm, *cym, *czm, *cxp, *cyp, *czp, *xm, *xp, *ym, *yp, *zm, *zp;
};

void MultigridLevel::start() {
  const float* in = b.colour(0);
  const float* inv = inverse.colour(0);
  float* out = x.colour(0);
  for_chunks("cfd::multigrid_level::start", begin(0), end(0), [&](Index from, Index to) {
#pragma GCC ivdep
    for (Index h = from; h < to; ++h) out[h] = in[h] * inv[h];
  });
  if (!two_coloured) {
    float* black = x.colour(1);
    for (Index h = 0; h < half; ++h) black[h] = 0;
  }
  repeat_ends();
  smooth(1);
}

void MultigridLevel::smooth(Index c) {
  const float* in = b.colour(c);
  const float* inv = inverse.colour(c);
  float* out = x.colour(c);
  const Neighbours sum(*this, c);
  for_chunks("cfd::multigrid_level::smooth", begin(c), end(c), [&](Index from, Index to) {
    const Neighbours near = sum;
#pragma GCC ivdep
    for (Index h = from; h < to; ++h) out[h] = (in[h] + near(h)) * inv[h];
  });
  repeat_ends();
}

void MultigridLevel::compute_residual() {
  // Black was updated last: its residual is 0, but for cells that touch their own colour.
  for (Index c = 0; c < (two_coloured ? 1 : 2); ++c) {
    const float* in = b.colour(c);
    const float* d = diagonal.colour(c);
    const float* value = x.colour(c);
    float* out = r.colour(c);
    const Neighbours sum(*this, c);
    for_chunks("cfd::multigrid_level::compute_residual", begin(c), end(c), [&](Index from, Index to) {
      const Neighbours near = sum;
#pragma GCC ivdep
      for (Index h = from; h < to; ++h) out[h] = in[h] + near(h) - d[h] * value[h];
    });
  }
}

// Cells beyond the ends of periodic axes.
void MultigridLevel::repeat_ends() const {
  for (int axis = 0; axis < 3; ++axis) {
    const Index n = s.n[axis];
    if (!s.periodic[static_cast<std::size_t>(axis)] || n < 2) continue;
    const Index around = n * stride(axis);
    const int u = axis == 0 ? 1 : 0;
    const int v = axis == 2 ? 1 : 2;
    for (Index q = 0; q < s.n[v]; ++q) {
      for (Index p = 0; p < s.n[u]; ++p) {
        const Index first = origin + p * stride(u) + q * stride(v);
        x.at(first + around) = x.at(first);
        x.at(first - stride(axis)) = x.at(first + around - stride(axis));
      }
    }
  }
}

}  // namespace pellicle::cfd
