#include "core/checkpoint.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <cstring>
#include <map>
#include <set>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/hdf5_file.hpp"
#include "core/version.hpp"

namespace pellicle::core {

namespace {

/// Raised whenever an older program could no longer read the file, or this one an older file.
constexpr std::int64_t checkpoint_format = 1;
constexpr const char* format_name = "checkpoint/format";

std::span<const double> components(std::span<const Vec3> values) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && std::is_standard_layout_v<Vec3>);
  return {values.empty() ? nullptr : &values.front().x, 3 * values.size()};
}

}  // namespace

struct CheckpointWriter::Impl {
  std::filesystem::path path;
  Hdf5File file;
};

CheckpointWriter::CheckpointWriter(std::filesystem::path path)
    : impl_(new Impl{path, Hdf5File(temporary_name(path), Hdf5File::Mode::create)}) {
  write(format_name, checkpoint_format);
  write("checkpoint/program", version());
}

CheckpointWriter::~CheckpointWriter() {
  if (!impl_) return;
  const auto temporary = temporary_name(impl_->path);
  impl_.reset();
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
}

void CheckpointWriter::write(std::string_view name, std::span<const double> values) {
  impl_->file.write(name, values);
}
void CheckpointWriter::write(std::string_view name, std::span<const std::int32_t> values) {
  impl_->file.write(name, values);
}
void CheckpointWriter::write(std::string_view name, std::span<const std::int64_t> values) {
  impl_->file.write(name, values);
}
void CheckpointWriter::write(std::string_view name, std::span<const Vec3> values) {
  impl_->file.write(name, components(values), std::array<std::size_t, 2>{values.size(), 3});
}
void CheckpointWriter::write(std::string_view name, double value) { impl_->file.write_number(name, value); }
void CheckpointWriter::write(std::string_view name, std::int64_t value) {
  impl_->file.write_number(name, value);
}
void CheckpointWriter::write(std::string_view name, const std::string& text) {
  impl_->file.write_text(name, text);
}
void CheckpointWriter::write_bytes(std::string_view name, std::span<const std::byte> bytes) {
  impl_->file.write(name, std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

void CheckpointWriter::close() {
  const auto path = impl_->path;
  impl_->file.close();
  publish_file(temporary_name(path), path);
  impl_.reset();
}

struct CheckpointReader::Impl {
  Hdf5File file;
};

CheckpointReader::CheckpointReader(std::filesystem::path path) {
  if (!std::filesystem::exists(path)) throw InputError(path.string() + ": there is no checkpoint");
  std::int64_t format = 0;
  try {
    impl_.reset(new Impl{Hdf5File(path, Hdf5File::Mode::read)});
    format = impl_->file.read_int64(format_name);
  } catch (const RunError& error) {
    throw InputError(
        fmt::format("{}: not a checkpoint of pellicle, or damaged ({})", path.string(), error.what()));
  }
  if (format != checkpoint_format) {
    throw InputError(
        fmt::format("{}: checkpoint format {}; this program reads format {} (written by pellicle {})",
                    path.string(), format, checkpoint_format, read_string("checkpoint/program")));
  }
}

CheckpointReader::~CheckpointReader() = default;

std::vector<double> CheckpointReader::read_doubles(std::string_view name) const {
  return impl_->file.read<double>(name);
}
std::vector<std::int32_t> CheckpointReader::read_int32s(std::string_view name) const {
  return impl_->file.read<std::int32_t>(name);
}
std::vector<std::int64_t> CheckpointReader::read_int64s(std::string_view name) const {
  return impl_->file.read<std::int64_t>(name);
}

std::vector<Vec3> CheckpointReader::read_vec3s(std::string_view name) const {
  const auto numbers = read_doubles(name);
  std::vector<Vec3> values(numbers.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  }
  return values;
}

double CheckpointReader::read_double(std::string_view name) const { return impl_->file.read_double(name); }
std::int64_t CheckpointReader::read_int64(std::string_view name) const {
  return impl_->file.read_int64(name);
}

Vec3 CheckpointReader::read_vec3(std::string_view name) const {
  const auto values = read_vec3s(name);
  if (values.size() != 1) {
    throw RunError(fmt::format("{}: {} is not one vector", impl_->file.path().string(), name));
  }
  return values.front();
}

std::string CheckpointReader::read_string(std::string_view name) const { return impl_->file.read_text(name); }

std::vector<std::byte> CheckpointReader::read_bytes(std::string_view name) const {
  const auto values = impl_->file.read<std::uint8_t>(name);
  std::vector<std::byte> bytes(values.size());
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

bool CheckpointReader::has(std::string_view name) const { return impl_->file.has(name); }

void CheckpointReader::copy(std::string_view name, std::span<const std::byte> from, void* to,
                            std::size_t size) const {
  if (from.size() != size) {
    throw RunError(fmt::format("{}: {} holds {} bytes where this run needs {}", impl_->file.path().string(),
                               name, from.size(), size));
  }
  if (size > 0) std::memcpy(to, from.data(), size);
}

namespace {

using FlatCase = std::map<std::string, std::string>;

void flatten(const YAML::Node& node, const std::string& path, FlatCase& flat) {
  if (node.IsMap()) {
    for (const auto& entry : node) {
      const auto key = entry.first.as<std::string>();
      flatten(entry.second, path.empty() ? key : path + "." + key, flat);
    }
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i) flatten(node[i], path + "." + std::to_string(i), flat);
  } else {
    flat[path] = node.IsNull() ? "(empty)" : node.as<std::string>();
  }
}

bool may_change(const std::string& path) {
  return path == "title" || path == "time.end" || path == "output" || path.starts_with("output.");
}

}  // namespace

void require_same_case(const std::string& checkpoint_case, const std::string& present_case) {
  FlatCase then, now;
  flatten(YAML::Load(checkpoint_case), "", then);
  flatten(YAML::Load(present_case), "", now);
  std::set<std::string> paths;
  for (const auto& [path, value] : then) paths.insert(path);
  for (const auto& [path, value] : now) paths.insert(path);

  constexpr int most_named = 5;
  std::string differences;
  int count = 0;
  for (const auto& path : paths) {
    const auto before = then.find(path), after = now.find(path);
    const std::string old_value = before == then.end() ? "absent" : before->second;
    const std::string new_value = after == now.end() ? "absent" : after->second;
    if (may_change(path) || old_value == new_value) continue;
    if (++count <= most_named) {
      differences += fmt::format("\n  {}: {} in the checkpoint, {} now", path, old_value, new_value);
    }
  }
  if (count == 0) return;
  if (count > most_named) differences += fmt::format("\n  and {} more", count - most_named);
  throw InputError(
      "the case differs from the one that the checkpoint belongs to; only title, time.end and output may "
      "change on --resume:" +
      differences);
}

}  // namespace pellicle::core
