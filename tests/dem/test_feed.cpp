// Particles that enter while a run goes on.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "core/checkpoint.hpp"
#include "dem/feed.hpp"
#include "dem/stl.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/dem/bed.hpp"
#include "tests/dem/meshes.hpp"

namespace pellicle::dem {
namespace {

using tests::advance;
using tests::Grain;
using tests::grains;

constexpr Real density = 2500;  // that of tests::glass_setup

Real mass_of(Real diameter) { return density * M_PI / 6 * diameter * diameter * diameter; }

/// 2 mm spheres that fall out of a plate at the top of a box of 20 x 20 x 40 mm.
FeedSetup plate_feed(const Domain& domain) {
  FeedSetup setup;
  setup.region = Box{{0.002, 0.002, 0.035}, {0.018, 0.018, 0.035}};
  setup.domain = domain;
  setup.to = 10;
  setup.rate = 0.02;
  setup.density = density;
  setup.diameter = 0.002;
  setup.particle.velocity = {0, 0, -0.5};
  setup.seed = 4;
  return setup;
}

/// A box whose particles fall through an open floor.
EngineSetup open_box(const FeedSetup& feed_setup) {
  auto setup = tests::glass_setup({0.02, 0.02, 0.04}, 1e-5);
  setup.domain.open_min = {0, 0, 1};
  setup.gravity = {0, 0, -9.81};
  tests::add_box_walls(setup);
  const Feed feed(feed_setup);
  setup.later = {{0}, feed.smallest_radius(), feed.largest_radius(), feed.expected_particles()};
  return setup;
}

/// One outer step of ten substeps that begins at step × 0.1 ms.
void outer_step(Engine& engine, Feed& feed, int step) {
  const Real time = 1e-4 * step;
  if (feed.is_due(time)) engine.add_particles(feed.draw(time, step, spheres_near(engine, feed.reach())));
  engine.prepare_outer_step();
  advance(engine, 10);
  (void)engine.collect_report();
}

TEST(Feed, KeepsToItsRate) {
  const Domain domain = tests::glass_setup({0.02, 0.02, 0.04}, 1e-5).domain;
  FeedSetup setup = plate_feed(domain);
  setup.from = 0.1;
  setup.to = 0.3;
  Feed even(setup);
  setup.diameter = UniformSizes{0.001, 0.003};
  Feed spread(setup);
  setup.by_count = true;
  setup.rate = 1000;
  Feed counted(setup);
  std::int64_t entered = 0;
  for (int step = 0; step <= 4000; ++step) {
    const Real time = 1e-4 * step;
    entered += static_cast<std::int64_t>(even.draw(time, step, {}).size());
    (void)spread.draw(time, step, {});
    (void)counted.draw(time, step, {});
    const Real due = 0.02 * std::max(0.0, std::min(time, 0.3) - 0.1);
    // The last one enters when its whole mass is due: the feed is behind by less than one particle.
    ASSERT_LE(even.fed_mass(), due * (1 + 1e-9)) << time;
    ASSERT_GT(even.fed_mass(), due - mass_of(0.002)) << time;
    ASSERT_LE(spread.fed_mass(), due * (1 + 1e-9)) << time;
    ASSERT_GT(spread.fed_mass(), due - mass_of(0.003)) << time;
    ASSERT_EQ(even.waiting(time), 0);
  }
  // 4 g of 10.47 mg each; 1000/s for 0.2 s.
  EXPECT_EQ(even.fed_particles(), static_cast<std::int64_t>(0.004 / mass_of(0.002)));
  EXPECT_EQ(entered, even.fed_particles());
  EXPECT_EQ(counted.fed_particles(), 200);
  EXPECT_EQ(even.expected_particles(), even.fed_particles());
}

TEST(Feed, EntersInsideItsRegionAndTouchesNobody) {
  Domain domain;
  domain.box = {{0, 0, 0}, {0.02, 0.02, 0.04}};
  domain.periodic = {1, 0, 0};
  FeedSetup setup = plate_feed(domain);
  setup.diameter = UniformSizes{0.001, 0.003};
  setup.rate = 1e3;  // as many as find room
  const DiscRegion disc{{0.01, 0.01, 0.03}, {0.6, 0, 0.8}, 0.008};
  const Box thick{{0, 0, 0.01}, {0.02, 0.02, 0.02}};
  for (const std::variant<Box, DiscRegion>& region : {std::variant<Box, DiscRegion>(thick), {disc}}) {
    setup.region = region;
    Feed feed(setup);
    const std::vector<PlacedSphere> near{{{0.0195, 0.005, 0.015}, 0.003}, {{0.01, 0.01, 0.03}, 0.002}};
    const auto entering = feed.draw(1, 7, near);
    ASSERT_GT(entering.size(), 10u);
    EXPECT_GT(feed.waiting(1), 0);
    const Box reach = feed.reach();
    for (std::size_t a = 0; a < entering.size(); ++a) {
      const Vec3 x = entering[a].position;
      const Real r = entering[a].radius;
      const auto distance = [&](const Vec3& y) {  // the nearest of the images along x, by hand
        Real nearest = 1;
        for (const int image : {-1, 0, 1})
          nearest = std::min(nearest, norm(x - y - Vec3{0.02 * image, 0, 0}));
        return nearest;
      };
      for (const auto& other : near) ASSERT_GE(distance(other.position), (r + other.radius) * (1 - 1e-12));
      for (std::size_t b = 0; b < a; ++b) {
        ASSERT_GE(distance(entering[b].position), (r + entering[b].radius) * (1 - 1e-12));
      }
      for (int axis = 0; axis < 3; ++axis) {
        ASSERT_GE(x[axis] - r, reach.min[axis] - 1e-12);
        ASSERT_LE(x[axis] + r, reach.max[axis] + 1e-12);
      }
      if (std::holds_alternative<Box>(region)) {
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_GE(x[axis], thick.min[axis] + r * (1 - 1e-12));
          ASSERT_LE(x[axis], thick.max[axis] - r * (1 - 1e-12));
        }
      } else {
        ASSERT_NEAR(dot(x - disc.centre, disc.normal), 0, 1e-15);
        ASSERT_LE(norm(x - disc.centre) + r, 0.008 * (1 + 1e-12));
      }
    }
  }
}

TEST(Feed, SpreadsParticlesEvenlyOverADisc) {
  // One at a time, nobody near: half of the centres lie within 1/√2 of the largest distance, half on each side.
  FeedSetup setup = plate_feed(tests::glass_setup({0.02, 0.02, 0.04}, 1e-5).domain);
  setup.region = DiscRegion{{0.01, 0.01, 0.03}, {0, 0, 1}, 0.008};
  setup.by_count = true;
  setup.rate = 1;
  setup.to = 1e5;
  Feed feed(setup);
  const int count = 4000, half = count / 2;
  int within = 0, right = 0, behind = 0;
  for (int step = 1; step <= count; ++step) {
    const auto one = feed.draw(step, step, {});
    ASSERT_EQ(one.size(), 1U);
    const Vec3 out = one[0].position - Vec3{0.01, 0.01, 0.03};
    within += std::hypot(out.x, out.y) < 0.007 * std::sqrt(0.5) ? 1 : 0;
    right += out.x > 0 ? 1 : 0;
    behind += out.y > 0 ? 1 : 0;
  }
  // Four standard deviations of a binomial number: 4 √(4000/4) = 126.
  EXPECT_NEAR(within, half, 126);
  EXPECT_NEAR(right, half, 126);
  EXPECT_NEAR(behind, half, 126);
}

TEST(Feed, WaitsUntilThereIsRoom) {
  const Domain domain = tests::glass_setup({0.02, 0.02, 0.04}, 1e-5).domain;
  Feed feed(plate_feed(domain));
  const std::vector<PlacedSphere> lid{{{0.01, 0.01, 0.035}, 0.02}};
  EXPECT_TRUE(feed.draw(0.1, 0, lid).empty());
  EXPECT_EQ(feed.fed_particles(), 0);
  // 2 mg of 20 mg/s x 0.1 s, less the 10.47 µg with which the next one is due.
  EXPECT_NEAR(feed.waiting(0.1), 0.002 - mass_of(0.002), 1e-12);
  // 190 particles of 2 mm do not fit on a plate of 16 x 16 mm; those that do enter at once, the others later.
  const auto some = feed.draw(0.1, 1, {});
  EXPECT_GT(some.size(), 15u);
  EXPECT_LT(some.size(), 64u);
  for (int step = 2; step < 40; ++step) (void)feed.draw(0.1, step, {});
  EXPECT_EQ(feed.fed_particles(), static_cast<std::int64_t>(0.002 / mass_of(0.002)));
  EXPECT_EQ(feed.waiting(0.1), 0);
}

Wall block_wall(const Vec3& min, const Vec3& max) {
  Wall wall;
  wall.boxes = {{min, max}};
  return wall;
}

/// Where the particles of some outer steps enter, as long as some find a place.
std::vector<ParticleSeed> places_of(const FeedSetup& setup, const std::vector<Wall>& walls, Real wall_time) {
  Feed feed(setup);
  feed.keep_clear_of(walls);
  EXPECT_FALSE(feed.wall_without_room());
  std::vector<ParticleSeed> all;
  for (int step = 0; step < 20; ++step) {
    const auto some = feed.draw(1, step, {}, wall_time);  // nobody is there any more
    all.insert(all.end(), some.begin(), some.end());
  }
  EXPECT_GT(all.size(), 100U);
  return all;
}

TEST(Feed, KeepsClearOfWalls) {
  // The plate at z = 35 mm from 2 to 18 mm, of which a block takes x < 8 mm, and a tube around (14, 10) mm of 3 mm cuts
  // through the rest: spheres of 2 mm have their centres at 9 mm or more, and 1 mm from the tube on either side.
  FeedSetup setup = plate_feed(tests::glass_setup({0.02, 0.02, 0.04}, 1e-5).domain);
  setup.rate = 100;
  Wall tube;
  tube.revolved = {{{0.014, 0.01, 0}, {0, 0, 1}, 0.003, 0, 0.003, 0.04}};
  int within = 0, without = 0;
  for (const ParticleSeed& p : places_of(setup, {block_wall({0, 0, 0.03}, {0.008, 0.02, 0.04}), tube}, 0)) {
    ASSERT_GE(p.position.x, 0.009 - 1e-8);
    const Real out = std::hypot(p.position.x - 0.014, p.position.y - 0.01);
    ASSERT_GE(std::abs(out - 0.003), 0.001 - 1e-8);
    ++(out < 0.003 ? within : without);
  }
  EXPECT_GT(within, 5);
  EXPECT_GT(without, 50);
}

TEST(Feed, KeepsClearOfWallsThatMoveAsTheyStand) {
  // A block that swings from x < 8 mm at rest to x < 12 mm a quarter of a period later, to x < 4 mm at three quarters.
  FeedSetup setup = plate_feed(tests::glass_setup({0.02, 0.02, 0.04}, 1e-5).domain);
  setup.rate = 100;
  Wall piston = block_wall({-0.02, 0, 0.03}, {0.008, 0.02, 0.04});
  piston.motion.amplitude = {0.004, 0, 0};
  piston.motion.frequency = 10;
  for (const auto& [time, face] : {std::pair{-0.025, 0.008}, {0.025, 0.012}, {0.075, 0.004}}) {
    Real nearest = 1;
    for (const ParticleSeed& p : places_of(setup, {piston}, time))
      nearest = std::min(nearest, p.position.x - 0.001);
    EXPECT_GE(nearest, face - 1e-8);
    EXPECT_LT(nearest, face + 0.0005);  // one of more than 100 on at most 14 mm
  }
  // While it covers the whole plate nobody enters, but it leaves; one that does not swing far enough is refused.
  piston.boxes[0].max.x = 0.0185;
  Feed feed(setup);
  feed.keep_clear_of({piston});
  EXPECT_FALSE(feed.wall_without_room());
  EXPECT_TRUE(feed.draw(1, 0, {}, 0).empty());
  EXPECT_FALSE(feed.draw(1, 1, {}, 0.075).empty());
  piston.motion.amplitude.x = 0.002;
  feed.keep_clear_of({piston});
  EXPECT_EQ(feed.wall_without_room(), 0);
  // Turned by half about the middle of the box, it leaves the plate too, if particles are fed for so long.
  piston.motion = {};
  piston.motion.spin = {0, 0, M_PI};
  piston.motion.through = {0.0205, 0.01, 0};
  feed.keep_clear_of({piston});
  EXPECT_FALSE(feed.wall_without_room());
  setup.to = 0.001;
  Feed shorter(setup);
  shorter.keep_clear_of({piston});
  EXPECT_EQ(shorter.wall_without_room(), 0);
}

TEST(Feed, StaysOnItsSideOfAClosedMesh) {
  // Nine tenths of the plate are within the mesh: nobody enters in the rest, nor in the walls.
  FeedSetup setup = plate_feed(tests::glass_setup({0.02, 0.02, 0.04}, 1e-5).domain);
  setup.rate = 100;
  Wall vessel;
  MeshReport report;
  vessel.mesh = std::make_shared<TriangleMesh>(parse_stl(
      tests::binary_stl(tests::box_triangles({0.0036, 0.001, 0.02}, {0.019, 0.019, 0.039})), 1, report));
  ASSERT_TRUE(vessel.mesh->closed);
  for (const ParticleSeed& p : places_of(setup, {vessel}, 0)) ASSERT_GE(p.position.x, 0.0046 - 1e-8);
  // The other way round.
  vessel.mesh = std::make_shared<TriangleMesh>(parse_stl(
      tests::binary_stl(tests::box_triangles({0.0036, 0.001, 0.02}, {0.009, 0.019, 0.039})), 1, report));
  for (const ParticleSeed& p : places_of(setup, {vessel}, 0))
    ASSERT_TRUE(p.position.x <= 0.0026 + 1e-8 || p.position.x >= 0.010 - 1e-8) << p.position.x;
}

TEST(Feed, SaysWhichWallLeavesItNoRoom) {
  FeedSetup setup = plate_feed(tests::glass_setup({0.02, 0.02, 0.04}, 1e-5).domain);
  setup.diameter = UniformSizes{0.001, 0.003};
  const auto in_the_way = [&](const std::vector<Wall>& walls) {
    Feed feed(setup);
    feed.keep_clear_of(walls);
    return feed.wall_without_room();
  };
  const Wall floor = PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 0};
  EXPECT_FALSE(in_the_way({floor}));
  // Spheres of 3 mm stay within the plate with their centres at up to 16.5 mm: 1.5 mm from a block that ends at 15 mm.
  EXPECT_FALSE(in_the_way({floor, block_wall({0, 0, 0.03}, {0.0148, 0.02, 0.04})}));
  EXPECT_EQ(in_the_way({floor, block_wall({0, 0, 0.03}, {0.0152, 0.02, 0.04})}), 1);
  // Behind a plane, and in the middle of one.
  EXPECT_EQ(in_the_way({PlaneWall{"lid", {0, 0, 0.03}, {0, 0, -1}, {}, 0}, floor}), 0);
  EXPECT_EQ(in_the_way({PlaneWall{"lid", {0, 0, 0.035}, {0, 0, 1}, {}, 0}, floor}), 0);
}

TEST(Feed, AddedParticlesFlyLikeOthers) {
  auto setup = tests::glass_setup({1, 1, 1}, 1e-4);
  setup.gravity = {1, -2, -9.81};
  setup.later = {{0}, 0.001, 0.001, 10};
  Engine engine(setup);
  engine.set_particles({});
  advance(engine, 3);
  engine.prepare_outer_step();
  engine.add_particles({{{0.2, 0.3, 0.9}, {0.5, 0.4, -0.3}, {1, 2, 3}, 0.001, 0, false}});
  EXPECT_EQ(engine.particles().count, 1);
  advance(engine, 1000);
  engine.add_particles(
      {{{0.2, 0.3, 0.9}, {}, {}, 0.001, 0, false}, {{0.5, 0.5, 0.5}, {}, {}, 0.001, 0, true}});
  advance(engine, 1000);
  const auto all = grains(engine.particles());
  ASSERT_EQ(all.size(), 3u);
  const auto expected = [&](const Vec3& x, const Vec3& v, Real t) {
    return x + t * v + (0.5 * t * t) * setup.gravity;
  };
  // Leapfrog is exact for a constant acceleration; the acceleration at the entry may be single precision: half a step
  // of 1e-4 s x 9.81 m/s2 x 6e-8 is 3e-11 m/s.
  EXPECT_EQ(all[0].id, 0);
  EXPECT_LT(norm(all[0].position - expected({0.2, 0.3, 0.9}, {0.5, 0.4, -0.3}, 0.2)), 3e-11);
  EXPECT_EQ(all[1].id, 1);
  EXPECT_LT(norm(all[1].position - expected({0.2, 0.3, 0.9}, {}, 0.1)), 3e-11);
  EXPECT_EQ(all[2].id, 2);
  EXPECT_TRUE(all[2].fixed);
  EXPECT_EQ(all[2].position, (Vec3{0.5, 0.5, 0.5}));
  // Momentum is what entered and what gravity gave; mass is that of two, the fixed one is not moving mass.
  const auto totals = engine.compute_totals();
  const Vec3 gained = engine.entered_momentum() + engine.gravity_impulse();
  EXPECT_LT(norm(totals.momentum - gained), 1e-12 * norm(gained));
  EXPECT_NEAR(engine.entered_mass(), 2 * mass_of(0.002), 1e-18);
  EXPECT_NEAR(totals.mass, 2 * mass_of(0.002), 1e-18);
}

/// What a state is to the last bit, in the order of ids.
std::vector<Real> bits(const Engine& engine) {
  std::vector<Real> numbers;
  for (const Grain& g : grains(engine.particles())) {
    for (const Vec3& v : {g.position, g.velocity, g.spin}) {
      for (int axis = 0; axis < 3; ++axis) numbers.push_back(v[axis]);
    }
  }
  return numbers;
}

// Memory that grows must lose nothing of the particles that were there, springs of their contacts included.
TEST(Feed, WhoeverIsThereDoesNotNoticeTheOthers) {
  auto setup = tests::glass_setup({0.02, 0.02, 0.2}, 1e-5);
  setup.contacts.tangential = Mindlin{};
  setup.gravity = {2, 0, -9.81};
  tests::add_box_walls(setup);
  setup.later = {{0}, 0.001, 0.001, 5000};
  std::vector<ParticleSeed> seeds;
  seeds.reserve(60);
  for (int p = 0; p < 60; ++p) {
    const int row = p / 5 % 4, layer = p / 20;
    seeds.push_back({Vec3{0.0035 + 0.003 * (p % 5), 0.0035 + 0.003 * row, 0.0012 + 0.0021 * layer} +
                         1e-4 * tests::random_vector(5, p),
                     {},
                     {},
                     0.001,
                     0,
                     false});
  }
  Engine alone(setup), fed(setup);
  alone.set_particles(seeds);
  fed.set_particles(seeds);
  std::int64_t contacts = 0;
  for (int step = 0; step < 600; ++step) {
    // 20 resting far above, out of reach for as long as this goes on.
    if (step % 20 == 0) {
      std::vector<ParticleSeed> more;
      more.reserve(64);
      const int layer = step / 20;
      for (int p = 0; p < 64; ++p) {
        const int row = p / 8;
        more.push_back({{0.0015 + 0.0021 * (p % 8), 0.0015 + 0.0021 * row, 0.1 + 0.003 * layer},
                        {},
                        {},
                        0.001,
                        0,
                        true});
      }
      fed.add_particles(more);
    }
    for (Engine* engine : {&alone, &fed}) {
      engine->prepare_outer_step();
      advance(*engine, 10);
    }
    contacts += alone.collect_report().touching_pairs;
    (void)fed.collect_report();
  }
  EXPECT_GT(contacts, 1000);
  EXPECT_EQ(fed.particles().count, 60 + 30 * 64);
  auto of_fed = bits(fed);
  const auto of_alone = bits(alone);
  // Others shift the blocks in which the loop adds up a particle's forces: now and then a sum differs in its last bit, here
  // by 1e-17 of numbers up to 1. A lost spring gives 1e-4.
  of_fed.resize(of_alone.size());
  for (std::size_t i = 0; i < of_alone.size(); ++i) EXPECT_NEAR(of_fed[i], of_alone[i], 1e-11) << i;
}

TEST(Feed, GoesOnAfterACheckpointAsIfNothingHadHappened) {
  const tests::TemporaryFolder folder;
  auto feed_setup = plate_feed(tests::glass_setup({0.02, 0.02, 0.04}, 1e-5).domain);
  feed_setup.diameter = NormalSizes{0.002, 0.0004, 0.001, 0.003};
  feed_setup.rate = 0.1;
  const auto setup = open_box(feed_setup);
  Engine engine(setup);
  Feed feed(feed_setup);
  engine.set_particles({});
  const auto file = folder.path() / "checkpoint.h5";
  std::vector<Real> middle;
  for (int step = 0; step < 1500; ++step) {
    if (step == 900) {
      engine.canonicalise();
      core::CheckpointWriter writer(file);
      engine.save(writer);
      feed.save(writer, "feed");
      writer.close();
    }
    outer_step(engine, feed, step);
  }
  Engine resumed(setup);
  Feed resumed_feed(feed_setup);
  core::CheckpointReader reader(file);
  resumed.load(reader);
  resumed_feed.load(reader, "feed");
  for (int step = 900; step < 1500; ++step) outer_step(resumed, resumed_feed, step);
  ASSERT_GT(engine.left_through_open_sides(), 100);
  ASSERT_GT(engine.particles().count, 100);
  EXPECT_EQ(resumed.left_through_open_sides(), engine.left_through_open_sides());
  EXPECT_EQ(resumed_feed.fed_particles(), feed.fed_particles());
  const auto one = bits(engine), other = bits(resumed);
  ASSERT_EQ(one.size(), other.size());
  EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(Real)), 0);
  // What came in is here or has left: sums of a few hundred masses of 1e-5 kg, each rounded to 1e-16 of the sum.
  EXPECT_NEAR(engine.entered_mass(), engine.left_mass() + engine.compute_totals().mass,
              1e-13 * engine.entered_mass());
  EXPECT_NEAR(engine.entered_mass(), feed.fed_mass(), 1e-13 * feed.fed_mass());
  EXPECT_EQ(feed.fed_particles(), engine.left_through_open_sides() + engine.particles().count);
}

}  // namespace
}  // namespace pellicle::dem
