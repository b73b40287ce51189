#include "spray/hits.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace pellicle::spray {
namespace {

/// Hits of a run that is sorted by insertion.
constexpr Index first_run = 32;

struct SortRun {
  DeviceArray<Hit> hits;
  Index count;
  KOKKOS_INLINE_FUNCTION void operator()(const Index run) const {
    const Index begin = run * first_run;
    const Index end = Kokkos::min(begin + first_run, count);
    for (Index i = begin + 1; i < end; ++i) {
      const Hit moved = hits(i);
      Index place = i;
      for (; place > begin && moved.before(hits(place - 1)); --place) hits(place) = hits(place - 1);
      hits(place) = moved;
    }
  }
};

/// Every hit of two neighbouring runs goes to its place in their union: its own place plus how many of the other run are
/// before it.
struct MergeRuns {
  DeviceArray<Hit> from, to;
  Index count, length;
  KOKKOS_INLINE_FUNCTION void operator()(const Index i) const {
    const Hit hit = from(i);
    const Index pair = i / (2 * length) * (2 * length);
    const Index middle = Kokkos::min(pair + length, count);
    const Index end = Kokkos::min(pair + 2 * length, count);
    const bool in_first = i < middle;
    Index low = in_first ? middle : pair;
    Index high = in_first ? end : middle;
    const Index other = low;
    while (low < high) {
      const Index half = (low + high) / 2;
      if (from(half).before(hit)) {
        low = half + 1;
      } else {
        high = half;
      }
    }
    to(pair + (i - (in_first ? pair : middle)) + (low - other)) = hit;
  }
};

struct AddHits {
  DeviceArray<Hit> hits;
  Index count;
  HitTargets targets;

  /// The first hit of each particle takes all of them, in order.
  KOKKOS_INLINE_FUNCTION void operator()(const Index i) const {
    const Hit first = hits(i);
    if (i > 0 && hits(i - 1).id == first.id) return;
    const Index p = first.particle;
    heat::Film film = targets.film(p);
    HitRecord record = targets.record(p);
    const bool warm = targets.temperature.extent(0) > 0;
    const heat::HeatCapacities& c = targets.capacities;
    Real capacity = 0;
    Real temperature = 0;
    if (warm) {
      capacity =
          targets.particles.mass(p) * targets.heat_capacity(targets.particles.velocity_spin(p).material) +
          film.liquid * c.liquid + film.solids * c.solids;
      temperature = targets.temperature(p);
    }
    for (Index k = i; k < count && hits(k).id == first.id; ++k) {
      const Hit hit = hits(k);
      film += hit.film;
      ++record.hits;
      // Those of one outer step are sorted by parcel, not by time.
      if (record.first_hit < 0 || hit.time < record.first_hit) record.first_hit = hit.time;
      record.last_hit = Kokkos::max(record.last_hit, hit.time);
      if (!warm) continue;
      const Real brought = hit.film.liquid * c.liquid + hit.film.solids * c.solids;
      if (targets.own_heat) {
        const Real above = temperature - c.reference_temperature;
        temperature += (hit.enthalpy - brought * above) / (capacity + brought);
        capacity += brought;
        continue;
      }
      const Real drop = targets.gas_temperature(hit.cell);
      temperature += brought / (capacity + brought) * (drop - temperature);
      capacity += brought;
      // Only these: others read who the hit belongs to at the same time.
      hits(k).enthalpy = brought * (drop - c.reference_temperature);
      hits(k).free_heat = brought * (drop - targets.nozzle_temperature(hit.nozzle));
    }
    targets.film(p) = film;
    targets.record(p) = record;
    if (warm) targets.temperature(p) = temperature;
  }
};

constexpr Index sum_block = 64;

struct SumHeat {
  DeviceArray<Hit> hits;
  Index count;
  DeviceArray<HitHeat> partial;
  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index end = Kokkos::min((block + 1) * sum_block, count);
    HitHeat sum;
    for (Index k = block * sum_block; k < end; ++k) {
      sum.enthalpy += hits(k).enthalpy;
      sum.free_heat += hits(k).free_heat;
    }
    partial(block) = sum;
  }
};

}  // namespace

void HitList::reserve(Index size) {
  if (static_cast<std::size_t>(size) <= hits_.extent(0)) return;
  const auto wanted = static_cast<std::size_t>(size + std::max<Index>(1024, size / 2));
  hits_ = DeviceArray<Hit>(Kokkos::view_alloc(Kokkos::WithoutInitializing, "spray::hits::hits"), wanted);
  aside_ = DeviceArray<Hit>(Kokkos::view_alloc(Kokkos::WithoutInitializing, "spray::hits::aside"), wanted);
}

void HitList::sort(Index count) {
  const Index runs = (count + first_run - 1) / first_run;
  Kokkos::parallel_for("spray::hits::sort_run", DeviceRange(0, runs), SortRun{hits_, count});
  for (Index length = first_run; length < count; length *= 2) {
    Kokkos::parallel_for("spray::hits::merge_runs", DeviceRange(0, count),
                         MergeRuns{hits_, aside_, count, length});
    std::swap(hits_, aside_);
  }
}

void add_hits(const DeviceArray<Hit>& hits, Index count, const HitTargets& targets) {
  Kokkos::parallel_for("spray::hits::add", DeviceRange(0, count), AddHits{hits, count, targets});
}

HitHeat sum_heat(const DeviceArray<Hit>& hits, Index count, DeviceArray<HitHeat>& partial) {
  HitHeat sum;
  if (count == 0) return sum;
  const Index blocks = (count + sum_block - 1) / sum_block;
  if (partial.extent(0) < static_cast<std::size_t>(blocks)) {
    partial = DeviceArray<HitHeat>(Kokkos::view_alloc(Kokkos::WithoutInitializing, "spray::hits::partial"),
                                   static_cast<std::size_t>(2 * blocks));
  }
  Kokkos::parallel_for("spray::hits::sum_heat", DeviceRange(0, blocks), SumHeat{hits, count, partial});
  const auto host = Kokkos::create_mirror_view_and_copy(
      Kokkos::HostSpace{}, Kokkos::subview(partial, std::pair<Index, Index>(0, blocks)));
  for (Index b = 0; b < blocks; ++b) {
    sum.enthalpy += host(b).enthalpy;
    sum.free_heat += host(b).free_heat;
  }
  return sum;
}

}  // namespace pellicle::spray
