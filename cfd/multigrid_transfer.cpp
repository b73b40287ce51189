// What is carried between a grid of the multigrid and the coarser one: linearly along the conductors that join the middles
// of the aggregates.
#include <algorithm>
#include <array>

#include "cfd/multigrid_level.hpp"
#include "cfd/multigrid_loops.hpp"

namespace pellicle::cfd {

namespace {

// Between the middle of an aggregate and its cell beside the next one; none where nothing joins its cells.
float half_resistance(float inner) { return inner > 0 ? 0.5F / inner : 0.0F; }

}  // namespace

MultigridLevel::Link MultigridLevel::link(int axis, Index3 at, bool towards_plus) const {
  const auto a = static_cast<std::size_t>(axis);
  const SplitField& c = coefficient[a];
  const Index n = s.n[axis];
  const Index step = stride(axis);
  const Index e = place(at.x, at.y, at.z);
  const Index t = at[axis];
  // A face on the plus side of the last cell has a place of its own.
  const float through = c.at(towards_plus ? e + step : e);
  if (!(through > 0)) return {};
  if (!joined[a]) return {through, 0};
  const auto inner_of = [&](Index cell) {
    // Of the pair that the cell belongs to: the face on the minus side of the second one.
    const Index second = cell | 1;
    return second < n ? half_resistance(c.at(e + (second - t) * step)) : 0.0F;
  };
  const Index other = towards_plus ? (t + 1 < n ? t + 1 : 0) : (t > 0 ? t - 1 : n - 1);
  const float here = inner_of(t);
  const float all = here + 1 / through + inner_of(other);
  return {1 / all, here / all};
}

MultigridLevel::Link MultigridLevel::outlet_link(int axis, Index3 at) const {
  const auto a = static_cast<std::size_t>(axis);
  const Index e = place(at.x, at.y, at.z);
  const float through = outlet[a].at(e);
  if (!(through > 0)) return {};
  if (!joined[a]) return {through, 0};
  const Index second = at[axis] | 1;
  const float here =
      second < s.n[axis] ? half_resistance(coefficient[a].at(e + (second - at[axis]) * stride(axis))) : 0.0F;
  const float all = here + 1 / through;
  return {1 / all, here / all};
}

void MultigridLevel::set_weights() {
  for_lines("cfd::multigrid_transfer::set_weights", s, [&](Index j, Index k) {
    for (Index i = 0; i < s.n.x; ++i) {
      const Index3 at{i, j, k};
      const Index e = place(i, j, k);
      std::array<float, 3> share{};
      float sum = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (!joined[a]) continue;
        share[a] = link(axis, at, at[axis] % 2 == 1).share;
        sum += share[a];
        if (has_outlet[a]) sum += outlet_link(axis, at).share;
      }
      const float scale = sum > 1 ? 1 / sum : 1.0F;
      for (std::size_t a = 0; a < 3; ++a) beside[a].at(e) = share[a] * scale;
      own.at(e) = 1 - sum * scale;
    }
  });
}

namespace {

// Rows of the fine grid that take part in a row of aggregates: its own, and along y or z those beside it.
struct Rows {
  Index own[2];
  int count;
  Index minus, plus;  ///< -1: none
};

Rows rows_of(Index coarse, bool joined, Index n, bool periodic) {
  const Index first = first_child(coarse, joined);
  const Index last = last_child(coarse, joined, n);
  Rows rows{{first, last}, last > first ? 2 : 1, -1, -1};
  if (joined) {
    rows.minus = first > 0 ? first - 1 : (periodic ? n - 1 : -1);
    rows.plus = last + 1 < n ? last + 1 : (periodic ? 0 : -1);
  }
  return rows;
}

// The aggregate beside that of cell t; without one its own: the weight is 0.
Index beside_aggregate(Index t, bool joined, Index n, bool periodic) {
  if (!joined) return t;
  const Index other =
      t % 2 == 1 ? (t + 1 < n ? t + 1 : (periodic ? 0 : t)) : (t > 0 ? t - 1 : (periodic ? n - 1 : t));
  return other / 2;
}

}  // namespace

void MultigridLevel::restrict_to(MultigridLevel& coarse) const {
  const Stencil& sc = coarse.s;
  const int colours = two_coloured ? 1 : 2;
  for_lines("cfd::multigrid_transfer::restrict_to", sc, [&](Index jc, Index kc) {
    float* sum = coarse.line.data() + 1 + sc.cell(0, jc, kc);
    for (Index i = 0; i < sc.n.x; ++i) sum[i] = 0;
    // What one or two rows of cells give to the aggregates beside which they lie.
    const auto add = [&](const SplitField& weight, Index j, Index k) {
      for (Index c = 0; c < colours; ++c) {
        const HalfRow row = half_row(c, j, k);
        const float* w = weight.colour(c) + row.h;
        const float* in = r.colour(c) + row.h;
        if (joined[0]) {
#pragma GCC ivdep
          for (Index m = 0; m < row.count; ++m) sum[m] += w[m] * in[m];
        } else {
#pragma GCC ivdep
          for (Index m = 0; m < row.count; ++m) sum[row.first + 2 * m] += w[m] * in[m];
        }
      }
    };
    const auto add_two = [&](const SplitField& weight, Index j1, Index k1, Index j2, Index k2) {
      if (colours == 2 || !joined[0] || s.n.x % 2 == 1) {
        add(weight, j1, k1);
        add(weight, j2, k2);
        return;
      }
      const HalfRow one = half_row(0, j1, k1);
      const HalfRow two = half_row(0, j2, k2);
      const float *w1 = weight.colour(0) + one.h, *in1 = r.colour(0) + one.h;
      const float *w2 = weight.colour(0) + two.h, *in2 = r.colour(0) + two.h;
#pragma GCC ivdep
      for (Index m = 0; m < one.count; ++m) sum[m] += w1[m] * in1[m] + w2[m] * in2[m];
    };
    // Cell i of a row belongs to aggregate i / 2 and acts on the one before it if i is even, else on the one after.
    const auto add_own = [&](Index j, Index k) {
      for (Index c = 0; c < colours; ++c) {
        const HalfRow row = half_row(c, j, k);
        const float *w = own.colour(c) + row.h, *in = r.colour(c) + row.h;
        if (!joined[0]) {
#pragma GCC ivdep
          for (Index m = 0; m < row.count; ++m) sum[row.first + 2 * m] += w[m] * in[m];
          continue;
        }
        const float* along = beside[0].colour(c) + row.h;
        if (row.first == 0) {
          const Index last = row.count - 1;
#pragma GCC ivdep
          for (Index m = 0; m < last; ++m) sum[m] += w[m] * in[m] + along[m + 1] * in[m + 1];
          sum[last] += w[last] * in[last];
          if (s.periodic[0]) sum[sc.n.x - 1] += along[0] * in[0];
        } else {
          if (row.count > 0) sum[0] += w[0] * in[0];
#pragma GCC ivdep
          for (Index m = 1; m < row.count; ++m) sum[m] += w[m] * in[m] + along[m - 1] * in[m - 1];
          if (row.count < sc.n.x && row.count > 0) sum[row.count] += along[row.count - 1] * in[row.count - 1];
          if (s.periodic[0] && s.n.x % 2 == 0) sum[0] += along[row.count - 1] * in[row.count - 1];
        }
      }
    };
    const Rows y = rows_of(jc, joined[1], s.n.y, s.periodic[1]);
    const Rows z = rows_of(kc, joined[2], s.n.z, s.periodic[2]);
    for (int kk = 0; kk < z.count; ++kk) {
      const Index k = z.own[kk];
      for (int jj = 0; jj < y.count; ++jj) add_own(y.own[jj], k);
      if (y.minus >= 0 && y.plus >= 0) {
        add_two(beside[1], y.minus, k, y.plus, k);
      } else if (y.minus >= 0 || y.plus >= 0) {
        add(beside[1], std::max(y.minus, y.plus), k);
      }
    }
    for (int jj = 0; jj < y.count; ++jj) {
      const Index j = y.own[jj];
      if (z.minus >= 0 && z.plus >= 0) {
        add_two(beside[2], j, z.minus, j, z.plus);
      } else if (z.minus >= 0 || z.plus >= 0) {
        add(beside[2], j, std::max(z.minus, z.plus));
      }
    }
    for (Index c = 0; c < 2; ++c) {
      const HalfRow row = coarse.half_row(c, jc, kc);
      float* out = coarse.b.colour(c) + row.h;
#pragma GCC ivdep
      for (Index m = 0; m < row.count; ++m) out[m] = sum[row.first + 2 * m];
    }
  });
}

void MultigridLevel::add_correction(const MultigridLevel& coarse) {
  const Stencil& sc = coarse.s;
  for_lines("cfd::multigrid_transfer::gather", sc, [&](Index j, Index k) {
    float* out = coarse.line.data() + 1 + sc.cell(0, j, k);
    for (Index c = 0; c < 2; ++c) {
      const HalfRow row = coarse.half_row(c, j, k);
      const float* in = coarse.x.colour(c) + row.h;
#pragma GCC ivdep
      for (Index m = 0; m < row.count; ++m) out[row.first + 2 * m] = in[m];
    }
  });
  // Of a cell that the other colour's half sweep overwrites nothing is needed.
  const int colours = two_coloured ? 1 : 2;
  for_lines("cfd::multigrid_transfer::add_correction", s, [&](Index j, Index k) {
    const Index jc = joined[1] ? j / 2 : j;
    const Index kc = joined[2] ? k / 2 : k;
    const float* values = coarse.line.data() + 1;
    const float* here = values + sc.cell(0, jc, kc);
    const float* over_y = values + sc.cell(0, beside_aggregate(j, joined[1], s.n.y, s.periodic[1]), kc);
    const float* over_z = values + sc.cell(0, jc, beside_aggregate(k, joined[2], s.n.z, s.periodic[2]));
    for (Index c = 0; c < colours; ++c) {
      const HalfRow row = half_row(c, j, k);
      const float *w = own.colour(c) + row.h, *wx = beside[0].colour(c) + row.h;
      const float *wy = beside[1].colour(c) + row.h, *wz = beside[2].colour(c) + row.h;
      float* out = x.colour(c) + row.h;
      if (!joined[0]) {
        for (Index m = 0; m < row.count; ++m) {
          const Index i = row.first + 2 * m;
          out[m] += w[m] * here[i] + wy[m] * over_y[i] + wz[m] * over_z[i];
        }
        continue;
      }
      // Beyond the ends of a row the weight is 0, but around a periodic axis.
      const float* over_x = here + (row.first == 0 ? -1 : 1);
#pragma GCC ivdep
      for (Index m = 0; m < row.count; ++m) {
        out[m] += (w[m] * here[m] + wx[m] * over_x[m]) + (wy[m] * over_y[m] + wz[m] * over_z[m]);
      }
      if (!s.periodic[0]) continue;
      const Index last = row.count - 1;
      if (row.first == 0) out[0] += wx[0] * (here[sc.n.x - 1] - over_x[0]);
      if (row.first == 1 && s.n.x % 2 == 0) out[last] += wx[last] * (here[0] - over_x[last]);
    }
  });
  repeat_ends();
}

}  // namespace pellicle::cfd
