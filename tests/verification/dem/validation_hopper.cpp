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

EngineSetup hopper_setup(Real friction) {
  auto setup = glass_setup({2 * middle, 2 * middle, floor_height + height}, 4e-5, 0.5, friction, 0);
  setup.contacts.tangential = Mindlin{};  // at the walls too
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

/// Beads poured at random and come to rest in the closed vessel.
std::vector<ParticleSeed> settle(Real friction) {
  auto closed = hopper_setup(friction);
  closed.walls = {hopper_wall(0)};
  const std::size_t beads = 5200;
  const auto centres = fill_region(
      CylinderRegion{{middle, middle, floor_height}, {middle, middle, floor_height + height}, vessel},
      FillPattern::random, std::vector<Real>(beads, radius), 99);
  EXPECT_EQ(centres.size(), beads);
  std::vector<ParticleSeed> seeds;
  seeds.reserve(centres.size());
  for (const Vec3& x : centres) seeds.push_back({x, {}, {}, radius, 0, false});
  Engine filling(closed);
  filling.set_particles(seeds);
  run(filling, 0.8);
  const auto settled = grains(filling.particles());
  EXPECT_EQ(settled.size(), beads);
  for (std::size_t p = 0; p < settled.size(); ++p)
    seeds[p] = {settled[p].position, settled[p].velocity, settled[p].spin, radius, 0, false};
  return seeds;
}

/// Solids fraction of the poured bed where neither floor, wall nor surface orders or loosens it: three diameters from each.
Real poured_fraction(const std::vector<ParticleSeed>& seeds) {
  const Real low = floor_height + 3 * d, high = floor_height + 14 * d, out = vessel - 3 * d;
  Real volume = 0;
  for (const ParticleSeed& s : seeds) {
    const Real z = s.position.z;
    const bool counts = z > low && z < high && std::hypot(s.position.x - middle, s.position.y - middle) < out;
    if (counts) volume += sphere_volume(radius);
  }
  return volume / (M_PI * out * out * (high - low));
}

/// Mass rate [kg/s] through an orifice of some diameters, once it is steady.
Real discharge_rate(const std::vector<ParticleSeed>& seeds, Real friction, Real orifice) {
  auto open = hopper_setup(friction);
  open.walls = {hopper_wall(0.5 * orifice * d)};
  Engine engine(open);
  engine.set_particles(seeds);
  const Real mass = sphere_mass({1e7, 0.25, 2500}, radius);
  core::CsvTable curve{{"time [s]", "discharged [kg]"}, {{0}, {0}}};
  Real t = 0, first_time = 0, first_mass = 0, last_mass = 0;
  const auto most = static_cast<std::int64_t>(seeds.size()) * 2 / 5;
  while (t < 1.6 && engine.left_through_open_sides() < most) {
    run(engine, 0.02);
    t += 0.02;
    last_mass = mass * static_cast<Real>(engine.left_through_open_sides());
    curve.columns[0].push_back(t);
    curve.columns[1].push_back(last_mass);
    if (t < 0.3) first_time = t, first_mass = last_mass;
  }
  keep_curve("hopper_" + show(friction) + "_" + show(orifice), curve);
  return (last_mass - first_mass) / (t - first_time);
}

// Beverloo, Leniger & van de Velde (1961): W = C ρ_b √g (D − k d)^(5/2), ρ_b that of the poured bed; C 0.55 to 0.65 by
// material, 0.58 on average, k 1.4 for grains that are nearly round. C falls with friction. The law is for wide orifices; of
// narrow ones, below 10 to 15 d, the rate is lower than the 5/2 law of wide ones (Mankoc et al., Granul. Matter 9 (2007)
// 407). Those here are 5 to 7 d, as wide as a vessel of 18 d bears: it is 2.5 times as wide, though not 30 d wider, which
// is asked for too.
//
// Expected before the first of these runs: k = 1.4 taken, C at µ 0.3 at the lower end of 0.55 to 0.65 or some per cent
// below it, more at µ 0.1, at µ 0.5 as before (0.50). Rates of a single run scatter by 2 % or so.
TEST(Hopper, DischargesAsBeverloo) {
  constexpr Real shape = 1.4;
  core::CsvTable rates{{"friction", "orifice / d", "rate [kg/s]", "C at k 1.4"}, {{}, {}, {}, {}}};
  std::vector<Real> mean_constant;
  for (const Real friction : {0.1, 0.3, 0.5}) {
    const auto seeds = settle(friction);
    const Real fraction = poured_fraction(seeds);
    const std::string label = "hopper, µ " + show(friction);
    record_line(label + ": solids fraction of the poured bed", "0.58 to 0.64", fraction,
                "three diameters away from floor, wall and surface");
    const Real bulk = 2500 * fraction;
    const std::vector<Real> orifices = friction == 0.3 ? std::vector<Real>{5, 6, 7} : std::vector<Real>{6};
    Real mean = 0;
    for (const Real orifice : orifices) {
      const Real rate = discharge_rate(seeds, friction, orifice);
      const Real scale = bulk * std::sqrt(g) * std::pow((orifice - shape) * d, 2.5);
      rates.columns[0].push_back(friction);
      rates.columns[1].push_back(orifice);
      rates.columns[2].push_back(rate);
      rates.columns[3].push_back(rate / scale);
      mean += rate / scale / static_cast<Real>(orifices.size());
      record_line(label + ", orifice of " + show(orifice) + " d: discharge rate [kg/s]",
                  show(0.58 * scale) + " (C 0.58, k 1.4)", rate,
                  "ρ_b " + show(bulk) + " kg/m³; C here " + show(rate / scale));
    }
    mean_constant.push_back(mean);
  }
  keep_curve("hopper_rates", rates);
  expect_between("hopper, µ 0.3: Beverloo's C at k 1.4, mean of the orifices", 0.55, 0.65, mean_constant[1],
                 "0.58, 0.55 to 0.65 by material (Beverloo 1961)");
  expect_between("hopper: C at µ 0.1 over that at µ 0.5", 1, 2, mean_constant[0] / mean_constant[2],
                 "smooth beads flow faster: C depends on the material (Beverloo 1961)");
  // The power: W^(2/5) over D is a line that meets zero at k d.
  Real n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < rates.columns[0].size(); ++i) {
    if (rates.columns[0][i] != 0.3) continue;
    const Real x = rates.columns[1][i], y = std::pow(rates.columns[2][i], 0.4);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const Real slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  expect_between("hopper, µ 0.3: Beverloo's k, fitted", 1.2, 3, -(sy - slope * sx) / n / slope,
                 "1.4 for spheres (1.5 ± 0.1, Nedderman 1992; up to 2.9)");
}

}  // namespace
}  // namespace pellicle::dem
