#include "core/time_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/checkpoint.hpp"

namespace pellicle::core {

namespace {

constexpr Real rounding_tolerance = 1e-6;  // of one step: larger than any round-off of decimal input

}  // namespace

std::optional<std::int64_t> whole_multiple(Real length, Real unit) {
  if (!(length > 0) || !(unit > 0)) return std::nullopt;
  const Real ratio = length / unit;
  const Real nearest = std::round(ratio);
  if (nearest < 1 || std::abs(ratio - nearest) > rounding_tolerance) return std::nullopt;
  return static_cast<std::int64_t>(nearest);
}

int choose_parts(Real needed, int substeps) {
  constexpr int most = 1000;
  const int limit = substeps > 0 ? std::min(substeps, most) : most;
  if (!(needed > 1)) return 1;
  if (needed >= limit && substeps <= 0) return most;
  int largest = 1;
  for (int parts = 1; parts <= limit; ++parts) {
    if (substeps > 0 && substeps % parts != 0) continue;
    largest = parts;
    // Round-off of the velocity does not make a part more.
    if (parts >= needed * (1 - 1e-12)) return parts;
  }
  return largest;
}

TimeControl::TimeControl(Real end, Real gas_step, Real particle_step, Real settle) : gas_step_(gas_step) {
  if (!(end > 0)) throw std::invalid_argument("the end time must be positive");
  if (!(gas_step > 0)) throw std::invalid_argument("the gas step must be positive");
  if (!(settle >= 0)) throw std::invalid_argument("the settling time must not be negative");
  const auto substeps = whole_multiple(gas_step, particle_step);
  if (!substeps) {
    throw std::invalid_argument(
        fmt::format("the gas step must be a whole multiple of the particle step; {} / {} is not", gas_step,
                    particle_step));
  }
  substeps_ = static_cast<int>(*substeps);
  end_step_ = std::max<std::int64_t>(1, nearest_step(end, "time.end"));
  step_ = -nearest_step(settle, "time.settle");
}

void TimeControl::end_at(Real time) { end_step_ = std::min(end_step_, nearest_step(time, "--until")); }

std::int64_t TimeControl::nearest_step(Real time, const std::string& what) {
  const Real ratio = time / gas_step_;
  const auto nearest = static_cast<std::int64_t>(std::llround(ratio));
  if (std::abs(ratio - static_cast<Real>(nearest)) > rounding_tolerance) {
    messages_.push_back(
        fmt::format("{} = {:.9g} s is not a whole number of gas steps of {:.9g} s: {:.9g} s is used", what,
                    time, gas_step_, time_of(nearest)));
  }
  return nearest;
}

Schedule TimeControl::schedule(Real every, const std::string& what) {
  if (every <= 0) return {};
  if (every >= static_cast<Real>(std::int64_t{1} << 62) * gas_step_) return {};
  if (every < 0.5 * gas_step_) {
    messages_.push_back(
        fmt::format("{} = {:.9g} s is shorter than the gas step: every gas step of {:.9g} s is used", what,
                    every, gas_step_));
    return {1};
  }
  return {std::max<std::int64_t>(1, nearest_step(every, what))};
}

StepWindow TimeControl::window(Real from, Real to, const std::string& what) {
  // An open end is often infinite or far beyond the run.
  const std::int64_t last = to >= end() ? end_step_ : nearest_step(to, what + ".to");
  return {nearest_step(from, what + ".from"), last};
}

void TimeControl::save(CheckpointWriter& checkpoint) const {
  checkpoint.write("time/step", step_);
  checkpoint.write("time/gas_step", gas_step_);
}

void TimeControl::load(const CheckpointReader& checkpoint) { step_ = checkpoint.read_int64("time/step"); }

}  // namespace pellicle::core
