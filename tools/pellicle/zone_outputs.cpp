#include "tools/pellicle/zone_outputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/pellicle/probes.hpp"

namespace pellicle::tools {
namespace {

using spray::zone_groups;
using spray::ZoneSums;

const std::vector<std::string> figures_header{"time [s]",
                                              "inside [-]",
                                              "entered [-]",
                                              "entries [-]",
                                              "visits [-]",
                                              "mean_residence [s]",
                                              "cycles [-]",
                                              "mean_cycle_time [s]",
                                              "sd_cycle_time [s]",
                                              "steady_cycle_time [s]",
                                              "mean_gain [kg]",
                                              "sd_gain [kg]",
                                              "gain_time_correlation [-]",
                                              "coating_mean [kg]",
                                              "coating_cov [-]"};

const std::vector<std::string> groups_header{
    "time [s]",          "watched [s]",          "size_class [-]",
    "diameter_from [m]", "diameter_to [m]",      "group [-]",
    "particles [-]",     "entered [-]",          "entries [-]",
    "cycles [-]",        "cycle_time [s]",       "cycle_time_squared [s2]",
    "gain [kg]",         "gain_squared [kg2]",   "time_gain [s kg]",
    "coating [kg]",      "coating_squared [kg2]"};

const std::vector<std::string> times_header{"time [s]",   "from [s]",        "to [s]",
                                            "cycles [-]", "open_cycles [-]", "visits [-]"};

/// Standard deviation from sums; not a number where there are no two.
Real deviation(Real count, Real sum, Real squares) {
  if (!(count > 1)) return std::nan("");
  return std::sqrt(std::max(0.0, (squares - sum * sum / count) / (count - 1)));
}

spray::ZoneOptions make_options(const ZoneSpec& spec) {
  spray::ZoneOptions options;
  options.name = spec.name;
  options.shape = make_zone_shape(spec.box, spec.cylinder);
  options.shortest_absence = spec.shortest_absence;
  options.longest_time = spec.longest_time;
  options.bins = spec.bins;
  options.size_classes = spec.size_classes;
  return options;
}

}  // namespace

spray::ZoneShape make_zone_shape(const std::optional<Box>& box,
                                 const std::optional<dem::CylinderRegion>& cylinder) {
  spray::ZoneShape shape;
  if (box) {
    shape.min = box->min;
    shape.max = box->max;
    return shape;
  }
  const Vec3 along = cylinder->to - cylinder->from;
  shape.is_box = false;
  shape.from = cylinder->from;
  shape.length = norm(along);
  shape.axis = (1 / shape.length) * along;
  shape.radius = cylinder->radius;
  return shape;
}

Zones make_zones(const CaseSpec& spec, const dem::Particles& particles) {
  Zones zones;
  for (const ZoneSpec& zone : spec.output.zones) zones.emplace_back(make_options(zone), particles);
  return zones;
}

ZoneFigures compute_zone_figures(const ZoneSums& sums, Real time) {
  const Real none = std::nan("");
  ZoneFigures figures;
  const Real n = sums.cycles;
  figures.mean_residence = sums.visits > 0 ? sums.residence / sums.visits : none;
  figures.mean_cycle_time = n > 0 ? sums.cycle_time / n : none;
  figures.sd_cycle_time = deviation(n, sums.cycle_time, sums.cycle_time_squared);
  figures.steady_cycle_time = sums.entries > 0 ? sums.particles * time / sums.entries : none;
  figures.mean_gain = n > 0 ? sums.gain / n : none;
  figures.sd_gain = deviation(n, sums.gain, sums.gain_squared);
  const Real covariance = n > 1 ? (sums.time_gain - sums.cycle_time * sums.gain / n) / (n - 1) : none;
  figures.correlation = covariance / (figures.sd_cycle_time * figures.sd_gain);
  figures.coating_mean = sums.particles > 0 ? sums.solids / sums.particles : none;
  figures.coating_variation =
      deviation(sums.particles, sums.solids, sums.solids_squared) / figures.coating_mean;
  return figures;
}

ZoneOutputs::ZoneOutputs(const std::vector<ZoneSpec>& specs, core::TimeControl& time,
                         const ResultsFolder& folder, std::optional<Real> resume_time) {
  for (const ZoneSpec& spec : specs) {
    series_.push_back(
        {time.schedule(spec.every, "output.zones." + spec.name + ".every"),
         core::CsvSeries(folder.csv("zones", spec.name), figures_header, resume_time),
         core::CsvSeries(folder.csv("zones", spec.name + "_groups"), groups_header, resume_time),
         core::CsvSeries(folder.csv("histograms", spec.name + "_times"), times_header, resume_time)});
  }
}

void ZoneOutputs::sample(const OutputState& state, bool last) {
  if (state.zones == nullptr || state.particles == nullptr) return;
  for (std::size_t z = 0; z < series_.size(); ++z) {
    Series& series = series_[z];
    if (!(series.schedule.steps == 0 ? last : series.schedule.due(state.step))) continue;
    const spray::ZoneVisits& zone = (*state.zones)[z];
    const std::vector<ZoneSums> sums = zone.compute_sums(state.time, state.particles->film);
    ZoneSums all;
    for (const ZoneSums& part : sums) all += part;
    const ZoneFigures f = compute_zone_figures(all, state.time - zone.start());
    series.figures.append(std::array<double, 15>{state.time, all.inside, all.entered, all.entries, all.visits,
                                                 f.mean_residence, all.cycles, f.mean_cycle_time,
                                                 f.sd_cycle_time, f.steady_cycle_time, f.mean_gain, f.sd_gain,
                                                 f.correlation, f.coating_mean, f.coating_variation});
    const auto [smallest, largest] = zone.radii();
    const Real width = 2 * (largest - smallest) / zone.options().size_classes;
    for (Index c = 0; c < zone.options().size_classes; ++c) {
      for (Index g = 0; g < zone_groups; ++g) {
        const ZoneSums& s = sums[static_cast<std::size_t>(c) * zone_groups + static_cast<std::size_t>(g)];
        series.groups.append(std::array<double, 17>{
            state.time, state.time - zone.start(), static_cast<double>(c), 2 * smallest + width * c,
            2 * smallest + width * (c + 1), static_cast<double>(g), s.particles, s.entered, s.entries,
            s.cycles, s.cycle_time, s.cycle_time_squared, s.gain, s.gain_squared, s.time_gain, s.solids,
            s.solids_squared});
      }
    }
    const spray::ZoneHistograms counts = zone.compute_histograms(state.time);
    const Real bin = zone.options().longest_time / zone.options().bins;
    for (std::size_t b = 0; b < counts.cycle_time.size(); ++b) {
      const Real from = bin * static_cast<Real>(b);
      const Real to = b + 1 < counts.cycle_time.size() ? from + bin : INFINITY;
      series.times.append(std::array<double, 6>{
          state.time, from, to, static_cast<double>(counts.cycle_time[b]),
          static_cast<double>(counts.open_cycle[b]), static_cast<double>(counts.residence[b])});
    }
  }
}

void ZoneOutputs::flush() {
  for (Series& series : series_) {
    series.figures.flush();
    series.groups.flush();
    series.times.flush();
  }
}

}  // namespace pellicle::tools
