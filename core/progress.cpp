#include "core/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/log.hpp"
#include "core/timers.hpp"

namespace pellicle::core {

namespace {

constexpr double status_interval = 0.2;               // [s]; the eye does not follow more
constexpr double shortest_interval = 1;               // [s] between plain lines
constexpr double usual_interval = 10;                 // [s]
constexpr double long_run = 600, long_interval = 60;  // [s]
constexpr Real share_interval = 0.05;

}  // namespace

std::string format_duration(double seconds) {
  if (!std::isfinite(seconds)) return "?";
  const auto whole = static_cast<std::int64_t>(std::llround(std::max(0.0, seconds)));
  const auto days = whole / 86400, hours = whole / 3600 % 24, minutes = whole / 60 % 60;
  const std::string clock = fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
  return days > 0 ? fmt::format("{}d {}", days, clock) : clock;
}

Progress::Progress(Real begin, Real end, std::function<double()> clock)
    : begin_(begin), end_(end), clock_(clock ? std::move(clock) : wall_clock), wall_begin_(clock_()) {}

Progress::~Progress() { finish(); }

std::string Progress::line(Real simulated, double wall_seconds) const {
  const Real share = end_ > begin_ ? std::clamp((simulated - begin_) / (end_ - begin_), 0.0, 1.0) : 1.0;
  const std::string left = share > 0 ? format_duration(wall_seconds * (1 - share) / share) : "?";
  return fmt::format("t = {:.6g} s of {:.6g} s ({:.1f} %), {} gone, {} left", simulated, end_, 100 * share,
                     format_duration(wall_seconds), left);
}

bool Progress::line_due(Real simulated, double wall_seconds) const {
  const double since = wall_seconds - wall_of_last_line_;
  const Real share = end_ > begin_ ? (simulated - begin_) / (end_ - begin_) : 1;
  if (wall_seconds >= long_run) return since >= long_interval;
  return since >= usual_interval ||
         (share - share_of_last_line_ >= share_interval && since >= shortest_interval);
}

void Progress::update(Real simulated, const std::function<std::string()>& detail) {
  const double wall = clock_() - wall_begin_;
  const bool status_due = log().on_terminal() && wall - wall_of_last_status_ >= status_interval;
  const bool plain_due = line_due(simulated, wall);
  if (!status_due && !plain_due) return;
  std::string text = line(simulated, wall);
  if (detail) text += ", " + detail();
  if (status_due) {
    log().set_status(text);
    wall_of_last_status_ = wall;
  }
  if (plain_due) {
    if (log().on_terminal()) {
      log().file_only(Log::Level::info, text);
    } else {
      log().message(Log::Level::info, text);
    }
    wall_of_last_line_ = wall;
    share_of_last_line_ = end_ > begin_ ? (simulated - begin_) / (end_ - begin_) : 1;
    ++lines_;
  }
}

void Progress::finish() { log().set_status(""); }

}  // namespace pellicle::core
