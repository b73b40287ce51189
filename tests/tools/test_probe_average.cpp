#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/checkpoint.hpp"
#include "core/csv.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/tools/particles_for_tests.hpp"
#include "tools/pellicle/probes.hpp"

using namespace pellicle;
using namespace pellicle::tools;
using pellicle::tests::TemporaryFolder;

namespace {

const Box box{{0, 0, 0}, {1, 1, 1}};
constexpr Real gas_step = 0.01;

ProbeSpec probe(const std::string& name, std::vector<std::string> quantities, WindowSpec average) {
  ProbeSpec spec;
  spec.where = "case.yaml:3: output.probes." + name;
  spec.name = name;
  spec.quantities = std::move(quantities);
  spec.every = 0.05;  // five steps
  spec.average = average;
  return spec;
}

/// Moments of a list in two passes, in long double.
struct Expected {
  Real mean, rms, smallest, largest;
  explicit Expected(const std::vector<Real>& values) {
    const auto count = static_cast<long double>(values.size());
    long double sum = 0, squares = 0;
    for (const Real v : values) sum += v;
    for (const Real v : values) squares += (v - sum / count) * (v - sum / count);
    mean = static_cast<Real>(sum / count);
    rms = static_cast<Real>(std::sqrt(squares / count));
    smallest = *std::min_element(values.begin(), values.end());
    largest = *std::max_element(values.begin(), values.end());
  }
};

void expect_figures(const core::CsvTable& table, const std::string& name, const std::vector<Real>& values) {
  const Expected expected(values);
  const auto value = [&](const char* what) { return table.column(name + what).at(0); };
  // 9 digits are written.
  EXPECT_NEAR(value("_mean"), expected.mean, 1e-8 * std::abs(expected.mean) + 1e-12) << name;
  EXPECT_NEAR(value("_rms"), expected.rms, 1e-8 * expected.rms) << name;
  EXPECT_NEAR(value("_min"), expected.smallest, 1e-8 * std::abs(expected.smallest) + 1e-12) << name;
  EXPECT_NEAR(value("_max"), expected.largest, 1e-8 * std::abs(expected.largest) + 1e-12) << name;
  EXPECT_EQ(value("_samples"), static_cast<Real>(values.size())) << name;
}

/// A gas of one cell with a pressure and a velocity that change from step to step.
struct Gas {
  CartesianGrid grid{box, {1, 1, 1}};
  HostArray<Vec3> velocity{"test::velocity", 1};
  HostArray<Real> pressure{"test::pressure", 1};
  GasFields fields;
  Gas() {
    fields.grid = &grid;
    fields.velocity = velocity;
    fields.pressure = pressure;
  }
  static Real pressure_at(int step) { return 1e5 + 3 * std::sin(0.7 * step * step); }
  static Real speed_at(int step) { return -2 + std::cos(1.3 * step) / step; }
  void set(int step) {
    pressure(0) = pressure_at(step);
    velocity(0) = {0, 0, step > 0 ? speed_at(step) : 0};
  }
};

ProbeSpec point_probe() {
  ProbeSpec spec = probe("tap", {"pressure", "gas_velocity_z"}, {0.1, 0.3});
  spec.point = Vec3{0.5, 0.5, 0.5};
  return spec;
}

/// Impulses, angular impulses and contacts that a wall has after a step; nothing in them is linear.
WallFigures floor_after(int step) {
  WallFigures wall;
  wall.name = "floor";
  wall.impulse = {0, 0, -0.01 * step * step * step};
  wall.angular_impulse = {0, 0.1 * std::sin(step), 0};
  wall.contacts = step % 3;
  return wall;
}

ProbeSpec wall_probe() {
  ProbeSpec spec = probe("load", {"wall_force_z", "wall_torque_y", "wall_contacts"}, {0, 0.3});
  spec.wall = "floor";
  return spec;
}

/// Steps FROM to TO of a run with the gas and the wall.
void march(Probes& probes, int from, int to) {
  Gas gas;
  for (int step = from; step <= to; ++step) {
    gas.set(step);
    const std::vector<WallFigures> walls{floor_after(step)};
    probes.sample({.step = step, .time = gas_step * step, .gas = &gas.fields, .walls = &walls});
  }
  probes.flush();
}

core::CsvTable average(const ResultsFolder& results, const std::string& name) {
  return core::read_csv(results.csv("probes", name + "_average"));
}

}  // namespace

TEST(ProbeAverage, OfEveryStepInTheWindow) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(0.5, gas_step, gas_step);
  const Gas gas;
  Probes probes({point_probe()}, time, results, box, &gas.grid, std::nullopt);
  march(probes, 0, 50);
  std::vector<Real> pressures, speeds;
  for (int step = 11; step <= 30; ++step) {  // later than 0.1 s, up to 0.3 s
    pressures.push_back(Gas::pressure_at(step));
    speeds.push_back(Gas::speed_at(step));
  }
  const auto table = average(results, "tap");
  ASSERT_EQ(table.rows(), 1u);
  EXPECT_EQ(table.header[2], "pressure_mean [Pa]");
  EXPECT_EQ(table.column("from [s]").at(0), 0.1);
  EXPECT_EQ(table.column("to [s]").at(0), 0.3);
  expect_figures(table, "pressure", pressures);
  expect_figures(table, "gas_velocity_z", speeds);
  EXPECT_EQ(core::read_csv(results.csv("probes", "tap")).rows(), 11u);  // still every fifth step
}

TEST(ProbeAverage, BeforeTheWindowThereIsNone) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(0.5, gas_step, gas_step);
  const Gas gas;
  Probes probes({point_probe()}, time, results, box, &gas.grid, std::nullopt);
  march(probes, 0, 10);
  const auto table = average(results, "tap");
  for (const char* figure : {"_mean", "_rms", "_min", "_max"})
    EXPECT_TRUE(std::isnan(table.column(std::string("pressure") + figure).at(0))) << figure;
  EXPECT_EQ(table.column("pressure_samples").at(0), 0);
}

// A row holds the force since the row before, five steps ago; a sample that since the step before.
TEST(ProbeAverage, ForcesOnAWallAreThoseOfSteps) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(0.5, gas_step, gas_step);
  const Gas gas;
  Probes probes({wall_probe()}, time, results, box, &gas.grid, std::nullopt);
  march(probes, 0, 30);
  std::vector<Real> forces, torques, contacts;
  for (int step = 1; step <= 30; ++step) {
    // n^3 - (n-1)^3 = 3 n^2 - 3 n + 1
    forces.push_back(-0.01 * (3.0 * step * step - 3 * step + 1) / gas_step);
    torques.push_back(0.1 * (std::sin(step) - std::sin(step - 1)) / gas_step);
    contacts.push_back(step % 3);
  }
  const auto table = average(results, "load");
  expect_figures(table, "wall_force_z", forces);
  expect_figures(table, "wall_torque_y", torques);
  expect_figures(table, "wall_contacts", contacts);
  const auto rows = core::read_csv(results.csv("probes", "load")).column("wall_force_z");
  EXPECT_NEAR(rows.at(2), -0.01 * (1000 - 125) / (5 * gas_step), 1e-6);
}

TEST(ProbeAverage, WhatIsNoNumberIsNoSample) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(0.5, gas_step, gas_step);
  ProbeSpec spec = probe("tracer", {"particle_position_x"}, {0, 0.5});
  spec.particle = 1;
  Probes probes({spec}, time, results, box, nullptr, std::nullopt);
  std::vector<Real> positions;
  for (int step = 1; step <= 8; ++step) {
    std::vector<tests::MadeUpParticle> made_up{{{0.9, 0, 0}, {}, 0}};
    if (step <= 6) {  // then it has left
      positions.push_back(0.1 * step);
      made_up.push_back({{0.1 * step, 0, 0}, {}, 1});
    }
    const ParticleColumns particles = tests::make_particles(made_up);
    probes.sample({.step = step, .time = gas_step * step, .particles = &particles});
  }
  probes.flush();
  expect_figures(average(results, "tracer"), "particle_position_x", positions);
}

TEST(ProbeAverage, RestartGoesOnToTheLastBit) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  const ResultsFolder others(folder / "o", ResultsFolder::Existing::refuse);
  core::TimeControl time(0.5, gas_step, gas_step), longer(0.6, gas_step, gas_step);
  const Gas gas;
  Probes whole({point_probe(), wall_probe()}, time, results, box, &gas.grid, std::nullopt);
  march(whole, 0, 27);
  const auto save = [&](const Probes& probes, const char* name) {
    core::CheckpointWriter out(folder / name);
    probes.save(out);
    out.close();
  };
  save(whole, "whole.h5");
  {
    Probes first({point_probe(), wall_probe()}, time, others, box, &gas.grid, std::nullopt);
    march(first, 0, 13);
    save(first, "first.h5");
  }
  auto specs = std::vector<ProbeSpec>{point_probe(), wall_probe()};
  for (auto& spec : specs) spec.average->to = 0.6;  // a later end goes on with the average
  Probes second(specs, longer, others, box, &gas.grid, 0.13);
  second.load(core::CheckpointReader(folder / "first.h5"));
  march(second, 14, 27);
  save(second, "second.h5");
  const core::CheckpointReader one(folder / "whole.h5"), two(folder / "second.h5");
  for (const char* name : {"tap", "load"}) {
    EXPECT_EQ(average(results, name).columns, average(others, name).columns) << name;
    const std::string columns = std::string("probes/") + name + "/average/columns";
    EXPECT_EQ(one.read_bytes(columns), two.read_bytes(columns)) << name;
  }

  // Another point, and a wall whose step before the checkpoint nobody noted.
  auto changed = specs;
  changed[0].point = Vec3{0.1, 0.5, 0.5};
  changed[1].average->from = 0.05;
  const ResultsFolder more(folder / "m", ResultsFolder::Existing::refuse);
  Probes third(changed, longer, more, box, &gas.grid, 0.13);
  third.load(core::CheckpointReader(folder / "first.h5"));
  march(third, 14, 16);
  EXPECT_EQ(average(more, "tap").column("pressure_samples").at(0), 3);
  // The first step after the checkpoint has no step before it to take a difference to.
  expect_figures(average(more, "load"), "wall_force_z",
                 {-0.01 * (3 * 225 - 45 + 1) / gas_step, -0.01 * (3 * 256 - 48 + 1) / gas_step});
}
