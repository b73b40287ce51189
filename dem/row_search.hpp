// The search of one block's rows of the neighbour list, on host and device.
#pragma once

#include "dem/neighbour_list.hpp"

#ifndef KOKKOS_ENABLE_CUDA
#include "dem/lanes.hpp"
#endif

namespace pellicle::dem {

/// Particles whose rows are searched by one work item and stored side by side.
inline constexpr Index row_block = std::is_same_v<Device, Host> ? 64 : 1;

/// x, y, z and reach in sorted order, one array after the other.
struct SortedPlaces {
  DeviceArray<Real> memory;
  std::size_t stride;
  KOKKOS_INLINE_FUNCTION Real* x() const { return memory.data(); }
  KOKKOS_INLINE_FUNCTION Real* y() const { return memory.data() + stride; }
  KOKKOS_INLINE_FUNCTION Real* z() const { return memory.data() + 2 * stride; }
  KOKKOS_INLINE_FUNCTION Real* reach() const { return memory.data() + 3 * stride; }
};

/// What the search of rows reads, and where it puts them.
struct RowSearch {
  CellGrid grid;
  DeviceArray<std::int32_t> cell_start, order;
  SortedPlaces sorted;
  Particles particles;
  NeighbourList list;
  Index first_block;
  DeviceArray<std::int32_t> staging, block_start;
  std::int32_t capacity;  ///< entries that a block has room for

  /// The first particle whose row has no pairs with later particles of the block that p is in: partners from here to p
  /// have p in their rows.
  KOKKOS_INLINE_FUNCTION Index first_with(Index p) const {
    return list.half ? p / list_block * list_block : p;
  }

  /// Takes the fixed partners out of the row of a fixed particle, which half lists do not have; returns where it ends
  /// then.
  KOKKOS_INLINE_FUNCTION std::int32_t drop_fixed(Index p, std::int32_t* out, std::int32_t row,
                                                 std::int32_t end) const {
    if (!list.half || end > capacity || particles.velocity_spin(p).inverse_mass != 0) return end;
    std::int32_t kept = row;
    for (std::int32_t e = row; e < end; ++e) {
      const std::int32_t q = out[e];
      if (particles.velocity_spin(q).inverse_mass != 0) out[kept++] = q;
    }
    return kept;
  }
};

/// Rows of the particles of one block, one after the other, into the block's part of the staging memory.
template <bool Repeats>
struct FindRows {
  RowSearch in;

  /// `largest` is the room that the fullest block needs.
  KOKKOS_INLINE_FUNCTION void operator()(const Index b, std::int32_t& largest) const {
    std::int32_t* const out =
        in.staging.data() + static_cast<std::size_t>(b) * static_cast<std::size_t>(in.capacity);
    std::int32_t n = 0;
    const Index begin = (in.first_block + b) * row_block;
    const Index end = Kokkos::min(begin + row_block, in.particles.count);
    for (Index p = begin; p < end; ++p) {
      PositionRadius self = in.particles.position_radius(p);
      self.radius = reach_of(self, in.list.displacement(p), in.grid.beyond);
      const std::int32_t row = n;
      const Index first = in.first_with(p);
      visit_runs<Repeats>(in.grid, in.cell_start, self, [&](std::int32_t from, std::int32_t to) {
        for (std::int32_t slot = from; slot < to; ++slot) {
          const std::int32_t q = in.order(slot);
          if (!in_reach(self, slot) || (q <= p && q >= first)) continue;
          if (n < in.capacity) out[n] = q;
          ++n;
        }
      });
      n = in.drop_fixed(p, out, row, n);
      in.list.offset(p) = n - row;
    }
    in.block_start(b) = n;
    largest = Kokkos::max(largest, n);
  }

 private:
  KOKKOS_INLINE_FUNCTION bool in_reach(const PositionRadius& self, std::int32_t slot) const {
    Vec3 d{in.sorted.x()[slot] - self.x, in.sorted.y()[slot] - self.y, in.sorted.z()[slot] - self.z};
    if constexpr (Repeats) d = in.grid.domain.shortest(d);
    const Real r = self.radius + in.sorted.reach()[slot];
    return norm_squared(d) < r * r;
  }
};

#ifndef KOKKOS_ENABLE_CUDA

/// The same on a CPU, eight candidates at a time.
template <bool Repeats>
struct FindRowsInLanes {
  RowSearch in;

  void operator()(const Index b, std::int32_t& largest) const {
    using lanes::Int8;
    using lanes::Mask8;
    using lanes::Real8;
    constexpr std::int32_t width = 8;
    std::int32_t* const out =
        in.staging.data() + static_cast<std::size_t>(b) * static_cast<std::size_t>(in.capacity);
    // Entries that there is no room for go to the end, over each other, so that they are counted.
    const std::int32_t last = in.capacity - width;
    const std::int32_t* const order = in.order.data();
    const Real* const x = in.sorted.x();
    const Real* const y = in.sorted.y();
    const Real* const z = in.sorted.z();
    const Real* const reach = in.sorted.reach();
    std::int32_t n = 0;
    const Index begin = (in.first_block + b) * row_block;
    const Index end = Kokkos::min(begin + row_block, in.particles.count);
    for (Index p = begin; p < end; ++p) {
      PositionRadius self = in.particles.position_radius(p);
      self.radius = reach_of(self, in.list.displacement(p), in.grid.beyond);
      const std::int32_t row = n;
      const Index first = in.first_with(p);
      visit_runs<Repeats>(in.grid, in.cell_start, self, [&](std::int32_t from, std::int32_t to) {
        // What is read beyond the end of a run, or of the arrays, is masked out.
        for (std::int32_t slot = from; slot < to; slot += width) {
          Real8 dx = lanes::load<Real8>(x + slot) - self.x;
          Real8 dy = lanes::load<Real8>(y + slot) - self.y;
          Real8 dz = lanes::load<Real8>(z + slot) - self.z;
          if constexpr (Repeats) {
            dx = shortest(0, dx);
            dy = shortest(1, dy);
            dz = shortest(2, dz);
          }
          const Real8 r = lanes::load<Real8>(reach + slot) + self.radius;
          const Int8 q = lanes::load<Int8>(order + slot);
          const auto present = static_cast<Mask8>(to - slot >= width ? 0xff : (1 << (to - slot)) - 1);
          const Mask8 taken =
              lanes::less(dx * dx + dy * dy + dz * dz, r * r) & lanes::outside(q, first, p) & present;
          lanes::pack(taken, q, out + (n < last ? n : last));
          n += lanes::count(taken);
        }
      });
      largest = Kokkos::max(largest, n + width);
      n = in.drop_fixed(p, out, row, n);
      in.list.offset(p) = n - row;
    }
    in.block_start(b) = n;
  }

 private:
  lanes::Real8 shortest(int axis, lanes::Real8 d) const {
    if (in.grid.domain.periodic[axis] == 0) return d;
    const Real length = in.grid.domain.length()[axis];
    const lanes::Real8 zero{};
    d = d > 0.5 * length ? d - length : d;
    return d < zero - 0.5 * length ? d + length : d;
  }
};

#endif

}  // namespace pellicle::dem
