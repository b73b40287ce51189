// The benchmark series of Chung & Ooi (Granul. Matter 13 (2011) 643), tests 1 to 3: normal impacts.
//
// Their figures were read off by others (KratosMultiphysics, DEMApplication, benchmarks 1 to 8); a point read off is
// good to about 1 % of the axis. Closed forms are held to far less.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/verification/dem/impacts.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using namespace tests;

constexpr Solid glass{4.8e10, 0.20, 2800};
constexpr Solid limestone{2e10, 0.25, 2500};
constexpr Solid aluminium{7e10, 0.30, 2699};  // of test 2; tests 6 to 8 have ν 0.33
constexpr Solid magnesium{4e10, 0.35, 1800};
constexpr Solid aluminium_oxide{3.8e11, 0.23, 4000};
constexpr Solid cast_iron{1e11, 0.25, 7000};

/// Overlap and force through an elastic normal impact.
struct History {
  std::vector<double> time, overlap, force;
  Real largest_overlap = 0, largest_force = 0, contact_time = 0;
};

History follow_normal_impact(const Solid& solid, Real radius, Real speed_each, bool pair) {
  const Real share = pair ? 0.5 : 1;
  const Real speed = pair ? 2 * speed_each : speed_each;
  const HertzImpact hertz{share * sphere_mass(solid, radius), share * wall_modulus(solid), share * radius,
                          speed};
  const Real step = hertz.contact_time() / 1000;
  EngineSetup setup;
  setup.domain.box = {{0, 0, 0}, {8 * radius, 8 * radius, 8 * radius}};
  setup.materials = {{"solid", solid.density, solid.youngs_modulus, solid.poisson_ratio, false},
                     {"floor", 0, 0, 0, true}};
  setup.pairs = {{0, 0, 1, 0, 0}, {0, 1, 1, 0, 0}};
  setup.time_step = step;
  if (!pair) setup.walls = {PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 1}};
  const Real gap = 1.5 * speed * step;
  const Real height = pair ? 3 * radius + gap : radius + gap;
  std::vector<ParticleSeed> seeds = {
      {{4 * radius, 4 * radius, height}, {0, 0, -speed_each}, {}, radius, 0, false}};
  if (pair) seeds.push_back({{4 * radius, 4 * radius, radius}, {0, 0, speed_each}, {}, radius, 0, false});
  Engine engine(setup);
  engine.set_particles(seeds);
  History history;
  Real began = 0, ended = 0, overlap = -gap;
  for (int k = 1; k < 1010; ++k) {
    const Real before = overlap;
    advance(engine, 1);
    const auto all = grains(engine.particles());
    const Real distance = pair ? all[0].position.z - all[1].position.z : all[0].position.z;
    overlap = (pair ? 2 : 1) * radius - distance;
    const Real approach = -(all[0].velocity.z - (pair ? all[1].velocity.z : 0));
    // The force of a substep is that of the position it began from.
    if (before > 0) {
      history.time.push_back((k - 1) * step);
      history.overlap.push_back(before);
      history.force.push_back(all[0].acceleration.z * all[0].mass);
    }
    if (before <= 0 && overlap > 0) began = k * step - overlap / approach;
    if (before > 0 && overlap <= 0) ended = k * step - overlap / approach;
    history.largest_overlap = std::max(history.largest_overlap, overlap);
  }
  history.largest_force = *std::max_element(history.force.begin(), history.force.end());
  history.contact_time = ended - began;
  return history;
}

TEST(ChungOoi, Tests1And2ElasticNormalImpactsAreHertzs) {
  struct Case {
    const char* name;
    Solid solid;
    Real radius, speed_each;
    bool pair;
    Real overlap, force, time;  // [µm], [N], [µs]: Hertz (1882), worked out apart from this code
  };
  // The last row of each figure: δ = (15 m* v²/(16 E* √R*))^(2/5), F = (4/3) E* √R* δ^(3/2), t = 2.943275 δ/v.
  const std::vector<Case> cases = {
      {"glass spheres", glass, 0.01, 10, true, 274.1127, 10696.889, 40.339453},
      {"limestone spheres", limestone, 0.01, 10, true, 368.30403, 7108.2413, 54.201002},
      {"aluminium alloy on a floor", aluminium, 0.1, 0.2, false, 49.717175, 11369.858, 731.65659},
      {"magnesium alloy on a floor", magnesium, 0.1, 0.2, false, 52.123288, 7232.681, 767.06586},
      {"aluminium oxide on a floor", aluminium_oxide, 0.0025, 3.9, false, 8.0888083, 615.35157, 6.1045095},
      {"soft glass spheres", {1e7, 0.25, 2505}, 0.0015, 0.5, true, 105.2526, 0.21028937, 309.78733},
      {"soft glass on a floor", {1e7, 0.25, 2505}, 0.0015, 1, false, 91.627706, 0.48311811, 269.68554},
  };
  Real overlap = 0, force = 0, time = 0;
  for (const Case& c : cases) {
    const History h = follow_normal_impact(c.solid, c.radius, c.speed_each, c.pair);
    const auto deviation = [](Real& largest, Real got, Real expected) {
      largest = std::max(largest, std::abs(got / expected - 1));
    };
    deviation(overlap, h.largest_overlap, c.overlap * 1e-6);
    deviation(force, h.largest_force, c.force);
    deviation(time, h.contact_time, c.time * 1e-6);
  }
  const std::string why =
      "Verlet at 1000 steps a contact: O((Δt/t_c)²), and up to half a step beside the peak";
  expect_small("tests 1, 2: largest overlap, 7 impacts, largest relative deviation", overlap, 5e-6, why);
  expect_small("tests 1, 2: largest force, relative deviation", force, 5e-6, why);
  expect_small("tests 1, 2: contact time, relative deviation", time, 5e-6, why);
}

/// Largest deviation of the loading branch from points of a figure, over the figure's largest force.
Real compare_loading(const History& h, const std::vector<std::pair<Real, Real>>& points,
                     const std::string& name) {
  core::CsvTable table{{"overlap [um]", "force [kN]", "force read off [kN]"}, {{}, {}, {}}};
  Real largest = 0;
  for (const auto& [overlap, force] : points) {
    std::size_t i = 0;
    while (i + 1 < h.overlap.size() && h.overlap[i] < overlap * 1e-6 && h.overlap[i + 1] > h.overlap[i]) ++i;
    const Real share = i == 0 ? 1 : (overlap * 1e-6 - h.overlap[i - 1]) / (h.overlap[i] - h.overlap[i - 1]);
    const Real got = i == 0 ? h.force[0] : h.force[i - 1] + share * (h.force[i] - h.force[i - 1]);
    const std::array<Real, 3> row = {overlap, got / 1000, force};
    for (std::size_t k = 0; k < 3; ++k) table.columns[k].push_back(row[k]);
    largest = std::max(largest, std::abs(got / 1000 - force));
  }
  keep_curve(name, table);
  return largest / points.back().second;
}

TEST(ChungOoi, Tests1And2ForceAgainstOverlap) {
  const std::vector<std::pair<Real, Real>> spheres = {
      {29.0476, 0.450281},  {54.7619, 0.968105},  {73.8095, 1.508443},  {94.2857, 2.183865},
      {109.0476, 2.701689}, {128.5714, 3.422139}, {148.0952, 4.232645}, {167.1429, 5.065666},
      {186.1905, 5.966229}, {200.9524, 6.709193}, {217.1429, 7.5197},   {231.9048, 8.285178},
      {251.4286, 9.365854}, {265.2381, 10.17636}};
  const std::vector<std::pair<Real, Real>> floor = {
      {3.00358, 0.08989},  {7.00834, 0.51685},  {12.0143, 1.30337},  {17.02026, 2.17978}, {21.02503, 3.10112},
      {25.0298, 4.02247},  {28.96305, 4.96629}, {32.03814, 5.86517}, {34.9702, 6.74157},  {37.97378, 7.57303},
      {40.97735, 8.35955}, {42.97974, 9.07865}, {44.98212, 9.68539}, {47.9857, 10.65169}};
  const std::string why =
      "their figure, read off; 1.5 % of the axis (its own deviation from Hertz is as large)";
  expect_small("test 1: force at overlap, glass, of the largest",
               compare_loading(follow_normal_impact(glass, 0.01, 10, true), spheres, "test1_glass"), 0.015,
               why);
  expect_small("test 2: force at overlap, aluminium alloy, of the largest",
               compare_loading(follow_normal_impact(aluminium, 0.1, 0.2, false), floor, "test2_aluminium"),
               0.015, why);
}

TEST(ChungOoi, Test3RestitutionOut) {
  Real deviation = 0;
  for (const Solid& solid : {aluminium_oxide, cast_iron}) {
    for (const Real e : {0.2, 0.4, 0.6, 0.8, 1.0}) {
      ImpactSeries series{solid, 0.0025};
      series.restitution = e;
      series.steps_per_contact = 2000;
      const auto after = run_impacts(series, {{{0, 0, -3.9}, {}, {}}});
      deviation = std::max(deviation, std::abs(after[0].velocity.z / 3.9 - e));
    }
  }
  expect_small("test 3: restitution out minus in, e 0.2 to 1, two solids", deviation, 5e-5,
               "scatter 0.015 at 20 steps a contact, e 0.3, falls with Δt^1.25: 5e-5 at 2000 steps");
}

}  // namespace
}  // namespace pellicle::dem
