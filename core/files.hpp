// Files that a crash leaves either as they were or complete.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace pellicle::core {

/// Whole content of a text file; throws RunError if it cannot be read.
std::string read_file(const std::filesystem::path& path);

/// Replaces the file by `content`: written beside it, then renamed, so that a program that is killed leaves the old or
/// the new one. It is not waited for the disk, which a power failure would take: that costs tens of milliseconds.
/// Throws RunError (disk full).
void write_file_atomically(const std::filesystem::path& path, std::string_view content);

/// Flushes the file's data to disk, renames it to `path` (replacing what is there) and flushes the folder: whatever
/// happens then, power failure included, leaves the old or the new one.
void publish_file(const std::filesystem::path& temporary, const std::filesystem::path& path);

/// "PATH.tmp": where a file is written before it replaces PATH.
std::filesystem::path temporary_name(const std::filesystem::path& path);

}  // namespace pellicle::core
