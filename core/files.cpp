#include "core/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/error.hpp"

namespace pellicle::core {

namespace {

[[noreturn]] void fail(const std::string& what, const std::filesystem::path& path) {
  const std::string why = std::strerror(errno);
  throw RunError(fmt::format("{}: {}: {}", path.string(), what, why));
}

void flush_to_disk(const std::filesystem::path& path, int flags) {
  const int file = ::open(path.c_str(), flags | O_CLOEXEC);
  if (file < 0) fail("cannot be opened", path);
  const bool flushed = ::fsync(file) == 0;
  const int error = errno;
  ::close(file);
  errno = error;
  // Some file systems refuse to flush a folder: the rename is then as safe as it can be.
  if (!flushed && (flags & O_DIRECTORY) == 0) fail("cannot be written to disk", path);
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) fail("cannot be read", path);
  std::ostringstream text;
  text << in.rdbuf();
  if (in.bad()) fail("cannot be read", path);
  return std::move(text).str();
}

std::filesystem::path temporary_name(const std::filesystem::path& path) {
  std::filesystem::path temporary = path;
  temporary += ".tmp";
  return temporary;
}

void publish_file(const std::filesystem::path& temporary, const std::filesystem::path& path) {
  flush_to_disk(temporary, O_RDWR);
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot be replaced", path);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  flush_to_disk(folder, O_RDONLY | O_DIRECTORY);
}

void write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  const std::filesystem::path temporary = temporary_name(path);
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) fail("cannot be written", temporary);
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  const int error = errno;
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed) {
    if (!written) errno = error;
    const int kept = errno;
    std::remove(temporary.c_str());
    errno = kept;
    fail("cannot be written", path);
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail("cannot be replaced", path);
}

}  // namespace pellicle::core
