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

}  // namespace

const HostParticles& OutputState::host_particles() const {
  if (!copied_particles) copied_particles = particles != nullptr ? copy_to_host(*particles) : HostParticles{};
  return *copied_particles;
}

Probes::Probes(const std::vector<ProbeSpec>& specs, core::TimeControl& time, const ResultsFolder& folder,
               const Box& domain, const CartesianGrid* gas_grid, std::optional<Real> resume_time)
    : floor_(domain.min.z) {
  for (const auto& spec : specs) {
    auto quantities = find_all(quantities_of(spec), spec);
    const Index cell = cell_of(spec, gas_grid);
    // Without `every`: after each outer step.
    const core::Schedule schedule = spec.every > 0
                                        ? time.schedule(spec.every, "output.probes." + spec.name + ".every")
                                        : core::Schedule{1};
    probes_.push_back({spec,
                       schedule,
                       std::move(quantities),
                       cell,
                       section_of(spec, gas_grid),
                       core::CsvSeries(folder.csv("probes", spec.name), probe_header(spec), resume_time),
                       {},
                       {},
                       0});
  }
}

void Probes::append(Probe& probe, const OutputState& state) {
  std::vector<double> row{state.time};
  if (probe.spec.bed) {
    const BedFigures bed = compute_bed_figures(state.host_particles(), floor_);
    for (const auto& name : probe.spec.quantities)
      row.push_back(bed_quantity(name, bed, state.gas, state.contacts));
  } else if (probe.spec.coating) {
    const CoatingFigures coating = compute_coating_figures(state.host_particles());
    for (const auto& name : probe.spec.quantities) row.push_back(coating_quantity(name, coating));
  } else if (probe.spec.particle) {
    ParticleSample particle;
    const bool found =
        state.particles != nullptr && finder_.find(*state.particles, *probe.spec.particle, particle);
    for (const int quantity : probe.quantities) {
      row.push_back(found ? particle_quantity(quantity, particle) : std::nan(""));
    }
  } else if (probe.spec.wall) {
    const WallFigures& now = find_wall(state, *probe.spec.wall);
    for (const int quantity : probe.quantities)
      row.push_back(wall_quantity(quantity, now, probe.before, state.time - probe.time_before));
    probe.before = now;
    probe.time_before = state.time;
  } else if (probe.spec.side) {
    const dem::SideTotals now = state.sides != nullptr
                                    ? (*state.sides)[static_cast<std::size_t>(*probe.spec.side)]
                                    : dem::SideTotals{};
    for (const int quantity : probe.quantities)
      row.push_back(side_quantity(quantity, now, probe.left_before, state.time - probe.time_before));
    probe.left_before = now;
    probe.time_before = state.time;
  } else if (probe.plane) {
    for (const int quantity : probe.quantities) row.push_back(probe.plane->quantity(*state.gas, quantity));
  } else {
    for (const int quantity : probe.quantities) row.push_back(gas_quantity(*state.gas, quantity, probe.cell));
  }
  probe.file.append(row);
}

void Probes::sample(const OutputState& state) {
  for (auto& probe : probes_) {
    if (probe.schedule.due(state.step)) append(probe, state);
  }
}

void Probes::flush() {
  for (auto& probe : probes_) probe.file.flush();
}

void Probes::save(core::CheckpointWriter& checkpoint) const {
  for (const auto& probe : probes_) {
    if (!probe.spec.wall && !probe.spec.side) continue;
    const std::string path = "probes/" + probe.spec.name;
    checkpoint.write(path + "/time", probe.time_before);
    if (probe.spec.side) {
      checkpoint.write(path + "/left_mass", probe.left_before.mass);
      checkpoint.write(path + "/left_particles", probe.left_before.particles);
      continue;
    }
    checkpoint.write(path + "/impulse", probe.before.impulse);
    checkpoint.write(path + "/angular_impulse", probe.before.angular_impulse);
    checkpoint.write(path + "/gas_impulse", probe.before.gas_impulse);
    checkpoint.write(path + "/heat", probe.before.heat.value_or(0));
  }
}

void Probes::load(const core::CheckpointReader& checkpoint) {
  for (auto& probe : probes_) {
    const std::string path = "probes/" + probe.spec.name;
    // The first row of a probe that is new with this run is a mean since t = 0.
    const char* const what = probe.spec.wall ? "/impulse" : "/left_mass";
    if ((!probe.spec.wall && !probe.spec.side) || !checkpoint.has(path + what)) continue;
    probe.time_before = checkpoint.read_double(path + "/time");
    if (probe.spec.side) {
      probe.left_before = {checkpoint.read_int64(path + "/left_particles"),
                           checkpoint.read_double(path + what)};
      continue;
    }
    probe.before.impulse = checkpoint.read_vec3(path + "/impulse");
    probe.before.angular_impulse = checkpoint.read_vec3(path + "/angular_impulse");
    probe.before.gas_impulse = checkpoint.read_vec3(path + "/gas_impulse");
    probe.before.heat = checkpoint.read_double(path + "/heat");
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
  Real from, width;
  std::size_t count;

  Bins(const std::vector<Real>& values, std::optional<Real> min, std::optional<Real> max, Index bins)
      : count(static_cast<std::size_t>(bins)) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    from = min.value_or(*least);
    Real to = max.value_or(*most);
    // All equal: one bin's width around the value, so that the bins have a size.
    if (!(to > from)) to = from + std::max(1e-12, 1e-6 * std::abs(from));
    width = (to - from) / bins;
  }
  Real low(std::size_t bin) const { return from + width * static_cast<Real>(bin); }
  /// `count` for what is outside.
  std::size_t find(Real value) const {
    const Real at = (value - from) / width;
    if (!(at >= 0) || value > low(count)) return count;
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
