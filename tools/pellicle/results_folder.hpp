// The folder that a run leaves behind; docs/results.md describes every file in it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pellicle::tools {

/// Lays out and guards a results folder.
class ResultsFolder {
 public:
  enum class Existing { refuse, overwrite, resume };

  /// Makes the folder if it is not there. If it holds results already: `refuse` throws InputError; `overwrite`
  /// removes the files that a run writes, and only those; `resume` keeps them. A folder that holds other things but
  /// no results is never written into (InputError).
  ResultsFolder(std::filesystem::path folder, Existing existing);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path checkpoint() const { return path_ / "checkpoint.h5"; }
  std::filesystem::path run_log() const { return path_ / "run.log"; }
  std::filesystem::path summary() const { return path_ / "summary.json"; }
  std::filesystem::path case_file() const { return path_ / "case.yaml"; }
  /// lines/NAME.csv, probes/NAME.csv, histograms/NAME.csv; the subfolder is made.
  std::filesystem::path csv(std::string_view kind, const std::string& name) const;
  bool has_checkpoint() const;

  /// The case as run, with all defaults filled in.
  void write_case(const std::string& resolved_yaml) const;

 private:
  std::filesystem::path path_;
};

}  // namespace pellicle::tools
