#include "tools/pellicle/wetness_outputs.hpp"

#include <array>
#include <cmath>
#include <string>

#include "tools/pellicle/output_fields.hpp"
#include "tools/pellicle/probes.hpp"
#include "tools/pellicle/zone_outputs.hpp"

namespace pellicle::tools {
namespace {

spray::WetnessOptions make_options(const WetnessSpec& spec) {
  spray::WetnessOptions options;
  options.name = spec.name;
  options.shape = make_zone_shape(spec.box, spec.cylinder);
  options.measure = static_cast<spray::WetnessMeasure>(spec.measure);
  options.wettest = spec.wettest;
  options.bins = spec.bins;
  options.fastest = spec.fastest;
  options.speed_bins = spec.speed_bins;
  options.every_substep = spec.sample == 1;
  return options;
}

std::vector<std::string> header_of(const WetnessSpec& spec) {
  const core::ModelInfo& measure = wetness_measures[static_cast<std::size_t>(spec.measure)];
  const std::string unit = " [" + std::string(unit_of(measure)) + "]";
  const std::string name(measure.name);
  return {"time [s]",
          name + "_from" + unit,
          name + "_to" + unit,
          "impact_speed_from [m/s]",
          "impact_speed_to [m/s]",
          "particle_contacts [-]",
          "wall_contacts [-]"};
}

/// Lower and upper end of a bin; the one after the last has no upper end.
std::array<Real, 2> edges(Index bin, Index bins, Real end) {
  const Real width = end / bins;
  return {width * bin, bin < bins ? width * (bin + 1) : INFINITY};
}

}  // namespace

std::vector<spray::ContactWetness> make_wetness(const CaseSpec& spec) {
  std::vector<spray::ContactWetness> all;
  for (const WetnessSpec& wetness : spec.output.wetness) all.emplace_back(make_options(wetness));
  return all;
}

WetnessOutputs::WetnessOutputs(const std::vector<WetnessSpec>& specs, core::TimeControl& time,
                               const ResultsFolder& folder, std::optional<Real> resume_time) {
  for (const WetnessSpec& spec : specs) {
    series_.push_back(
        {time.schedule(spec.every, "output.wetness." + spec.name + ".every"),
         core::CsvSeries(folder.csv("histograms", spec.name + "_wetness"), header_of(spec), resume_time)});
  }
}

void WetnessOutputs::sample(const OutputState& state, bool last) {
  if (state.wetness == nullptr) return;
  for (std::size_t w = 0; w < series_.size(); ++w) {
    Series& series = series_[w];
    if (!(series.schedule.steps == 0 ? last : series.schedule.due(state.step))) continue;
    const spray::ContactWetness& region = (*state.wetness)[w];
    const spray::WetnessOptions& options = region.options();
    const spray::WetnessCounts counts = region.counts();
    std::size_t entry = 0;
    for (Index row = 0; row < counts.rows; ++row) {
      const std::array<Real, 2> wetness =
          row == 0 ? std::array<Real, 2>{0, 0} : edges(row - 1, options.bins, options.wettest);
      for (Index column = 0; column < counts.columns; ++column, ++entry) {
        const std::array<Real, 2> speed = edges(column, options.speed_bins, options.fastest);
        series.file.append(std::array<double, 7>{state.time, wetness[0], wetness[1], speed[0], speed[1],
                                                 static_cast<double>(counts.pairs[entry]),
                                                 static_cast<double>(counts.walls[entry])});
      }
    }
  }
}

void WetnessOutputs::flush() {
  for (Series& series : series_) series.file.flush();
}

}  // namespace pellicle::tools
