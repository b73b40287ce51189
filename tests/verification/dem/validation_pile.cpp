// Long: heaps. One that must not creep, and the slope of others against rolling friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "dem/fill.hpp"
#include "tests/verification/dem/impacts.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using namespace tests;

constexpr Real g = 9.81;

ContactOptions laws_with_memory() {
  ContactOptions laws;
  laws.tangential = Mindlin{};
  laws.rolling = Epsd2{};
  return laws;
}

void run(Engine& engine, Real duration) {
  const auto outer = static_cast<int>(std::lround(duration / (10 * engine.setup().time_step)));
  for (int k = 0; k < outer; ++k) {
    engine.prepare_outer_step();
    advance(engine, 10);
  }
}

/// A round floor of fixed beads, 22 diameters wide, and 400 beads that fall on its middle.
std::vector<ParticleSeed> heap_seeds(Real radius, const Vec3& middle) {
  std::vector<ParticleSeed> seeds;
  const Real d = 2 * radius;
  for (int i = -11; i <= 11; ++i) {
    for (int j = -13; j <= 13; ++j) {
      const Real x = (i + 0.5 * (j % 2)) * d, y = j * d * std::sqrt(0.75);
      if (x * x + y * y < 121 * d * d)
        seeds.push_back({{middle.x + x, middle.y + y, radius}, {}, {}, radius, 0, true});
    }
  }
  const auto centres =
      fill_region(CylinderRegion{{middle.x, middle.y, d}, {middle.x, middle.y, 30 * d}, 4 * d},
                  FillPattern::random, std::vector<Real>(400, radius), 97);
  EXPECT_EQ(centres.size(), 400U);
  for (const Vec3& x : centres) seeds.push_back({x, {}, {}, radius, 0, false});
  return seeds;
}

/// How a heap that has come to rest moves over 1e5 steps.
struct Creep {
  Real mean_shift = 0, largest_shift = 0;  // over the diameter
  Real sinking = 0;                        // of the centre of mass, over the diameter
  Real energy = 0;                         // kinetic, mean at the end, over m g d
  Real height = 0;                         // of the heap, in diameters
  Real lost = 0;                           // beads that left the floor meanwhile
};

Creep watch_heap(const std::string& name, const ContactOptions& laws) {
  const Real radius = 0.0015, d = 2 * radius, step = 1e-5;
  auto setup = glass_setup({0.1, 0.1, 0.12}, step, 0.5, 0.5, 0.2);
  setup.contacts = laws;
  setup.gravity = {0, 0, -g};
  setup.domain.open_max.z = setup.domain.open_min.z = 1;
  setup.domain.open_min.x = setup.domain.open_max.x = setup.domain.open_min.y = setup.domain.open_max.y = 1;
  Engine engine(setup);
  engine.set_particles(heap_seeds(radius, {0.05, 0.05, 0}));
  run(engine, 1.0);
  const auto start = grains(engine.particles());
  const std::int64_t off_before = engine.left_through_open_sides();
  core::CsvTable curve{{"steps", "mean shift / d", "largest shift / d", "centre of mass / d"},
                       {{}, {}, {}, {}}};
  Creep creep;
  for (int sample = 0; sample <= 50; ++sample) {
    if (sample > 0) run(engine, 2000 * step);
    const auto now = grains(engine.particles());
    Real shift = 0, largest = 0, sinking = 0, energy = 0, height = 0;
    int moving = 0;
    auto first = start.begin();  // both are sorted by id; beads that fell off the floor are gone
    for (const Grain& bead : now) {
      while (first->id < bead.id) ++first;
      if (bead.fixed) continue;
      ++moving;
      const Real by = norm(bead.position - first->position) / d;
      shift += by;
      largest = std::max(largest, by);
      sinking += (first->position.z - bead.position.z) / d;
      energy += 0.5 * norm_squared(bead.velocity) + 0.2 * radius * radius * norm_squared(bead.spin);
      height = std::max(height, bead.position.z / d);
    }
    creep = {shift / moving, largest, sinking / moving, energy / moving / (g * d), height};
    const std::array<Real, 4> row = {2000.0 * sample, creep.mean_shift, creep.largest_shift, creep.sinking};
    for (std::size_t k = 0; k < 4; ++k) curve.columns[k].push_back(row[k]);
  }
  keep_curve("creep_" + name, curve);
  creep.lost = static_cast<Real>(engine.left_through_open_sides() - off_before);
  return creep;
}

TEST(Heap, DoesNotCreepWithMemory) {
  const Creep c = watch_heap("mindlin_epsd2", laws_with_memory());
  expect_small("heap of 400 beads, mindlin + epsd2, 1e5 steps: largest shift of a bead, over d",
               c.largest_shift, 1e-3, "at rest; a thousandth of a diameter in 1 s is below what shows");
  expect_small("heap, mindlin + epsd2: mean shift, over d", c.mean_shift, 1e-4, "at rest");
  expect_small("heap, mindlin + epsd2: kinetic energy left, over m g d", c.energy, 1e-9,
               "damped to nothing but rounding and slow modes");
  record_line("heap, mindlin + epsd2: height, in diameters", "-", c.height, "for comparison with the next");
}

TEST(Heap, FlowsApartWithoutMemory) {
  const Creep c = watch_heap("viscous_coulomb", ContactOptions{});
  record_line("heap of 400 beads, viscous_coulomb + constant_torque, 1e5 steps: mean shift, over d",
              "it creeps", c.mean_shift,
              "friction without history resists a velocity; nothing is added to hide that");
  record_line("heap, viscous_coulomb + constant_torque: beads that left the floor in the 1e5 steps", "-",
              c.lost, "");
  record_line("heap, viscous_coulomb + constant_torque: height, in diameters", "-", c.height,
              "it sinks as it creeps");
}

/// A heap that is left when the two walls of a settled block, endless in y, are taken away: 20 diameters wide, on a
/// rough floor just as wide. What passes the edges falls out.
Real angle_of_repose(Real sliding, Real rolling, const std::string& name) {
  const Real radius = 0.005, d = 2 * radius, half = 10 * d, depth = 6 * d, middle = 0.5;
  auto setup = glass_setup({2 * middle, depth, 0.5}, 4e-5, 0.5, sliding, rolling);
  setup.contacts = laws_with_memory();
  setup.gravity = {0, 0, -g};
  setup.domain.periodic = {0, 1, 0};
  setup.domain.open_min = {1, 0, 1};
  setup.domain.open_max = {1, 0, 1};
  std::vector<ParticleSeed> seeds;
  const Real floor = 0.1;
  for (int i = -10; i < 10; ++i) {
    for (int j = 0; j < 6; ++j) {
      seeds.push_back({{middle + (i + 0.5) * d, (j + 0.5) * d, floor}, {}, {}, radius, 0, true});
    }
  }
  const std::size_t beads = 1900;
  const auto centres = fill_region(Box{{middle - half, 0, floor + radius}, {middle + half, depth, 0.5}},
                                   FillPattern::random, std::vector<Real>(beads, radius), 98);
  EXPECT_EQ(centres.size(), beads);
  for (const Vec3& x : centres) seeds.push_back({x, {}, {}, radius, 0, false});
  auto walled = setup;
  walled.walls = {PlaneWall{"left", {middle - half, 0, 0}, {1, 0, 0}, {}, 1},
                  PlaneWall{"right", {middle + half, 0, 0}, {-1, 0, 0}, {}, 1}};
  {
    Engine filling(walled);
    filling.set_particles(seeds);
    run(filling, 0.6);
    const auto settled = grains(filling.particles());
    EXPECT_EQ(settled.size(), seeds.size());
    for (std::size_t p = 0; p < settled.size(); ++p) {
      seeds[p].position = settled[p].position;
      seeds[p].velocity = settled[p].velocity;
      seeds[p].spin = settled[p].spin;
    }
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  Real energy = 1;
  for (int k = 0; k < 20 && energy > 1e-4; ++k) {
    run(engine, 0.2);
    energy = 0;
    const auto all = grains(engine.particles());
    for (const Grain& s : all) {
      if (!s.fixed) energy += 0.5 * norm_squared(s.velocity) / (g * d) / static_cast<Real>(all.size());
    }
  }
  EXPECT_LT(energy, 1e-3) << "still moving";
  // The surface: the highest bead in each strip of one diameter. Its slope on each side, edges and top left out.
  std::vector<Real> top(20, 0);
  core::CsvTable curve{{"x / d", "surface / d"}, {{}, {}}};
  for (const Grain& s : grains(engine.particles())) {
    const auto i = static_cast<int>(std::floor((s.position.x - middle + half) / d));
    if (i < 0 || i >= 20) continue;
    Real& height = top[static_cast<std::size_t>(i)];
    height = std::max(height, s.position.z - floor);
  }
  Real sum = 0;
  for (const int side : {0, 1}) {
    Real n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (int k = 1; k < 9; ++k) {  // from the edge inwards
      const Real x = k * d, y = top[static_cast<std::size_t>(side == 0 ? k : 19 - k)];
      n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    sum += (n * sxy - sx * sy) / (n * sxx - sx * sx);
  }
  for (int i = 0; i < 20; ++i) {
    curve.columns[0].push_back(i - 9.5);
    curve.columns[1].push_back(top[static_cast<std::size_t>(i)] / d);
  }
  keep_curve("repose_" + name, curve);
  return std::atan(sum / 2) * 180 / M_PI;
}

TEST(Heap, SteepensWithRollingFriction) {
  core::CsvTable curve{{"rolling friction", "angle of repose [deg]"}, {{}, {}}};
  Real least_rise = 90, before = -1;
  for (const Real rolling : {0.0, 0.1, 0.2, 0.4}) {
    const Real angle = angle_of_repose(0.5, rolling, show(rolling));
    curve.columns[0].push_back(rolling);
    curve.columns[1].push_back(angle);
    record_line("angle of repose, µ_s 0.5, µ_r " + show(rolling) + " (of R*) [deg]", "-", angle,
                "mean slope of both sides of a heap 20 diameters wide, 6 deep and periodic; a single run");
    if (before >= 0) least_rise = std::min(least_rise, angle - before);
    before = angle;
  }
  keep_curve("angle_of_repose", curve);
  expect_between("angle of repose: smallest rise from one rolling friction to the next [deg]", 0, 90,
                 least_rise, "monotone");
}

}  // namespace
}  // namespace pellicle::dem
