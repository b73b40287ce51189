#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/log.hpp"
#include "core/progress.hpp"
#include "tests/core/temporary_folder.hpp"

using namespace pellicle;
using namespace pellicle::core;
using pellicle::tests::TemporaryFolder;

TEST(Csv, TableThereAndBack) {
  TemporaryFolder folder;
  write_csv(folder / "t.csv", {{"x [m]", "value [m/s]"}, {{0.1, 0.2}, {-1.5, -std::nan("")}}});
  EXPECT_EQ(read_file(folder / "t.csv"), "x [m],value [m/s]\n0.1,-1.5\n0.2,nan\n");
  const CsvTable table = read_csv(folder / "t.csv");
  EXPECT_EQ(table.column("x"), (std::vector<double>{0.1, 0.2}));
  EXPECT_EQ(table.column("value [m/s]").front(), -1.5);
  EXPECT_TRUE(std::isnan(table.column("value").back()));
  EXPECT_THROW(table.column("y"), RunError);
}

TEST(Csv, BadLinesAreNamed) {
  TemporaryFolder folder;
  std::ofstream(folder / "t.csv") << "# comment\nx,y\n1,2\n3,zwei\n";
  try {
    read_csv(folder / "t.csv");
    FAIL();
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("t.csv:4: \"zwei\""), std::string::npos) << error.what();
  }
}

TEST(Csv, SeriesResumesAtTheCheckpoint) {
  TemporaryFolder folder;
  const std::vector<std::string> header{"time [s]", "a [-]"};
  const auto row = [](double t, double a) { return std::array<double, 2>{t, a}; };
  {
    CsvSeries series(folder / "s.csv", header);
    for (int i = 0; i < 5; ++i) series.append(row(i * 0.1, i));
    series.flush();
  }
  // As a killed run leaves it: rows after the checkpoint at 0.3 s (which is not 3 * 0.1), the last one cut off.
  std::ofstream(folder / "s.csv", std::ios::app) << "0.5,";
  {
    CsvSeries series(folder / "s.csv", header, 0.3);
    series.append(row(0.4, 40));
  }
  EXPECT_EQ(read_file(folder / "s.csv"), "time [s],a [-]\n0,0\n0.1,1\n0.2,2\n0.3,3\n0.4,40\n");
  {
    CsvSeries series(folder / "s.csv", {"time [s]", "b [-]"}, 0.3);
    series.append(row(0.4, 1));
  }
  EXPECT_EQ(read_file(folder / "s.csv"), "time [s],b [-]\n0.4,1\n");
  EXPECT_TRUE(std::filesystem::exists(folder / "s.csv.old"));
}

TEST(Files, ReplacedAsAWholeOrNotAtAll) {
  TemporaryFolder folder;
  write_file_atomically(folder / "f", "one");
  write_file_atomically(folder / "f", "two");
  EXPECT_EQ(read_file(folder / "f"), "two");
  EXPECT_THROW(write_file_atomically(folder / "no" / "f", "x"), RunError);
  EXPECT_THROW(read_file(folder / "g"), RunError);
}

TEST(Log, FileGetsLevelsAndIsContinued) {
  TemporaryFolder folder;
  log().set_console_level(Log::Level::error);
  log().info("before the folder is known");
  log().open_file(folder / "run.log");
  log().info("{} particles", 12);
  log().debug("hidden");
  log().close_file();
  log().open_file(folder / "run.log");
  log().warn("careful");
  log().close_file();
  log().info("after");
  log().set_console_level(Log::Level::info);
  const std::string text = read_file(folder / "run.log");
  const auto early = text.find("info: before the folder is known\n"),
             later = text.find("info: 12 particles\n");
  EXPECT_NE(early, std::string::npos) << text;
  EXPECT_NE(later, std::string::npos) << text;
  EXPECT_LT(early, later);
  EXPECT_NE(text.find("warning: careful\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("hidden"), std::string::npos);
  EXPECT_EQ(text.find("after"), std::string::npos);
}

TEST(Progress, Durations) {
  EXPECT_EQ(format_duration(0), "0:00:00");
  EXPECT_EQ(format_duration(65.4), "0:01:05");
  EXPECT_EQ(format_duration(3600 * 27 + 61), "1d 3:01:01");
}

TEST(Progress, TimeLeft) {
  const Progress progress(0, 4, [] { return 0.0; });
  EXPECT_EQ(progress.line(0.5, 60), "t = 0.5 s of 4 s (12.5 %), 0:01:00 gone, 0:07:00 left");
  EXPECT_EQ(progress.line(0, 1), "t = 0 s of 4 s (0.0 %), 0:00:01 gone, ? left");
}

// 100 s of wall time at an even pace: a line every 5 s (5 %), so 20; a run of 1000 s: every 10 s for 10 minutes,
// then every minute, so 60 + 6.
TEST(Progress, PlainLinesAreFew) {
  if (log().on_terminal()) GTEST_SKIP() << "needs output that is not a terminal";
  log().set_console_level(Log::Level::error);
  for (const auto& [duration, lines] : {std::pair{100.0, 20}, std::pair{1000.0, 66}}) {
    double now = 0;
    Progress progress(0, 1, [&] { return now; });
    for (int step = 1; step <= 10000; ++step) {
      now = duration * step / 10000;
      progress.update(step / 10000.0);
    }
    EXPECT_NEAR(progress.lines(), lines, 1);
  }
  log().set_console_level(Log::Level::info);
}
