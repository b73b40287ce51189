// What is written of the wetness of contacts: histograms/NAME_wetness.csv.
#pragma once

#include <optional>
#include <vector>

#include "core/csv.hpp"
#include "core/time_control.hpp"
#include "spray/contact_wetness.hpp"
#include "tools/pellicle/case_spec.hpp"
#include "tools/pellicle/results_folder.hpp"

namespace pellicle::tools {

struct OutputState;

std::vector<spray::ContactWetness> make_wetness(const CaseSpec& spec);

class WetnessOutputs {
 public:
  /// With `resume_time` the files that are there are continued.
  WetnessOutputs(const std::vector<WetnessSpec>& specs, core::TimeControl& time, const ResultsFolder& folder,
                 std::optional<Real> resume_time);

  /// Those without `every` are written at the end of the run alone (`last`).
  void sample(const OutputState& state, bool last);
  void flush();

 private:
  struct Series {
    core::Schedule schedule;
    core::CsvSeries file;
  };
  std::vector<Series> series_;
};

}  // namespace pellicle::tools
