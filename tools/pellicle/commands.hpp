// What each command of the program does; main.cpp reads the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace pellicle::tools {

struct RunArguments {
  std::string case_file;
  std::optional<std::string> output;   ///< default results/CASE
  std::vector<std::string> overrides;  ///< `path=value`
  std::optional<std::string> until;    ///< a time such as "0.5 s"
  bool resume = false;
  bool overwrite = false;
  int threads = 0;  ///< 0: as many as OpenMP would take
};

// Each prints to stdout and returns the exit code; throws InputError or RunError.

/// Runs a case. Nothing in an existing results folder changes before the case has been read and checked.
int run_command(const RunArguments& arguments);
/// Reads a case, checks it, and says what it comes to.
int check_command(const std::string& case_file, const std::vector<std::string>& overrides);
/// Lists all models; of one family if `family` is the end of its key, such as "drag".
int models_command(const std::string& family);
/// Prints the JSON schema of case files, or the reference of their keys in Markdown.
int schema_command(bool markdown);
/// What a results folder or a checkpoint holds.
int info_command(const std::string& path);
/// A readable account of a run.
int report_command(const std::string& folder);

/// What a case comes to, one line a fact: counts, cells, steps, Courant numbers.
std::string describe_case_text(const struct CaseSpec& spec);

}  // namespace pellicle::tools
