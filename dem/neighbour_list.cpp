#include "dem/neighbour_list.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/error.hpp"
#include "dem/engine_arrays.hpp"
#include "dem/memory_order.hpp"
#include "dem/row_search.hpp"

namespace pellicle::dem {
namespace {

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

void gather_sorted(const Particles& particles, const DeviceArray<std::int32_t>& order,
                   const DeviceArray<Displacement>& displacement, Real beyond, const SortedPlaces& sorted) {
  const auto place = particles.position_radius;
  Kokkos::parallel_for(
      "dem::neighbour_list::gather_sorted", DeviceRange(0, particles.count), KOKKOS_LAMBDA(const Index slot) {
        const Index p = order(slot);
        const PositionRadius at = place(p);
        sorted.x()[slot] = at.x;
        sorted.y()[slot] = at.y;
        sorted.z()[slot] = at.z;
        sorted.reach()[slot] = reach_of(at, displacement(p), beyond);
      });
}

/// Searches the rows of some blocks; returns the room that the fullest block needs.
template <bool Repeats>
std::int32_t search_rows(const char* label, const RowSearch& search, Index blocks) {
#ifndef KOKKOS_ENABLE_CUDA
  using Kernel = FindRowsInLanes<Repeats>;
#else
  using Kernel = FindRows<Repeats>;
#endif
  std::int32_t largest = 0;
  // Dense and dilute blocks cost differently: threads take them as they come.
  Kokkos::parallel_reduce(
      label, Kokkos::RangePolicy<Device, Kokkos::Schedule<Kokkos::Dynamic>>(0, blocks, Kokkos::ChunkSize(1)),
      Kernel{search}, Kokkos::Max<std::int32_t>(largest));
  return largest;
}

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
          if (list.half) {
            const auto own = static_cast<std::uint16_t>(p % list_block);
            for (std::int32_t e = 0; e < length; ++e) list.owner(start + n + e) = own;
          }
          n += length;
        }
        if (end == list.count) list.offset(end) = start + n;
        const std::int32_t* const from =
            staging.data() + static_cast<std::size_t>(b) * static_cast<std::size_t>(capacity);
        std::int32_t* const to = list.partner.data() + start;
        for (std::int32_t i = 0; i < n; ++i) to[i] = from[i];
      });
}

/// Room for `size` entries, of which `used` are kept.
template <class T>
void grow_list(DeviceArray<T>& list, const char* label, std::size_t used, std::size_t size) {
  if (list.extent(0) >= size) return;
  DeviceArray<T> grown(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)),
                       size + size / 16 + 64);
  if (used > 0) {
    const std::pair<std::size_t, std::size_t> kept(0, used);
    Kokkos::deep_copy(Kokkos::subview(grown, kept), Kokkos::subview(list, kept));
  }
  list = grown;
}

}  // namespace

NeighbourSearch::NeighbourSearch(const Domain& domain, const SkinOptions& skin, Real smallest_radius,
                                 Real largest_radius)
    : skin_(skin), smallest_radius_(smallest_radius), largest_radius_(largest_radius) {
  grid_.domain = domain;
  grid_.beyond = skin_.reach;
  require_room(largest_radius_);
  set_levels(grid_, smallest_radius_, largest_radius_);
}

void NeighbourSearch::require_room(Real largest_radius) const {
  const Domain& domain = grid_.domain;
  const Real reach = 2 * (largest_radius + largest_radius_ * skin_.largest_fraction + skin_.reach);
  for (int axis = 0; axis < 3; ++axis) {
    if (domain.periodic[axis] != 0 && domain.length()[axis] < 2 * reach) {
      throw std::invalid_argument("a periodic domain must be at least " + std::to_string(2 * reach) +
                                  " m wide for these particles, so that none meets two images of another");
    }
  }
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
  // The search reads whole registers, beyond the last particle too.
  ensure_size(order_, sorted_stride(n), "dem::neighbour_list::order");
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
  gather_sorted(particles, order_, list.displacement, grid_.beyond,
                {scratch, sorted_stride(static_cast<std::size_t>(particles.count))});
  find_rows(particles, list, scratch);
}

void NeighbourSearch::find_rows(const Particles& particles, NeighbourList& list,
                                const DeviceArray<Real>& scratch) {
  const SortedPlaces sorted{scratch, sorted_stride(static_cast<std::size_t>(particles.count))};
  const Index blocks = (particles.count + row_block - 1) / row_block;
  const Index round = std::min(blocks, blocks_per_round(blocks));
  ensure_size(block_start_, static_cast<std::size_t>(round), "dem::neighbour_list::block_start");
  block_capacity_ = std::max(block_capacity_, 12 * row_block + 16);
  if (blocks == 0) Kokkos::deep_copy(Kokkos::subview(list.offset, std::pair<Index, Index>(0, 1)), 0);
  std::int64_t total = 0;
  for (Index first = 0; first < blocks; first += round) {
    const Index present = std::min(round, blocks - first);
    const DeviceRange range(0, present);
    for (;;) {
      ensure_size(staging_, static_cast<std::size_t>(round) * static_cast<std::size_t>(block_capacity_),
                  "dem::neighbour_list::staging");
      std::int32_t largest = 0;
      const RowSearch search{grid_, cell_start_, order_,   sorted,       particles,
                             list,  first,       staging_, block_start_, block_capacity_};
      if (grid_.domain.repeats()) {
        largest = search_rows<true>("dem::neighbour_list::find_rows_periodic", search, present);
      } else {
        largest = search_rows<false>("dem::neighbour_list::find_rows", search, present);
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
      grow_list(list.partner, "dem::neighbour_list::partner", static_cast<std::size_t>(before), expected);
    }
    if (list.half && list.owner.extent(0) < static_cast<std::size_t>(total)) {
      grow_list(list.owner, "dem::neighbour_list::owner", static_cast<std::size_t>(before), expected);
    }
    place_rows(list, first, present, static_cast<std::int32_t>(before), staging_, block_start_,
               block_capacity_);
  }
  list.entries = total;
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
