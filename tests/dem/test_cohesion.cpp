// Liquid bridges: the law against numbers worked out elsewhere with 25 digits from Willett et al. (2000), and the life of
// a bridge in the engine.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/cohesion.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

using tests::advance;
using tests::grains;

constexpr Real radius = 1e-3;  // R_w

/// F/(2π R_w γ) of a bridge of volume V* R_w³ at a gap.
Real scaled_force(Real scaled_volume, Real angle_in_degrees, Real gap) {
  const Willett law{scaled_volume * radius * radius * radius, 0.072, angle_in_degrees * M_PI / 180};
  return law.force(gap, radius) / (2 * M_PI * radius * 0.072);
}

TEST(Willett, AgreesWithTheFit) {
  // V* 1e-3 at S/R_w 0.025. The fit takes logarithms of logarithms: a few more digits than round-off.
  EXPECT_NEAR(scaled_force(1e-3, 0, 2.5e-5), 0.3122502717867136, 1e-13);
  EXPECT_NEAR(scaled_force(1e-3, 20, 2.5e-5), 0.2956662806513365, 1e-13);
  // Nearer than 1 µm, and in contact, it is as at 1 µm.
  for (const Real gap : {1e-6, 1e-9, 0.0, -1e-4}) {
    EXPECT_NEAR(scaled_force(1e-3, 0, gap), 0.9097888409662337, 1e-12);
    EXPECT_NEAR(scaled_force(1e-3, 20, gap), 0.8434217341775488, 1e-12);
  }
}

TEST(Willett, TakesTheSimpleFormForSmallBridges) {
  // V* 1e-6 at S/R_w 0.005: S⁺ = 2.5, cos θ/(1 + 2.1 × 2.5 + 10 × 6.25).
  EXPECT_NEAR(scaled_force(1e-6, 0, 5e-6), 0.01454545454545455, 1e-14);
  EXPECT_NEAR(scaled_force(1e-6, 60, 5e-6), 0.5 * 0.01454545454545455, 1e-14);
  // The two meet near V* 1e-5: within 6 %, which the paper gives for the simple form.
  EXPECT_NEAR(scaled_force(1.0001e-5, 0, 5e-6) / scaled_force(0.9999e-5, 0, 5e-6), 1, 0.06);
}

TEST(Willett, BreaksAtTheGapOfTheFit) {
  // R_w (1 + θ/2)(V*^⅓ + 0.1 V*^⅔).
  EXPECT_NEAR((Willett{1e-12, 0.072, 0}.rupture_gap(radius)), 0.101 * radius, 1e-16);
  EXPECT_NEAR((Willett{1e-12, 0.072, M_PI / 9}.rupture_gap(radius)), 0.1186278254451427 * radius, 1e-16);
  // The list reaches as far, share by share: R_w of 1 and 3 mm is 1.5 mm.
  const Willett law{1e-10, 0.072, 0.3};
  EXPECT_NEAR(bridge_reach(law, 1e-3) + bridge_reach(law, 3e-3), law.rupture_gap(1.5e-3), 1e-16);
}

/// A heavy sphere that flies off a fixed one of 1.5 mm, starting with an overlap of 0.02 mm; nothing changes its speed.
/// V* = 0.03: the bridge breaks at a gap of 0.48 mm.
struct FlyOff {
  EngineSetup setup = tests::glass_setup({0.1, 0.1, 0.1}, 1e-6, 1.0, 0.3, 0);
  std::vector<ParticleSeed> seeds;
  Willett law{1e-10, 0.072, 0};

  explicit FlyOff(Real start = 3e-3 - 2e-5, Real speed = 0.5) {
    setup.materials[0].density = 1e20;
    setup.contacts.cohesion = law;
    seeds.push_back({{0.05, 0.05, 0.05}, {}, {}, 1.5e-3, 0, true});
    seeds.push_back({{0.05, 0.05, 0.05 + start}, {0, 0, speed}, {}, 1.5e-3, 0, false});
  }
};

TEST(Bridges, LastFromTheTouchToTheRupture) {
  const FlyOff fly;
  Engine engine(fly.setup);
  engine.set_particles(fly.seeds);
  bool broken = false;
  int compared = 0;
  while (engine.substeps() < 1200) {
    advance(engine, 1);
    const auto all = grains(engine.particles());
    // The force of this substep acted before the last move.
    const Real gap = all[1].position.z - 1e-6 * all[1].velocity.z - all[0].position.z - 3e-3;
    const ContactReport report = engine.collect_report();
    const bool spans = gap < fly.law.rupture_gap(1.5e-3);
    EXPECT_EQ(report.bridges, spans ? 1 : 0) << gap;
    if (gap < 0) continue;
    const Real force = all[1].mass * all[1].acceleration.z;
    if (spans) {
      // Single precision of the acceleration, or the fourth root of the gap's round-off.
      EXPECT_NEAR(force / -fly.law.force(gap, 1.5e-3), 1, 1e-6) << gap;
      // The fixed one below is drawn up for one step of 1 µs.
      EXPECT_NEAR(report.support_impulse.z / (1e-6 * fly.law.force(gap, 1.5e-3)), 1, 1e-6) << gap;
      ++compared;
    } else {
      EXPECT_EQ(force, 0);
      broken = true;
    }
  }
  EXPECT_TRUE(broken);
  EXPECT_GT(compared, 900);
  EXPECT_GE(engine.list_builds(), 3) << "lists were to be rebuilt while the bridge lasts";
}

TEST(Bridges, FormOnlyAtATouch) {
  // It comes near, within the rupture distance, and flies by.
  FlyOff fly(3e-3 + 1e-4, 0.1);
  fly.seeds[1].velocity = {0.1, 0, 0};
  Engine engine(fly.setup);
  engine.set_particles(fly.seeds);
  for (int k = 0; k < 50; ++k) {
    advance(engine, 1);
    EXPECT_EQ(engine.collect_report().bridges, 0);
  }
  EXPECT_EQ(grains(engine.particles())[1].acceleration.z, 0);
}

TEST(Bridges, HoldASphereAgainstItsWeight) {
  // Hung from a fixed sphere, touching: F at contact against m g. Glass of 0.8 mm hangs, of 1.8 mm falls: the force grows
  // as R, the weight as R³.
  for (const Real r : {0.8e-3, 1.8e-3}) {
    auto setup = tests::glass_setup({0.1, 0.1, 0.1}, 2e-6, 0.5, 0.3, 0);
    setup.gravity = {0, 0, -9.81};
    const Willett law{1e-3 * r * r * r, 0.072 * 0.2, 0};
    setup.contacts.cohesion = law;
    Engine engine(setup);
    engine.set_particles(
        {{{0.05, 0.05, 0.05}, {}, {}, r, 0, true}, {{0.05, 0.05, 0.05 - 1.9999 * r}, {}, {}, r, 0, false}});
    const Real weight = 2500 * 4.0 / 3.0 * M_PI * r * r * r * 9.81;
    const bool hangs = law.force(0, r) > weight;
    EXPECT_EQ(hangs, r < 1e-3);
    advance(engine, 10000);
    EXPECT_EQ(engine.collect_report().bridges, hangs ? 1 : 0);
    EXPECT_EQ(grains(engine.particles())[1].position.z > 0.05 - 2.2 * r, hangs);
  }
}

}  // namespace
}  // namespace pellicle::dem
