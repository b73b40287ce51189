// How far the run is and how long it will still take.
#pragma once

#include <functional>
#include <string>

#include "core/types.hpp"

namespace pellicle::core {

/// Shows progress through the log: a status line on a terminal, plain lines otherwise (and in run.log) every 10 s or
/// 5 %, whichever comes first, though not more often than once a second; from ten minutes on at most one a minute.
class Progress {
 public:
  /// From simulated time `begin` to `end` [s]; `clock` gives wall seconds (wall_clock() if left out).
  Progress(Real begin, Real end, std::function<double()> clock = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// To be called after each outer step: costs a clock reading, except when a line is due; `detail` is called only
  /// then and gives what follows the times, such as "12000 particles".
  void update(Real simulated, const std::function<std::string()>& detail = {});
  /// Removes the status line.
  void finish();

  /// Lines printed so far.
  int lines() const { return lines_; }
  /// The text of a line: "t = 0.5 s of 4 s (12.5 %), 0:01:00 gone, 0:07:00 left".
  std::string line(Real simulated, double wall_seconds) const;

 private:
  bool line_due(Real simulated, double wall_seconds) const;

  Real begin_, end_;
  std::function<double()> clock_;
  double wall_begin_;
  double wall_of_last_line_ = 0, wall_of_last_status_ = -1;
  Real share_of_last_line_ = 0;
  int lines_ = 0;
};

/// Wall time as "0:01:05", with days in front from 24 h on ("2d 3:00:00").
std::string format_duration(double seconds);

}  // namespace pellicle::core
