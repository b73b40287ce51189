// The contact loop of a CPU: a block of particles a work item, each pair within it once, touching pairs side by side in
// vector registers. Forces are found in single precision unless the laws remember, and put together in double precision
// (PairForce).
#pragma once

#include <algorithm>
#include <limits>

#include "dem/contact_force.hpp"
#include "dem/contact_loop.hpp"
#include "dem/lanes.hpp"
#include "dem/prefetch.hpp"

namespace pellicle::dem {

/// List entries that are looked at before the touching pairs among them are worked on: so few that all about them stays
/// in the first-level cache. A multiple of 16.
inline constexpr int pair_window = 256;

/// The touching pairs of a window, one array a quantity.
template <int Springs>
struct PairWindow {
  static constexpr int room = pair_window + 16;
  static constexpr int components = Springs > 0 ? 3 * Springs : 1;
  static constexpr int spring_room = Springs > 0 ? room : 1;
  alignas(64) Real dx[room], dy[room], dz[room];
  alignas(64) float gap[room], ri[room], rj[room];
  alignas(64) float dvx[room], dvy[room], dvz[room];
  alignas(64) float difference_x[room], difference_y[room], difference_z[room];  // of the spins
  alignas(64) float sum_x[room], sum_y[room], sum_z[room];
  alignas(64) float inverse_mass_difference[room], inverse_mass_sum[room];
  // The force: see PairForce.
  alignas(64) float pull[room], friction_x[room], friction_y[room], friction_z[room], skew[room];
  alignas(64) float rolling_x[room], rolling_y[room], rolling_z[room];
  alignas(64) Real spring[components][spring_room];
  alignas(64) std::int32_t i[room], j[room];                // particles
  alignas(64) std::int32_t sum_of_i[room], sum_of_j[room];  // whose sums the force goes to
  alignas(64) std::int32_t touching_i[room], touching_j[room], parameters[room];
  lanes::Mask8 touches[pair_window / 8];  // list entries, eight a group
  int count = 0;
  int within = 0;     // of them, pairs within the block
  Index rows = 1;     // that the entries are in
  bool dense = true;  // most rows of the window before had pairs that touch
};

/// A block of particles a work item: scan rows, gather touching pairs, run the laws over them in vectors, add up.
/// Of pairs within the block the row of one particle has the entry, and both get its force. Pairs with particles of other
/// blocks have an entry on each side, and only the particle of this block gets the force: blocks share no results.
template <class Laws, bool OnePair, bool Repeats>
struct BlockContactKernel {
  using Number = float;
  using Window = PairWindow<Laws::springs>;

  ContactInput in;
  ContactResult out;
  Laws laws;

  void operator()(const Index block) const {
    Window window;
    BlockReport report = start_report(out.report(block));
    const Index begin = block * contact_block;
    const Index end = std::min(begin + contact_block, in.particles.count);
    auto* const sums = reinterpret_cast<Sum*>(out.load.data() + begin);
    for (Index k = 0; k < end - begin; ++k) sums[k] = Sum{};
    // What belongs to other blocks, in several places so that one addition need not wait for another.
    alignas(64) Sum elsewhere[16] = {};
    const std::int32_t last = in.list.offset(end);
    Index asked = 0;
    for (std::int32_t slot = in.list.offset(begin); slot < last; slot += pair_window) {
      const std::int32_t stop = std::min(slot + pair_window, last);
      const Index reached = stop < last ? in.list.owner(stop) : contact_block;
      // In a gas of particles hardly any touch, and only their velocities are needed.
      window.dense = 2 * window.count > window.rows;
      window.rows = reached - asked;
      prefetch_next_block(begin + asked, begin + reached, window.dense);
      prefetch_others(begin, stop, std::min(stop + pair_window, last), window.dense);
      asked = reached;
      gather_touching(begin, slot, stop, window, report);
      if (window.count == 0) continue;
      gather_motion(window);
      find_forces(window, report);
      add_forces(window, sums, elsewhere);
      if constexpr (remembers) put_back_springs(slot, stop, window);
    }
    if (in.any_fixed) {
      for (Index p = begin; p < end; ++p) {
        if (in.particles.velocity_spin(p).inverse_mass == 0)
          report.support_impulse += in.kick * out.load(p).force;
      }
    }
    out.report(block) = report;
  }

 private:
  using Sum = lanes::Real8;  // a ContactLoad
  static constexpr bool remembers = Laws::springs > 0;
  static constexpr int components = 3 * Laws::springs;
  static constexpr int no_row = contact_block;

  /// Asks for as many particles of the next block as this window has. Rows meet their partners in an order that the
  /// processor cannot foresee, and beds of more than some ten thousand particles do not fit into its cache.
  KOKKOS_FORCEINLINE_FUNCTION void prefetch_next_block(Index first, Index last, bool dense) const {
    const Index from = std::min(first + contact_block, in.particles.count);
    const Index to = std::min(last + contact_block, in.particles.count);
    prefetch(in.particles.position_radius.data(), from, to);
    if (dense) prefetch(in.particles.velocity_spin.data(), from, to);
    prefetch_to_write(out.load.data(), from, to);
  }

  /// Asks for those partners of the next window that are in other blocks.
  KOKKOS_FORCEINLINE_FUNCTION void prefetch_others(Index begin, std::int32_t slot, std::int32_t stop,
                                                   bool dense) const {
    std::int32_t other[pair_window + 8];
    int n = 0;
    // A rest of fewer than eight has to do without.
    for (; slot + 8 <= stop; slot += 8) {
      const auto j = lanes::load<lanes::Int8>(in.list.partner.data() + slot);
      const lanes::Mask8 outside = lanes::outside(j, begin, begin + contact_block - 1);
      lanes::pack(outside, j, other + n);
      n += lanes::count(outside);
    }
    for (int k = 0; k < n; ++k) {
      prefetch(in.particles.position_radius.data() + other[k]);
      if (dense) prefetch(in.particles.velocity_spin.data() + other[k]);
    }
  }

  /// Which of the entries touch, and where their partners are.
  void gather_touching(Index begin, std::int32_t slot, std::int32_t stop, Window& w,
                       BlockReport& report) const {
    const std::int32_t entries = stop - slot;
    const std::int32_t* const partner = in.list.partner.data() + slot;
    const std::uint16_t* const owner = in.list.owner.data() + slot;
    int n = 0;
    w.within = 0;
    std::int32_t s = 0;
    for (; s + 8 <= entries; s += 8) n = test_eight(begin, slot + s, 8, partner + s, owner + s, w, s / 8, n);
    if (s < entries) {
      // The entries beyond are the next block's, or none.
      std::int32_t some[8];
      std::uint16_t whose[8];
      for (std::int32_t k = 0; k < 8; ++k) {
        some[k] = partner[std::min(s + k, entries - 1)];
        whose[k] = owner[std::min(s + k, entries - 1)];
      }
      n = test_eight(begin, slot + s, entries - s, some, whose, w, s / 8, n);
    }
    report.touching += n + w.within;
    // Vectors are full: repeat the first pair.
    for (int k = n; n > 0 && k % 16 != 0; ++k) {
      w.dx[k] = w.dx[0];
      w.dy[k] = w.dy[0];
      w.dz[k] = w.dz[0];
      w.gap[k] = w.gap[0];
      w.ri[k] = w.ri[0];
      w.rj[k] = w.rj[0];
      w.i[k] = w.i[0];
      w.j[k] = w.j[0];
      w.sum_of_i[k] = w.sum_of_j[k] = no_row;
      if constexpr (remembers) {
        for (int e = 0; e < components; ++e) w.spring[e][k] = 0;
      }
    }
    w.sum_of_i[(n + 15) / 16 * 16] = no_row;
    w.count = n;
  }

  /// Appends those of `valid` <= 8 entries that touch to the n pairs found so far; returns how many there are then.
  int test_eight(Index begin, std::int32_t slot, std::int32_t valid, const std::int32_t* partner,
                 const std::uint16_t* owner, Window& w, int group, int n) const {
    using lanes::Real4;
    using lanes::Real8;
    const PositionRadius* const place = in.particles.position_radius.data();
    const auto own = [&](int k) { return lanes::load<Real4>(place + begin + owner[k]); };
    const auto other = [&](int k) { return lanes::load<Real4>(place + partner[k]); };
    Real8 a[4];
    Real8 b[4];
    for (int k = 0; k < 4; ++k) {
      a[k] = lanes::join(own(k), own(k + 4));
      b[k] = lanes::join(other(k), other(k + 4));
    }
    transpose_places(a);
    transpose_places(b);
    Real8 dx = b[0] - a[0];
    Real8 dy = b[1] - a[1];
    Real8 dz = b[2] - a[2];
    if constexpr (Repeats) {
      dx = shortest(dx, 0);
      dy = shortest(dy, 1);
      dz = shortest(dz, 2);
    }
    const Real8 distance_squared = dx * dx + dy * dy + dz * dz;
    const Real8 reach = a[3] + b[3];
    const Real8 reach_squared = reach * reach;
    const auto touches =
        static_cast<lanes::Mask8>(lanes::less(distance_squared, reach_squared) & (0xff >> (8 - valid)));
    if constexpr (remembers) gather_springs(slot, valid, touches, w, group, n);
    // In a gas of particles hardly any touch.
    if (touches == 0) return n;
    lanes::pack(touches, dx, w.dx + n);
    lanes::pack(touches, dy, w.dy + n);
    lanes::pack(touches, dz, w.dz + n);
    lanes::pack(touches, lanes::to_float(reach_squared - distance_squared), w.gap + n);
    lanes::pack(touches, lanes::to_float(a[3]), w.ri + n);
    lanes::pack(touches, lanes::to_float(b[3]), w.rj + n);
    const lanes::Int8 of_i = __builtin_convertvector(lanes::load<lanes::Short8>(owner), lanes::Int8);
    const auto j = lanes::load<lanes::Int8>(partner);
    // Outside the block, also below it, the unsigned difference is more than the last particle's.
    const auto local = reinterpret_cast<lanes::Unsigned8>(j - begin);
    constexpr auto last = static_cast<std::uint32_t>(no_row);
    const auto of_j = reinterpret_cast<lanes::Int8>(local < last ? local : lanes::Unsigned8{} + last);
    const int found = lanes::count(touches);
    w.within += found - lanes::count(touches & lanes::outside(j, begin, begin + contact_block - 1));
    lanes::pack(touches, of_i, w.sum_of_i + n);
    lanes::pack(touches, of_i + begin, w.i + n);
    lanes::pack(touches, j, w.j + n);
    lanes::pack(touches, of_j, w.sum_of_j + n);
    // For gather_motion.
    if (w.dense) {
      for (int k = 0; k < 8; ++k) prefetch(in.particles.velocity_spin.data() + partner[k]);
    } else {
      // Beyond those found there is particle 0.
      for (int k = n; k < n + 3; ++k) {
        prefetch(in.particles.velocity_spin.data() + w.i[k]);
        prefetch(in.particles.velocity_spin.data() + w.j[k]);
      }
    }
    return n + found;
  }

  /// x, y, z, r of eight particles from rows of two each, k and k + 4 in row k.
  static void transpose_places(lanes::Real8 (&r)[4]) {
    const lanes::Real8 xz01 = __builtin_shufflevector(r[0], r[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const lanes::Real8 yr01 = __builtin_shufflevector(r[0], r[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const lanes::Real8 xz23 = __builtin_shufflevector(r[2], r[3], 0, 8, 2, 10, 4, 12, 6, 14);
    const lanes::Real8 yr23 = __builtin_shufflevector(r[2], r[3], 1, 9, 3, 11, 5, 13, 7, 15);
    r[0] = __builtin_shufflevector(xz01, xz23, 0, 1, 8, 9, 4, 5, 12, 13);
    r[1] = __builtin_shufflevector(yr01, yr23, 0, 1, 8, 9, 4, 5, 12, 13);
    r[2] = __builtin_shufflevector(xz01, xz23, 2, 3, 10, 11, 6, 7, 14, 15);
    r[3] = __builtin_shufflevector(yr01, yr23, 2, 3, 10, 11, 6, 7, 14, 15);
  }

  /// As Domain::shortest, along one axis.
  lanes::Real8 shortest(lanes::Real8 d, int axis) const {
    if (in.domain.periodic[axis] == 0) return d;
    const Real length = in.domain.length()[axis];
    const lanes::Real8 none{};
    d -= d > 0.5 * length ? none + length : none;
    d += d < -0.5 * length ? none + length : none;
    return d;
  }

  /// Springs of the pairs that touched in the substep before, too; zero for those that did not.
  void gather_springs(std::int32_t slot, std::int32_t valid, lanes::Mask8 touches, Window& w, int group,
                      int n) const {
    bool* const held = out.springs.held.data() + slot;
    lanes::Mask8 goes_on = 0;
    if (valid == 8) {
      goes_on = lanes::load_flags(held);
      if (goes_on != touches) lanes::store_flags(touches, held);
    } else {
      for (std::int32_t k = 0; k < valid; ++k) {
        goes_on = static_cast<lanes::Mask8>(goes_on | (held[k] ? 1 : 0) << k);
        held[k] = ((touches >> k) & 1) != 0;
      }
    }
    w.touches[group] = touches;
    if (touches == 0) return;
    for (int e = 0; e < components; ++e) {
      // Of the next window: springs come from far away.
      prefetch_to_write(out.springs.component(e) + slot + pair_window);
      const auto spring = lanes::load<lanes::Real8>(out.springs.component(e) + slot);
      lanes::pack(touches, lanes::keep(goes_on, spring), w.spring[e] + n);
    }
  }

  void put_back_springs(std::int32_t slot, std::int32_t stop, const Window& w) const {
    int n = 0;
    for (std::int32_t s = slot; s < stop; s += 8) {
      const lanes::Mask8 touches = w.touches[(s - slot) / 8];
      if (touches == 0) continue;
      for (int e = 0; e < components; ++e) {
        lanes::unpack(touches, w.spring[e] + n, out.springs.component(e) + s);
      }
      n += lanes::count(touches);
    }
  }

  /// Relative velocities and spins of all pairs, formed in double precision.
  void gather_motion(Window& w) const {
    const VelocitySpin* const motion = in.particles.velocity_spin.data();
    // Material and id, which end the row, are no numbers.
    constexpr lanes::Bits8 numbers{-1, -1, -1, -1, -1, -1, -1, 0};
    for (int c = 0; c < w.count; c += 16) {
      lanes::Float16 row[16];
      for (int k = 0; k < 16; ++k) {
        const auto a =
            reinterpret_cast<lanes::Real8>(lanes::load<lanes::Bits8>(motion + w.i[c + k]) & numbers);
        const auto b =
            reinterpret_cast<lanes::Real8>(lanes::load<lanes::Bits8>(motion + w.j[c + k]) & numbers);
        row[k] = lanes::join(lanes::to_float(a - b), lanes::to_float(a + b));
      }
      lanes::transpose(row);
      lanes::store(row[0], w.dvx + c);
      lanes::store(row[1], w.dvy + c);
      lanes::store(row[2], w.dvz + c);
      lanes::store(row[3], w.difference_x + c);
      lanes::store(row[4], w.difference_y + c);
      lanes::store(row[5], w.difference_z + c);
      lanes::store(row[11], w.sum_x + c);
      lanes::store(row[12], w.sum_y + c);
      lanes::store(row[13], w.sum_z + c);
      lanes::store(row[14], w.inverse_mass_sum + c);
      if constexpr (Laws::needs_compliance) {
        lanes::store(row[6], w.inverse_mass_difference + c);
        for (int k = c; k < c + 16; ++k) {
          w.touching_i[k] = out.touching(w.i[k]);
          w.touching_j[k] = out.touching(w.j[k]);
        }
      }
      if constexpr (!OnePair) {
        for (int k = c; k < c + 16; ++k) {
          w.parameters[k] = motion[w.i[k]].material * in.materials + motion[w.j[k]].material;
        }
      }
    }
  }

  void find_forces(Window& w, BlockReport& report) const {
    const PairParameters* const table = in.table.data();
    const PairParametersOf<Number> only = convert<Number>(table[0]);
    const Laws law = laws;
    Number largest_overlap = 0;
    Number largest_depth = 0;
    Number largest_approach = std::numeric_limits<Number>::lowest();
    const int n = (w.count + 15) / 16 * 16;
#pragma omp simd reduction(max : largest_overlap, largest_depth, largest_approach)
    for (int c = 0; c < n; ++c) {
      const auto number = [](auto x) { return static_cast<Number>(x); };
      PairState<Number> pair{
          {number(w.dx[c]), number(w.dy[c]), number(w.dz[c])},
          number(w.gap[c]),
          number(w.ri[c]),
          number(w.rj[c]),
          {number(w.dvx[c]), number(w.dvy[c]), number(w.dvz[c])},
          {number(w.sum_x[c]), number(w.sum_y[c]), number(w.sum_z[c])},
          {number(w.difference_x[c]), number(w.difference_y[c]), number(w.difference_z[c])},
          number(w.inverse_mass_sum[c])};
      if constexpr (Laws::needs_compliance) {
        // Exact where one of them is zero.
        const Number mass_i = Number(0.5) * number(w.inverse_mass_sum[c] + w.inverse_mass_difference[c]);
        const Number mass_j = Number(0.5) * number(w.inverse_mass_sum[c] - w.inverse_mass_difference[c]);
        pair.spin_compliance = spin_compliance_of(w.touching_i[c], mass_i, pair.ri) +
                               spin_compliance_of(w.touching_j[c], mass_j, pair.rj);
      }
      ContactSprings springs;
      constexpr int t = 3 * Laws::tangential_spring;
      constexpr int r = 3 * Laws::rolling_spring;
      if constexpr (t >= 0) springs.tangential = {w.spring[t][c], w.spring[t + 1][c], w.spring[t + 2][c]};
      if constexpr (r >= 0) springs.rolling = {w.spring[r][c], w.spring[r + 1][c], w.spring[r + 2][c]};
      // Not one expression: a copy of `only` would keep the loop out of vector registers.
      PairParametersOf<Number> own;
      if constexpr (!OnePair) own = convert<Number>(table[w.parameters[c]]);
      const PairForce<Number> f = find_pair_force(law, OnePair ? only : own, pair, springs);
      if constexpr (t >= 0) {
        w.spring[t][c] = springs.tangential.x;
        w.spring[t + 1][c] = springs.tangential.y;
        w.spring[t + 2][c] = springs.tangential.z;
      }
      if constexpr (r >= 0) {
        w.spring[r][c] = springs.rolling.x;
        w.spring[r + 1][c] = springs.rolling.y;
        w.spring[r + 2][c] = springs.rolling.z;
      }
      w.pull[c] = static_cast<float>(f.pull);
      w.friction_x[c] = static_cast<float>(f.friction.x);
      w.friction_y[c] = static_cast<float>(f.friction.y);
      w.friction_z[c] = static_cast<float>(f.friction.z);
      w.skew[c] = static_cast<float>(f.skew);
      if constexpr (Laws::rolls) {
        w.rolling_x[c] = static_cast<float>(f.rolling_torque.x);
        w.rolling_y[c] = static_cast<float>(f.rolling_torque.y);
        w.rolling_z[c] = static_cast<float>(f.rolling_torque.z);
      }
      const Number smaller = pair.ri < pair.rj ? pair.ri : pair.rj;
      const Number relative = f.overlap / smaller;
      largest_overlap = relative > largest_overlap ? relative : largest_overlap;
      largest_depth = f.overlap > largest_depth ? f.overlap : largest_depth;
      largest_approach = f.approach_speed > largest_approach ? f.approach_speed : largest_approach;
    }
    report.largest_overlap = std::max(report.largest_overlap, static_cast<Real>(largest_overlap));
    report.largest_depth = std::max(report.largest_depth, static_cast<Real>(largest_depth));
    report.largest_approach_speed =
        std::max(report.largest_approach_speed, static_cast<Real>(largest_approach));
  }

  /// Adds forces and torques to both particles of every pair, pairs in list order. Pairs of a row come one after the other:
  /// their sum stays in a register and is added to what earlier rows gave to the particle at the last of them; at the others
  /// it goes elsewhere, so that nothing branches and no pair waits for what the one before has written.
  void add_forces(const Window& w, Sum* sums, Sum* elsewhere) const {
    using lanes::Bits8;
    using lanes::Int8;
    using lanes::Real8;
    const auto places = [](const Sum* first) {
      return Bits8{} + static_cast<std::int64_t>(reinterpret_cast<std::intptr_t>(first));
    };
    constexpr std::int64_t size = sizeof(Sum);
    constexpr Bits8 one_each{0, size, 2 * size, 3 * size, 4 * size, 5 * size, 6 * size, 7 * size};
    const Bits8 first = places(sums);
    const Bits8 else_i = places(elsewhere) + one_each;
    const Bits8 else_j = places(elsewhere + 8) + one_each;
    Int8 before = Int8{} - 1;
    Real8 row{};
    for (int c = 0; c < w.count; c += 8) {
      const auto real = [&](const float* from) {
        return lanes::to_real(lanes::load<lanes::Float8>(from + c));
      };
      const auto dx = lanes::load<Real8>(w.dx + c);
      const auto dy = lanes::load<Real8>(w.dy + c);
      const auto dz = lanes::load<Real8>(w.dz + c);
      const Real8 fx = real(w.friction_x);
      const Real8 fy = real(w.friction_y);
      const Real8 fz = real(w.friction_z);
      const Real8 pull = real(w.pull);
      const Real8 skew = real(w.skew);
      const Real8 half_x = 0.5 * (dy * fz - dz * fy);
      const Real8 half_y = 0.5 * (dz * fx - dx * fz);
      const Real8 half_z = 0.5 * (dx * fy - dy * fx);
      Real8 rest_x = skew * half_x;
      Real8 rest_y = skew * half_y;
      Real8 rest_z = skew * half_z;
      if constexpr (Laws::rolls) {
        rest_x += real(w.rolling_x);
        rest_y += real(w.rolling_y);
        rest_z += real(w.rolling_z);
      }
      const Real8 one = Real8{} + 1.0;
      Real8 i[8] = {fx - pull * dx,
                    fy - pull * dy,
                    fz - pull * dz,
                    half_x + rest_x,
                    half_y + rest_y,
                    half_z + rest_z,
                    one,
                    Real8{}};
      Real8 j[8] = {-i[0], -i[1], -i[2], half_x - rest_x, half_y - rest_y, half_z - rest_z, one, Real8{}};
      lanes::transpose(i);
      lanes::transpose(j);
      const auto of_i = lanes::load<Int8>(w.sum_of_i + c);
      const auto of_j = lanes::load<Int8>(w.sum_of_j + c);
      const auto wide = [](const Int8& v) { return __builtin_convertvector(v, Bits8); };
      const Bits8 at_i = wide(of_i) < no_row ? first + size * wide(of_i) : else_i;
      const Bits8 at_j = wide(of_j) < no_row ? first + size * wide(of_j) : else_j;
      alignas(64) std::int64_t goes_on[8];  // all bits set: the same row as the pair before
      alignas(64) Sum* to[8];
      alignas(64) Sum* other[8];
      lanes::store(wide(of_i == __builtin_shufflevector(before, of_i, 7, 8, 9, 10, 11, 12, 13, 14)), goes_on);
      lanes::store(wide(of_i) != wide(lanes::load<Int8>(w.sum_of_i + c + 1)) ? at_i : else_i, to);
      lanes::store(at_j, other);
      before = of_i;
      for (int k = 0; k < 8; ++k) {
        row = reinterpret_cast<Real8>(reinterpret_cast<Bits8>(row) & goes_on[k]) + i[k];
        *to[k] += row;
        *other[k] += j[k];
      }
    }
  }
};

}  // namespace pellicle::dem
