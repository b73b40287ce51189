// What verification cases leave behind: lines of the table in docs/validation/dem.md, and curves beside it.
//
// With PELLICLE_VERIFICATION set to a folder, each line is appended to its table.csv and each curve becomes a file of
// its own (tools/validation/run_dem makes the page from them). Without it the tests only check.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/csv.hpp"

namespace pellicle::tests {

/// Six digits.
inline std::string show(Real value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// Folder that takes what a run leaves behind; empty where nothing is kept.
inline std::filesystem::path verification_folder() {
  const char* folder = std::getenv("PELLICLE_VERIFICATION");
  return folder != nullptr ? folder : "";
}

/// Appends one line to the table. A field may hold anything but a line break.
inline void append_line(const std::string& line, const std::string& expected, const std::string& got,
                        const std::string& tolerance, bool holds, const std::string& why) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::printf("%s: expected %s, got %s, tolerance %s\n", line.c_str(), expected.c_str(), got.c_str(),
              tolerance.c_str());
  const auto folder = verification_folder();
  if (folder.empty()) return;
  std::string row;
  const std::string name = std::string(test->test_suite_name()) + "." + test->name();
  for (const std::string& field :
       {line, expected, got, tolerance, std::string(holds ? "yes" : "NO"), why, name}) {
    std::string quoted = "\"";
    for (const char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    row += (row.empty() ? "" : ",") + quoted + "\"";
  }
  row += "\n";
  const auto path = folder / "table.csv";
  std::FILE* file = std::fopen(path.c_str(), "a");
  ASSERT_NE(file, nullptr) << path;
  EXPECT_EQ(std::fputs(row.c_str(), file) < 0, false);
  EXPECT_EQ(std::fclose(file), 0);
}

/// A line that holds where |got − expected| ≤ tolerance; a test expectation as well.
inline void expect_line(const std::string& line, Real expected, Real got, Real tolerance,
                        const std::string& why) {
  const bool holds = std::abs(got - expected) <= tolerance;
  append_line(line, show(expected), show(got), show(tolerance), holds, why);
  EXPECT_TRUE(holds) << line << ": expected " << expected << " ± " << tolerance << ", got " << got;
}

/// A line that holds where low ≤ got ≤ high.
inline void expect_between(const std::string& line, Real low, Real high, Real got, const std::string& why) {
  const bool holds = got >= low && got <= high;
  append_line(line, show(low) + " to " + show(high), show(got), "-", holds, why);
  EXPECT_TRUE(holds) << line << ": expected " << low << " to " << high << ", got " << got;
}

/// A line that holds where |got| ≤ bound.
inline void expect_small(const std::string& line, Real got, Real bound, const std::string& why) {
  const bool holds = std::abs(got) <= bound;
  append_line(line, "0", show(got), show(bound), holds, why);
  EXPECT_TRUE(holds) << line << ": got " << got << ", bound " << bound;
}

/// A figure for the record, without a bar.
inline void record_line(const std::string& line, const std::string& expected, Real got,
                        const std::string& why) {
  append_line(line, expected, show(got), "recorded", true, why);
}

/// Keeps a table of numbers as NAME.csv.
inline void keep_curve(const std::string& name, const core::CsvTable& table) {
  const auto folder = verification_folder();
  if (!folder.empty()) core::write_csv(folder / (name + ".csv"), table);
}

}  // namespace pellicle::tests
