// A test that runs itself again in a child process: the number of threads is set when a process starts.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <string>

namespace pellicle::tests {

inline constexpr const char* child_variable = "PELLICLE_TEST_CHILD";
inline constexpr const char* child_mark = "child: ";

/// Whether this process is such a child; its answer is the line `child_mark` + text on standard output.
inline bool is_child() { return std::getenv(child_variable) != nullptr; }
inline void answer(const std::string& text) { std::printf("\n%s%s\n", child_mark, text.c_str()); }

/// Runs the present test in a child with this many threads; returns what it answered, or what went wrong.
inline std::string ask_child(int threads) {
  std::array<char, 4096> path{};
  if (readlink("/proc/self/exe", path.data(), path.size() - 1) <= 0)
    return "this executable is not to be found";
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  const std::string command =
      std::string(child_variable) +
      "=1 OMP_PROC_BIND=false OMP_WAIT_POLICY=passive OMP_NUM_THREADS=" + std::to_string(threads) + " '" +
      path.data() + "' --gtest_filter=" + test.test_suite_name() + "." + test.name();
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "cannot run: " + command;
  std::string line;
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) {
    if (std::strncmp(part.data(), child_mark, std::strlen(child_mark)) == 0) {
      line = part.data() + std::strlen(child_mark);
    }
  }
  while (!line.empty() && line.back() == '\n') line.pop_back();
  return pclose(pipe) == 0 ? line : "failed: " + command;
}

/// Expects that a child answers `N threads HASH` with the same hash for each number of threads.
inline void expect_same_answer(std::initializer_list<int> numbers_of_threads) {
  std::string hash;
  for (const int threads : numbers_of_threads) {
    const std::string prefix = std::to_string(threads) + " threads ";
    const std::string line = ask_child(threads);
    ASSERT_EQ(line.substr(0, prefix.size()), prefix);
    if (hash.empty()) hash = line.substr(prefix.size());
    EXPECT_EQ(line, prefix + hash);
  }
}

}  // namespace pellicle::tests
