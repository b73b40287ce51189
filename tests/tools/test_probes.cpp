#include <gtest/gtest.h>

#include <cmath>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/tools/particles_for_tests.hpp"
#include "tools/pellicle/probes.hpp"

using namespace pellicle;
using namespace pellicle::tools;
using pellicle::tests::MadeUpParticle;
using pellicle::tests::TemporaryFolder;

namespace {

const Box box{{0, 0, -0.5}, {1, 1, 0.5}};

/// A gas of 2 x 1 x 4 cells in the box, pressure 100 (layer from below) + column, velocity (cell, 0, 1).
struct Gas {
  CartesianGrid grid{box, {2, 1, 4}};
  HostArray<Vec3> velocity{"test::velocity", 8};
  HostArray<Real> pressure{"test::pressure", 8};
  HostArray<Real> void_fraction{"test::void_fraction", 8};
  HostArray<Real> density{"test::density", 8};
  HostArray<Real> temperature{"test::temperature", 8};
  GasFields fields;
  Gas() {
    for (Index c = 0; c < 8; ++c) {
      const Index3 at = grid.coordinates(c);
      velocity(c) = {1.0 * c, 0, 1};
      pressure(c) = 100.0 * at.z + at.x;
      void_fraction(c) = 0.5;
      density(c) = 1.2;
      temperature(c) = 300 + c;
    }
    fields.grid = &grid;
    fields.velocity = velocity;
    fields.pressure = pressure;
    fields.void_fraction = void_fraction;
    fields.density = density;
    fields.temperature = temperature;
  }
};

ProbeSpec named(const std::string& name, std::vector<std::string> quantities) {
  ProbeSpec spec;
  spec.where = "case.yaml:3: output.probes." + name;
  spec.name = name;
  spec.quantities = std::move(quantities);
  return spec;
}

}  // namespace

TEST(Probes, PointShowsItsCell) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(1, 0.1, 0.1);
  const Gas gas;
  ProbeSpec spec = named(
      "tap", {"pressure", "gas_velocity_x", "superficial_velocity_z", "gas_temperature", "gas_density"});
  spec.point = Vec3{0.7, 0.5, 0.3};  // column 1, layer 3: cell 7
  spec.every = 0.2;
  Probes probes({spec}, time, results, box, &gas.grid, std::nullopt);
  for (int step = 0; step <= 5; ++step) probes.sample({.step = step, .time = 0.1 * step, .gas = &gas.fields});
  probes.flush();
  EXPECT_EQ(core::read_file(results.csv("probes", "tap")),
            "time [s],pressure [Pa],gas_velocity_x [m/s],superficial_velocity_z [m/s],gas_temperature [K],"
            "gas_density [kg/m3]\n0,301,7,0.5,307,1.2\n0.2,301,7,0.5,307,1.2\n0.4,301,7,0.5,307,1.2\n");
}

TEST(Probes, ParticleIsFoundWhereverItIs) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(1, 0.1, 0.1);
  ProbeSpec spec = named("tracer", {"particle_position_x", "particle_spin_y"});
  spec.particle = 7;
  Probes probes({spec}, time, results, box, nullptr, std::nullopt);
  std::vector<MadeUpParticle> made_up;
  made_up.reserve(10);
  for (int id = 0; id < 10; ++id) made_up.push_back({{0.1 * id, 0, 0}, {}, id});
  ParticleColumns particles = tests::make_particles(made_up);
  probes.sample({.step = 1, .time = 0.1, .particles = &particles});
  std::swap(made_up[7], made_up[2]);  // re-sorted in memory
  made_up[2].position.x = 0.75;
  particles = tests::make_particles(made_up);
  probes.sample({.step = 2, .time = 0.2, .particles = &particles});
  made_up.erase(made_up.begin() + 2);  // left the domain
  particles = tests::make_particles(made_up);
  probes.sample({.step = 3, .time = 0.3, .particles = &particles});
  probes.flush();
  EXPECT_EQ(
      core::read_file(results.csv("probes", "tracer")),
      "time [s],particle_position_x [m],particle_spin_y [rad/s]\n0.1,0.7,1.4\n0.2,0.75,1.4\n0.3,nan,nan\n");
}

TEST(Probes, BedByHand) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(1, 0.1, 0.1);
  std::vector<std::string> all;
  all.reserve(bed_quantities.size());
  for (const auto& info : bed_quantities) all.emplace_back(info.name);
  ProbeSpec spec = named("bed", all);
  spec.bed = true;
  const Gas gas;
  Probes probes({spec}, time, results, box, &gas.grid, std::nullopt);
  // 200 particles at heights 0.001, 0.002, ... 0.2 above the floor at z = -0.5: the 198th is the 99 % one.
  std::vector<MadeUpParticle> made_up;
  made_up.reserve(200);
  for (int id = 0; id < 200; ++id) {
    made_up.push_back(
        {{0, 0, -0.5 + 0.001 * (id + 1)}, {3, 0, id == 5 ? 4.0 : 0.0}, id, 1e-3, id < 100 ? 1.0 : 3.0});
  }
  const ParticleColumns particles = tests::make_particles(made_up);
  probes.sample(
      {.step = 1, .time = 0.1, .particles = &particles, .gas = &gas.fields, .contacts = {5.5, 0.01}});
  probes.flush();
  const auto table = core::read_csv(results.csv("probes", "bed"));
  const auto value = [&](const char* name) { return table.column(name).at(0); };
  EXPECT_NEAR(value("bed_height"), 0.198, 1e-9);
  EXPECT_NEAR(value("mean_height"), (0.0505 * 100 + 0.1505 * 300) / 400, 1e-9);
  EXPECT_NEAR(value("mean_speed"), (199 * 3 + 5) / 200.0, 1e-9);
  EXPECT_EQ(value("largest_speed"), 5);
  EXPECT_NEAR(value("kinetic_energy"), 0.5 * (99 * 9 + 25 + 300 * 9), 1e-9);
  EXPECT_EQ(value("particles"), 200);
  EXPECT_NEAR(value("solids_volume"), 200 * 4.0 / 3 * M_PI * 1e-9, 1e-15);
  EXPECT_EQ(value("pressure_drop"), -300);  // the made-up pressure grows upwards
  // Eight cells of 1/8 m3, half gas, rho 1.2, |u|^2 = c^2 + 1: sum of squares 0..7 is 140.
  EXPECT_NEAR(value("gas_kinetic_energy"), 0.5 * 1.2 * 0.5 / 8 * (140 + 8), 1e-9);
  EXPECT_EQ(value("contacts_per_particle"), 5.5);
  EXPECT_EQ(value("largest_overlap"), 0.01);
}

TEST(Probes, WrongOnesAreRefused) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(1, 0.1, 0.1);
  const Gas gas;
  ProbeSpec outside = named("a", {"pressure"});
  outside.point = Vec3{2, 0, 0};
  EXPECT_THROW(Probes({outside}, time, results, box, &gas.grid, std::nullopt), InputError);
  outside.point = Vec3{0.5, 0.5, 0};
  EXPECT_THROW(Probes({outside}, time, results, box, nullptr, std::nullopt), InputError);
  outside.quantities = {"particle_speed"};
  EXPECT_THROW(Probes({outside}, time, results, box, &gas.grid, std::nullopt), InputError);
}

TEST(Histograms, CountsByHand) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(1, 0.1, 0.1);
  HistogramSpec spec;
  spec.name = "speed";
  spec.quantity = "particle_speed";
  spec.bins = 2;
  spec.min = 0;
  spec.max = 4;
  spec.every = 0.5;
  HistogramSpec by_mass = spec;
  by_mass.name = "mass";
  by_mass.by_mass = true;
  by_mass.min = by_mass.max = std::nullopt;
  by_mass.every = 0;  // at the end alone
  Histograms histograms({spec, by_mass}, time, results, std::nullopt);
  const ParticleColumns particles = tests::make_particles({{{}, {1, 0, 0}, 0, 1e-3, 2.0},
                                                           {{}, {0, 3, 0}, 1, 1e-3, 1.0},
                                                           {{}, {0, 0, -3.5}, 2, 1e-3, 1.0},
                                                           {{}, {0, 0, 5}, 3, 1e-3, 4.0}});
  for (int step = 0; step < 5; ++step)
    histograms.sample({.step = step, .time = 0.1 * step, .particles = &particles}, step == 4);
  histograms.flush();
  // The fastest lies beyond the range: shares are of all four.
  EXPECT_EQ(core::read_file(results.csv("histograms", "speed")),
            "time [s],particle_speed_from [m/s],particle_speed_to [m/s],count [-],density [1/(m/s)]\n"
            "0,0,2,1,0.125\n0,2,4,2,0.25\n");
  EXPECT_EQ(core::read_file(results.csv("histograms", "mass")),
            "time [s],particle_speed_from [m/s],particle_speed_to [m/s],mass [kg],density [1/(m/s)]\n"
            "0.4,1,3,2,0.125\n0.4,3,5,6,0.375\n");
}

// from + bins x ((to - from) / bins) can be rounded to less than `to`: the fastest still counts.
TEST(Histograms, NobodyIsLeftOutOfTheRangeFound) {
  TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(1, 0.1, 0.1);
  HistogramSpec spec;
  spec.name = "speed";
  spec.quantity = "particle_speed";
  spec.bins = 50;
  spec.every = 0.1;
  Histograms histograms({spec}, time, results, std::nullopt);
  constexpr int ranges = 1000;  // of which some twenty are rounded so
  for (int n = 0; n < ranges; ++n) {
    const Real low = 0.001 * (n * 7919 % 1000) / 7, high = low + 0.001 * (n * 104729 % 1000 + 1) / 3;
    const ParticleColumns particles = tests::make_particles(
        {{{}, {low, 0, 0}, 0}, {{}, {0.5 * (low + high), 0, 0}, 1}, {{}, {high, 0, 0}, 2}});
    histograms.sample({.step = n, .time = 0.1 * n, .particles = &particles}, false);
  }
  histograms.flush();
  const core::CsvTable table = core::read_csv(results.csv("histograms", "speed"));
  ASSERT_EQ(table.rows(), 50u * ranges);
  double counted = 0;
  for (const double count : table.columns[3]) counted += count;
  EXPECT_EQ(counted, 3 * ranges);
}
