// Contacts that begin, counted by the wetness of the wetter partner and the speed: against collisions worked out by hand and
// against a bed whose overlaps are followed pair by pair.
#include "spray/contact_wetness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "tests/core/temporary_folder.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::spray {
namespace {

WetnessOptions region(const Vec3& min, const Vec3& max) {
  WetnessOptions options;
  options.name = "all";
  options.shape.min = min;
  options.shape.max = max;
  options.wettest = 0.02;
  options.fastest = 1;
  options.bins = 4;
  options.speed_bins = 5;
  options.every_substep = true;
  return options;
}

struct Counting {
  dem::Engine engine;
  heat::SurfaceState surface;
  std::vector<ContactWetness> regions;

  Counting(const dem::EngineSetup& setup, const std::vector<dem::ParticleSeed>& seeds,
           const std::vector<WetnessOptions>& options)
      : engine(setup), surface(engine.particles(), std::vector<Real>(setup.materials.size(), 840), {}, 300) {
    engine.attach(surface);
    engine.set_particles(seeds);
    for (const WetnessOptions& one : options) regions.emplace_back(one);
  }
  /// Liquid and solids of the particle with this id [kg].
  void wet(std::int32_t id, const heat::Film& film) const {
    const auto motion =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, engine.particles().velocity_spin);
    const auto films = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, surface.film());
    for (Index p = 0; p < engine.particles().count; ++p) {
      if (motion(p).id == id) films(p) = film;
    }
    Kokkos::deep_copy(surface.film(), films);
  }
  template <class Watch>
  void outer_step(int substeps, const Watch& watch) {
    core::Timers timers;
    engine.prepare_outer_step();
    engine.advance(substeps, timers, [&](int k) {
      watch();
      for (ContactWetness& one : regions) one.count(k, substeps, engine, surface.film());
    });
  }
};

std::int64_t total(const std::vector<std::int64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

dem::ParticleSeed bead(const Vec3& position, const Vec3& velocity, Real radius = 1e-3) {
  dem::ParticleSeed seed;
  seed.position = position;
  seed.velocity = velocity;
  seed.radius = radius;
  return seed;
}

// Two beads of 1 mm meet head on at 0.3 + 0.4 m/s in the middle of the box, a third hits the floor at 0.5 m/s. 0.1 mg of
// water on the second is 0.1e-6 / (4 pi 1e-6) = 7.96 g/m2: bin 1 of 5 g/m2, row 2. 30 % of solids beside it: fraction 0.7.
TEST(ContactWetness, CollisionsByHand) {
  dem::EngineSetup setup = tests::glass_setup({0.02, 0.02, 0.02}, 2e-6, 0.5);
  tests::add_box_walls(setup);
  const std::vector<dem::ParticleSeed> seeds{bead({0.008, 0.01, 0.01}, {0.3, 0, 0}),
                                             bead({0.0121, 0.01, 0.01}, {-0.4, 0, 0}),
                                             bead({0.004, 0.004, 0.0013}, {0.1, 0, -0.5})};
  // In the middle, without it, and by the liquid's share.
  std::vector<WetnessOptions> options{region({0, 0, 0}, {0.02, 0.02, 0.02}),
                                      region({0, 0, 0}, {0.0085, 1, 1}),
                                      region({0, 0, 0}, {0.02, 0.02, 0.02})};
  options[2].measure = WetnessMeasure::liquid_fraction;
  options[2].wettest = 1;
  Counting counting(setup, seeds, options);
  counting.wet(1, {0.1e-6, 0.1e-6 * 3 / 7});
  for (int k = 0; k < 200; ++k) counting.outer_step(10, [] {});
  const WetnessCounts all = counting.regions[0].counts();
  ASSERT_EQ(all.rows, 6);
  ASSERT_EQ(all.columns, 6);
  const auto at = [](std::size_t row, std::size_t column) { return row * 6 + column; };
  EXPECT_EQ(all.pairs[at(2, 3)], 1);  // 0.7 m/s: 0.6 to 0.8
  EXPECT_EQ(total(all.pairs), 1);
  EXPECT_EQ(all.walls[at(0, 2)], 1);  // dry, 0.5 m/s: 0.4 to 0.6
  EXPECT_EQ(total(all.walls), 1);
  const WetnessCounts left = counting.regions[1].counts();
  EXPECT_EQ(total(left.pairs), 0);
  EXPECT_EQ(total(left.walls), 1);
  const WetnessCounts share = counting.regions[2].counts();
  EXPECT_EQ(share.pairs[at(3, 3)], 1);  // 0.7: 0.5 to 0.75
}

// Wetter and faster than the last bins: in the row and the column after them. The wetter of the two counts.
TEST(ContactWetness, BeyondTheBins) {
  const dem::EngineSetup setup = tests::glass_setup({0.02, 0.02, 0.02}, 1e-6, 0.5);
  Counting counting(setup, {bead({0.008, 0.01, 0.01}, {0.9, 0, 0}), bead({0.0105, 0.01, 0.01}, {-0.4, 0, 0})},
                    {region({0, 0, 0}, {0.02, 0.02, 0.02})});
  counting.wet(0, {0.5e-6, 0});  // 39.8 g/m2
  counting.wet(1, {1e-9, 0});
  for (int k = 0; k < 60; ++k) counting.outer_step(10, [] {});
  const WetnessCounts counts = counting.regions[0].counts();
  EXPECT_EQ(counts.pairs[5 * 6 + 5], 1);
  EXPECT_EQ(total(counts.pairs), 1);
}

/// Beads that fly about in a box, periodic along y.
Counting flying_bed(int every) {
  dem::EngineSetup setup = tests::glass_setup({0.012, 0.01, 0.012}, 4e-6, 0.95);
  setup.domain.periodic = {0, 1, 0};
  tests::add_box_walls(setup);
  std::vector<Real> radii(60, 0.8e-3);
  for (std::size_t i = 0; i < radii.size(); i += 3) radii[i] = 0.5e-3;
  const std::vector<Vec3> places = tests::scatter({{1e-3, 0, 1e-3}, {0.011, 0.01, 0.011}}, radii, 0, 4);
  std::vector<dem::ParticleSeed> seeds;
  for (std::size_t i = 0; i < radii.size(); ++i)
    seeds.push_back(bead(places[i], 1.0 * tests::random_vector(9, static_cast<int>(i)), radii[i]));
  std::vector<WetnessOptions> options{region({-1, -1, -1}, {1, 1, 1}), region({0, -1, 0}, {0.006, 1, 1}),
                                      region({0.006, -1, 0}, {1, 1, 1})};
  for (WetnessOptions& one : options) {
    one.fastest = 4;
    one.every_substep = every == 1;
  }
  return {setup, seeds, options};
}

// Every overlap that was not there a substep before, as found by looking at all pairs; walls are the planes of the box.
TEST(ContactWetness, AgainstOverlapsThatAreFollowed) {
  Counting counting = flying_bed(1);
  for (std::int32_t id = 0; id < 60; id += 2) counting.wet(id, {id * 1e-9, 0});
  std::set<std::pair<std::size_t, std::size_t>> touching, before, walls_touching, walls_before;
  std::int64_t pairs = 0, walls = 0, dry = 0;
  bool first = true;
  const auto watch = [&] {
    const std::vector<tests::Grain> grains = tests::grains(counting.engine.particles());
    touching.clear();
    walls_touching.clear();
    for (std::size_t a = 0; a < grains.size(); ++a) {
      for (std::size_t b = a + 1; b < grains.size(); ++b) {
        Vec3 apart = grains[a].position - grains[b].position;
        apart.y -= 0.01 * std::round(apart.y / 0.01);
        if (norm(apart) < grains[a].radius + grains[b].radius) touching.emplace(a, b);
      }
      const Vec3 x = grains[a].position;
      const Real gaps[4] = {x.x, 0.012 - x.x, x.z, 0.012 - x.z};
      for (std::size_t w = 0; w < 4; ++w) {
        if (gaps[w] < grains[a].radius) walls_touching.emplace(a, w);
      }
    }
    if (first) before = touching;  // what overlaps at the start across the periodic sides does not begin
    first = false;
    for (const auto& pair : touching) {
      if (before.contains(pair)) continue;
      ++pairs;
      const bool wet = (pair.first % 2 == 0 && pair.first > 0) || pair.second % 2 == 0;
      dry += wet ? 0 : 1;
    }
    for (const auto& pair : walls_touching) walls += walls_before.contains(pair) ? 0 : 1;
    before = touching;
    walls_before = walls_touching;
  };
  for (int k = 0; k < 500; ++k) counting.outer_step(10, watch);
  ASSERT_GT(pairs, 150);
  ASSERT_GT(walls, 50);
  ASSERT_GT(dry, 20);
  const WetnessCounts all = counting.regions[0].counts();
  EXPECT_EQ(total(all.pairs), pairs);
  EXPECT_EQ(total(all.walls), walls);
  EXPECT_EQ(std::accumulate(all.pairs.begin(), all.pairs.begin() + 6, std::int64_t{0}), dry);
  EXPECT_GT(*std::max_element(all.pairs.begin() + 6, all.pairs.end()), 5);
  // The two halves of the box together are all of it.
  const WetnessCounts left = counting.regions[1].counts(), right = counting.regions[2].counts();
  EXPECT_EQ(total(left.pairs) + total(right.pairs), pairs);
  EXPECT_GT(total(left.pairs), pairs / 4);
  EXPECT_GT(total(right.pairs), pairs / 4);
}

// One substep in five, each contact counting five times: 2000 contacts are found to within the scatter of the sample, whose
// standard deviation is that of a binomial, sqrt(n 4/5 5) of the estimate.
TEST(ContactWetness, ASampleFindsAsManyOnAverage) {
  Counting full = flying_bed(1), sample = flying_bed(5);
  for (int k = 0; k < 2000; ++k) {
    full.outer_step(5, [] {});
    sample.outer_step(5, [] {});
  }
  const Real all = static_cast<Real>(total(full.regions[0].counts().pairs));
  const Real some = static_cast<Real>(total(sample.regions[0].counts().pairs));
  ASSERT_GT(all, 200);
  EXPECT_NEAR(some, all, 4 * std::sqrt(4 * all));
  EXPECT_EQ(std::fmod(some, 5), 0);
}

TEST(ContactWetness, GoesThroughACheckpoint) {
  const tests::TemporaryFolder folder;
  Counting counting = flying_bed(1);
  for (int k = 0; k < 300; ++k) counting.outer_step(10, [] {});
  core::CheckpointWriter out(folder / "checkpoint.h5");
  counting.regions[0].save(out);
  out.close();
  ContactWetness again(counting.regions[0].options());
  again.load(core::CheckpointReader(folder / "checkpoint.h5"));
  EXPECT_GT(total(again.counts().pairs), 0);
  EXPECT_EQ(again.counts().pairs, counting.regions[0].counts().pairs);
  EXPECT_EQ(again.counts().walls, counting.regions[0].counts().walls);
}

}  // namespace
}  // namespace pellicle::spray
