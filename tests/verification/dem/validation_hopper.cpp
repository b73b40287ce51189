// Long: a flat-bottomed hopper against Beverloo's law.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "dem/fill.hpp"
#include "tests/verification/dem/impacts.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using namespace tests;

constexpr Real g = 9.81;
constexpr Real radius = 0.005, d = 2 * radius, vessel = 9 * d, middle = 10 * d, floor_height = 3 * d,
               height = 40 * d;

EngineSetup hopper_setup() {
  auto setup = glass_setup({2 * middle, 2 * middle, floor_height + height}, 4e-5, 0.5, 0.5, 0);
  setup.contacts.tangential = Mindlin{};
  setup.contacts.rolling = NoRolling{};
  setup.gravity = {0, 0, -g};
  setup.domain.open_min.z = setup.domain.open_max.z = 1;
  return setup;
}

/// A cylinder and its floor with a hole of a radius, which may be zero.
Wall hopper_wall(Real hole) {
  Wall wall;
  wall.name = "hopper";
  wall.material = 1;
  const Vec3 origin{middle, middle, floor_height}, up{0, 0, 1};
  wall.revolved = {{origin, up, vessel, 0, vessel, height}, {origin, up, hole, 0, vessel, 0}};
  return wall;
}

void run(Engine& engine, Real duration) {
  const auto outer = static_cast<int>(std::lround(duration / (10 * engine.setup().time_step)));
  for (int k = 0; k < outer; ++k) {
    engine.prepare_outer_step();
    advance(engine, 10);
  }
}

TEST(Hopper, DischargesAsBeverloo) {
  auto closed = hopper_setup();
  closed.walls = {hopper_wall(0)};
  const std::size_t beads = 5200;
  const auto centres = fill_region(
      CylinderRegion{{middle, middle, floor_height}, {middle, middle, floor_height + height}, vessel},
      FillPattern::random, std::vector<Real>(beads, radius), 99);
  ASSERT_EQ(centres.size(), beads);
  std::vector<ParticleSeed> seeds;
  for (const Vec3& x : centres) seeds.push_back({x, {}, {}, radius, 0, false});
  Real top = 0;
  {
    Engine filling(closed);
    filling.set_particles(seeds);
    run(filling, 0.8);
    const auto settled = grains(filling.particles());
    ASSERT_EQ(settled.size(), beads);
    for (std::size_t p = 0; p < beads; ++p) {
      seeds[p] = {settled[p].position, settled[p].velocity, settled[p].spin, radius, 0, false};
      top += 2 * (settled[p].position.z - floor_height) / static_cast<Real>(beads);
    }
  }
  const Real mass = sphere_mass({1e7, 0.25, 2500}, radius);
  const Real bulk = static_cast<Real>(beads) * mass / (M_PI * vessel * vessel * top);
  core::CsvTable rates{{"orifice / d", "rate [kg/s]"}, {{}, {}}};
  Real n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const Real orifice : {4.5, 5.5, 6.5, 7.5}) {  // in diameters
    auto open = hopper_setup();
    open.walls = {hopper_wall(0.5 * orifice * d)};
    Engine engine(open);
    engine.set_particles(seeds);
    core::CsvTable curve{{"time [s]", "discharged [kg]"}, {{0}, {0}}};
    // Steady after 0.3 s; Beverloo needs a head of more than the vessel's width.
    Real t = 0, first_time = 0, first_mass = 0, last_time = 0, last_mass = 0;
    while (t < 2 && engine.left_through_open_sides() < static_cast<std::int64_t>(beads) * 2 / 5) {
      run(engine, 0.02);
      t += 0.02;
      last_time = t;
      last_mass = mass * static_cast<Real>(engine.left_through_open_sides());
      curve.columns[0].push_back(t);
      curve.columns[1].push_back(last_mass);
      if (t < 0.3) first_time = t, first_mass = last_mass;
    }
    const Real rate = (last_mass - first_mass) / (last_time - first_time);
    keep_curve("hopper_" + show(orifice), curve);
    rates.columns[0].push_back(orifice);
    rates.columns[1].push_back(rate);
    const Real beverloo = 0.58 * bulk * std::sqrt(g) * std::pow((orifice - 1.4) * d, 2.5);
    record_line("hopper, orifice of " + show(orifice) + " d: discharge rate [kg/s]",
                show(beverloo) + " (C 0.58, k 1.4)", rate,
                "µ 0.5, no rolling friction, bulk density " + show(bulk));
    const Real x = orifice * d, y = std::pow(rate, 0.4);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  keep_curve("hopper_rates", rates);
  // W^(2/5) = (C ρ_b √g)^(2/5) (D − k d).
  const Real slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  const Real k = -(sy - slope * sx) / n / slope / d;
  const Real c = std::pow(slope, 2.5) / (bulk * std::sqrt(g));
  expect_between("hopper: Beverloo's k, fitted", 1.2, 3, k,
                 "1.4 for spheres (1.5 ± 0.1, Nedderman 1992; up to 2.9)");
  expect_between("hopper: Beverloo's C, fitted", 0.55, 0.65, c,
                 "0.58, 0.55 to 0.65 by material (Beverloo 1961)");
}

}  // namespace
}  // namespace pellicle::dem
