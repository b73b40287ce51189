// CSV files of the results folder: a header row of names with units, then numbers.
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace pellicle::core {

/// A whole table, written at once. Columns are all of one length.
struct CsvTable {
  std::vector<std::string> header;           ///< such as "x [m]"
  std::vector<std::vector<double>> columns;  ///< one a header entry

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  /// Column by its header, with or without the unit; throws RunError with the known ones.
  const std::vector<double>& column(const std::string& name) const;
};

/// Replaces the file by the table; numbers with 9 digits (12 in the first column), NaN as "nan". Throws RunError.
void write_csv(const std::filesystem::path& path, const CsvTable& table);

/// Reads a table; lines that begin with # are skipped. Throws RunError with the line.
CsvTable read_csv(const std::filesystem::path& path);

/// A file that grows by rows, the first column being the time [s]. Rows are handed to the operating system by
/// flush() or when 64 kB are waiting, whole rows only.
class CsvSeries {
 public:
  /// Begins a new file, or goes on with the one that is there: rows later than `resume_time` (those of a run that
  /// went on after its last checkpoint) and a half-written last row are dropped. A file with other columns is kept
  /// under another name. Throws RunError.
  CsvSeries(std::filesystem::path path, const std::vector<std::string>& header,
            std::optional<Real> resume_time = std::nullopt);
  ~CsvSeries();
  CsvSeries(CsvSeries&& other) noexcept;
  CsvSeries& operator=(CsvSeries&&) = delete;

  /// One number for each column.
  void append(std::span<const double> row);
  void flush();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::size_t columns_;
  std::string waiting_;
  std::FILE* file_ = nullptr;
};

}  // namespace pellicle::core
