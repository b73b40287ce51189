// Particles that their coating makes larger: the radius by hand, and that the spray sees it.
#include <gtest/gtest.h>

#include <cmath>

#include "core/checkpoint.hpp"
#include "heat/film_laws.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/spray/rig.hpp"

namespace pellicle::spray {
namespace {

using tests::needle;
using tests::Rig;

constexpr Real drop = 1000 * M_PI / 6 * 27e-12;  // of 300 um [kg]

/// Forty droplets of 300 um, a fifth solids, onto the middle of a bead of 1 mm within 1 ms; from 5 ms on ten more that fly by
/// 3 um beyond the reach of the bare bead.
SprayOptions showers() {
  SprayOptions options;
  options.nozzles = {needle({0.005, 0.01, 0.01}, {1, 0, 0}, 10, 300e-6),
                     needle({0.005, 0.01 + 1e-3 + 150e-6 + 3e-6, 0.01}, {1, 0, 0}, 10, 300e-6)};
  options.nozzles[0].mass_rate = 40 * drop / 1e-3;
  options.nozzles[0].to = 1e-3;
  options.nozzles[1].mass_rate = 10 * drop / 1e-3;
  options.nozzles[1].from = 5e-3;
  options.nozzles[1].to = 6e-3;
  return options;
}

Rig rig(heat::FilmGrowth growth) {
  dem::EngineSetup setup = tests::glass_setup({0.02, 0.02, 0.02}, 1e-5);
  setup.domain.open_max = {1, 1, 1};
  std::vector<dem::ParticleSeed> seeds(2);
  seeds[0].position = {0.01, 0.01, 0.01};
  seeds[0].radius = 1e-3;
  seeds[1].position = {0.01, 0.004, 0.004};
  seeds[1].radius = 0.7e-3;
  seeds[1].fixed = true;
  return {setup, seeds, showers(), 50, growth};
}

TEST(Growth, TheRadiusByHandAndWhatMeetsIt) {
  for (const auto growth :
       {heat::FilmGrowth::none, heat::FilmGrowth::mass, heat::FilmGrowth::mass_and_radius}) {
    const bool grows = growth == heat::FilmGrowth::mass_and_radius;
    Rig r = rig(growth);
    for (int k = 0; k < 8; ++k) r.outer_step();  // 4 ms
    ASSERT_EQ(r.records()[0].hits, 40);
    const dem::Particles& particles = r.engine.particles();
    const Index bead = particles.velocity_spin(0).id == 0 ? 0 : 1;
    // 40 0.2 drop / 1250 kg/m3 of coating on 4/3 pi mm3.
    const Real volume = 40 * 0.2 * drop / 1250;
    const Real radius = grows ? std::cbrt(1e-9 + 3 * volume / (4 * M_PI)) : 1e-3;
    const Real weight = tests::glass_mass(1e-3) + (growth == heat::FilmGrowth::none ? 0 : 40 * drop);
    EXPECT_NEAR(particles.position_radius(bead).radius, radius, 1e-15);
    EXPECT_NEAR(particles.mass(bead), weight, 1e-13 * weight);
    EXPECT_EQ(particles.position_radius(1 - bead).radius, 0.7e-3);
    EXPECT_NEAR(r.surface.bare(particles).mass(bead), tests::glass_mass(1e-3), 1e-13 * weight);
    const dem::ParticleTotals totals = r.engine.compute_totals();  // of what moves
    EXPECT_NEAR(totals.volume, 4.0 / 3 * M_PI * radius * radius * radius, 1e-12 * totals.volume);
    // What outputs report, from the grown radius too.
    const Real solids = r.surface.film()(bead).solids;
    const Real thickness = std::cbrt(1e-9 + 3 * volume / (4 * M_PI)) - 1e-3;
    EXPECT_GT(thickness, 5e-6);
    EXPECT_NEAR(heat::coating_thickness(1e-3, solids, 1250), thickness, 1e-15);
    if (grows) {
      EXPECT_NEAR(heat::coating_thickness_within(radius, solids, 1250), thickness, 1e-15);
    }
    // The next ones touch the coated bead only.
    for (int k = 0; k < 8; ++k) r.outer_step();
    EXPECT_EQ(r.records()[0].hits, grows ? 50 : 40);
    EXPECT_EQ(particles.velocity_spin(bead).vx, 0);
  }
}

// A checkpoint knows the bare radius: what comes after it grows from that, bit for bit.
TEST(Growth, GoesOnFromACheckpoint) {
  const tests::TemporaryFolder folder;
  const auto fill = [](Rig& r, int steps) {
    for (int k = 0; k < steps; ++k) r.outer_step();
  };
  Rig whole = rig(heat::FilmGrowth::mass_and_radius);
  fill(whole, 1);
  EXPECT_GT(whole.records()[0].hits, 3);
  whole.engine.canonicalise();
  core::CheckpointWriter out(folder / "checkpoint.h5");
  whole.engine.save(out);
  whole.spray.save(out);
  out.close();
  Rig resumed = rig(heat::FilmGrowth::mass_and_radius);
  core::CheckpointReader in(folder / "checkpoint.h5");
  resumed.engine.load(in);
  resumed.spray.load(in);
  resumed.steps = whole.steps;
  fill(whole, 15);
  fill(resumed, 15);
  for (Index p = 0; p < 2; ++p) {
    EXPECT_EQ(whole.engine.particles().position_radius(p).radius,
              resumed.engine.particles().position_radius(p).radius);
    EXPECT_EQ(whole.engine.particles().mass(p), resumed.engine.particles().mass(p));
  }
  EXPECT_EQ(whole.records()[0].hits, 50);
}

}  // namespace
}  // namespace pellicle::spray
