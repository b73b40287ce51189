// Messages to the person who runs the program: on the console and in the results folder's run.log.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace pellicle::core {

/// The program's one logger. On a terminal a status line (the progress) stays below the messages; where the output
/// is not a terminal only plain lines appear. Warnings and errors go to stderr, the rest to stdout. spdlog does the
/// work and stays out of this header, so that every folder may include it.
class Log {
 public:
  enum class Level { debug, info, warning, error };

  template <class... Args>
  void debug(fmt::format_string<Args...> format, Args&&... args) {
    message(Level::debug, fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  void info(fmt::format_string<Args...> format, Args&&... args) {
    message(Level::info, fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  void warn(fmt::format_string<Args...> format, Args&&... args) {
    message(Level::warning, fmt::format(format, std::forward<Args>(args)...));
  }
  template <class... Args>
  void error(fmt::format_string<Args...> format, Args&&... args) {
    message(Level::error, fmt::format(format, std::forward<Args>(args)...));
  }
  void message(Level level, std::string_view text);

  /// Also writes to this file from now on, each line with date, time and level, after the messages since the start of
  /// the program (or since the last file was closed); throws RunError if it cannot. An existing file is continued.
  void open_file(const std::filesystem::path& path);
  void close_file();
  /// To the file alone.
  void file_only(Level level, std::string_view text);

  /// Messages below this level are not shown on the console; the file gets all but debug. Default info.
  void set_console_level(Level level);
  /// True if stdout is a terminal that understands cursor movement.
  bool on_terminal() const;
  /// Text of the status line on a terminal, redrawn after each message; empty removes it.
  void set_status(std::string_view text);

 private:
  friend Log& log();
  Log();
  ~Log();
  struct Impl;
  Impl* impl_;
};

/// The logger: `core::log().info("{} particles", n)`.
Log& log();

}  // namespace pellicle::core
