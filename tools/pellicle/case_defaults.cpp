#include "tools/pellicle/case_defaults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dem/contact_laws.hpp"
#include "tools/pellicle/case_checks.hpp"
#include "tools/pellicle/case_file.hpp"
#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

namespace {

constexpr Real particle_steps_without_gas = 10;
constexpr Real least_impact_speed = 1;  // [m/s]

void fill_in_time(CaseSpec& spec, core::InputProblems& problems) {
  TimeSpec& time = spec.time;
  const bool with_particles = !spec.particles.empty();
  if (spec.gas && time.gas_step == 0) {
    problems.add(spec.where("time.gas_step"), "missing; with gas a time greater than 0 s");
  }
  if (with_particles && time.particle_step == 0) {
    problems.add(spec.where("time.particle_step"), "missing; with particles a time greater than 0 s");
  }
  if (!problems.empty()) return;
  if (time.gas_step == 0) time.gas_step = particle_steps_without_gas * time.particle_step;
  if (time.particle_step == 0) time.particle_step = time.gas_step;
  if (time.impact_speed == 0) {
    time.impact_speed = least_impact_speed;
    for (const auto& population : spec.particles) {
      time.impact_speed = std::max(time.impact_speed, norm(population.velocity));
      for (const auto& particle : population.list) {
        time.impact_speed = std::max(time.impact_speed, norm(particle.velocity));
      }
    }
  }
}

/// Size of the gas cell in the middle of the line, across it; the larger of two.
Real default_thickness(const CaseSpec& spec, const LineSpec& line) {
  const Vec3 along = line.to - line.from;
  if (!spec.gas) return norm(along) / static_cast<Real>(line.points);
  const CartesianGrid grid = make_grid(spec.gas->grid, spec.domain);
  Vec3 widths;
  int line_axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    widths[axis] = grid.width(axis, grid.locate(axis, 0.5 * (line.from[axis] + line.to[axis])));
    if (std::abs(along[axis]) > std::abs(along[line_axis])) line_axis = axis;
  }
  Real thickness = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != line_axis && axis != line.depth_average) thickness = std::max(thickness, widths[axis]);
  }
  return thickness;
}

/// How many particles each fill comes to; distributions of fills and feeds.
void count_fills(CaseSpec& spec, core::InputProblems& problems) {
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    PopulationSpec& population = spec.particles[i];
    try {
      if (population.sizes)
        (void)dem::SizeSampler(*population.sizes->distribution());  // throws here, not later
      if (population.fill) population.filled = count_fill(spec, i);
    } catch (const std::invalid_argument& error) {
      problems.add(spec.where(fmt::format("particles.{}.diameter", i)),
                   fmt::format("{}; a distribution with sizes between its bounds", error.what()));
    }
  }
}

/// The gas grid's cells where sizes and zones say what they are; false if they are too many.
bool make_refined(CaseSpec& spec, core::InputProblems& problems) {
  if (!spec.gas->grid.refinement) return true;
  try {
    refine(spec.gas->grid, spec.domain);
    return true;
  } catch (const std::length_error&) {
    problems.add(spec.where("gas.grid.cell_size"),
                 "with its zones it gives more than 100000 cells along an axis; larger sizes");
    return false;
  }
}

void fill_in_heat(CaseSpec& spec) {
  HeatSpec& heat = *spec.heat;
  if (!heat.evaporation) heat.evaporation = spec.gas && spec.gas->moisture;
  if (!heat.initial_temperature && spec.gas && spec.gas->heat) {
    heat.initial_temperature = spec.gas->heat->initial_temperature;
  }
}

bool has_temperature(const CaseSpec& spec, const std::string& wall) {
  return std::any_of(spec.walls.begin(), spec.walls.end(),
                     [&](const WallSpec& w) { return w.name == wall && w.temperature.has_value(); });
}

/// All that a probe can show, without what the gas does not carry.
std::vector<std::string> all_quantities(const CaseSpec& spec, const ProbeSpec& probe) {
  std::vector<std::string> names;
  const bool is_seen =
      spec.gas && probe.wall && std::any_of(spec.walls.begin(), spec.walls.end(), [&](const WallSpec& wall) {
        return wall.name == *probe.wall && (wall.box || wall.gas != GasWall::open);
      });
  for (const auto& quantity : quantities_of(probe)) {
    const bool warm = quantity.name == "gas_temperature" || quantity.name == "relative_humidity";
    const bool moist = quantity.name == "vapour_mass_fraction" || quantity.name == "relative_humidity";
    const bool there = (!warm || (spec.gas && spec.gas->heat)) &&
                       (!moist || (spec.gas && spec.gas->moisture)) && spec.follows(quantity.name);
    const bool eddies = !is_turbulent_quantity(quantity.name) || (spec.gas && spec.gas->options.turbulence);
    const bool needs_gas = quantity.name.starts_with("gas_force");
    const bool acts = !probe.wall || (needs_gas ? is_seen : !spec.particles.empty());
    const bool takes_heat = !quantity.name.starts_with("wall_heat") || has_temperature(spec, *probe.wall);
    if (there && eddies && acts && takes_heat) names.emplace_back(quantity.name);
  }
  return names;
}

}  // namespace

void fill_in_defaults(CaseSpec& spec, core::InputProblems& problems) {
  if (spec.title.empty()) spec.title = case_name(spec.file);
  fill_in_time(spec, problems);
  if (spec.contacts.normal == dem::Linear::info.name) {
    if (!spec.contacts.linear) spec.contacts.linear.emplace();
    if (spec.contacts.linear->speed == 0) spec.contacts.linear->speed = spec.time.impact_speed;
  }
  count_fills(spec, problems);
  if (spec.heat) fill_in_heat(spec);
  if (spec.gas && !make_refined(spec, problems)) return;
  if (spec.gas && spec.coupling.transfer_grid.cells.x == 0) {
    spec.coupling.transfer_grid = spec.gas->grid;
    spec.coupling.transfer_grid.refinement.reset();  // the cells that it came to are kept
  }
  for (auto& population : spec.particles) {
    if (population.feed && population.feed->to == 0) population.feed->to = spec.time.end;
  }
  for (auto& nozzle : spec.spray) {
    if (nozzle.to == 0) nozzle.to = spec.time.end;
    const bool hollow = nozzle.pattern == spray::SprayPattern::hollow;
    if (hollow && !nozzle.inner_cone_angle) nozzle.inner_cone_angle = 0.8 * nozzle.cone_angle;
  }
  for (auto& probe : spec.output.probes) {
    if (probe.quantities.empty()) probe.quantities = all_quantities(spec, probe);
    if (probe.average && probe.average->to == 0) probe.average->to = spec.time.end;
  }
  if (spec.output.average && spec.output.average->window.to == 0) {
    spec.output.average->window.to = spec.time.end;
  }
  for (auto& zone : spec.output.zones) {
    if (zone.longest_time == 0) zone.longest_time = spec.time.end;
  }
  for (auto& wetness : spec.output.wetness) {
    if (wetness.wettest == 0) wetness.wettest = wetness.measure == 0 ? 0.02 : 1;
  }
  for (auto& line : spec.output.lines) {
    if (line.thickness == 0) line.thickness = default_thickness(spec, line);
    if (line.average.to == 0) line.average.to = spec.time.end;
  }
}

}  // namespace pellicle::tools
