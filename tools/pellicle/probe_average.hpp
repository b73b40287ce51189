// Mean, RMS, smallest and largest of each column of a probe over time: probes/NAME_average.csv.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "core/csv.hpp"
#include "core/running_moments.hpp"
#include "core/time_control.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

/// Figures of the columns of one probe over the outer steps of a window. A column's value that is not a number (a
/// particle that has left, a mean over nothing) is no sample of it.
class ProbeAverage {
 public:
  /// `window`: of `spec.average`.
  ProbeAverage(const ProbeSpec& spec, const core::StepWindow& window, Real gas_step);

  bool wants(std::int64_t step) const { return window_.contains(step); }
  /// Takes up the values of a step, one a quantity of the probe.
  void add(std::int64_t step, std::span<const double> values);

  /// One row: the window's start, the last sampled time, and of each quantity mean, RMS of the fluctuation about it,
  /// smallest, largest and number of samples; nan without samples.
  core::CsvTable table() const;

  void save(core::CheckpointWriter& checkpoint, const std::string& path) const;
  /// Whether it goes on; an average that is new, or another one than the checkpoint's, begins now, with a warning.
  bool load(const core::CheckpointReader& checkpoint, const std::string& path);

 private:
  struct Column {
    core::RunningMoments moments;
    Real smallest = std::numeric_limits<Real>::infinity();
    Real largest = -std::numeric_limits<Real>::infinity();
  };

  std::vector<std::string> quantities_;
  std::string name_, identity_;
  core::StepWindow window_;
  Real gas_step_;
  std::int64_t last_;  ///< sampled step
  std::vector<Column> columns_;
};

}  // namespace pellicle::tools
