#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/checkpoint.hpp"
#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/random.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/tools/particles_for_tests.hpp"
#include "tools/pellicle/lines.hpp"
#include "tools/pellicle/output_fields.hpp"

using namespace pellicle;
using namespace pellicle::tools;
using pellicle::tests::MadeUpParticle;
using pellicle::tests::TemporaryFolder;

namespace {

LineSpec line_along_x() {
  LineSpec spec;
  spec.where = "case.yaml:7: output.lines.middle";
  spec.name = "middle";
  spec.from = {0, 0.01, 0.05};
  spec.to = {0.1, 0.01, 0.05};
  spec.points = 10;
  spec.depth_average = 1;
  spec.thickness = 0.01;
  spec.quantity = "particle_velocity_z";
  spec.average = {0, 1};
  return spec;
}

/// Particles spread over the box (0.1 x 0.02 x 0.1 m) with velocities in [-1, 1).
std::vector<MadeUpParticle> spread(int count, std::int64_t step = 0) {
  std::vector<MadeUpParticle> particles;
  for (int id = 0; id < count; ++id) {
    const Vec3 u = core::random_uniform3(1, core::Purpose::test, step, id);
    const Vec3 v = core::random_uniform3(1, core::Purpose::test, step, id, 1);
    particles.push_back({{0.1 * u.x, 0.02 * u.y, 0.1 * u.z}, 2.0 * v - Vec3{1, 1, 1}, id});
  }
  return particles;
}

core::CsvTable result(const Lines& lines, const TemporaryFolder& folder, const std::string& name) {
  const ResultsFolder results(folder / "results", ResultsFolder::Existing::resume);
  lines.write(results);
  return core::read_csv(results.csv("lines", name));
}

}  // namespace

TEST(LineGeometry, BinsHoldTheirLowerFaces) {
  LineSpec spec = line_along_x();
  const LineGeometry line = make_line_geometry(spec);
  EXPECT_EQ(line.bin({0, 0.005, 0.05}), 0);
  EXPECT_EQ(line.bin({0.0149, -7, 0.05}), 1);  // whatever the depth
  EXPECT_EQ(line.bin({0.0999, 0, 0.0451}), 9);
  EXPECT_EQ(line.bin({0.1, 0, 0.05}), -1);
  EXPECT_EQ(line.bin({-1e-9, 0, 0.05}), -1);
  EXPECT_EQ(line.bin({0.05, 0, 0.0449}), -1);
  EXPECT_EQ(line.bin({0.05, 0, 0.0551}), -1);
  spec.depth_average.reset();
  const LineGeometry thin = make_line_geometry(spec);
  EXPECT_EQ(thin.bin({0.031, 0.0149, 0.05}), 3);
  EXPECT_EQ(thin.bin({0.031, 0.0151, 0.05}), -1);
  EXPECT_EQ(thin.bin({0.031, 0.01, 0.0551}), -1);
}

TEST(LineGeometry, ObliqueLine) {
  LineSpec spec = line_along_x();
  spec.to = {0.03, 5.0, 0.09};  // 3-4-5 triangle in x-z; the depth does not count
  const LineGeometry line = make_line_geometry(spec);
  EXPECT_NEAR(line.length, 0.05, 1e-15);
  const Vec3 along{0.6, 0, 0.8}, across{-0.8, 0, 0.6};
  EXPECT_EQ(line.bin(spec.from + along * 0.012 + across * 0.0049), 2);
  EXPECT_EQ(line.bin(spec.from + along * 0.012 - across * 0.0051), -1);
  EXPECT_NEAR(line_positions(spec, line)[3], 0.0175, 1e-15);
}

TEST(LineGeometry, ImpossibleLinesAreRefused) {
  LineSpec spec = line_along_x();
  spec.to = {0, 0.5, 0.05};  // along the direction that is averaged over
  EXPECT_THROW(make_line_geometry(spec), InputError);
  spec = line_along_x();
  spec.thickness = 0;
  EXPECT_THROW(make_line_geometry(spec), InputError);
}

// Against a plain count on the host over three steps with different particles.
TEST(Lines, ParticleMeanIsOverAllSamples) {
  TemporaryFolder folder;
  core::TimeControl time(1, 0.1, 0.1);
  Lines lines({line_along_x()}, time, nullptr);
  std::array<std::vector<double>, 10> samples;
  for (int step = 1; step <= 3; ++step) {
    // Different numbers of particles, so that a mean of frame means would differ.
    const auto made_up = spread(500 * step, step);
    const ParticleColumns particles = tests::make_particles(made_up);
    lines.sample(step, &particles, nullptr);
    for (const auto& p : made_up) {
      if (p.position.z < 0.045 || p.position.z >= 0.055) continue;
      samples[static_cast<std::size_t>(p.position.x / 0.01)].push_back(p.velocity.z);
    }
  }
  const auto table = result(lines, folder, "middle");
  EXPECT_EQ(table.header[0], "x [m]");
  EXPECT_EQ(table.header[1], "particle_velocity_z [m/s]");
  ASSERT_EQ(table.rows(), 10u);
  for (std::size_t bin = 0; bin < 10; ++bin) {
    double mean = 0, variance = 0;
    for (const double v : samples[bin]) mean += v / static_cast<double>(samples[bin].size());
    for (const double v : samples[bin])
      variance += (v - mean) * (v - mean) / static_cast<double>(samples[bin].size());
    EXPECT_NEAR(table.columns[0][bin], 0.005 + 0.01 * static_cast<double>(bin), 1e-12);
    EXPECT_NEAR(table.columns[1][bin], mean, 1e-8);  // 9 digits are written
    EXPECT_NEAR(table.columns[2][bin], std::sqrt(variance), 1e-8);
    EXPECT_EQ(table.columns[3][bin], static_cast<double>(samples[bin].size()));
    EXPECT_GT(samples[bin].size(), 10u);
  }
}

TEST(Lines, OnlyInsideTheWindow) {
  TemporaryFolder folder;
  core::TimeControl time(1, 0.1, 0.1);
  LineSpec spec = line_along_x();
  spec.average = {0.3, 0.6};
  Lines lines({spec}, time, nullptr);
  const ParticleColumns particles = tests::make_particles({{{0.015, 0, 0.05}, {0, 0, 2}, 0}});
  for (int step = 0; step <= 10; ++step) lines.sample(step, &particles, nullptr);
  const auto table = result(lines, folder, "middle");
  EXPECT_EQ(table.columns[3][1], 3);  // steps 4, 5 and 6
  EXPECT_EQ(table.columns[1][1], 2);
  EXPECT_EQ(table.columns[2][1], 0);
  EXPECT_EQ(table.columns[3][2], 0);
  EXPECT_TRUE(std::isnan(table.columns[1][2]));
}

// The same moments to the last bit, whatever the number of threads: a bin takes its particles in memory order.
TEST(Lines, MomentsAreInMemoryOrder) {
  const auto made_up = spread(20000);
  const ParticleColumns particles = tests::make_particles(made_up);
  const LineGeometry geometry = make_line_geometry(line_along_x());
  ParticleLine line(geometry, core::find_model(particle_quantities, "particle_velocity_z"));
  line.add(particles);
  std::array<core::RunningMoments, 10> expected{};
  for (const auto& p : made_up) {
    const Index bin = geometry.bin(p.position);
    if (bin >= 0) expected[static_cast<std::size_t>(bin)].add(p.velocity.z);
  }
  const auto moments = line.moments();
  for (std::size_t bin = 0; bin < 10; ++bin) {
    EXPECT_EQ(moments[bin].mean, expected[bin].mean);
    EXPECT_EQ(moments[bin].squares, expected[bin].squares);
  }
}

TEST(Lines, GasMeanIsWeightedByVolume) {
  TemporaryFolder folder;
  core::TimeControl time(1, 0.1, 0.1);
  // Cells of 0.02 x 0.01 x (0.048 and 0.052): the line's band 0.045 to 0.055 has 3 mm in the lower, 7 mm in the upper.
  const CartesianGrid grid(std::array<std::vector<Real>, 3>{
      std::vector<Real>{0, 0.02, 0.04, 0.06, 0.08, 0.1}, {0, 0.01, 0.02}, {0, 0.048, 0.1}});
  LineSpec spec = line_along_x();
  spec.points = 4;  // bins of 25 mm: the first has 20 mm of cell 0 and 5 mm of cell 1
  spec.quantity = "void_fraction";
  HostArray<Real> void_fraction("test::void_fraction", 20);
  for (Index k = 0; k < 2; ++k) {
    for (Index j = 0; j < 2; ++j) {
      for (Index i = 0; i < 5; ++i) void_fraction(grid.index(i, j, k)) = 0.1 * i + 0.02 * j + 0.3 * k;
    }
  }
  Lines lines({spec}, time, &grid);
  GasFields gas;
  gas.grid = &grid;
  gas.void_fraction = void_fraction;
  lines.sample(1, nullptr, &gas);
  auto table = result(lines, folder, "middle");
  // 0.1 (0 * 20 + 1 * 5) / 25 + 0.01 over the depth + 0.3 * 0.7
  EXPECT_NEAR(table.columns[1][0], 0.02 + 0.01 + 0.21, 1e-9);
  EXPECT_EQ(table.columns[3][0], 1);
  // A second step with twice the value: mean 1.5 times, deviation half of the first value.
  for (std::size_t c = 0; c < 20; ++c) void_fraction(c) *= 2;
  lines.sample(2, nullptr, &gas);
  table = result(lines, folder, "middle");
  EXPECT_NEAR(table.columns[1][0], 1.5 * 0.24, 1e-9);
  EXPECT_NEAR(table.columns[2][0], 0.12, 1e-8);
}

// The deviation is what is left of numbers that agree in their first ten digits: the mean of the squares minus the square
// of the mean is wrong in all of its digits here.
TEST(Lines, SmallFluctuationOfALargePressure) {
  TemporaryFolder folder;
  core::TimeControl time(1, 1e-3, 1e-3);
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.02, 0.1}}, {10, 2, 10});
  LineSpec spec = line_along_x();
  spec.quantity = "pressure";
  HostArray<Real> pressure("test::pressure", 200);
  Lines lines({spec}, time, &grid);
  GasFields gas;
  gas.grid = &grid;
  gas.pressure = pressure;
  // 101325 Pa and a wave of 1e-5 Pa over four whole periods: its RMS is 1e-5 / sqrt 2.
  for (int step = 1; step <= 1000; ++step) {
    const Real wave = 1e-5 * std::sin(2 * M_PI * 4 * step / 1000.0);
    Kokkos::deep_copy(pressure, 101325 + wave);
    lines.sample(step, nullptr, &gas);
  }
  const auto table = result(lines, folder, "middle");
  for (std::size_t bin = 0; bin < 10; ++bin) {
    // A pressure is rounded to 1.5e-11 Pa, its mean over the cells of a bin to a few times that: 1e-5 of the wave.
    EXPECT_NEAR(table.columns[2][bin], 1e-5 / std::sqrt(2.0), 1e-10);
    EXPECT_NEAR(table.columns[1][bin], 101325, 1e-3);  // 9 digits are written
  }
}

// A linear field along an oblique line: the mean over a bin of a linear field is its value at the bin's centre, up to
// the cell size that the field is resolved with.
TEST(Lines, ObliqueGasLine) {
  LineSpec spec = line_along_x();
  spec.from = {0.02, 0, 0.02};
  spec.to = {0.08, 0, 0.08};
  spec.points = 5;
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.02, 0.1}}, {50, 2, 50});
  const LineGeometry line = make_line_geometry(spec);
  const auto cells = bin_cells(spec, line, grid);
  for (std::size_t bin = 0; bin < 5; ++bin) {
    Real x = 0, z = 0, shares = 0;
    for (const auto& [cell, share] : cells[bin]) {
      const Index3 at = grid.coordinates(cell);
      x += share * grid.center(0, at.x);
      z += share * grid.center(2, at.z);
      shares += share;
    }
    const Real centre = 0.02 + 0.06 * (static_cast<Real>(bin) + 0.5) / 5;
    EXPECT_NEAR(shares, 1, 1e-12);
    EXPECT_NEAR(x, centre, 0.1 * 0.002);  // a tenth of a cell
    EXPECT_NEAR(z, centre, 0.1 * 0.002);
  }
}

TEST(Lines, RestartGoesOnWithTheAverage) {
  TemporaryFolder folder;
  core::TimeControl time(1, 0.1, 0.1), longer(2, 0.1, 0.1);
  LineSpec spec = line_along_x();
  Lines whole({spec}, time, nullptr), first({spec}, time, nullptr);
  for (int step = 1; step <= 10; ++step) {
    const ParticleColumns particles = tests::make_particles(spread(1000, step));
    whole.sample(step, &particles, nullptr);
    if (step <= 4) first.sample(step, &particles, nullptr);
  }
  core::CheckpointWriter out(folder / "c.h5");
  first.save(out);
  out.close();
  Lines second({spec}, longer, nullptr);  // a later end keeps the average
  second.load(core::CheckpointReader(folder / "c.h5"));
  for (int step = 5; step <= 10; ++step) {
    const ParticleColumns particles = tests::make_particles(spread(1000, step));
    second.sample(step, &particles, nullptr);
  }
  EXPECT_EQ(result(second, folder, "middle").columns, result(whole, folder, "middle").columns);

  spec.points = 5;
  Lines changed({spec}, time, nullptr);
  changed.load(core::CheckpointReader(folder / "c.h5"));
  EXPECT_EQ(result(changed, folder, "middle").columns[3][0], 0);
}

TEST(Lines, UnknownOrMissingQuantity) {
  core::TimeControl time(1, 0.1, 0.1);
  LineSpec spec = line_along_x();
  spec.quantity = "void_fraction";
  EXPECT_THROW(Lines({spec}, time, nullptr), InputError);
  spec.quantity = "particle_velocity";
  EXPECT_THROW(Lines({spec}, time, nullptr), InputError);
}
