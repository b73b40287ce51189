#include "core/log.hpp"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/warn.hpp"

namespace pellicle::core {

namespace {

constexpr std::size_t most_early_messages =
    1000;  // a program that opens no file must not collect them forever

bool stdout_is_terminal() {
  const char* terminal = std::getenv("TERM");
  return isatty(STDOUT_FILENO) != 0 && (terminal == nullptr || std::string_view(terminal) != "dumb");
}

/// Messages above, status line below.
class ConsoleSink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  explicit ConsoleSink(bool terminal) : terminal_(terminal) {}

  void set_status(std::string_view text) {
    const std::lock_guard lock(mutex_);
    status_ = text;
    draw_status();
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const bool important = message.level >= spdlog::level::warn;
    std::FILE* out = important ? stderr : stdout;
    if (terminal_ && !status_.empty()) std::fputs(erase_line, stdout), std::fflush(stdout);
    const char* prefix = message.level == spdlog::level::err    ? "error: "
                         : message.level == spdlog::level::warn ? "warning: "
                                                                : "";
    std::fprintf(out, "%s%.*s\n", prefix, static_cast<int>(message.payload.size()), message.payload.data());
    std::fflush(out);
    if (terminal_ && !status_.empty()) draw_status();
  }
  void flush_() override { std::fflush(stdout); }

 private:
  static constexpr const char* erase_line = "\r\x1b[2K";

  void draw_status() {
    if (!terminal_) return;
    std::fprintf(stdout, "%s%s", erase_line, status_.c_str());
    std::fflush(stdout);
  }

  bool terminal_;
  std::string status_;
};

spdlog::level::level_enum spdlog_level(Log::Level level) {
  switch (level) {
    case Log::Level::debug:
      return spdlog::level::debug;
    case Log::Level::info:
      return spdlog::level::info;
    case Log::Level::warning:
      return spdlog::level::warn;
    case Log::Level::error:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

struct Log::Impl {
  bool terminal = stdout_is_terminal();
  std::shared_ptr<ConsoleSink> console = std::make_shared<ConsoleSink>(terminal);
  spdlog::logger console_logger{"console", console};
  std::unique_ptr<spdlog::logger> file_logger;
  std::vector<std::pair<Level, std::string>> early;  ///< messages for a file that is not open yet
};

Log::Log() : impl_(new Impl) { impl_->console_logger.set_level(spdlog::level::info); }
Log::~Log() { delete impl_; }

void Log::message(Level level, std::string_view text) {
  impl_->console_logger.log(spdlog_level(level), spdlog::string_view_t(text.data(), text.size()));
  file_only(level, text);
}

void Log::file_only(Level level, std::string_view text) {
  if (impl_->file_logger) {
    impl_->file_logger->log(spdlog_level(level), spdlog::string_view_t(text.data(), text.size()));
  } else if (impl_->early.size() < most_early_messages) {
    impl_->early.emplace_back(level, text);
  }
}

void Log::open_file(const std::filesystem::path& path) {
  try {
    auto sink = std::make_shared<spdlog::sinks::basic_file_sink_mt>(path.string());
    impl_->file_logger = std::make_unique<spdlog::logger>("file", std::move(sink));
  } catch (const spdlog::spdlog_ex& error) {
    throw RunError(fmt::format("{}: cannot be written: {}", path.string(), error.what()));
  }
  impl_->file_logger->set_pattern("%Y-%m-%d %H:%M:%S %l: %v");
  impl_->file_logger->set_level(spdlog::level::info);
  // A run that is killed leaves every line behind. A full disk must not end the program from inside a log call.
  impl_->file_logger->flush_on(spdlog::level::info);
  impl_->file_logger->set_error_handler([](const std::string&) {});
  for (const auto& [level, text] : std::exchange(impl_->early, {})) file_only(level, text);
}

void Log::close_file() { impl_->file_logger.reset(); }

void Log::set_console_level(Level level) { impl_->console_logger.set_level(spdlog_level(level)); }
bool Log::on_terminal() const { return impl_->terminal; }
void Log::set_status(std::string_view text) { impl_->console->set_status(text); }

Log& log() {
  static Log instance;
  return instance;
}

void warn(std::string_view text) { log().message(Log::Level::warning, text); }

}  // namespace pellicle::core
