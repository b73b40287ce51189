#include "core/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>
#include <utility>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/log.hpp"

namespace pellicle::core {

namespace {

constexpr std::size_t buffer_size = 65536;
constexpr int usual_digits = 9;
constexpr int first_column_digits = 12;  // times: a run may have 1e9 steps

std::string header_line(const std::vector<std::string>& header) {
  return fmt::format("{}\n", fmt::join(header, ","));
}

void append_number(std::string& text, double value, int digits) {
  if (std::isfinite(value) && value == std::trunc(value) && std::abs(value) < 1e15) {
    fmt::format_to(std::back_inserter(text), "{:.0f}", value);
  } else if (std::isnan(value)) {
    text += "nan";  // a NaN's sign means nothing
  } else {
    fmt::format_to(std::back_inserter(text), "{:.{}g}", value, digits);
  }
}

template <class Row>
void append_row(std::string& text, std::size_t columns, const Row& number) {
  for (std::size_t c = 0; c < columns; ++c) {
    if (c > 0) text += ',';
    append_number(text, number(c), c == 0 ? first_column_digits : usual_digits);
  }
  text += '\n';
}

std::string bare_name(const std::string& header) { return header.substr(0, header.find(" [")); }

double parse_number(std::string_view text, const std::filesystem::path& path, std::size_t line) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '+')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
  if (text == "nan") return std::nan("");
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) {
    throw RunError(fmt::format("{}:{}: \"{}\" is not a number", path.string(), line, text));
  }
  return value;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  std::string field;
  while (std::getline(in, field, ',')) fields.push_back(field);
  return fields;
}

/// The part of an interrupted series that belongs to the time up to `time`; empty if the header is another.
std::string kept_part(const std::string& content, const std::string& header, Real time) {
  if (!content.starts_with(header)) return {};
  // The row at the checkpoint's time was rounded when printed: it may read back slightly later.
  const Real limit = time + 1e-11 * std::abs(time);
  std::size_t end = header.size();
  while (true) {
    const std::size_t next = content.find('\n', end);
    if (next == std::string::npos) break;
    double row_time = 0;
    const auto parsed = std::from_chars(content.data() + end, content.data() + next, row_time);
    if (parsed.ec != std::errc{} || row_time > limit) break;
    end = next + 1;
  }
  return content.substr(0, end);
}

}  // namespace

const std::vector<double>& CsvTable::column(const std::string& name) const {
  for (std::size_t c = 0; c < header.size(); ++c) {
    if (header[c] == name || bare_name(header[c]) == name) return columns[c];
  }
  throw RunError(fmt::format("there is no column {} among {}", name, fmt::join(header, ", ")));
}

void write_csv(const std::filesystem::path& path, const CsvTable& table) {
  std::string text = header_line(table.header);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    append_row(text, table.columns.size(), [&](std::size_t c) { return table.columns[c].at(row); });
  }
  write_file_atomically(path, text);
}

CsvTable read_csv(const std::filesystem::path& path) {
  std::istringstream in(read_file(path));
  CsvTable table;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    const auto fields = split(line);
    if (table.header.empty()) {
      table.header = fields;
      table.columns.resize(fields.size());
      continue;
    }
    if (fields.size() != table.header.size()) {
      throw RunError(fmt::format("{}:{}: {} values for {} columns", path.string(), number, fields.size(),
                                 table.header.size()));
    }
    for (std::size_t c = 0; c < fields.size(); ++c) {
      table.columns[c].push_back(parse_number(fields[c], path, number));
    }
  }
  return table;
}

CsvSeries::CsvSeries(std::filesystem::path path, const std::vector<std::string>& header,
                     std::optional<Real> resume_time)
    : path_(std::move(path)), columns_(header.size()) {
  const std::string first = header_line(header);
  std::string content = first;
  if (resume_time && std::filesystem::exists(path_)) {
    const std::string old = read_file(path_);
    content = kept_part(old, first, *resume_time);
    if (content.empty()) {
      content = first;
      if (old.find('\n') != std::string::npos) {
        std::filesystem::path aside = path_;
        aside += ".old";
        std::filesystem::rename(path_, aside);
        log().warn("{}: has other columns than before; the earlier rows are kept as {}", path_.string(),
                   aside.filename().string());
      }
    }
  }
  write_file_atomically(path_, content);
  file_ = std::fopen(path_.c_str(), "ab");
  if (file_ == nullptr) {
    throw RunError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
  }
}

CsvSeries::CsvSeries(CsvSeries&& other) noexcept
    : path_(std::move(other.path_)),
      columns_(other.columns_),
      waiting_(std::move(other.waiting_)),
      file_(std::exchange(other.file_, nullptr)) {}

CsvSeries::~CsvSeries() {
  if (file_ == nullptr) return;
  std::fwrite(waiting_.data(), 1, waiting_.size(), file_);
  std::fclose(file_);
}

void CsvSeries::append(std::span<const double> row) {
  if (row.size() != columns_) {
    throw std::logic_error(
        fmt::format("{}: {} numbers for {} columns", path_.string(), row.size(), columns_));
  }
  append_row(waiting_, columns_, [&](std::size_t c) { return row[c]; });
  if (waiting_.size() >= buffer_size) flush();
}

void CsvSeries::flush() {
  const bool written = std::fwrite(waiting_.data(), 1, waiting_.size(), file_) == waiting_.size();
  const bool flushed = std::fflush(file_) == 0;
  waiting_.clear();
  if (!written || !flushed) {
    throw RunError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
  }
}

}  // namespace pellicle::core
