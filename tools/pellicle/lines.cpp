#include "tools/pellicle/lines.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/checkpoint.hpp"
#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

Lines::Lines(const std::vector<LineSpec>& specs, core::TimeControl& time, const CartesianGrid* gas_grid) {
  for (const auto& spec : specs) {
    Line line;
    line.spec = spec;
    line.geometry = make_line_geometry(spec);
    line.window = time.window(spec.average.from, spec.average.to, "output.lines." + spec.name + ".average");
    const int particle_quantity = core::find_model(particle_quantities, spec.quantity);
    line.gas_quantity = core::find_model(gas_quantities, spec.quantity);
    if (particle_quantity >= 0) {
      line.particles = std::make_unique<ParticleLine>(line.geometry, particle_quantity);
    } else if (line.gas_quantity >= 0) {
      if (gas_grid == nullptr) {
        throw InputError(fmt::format("{}: {} is a quantity of the gas, and this case has none", spec.where,
                                     spec.quantity));
      }
      line.cells = bin_cells(spec, line.geometry, *gas_grid);
      line.gas_moments.resize(static_cast<std::size_t>(spec.points));
    } else {
      throw InputError(fmt::format("{}: unknown quantity {}; allowed: {}", spec.where, spec.quantity,
                                   line_quantity_names()));
    }
    lines_.push_back(std::move(line));
  }
}

void Lines::sample(std::int64_t step, const ParticleColumns* particles, const GasFields* gas) {
  for (auto& line : lines_) {
    if (!line.window.contains(step)) continue;
    if (line.particles) {
      if (particles != nullptr) line.particles->add(*particles);
    } else if (gas != nullptr) {
      for (std::size_t bin = 0; bin < line.cells.size(); ++bin) {
        if (line.cells[bin].empty()) continue;
        Real value = 0;
        for (const auto& [cell, share] : line.cells[bin])
          value += share * gas_quantity(*gas, line.gas_quantity, cell);
        line.gas_moments[bin].add(value);
      }
    }
  }
}

std::vector<core::RunningMoments> Lines::moments_of(const Line& line) {
  return line.particles ? line.particles->moments() : line.gas_moments;
}

void Lines::write(const ResultsFolder& folder) const {
  for (const auto& line : lines_) {
    const std::vector<core::RunningMoments> moments = moments_of(line);
    const std::size_t points = moments.size();
    const std::string header = column_header(line.spec.quantity);
    const std::string unit = header.substr(header.find('['));
    const Vec3& direction = line.geometry.direction;
    std::string position = "distance [m]";
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(direction[axis]) > 1 - 1e-12) position = fmt::format("{} [m]", "xyz"[axis]);
    }
    core::CsvTable table{{position, header, "standard_deviation " + unit, "samples [-]"},
                         std::vector<std::vector<double>>(4, std::vector<double>(points))};
    table.columns[0] = line_positions(line.spec, line.geometry);
    for (std::size_t bin = 0; bin < points; ++bin) {
      table.columns[1][bin] = moments[bin].mean_or_nan();
      table.columns[2][bin] = moments[bin].deviation();
      table.columns[3][bin] = static_cast<double>(moments[bin].samples);
    }
    core::write_csv(folder.csv("lines", line.spec.name), table);
  }
}

std::string Lines::fingerprint(const Line& line) {
  const LineSpec& s = line.spec;
  // The window's end is left out: a longer run goes on with the same average.
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {}", s.quantity, s.from.x, s.from.y, s.from.z, s.to.x,
                     s.to.y, s.to.z, s.points, s.depth_average.value_or(-1), s.thickness, line.window.from,
                     s.name);
}

void Lines::save(core::CheckpointWriter& checkpoint) const {
  for (const auto& line : lines_) {
    const std::string name = "output/lines/" + line.spec.name + "/";
    checkpoint.write(name + "is", fingerprint(line));
    checkpoint.write(name + "moments", moments_of(line));
  }
}

void Lines::load(const core::CheckpointReader& checkpoint) {
  for (auto& line : lines_) {
    const std::string name = "output/lines/" + line.spec.name + "/";
    // A checkpoint of an earlier version has no moments.
    if (!checkpoint.has(name + "moments") || checkpoint.read_string(name + "is") != fingerprint(line)) {
      core::log().warn("the line {} is new or has changed since the checkpoint: its average begins now",
                       line.spec.name);
      continue;
    }
    std::vector<core::RunningMoments> moments(static_cast<std::size_t>(line.spec.points));
    checkpoint.read_into(name + "moments", moments);
    if (line.particles) {
      line.particles->set_moments(moments);
    } else {
      line.gas_moments = std::move(moments);
    }
  }
}

}  // namespace pellicle::tools
