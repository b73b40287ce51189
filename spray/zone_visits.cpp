#include "spray/zone_visits.hpp"

#include <algorithm>

#include "spray/region_identity.hpp"

namespace pellicle::spray {
namespace {

/// Particles that one work item sums over; fixed, so that sums do not depend on threads.
constexpr Index sum_block = 8192;

/// Bin of a time; the last one, `bins`, for what is longer.
KOKKOS_INLINE_FUNCTION Index bin_of(Real time, Real longest, Index bins) {
  const auto bin = static_cast<Index>(time / longest * bins);
  return time < longest ? Kokkos::min(bin, bins - 1) : bins;
}

struct FindRadii {
  DeviceArray<dem::PositionRadius> place;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Kokkos::MinMaxScalar<Real>& all) const {
    all.min_val = Kokkos::min(all.min_val, place(p).radius);
    all.max_val = Kokkos::max(all.max_val, place(p).radius);
  }
};

Kokkos::MinMaxScalar<Real> radii_of(const dem::Particles& particles) {
  Kokkos::MinMaxScalar<Real> found;
  Kokkos::parallel_reduce("spray::zone_visits::find_radii", DeviceRange(0, particles.count),
                          FindRadii{particles.position_radius}, Kokkos::MinMax<Real>(found));
  return found;
}

/// At the start: who is inside has not entered.
struct MarkInside {
  ZoneShape shape;
  DeviceArray<dem::PositionRadius> place;
  DeviceArray<Visit> visits;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    visits(p).inside = shape.contains(place(p).position()) ? 1 : 0;
  }
};

struct UpdateVisits {
  ZoneShape shape;
  Real time, shortest_absence, longest;
  Index bins;
  DeviceArray<dem::PositionRadius> place;
  DeviceArray<heat::Film> film;
  DeviceArray<Visit> visits;
  DeviceArray<Cycles> cycles;
  DeviceArray<std::int64_t> cycle_counts, residence_counts;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    const bool inside = shape.contains(place(p).position());
    if (inside == (visits(p).inside != 0)) return;
    Visit visit = visits(p);
    visit.inside = inside ? 1 : 0;
    if (!inside) {
      visit.left = time;
    } else if (visit.left < 0 || time - visit.left >= shortest_absence) {
      enter(p, visit);
    }
    visits(p) = visit;
  }

  KOKKOS_INLINE_FUNCTION void enter(Index p, Visit& visit) const {
    const Real solids = film.extent(0) > 0 ? film(p).solids : 0;
    if (visit.entries > 0) {
      const Real cycle = time - visit.entered, gain = solids - visit.solids;
      Cycles sum = cycles(p);
      sum.time_squared += cycle * cycle;
      sum.gain += gain;
      sum.gain_squared += gain * gain;
      sum.time_gain += cycle * gain;
      cycles(p) = sum;
      const Real stay = visit.left - visit.entered;
      visit.residence += stay;
      // Whole numbers: the same whatever the order.
      Kokkos::atomic_inc(&cycle_counts(bin_of(cycle, longest, bins)));
      Kokkos::atomic_inc(&residence_counts(bin_of(stay, longest, bins)));
    } else {
      visit.first_entry = time;
    }
    visit.entered = time;
    visit.solids = solids;
    ++visit.entries;
  }
};

// The last visit counts once the particle has been away for long enough.
KOKKOS_INLINE_FUNCTION bool has_ended(const Visit& visit, Real time, Real shortest_absence) {
  return visit.entries > 0 && visit.inside == 0 && time - visit.left >= shortest_absence;
}

struct SumZone {
  Index count, classes;
  Real smallest, largest, time, shortest_absence;
  dem::Particles particles;
  DeviceArray<heat::Film> film;
  DeviceArray<Visit> visits;
  DeviceArray<Cycles> cycles;
  DeviceArray<ZoneSums> sums;  // blocks x classes x groups

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index rows = classes * zone_groups;
    for (Index row = 0; row < rows; ++row) sums(block * rows + row) = ZoneSums{};
    const Index end = Kokkos::min((block + 1) * sum_block, count);
    for (Index p = block * sum_block; p < end; ++p) {
      const Index group = particles.velocity_spin(p).id % zone_groups;
      const Real share = largest > smallest
                             ? (particles.position_radius(p).radius - smallest) / (largest - smallest)
                             : Real(0);
      const Index size =
          share > 0 ? Kokkos::min(static_cast<Index>(share * static_cast<Real>(classes)), classes - 1) : 0;
      sums(block * rows + size * zone_groups + group) += of(p);
    }
  }

  KOKKOS_INLINE_FUNCTION ZoneSums of(Index p) const {
    const Visit& visit = visits(p);
    const Cycles& cycle = cycles(p);
    ZoneSums sum;
    sum.particles = 1;
    sum.inside = visit.inside;
    sum.entered = visit.entries > 0 ? 1 : 0;
    sum.entries = visit.entries;
    sum.cycles = visit.entries > 0 ? visit.entries - 1 : 0;
    sum.visits = sum.cycles;
    sum.residence = visit.residence;
    if (has_ended(visit, time, shortest_absence)) {
      sum.visits += 1;
      sum.residence += visit.left - visit.entered;
    }
    sum.cycle_time = visit.entries > 0 ? visit.entered - visit.first_entry : 0;
    sum.cycle_time_squared = cycle.time_squared;
    sum.gain = cycle.gain;
    sum.gain_squared = cycle.gain_squared;
    sum.time_gain = cycle.time_gain;
    sum.solids = film.extent(0) > 0 ? film(p).solids : 0;
    sum.solids_squared = sum.solids * sum.solids;
    return sum;
  }
};

// What has not been counted as particles entered anew: cycles that go on, and the last visit of each if it has ended.
struct CountLast {
  Real time, longest, shortest_absence;
  Index bins;
  DeviceArray<Visit> visits;
  DeviceArray<std::int64_t> open, residence;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    const Visit& visit = visits(p);
    if (visit.entries == 0) return;
    Kokkos::atomic_inc(&open(bin_of(time - visit.entered, longest, bins)));
    if (has_ended(visit, time, shortest_absence))
      Kokkos::atomic_inc(&residence(bin_of(visit.left - visit.entered, longest, bins)));
  }
};

std::vector<std::int64_t> to_host(const DeviceArray<std::int64_t>& counts) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, counts);
  return {host.data(), host.data() + host.extent(0)};
}

void from_file(const core::CheckpointReader& file, const std::string& name,
               const DeviceArray<std::int64_t>& counts) {
  const auto host = Kokkos::create_mirror_view(counts);
  file.read_into(name, host);
  Kokkos::deep_copy(counts, host);
}

std::string path_of(const ZoneOptions& options, const char* what) {
  return "zones/" + options.name + "/" + what;
}

}  // namespace

ZoneVisits::ZoneVisits(const ZoneOptions& options, const dem::Particles& particles)
    : options_(options),
      particles_(particles),
      visits_("spray::zone_visits::visits", path_of(options, "visits")),
      cycles_("spray::zone_visits::cycles", path_of(options, "cycles")),
      cycle_counts_("spray::zone_visits::cycle_counts", static_cast<std::size_t>(options.bins) + 1),
      residence_counts_("spray::zone_visits::residence_counts", static_cast<std::size_t>(options.bins) + 1) {}

void ZoneVisits::find_radii() {
  const Kokkos::MinMaxScalar<Real> found = radii_of(particles_);
  smallest_radius_ = found.min_val;
  largest_radius_ = found.max_val;
}

void ZoneVisits::update(Real time, const DeviceArray<heat::Film>& film) {
  if (particles_.count == 0) return;
  const DeviceRange all(0, particles_.count);
  if (!started_) {
    find_radii();
    Kokkos::parallel_for("spray::zone_visits::mark_inside", all,
                         MarkInside{options_.shape, particles_.position_radius, visits_.values()});
    start_ = time;
    started_ = true;
    return;
  }
  Kokkos::parallel_for("spray::zone_visits::update", all,
                       UpdateVisits{options_.shape, time, options_.shortest_absence, options_.longest_time,
                                    options_.bins, particles_.position_radius, film, visits_.values(),
                                    cycles_.values(), cycle_counts_, residence_counts_});
}

std::vector<ZoneSums> ZoneVisits::compute_sums(Real time, const DeviceArray<heat::Film>& film) const {
  const Index rows = options_.size_classes * zone_groups;
  std::vector<ZoneSums> total(static_cast<std::size_t>(rows));
  if (particles_.count == 0) return total;
  const Index blocks = (particles_.count + sum_block - 1) / sum_block;
  const DeviceArray<ZoneSums> sums(
      Kokkos::view_alloc("spray::zone_visits::sums", Kokkos::WithoutInitializing),
      static_cast<std::size_t>(blocks) * static_cast<std::size_t>(rows));
  Kokkos::parallel_for(
      "spray::zone_visits::sum", DeviceRange(0, blocks),
      SumZone{particles_.count, options_.size_classes, smallest_radius_, largest_radius_, time,
              options_.shortest_absence, particles_, film, visits_.values(), cycles_.values(), sums});
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, sums);
  for (std::size_t i = 0; i < host.extent(0); ++i) total[i % static_cast<std::size_t>(rows)] += host(i);
  return total;
}

ZoneHistograms ZoneVisits::compute_histograms(Real time) const {
  const DeviceArray<std::int64_t> open("spray::zone_visits::open", cycle_counts_.extent(0));
  const DeviceArray<std::int64_t> residence("spray::zone_visits::residence", residence_counts_.extent(0));
  Kokkos::deep_copy(residence, residence_counts_);
  if (particles_.count > 0) {
    Kokkos::parallel_for("spray::zone_visits::count_last", DeviceRange(0, particles_.count),
                         CountLast{time, options_.longest_time, options_.shortest_absence, options_.bins,
                                   visits_.values(), open, residence});
  }
  return {to_host(cycle_counts_), to_host(open), to_host(residence)};
}

void ZoneVisits::reset(Index count) {
  visits_.reset(count);
  cycles_.reset(count);
  Kokkos::deep_copy(cycle_counts_, 0);
  Kokkos::deep_copy(residence_counts_, 0);
  started_ = false;
}

void ZoneVisits::add(Index first, Index count) {
  visits_.add(first, count);
  cycles_.add(first, count);
}

void ZoneVisits::reorder(const DeviceArray<std::int32_t>& order, Index before, Index count,
                         const DeviceArray<Real>& scratch) {
  visits_.reorder(order, before, count, scratch);
  cycles_.reorder(order, before, count, scratch);
}

void ZoneVisits::save(core::CheckpointWriter& file, Index count) const {
  visits_.save(file, count);
  cycles_.save(file, count);
  file.write(path_of(options_, "cycle_counts"), to_host(cycle_counts_));
  file.write(path_of(options_, "residence_counts"), to_host(residence_counts_));
  file.write(path_of(options_, "smallest_radius"), smallest_radius_);
  file.write(path_of(options_, "largest_radius"), largest_radius_);
  file.write(path_of(options_, "is"), identity_of(options_));
  file.write(path_of(options_, "start"), start_);
  file.write(path_of(options_, "started"), std::int64_t{started_ ? 1 : 0});
}

void ZoneVisits::load(const core::CheckpointReader& file, Index count) {
  reset(count);
  if (!goes_on(file, path_of(options_, "is"), identity_of(options_), "zone " + options_.name)) return;
  start_ = file.read_double(path_of(options_, "start"));
  visits_.load(file, count);
  cycles_.load(file, count);
  from_file(file, path_of(options_, "cycle_counts"), cycle_counts_);
  from_file(file, path_of(options_, "residence_counts"), residence_counts_);
  smallest_radius_ = file.read_double(path_of(options_, "smallest_radius"));
  largest_radius_ = file.read_double(path_of(options_, "largest_radius"));
  started_ = file.read_int64(path_of(options_, "started")) != 0;
}

}  // namespace pellicle::spray
