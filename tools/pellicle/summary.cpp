#include "tools/pellicle/summary.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/progress.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

using Json = nlohmann::ordered_json;

double seconds_of(const Summary& summary, core::Part part) {
  return summary.wall_by_part[static_cast<std::size_t>(part)];
}

double particle_seconds(const Summary& summary) {
  return seconds_of(summary, core::Part::contacts) + seconds_of(summary, core::Part::neighbours) +
         seconds_of(summary, core::Part::motion);
}

/// The masses of a nozzle, or of all [kg].
constexpr std::pair<const char*, Real spray::NozzleFigures::*> spray_masses[] = {
    {"injected", &spray::NozzleFigures::injected},
    {"captured", &spray::NozzleFigures::captured},
    {"wall_loss", &spray::NozzleFigures::wall_loss},
    {"overspray", &spray::NozzleFigures::overspray},
    {"in_flight", &spray::NozzleFigures::in_flight},
    {"evaporated", &spray::NozzleFigures::evaporated},
    {"dried", &spray::NozzleFigures::dried},
    {"dust_captured", &spray::NozzleFigures::dust_captured},
    {"captured_solids", &spray::NozzleFigures::captured_solids},
    {"wall_solids", &spray::NozzleFigures::wall_solids},
    {"overspray_solids", &spray::NozzleFigures::overspray_solids},
    {"in_flight_solids", &spray::NozzleFigures::in_flight_solids},
};

Json vector_json(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

/// What droplets did with their momentum, where they push the gas [N s].
Json momentum_json(const SprayFigures& spray) {
  Json json;
  json["injected"] = vector_json(spray.momentum.injected);
  json["captured"] = vector_json(spray.momentum.captured);
  json["wall_loss"] = vector_json(spray.momentum.wall_loss);
  json["overspray"] = vector_json(spray.momentum.overspray);
  json["in_flight"] = vector_json(spray.momentum.in_flight);
  json["to_gas"] = vector_json(spray.impulses.on_gas);
  json["to_particles"] = vector_json(spray.momentum.to_particles);
  json["bounced"] = vector_json(spray.impulses.bounced);
  json["gravity"] = vector_json(spray.impulses.gravity);
  json["vapour"] = vector_json(spray.impulses.vapour);
  return json;
}

Json spray_json(const SprayFigures& spray) {
  Json json;
  for (const auto& [name, mass] : spray_masses) json[name] = spray.total(mass);
  json["enthalpy"] = spray.heat.enthalpy;
  json["free_heat"] = spray.heat.free_heat;
  if (spray.two_way) json["momentum"] = momentum_json(spray);
  for (const spray::NozzleFigures& nozzle : spray.nozzles) {
    Json& figures = json["nozzles"][nozzle.name];
    for (const auto& [name, mass] : spray_masses) figures[name] = nozzle.*mass;
    figures["solids_fraction"] = nozzle.solids_fraction;
    figures["parcels"] = nozzle.parcels;
  }
  return json;
}

SprayFigures read_spray(const Json& json) {
  SprayFigures spray;
  spray.heat = {json.at("enthalpy"), json.at("free_heat")};
  for (const auto& [name, figures] : json.at("nozzles").items()) {
    spray::NozzleFigures& nozzle = spray.nozzles.emplace_back();
    nozzle.name = name;
    for (const auto& [key, mass] : spray_masses) nozzle.*mass = figures.at(key);
    nozzle.solids_fraction = figures.at("solids_fraction");
    nozzle.parcels = figures.at("parcels");
  }
  return spray;
}

}  // namespace

double Summary::particle_steps_per_second() const {
  const double seconds = particle_seconds(*this);
  return seconds > 0 ? particle_steps / seconds : 0;
}

double Summary::wall_seconds_per_simulated_second() const {
  return simulated_seconds > 0 ? wall_seconds / simulated_seconds : 0;
}

void Summary::set_times(const core::Timers& timers) {
  for (std::size_t part = 0; part < wall_by_part.size(); ++part) {
    wall_by_part[part] = timers.seconds(static_cast<core::Part>(part));
  }
}

void Summary::set_defects(const core::Ledger& ledger) {
  for (std::size_t q = 0; q < defects.size(); ++q)
    defects[q] = ledger.defect(static_cast<core::Conserved>(q));
}

void write_summary(const std::filesystem::path& path, const Summary& summary) {
  Json json;
  json["status"] = summary.status;
  if (!summary.message.empty()) json["message"] = summary.message;
  json["title"] = summary.title;
  json["program"] = {{"version", summary.program_version}, {"commit", summary.program_commit}};
  json["simulated_seconds"] = summary.simulated_seconds;
  json["setup_seconds"] = summary.setup_seconds;
  json["wall_seconds"] = summary.wall_seconds;
  json["settling_seconds"] = summary.settling_seconds;
  json["wall_seconds_per_simulated_second"] = summary.wall_seconds_per_simulated_second();
  for (std::size_t part = 0; part < summary.wall_by_part.size(); ++part) {
    json["wall_by_part"][std::string(core::part_names[part])] = summary.wall_by_part[part];
  }
  json["threads"] = summary.threads;
  json["gas_steps"] = summary.gas_steps;
  if (const GasConvergence& gas = summary.gas; gas.steps > 0) {
    json["gas"] = {{"steps", gas.steps},
                   {"smallest_step", gas.smallest_step},
                   {"outer_iterations", gas.outer_iterations},
                   {"pressure_iterations", gas.pressure_iterations},
                   {"momentum_iterations", gas.momentum_iterations},
                   {"steps_not_converged", gas.steps_not_converged},
                   {"largest_velocity_change", gas.largest_velocity_change},
                   {"largest_continuity_residual", gas.largest_continuity_residual},
                   {"largest_momentum_residual", gas.largest_momentum_residual},
                   {"largest_divergence", gas.largest_divergence},
                   {"largest_courant_number", gas.largest_courant_number}};
  }
  json["particles"] = summary.particles;
  json["particle_steps"] = summary.particle_steps;
  json["particle_steps_per_second"] = summary.particle_steps_per_second();
  json["contacts_per_particle"] = summary.contacts_per_particle;
  json["largest_overlap"] = summary.largest_overlap;
  json["largest_overlap_ratio"] = summary.largest_overlap_ratio;
  json["largest_impact_speed"] = summary.largest_impact_speed;
  json["peak_memory_bytes"] = summary.peak_memory_bytes;
  json["engine_bytes"] = summary.engine_bytes;
  for (std::size_t q = 0; q < summary.defects.size(); ++q) {
    json["defects"][std::string(core::conserved_names[q])] = summary.defects[q];
  }
  json["instantaneous_momentum_defect"] = summary.instantaneous_momentum_defect;
  json["lost_particles"] = summary.lost_particles;
  json["particles_left_through_open_sides"] = summary.particles_left_through_open_sides;
  for (const WallFigures& wall : summary.walls) {
    const auto list = [](const Vec3& v) { return Json{v.x, v.y, v.z}; };
    const double time = summary.simulated_seconds;
    const auto mean = [&](const Vec3& v) { return list(time > 0 ? (1 / time) * v : Vec3{}); };
    json["walls"][wall.name] = {{"mean_force", mean(wall.impulse)},
                                {"mean_torque", mean(wall.angular_impulse)},
                                {"impulse", list(wall.impulse)},
                                {"angular_impulse", list(wall.angular_impulse)},
                                {"contacts", wall.contacts}};
    if (wall.heat) {
      json["walls"][wall.name]["heat"] = *wall.heat;
      json["walls"][wall.name]["mean_heat_rate"] = time > 0 ? *wall.heat / time : 0;
    }
    if (summary.gas.steps == 0) continue;
    json["walls"][wall.name]["mean_gas_force"] = mean(wall.gas_impulse);
    json["walls"][wall.name]["gas_impulse"] = list(wall.gas_impulse);
  }
  for (const GasBoundaryFigures& boundary : summary.gas_boundaries) {
    Json& figures = json["gas_boundaries"][boundary.name];
    figures = {{"mass_in", boundary.mass_in}, {"mass_out", boundary.mass_out}};
    if (boundary.heat_in) figures["heat_in"] = *boundary.heat_in;
    if (boundary.vapour_in) figures["vapour_in"] = *boundary.vapour_in;
  }
  if (!summary.spray.nozzles.empty()) json["spray"] = spray_json(summary.spray);
  json["mass_left"] = summary.mass_left;
  json["left_by_side"] = Json::object();
  for (std::size_t side = 0; side < summary.left_by_side.size(); ++side) {
    const dem::SideTotals& left = summary.left_by_side[side];
    if (left.particles == 0) continue;
    json["left_by_side"][std::string(domain_sides[side].name)] = {{"particles", left.particles},
                                                                  {"mass", left.mass}};
  }
  json["particles_fed"] = summary.particles_fed;
  json["mass_fed"] = summary.mass_fed;
  core::write_file_atomically(path, json.dump(2) + "\n");
}

Summary read_summary(const std::filesystem::path& path) {
  try {
    const Json json = Json::parse(core::read_file(path));
    Summary summary;
    summary.status = json.at("status");
    summary.message = json.value("message", "");
    summary.title = json.value("title", "");
    summary.program_version = json.at("program").at("version");
    summary.program_commit = json.at("program").at("commit");
    summary.simulated_seconds = json.at("simulated_seconds");
    summary.setup_seconds = json.value("setup_seconds", 0.0);
    summary.wall_seconds = json.at("wall_seconds");
    summary.settling_seconds = json.value("settling_seconds", 0.0);
    for (std::size_t part = 0; part < summary.wall_by_part.size(); ++part) {
      summary.wall_by_part[part] = json.at("wall_by_part").at(std::string(core::part_names[part]));
    }
    summary.threads = json.at("threads");
    summary.gas_steps = json.at("gas_steps");
    if (json.contains("gas")) {
      const Json& gas = json.at("gas");
      summary.gas.steps = gas.at("steps");
      summary.gas.smallest_step = gas.at("smallest_step");
      summary.gas.outer_iterations = gas.at("outer_iterations");
      summary.gas.pressure_iterations = gas.at("pressure_iterations");
      summary.gas.momentum_iterations = gas.at("momentum_iterations");
      summary.gas.steps_not_converged = gas.at("steps_not_converged");
      summary.gas.largest_velocity_change = gas.at("largest_velocity_change");
      summary.gas.largest_continuity_residual = gas.at("largest_continuity_residual");
      summary.gas.largest_momentum_residual = gas.at("largest_momentum_residual");
      summary.gas.largest_divergence = gas.at("largest_divergence");
      summary.gas.largest_courant_number = gas.at("largest_courant_number");
    }
    summary.particles = json.at("particles");
    summary.particle_steps = json.at("particle_steps");
    summary.contacts_per_particle = json.at("contacts_per_particle");
    summary.largest_overlap = json.at("largest_overlap");
    summary.largest_overlap_ratio = json.at("largest_overlap_ratio");
    summary.largest_impact_speed = json.at("largest_impact_speed");
    summary.peak_memory_bytes = json.at("peak_memory_bytes");
    summary.engine_bytes = json.value("engine_bytes", std::int64_t{0});
    for (std::size_t q = 0; q < summary.defects.size(); ++q) {
      // Not-a-number is null in JSON.
      const auto& defect = json.at("defects").at(std::string(core::conserved_names[q]));
      summary.defects[q] = defect.is_null() ? std::numeric_limits<double>::quiet_NaN() : defect.get<double>();
    }
    summary.instantaneous_momentum_defect = json.value("instantaneous_momentum_defect", 0.0);
    summary.lost_particles = json.at("lost_particles");
    summary.particles_left_through_open_sides = json.at("particles_left_through_open_sides");
    if (json.contains("walls")) {
      for (const auto& [name, wall] : json.at("walls").items()) {
        const auto vector = [&](const char* key) {
          const auto& list = wall.at(key);
          return Vec3{list.at(0), list.at(1), list.at(2)};
        };
        summary.walls.push_back({name, vector("impulse"), vector("angular_impulse"), wall.at("contacts"),
                                 wall.contains("gas_impulse") ? vector("gas_impulse") : Vec3{}});
        if (wall.contains("heat")) summary.walls.back().heat = wall.at("heat").get<double>();
      }
    }
    if (json.contains("gas_boundaries")) {
      for (const auto& [name, figures] : json.at("gas_boundaries").items()) {
        const auto optional = [&](const char* key) {
          return figures.contains(key) ? std::optional<double>(figures.at(key)) : std::nullopt;
        };
        summary.gas_boundaries.push_back({name, figures.at("mass_in"), figures.at("mass_out"),
                                          optional("heat_in"), optional("vapour_in")});
      }
    }
    if (json.contains("spray")) summary.spray = read_spray(json.at("spray"));
    summary.mass_left = json.at("mass_left");
    for (std::size_t side = 0; json.contains("left_by_side") && side < summary.left_by_side.size(); ++side) {
      const std::string name(domain_sides[side].name);
      if (!json.at("left_by_side").contains(name)) continue;
      const auto& left = json.at("left_by_side").at(name);
      summary.left_by_side[side] = {left.at("particles"), left.at("mass")};
    }
    summary.particles_fed = json.at("particles_fed");
    summary.mass_fed = json.at("mass_fed");
    return summary;
  } catch (const Json::exception& error) {
    throw RunError(fmt::format("{}: not a summary of a run: {}", path.string(), error.what()));
  }
}

std::string report_text(const Summary& summary) {
  std::string text;
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("{:<34}{}\n", name, value);
  };
  line("title", summary.title);
  line("status", summary.message.empty() ? summary.status : summary.status + ": " + summary.message);
  line("simulated", fmt::format("{:.6g} s in {} gas steps", summary.simulated_seconds, summary.gas_steps));
  line("set-up", fmt::format("{:.1f} s", summary.setup_seconds));
  line("wall time", fmt::format("{:.1f} s ({}), {:.4g} s per simulated second, {} threads",
                                summary.wall_seconds, core::format_duration(summary.wall_seconds),
                                summary.wall_seconds_per_simulated_second(), summary.threads));
  if (summary.settling_seconds > 0) {
    line("  of it settling", fmt::format("{:.1f} s", summary.settling_seconds));
  }
  for (std::size_t part = 0; part < summary.wall_by_part.size(); ++part) {
    const double seconds = summary.wall_by_part[part];
    if (seconds <= 0) continue;
    line(fmt::format("  {}", core::part_names[part]),
         fmt::format("{:.1f} s, {:.1f} %", seconds, 100 * seconds / std::max(summary.wall_seconds, 1e-300)));
  }
  if (const GasConvergence& gas = summary.gas; gas.steps > 0) {
    line("gas", fmt::format("{} steps, the smallest {:.3g} s; largest Courant number {:.3g}", gas.steps,
                            gas.smallest_step, gas.largest_courant_number));
    const auto per_step = [&](std::int64_t count) {
      return static_cast<double>(count) / static_cast<double>(gas.steps);
    };
    line("  iterations a step", fmt::format("{:.2f} outer, {:.1f} of the pressure, {:.1f} of the velocity",
                                            per_step(gas.outer_iterations), per_step(gas.pressure_iterations),
                                            per_step(gas.momentum_iterations)));
    line("  last change of velocities", fmt::format("{:.3g} of the largest", gas.largest_velocity_change));
    line("  continuity", fmt::format("{:.3g} of the throughput, {:.3g} of a cell's gas in a step",
                                     gas.largest_continuity_residual, gas.largest_divergence));
    line("  momentum", fmt::format("{:.3g}", gas.largest_momentum_residual));
  }
  line("particles", fmt::format("{}", summary.particles));
  if (summary.particles > 0) {
    line("particle steps per second", fmt::format("{:.4g}", summary.particle_steps_per_second()));
    line("contacts per particle", fmt::format("{:.3f}", summary.contacts_per_particle));
    line("largest overlap", fmt::format("{:.4g} m, {:.3f} % of the radius", summary.largest_overlap,
                                        100 * summary.largest_overlap_ratio));
    line("largest impact speed", fmt::format("{:.4g} m/s", summary.largest_impact_speed));
    line("lost particles", fmt::format("{}", summary.lost_particles));
    if (summary.particles_left_through_open_sides > 0) {
      line("left through open sides",
           fmt::format("{}, {:.4g} kg", summary.particles_left_through_open_sides, summary.mass_left));
      for (std::size_t side = 0; side < summary.left_by_side.size(); ++side) {
        const dem::SideTotals& left = summary.left_by_side[side];
        if (left.particles == 0) continue;
        line(fmt::format("  {}", domain_sides[side].name),
             fmt::format("{}, {:.4g} kg", left.particles, left.mass));
      }
    }
    if (summary.particles_fed > 0) {
      line("fed", fmt::format("{}, {:.4g} kg", summary.particles_fed, summary.mass_fed));
    }
  }
  for (const GasBoundaryFigures& boundary : summary.gas_boundaries) {
    std::string figures =
        fmt::format("{:.6g} kg of gas in, {:.6g} kg out", boundary.mass_in, boundary.mass_out);
    if (boundary.heat_in) figures += fmt::format(", {:.6g} J of heat in", *boundary.heat_in);
    if (boundary.vapour_in) figures += fmt::format(", {:.6g} kg of vapour in", *boundary.vapour_in);
    line(fmt::format("boundary {}", boundary.name), figures);
  }
  if (!summary.spray.nozzles.empty()) {
    const SprayFigures& spray = summary.spray;
    const Real injected = spray.total(&spray::NozzleFigures::injected);
    const auto share = [&](Real spray::NozzleFigures::*mass) {
      return injected > 0 ? 100 * spray.total(mass) / injected : 0;
    };
    line("sprayed", fmt::format("{:.6g} kg, {:.4g} kg of it solids", injected, spray.solids_injected()));
    line("  captured", fmt::format("{:.2f} %", share(&spray::NozzleFigures::captured)));
    line("  on walls", fmt::format("{:.2f} %", share(&spray::NozzleFigures::wall_loss)));
    line("  left the domain", fmt::format("{:.2f} %", share(&spray::NozzleFigures::overspray)));
    line("  in flight", fmt::format("{:.2f} %", share(&spray::NozzleFigures::in_flight)));
    if (spray.total(&spray::NozzleFigures::evaporated) != 0) {
      line("  evaporated in flight", fmt::format("{:.2f} %", share(&spray::NozzleFigures::evaporated)));
      // What coats is the solids: masses above are less by what evaporated.
      const Real solids = spray.solids_injected();
      const auto of_solids = [&](Real spray::NozzleFigures::*mass) {
        return solids > 0 ? 100 * spray.total(mass) / solids : 0;
      };
      line("  of the solids captured",
           fmt::format("{:.2f} %", of_solids(&spray::NozzleFigures::captured_solids)));
      line("  of the solids on walls",
           fmt::format("{:.2f} %", of_solids(&spray::NozzleFigures::wall_solids)));
      line("  of the solids dried to dust", fmt::format("{:.2f} %", of_solids(&spray::NozzleFigures::dried)));
    }
    if (spray.heat.free_heat != 0)
      line("  heated for nothing", fmt::format("{:.4g} J", spray.heat.free_heat));
  }
  for (std::size_t q = 0; q < summary.defects.size(); ++q) {
    if (summary.defects[q] == 0) continue;
    line(fmt::format("defect of {}", core::conserved_names[q]), fmt::format("{:.3g}", summary.defects[q]));
  }
  line("peak memory", fmt::format("{:.1f} MB", static_cast<double>(summary.peak_memory_bytes) / 1e6));
  if (summary.particles > 0) {
    line("  of it the particle engine",
         fmt::format("{:.1f} MB, {:.0f} bytes a particle", static_cast<double>(summary.engine_bytes) / 1e6,
                     static_cast<double>(summary.engine_bytes) / static_cast<double>(summary.particles)));
  }
  line("program", fmt::format("pellicle {} ({})", summary.program_version, summary.program_commit));
  return text;
}

std::int64_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{1024} * usage.ru_maxrss;
}

}  // namespace pellicle::tools
