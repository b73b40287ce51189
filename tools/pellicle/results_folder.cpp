#include "tools/pellicle/results_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.hpp"
#include "core/files.hpp"

namespace pellicle::tools {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 13> files{
    "case.yaml",        "run.log",       "summary.json", "particles.h5", "particles.xdmf",
    "spray.h5",         "spray.xdmf",    "gas.h5",       "gas.xdmf",     "gas_average.h5",
    "gas_average.xdmf", "checkpoint.h5", "histograms.h5"};
constexpr std::array<std::string_view, 4> subfolders{"lines", "probes", "histograms", "zones"};

bool is_name_of_results(const std::string& name) {
  const auto known = [&](const char* file) { return name == file || name == std::string(file) + ".tmp"; };
  return std::any_of(files.begin(), files.end(), known) ||
         std::find(subfolders.begin(), subfolders.end(), name) != subfolders.end();
}

/// The case file or the log tells; a run killed at its very start may have left some of the others alone.
bool holds_results(const fs::path& folder) {
  if (fs::exists(folder / "case.yaml") || fs::exists(folder / "run.log")) return true;
  const auto entries = fs::directory_iterator(folder);
  return !fs::is_empty(folder) && std::all_of(begin(entries), end(entries), [](const auto& entry) {
    return is_name_of_results(entry.path().filename().string());
  });
}

void remove_results(const fs::path& folder) {
  for (const char* name : files) {
    fs::remove(folder / name);
    fs::remove(core::temporary_name(folder / name));
  }
  for (const std::string_view name : subfolders) {
    if (!fs::is_directory(folder / name)) continue;
    for (const auto& entry : fs::directory_iterator(folder / name)) {
      const auto extension = entry.path().extension();
      if (extension == ".csv" || extension == ".tmp" || extension == ".old") fs::remove(entry.path());
    }
    std::error_code not_empty;
    fs::remove(folder / name, not_empty);
  }
}

}  // namespace

ResultsFolder::ResultsFolder(fs::path folder, Existing existing) : path_(std::move(folder)) {
  try {
    if (fs::exists(path_)) {
      if (!fs::is_directory(path_))
        throw InputError(path_.string() + ": is a file, not a folder for results");
      if (!holds_results(path_)) {
        if (!fs::is_empty(path_)) {
          throw InputError(
              path_.string() +
              ": holds files but no results of an earlier run; give another folder with --output");
        }
      } else if (existing == Existing::refuse) {
        throw InputError(
            path_.string() +
            ": holds results already; --overwrite replaces them, --resume goes on with that run, "
            "--output names another folder");
      } else if (existing == Existing::overwrite) {
        remove_results(path_);
      }
    }
    fs::create_directories(path_);
  } catch (const fs::filesystem_error& error) {
    throw InputError(
        fmt::format("{}: cannot be used for results: {}", path_.string(), error.code().message()));
  }
}

fs::path ResultsFolder::csv(std::string_view kind, const std::string& name) const {
  const fs::path subfolder = path_ / kind;
  std::error_code error;
  fs::create_directories(subfolder, error);
  if (error) throw RunError(fmt::format("{}: cannot be made: {}", subfolder.string(), error.message()));
  return subfolder / (name + ".csv");
}

bool ResultsFolder::has_checkpoint() const { return fs::exists(checkpoint()); }

void ResultsFolder::write_case(const std::string& resolved_yaml) const {
  core::write_file_atomically(case_file(), resolved_yaml);
}

}  // namespace pellicle::tools
