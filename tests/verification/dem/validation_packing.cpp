// Long: beads that fall at random and come to rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "dem/fill.hpp"
#include "tests/verification/dem/impacts.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using namespace tests;

/// Volume of a sphere between two heights.
Real volume_between(Real centre, Real radius, Real low, Real high) {
  const auto below = [&](Real height) {  // of the cap below a height
    const Real h = std::clamp(height - (centre - radius), Real(0), 2 * radius);
    return M_PI * h * h * (radius - h / 3);
  };
  return below(high) - below(low);
}

/// What a settled bed is, away from floor and surface.
struct Packing {
  Real solids_fraction;  ///< with the overlaps
  Real mean_overlap;     ///< of the contacts, over the diameter
  Real contacts;         ///< per bead
  Real mean_speed;       ///< [m/s]

  /// Of spheres that only touch: the centres drawn apart evenly.
  Real touching() const { return solids_fraction * std::pow(1 - mean_overlap, 3); }
};

/// Drops 3000 beads into a box that is endless sideways and lets them rest.
Packing pack(const ContactOptions& laws, Real friction) {
  const Real radius = 0.0015, width = 0.03;
  const int count = 3000;
  auto setup = glass_setup({width, width, 0.3}, 1.5e-5, 0.5, friction);
  setup.contacts = laws;
  setup.gravity = {0, 0, -9.81};
  setup.domain.periodic = {1, 1, 0};
  setup.domain.open_max.z = 1;
  add_box_walls(setup);
  const auto centres = fill_region(Box{{0, 0, 0}, {width, width, 0.18}}, FillPattern::random,
                                   std::vector<Real>(count, radius), 95);
  EXPECT_EQ(centres.size(), static_cast<std::size_t>(count));
  std::vector<ParticleSeed> seeds;
  for (const Vec3& x : centres) seeds.push_back({x, {}, {}, radius, 0, false});
  Engine engine(setup);
  engine.set_particles(seeds);
  for (int k = 0; k < 4000; ++k) {  // 0.6 s
    engine.prepare_outer_step();
    advance(engine, 10);
  }
  EXPECT_EQ(engine.left_through_open_sides(), 0);
  const auto all = grains(engine.particles());
  std::vector<Real> heights;
  Packing result{};
  for (const Grain& g : all) {
    heights.push_back(g.position.z);
    result.mean_speed += norm(g.velocity) / count;
  }
  std::sort(heights.begin(), heights.end());
  const Real low = 10 * radius, high = heights[heights.size() - 50] - 10 * radius;
  EXPECT_GT(high - low, 20 * radius);
  Real volume = 0, ends = 0, overlaps = 0, beads = 0;
  for (const Grain& g : all) {
    volume += volume_between(g.position.z, radius, low, high);
    if (g.position.z < low || g.position.z > high) continue;
    beads += 1;
    for (const Grain& partner : all) {
      if (partner.id == g.id) continue;
      Vec3 d = partner.position - g.position;
      d.x -= width * std::round(d.x / width);
      d.y -= width * std::round(d.y / width);
      const Real overlap = 2 * radius - norm(d);
      if (overlap <= 0) continue;
      ends += 1;
      overlaps += overlap / (2 * radius);
    }
  }
  result.solids_fraction = volume / (width * width * (high - low));
  result.mean_overlap = overlaps / ends;
  result.contacts = ends / beads;
  return result;
}

/// Checks one packing against what is known of its kind.
void check(const std::string& name, const ContactOptions& laws, Real friction, Real low, Real high,
           const std::string& why) {
  const Packing p = pack(laws, friction);
  expect_between("random packing, " + name + ": solids fraction", low, high, p.touching(),
                 why + "; " + show(p.solids_fraction) + " with overlaps, whose mean of " +
                     show(p.mean_overlap) + " d is taken out");
  record_line("random packing, " + name + ": contacts per bead", friction > 0 ? "4 to 6" : "6 (isostatic)",
              p.contacts, "overlaps of soft beads add some");
  record_line("random packing, " + name + ": mean speed left after 0.6 s [m/s]", "-", p.mean_speed,
              "at rest, or creeping");
}

ContactOptions with_memory() {
  ContactOptions laws;
  laws.tangential = Mindlin{};
  laws.rolling = NoRolling{};
  return laws;
}

TEST(RandomPacking, WithoutFrictionIsClose) {
  check("no friction", ContactOptions{}, 0, 0.635, 0.645,
        "random close packing, 0.64 (Scott & Kilgour 1969)");
}

const std::string between = "random loose to random close packing, 0.58 to 0.64, beads poured at once";

TEST(RandomPacking, WithFrictionButNoMemory) {
  check("µ 0.3, viscous_coulomb", ContactOptions{}, 0.3, 0.58, 0.64, between);
}

TEST(RandomPacking, WithFrictionAndMemory) {
  check("µ 0.3, mindlin", with_memory(), 0.3, 0.58, 0.64, between);
}

TEST(RandomPacking, WithMoreFrictionIsLooser) {
  check("µ 1, mindlin", with_memory(), 1, 0.58, 0.64, between);
}

}  // namespace
}  // namespace pellicle::dem
