// Droplets that hit particles push them: by hand for one, and the momentum of all together.
#include "spray/particle_push.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/checkpoint.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/spray/rig.hpp"

namespace pellicle::spray {
namespace {

using tests::needle;
using tests::Rig;

constexpr Real side = 0.02;

dem::EngineSetup periodic_box() {
  dem::EngineSetup setup = tests::glass_setup({side, side, side}, 1e-5);
  setup.domain.periodic = {1, 1, 1};
  return setup;
}

dem::ParticleSeed bead(const Vec3& position, const Vec3& velocity, Real radius = 1e-3) {
  dem::ParticleSeed seed;
  seed.position = position;
  seed.velocity = velocity;
  seed.radius = radius;
  return seed;
}

/// Droplets of 300 um, so that they matter beside the bead; all leave within the first outer step.
SprayOptions shower(int droplets, const Vec3& axis, Real speed) {
  SprayOptions options;
  options.nozzles = {needle({0.005, 0.01, 0.01}, axis, speed, 300e-6)};
  options.nozzles[0].mass_rate = droplets * 1000 * M_PI / 6 * 27e-12 / 1e-4;
  options.nozzles[0].to = 1e-4;
  options.watch_momentum = options.push_particles = true;
  return options;
}

// Four droplets of 10 m/s catch up with a bead of 0.2 m/s, all in one outer step: v' = (M v + p)/(M + m), whether the film
// weighs anything from then on or not.
TEST(ParticlePush, ABeadAndItsDropletsGoOnTogether) {
  for (const auto growth : {heat::FilmGrowth::none, heat::FilmGrowth::mass}) {
    const Vec3 velocity{0.2, 0.1, -0.3};
    Rig rig(periodic_box(), {bead({0.009, 0.01, 0.01}, velocity)}, shower(4, {1, 0, 0}, 10), 100, growth);
    rig.outer_step();
    ASSERT_EQ(rig.records()[0].hits, 4);
    const Real mass = 2500 * M_PI * 4 / 3 * 1e-9;
    const Real caught = 4 * 1000 * M_PI / 6 * 27e-12;
    const Vec3 together = (1 / (mass + caught)) * (mass * velocity + caught * Vec3{10, 0, 0});
    EXPECT_GT(together.x, velocity.x + 0.04);
    EXPECT_LT(norm(rig.engine.particles().velocity_spin(0).velocity() - together), 1e-11);
    const Vec3 given = rig.spray.momentum().to_particles;
    EXPECT_LT(norm(given - mass * (together - velocity)), 1e-11 * mass);
    const Real whole = growth == heat::FilmGrowth::mass ? mass + caught : mass;
    EXPECT_NEAR(rig.engine.particles().mass(0), whole, 1e-12 * whole);
  }
}

TEST(ParticlePush, NothingWithoutTheOptionNorOnWhatIsFixed) {
  SprayOptions options = shower(4, {1, 0, 0}, 10);
  options.push_particles = false;
  Rig left_alone(periodic_box(), {bead({0.009, 0.01, 0.01}, {0.2, 0, 0})}, options, 100);
  left_alone.outer_step();
  ASSERT_EQ(left_alone.records()[0].hits, 4);
  EXPECT_EQ(left_alone.engine.particles().velocity_spin(0).vx, 0.2);
  Rig held(periodic_box(), {tests::fixed_bead({0.009, 0.01, 0.01}, 1e-3)}, shower(4, {1, 0, 0}, 10), 100);
  held.outer_step();
  ASSERT_EQ(held.records()[0].hits, 4);
  EXPECT_EQ(norm(held.engine.particles().velocity_spin(0).velocity()), 0);
  EXPECT_EQ(norm(held.spray.momentum().to_particles), 0);
}

// A cloud of beads that collide in a dense spray, half of whose droplets bounce; no gas, no gravity. Momentum of beads, films
// and droplets: 2^-34 m/s of a parcel's mass for each hit, 1e-12 of what was injected, and the rounding of sums.
TEST(ParticlePush, MomentumIsThatOfBeadsAndDropletsTogether) {
  SprayOptions options = shower(2000, {0.6, 0, 0.8}, 10);
  options.nozzles[0].cone_angle = 2;
  options.nozzles[0].mass_rate /= 100;
  options.nozzles[0].to = 1e-2;
  options.nozzles[0].efficiency.surface_tension = 0.072;
  options.nozzles[0].efficiency.points = 1;
  options.nozzles[0].efficiency.weber[0] = 0;
  options.nozzles[0].efficiency.share[0] = 0.5;
  std::vector<dem::ParticleSeed> beads;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      beads.push_back(
          bead({0.0025 + 0.005 * i, 0.0025 + 0.005 * j, 0.013}, {0.1 * i, -0.2 * j, 0.05 * (i + j)}));
  }
  Rig rig(periodic_box(), beads, options, 10, heat::FilmGrowth::mass);
  const Vec3 before = rig.engine.compute_totals().momentum;
  const Vec3 at_first = rig.engine.grown_momentum();
  for (int k = 0; k < 150; ++k) rig.outer_step();
  const ParcelMomentum droplets = rig.spray.momentum();
  std::int64_t hits = 0;
  for (const HitRecord& record : rig.records()) hits += record.hits;
  EXPECT_GT(hits, 500);
  EXPECT_GT(norm(droplets.captured), 0.1 * norm(droplets.injected));
  const Vec3 now = rig.engine.compute_totals().momentum + droplets.in_flight;
  EXPECT_LT(norm(now - before - droplets.injected), 1e-11 * norm(droplets.injected));
  // What came with hits is what beads got and what their films have.
  const Vec3 films = rig.engine.grown_momentum() - at_first;
  const Vec3 unexplained = now - before - films - droplets.to_particles - droplets.in_flight;
  EXPECT_LT(norm(unexplained), 1e-11 * norm(droplets.injected));
}

TEST(ParticlePush, GoesOnBitForBitFromACheckpoint) {
  const tests::TemporaryFolder folder;
  SprayOptions options = shower(2000, {1, 0, 0}, 10);
  options.nozzles[0].cone_angle = 1;
  options.nozzles[0].mass_rate /= 100;
  options.nozzles[0].to = 1e-2;
  const std::vector<dem::ParticleSeed> beads{bead({0.009, 0.01, 0.01}, {0.2, 0, 0}),
                                             bead({0.013, 0.01, 0.01}, {})};
  Rig whole(periodic_box(), beads, options, 10, heat::FilmGrowth::mass);
  for (int k = 0; k < 20; ++k) whole.outer_step();
  core::CheckpointWriter out(folder / "checkpoint.h5");
  whole.engine.canonicalise();
  whole.engine.save(out);
  whole.spray.save(out);
  out.close();
  Rig resumed(periodic_box(), beads, options, 10, heat::FilmGrowth::mass);
  core::CheckpointReader in(folder / "checkpoint.h5");
  resumed.engine.load(in);
  resumed.spray.load(in);
  resumed.steps = whole.steps;
  for (int k = 0; k < 40; ++k) {
    whole.outer_step();
    resumed.outer_step();
  }
  for (Index p = 0; p < 2; ++p) {
    const auto a = whole.engine.particles().velocity_spin(p), b = resumed.engine.particles().velocity_spin(p);
    EXPECT_EQ(a.vx, b.vx);
    EXPECT_EQ(a.vz, b.vz);
  }
  EXPECT_EQ(whole.spray.momentum().to_particles.x, resumed.spray.momentum().to_particles.x);
  EXPECT_GT(whole.spray.momentum().to_particles.x, 0);
}

}  // namespace
}  // namespace pellicle::spray
