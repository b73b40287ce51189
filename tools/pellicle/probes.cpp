#include "tools/pellicle/probes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/model_families.hpp"
#include "tools/pellicle/output_fields.hpp"
#include "tools/pellicle/particle_quantities.hpp"

namespace pellicle::tools {

namespace {

std::vector<int> find_all(core::ModelList known, const ProbeSpec& spec) {
  std::vector<int> found;
  for (const auto& quantity : spec.quantities) {
    found.push_back(core::find_model(known, quantity));
    if (found.back() < 0) {
      std::string names;
      for (const auto& info : known) names += (names.empty() ? "" : ", ") + std::string(info.name);
      throw InputError(fmt::format("{}: unknown quantity {}; allowed: {}", spec.where, quantity, names));
    }
  }
  return found;
}

std::vector<std::string> probe_header(const ProbeSpec& spec) {
  std::vector<std::string> header{"time [s]"};
  for (const auto& quantity : spec.quantities) header.push_back(column_header(quantity));
  return header;
}

Index cell_of(const ProbeSpec& spec, const CartesianGrid* grid) {
  if (!spec.point) return 0;
  if (grid == nullptr) throw InputError(spec.where + ": a point probe shows the gas, and this case has none");
  const Vec3& at = *spec.point;
  for (int axis = 0; axis < 3; ++axis) {
    if (at[axis] < grid->box().min[axis] || at[axis] > grid->box().max[axis]) {
      throw InputError(fmt::format("{}: the point ({:.6g}, {:.6g}, {:.6g}) m lies outside the gas grid",
                                   spec.where, at.x, at.y, at.z));
    }
  }
  return grid->index(grid->locate(0, at.x), grid->locate(1, at.y), grid->locate(2, at.z));
}

std::optional<PlaneSection> section_of(const ProbeSpec& spec, const CartesianGrid* grid) {
  if (!spec.plane) return std::nullopt;
  if (grid == nullptr) throw InputError(spec.where + ": a plane probe shows the gas, and this case has none");
  return PlaneSection(*spec.plane, *grid);
}

/// Entry of wall_quantities: means over `interval`, of which there is none at the first row.
Real wall_quantity(int quantity, const WallFigures& now, const WallFigures& before, Real interval) {
  if (quantity == 6) return static_cast<Real>(now.contacts);
  if (quantity == 11) return now.heat.value_or(0);
  if (quantity == 10) {
    return interval > 0 ? (now.heat.value_or(0) - before.heat.value_or(0)) / interval : 0;
  }
  if (quantity > 6) return interval > 0 ? (now.gas_impulse - before.gas_impulse)[quantity - 7] / interval : 0;
  const Vec3 given =
      quantity < 3 ? now.impulse - before.impulse : now.angular_impulse - before.angular_impulse;
  return interval > 0 ? given[quantity % 3] / interval : 0;
}

/// Entry of side_quantities; rates are means over `interval`, of which there is none at the first row.
Real side_quantity(int quantity, const dem::SideTotals& now, const dem::SideTotals& before, Real interval) {
  if (quantity == 2) return now.mass;
  if (quantity == 3) return static_cast<Real>(now.particles);
  if (!(interval > 0)) return 0;
  return (quantity == 0 ? now.mass - before.mass : static_cast<Real>(now.particles - before.particles)) /
         interval;
}

const WallFigures& find_wall(const OutputState& state, const std::string& name) {
  static const WallFigures none;
  if (state.walls == nullptr) return none;
  const auto found = std::find_if(state.walls->begin(), state.walls->end(),
                                  [&](const WallFigures& wall) { return wall.name == name; });
  return found == state.walls->end() ? none : *found;
}

dem::SideTotals left_through(const OutputState& state, int side) {
  return state.sides != nullptr ? (*state.sides)[static_cast<std::size_t>(side)] : dem::SideTotals{};
}

}  // namespace

const HostParticles& OutputState::host_particles() const {
  if (!copied_particles) copied_particles = particles != nullptr ? copy_to_host(*particles) : HostParticles{};
  return *copied_particles;
}

Probes::Probes(const std::vector<ProbeSpec>& specs, core::TimeControl& time, const ResultsFolder& folder,
               const Box& domain, const CartesianGrid* gas_grid, std::optional<Real> resume_time)
    : folder_(folder), floor_(domain.min.z) {
  for (const auto& spec : specs) {
    auto quantities = find_all(quantities_of(spec), spec);
    const Index cell = cell_of(spec, gas_grid);
    // Without `every`: after each outer step.
    const core::Schedule schedule = spec.every > 0
                                        ? time.schedule(spec.every, "output.probes." + spec.name + ".every")
                                        : core::Schedule{1};
    probes_.push_back({spec, schedule, std::move(quantities), cell, section_of(spec, gas_grid),
                       core::CsvSeries(folder.csv("probes", spec.name), probe_header(spec), resume_time)});
    if (!spec.average) continue;
    const core::StepWindow window =
        time.window(spec.average->from, spec.average->to, "output.probes." + spec.name + ".average");
    probes_.back().average.emplace(spec, window, time.gas_step());
  }
}

std::vector<double> Probes::values(const Probe& probe, const OutputState& state, const Past& past) const {
  std::vector<double> values;
  const Real interval = state.time - past.time;
  if (probe.spec.bed) {
    const BedFigures bed = compute_bed_figures(state.host_particles(), floor_);
    for (const auto& name : probe.spec.quantities)
      values.push_back(bed_quantity(name, bed, state.gas, state.contacts));
  } else if (probe.spec.coating) {
    const CoatingFigures coating = compute_coating_figures(state.host_particles());
    for (const auto& name : probe.spec.quantities) values.push_back(coating_quantity(name, coating));
  } else if (probe.spec.particle) {
    ParticleSample particle;
    const bool found =
        state.particles != nullptr && finder_.find(*state.particles, *probe.spec.particle, particle);
    for (const int quantity : probe.quantities) {
      values.push_back(found ? particle_quantity(quantity, particle) : std::nan(""));
    }
  } else if (probe.spec.wall) {
    const WallFigures& now = find_wall(state, *probe.spec.wall);
    for (const int quantity : probe.quantities)
      values.push_back(wall_quantity(quantity, now, past.wall, interval));
  } else if (probe.spec.side) {
    const dem::SideTotals now = left_through(state, *probe.spec.side);
    for (const int quantity : probe.quantities)
      values.push_back(side_quantity(quantity, now, past.left, interval));
  } else if (probe.plane) {
    for (const int quantity : probe.quantities) values.push_back(probe.plane->quantity(*state.gas, quantity));
  } else {
    for (const int quantity : probe.quantities)
      values.push_back(gas_quantity(*state.gas, quantity, probe.cell));
  }
  return values;
}

void Probes::sample(const OutputState& state) {
  for (auto& probe : probes_) {
    const bool has_past = probe.spec.wall || probe.spec.side;
    const bool due = probe.schedule.due(state.step);
    std::vector<double> now;
    if (due) {
      now = values(probe, state, probe.row);
      std::vector<double> row{state.time};
      row.insert(row.end(), now.begin(), now.end());
      probe.file.append(row);
    }
    if (probe.average && probe.average->wants(state.step) && (!has_past || probe.step)) {
      // Of walls and sides a row is a mean since the row before, a sample one since the step before.
      if (!due || has_past) now = values(probe, state, has_past ? *probe.step : Past{});
      probe.average->add(state.step, now);
    }
    if (!has_past || !(due || probe.average)) continue;
    Past past{{}, {}, state.time};
    if (probe.spec.wall) past.wall = find_wall(state, *probe.spec.wall);
    if (probe.spec.side) past.left = left_through(state, *probe.spec.side);
    if (probe.average) probe.step = past;
    if (due) probe.row = std::move(past);
  }
}

void Probes::flush() {
  for (auto& probe : probes_) {
    probe.file.flush();
    if (probe.average)
      core::write_csv(folder_.csv("probes", probe.spec.name + "_average"), probe.average->table());
  }
}

void Probes::save(core::CheckpointWriter& checkpoint, const std::string& path, const Probe& probe,
                  const Past& past) {
  checkpoint.write(path + "/time", past.time);
  if (probe.spec.side) {
    checkpoint.write(path + "/left_mass", past.left.mass);
    checkpoint.write(path + "/left_particles", past.left.particles);
    return;
  }
  checkpoint.write(path + "/impulse", past.wall.impulse);
  checkpoint.write(path + "/angular_impulse", past.wall.angular_impulse);
  checkpoint.write(path + "/gas_impulse", past.wall.gas_impulse);
  checkpoint.write(path + "/heat", past.wall.heat.value_or(0));
}

Probes::Past Probes::load(const core::CheckpointReader& checkpoint, const std::string& path,
                          const Probe& probe) {
  Past past;
  past.time = checkpoint.read_double(path + "/time");
  if (probe.spec.side) {
    past.left = {checkpoint.read_int64(path + "/left_particles"),
                 checkpoint.read_double(path + "/left_mass")};
    return past;
  }
  past.wall.impulse = checkpoint.read_vec3(path + "/impulse");
  past.wall.angular_impulse = checkpoint.read_vec3(path + "/angular_impulse");
  past.wall.gas_impulse = checkpoint.read_vec3(path + "/gas_impulse");
  past.wall.heat = checkpoint.read_double(path + "/heat");
  return past;
}

void Probes::save(core::CheckpointWriter& checkpoint) const {
  for (const auto& probe : probes_) {
    const std::string path = "probes/" + probe.spec.name;
    if (probe.spec.wall || probe.spec.side) save(checkpoint, path, probe, probe.row);
    if (!probe.average) continue;
    probe.average->save(checkpoint, path + "/average");
    if ((probe.spec.wall || probe.spec.side) && probe.step)
      save(checkpoint, path + "/average", probe, *probe.step);
  }
}

void Probes::load(const core::CheckpointReader& checkpoint) {
  for (auto& probe : probes_) {
    const std::string path = "probes/" + probe.spec.name;
    const bool goes_on = probe.average && probe.average->load(checkpoint, path + "/average");
    if (!probe.spec.wall && !probe.spec.side) continue;
    // The first row of a probe that is new with this run is a mean since t = 0. A sample would count that as a step.
    const std::string what = probe.spec.wall ? "/impulse" : "/left_mass";
    if (checkpoint.has(path + what)) probe.row = load(checkpoint, path, probe);
    probe.step.reset();
    if (goes_on && checkpoint.has(path + "/average" + what))
      probe.step = load(checkpoint, path + "/average", probe);
  }
}

Histograms::Histograms(const std::vector<HistogramSpec>& specs, core::TimeControl& time,
                       const ResultsFolder& folder, std::optional<Real> resume_time) {
  for (const auto& spec : specs) {
    const int quantity = core::find_model(particle_quantities, spec.quantity);
    if (quantity < 0) throw InputError(fmt::format("{}: unknown quantity {}", spec.where, spec.quantity));
    std::vector<std::string> header{"time [s]"};
    std::string units;
    const auto add = [&](const std::string& name) {
      const int found = core::find_model(particle_quantities, name);
      const auto unit = std::string(unit_of(particle_quantities[static_cast<std::size_t>(found)]));
      header.push_back(fmt::format("{}_from [{}]", name, unit));
      header.push_back(fmt::format("{}_to [{}]", name, unit));
      units += fmt::format("({})", unit);
      return found;
    };
    add(spec.quantity);
    const int against = spec.against ? add(*spec.against) : -1;
    header.emplace_back(spec.by_mass ? "mass [kg]" : "count [-]");
    header.push_back(fmt::format("density [1/{}]", units));
    histograms_.push_back({spec, time.schedule(spec.every, "output.histograms." + spec.name + ".every"),
                           quantity, against,
                           core::CsvSeries(folder.csv("histograms", spec.name), header, resume_time)});
  }
}

namespace {

/// Bins of one quantity.
struct Bins {
  Real from, to, width;
  std::size_t count;

  Bins(const std::vector<Real>& values, std::optional<Real> min, std::optional<Real> max, Index bins)
      : count(static_cast<std::size_t>(bins)) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    from = min.value_or(*least);
    to = max.value_or(*most);
    // All equal: one bin's width around the value, so that the bins have a size.
    if (!(to > from)) to = from + std::max(1e-12, 1e-6 * std::abs(from));
    width = (to - from) / bins;
  }
  Real low(std::size_t bin) const { return from + width * static_cast<Real>(bin); }
  /// `count` for what is outside.
  std::size_t find(Real value) const {
    const Real at = (value - from) / width;
    if (!(at >= 0) || value > to) return count;  // low(count) may be rounded to less
    return std::min(count - 1, static_cast<std::size_t>(at));
  }
};

std::vector<Real> values_of(const HostParticles& particles, int quantity) {
  std::vector<Real> values(particles.count());
  for (std::size_t p = 0; p < values.size(); ++p)
    values[p] = particle_quantity(quantity, particles.sample(p));
  return values;
}

}  // namespace

void Histograms::append(Histogram& histogram, const OutputState& state) {
  const HistogramSpec& spec = histogram.spec;
  const HostParticles& particles = state.host_particles();
  if (particles.count() == 0) return;
  const std::vector<Real> values = values_of(particles, histogram.quantity);
  const Bins bins(values, spec.min, spec.max, spec.bins);
  const bool joint = histogram.against >= 0;
  const std::vector<Real> others = joint ? values_of(particles, histogram.against) : std::vector<Real>{0};
  const Bins other_bins(others, joint ? spec.against_min : 0.0, joint ? spec.against_max : 1.0,
                        joint ? spec.against_bins : 1);
  std::vector<Real> amount(bins.count * other_bins.count);
  Real total = 0;
  for (std::size_t p = 0; p < values.size(); ++p) {
    const Real weight = spec.by_mass ? particles.mass[p] : 1;
    total += weight;
    const std::size_t bin = bins.find(values[p]), other = joint ? other_bins.find(others[p]) : 0;
    if (bin < bins.count && other < other_bins.count) amount[bin * other_bins.count + other] += weight;
  }
  for (std::size_t b = 0; b < bins.count; ++b) {
    for (std::size_t o = 0; o < other_bins.count; ++o) {
      std::vector<double> row{state.time, bins.low(b), bins.low(b) + bins.width};
      Real size = bins.width;
      if (joint) {
        row.push_back(other_bins.low(o));
        row.push_back(other_bins.low(o) + other_bins.width);
        size *= other_bins.width;
      }
      row.push_back(amount[b * other_bins.count + o]);
      row.push_back(amount[b * other_bins.count + o] / (total * size));
      histogram.file.append(row);
    }
  }
}

void Histograms::sample(const OutputState& state, bool last) {
  for (auto& histogram : histograms_) {
    const bool at_end_alone = histogram.schedule.steps == 0;
    if (at_end_alone ? last : histogram.schedule.due(state.step)) append(histogram, state);
  }
}

void Histograms::flush() {
  for (auto& histogram : histograms_) histogram.file.flush();
}

}  // namespace pellicle::tools
