// Keys of the spray: what they come to, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "tests/tools/cases_for_tests.hpp"
#include "tools/pellicle/build_spray.hpp"
#include "tools/pellicle/case_file.hpp"

namespace pellicle::tools {
namespace {

using tests::sprayed_case;

std::string errors(const std::vector<std::string>& assignments, const char* text = sprayed_case) {
  try {
    parse_case(text, "c.yaml", assignments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(CaseSpray, IsRead) {
  const CaseSpec spec = parse_case(sprayed_case, "c.yaml");
  const spray::SprayOptions options = make_spray_options(spec);
  ASSERT_EQ(options.nozzles.size(), 7U);
  EXPECT_DOUBLE_EQ(options.parcel_step, 2e-6);
  const spray::Nozzle& gun = options.nozzles[0];
  EXPECT_EQ(gun.name, "gun");
  EXPECT_DOUBLE_EQ(gun.position.z, 0.01);
  EXPECT_DOUBLE_EQ(gun.axis.y, 0.6);  // 3-4-5
  EXPECT_DOUBLE_EQ(gun.axis.z, 0.8);
  EXPECT_DOUBLE_EQ(gun.cone_angle, std::numbers::pi / 6);
  EXPECT_EQ(gun.pattern, spray::SprayPattern::full);
  EXPECT_DOUBLE_EQ(gun.radius, 5e-4);
  EXPECT_DOUBLE_EQ(gun.mass_rate, 5e-3 / 60);
  EXPECT_DOUBLE_EQ(gun.solids_fraction, 0.2);
  EXPECT_DOUBLE_EQ(std::get<Real>(gun.diameter), 30e-6);
  EXPECT_EQ(gun.droplets_per_parcel, 10);
  EXPECT_EQ(gun.density, 1050);
  EXPECT_DOUBLE_EQ(gun.temperature, 298.15);
  EXPECT_DOUBLE_EQ(gun.from, 0.01);
  EXPECT_DOUBLE_EQ(gun.to, 0.05);
  EXPECT_DOUBLE_EQ(gun.efficiency(55), 0.6);
  EXPECT_DOUBLE_EQ(gun.efficiency.surface_tension, 0.06);
  const spray::Nozzle& ring = options.nozzles[1];
  EXPECT_EQ(ring.pattern, spray::SprayPattern::hollow);
  EXPECT_DOUBLE_EQ(ring.inner_cone_angle, 0.8 * std::numbers::pi / 3);
  EXPECT_EQ(ring.to, 0.1);  // time.end
  EXPECT_EQ(ring.temperature, 293.15);
  EXPECT_EQ(ring.efficiency.points, 0);
  const auto& sizes = std::get<dem::SizeDistribution>(ring.diameter);
  EXPECT_DOUBLE_EQ(std::get<dem::LogNormalSizes>(sizes).median, 30e-6);
  EXPECT_EQ(spec.coating.solids_density, 1300);
}

TEST(CaseSpray, ContradictionsAreRefusedWithTheirPlace) {
  EXPECT_EQ(errors({}), "accepted");
  EXPECT_TRUE(says(errors({"spray.gun.axis=[0, 0, 0]"}), "spray.gun.axis: it has no length"));
  EXPECT_TRUE(says(errors({"spray.gun.inner_cone_angle=0.1"}), "only with pattern hollow"));
  EXPECT_TRUE(says(errors({"spray.ring.inner_cone_angle=2"}), "wider than cone_angle"));
  EXPECT_TRUE(says(errors({"spray.gun.to=5 ms"}), "spray.gun.to: from 0.01 to 0.005 s is no time"));
  EXPECT_TRUE(says(errors({"spray.ring.name=gun"}), "another one is called gun already"));
  EXPECT_TRUE(says(errors({"spray.gun.position=[1, 0, 0]"}), "is out of the domain"));
  EXPECT_TRUE(says(errors({"spray.gun.capture.weber=[10, 5]"}), "they do not increase"));
  EXPECT_TRUE(says(errors({"spray.gun.capture.weber=[10]"}), "2 shares for 1 Weber numbers"));
  EXPECT_TRUE(says(errors({"spray.gun.solids_fraction=2"}), "spray.gun.solids_fraction"));
  EXPECT_TRUE(
      says(errors({"spray.ring.droplet_diameter.log_normal.max=5 um"}), "max must be greater than min"));
  EXPECT_TRUE(says(
      errors({"spray=[{name: a, position: [0.5, 0.5, 0.5], speed: 1, mass_rate: 1, droplet_diameter: 1e-5}]"},
             tests::channel_case),
      "a case without particles has nothing to spray"));
  // Evaporation of droplets needs heat, a gas that feels it, and room for liquid: 0.2/150 > 1/1000.
  EXPECT_EQ(errors({}, tests::mist_case), "accepted");
  EXPECT_TRUE(says(errors({"heat.evaporation=false"}, tests::mist_case),
                   "droplets.evaporation: needs heat with evaporation"));
  EXPECT_TRUE(says(errors({"coupling.exchange=one_way"}, tests::mist_case),
                   "droplets.evaporation: the gas gives without losing"));
  EXPECT_TRUE(says(errors({"coating.solids_density=150"}, tests::mist_case),
                   "spray.gun.density: the solids in a droplet, of 150 kg/m3, leave no room"));
  // With its line.
  EXPECT_TRUE(says(errors({}, R"(domain: {min: [0, 0, 0], max: [1, 1, 1]}
time: {end: 0.1, particle_step: 1e-5}
materials: {glass: {density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.22}}
contacts: {pairs: [{between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}]}
particles: [{material: glass, list: [{position: [0.5, 0.5, 0.5], diameter: 0.01}]}]
spray:
  - {name: a, position: [0.5, 0.5, 0.5], sped: 1, mass_rate: 1, droplet_diameter: 1e-5}
)"),
                   "c.yaml:7: spray.a.sped"));
}

}  // namespace
}  // namespace pellicle::tools
