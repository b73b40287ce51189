// Parcels among particles and walls: who is hit, when, and that nothing is lost.
#include "spray/spray.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "core/random.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/dem/meshes.hpp"
#include "tests/spray/rig.hpp"

namespace pellicle::spray {
namespace {

using tests::fixed_bead;
using tests::needle;
using tests::Rig;

/// All sides open, nothing but what the test puts in.
dem::EngineSetup open_box(const Vec3& size, Real time_step = 1e-5) {
  dem::EngineSetup setup = tests::glass_setup(size, time_step);
  setup.domain.open_min = setup.domain.open_max = {1, 1, 1};
  return setup;
}

SprayOptions spray_of(std::vector<Nozzle> nozzles) {
  SprayOptions options;
  options.nozzles = std::move(nozzles);
  return options;
}

/// Injected = captured + wall loss + overspray + in flight, and what was captured is on the particles.
void expect_balance(const Rig& rig) {
  Real liquid = 0;
  Real solids = 0;
  for (const NozzleFigures& f : rig.spray.figures()) {
    ASSERT_NEAR(f.captured + f.wall_loss + f.overspray + f.in_flight, f.injected, 1e-13 * f.injected);
    liquid += (1 - f.solids_fraction) * f.captured;
    solids += f.solids_fraction * f.captured;
  }
  const heat::SurfaceTotals totals = rig.surface.compute_totals();
  const heat::Film left = rig.surface.left().film;
  ASSERT_NEAR(totals.film.liquid + left.liquid, liquid, 1e-13 * liquid);
  ASSERT_NEAR(totals.film.solids + left.solids, solids, 1e-13 * solids);
}

TEST(Spray, NeverTunnelsAt100MetresPerSecond) {
  // A bead of 0.25 mm and droplets that go 1 mm a substep: hit if and only if they are aimed at R + r.
  const Real radius = 0.25e-3;
  const Real reach = radius + 15e-6;
  const Vec3 centre{0.0153, 0.01, 0.01};
  std::vector<Nozzle> nozzles;
  std::vector<bool> aimed;
  for (int n = 0; n < 80; ++n) {
    const Real angle = 2.399 * n;
    const Real beside = reach * (n < 8 ? 0.9999 : (n < 16 ? 1.0001 : 1.5 * (n - 16) / 64.0));
    nozzles.push_back(
        needle({1e-3, 0.01 + beside * std::cos(angle), 0.01 + beside * std::sin(angle)}, {1, 0, 0}, 100));
    nozzles.back().to = 1e-4;
    nozzles.back().mass_rate *= 1 + 0.01 * n;  // all phases of a substep
    aimed.push_back(beside < reach);
  }
  for (const int stride : {1, 3}) {
    SprayOptions options = spray_of(nozzles);
    options.parcel_step = stride * 1e-5;
    Rig rig(open_box({0.02, 0.02, 0.02}), {fixed_bead(centre, radius)}, options);
    for (int k = 0; k < 4; ++k) rig.outer_step();
    const auto figures = rig.spray.figures();
    for (std::size_t n = 0; n < nozzles.size(); ++n) {
      ASSERT_GE(figures[n].parcels, 10);
      EXPECT_EQ(figures[n].in_flight, 0);
      EXPECT_EQ(figures[n].captured, aimed[n] ? figures[n].injected : 0) << n;
    }
    expect_balance(rig);
  }
}

TEST(Spray, MovesEverySubstepUnlessItsPathStaysShorterThanARadius) {
  const Real radius = 0.25e-3;
  for (const auto& [speed, stride] : {std::pair<Real, int>{100, 1}, {20, 1}, {12, 2}, {5, 5}, {0.1, 10}}) {
    Rig rig(open_box({0.02, 0.02, 0.02}), {fixed_bead({0.015, 0.01, 0.01}, radius)},
            spray_of({needle({1e-3, 0.01, 0.01}, {1, 0, 0}, speed)}));
    rig.outer_step();
    EXPECT_EQ(rig.spray.stride(), stride) << speed;
  }
}

TEST(Spray, AParticleThatComesTowardsADropletMeetsItWhenItShould) {
  // The bead flies at -5 m/s, the droplet at 1 m/s: they meet when gap - 5 t = 1 (t - born).
  const Real radius = 1e-3;
  dem::ParticleSeed bead;
  bead.position = {0.012, 0.01, 0.01};
  bead.velocity = {-5, 0, 0};
  bead.radius = radius;
  Nozzle nozzle = needle({0.002, 0.01, 0.01}, {1, 0, 0}, 1);
  nozzle.mass_rate *= 0.0001;  // 10 a second
  nozzle.mass_rate *= 100;     // 1000 a second: the first is born after 0.5 ms
  for (const int substeps : {10, 7}) {
    Rig rig(open_box({0.02, 0.02, 0.02}), {bead}, spray_of({nozzle}), substeps);
    while (rig.time() < 2e-3) rig.outer_step();
    const Real gap = 0.01 - radius - 15e-6;
    const Real expected = (gap + 0.5e-3) / 6;
    ASSERT_GE(rig.records()[0].hits, 1);
    // Hardly more than rounding: the bead's velocity does not change.
    EXPECT_NEAR(rig.records()[0].first_hit, expected, 1e-12);
    EXPECT_GE(rig.records()[0].last_hit, rig.records()[0].first_hit);
  }
}

TEST(Spray, ADropletMeetsAParticleWithinTheMoveThatItIsBornIn) {
  // Born 5 us after the beginning, at 1 m/s, before a bead that comes at -5 m/s from 40 um: 40 um - 5 t = t - 5 us.
  dem::ParticleSeed bead;
  bead.radius = 1e-3;
  bead.position = {0.005 + bead.radius + 15e-6 + 40e-6, 0.01, 0.01};
  bead.velocity = {-5, 0, 0};
  Rig rig(open_box({0.02, 0.02, 0.02}), {bead}, spray_of({needle({0.005, 0.01, 0.01}, {1, 0, 0}, 1)}));
  rig.outer_step();
  EXPECT_NEAR(rig.records()[0].first_hit, 7.5e-6, 1e-13);
}

TEST(Spray, OfTwoAtTheSameMomentTheLowerIdIsHit) {
  // Mirror images about the path, the one with the lower id at either side.
  const Real radius = 1e-3;
  for (const Real side : {1.0, -1.0}) {
    Rig rig(open_box({0.02, 0.02, 0.02}),
            {fixed_bead({0.012, 0.01 + side * 0.0009765625, 0.01}, radius),
             fixed_bead({0.012, 0.01 - side * 0.0009765625, 0.01}, radius)},
            spray_of({needle({0.002, 0.01, 0.01}, {1, 0, 0}, 50)}));
    for (int k = 0; k < 5; ++k) rig.outer_step();
    EXPECT_GT(rig.records()[0].hits, 10);
    EXPECT_EQ(rig.records()[1].hits, 0);
  }
}

TEST(Spray, TheFirstOfSeveralOnThePathIsHit) {
  const Real radius = 0.2e-3;
  // Three beads behind each other within one substep's path, in any order of ids.
  Rig rig(open_box({0.02, 0.02, 0.02}),
          {fixed_bead({0.0130, 0.01, 0.01}, radius), fixed_bead({0.0120, 0.01, 0.01}, radius),
           fixed_bead({0.0125, 0.01, 0.01}, radius)},
          spray_of({needle({0.002, 0.01, 0.01}, {1, 0, 0}, 200)}));
  for (int k = 0; k < 5; ++k) rig.outer_step();
  EXPECT_EQ(rig.records()[0].hits, 0);
  EXPECT_GT(rig.records()[1].hits, 10);
  EXPECT_EQ(rig.records()[2].hits, 0);
}

TEST(Spray, MeanFreePathInARandomArrayOfSpheres) {
  // A broad parallel beam through beads that are placed without regard for each other (Poisson): a droplet that flies a
  // way x without being caught has swept a cylinder of radius R + r with rounded ends that holds no centre, which has the
  // probability exp(-n (pi (R + r)^2 x + 4/3 pi (R + r)^3)): the mean free path is 1/(n pi (R + r)^2).
  const Real reach = 0.5e-3;
  const Real free_path = 0.02;
  const Real number_density = 1 / (M_PI * reach * reach * free_path);
  const Vec3 size{0.04, 0.04, 0.034};
  const auto count = static_cast<int>(std::lround(number_density * size.x * size.y * 0.032));
  const int arrays = 40;
  const int depths = 4;  // 5, 10, 15, 20 mm
  std::vector<Real> sum(depths, 0);
  std::vector<Real> squares(depths, 0);
  for (int array = 0; array < arrays; ++array) {
    std::vector<dem::ParticleSeed> beads;
    for (int n = 0; n < count; ++n) {
      const Vec3 u = core::random_uniform3(91, core::Purpose::test, array, n);
      beads.push_back(fixed_bead({u.x * size.x, u.y * size.y, 0.001 + u.z * 0.032}, reach - 15e-6));
    }
    // The beam stays within the array: 5 mm from its sides, from 6 to 26 mm of its 33. 2000 parcels in a microsecond.
    Nozzle nozzle = needle({0.02, 0.02, 0.006}, {0, 0, 1}, 50);
    nozzle.radius = 0.015;
    nozzle.mass_rate *= 2e4;
    nozzle.to = 1e-6;
    SprayOptions options = spray_of({nozzle});
    options.seed = static_cast<std::uint64_t>(array);
    Rig rig(open_box(size), beads, options);
    for (std::size_t k = 0; k < depths; ++k) {
      rig.outer_step();
      const NozzleFigures f = rig.spray.figures()[0];
      ASSERT_EQ(f.parcels, 2000);
      ASSERT_EQ(f.overspray, 0);
      const Real survived = f.in_flight / f.injected;
      sum[k] += survived;
      squares[k] += survived * survived;
    }
    expect_balance(rig);
  }
  for (std::size_t k = 0; k < depths; ++k) {
    const Real mean = sum[k] / arrays;
    // The error of the mean, as the arrays scatter.
    const Real error = std::sqrt((squares[k] / arrays - mean * mean) / (arrays - 1));
    const Real way = 50 * (static_cast<Real>(k + 1) * 1e-4 - 0.5e-6);
    const Real expected = std::exp(-(way + 4.0 / 3 * reach) / free_path);
    EXPECT_LT(error, 0.01 * mean);
    EXPECT_NEAR(mean, expected, 3 * error) << way;
  }
}

TEST(Spray, NothingIsCapturedThroughTheWallOfADraftTube) {
  // A thin tube with beads pressed into its outside (soft ones reach a little through it) and one bead inside; the nozzle
  // at its axis sprays to all sides.
  const Real tube = 5e-3;
  const Real radius = 0.5e-3;
  dem::EngineSetup setup = open_box({0.02, 0.02, 0.03});
  dem::Wall wall;
  wall.name = "tube";
  wall.material = 1;
  wall.revolved = {{{0.01, 0.01, 0.005}, {0, 0, 1}, tube, 0, tube, 0.02}};
  for (const bool mesh : {false, true}) {
    if (mesh) {
      auto triangles = tests::tube_triangles(tube, 0, 0.02, 48);
      for (dem::TriangleShape& t : triangles) {
        for (Vec3* c : {&t.a, &t.b, &t.c}) *c = {0.01 + c->z, 0.01 + c->x, 0.005 + c->y};
      }
      wall.revolved.clear();
      wall.mesh = tests::loose_mesh(triangles);
    }
    setup.walls = {wall};
    std::vector<dem::ParticleSeed> beads;
    for (int n = 0; n < 60; ++n) {
      const Real angle = 2 * M_PI * (n + 0.5) / 15;  // at the middle of facets and elsewhere
      const int row = n / 15;
      const Real out = tube + 0.9 * radius;
      beads.push_back(fixed_bead(
          {0.01 + out * std::cos(angle), 0.01 + out * std::sin(angle), 0.008 + 0.003 * row}, radius));
    }
    beads.push_back(fixed_bead({0.012, 0.01, 0.014}, radius));
    Nozzle nozzle = needle({0.01, 0.01, 0.012}, {0, 0, 1}, 50);
    nozzle.cone_angle = 2 * M_PI;
    nozzle.mass_rate *= 20;
    nozzle.to = 2e-3;
    Rig rig(setup, beads, spray_of({nozzle}));
    while (rig.time() < 4e-3) rig.outer_step();
    const auto records = rig.records();
    for (int n = 0; n < 60; ++n) EXPECT_EQ(records[static_cast<std::size_t>(n)].hits, 0) << n;
    EXPECT_GT(records[60].hits, 10);
    const NozzleFigures f = rig.spray.figures()[0];
    EXPECT_EQ(f.in_flight, 0);
    // Without the bead: within the tube's end, 13 mm above the nozzle, as seen from it, 1 - 13/13.93 of all go out; down
    // 7 mm, 1 - 7/8.60; each of the two solid angles over 4 pi is half of that.
    EXPECT_NEAR(f.wall_loss / f.injected,
                1 - 0.5 * (1 - 13 / std::hypot(13, 5)) - 0.5 * (1 - 7 / std::hypot(7, 5)), 0.03);
    expect_balance(rig);
  }
}

/// A shallow bed in a box with an open top, sprayed from above and from a side, in a rising gas.
dem::EngineSetup bed_setup() {
  dem::EngineSetup setup = tests::glass_setup({0.02, 0.02, 0.03}, 1e-5);
  setup.domain.open_max = {0, 0, 1};
  setup.gravity = {0, 0, -9.81};
  tests::add_box_walls(setup);
  // A plate that swings.
  dem::Wall plate;
  plate.name = "plate";
  plate.material = 1;
  plate.revolved = {{{0.01, 0.01, 0.022}, {0, 0, 1}, 0, 0, 3e-3, 0}};
  plate.motion.amplitude = {0, 0, 1e-3};
  plate.motion.frequency = 200;
  setup.walls.push_back(plate);
  return setup;
}

std::vector<dem::ParticleSeed> bed_particles() {
  std::vector<dem::ParticleSeed> seeds;
  const auto centres =
      tests::scatter({{0.001, 0.001, 0.001}, {0.019, 0.019, 0.019}}, std::vector<Real>(300, 0.0008), 0, 61);
  for (std::size_t p = 0; p < centres.size(); ++p) {
    seeds.push_back({centres[p], tests::random_vector(62, static_cast<int>(p)), {}, 0.0008, 0, false});
  }
  return seeds;
}

SprayOptions bed_spray() {
  Nozzle above = needle({0.005, 0.005, 0.025}, {0, 0, -1}, 10);
  above.cone_angle = 1;
  above.radius = 1e-3;
  above.mass_rate *= 4;
  Nozzle below = needle({0.01, 0.01, 0.02}, {0, 0, 1}, 40);
  below.name = "other";
  below.pattern = SprayPattern::hollow;
  below.cone_angle = 1.2;
  below.inner_cone_angle = 0.8;
  below.solids_fraction = 0.1;
  below.diameter = dem::SizeDistribution(dem::LogNormalSizes{20e-6, 1.4, 8e-6, 60e-6});
  SprayOptions options = spray_of({above, below});
  options.gravity = {0, 0, -9.81};
  return options;
}

TEST(Spray, EveryGramIsSomewhereAtEveryStep) {
  Rig rig(bed_setup(), bed_particles(), bed_spray());
  rig.blow({0, 0, 12});
  for (int k = 0; k < 150; ++k) {
    rig.outer_step();
    expect_balance(rig);
  }
  const auto figures = rig.spray.figures();
  Real ends[4] = {0, 0, 0, 0};
  for (const NozzleFigures& f : figures) {
    ends[0] += f.captured;
    ends[1] += f.wall_loss;
    ends[2] += f.overspray;
    ends[3] += f.in_flight;
  }
  for (const Real end : ends) EXPECT_GT(end, 0.001 * (figures[0].injected + figures[1].injected));
}

TEST(Spray, GoesOnBitForBitFromACheckpoint) {
  const tests::TemporaryFolder folder;
  const auto path = folder / "state.h5";
  Rig whole(bed_setup(), bed_particles(), bed_spray());
  whole.blow({0, 0, 12});
  for (int k = 0; k < 40; ++k) whole.outer_step();
  whole.engine.canonicalise();
  {
    core::CheckpointWriter file(path);
    whole.engine.save(file);
    whole.spray.save(file);
    file.close();
  }
  Rig resumed(bed_setup(), {}, bed_spray());
  resumed.blow({0, 0, 12});
  {
    core::CheckpointReader file(path);
    resumed.engine.load(file);
    resumed.spray.load(file);
  }
  resumed.steps = whole.steps;
  for (int k = 0; k < 40; ++k) {
    whole.outer_step();
    resumed.outer_step();
  }
  expect_balance(resumed);
  ASSERT_EQ(whole.spray.parcels().count, resumed.spray.parcels().count);
  ASSERT_GT(whole.spray.parcels().count, 100);
  for (Index i = 0; i < whole.spray.parcels().count; ++i) {
    const ParcelState& a = whole.spray.parcels().state(i);
    const ParcelState& b = resumed.spray.parcels().state(i);
    ASSERT_TRUE(a.position == b.position && a.velocity == b.velocity && a.droplets == b.droplets);
    ASSERT_EQ(whole.spray.parcels().name(i).number, resumed.spray.parcels().name(i).number);
  }
  for (Index p = 0; p < whole.engine.particles().count; ++p) {
    ASSERT_EQ(whole.surface.film()(p).liquid, resumed.surface.film()(p).liquid);
    ASSERT_EQ(whole.spray.hit_record()(p).last_hit, resumed.spray.hit_record()(p).last_hit);
  }
  const auto a = whole.spray.figures();
  const auto b = resumed.spray.figures();
  for (std::size_t n = 0; n < a.size(); ++n) {
    EXPECT_EQ(a[n].captured, b[n].captured);
    EXPECT_EQ(a[n].wall_loss, b[n].wall_loss);
    EXPECT_EQ(a[n].overspray, b[n].overspray);
    EXPECT_EQ(a[n].in_flight, b[n].in_flight);
  }
}

TEST(Spray, CrossesPeriodicSidesAndIsMetBeyondThem) {
  dem::EngineSetup setup = open_box({0.02, 0.02, 0.02});
  setup.domain.periodic = {1, 0, 0};
  const Real radius = 0.5e-3;
  // Just beyond the right side, as an image of a bead at the left; and one that is met from the other side.
  for (const Real direction : {1.0, -1.0}) {
    const Real bead = direction > 0 ? 0.2e-3 : 0.0198;
    Rig rig(setup, {fixed_bead({bead, 0.01, 0.01}, radius)},
            spray_of({needle({0.01, 0.01, 0.01}, {direction, 0, 0}, 70)}));
    for (int k = 0; k < 4; ++k) rig.outer_step();
    EXPECT_GT(rig.records()[0].hits, 5);
    // 0.01 + 0.2 mm - R - r, at 70 m/s, first one born after 5 us.
    EXPECT_NEAR(rig.records()[0].first_hit, 5e-6 + (0.01 + 0.2e-3 - radius - 15e-6) / 70, 1e-12);
    // Without the bead in the way, a wall beyond the side is met as well.
    dem::Wall disc;
    disc.revolved = {{{direction > 0 ? 0.3e-3 : 0.0197, 0.01, 0.01}, {1, 0, 0}, 0, 0, 1e-3, 0}};
    dem::EngineSetup walled = setup;
    walled.walls = {disc};
    walled.walls[0].material = 1;
    Rig other(walled, {fixed_bead({0.01, 0.002, 0.002}, radius)},
              spray_of({needle({0.01, 0.01, 0.01}, {direction, 0, 0}, 70)}));
    for (int k = 0; k < 4; ++k) other.outer_step();
    EXPECT_GT(other.spray.figures()[0].wall_loss, 0);
    EXPECT_EQ(other.spray.figures()[0].overspray, 0);
    EXPECT_LE(static_cast<Real>(other.spray.parcels().count), 1e5 * (0.0103 / 70) + 1);
  }
}

TEST(Spray, APathBeyondAPeriodicSideMeetsNoWallThatIsNotOnIt) {
  // From 0.015 over the side at 0.02 to a bead at 0.004, steps of 0.7 mm. The wall at 0.008 is behind the bead as the droplet
  // sees it, that at 0.013 behind the nozzle: neither is on the way, though both lie between the ends as the box counts.
  for (const int axis : {0, 1, 2}) {
    dem::EngineSetup setup = open_box({0.02, 0.02, 0.02});
    setup.domain.periodic[axis] = 1;
    const auto along = [&](Real x) {
      Vec3 place{0.01, 0.01, 0.01};
      place[axis] = x;
      return place;
    };
    for (const Real at : {0.008, 0.013}) {
      dem::Wall disc;
      Vec3 normal{0, 0, 0};
      normal[axis] = 1;
      disc.revolved = {{along(at), normal, 0, 0, 3e-3, 0}};
      disc.material = 1;
      setup.walls.push_back(disc);
    }
    Vec3 direction{0, 0, 0};
    direction[axis] = 1;
    const Real radius = 0.5e-3;
    Rig rig(setup, {fixed_bead(along(0.004), radius)}, spray_of({needle(along(0.015), direction, 70)}));
    for (int k = 0; k < 4; ++k) rig.outer_step();
    EXPECT_EQ(rig.spray.figures()[0].wall_loss, 0) << axis;
    EXPECT_NEAR(rig.records()[0].first_hit, 5e-6 + (0.009 - radius - 15e-6) / 70, 1e-12);
    // Without the bead the wall at 0.008 is met after 13 mm, and not before: 13e-3 / 70 * 1e5 = 18.6 parcels fly.
    Rig other(setup, {fixed_bead({0.002, 0.002, 0.002}, radius)},
              spray_of({needle(along(0.015), direction, 70)}));
    for (int k = 0; k < 4; ++k) other.outer_step();
    EXPECT_GE(other.spray.parcels().count, 18) << axis;
    EXPECT_LE(other.spray.parcels().count, 19) << axis;
    EXPECT_GT(other.spray.figures()[0].wall_loss, 0);
  }
}

TEST(Spray, DropletsThatDoNotStayBounceLikeFromAMirror) {
  // Head-on at a large bead, half of them stay: those that do not come back and leave through the side they came from.
  Nozzle nozzle = needle({0.002, 0.01, 0.01}, {1, 0, 0}, 50);
  nozzle.efficiency.points = 2;
  nozzle.efficiency.surface_tension = 0.072;
  nozzle.efficiency.weber[0] = 0;
  nozzle.efficiency.weber[1] = 1e6;
  nozzle.efficiency.share[0] = nozzle.efficiency.share[1] = 0.3;
  nozzle.mass_rate *= 10;
  nozzle.to = 2e-3;
  Rig rig(open_box({0.02, 0.02, 0.02}), {fixed_bead({0.012, 0.01, 0.01}, 5e-3)}, spray_of({nozzle}));
  while (rig.time() < 2.5e-3) rig.outer_step();
  const NozzleFigures f = rig.spray.figures()[0];
  EXPECT_EQ(f.in_flight, 0);
  EXPECT_EQ(f.wall_loss, 0);
  // 2000 parcels: the standard deviation of the share is 0.0102.
  EXPECT_EQ(f.parcels, 2000);
  EXPECT_NEAR(f.captured / f.injected, 0.3, 0.04);
  expect_balance(rig);
  // Slow ones stay, fast ones do not: We = 1000 v^2 30e-6 / 0.072 is 1042 at 50 m/s and 0.42 at 1 m/s.
  nozzle.efficiency.weber[0] = 10;
  nozzle.efficiency.weber[1] = 100;
  nozzle.efficiency.share[0] = 1;
  nozzle.efficiency.share[1] = 0;
  for (const Real speed : {50.0, 1.0}) {
    nozzle.speed = speed;
    Rig other(open_box({0.02, 0.02, 0.02}), {fixed_bead({0.012, 0.01, 0.01}, 5e-3)}, spray_of({nozzle}));
    while (other.time() < 12e-3) other.outer_step();
    const NozzleFigures figures = other.spray.figures()[0];
    EXPECT_EQ(figures.captured, speed > 10 ? 0 : figures.injected);
  }
}

TEST(Spray, AnObliqueBounceKeepsTheSpeedAndReversesTheNormal) {
  // R + r = 5 mm, path 3 mm aside: 3-4-5, so the normal is (-0.8, 0.6) and (1, 0) goes to (-0.28, 0.96).
  Nozzle nozzle = needle({0.002, 0.013, 0.01}, {1, 0, 0}, 50);
  nozzle.efficiency.points = 1;
  nozzle.efficiency.surface_tension = 0.072;
  nozzle.to = 1e-4;
  Rig rig(open_box({0.02, 0.02, 0.02}), {fixed_bead({0.012, 0.01, 0.01}, 5e-3 - 15e-6)}, spray_of({nozzle}));
  for (int k = 0; k < 3; ++k) rig.outer_step();
  ASSERT_EQ(rig.spray.parcels().count, 10);
  for (Index i = 0; i < 10; ++i) {
    const ParcelState& p = rig.spray.parcels().state(i);
    EXPECT_NEAR(p.velocity.x, -0.28 * 50, 1e-10);
    EXPECT_NEAR(p.velocity.y, 0.96 * 50, 1e-10);
    EXPECT_NEAR(p.velocity.z, 0, 1e-10);
  }
}

TEST(Spray, DropletsFollowTheGasOfTheirCell) {
  // From rest: v = u (1 - e^(-t/tau)) with the drag of Schiller & Naumann; 5 um relax in 0.08 ms, so after 2 ms they go with the
  // gas and fall with 18 mu w = rho d^2 g.
  SprayOptions options = spray_of({needle({0.01, 0.0095, 0.01}, {1, 0, 0}, 1e-6, 5e-6)});
  options.gravity = {0, 0, -9.81};
  Rig rig(open_box({0.02, 0.02, 0.02}), {fixed_bead({0.001, 0.001, 0.001}, 5e-4)}, options);
  rig.blow({0, 2, 0});
  // Another gas in the upper half of y.
  for (Index c = 0; c < 8; ++c) {
    if ((c / 2) % 2 == 1) rig.gas.velocity(c) = {0, 0, 3};
  }
  for (int k = 0; k < 20; ++k) rig.outer_step();
  const ParcelState& first = rig.spray.parcels().state(0);
  EXPECT_GT(first.position.y, 0.01);
  EXPECT_NEAR(first.velocity.y, 0, 1e-6);
  const Real fall = 1000 * 25e-12 * 9.81 / (18 * 1.8e-5);
  // Its slip's Reynolds number is 2.5e-4: 0.15 Re^0.687 is 0.0005.
  EXPECT_NEAR(first.velocity.z, 3 - fall, 1e-3 * fall);
}

TEST(Spray, GasIsThatOfTheCellOnTheDropletsOwnSideOfAThinWall) {
  // Two cells along x, 0 to 1 and 1 to 2; a thin wall at x = 0.75 leaves the right end of the first cell to the second.
  ParcelGas gas;
  gas.grid = coupling::GridLocator(CartesianGrid(Box{{0, 0, 0}, {2, 1, 1}}, {2, 1, 1}));
  EXPECT_EQ(gas.cell_of({0.9, 0.5, 0.5}), 0);
  gas.cut.volume = DeviceArray<Real>("tests::spray::volume", 2);
  gas.cut.nearest_open = DeviceArray<Index>("tests::spray::nearest_open", 2);
  gas.cut.walls_begin = DeviceArray<Index>("tests::spray::walls_begin", 3);
  gas.cut.walls = DeviceArray<coupling::ThinWall>("tests::spray::walls", 1);
  gas.cut.nearest_open(1) = 1;
  gas.cut.walls_begin(1) = gas.cut.walls_begin(2) = 1;
  gas.cut.walls(0) = {{0.75, 0, 0}, {-1, 0, 0}, 1};
  EXPECT_EQ(gas.cell_of({0.7, 0.5, 0.5}), 0);
  EXPECT_EQ(gas.cell_of({0.9, 0.5, 0.5}), 1);
  EXPECT_EQ(gas.cell_of({1.1, 0.5, 0.5}), 1);
}

TEST(Spray, CapturedDropletsMixWithTheParticleAtTheGasTemperature) {
  const Real radius = 0.2e-3;
  Nozzle nozzle = needle({0.002, 0.01, 0.01}, {1, 0, 0}, 50);
  nozzle.temperature = 290;
  nozzle.mass_rate *= 100;
  nozzle.to = 1e-4;
  Rig rig(open_box({0.02, 0.02, 0.02}), {fixed_bead({0.012, 0.01, 0.01}, radius)}, spray_of({nozzle}));
  rig.blow({50, 0, 0});
  rig.gas_temperature = DeviceArray<Real>("tests::spray::gas_temperature", 8);
  Kokkos::deep_copy(rig.gas_temperature, 350.0);
  for (int k = 0; k < 5; ++k) rig.outer_step();
  const NozzleFigures f = rig.spray.figures()[0];
  ASSERT_EQ(f.captured, f.injected);
  ASSERT_EQ(f.parcels, 1000);
  // Glass of 840 J/kg/K at 300 K, and 0.8 of the droplets water (4186), 0.2 solids (1000), at 350 K.
  const Real glass = 840 * 2500 * 4.0 / 3 * M_PI * std::pow(radius, 3);
  const Real drops = f.injected * (0.8 * 4186 + 0.2 * 1000);
  EXPECT_NEAR(rig.surface.temperature()(0), (glass * 300 + drops * 350) / (glass + drops), 1e-9);
  EXPECT_NEAR(rig.spray.heat().free_heat, drops * 60, 1e-12 * drops * 60);
  EXPECT_NEAR(rig.spray.heat().enthalpy, drops * (350 - 273.15), 1e-12 * drops * 77);
  // What the particle has more is what was brought.
  EXPECT_NEAR(rig.surface.compute_totals().enthalpy, glass * (300 - 273.15) + rig.spray.heat().enthalpy,
              1e-12 * glass * 30);
}

TEST(Spray, HitsAreSortedByParticleNozzleAndNumber) {
  for (const Index count : {0, 1, 31, 32, 33, 64, 100, 1000, 5000}) {
    HitList list;
    list.reserve(count);
    std::vector<Hit> expected;
    for (Index i = 0; i < count; ++i) {
      const core::RandomWords words = core::random_words(5, core::Purpose::test, count, i);
      Hit hit;
      hit.id = static_cast<std::int32_t>(words.word[0] % 50);
      hit.nozzle = static_cast<std::int32_t>(words.word[1] % 3);
      hit.number = i;
      list.hits()(i) = hit;
      expected.push_back(hit);
    }
    std::sort(expected.begin(), expected.end(), [](const Hit& a, const Hit& b) {
      return std::tie(a.id, a.nozzle, a.number) < std::tie(b.id, b.nozzle, b.number);
    });
    list.sort(count);
    for (Index i = 0; i < count; ++i) {
      const Hit& hit = list.hits()(i);
      const Hit& e = expected[static_cast<std::size_t>(i)];
      ASSERT_TRUE(hit.id == e.id && hit.nozzle == e.nozzle && hit.number == e.number) << count << " " << i;
    }
  }
}

}  // namespace
}  // namespace pellicle::spray
