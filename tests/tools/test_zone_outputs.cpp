// Figures of zones and of the coating, and joint histograms, against numbers worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/csv.hpp"
#include "core/hdf5_file.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/tools/particles_for_tests.hpp"
#include "tools/pellicle/coating_figures.hpp"
#include "tools/pellicle/histogram_file.hpp"
#include "tools/pellicle/probes.hpp"
#include "tools/pellicle/zone_outputs.hpp"

namespace pellicle::tools {
namespace {

TEST(ZoneFigures, ByHand) {
  spray::ZoneSums sums;
  sums.particles = 4;
  sums.entries = 5;
  sums.visits = 3;
  sums.residence = 1.5;
  sums.cycles = 3;  // times 2, 3, 7 s; gains 1, 1, 4 kg
  sums.cycle_time = 12;
  sums.cycle_time_squared = 62;
  sums.gain = 6;
  sums.gain_squared = 18;
  sums.time_gain = 33;
  sums.solids = 8;  // 1, 1, 2, 4 kg
  sums.solids_squared = 22;
  const ZoneFigures figures = compute_zone_figures(sums, 10);
  EXPECT_DOUBLE_EQ(figures.mean_residence, 0.5);
  EXPECT_DOUBLE_EQ(figures.mean_cycle_time, 4);
  EXPECT_DOUBLE_EQ(figures.sd_cycle_time, std::sqrt(7.0));  // (4 + 1 + 9) / 2
  EXPECT_DOUBLE_EQ(figures.steady_cycle_time, 8);           // 4 x 10 / 5
  EXPECT_DOUBLE_EQ(figures.mean_gain, 2);
  EXPECT_DOUBLE_EQ(figures.sd_gain, std::sqrt(3.0));  // (1 + 1 + 4) / 2
  // Covariance (2 + 1 + 6) / 2 = 4.5.
  EXPECT_NEAR(figures.correlation, 4.5 / std::sqrt(21.0), 1e-14);
  EXPECT_DOUBLE_EQ(figures.coating_mean, 2);
  EXPECT_DOUBLE_EQ(figures.coating_variation, std::sqrt(2.0) / 2);  // (1 + 1 + 0 + 4) / 3 = 2
  EXPECT_TRUE(std::isnan(compute_zone_figures({}, 1).mean_cycle_time));
}

TEST(CoatingFigures, ByHand) {
  HostParticles particles = copy_to_host(
      tests::make_particles({{{}, {}, 0, 1e-3}, {{}, {}, 1, 1e-3}, {{}, {}, 2, 1e-3}, {{}, {}, 3, 2e-3}}));
  particles.solids_density = 1500;
  // Solids 0, 2, 2, 4 ug: mean 2, standard deviation sqrt(2).
  particles.film = {{0, 0}, {1e-9, 2e-9}, {0, 2e-9}, {0, 4e-9}};
  particles.temperature = {300, 310, 320, 330};
  const CoatingFigures coating = compute_coating_figures(particles);
  EXPECT_DOUBLE_EQ(coating_quantity("coating_mass", coating), 8e-9);
  EXPECT_DOUBLE_EQ(coating_quantity("coating_mass_mean", coating), 2e-9);
  EXPECT_NEAR(coating_quantity("coating_mass_cov", coating), std::sqrt(2.0) / 2, 1e-14);
  EXPECT_DOUBLE_EQ(coating_quantity("coated_share", coating), 0.75);
  EXPECT_DOUBLE_EQ(coating_quantity("wet_share", coating), 0.25);
  EXPECT_DOUBLE_EQ(coating_quantity("film_liquid_mass", coating), 1e-9);
  EXPECT_DOUBLE_EQ(coating_quantity("particle_temperature_mean", coating), 315);
  // Flat films m / (4 pi R2 rho), to the relative thickness of 1e-4: 2 ug on 1 mm and 4 ug on 2 mm (a half).
  const Real one = 2e-9 / (4 * M_PI * 1e-6 * 1500);
  EXPECT_NEAR(coating_quantity("coating_thickness_mean", coating), (2 * one + 0.5 * one) / 4, 2e-4 * one);
}

TEST(Histograms, JointDistribution) {
  tests::TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(1, 0.1, 0.1);
  HistogramSpec spec;
  spec.name = "joint";
  spec.quantity = "particle_velocity_z";
  spec.bins = 2;
  spec.min = 0;
  spec.max = 2;
  spec.against = "particle_diameter";
  spec.against_bins = 3;
  spec.against_min = 1e-3;
  spec.against_max = 4e-3;
  Histograms histograms({spec}, time, results, std::nullopt);
  // Velocity and diameter: (0.5, 2.5 mm), (1.5, 3.5 mm), (1.5, 4 mm: the end of the last bin), (3: outside).
  const ParticleColumns particles = tests::make_particles({{{}, {0, 0, 0.5}, 0, 1.25e-3},
                                                           {{}, {0, 0, 1.5}, 1, 1.75e-3},
                                                           {{}, {0, 0, 1.5}, 2, 2e-3},
                                                           {{}, {0, 0, 3}, 3, 1.25e-3}});
  histograms.sample({.step = 1, .time = 0.1, .particles = &particles}, true);
  histograms.flush();
  const auto table = core::read_csv(results.csv("histograms", "joint"));
  EXPECT_EQ(table.header[3], "particle_diameter_from [m]");
  EXPECT_EQ(table.columns[5], (std::vector<double>{0, 1, 0, 0, 0, 2}));
  // Share of all four over the bin's 1 m/s x 1 mm.
  EXPECT_NEAR(table.columns[6][1], 0.25 / 1e-3, 1e-9);
  EXPECT_NEAR(table.columns[3][1], 2e-3, 1e-12);
  EXPECT_NEAR(table.columns[1][5], 1, 1e-12);
}

TEST(Histograms, OneHdf5FileHoldsThemAll) {
  const tests::TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  write_histogram_file(results.path());
  EXPECT_FALSE(std::filesystem::exists(results.path() / "histograms.h5")) << "of nothing";
  core::write_csv(results.csv("histograms", "speed"),
                  {{"time [s]", "from [m/s]", "count [-]"},
                   {{0, 0, 0, 0.5, 0.5, 0.5}, {0, 1, 2, 0, 1, 2}, {7, 8, 9, 10, 11, 12}}});
  core::write_csv(results.csv("histograms", "empty"), {{"time [s]", "count [-]"}, {{}, {}}});
  for (int again = 0; again < 2; ++again) write_histogram_file(results.path());
  const core::Hdf5File file(results.path() / "histograms.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.members("/"), (std::vector<std::string>{"empty", "speed"}));
  EXPECT_EQ(file.read<double>("speed/time"), (std::vector<double>{0, 0.5}));
  EXPECT_EQ(file.shape("speed/count"), (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(file.read<double>("speed/count"), (std::vector<double>{7, 8, 9, 10, 11, 12}));
  EXPECT_TRUE(file.has_attribute("speed/from", "unit"));
  EXPECT_EQ(file.shape("empty/time"), (std::vector<std::size_t>{0}));
}

// A run that was resumed with two bins in place of three: the file has the times since; the table has all.
TEST(Histograms, Hdf5FileHasTheTimesOfTheBinsAtHand) {
  const tests::TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::write_csv(results.csv("histograms", "speed"),
                  {{"time [s]", "count [-]"},
                   {{0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1.5, 1.5}, {7, 8, 9, 10, 11, 12, 13, 14, 15, 16}}});
  write_histogram_file(results.path());
  const core::Hdf5File file(results.path() / "histograms.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.read<double>("speed/time"), (std::vector<double>{1, 1.5}));
  EXPECT_EQ(file.shape("speed/count"), (std::vector<std::size_t>{2, 2}));
  EXPECT_EQ(file.read<double>("speed/count"), (std::vector<double>{13, 14, 15, 16}));
}

}  // namespace
}  // namespace pellicle::tools
