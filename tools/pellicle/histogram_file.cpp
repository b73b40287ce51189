#include "tools/pellicle/histogram_file.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/csv.hpp"
#include "core/files.hpp"
#include "core/hdf5_file.hpp"

namespace pellicle::tools {

namespace {

void write_table(core::Hdf5File& file, const std::string& group, const core::CsvTable& table) {
  const std::vector<double>& time = table.columns.front();
  // Of the last times that have the same number of rows: a run that was resumed with other bins goes on with those.
  const std::size_t rows = table.rows();
  std::size_t begin = rows, bins = 0;
  while (begin > 0) {
    std::size_t first = begin;
    while (first > 0 && time[first - 1] == time[begin - 1]) --first;
    if (bins > 0 && begin - first != bins) break;
    bins = begin - first;
    begin = first;
  }
  const std::size_t times = bins > 0 ? (rows - begin) / bins : 0;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::string& header = table.header[c];
    const std::size_t bracket = header.find(" [");
    const std::string name = group + "/" + header.substr(0, bracket);
    const std::vector<double>& values = table.columns[c];
    if (c == 0) {
      std::vector<double> each(times);
      for (std::size_t n = 0; n < times; ++n) each[n] = values[begin + n * bins];
      file.write<double>(name, each);
    } else {
      file.write<double>(name, std::span(values).subspan(begin), std::array{times, bins});
    }
    if (bracket != std::string::npos)
      file.set_attribute(name, "unit", header.substr(bracket + 2, header.size() - bracket - 3));
  }
}

}  // namespace

void write_histogram_file(const std::filesystem::path& folder) {
  const auto tables = folder / "histograms";
  if (!std::filesystem::exists(tables)) return;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(tables)) {
    if (entry.path().extension() == ".csv") paths.push_back(entry.path());
  }
  if (paths.empty()) return;
  std::sort(paths.begin(), paths.end());
  // Under another name first: who kills the run finds the old file or the new one.
  const auto finished = folder / "histograms.h5";
  const auto unfinished = core::temporary_name(finished);
  {
    core::Hdf5File file(unfinished, core::Hdf5File::Mode::create);
    for (const auto& path : paths) write_table(file, path.stem().string(), core::read_csv(path));
    file.close();
  }
  core::publish_file(unfinished, finished);
}

}  // namespace pellicle::tools
