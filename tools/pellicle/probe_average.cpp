#include "tools/pellicle/probe_average.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/log.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

namespace {

std::string text(const Vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

std::string identity_of_plane(const PlaneProbeSpec& plane) {
  std::string is = fmt::format("plane {} {} {}", plane.axis, plane.at, plane.by_flow);
  if (plane.box) is += " box " + text(plane.box->min) + " " + text(plane.box->max);
  if (plane.disc) is += fmt::format(" disc {} {}", text(plane.disc->centre), plane.disc->radius);
  return is;
}

/// What makes the samples those of the same average. The window's end is left out: a longer run goes on with it.
std::string identity_of(const ProbeSpec& spec, const core::StepWindow& window) {
  std::string is = fmt::format("{} ", window.from);
  if (spec.point) is += "point " + text(*spec.point);
  if (spec.plane) is += identity_of_plane(*spec.plane);
  if (spec.particle) is += fmt::format("particle {}", *spec.particle);
  if (spec.wall) is += "wall " + *spec.wall;
  if (spec.side) is += fmt::format("side {}", *spec.side);
  if (spec.bed) is += "bed";
  if (spec.coating) is += "coating";
  return fmt::format("{}: {}", is, fmt::join(spec.quantities, " "));
}

}  // namespace

ProbeAverage::ProbeAverage(const ProbeSpec& spec, const core::StepWindow& window, Real gas_step)
    : quantities_(spec.quantities),
      name_(spec.name),
      identity_(identity_of(spec, window)),
      window_(window),
      gas_step_(gas_step),
      last_(window.from),
      columns_(spec.quantities.size()) {}

void ProbeAverage::add(std::int64_t step, std::span<const double> values) {
  last_ = step;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const Real value = values[c];
    if (std::isnan(value)) continue;
    Column& column = columns_[c];
    column.moments.add(value);
    column.smallest = std::min(column.smallest, value);
    column.largest = std::max(column.largest, value);
  }
}

core::CsvTable ProbeAverage::table() const {
  core::CsvTable table{
      {"from [s]", "to [s]"},
      {{static_cast<Real>(window_.from) * gas_step_}, {static_cast<Real>(last_) * gas_step_}}};
  const auto add = [&](const std::string& header, Real value) {
    table.header.push_back(header);
    table.columns.push_back({value});
  };
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto& [moments, smallest, largest] = columns_[c];
    const std::string header = column_header(quantities_[c]);
    const std::string unit = header.substr(header.find(' '));
    const Real none = moments.samples > 0 ? 0 : std::nan("");  // in place of the infinite ends
    add(quantities_[c] + "_mean" + unit, moments.mean_or_nan());
    add(quantities_[c] + "_rms" + unit, moments.deviation());
    add(quantities_[c] + "_min" + unit, smallest + none);
    add(quantities_[c] + "_max" + unit, largest + none);
    add(quantities_[c] + "_samples [-]", static_cast<Real>(moments.samples));
  }
  return table;
}

void ProbeAverage::save(core::CheckpointWriter& checkpoint, const std::string& path) const {
  checkpoint.write(path + "/is", identity_);
  checkpoint.write(path + "/last", last_);
  checkpoint.write(path + "/columns", columns_);
}

bool ProbeAverage::load(const core::CheckpointReader& checkpoint, const std::string& path) {
  if (!checkpoint.has(path + "/is") || checkpoint.read_string(path + "/is") != identity_) {
    core::log().warn("the average of the probe {} is new or has changed since the checkpoint: it begins now",
                     name_);
    return false;
  }
  last_ = checkpoint.read_int64(path + "/last");
  checkpoint.read_into(path + "/columns", columns_);
  return true;
}

}  // namespace pellicle::tools
