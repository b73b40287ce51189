// Visits to a zone, counted by hand along made-up paths.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/checkpoint.hpp"
#include "spray/zone_visits.hpp"
#include "tests/core/temporary_folder.hpp"

namespace pellicle::spray {
namespace {

/// Particles that are moved by hand.
struct Paths {
  dem::Particles particles;
  DeviceArray<heat::Film> film;
  explicit Paths(Index count) : film("test::film", static_cast<std::size_t>(count)) {
    const auto n = static_cast<std::size_t>(count);
    particles.count = count;
    particles.position_radius = DeviceArray<dem::PositionRadius>("test::position_radius", n);
    particles.velocity_spin = DeviceArray<dem::VelocitySpin>("test::velocity_spin", n);
    for (Index p = 0; p < count; ++p) put(p, {5, 0, 0}, 1e-3, 0);
  }
  void put(Index p, const Vec3& x, Real radius, Real solids) {
    const auto place = Kokkos::create_mirror_view(particles.position_radius);
    const auto motion = Kokkos::create_mirror_view(particles.velocity_spin);
    const auto host_film = Kokkos::create_mirror_view(film);
    Kokkos::deep_copy(place, particles.position_radius);
    Kokkos::deep_copy(motion, particles.velocity_spin);
    Kokkos::deep_copy(host_film, film);
    place(p) = {x.x, x.y, x.z, radius};
    motion(p).id = p;
    host_film(p).solids = solids;
    Kokkos::deep_copy(particles.position_radius, place);
    Kokkos::deep_copy(particles.velocity_spin, motion);
    Kokkos::deep_copy(film, host_film);
  }
};

ZoneOptions unit_box() {
  ZoneOptions options;
  options.name = "zone";
  options.shape.min = {0, 0, 0};
  options.shape.max = {1, 1, 1};
  options.longest_time = 10;
  options.bins = 10;
  return options;
}

constexpr Vec3 in{0.5, 0.5, 0.5};
constexpr Vec3 out{0.5, 0.5, 2};

ZoneSums total(const std::vector<ZoneSums>& parts) {
  ZoneSums sum;
  for (const ZoneSums& part : parts) sum += part;
  return sum;
}

TEST(ZoneVisits, CyclesByHand) {
  Paths paths(2);
  ZoneVisits zone(unit_box(), paths.particles);
  zone.reset(2);
  paths.put(0, out, 1e-3, 1.0);
  paths.put(1, in, 1e-3, 0.0);  // inside at the start: no entry
  zone.update(0, paths.film);
  // Particle 0 is in from 1 to 3, 6 to 7, and from 12 on; its coating at the three entries is 2, 5 and 5.5 kg.
  // Particle 1 leaves at 4 and enters at 9.
  struct Event {
    Real time;
    Index p;
    Vec3 at;
    Real solids;
  };
  const std::vector<Event> events{{1, 0, in, 2},  {3, 0, out, 4},   {4, 1, out, 0},  {6, 0, in, 5},
                                  {7, 0, out, 5}, {9, 1, in, 0.25}, {12, 0, in, 5.5}};
  for (const Event& e : events) {
    paths.put(e.p, e.at, 1e-3, e.solids);
    zone.update(e.time, paths.film);
  }
  const ZoneSums sum = total(zone.compute_sums(13, paths.film));
  EXPECT_EQ(sum.particles, 2);
  EXPECT_EQ(sum.inside, 2);
  EXPECT_EQ(sum.entered, 2);
  EXPECT_EQ(sum.entries, 4);
  EXPECT_EQ(sum.cycles, 2);       // 1 -> 6 and 6 -> 12
  EXPECT_EQ(sum.cycle_time, 11);  // 5 + 6
  EXPECT_EQ(sum.cycle_time_squared, 61);
  EXPECT_EQ(sum.gain, 3.5);  // 3 + 0.5
  EXPECT_EQ(sum.gain_squared, 9.25);
  EXPECT_EQ(sum.time_gain, 18);  // 5 x 3 + 6 x 0.5
  EXPECT_EQ(sum.visits, 2);
  EXPECT_EQ(sum.residence, 3);  // 2 + 1
  EXPECT_EQ(sum.solids, 5.75);
  EXPECT_EQ(sum.solids_squared, 5.5 * 5.5 + 0.0625);
  const ZoneHistograms counts = zone.compute_histograms(13);
  EXPECT_EQ(counts.cycle_time, (std::vector<std::int64_t>{0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0}));
  EXPECT_EQ(counts.residence, (std::vector<std::int64_t>{0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(counts.open_cycle, (std::vector<std::int64_t>{0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0}));  // 13-12, 13-9
}

TEST(ZoneVisits, WhoNeverEnteredHasNoOpenCycle) {
  Paths paths(3);
  ZoneVisits zone(unit_box(), paths.particles);
  zone.reset(3);
  paths.put(0, in, 1e-3, 0);  // inside from the start
  zone.update(0, paths.film);
  paths.put(2, in, 1e-3, 0);
  zone.update(1, paths.film);
  const ZoneHistograms counts = zone.compute_histograms(3.5);
  EXPECT_EQ(counts.open_cycle, (std::vector<std::int64_t>{0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0}));
}

// The rest of a path gives the same figures whether a checkpoint lies in between or not.
TEST(ZoneVisits, GoesThroughACheckpoint) {
  const tests::TemporaryFolder folder;
  Paths paths(2);
  ZoneVisits zone(unit_box(), paths.particles), resumed(unit_box(), paths.particles);
  zone.reset(2);
  zone.update(0, paths.film);
  const auto step = [&](ZoneVisits& which, Real time, const Vec3& at, Real solids) {
    paths.put(0, at, 1e-3, solids);
    which.update(time, paths.film);
  };
  step(zone, 1, in, 0.5);
  step(zone, 2, out, 1);
  step(zone, 4, in, 1);
  step(zone, 4.5, out, 1.5);
  {
    core::CheckpointWriter file(folder / "checkpoint.h5");
    zone.save(file, 2);
    file.close();
  }
  resumed.load(core::CheckpointReader(folder / "checkpoint.h5"), 2);
  step(zone, 9, in, 2);
  step(resumed, 8, out, 1.5);  // no news
  step(resumed, 9, in, 2);
  const ZoneSums a = total(zone.compute_sums(10, paths.film)),
                 b = total(resumed.compute_sums(10, paths.film));
  EXPECT_EQ(b.entries, 3);
  EXPECT_EQ(b.cycle_time, 8);  // 3 + 5
  EXPECT_EQ(b.cycle_time_squared, 34);
  EXPECT_EQ(b.gain, 1.5);  // 0.5 + 1
  EXPECT_EQ(b.residence, a.residence);
  EXPECT_EQ(b.time_gain, a.time_gain);
  EXPECT_EQ(resumed.compute_histograms(10).cycle_time, zone.compute_histograms(10).cycle_time);
  EXPECT_EQ(resumed.compute_histograms(10).residence, zone.compute_histograms(10).residence);
  EXPECT_EQ(resumed.radii(), zone.radii());
  EXPECT_EQ(resumed.start(), 0);
}

// Counts of another place, or of other bins, are no counts of this one.
TEST(ZoneVisits, OneThatChangedBeginsAnew) {
  const tests::TemporaryFolder folder;
  Paths paths(1);
  ZoneVisits zone(unit_box(), paths.particles);
  zone.reset(1);
  paths.put(0, out, 1e-3, 0);
  zone.update(0, paths.film);
  paths.put(0, in, 1e-3, 0);
  zone.update(1, paths.film);
  {
    core::CheckpointWriter file(folder / "checkpoint.h5");
    zone.save(file, 1);
    file.close();
  }
  std::vector<ZoneOptions> others(4, unit_box());
  others[0].shape.max.x += 0.5;
  others[1].bins += 1;
  others[2].shortest_absence += 0.25;
  others[3].longest_time += 1;
  for (const ZoneOptions& options : others) {
    ZoneVisits changed(options, paths.particles);
    changed.load(core::CheckpointReader(folder / "checkpoint.h5"), 1);
    changed.update(2, paths.film);  // inside at its start: it has not entered
    EXPECT_EQ(total(changed.compute_sums(3, paths.film)).entries, 0);
    EXPECT_EQ(changed.start(), 2);
  }
}

TEST(ZoneVisits, LastVisitIsInTheHistogramOnceItHasEnded) {
  ZoneOptions options = unit_box();
  options.shortest_absence = 0.5;
  Paths paths(1);
  ZoneVisits zone(options, paths.particles);
  zone.reset(1);
  paths.put(0, out, 1e-3, 0);
  zone.update(0, paths.film);
  paths.put(0, in, 1e-3, 0);
  zone.update(1, paths.film);
  paths.put(0, out, 1e-3, 0);
  zone.update(3.5, paths.film);
  const auto ended = [&](Real time) {
    std::int64_t all = 0;
    for (const std::int64_t count : zone.compute_histograms(time).residence) all += count;
    return all;
  };
  EXPECT_EQ(ended(3.75), 0);  // it may still come back
  EXPECT_EQ(ended(4), 1);
  EXPECT_EQ(zone.compute_histograms(4).residence[2], 1);  // 2.5 s in bins of 1 s
}

TEST(ZoneVisits, ShortAbsenceIsNone) {
  ZoneOptions options = unit_box();
  options.shortest_absence = 0.5;
  Paths paths(1);
  ZoneVisits zone(options, paths.particles);
  zone.reset(1);
  paths.put(0, out, 1e-3, 0);
  zone.update(0, paths.film);
  const auto step = [&](Real time, const Vec3& at) {
    paths.put(0, at, 1e-3, 0);
    zone.update(time, paths.film);
  };
  step(1, in);
  step(2, out);
  step(2.25, in);  // back after 0.25: the same visit
  step(3, out);
  ZoneSums sum = total(zone.compute_sums(3.25, paths.film));
  EXPECT_EQ(sum.entries, 1);
  EXPECT_EQ(sum.visits, 0);  // it may still come back
  sum = total(zone.compute_sums(3.5, paths.film));
  EXPECT_EQ(sum.visits, 1);
  EXPECT_EQ(sum.residence, 2);  // 1 to 3
  step(4, in);
  sum = total(zone.compute_sums(4, paths.film));
  EXPECT_EQ(sum.entries, 2);
  EXPECT_EQ(sum.cycle_time, 3);
}

TEST(ZoneVisits, CylinderAlongAnyAxis) {
  ZoneShape shape;
  shape.is_box = false;
  shape.from = {1, 2, 3};
  shape.axis = {0.6, 0, 0.8};
  shape.length = 5;
  shape.radius = 0.5;
  const Vec3 across{0.8, 0, -0.6};
  EXPECT_TRUE(shape.contains(shape.from + 2.0 * shape.axis + 0.49 * across));
  EXPECT_FALSE(shape.contains(shape.from + 2.0 * shape.axis + 0.51 * across));
  EXPECT_TRUE(shape.contains(shape.from + 4.99 * shape.axis));
  EXPECT_FALSE(shape.contains(shape.from + 5.01 * shape.axis));
  EXPECT_FALSE(shape.contains(shape.from - 0.01 * shape.axis));
  EXPECT_TRUE(shape.contains(shape.from + 1.0 * shape.axis + Vec3{0, -0.49, 0}));
}

TEST(ZoneVisits, GroupsAndSizeClasses) {
  ZoneOptions options = unit_box();
  options.size_classes = 2;
  constexpr Index count = 40;
  Paths paths(count);
  ZoneVisits zone(options, paths.particles);
  zone.reset(count);
  for (Index p = 0; p < count; ++p) paths.put(p, out, p < 30 ? 1e-3 : 2e-3, p);
  zone.update(0, paths.film);
  const auto sums = zone.compute_sums(0, paths.film);
  ASSERT_EQ(sums.size(), 2U * zone_groups);
  EXPECT_EQ(sums[3].particles, 2);  // small, ids 3 and 19
  EXPECT_EQ(sums[3].solids, 22);
  EXPECT_EQ(sums[zone_groups + 1].particles, 1);  // large, 33 of 1, 17, 33
  EXPECT_EQ(sums[zone_groups + 1].solids, 33);
  EXPECT_EQ(sums[14].particles, 1);  // small 14; 30 is large
  EXPECT_EQ(sums[zone_groups + 14].solids, 30);
}

}  // namespace
}  // namespace pellicle::spray
