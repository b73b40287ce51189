#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "core/hdf5_file.hpp"
#include "tools/pellicle/commands.hpp"
#include "tools/pellicle/summary.hpp"

namespace pellicle::tools {

namespace {

namespace fs = std::filesystem;

std::string size_text(std::uintmax_t bytes) {
  if (bytes >= 1'000'000'000) return fmt::format("{:.1f} GB", static_cast<double>(bytes) / 1e9);
  if (bytes >= 1'000'000) return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
  return fmt::format("{:.1f} kB", static_cast<double>(bytes) / 1e3);
}

/// The summary of a results folder.
Summary summary_of(const fs::path& folder) {
  const fs::path path = folder / "summary.json";
  if (!fs::exists(path)) {
    throw InputError(fmt::format("{}: no results, there is no summary.json; a folder that a run has left",
                                 folder.string()));
  }
  return read_summary(path);
}

void list_group(const core::Hdf5File& file, const std::string& group) {
  for (const auto& name : file.members(group)) {
    const std::string path = group == "/" ? name : group + "/" + name;
    std::string shape;
    try {
      for (const std::size_t extent : file.shape(path))
        shape += (shape.empty() ? "" : " x ") + std::to_string(extent);
    } catch (const RunError&) {  // a group, not an array
      list_group(file, path);
      continue;
    }
    fmt::print("  {:<40} {}\n", path, shape);
  }
}

void describe_checkpoint(const fs::path& path) {
  const core::Hdf5File file(path, core::Hdf5File::Mode::read);
  fmt::print("{}: checkpoint, {}\n", path.string(), size_text(fs::file_size(path)));
  if (file.has("time/step") && file.has("time/gas_step")) {
    const auto step = file.read_int64("time/step");
    fmt::print("  t = {:g} s, outer step {}\n", static_cast<Real>(step) * file.read_double("time/gas_step"),
               step);
  }
  list_group(file, "/");
}

}  // namespace

int info_command(const std::string& path) {
  if (!fs::exists(path))
    throw InputError(
        fmt::format("{}: there is no such file or folder; a results folder or a checkpoint", path));
  if (!fs::is_directory(path)) {
    try {
      describe_checkpoint(path);
    } catch (const RunError& error) {
      throw InputError(fmt::format("{}; a results folder or a checkpoint", error.what()));
    }
    return 0;
  }
  const Summary summary = summary_of(path);
  fmt::print("{}: {}\n  status {}, t = {:g} s\n", path, summary.title, summary.status,
             summary.simulated_seconds);
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    fmt::print("  {:<40} {}\n", fs::relative(file, path).string(), size_text(fs::file_size(file)));
  }
  return 0;
}

int report_command(const std::string& folder) {
  fmt::print("{}", report_text(summary_of(folder)));
  return 0;
}

}  // namespace pellicle::tools
