#include "dem/neighbour_list.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/error.hpp"
#include "dem/engine_arrays.hpp"
#include "dem/memory_order.hpp"

namespace pellicle::dem {
namespace {

/// Particles whose rows are searched by one work item and stored side by side.
constexpr Index row_block = std::is_same_v<Device, Host> ? 64 : 1;

/// Blocks whose rows are searched before they are moved to their place. The rows of a round stay in the cache and the
/// memory they need is small beside the lists; on a GPU a round has to keep all of it busy.
Index blocks_per_round(Index blocks) {
  if constexpr (!std::is_same_v<Device, Host>) return 1 << 17;
  const Index busy = 8 * static_cast<Index>(Device().concurrency());
  return std::max(busy, std::min<Index>(256, blocks / 16 + 1));
}

void set_allowances(const Particles& particles, Real reach_time, Real smallest, Real largest,
                    const DeviceArray<Displacement>& displacement) {
  const auto motion = particles.velocity_spin;
  Kokkos::parallel_for(
      "dem::neighbour_list::set_allowances", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index p) {
        const VelocitySpin m = motion(p);
        const Real travel = reach_time * Kokkos::sqrt(m.vx * m.vx + m.vy * m.vy + m.vz * m.vz);
        const Real least = travel > smallest ? travel : smallest;
        displacement(p) = {0, 0, 0, static_cast<float>(least < largest ? least : largest)};
      });
}

/// x, y, z and reach in sorted order, one array after the other.
struct SortedPlaces {
  DeviceArray<Real> memory;
  std::size_t stride;
  KOKKOS_INLINE_FUNCTION Real* x() const { return memory.data(); }
  KOKKOS_INLINE_FUNCTION Real* y() const { return memory.data() + stride; }
  KOKKOS_INLINE_FUNCTION Real* z() const { return memory.data() + 2 * stride; }
  KOKKOS_INLINE_FUNCTION Real* reach() const { return memory.data() + 3 * stride; }
};

void gather_sorted(const Particles& particles, const DeviceArray<std::int32_t>& order,
                   const DeviceArray<Displacement>& displacement, const SortedPlaces& sorted) {
  const auto place = particles.position_radius;
  Kokkos::parallel_for(
      "dem::neighbour_list::gather_sorted", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index slot) {
        const Index p = order(slot);
        const PositionRadius at = place(p);
        sorted.x()[slot] = at.x;
        sorted.y()[slot] = at.y;
        sorted.z()[slot] = at.z;
        sorted.reach()[slot] = reach_of(at, displacement(p));
      });
}

/// Rows of the particles of one block, one after the other, into the block's part of the staging memory.
template <bool Repeats>
struct FindRows {
  CellGrid grid;
  DeviceArray<std::int32_t> cell_start, order;
  SortedPlaces sorted;
  Particles particles;
  NeighbourList list;
  Index first_block;
  DeviceArray<std::int32_t> staging, block_start;
  std::int32_t capacity;  // entries that a block has room for

  /// `largest` is the room that the fullest block needs.
  KOKKOS_INLINE_FUNCTION void operator()(const Index b, std::int32_t& largest) const {
    std::int32_t* const out = staging.data() + static_cast<std::size_t>(b) * capacity;
    const std::int32_t* const particle = order.data();
    std::int32_t n = 0;
    const Index begin = (first_block + b) * row_block;
    const Index end = Kokkos::min(begin + row_block, particles.count);
    for (Index p = begin; p < end; ++p) {
      PositionRadius self = particles.position_radius(p);
      self.radius = reach_of(self, list.displacement(p));
      const std::int32_t row = n;
      // Partners from `first` to p have p in their rows.
      const Index first = list.half ? p / list_block * list_block : p;
      visit_runs(grid, cell_start, self, [&](std::int32_t from, std::int32_t to) {
        for (std::int32_t start = from; start < to; start += part) {
          const std::int32_t m = to - start < part ? to - start : part;
          bool hit[part];
          test(self, start, m, hit);
          largest = Kokkos::max(largest, n + m);
          if (n + m <= capacity) {
            // Without a branch: whether a candidate is in reach cannot be predicted.
            for (std::int32_t i = 0; i < m; ++i) {
              const std::int32_t q = particle[start + i];
              out[n] = q;
              n += static_cast<std::int32_t>(hit[i]) & static_cast<std::int32_t>((q > p) | (q < first));
            }
          } else {
            for (std::int32_t i = 0; i < m; ++i) {
              const std::int32_t q = particle[start + i];
              n += hit[i] && (q > p || q < first) ? 1 : 0;
            }
          }
        }
      });
      if (list.half && n <= capacity && particles.velocity_spin(p).inverse_mass == 0) {
        n = drop_fixed(out, row, n);
      }
      list.offset(p) = n - row;
    }
    block_start(b) = n;
  }

 private:
  static constexpr std::int32_t part = 64;

  /// Takes the fixed partners out of a row; returns where it ends then.
  KOKKOS_INLINE_FUNCTION std::int32_t drop_fixed(std::int32_t* out, std::int32_t row,
                                                 std::int32_t end) const {
    std::int32_t kept = row;
    for (std::int32_t e = row; e < end; ++e) {
      const std::int32_t q = out[e];
      if (particles.velocity_spin(q).inverse_mass != 0) out[kept++] = q;
    }
    return kept;
  }

  /// Which of the slots start … start + m may touch before the next build. Works on whole vectors: entries from m on
  /// come from beyond and mean nothing.
  KOKKOS_INLINE_FUNCTION void test(const PositionRadius& self, std::int32_t start, std::int32_t m,
                                   bool* hit) const {
    constexpr std::int32_t width = std::is_same_v<Device, Host> ? 8 : 1;
    const Real* const x = sorted.x() + start;
    const Real* const y = sorted.y() + start;
    const Real* const z = sorted.z() + start;
    const Real* const reach = sorted.reach() + start;
    for (std::int32_t v = 0; v < m; v += width) {
      for (std::int32_t i = v; i < v + width; ++i) {
        Vec3 d{x[i] - self.x, y[i] - self.y, z[i] - self.z};
        if constexpr (Repeats) d = grid.domain.shortest(d);
        const Real r = self.radius + reach[i];
        hit[i] = norm_squared(d) < r * r;
      }
    }
  }
};

/// Block totals become the places where blocks begin; the last entry, and the return value, is their sum.
std::int64_t scan_blocks(const DeviceArray<std::int32_t>& block_start, Index blocks) {
  std::int64_t total = 0;
  Kokkos::parallel_scan(
      "dem::neighbour_list::scan_blocks", DeviceRange(0, blocks),
      KOKKOS_LAMBDA(const Index b, std::int64_t& sum, const bool final) {
        const std::int32_t count = block_start(b);
        if (final) block_start(b) = static_cast<std::int32_t>(sum);
        sum += count;
      },
      total);
  return total;
}

/// Moves the rows of a round to their place in the list; `base` is where the round begins.
void place_rows(const NeighbourList& list, Index first_block, Index blocks, std::int32_t base,
                const DeviceArray<std::int32_t>& staging, const DeviceArray<std::int32_t>& block_start,
                std::int32_t capacity) {
  Kokkos::parallel_for(
      "dem::neighbour_list::place_rows", DeviceRange(0, blocks), KOKKOS_LAMBDA(const Index b) {
        const std::int32_t start = base + block_start(b);
        const Index begin = (first_block + b) * row_block;
        const Index end = Kokkos::min(begin + row_block, list.count);
        std::int32_t n = 0;
        for (Index p = begin; p < end; ++p) {
          const std::int32_t length = list.offset(p);
          list.offset(p) = start + n;
          n += length;
        }
        if (end == list.count) list.offset(end) = start + n;
        const std::int32_t* const from = staging.data() + static_cast<std::size_t>(b) * capacity;
        std::int32_t* const to = list.partner.data() + start;
        for (std::int32_t i = 0; i < n; ++i) to[i] = from[i];
      });
}

/// Room for `size` entries, of which `used` are kept.
void grow_list(DeviceArray<std::int32_t>& partner, std::size_t used, std::size_t size) {
  if (partner.extent(0) >= size) return;
  DeviceArray<std::int32_t> grown(
      Kokkos::view_alloc(Kokkos::WithoutInitializing, "dem::neighbour_list::partner"), size + size / 16 + 64);
  if (used > 0) {
    const std::pair<std::size_t, std::size_t> kept(0, used);
    Kokkos::deep_copy(Kokkos::subview(grown, kept), Kokkos::subview(partner, kept));
  }
  partner = grown;
}

}  // namespace

NeighbourSearch::NeighbourSearch(const Domain& domain, const SkinOptions& skin, Real smallest_radius,
                                 Real largest_radius)
    : skin_(skin), smallest_radius_(smallest_radius), largest_radius_(largest_radius) {
  grid_.domain = domain;
  const Real reach = 2 * largest_radius_ * (1 + skin_.largest_fraction);
  for (int axis = 0; axis < 3; ++axis) {
    if (domain.periodic[axis] != 0 && domain.length()[axis] < 2 * reach) {
      throw std::invalid_argument("a periodic domain must be at least " + std::to_string(2 * reach) +
                                  " m wide for these particles, so that none meets two images of another");
    }
  }
  set_levels(grid_, smallest_radius_, largest_radius_);
}

void NeighbourSearch::find_order(const Particles& particles, Real time_step, NeighbourList& list) {
  const auto n = static_cast<std::size_t>(particles.count);
  wrap_periodic(grid_.domain, particles);
  ensure_size(list.displacement, n, "dem::neighbour_list::displacement");
  set_allowances(particles, skin_.steps * time_step, skin_.smallest_fraction * smallest_radius_,
                 skin_.largest_fraction * largest_radius_, list.displacement);
  measure_levels(grid_, particles, list.displacement);
  set_cells(grid_);
  // As many as there may ever be: their number changes from build to build.
  const Index cells = most_cells(particles.count) + (grid_.levels - 1) * most_cells(0);
  ensure_size(cell_start_, static_cast<std::size_t>(cells) + 1, "dem::neighbour_list::cell_start");
  ensure_size(order_, n, "dem::neighbour_list::order");
  sort_into_cells(grid_, particles, cell_start_, order_);
}

void NeighbourSearch::find_memory_order(const DeviceArray<std::int32_t>& memory_order) {
  dem::find_memory_order(grid_, cell_start_, order_, cube_start_, memory_order);
}

void NeighbourSearch::build(const Particles& particles, Real time_step, NeighbourList& list,
                            const DeviceArray<Real>& scratch) {
  find_order(particles, time_step, list);
  list.count = particles.count;
  ensure_size(list.offset, static_cast<std::size_t>(particles.count) + 1, "dem::neighbour_list::offset");
  gather_sorted(particles, order_, list.displacement,
                {scratch, sorted_stride(static_cast<std::size_t>(particles.count))});
  find_rows(particles, list, scratch);
}

void NeighbourSearch::find_rows(const Particles& particles, NeighbourList& list,
                                const DeviceArray<Real>& scratch) {
  const SortedPlaces sorted{scratch, sorted_stride(static_cast<std::size_t>(particles.count))};
  const Index blocks = (particles.count + row_block - 1) / row_block;
  const Index round = std::min(blocks, blocks_per_round(blocks));
  ensure_size(block_start_, static_cast<std::size_t>(round), "dem::neighbour_list::block_start");
  block_capacity_ = std::max(block_capacity_, 12 * row_block + 64);
  if (blocks == 0) Kokkos::deep_copy(Kokkos::subview(list.offset, std::pair<Index, Index>(0, 1)), 0);
  std::int64_t total = 0;
  for (Index first = 0; first < blocks; first += round) {
    const Index present = std::min(round, blocks - first);
    const DeviceRange range(0, present);
    for (;;) {
      ensure_size(staging_, static_cast<std::size_t>(round) * static_cast<std::size_t>(block_capacity_),
                  "dem::neighbour_list::staging");
      std::int32_t largest = 0;
      // Dense and dilute blocks cost differently: threads take them as they come.
      const Kokkos::RangePolicy<Device, Kokkos::Schedule<Kokkos::Dynamic>> dynamic(0, present,
                                                                                   Kokkos::ChunkSize(1));
      if (grid_.domain.repeats()) {
        Kokkos::parallel_reduce("dem::neighbour_list::find_rows_periodic", dynamic,
                                FindRows<true>{grid_, cell_start_, order_, sorted, particles, list, first,
                                               staging_, block_start_, block_capacity_},
                                Kokkos::Max<std::int32_t>(largest));
      } else {
        Kokkos::parallel_reduce("dem::neighbour_list::find_rows", dynamic,
                                FindRows<false>{grid_, cell_start_, order_, sorted, particles, list, first,
                                                staging_, block_start_, block_capacity_},
                                Kokkos::Max<std::int32_t>(largest));
      }
      if (largest <= block_capacity_) break;
      block_capacity_ = largest + largest / 4;
    }
    const std::int64_t before = total;
    total += scan_blocks(block_start_, present);
    if (total > std::numeric_limits<std::int32_t>::max() / 2) {
      throw RunError(
          "the neighbour lists have more than a thousand million entries; too many particles, or sizes "
          "that differ too much");
    }
    // What the whole will need, as far as can be told by now.
    const Real share = static_cast<Real>(first + present) / blocks;
    const auto expected = static_cast<std::size_t>(static_cast<Real>(total) / share);
    if (list.partner.extent(0) < static_cast<std::size_t>(total)) {
      grow_list(list.partner, static_cast<std::size_t>(before), expected);
    }
    place_rows(list, first, present, static_cast<std::int32_t>(before), staging_, block_start_,
               block_capacity_);
  }
}

std::size_t NeighbourSearch::bytes() const {
  return bytes_of(cell_start_) + bytes_of(order_) + bytes_of(staging_) + bytes_of(block_start_) +
         bytes_of(cube_start_);
}

void wrap_periodic(const Domain& domain, const Particles& particles) {
  if (!domain.repeats()) return;
  const auto place = particles.position_radius;
  Kokkos::parallel_for(
      "dem::neighbour_list::wrap_periodic", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index p) {
        Vec3 x = place(p).position();
        const Vec3 length = domain.length();
        for (int axis = 0; axis < 3; ++axis) {
          if (domain.periodic[axis] == 0) continue;
          if (x[axis] < domain.box.min[axis]) x[axis] += length[axis];
          if (x[axis] >= domain.box.max[axis]) x[axis] -= length[axis];
        }
        place(p).x = x.x;
        place(p).y = x.y;
        place(p).z = x.z;
      });
}

}  // namespace pellicle::dem
