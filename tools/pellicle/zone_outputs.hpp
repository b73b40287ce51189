// What is written of the zones: zones/NAME.csv over time, zones/NAME_groups.csv, histograms/NAME_times.csv.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "core/csv.hpp"
#include "core/time_control.hpp"
#include "spray/zone_visits.hpp"
#include "tools/pellicle/case_spec.hpp"
#include "tools/pellicle/results_folder.hpp"

namespace pellicle::tools {

struct OutputState;

/// The box or cylinder of a zone or another region.
spray::ZoneShape make_zone_shape(const std::optional<Box>& box,
                                 const std::optional<dem::CylinderRegion>& cylinder);

/// The zones of a case. Entries never move: the engine keeps their addresses.
using Zones = std::deque<spray::ZoneVisits>;

Zones make_zones(const CaseSpec& spec, const dem::Particles& particles);

/// Means over cycles and visits, from the sums over all particles.
struct ZoneFigures {
  Real mean_residence = 0;                       ///< of visits that have ended [s]
  Real mean_cycle_time = 0, sd_cycle_time = 0;   ///< of cycles that have ended [s]
  Real steady_cycle_time = 0;                    ///< particles x time / entries [s]
  Real mean_gain = 0, sd_gain = 0;               ///< of coating from entry to entry [kg]
  Real correlation = 0;                          ///< of cycle time and gain
  Real coating_mean = 0, coating_variation = 0;  ///< of coating now [kg], [-]
};

/// Not a number where there is nothing to average. `time`: since the zone is watched [s].
ZoneFigures compute_zone_figures(const spray::ZoneSums& sums, Real time);

class ZoneOutputs {
 public:
  /// With `resume_time` the files that are there are continued.
  ZoneOutputs(const std::vector<ZoneSpec>& specs, core::TimeControl& time, const ResultsFolder& folder,
              std::optional<Real> resume_time);

  /// Those without `every` are written at the end of the run alone (`last`).
  void sample(const OutputState& state, bool last);
  void flush();

 private:
  struct Series {
    core::Schedule schedule;
    core::CsvSeries figures, groups, times;
  };
  std::vector<Series> series_;
};

}  // namespace pellicle::tools
