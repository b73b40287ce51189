#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/tools/particles_for_tests.hpp"
#include "tools/pellicle/outputs.hpp"
#include "tools/pellicle/results_folder.hpp"
#include "tools/pellicle/summary.hpp"

using namespace pellicle;
using namespace pellicle::tools;
using pellicle::tests::TemporaryFolder;

TEST(ResultsFolder, ExistingResultsAreGuarded) {
  TemporaryFolder folder;
  const auto path = folder / "results";
  {
    const ResultsFolder results(path, ResultsFolder::Existing::refuse);
    results.write_case("title: a\n");
    std::ofstream(results.csv("lines", "z50mm")) << "x\n";
    std::ofstream(path / "notes.txt") << "mine";
  }
  EXPECT_THROW(ResultsFolder(path, ResultsFolder::Existing::refuse), InputError);
  EXPECT_EQ(core::read_file(path / "case.yaml"), "title: a\n");
  const ResultsFolder resumed(path, ResultsFolder::Existing::resume);
  EXPECT_TRUE(std::filesystem::exists(path / "lines" / "z50mm.csv"));
  EXPECT_FALSE(resumed.has_checkpoint());
  const ResultsFolder fresh(path, ResultsFolder::Existing::overwrite);
  EXPECT_FALSE(std::filesystem::exists(path / "case.yaml"));
  EXPECT_FALSE(std::filesystem::exists(path / "lines"));
  EXPECT_EQ(core::read_file(path / "notes.txt"), "mine");  // what a run did not write stays
}

TEST(ResultsFolder, OtherPeoplesFoldersAreLeftAlone) {
  TemporaryFolder folder;
  std::ofstream(folder / "thesis.tex") << "x";
  EXPECT_THROW(ResultsFolder(folder.path(), ResultsFolder::Existing::overwrite), InputError);
  EXPECT_THROW(ResultsFolder(folder / "thesis.tex", ResultsFolder::Existing::refuse), InputError);
  EXPECT_NO_THROW(ResultsFolder(folder / "new" / "deep", ResultsFolder::Existing::refuse));
}

TEST(Summary, ThereAndBackWithEveryKey) {
  TemporaryFolder folder;
  Summary summary;
  summary.status = "done";
  summary.title = "bed";
  summary.program_version = "0.1.0";
  summary.program_commit = "abc";
  summary.simulated_seconds = 2;
  summary.wall_seconds = 300;
  core::Timers timers;
  timers.add(core::Part::contacts, 80);
  timers.add(core::Part::neighbours, 15);
  timers.add(core::Part::motion, 5);
  summary.set_times(timers);
  core::Ledger ledger;
  ledger.open(core::Conserved::gas_mass, 4.0);
  ledger.set_stock(core::Conserved::gas_mass, 5.0);
  summary.set_defects(ledger);
  summary.defects[1] = std::numeric_limits<double>::quiet_NaN();
  summary.threads = 2;
  summary.particles = 12000;
  summary.particle_steps = 12000.0 * 200000;
  summary.lost_particles = 1;
  write_summary(folder / "summary.json", summary);

  const auto json = nlohmann::json::parse(core::read_file(folder / "summary.json"));
  for (const char* key :
       {"status", "simulated_seconds", "wall_seconds", "wall_by_part", "threads", "particles",
        "particle_steps_per_second", "contacts_per_particle", "largest_overlap", "largest_impact_speed",
        "peak_memory_bytes", "wall_seconds_per_simulated_second", "defects", "lost_particles"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["wall_by_part"].size(), 8u);
  EXPECT_EQ(json["wall_seconds_per_simulated_second"], 150);
  EXPECT_EQ(json["particle_steps_per_second"], 24e6);
  EXPECT_EQ(json["defects"]["gas_mass"], 0.25);

  const Summary back = read_summary(folder / "summary.json");
  EXPECT_EQ(back.status, "done");
  EXPECT_EQ(back.wall_by_part, summary.wall_by_part);
  EXPECT_EQ(back.particles, 12000);
  EXPECT_EQ(back.lost_particles, 1);
  EXPECT_TRUE(std::isnan(back.defects[1]));
  const std::string text = report_text(back);
  EXPECT_NE(text.find("150 s per simulated second, 2 threads"), std::string::npos) << text;
  EXPECT_NE(text.find("80.0 s, 26.7 %"), std::string::npos) << text;

  core::write_file_atomically(folder / "summary.json", "{}");
  EXPECT_THROW(read_summary(folder / "summary.json"), RunError);
}

// A run of 10 steps against one that is broken off after step 7, its checkpoint being of step 5, and resumed: all files
// end up the same.
TEST(Outputs, ResumedRunWritesTheSameFiles) {
  TemporaryFolder folder;
  CaseSpec spec;
  spec.domain.box = {{0, 0, 0}, {1, 1, 1}};
  spec.particles.resize(1);
  LineSpec line;
  line.name = "vz";
  line.from = {0, 0.5, 0.5};
  line.to = {1, 0.5, 0.5};
  line.points = 4;
  line.thickness = 2;
  line.quantity = "particle_velocity_z";
  line.average = {0.2, 1};
  spec.output.lines = {line};
  ProbeSpec bed;
  bed.name = "bed";
  bed.bed = true;
  bed.quantities = {"mean_height", "kinetic_energy"};
  spec.output.probes = {bed};
  HistogramSpec histogram;
  histogram.name = "speed";
  histogram.quantity = "particle_speed";
  histogram.bins = 3;
  histogram.every = 0.2;
  spec.output.histograms = {histogram};
  spec.output.snapshots.every = 0.3;
  spec.output.snapshots.particles = {"velocity"};

  const auto state_at = [](int step) {
    std::vector<tests::MadeUpParticle> made_up;
    made_up.reserve(50);
    for (int id = 0; id < 50; ++id) {
      made_up.push_back({{0.02 * id, 0.5, 0.5}, {0, 0, 0.01 * id * step}, id});
    }
    return tests::make_particles(made_up);
  };
  const auto run = [&](const ResultsFolder& results, int from, int to, std::optional<std::int64_t> resume) {
    core::TimeControl time(1, 0.1, 0.1);
    Outputs outputs(spec, results, time, nullptr, resume);
    if (resume) outputs.load(core::CheckpointReader(results.checkpoint()));
    for (int step = from; step <= to; ++step) {
      const ParticleColumns particles = state_at(step);
      outputs.sample({.step = step, .time = time.time_of(step), .particles = &particles}, step == 10);
      if (step != 5 && step != 10) continue;
      outputs.flush();
      core::CheckpointWriter out(results.checkpoint());
      outputs.save(out);
      out.close();
    }
  };
  const ResultsFolder whole(folder / "whole", ResultsFolder::Existing::refuse);
  run(whole, 0, 10, std::nullopt);
  const ResultsFolder broken(folder / "broken", ResultsFolder::Existing::refuse);
  broken.write_case("title: a\n");
  run(broken, 0, 7, std::nullopt);
  run(broken, 6, 10, 5);
  for (const char* name : {"lines/vz.csv", "probes/bed.csv", "histograms/speed.csv", "particles.xdmf"}) {
    EXPECT_EQ(core::read_file(broken.path() / name), core::read_file(whole.path() / name)) << name;
  }
  EXPECT_GT(core::read_file(whole.path() / "probes/bed.csv").size(), 100u);
  // Snapshots at steps 0, 3, 6, 9 and the last, 10.
  const std::string xdmf = core::read_file(whole.path() / "particles.xdmf");
  EXPECT_NE(xdmf.find("step0000000009"), std::string::npos);
  EXPECT_NE(xdmf.find("step0000000010"), std::string::npos);
}
