// Steps and times: when a run ends and when which output is due.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace pellicle::core {

class CheckpointReader;
class CheckpointWriter;

/// Number n >= 1 with |n unit - length| <= 1e-6 unit, or nothing: `length` is then no whole multiple of `unit`.
std::optional<std::int64_t> whole_multiple(Real length, Real unit);

/// The least number of equal parts of an outer step that is not below `needed`; with `substeps` > 0 one that divides them,
/// or all of them if there are fewer than needed. At most 1000, and at least 1, also for what is not a number.
int choose_parts(Real needed, int substeps);

/// Something that happens every so many outer steps, counted from t = 0, so also at t = 0 itself.
struct Schedule {
  std::int64_t steps = 0;  ///< 0: never
  bool due(std::int64_t step) const { return steps > 0 && step >= 0 && step % steps == 0; }
};

/// A half-open interval of steps, (from, to]: a run that samples after each step takes (to - from) / step samples.
struct StepWindow {
  std::int64_t from = 0, to = 0;
  bool contains(std::int64_t step) const { return step > from && step <= to; }
};

/// Counts outer steps. Simulated time is step * gas_step, exactly, and never a sum; steps before t = 0 are negative
/// (settling without gas). Times that are no whole number of outer steps are rounded to the nearest, with a message.
class TimeControl {
 public:
  /// All in seconds. Throws std::invalid_argument if gas_step is no whole multiple of particle_step, or a length is
  /// not positive (settle may be zero).
  TimeControl(Real end, Real gas_step, Real particle_step, Real settle = 0);

  Real gas_step() const { return gas_step_; }
  /// gas_step / substeps, which the particles use.
  Real particle_step() const { return gas_step_ / substeps_; }
  int substeps() const { return substeps_; }
  std::int64_t step() const { return step_; }
  std::int64_t end_step() const { return end_step_; }
  Real time() const { return time_of(step_); }
  Real time_of(std::int64_t step) const { return static_cast<Real>(step) * gas_step_; }
  Real end() const { return time_of(end_step_); }
  /// The next step is one without gas.
  bool settling() const { return step_ < 0; }
  bool finished() const { return step_ >= end_step_; }
  void advance() { ++step_; }
  /// The next step is that at t = 0, if settling goes on.
  void end_settling() { step_ = step_ < 0 ? 0 : step_; }
  /// Ends earlier: `--until`; never later than the case says.
  void end_at(Real time);

  /// Nearest step to a time [s]; a message names `what` if they differ.
  std::int64_t nearest_step(Real time, const std::string& what);
  /// A schedule that repeats every `every` seconds (0: never), at least every step; a message if it is rounded.
  Schedule schedule(Real every, const std::string& what);
  StepWindow window(Real from, Real to, const std::string& what);

  /// What was rounded, one line each, for the log.
  const std::vector<std::string>& messages() const { return messages_; }

  void save(CheckpointWriter& checkpoint) const;
  /// Takes up the step of the checkpoint.
  void load(const CheckpointReader& checkpoint);

 private:
  Real gas_step_;
  int substeps_ = 1;
  std::int64_t step_ = 0, end_step_ = 0;
  std::vector<std::string> messages_;
};

}  // namespace pellicle::core
