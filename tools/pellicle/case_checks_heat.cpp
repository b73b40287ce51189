#include <fmt/format.h>

#include <algorithm>

#include "tools/pellicle/case_checks.hpp"

namespace pellicle::tools {

namespace {

bool has_outlet(const GasSpec& gas) {
  return std::any_of(gas.boundaries.begin(), gas.boundaries.end(), [](const cfd::BoundaryPatch& patch) {
    return std::holds_alternative<cfd::Outlet>(patch.kind);
  });
}

void check_evaporation(const CaseSpec& spec, core::InputProblems& problems) {
  if (!*spec.heat->evaporation) return;
  const auto refuse = [&](const char* what) { problems.add(spec.where("heat.evaporation"), what); };
  if (!spec.gas->moisture) refuse("there is no vapour without gas.moisture; false, or with gas.moisture");
  if (!has_outlet(*spec.gas) && spec.coupling.exchange != coupling::Exchange::one_way) {
    refuse(
        "the vapour needs an outlet: the pressure of a closed domain would have to rise; false, or an "
        "outlet among gas.boundaries");
  }
}

/// What conducts, and keys that would do nothing.
void check_conduction(const CaseSpec& spec, core::InputProblems& problems) {
  const bool conducts = spec.heat && spec.heat->contact_conduction;
  for (const WallSpec& wall : spec.walls) {
    if (conducts || !wall.temperature) continue;
    const std::string path = wall.where.substr(wall.where.rfind(": ") + 2) + ".temperature";
    problems.add(spec.where(path), "nothing conducts heat to the wall; with heat.contact_conduction: true");
  }
  if (!conducts) return;
  for (const PopulationSpec& population : spec.particles) {
    const MaterialSpec& material = spec.materials[static_cast<std::size_t>(population.material)];
    if (material.conductivity) continue;
    problems.add(spec.where(fmt::format("materials.{}.conductivity", material.name)),
                 "missing; of particles with heat.contact_conduction a conductivity greater than 0 W/m/K");
  }
}

/// Droplets exchange what particles do.
void check_droplets(const CaseSpec& spec, core::InputProblems& problems) {
  if (!spec.droplets.evaporation) return;
  const auto refuse = [&](const char* what) { problems.add(spec.where("droplets.evaporation"), what); };
  if (!spec.heat || !spec.heat->evaporation.value_or(false)) {
    refuse("needs heat with evaporation; false, or with heat and gas.moisture");
  } else if (spec.coupling.exchange == coupling::Exchange::one_way) {
    refuse("the gas gives without losing, with coupling.exchange one_way; false, or another exchange");
  }
  for (const NozzleSpec& nozzle : spec.spray) {
    const Real s = nozzle.solids_fraction;
    if (s == 1 || 1 / nozzle.density > s / spec.coating.solids_density) continue;
    problems.add(
        spec.where(fmt::format("spray.{}.density", nozzle.name)),
        fmt::format("the solids in a droplet, of {:g} kg/m3, leave no room for its liquid; a smaller "
                    "density, or a larger coating.solids_density",
                    spec.coating.solids_density));
  }
}

/// What a radius that grows does not go with.
void check_growing_radius(const CaseSpec& spec, core::InputProblems& problems) {
  if (spec.coating.growth != heat::FilmGrowth::mass_and_radius) return;
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    if (!(spec.particles[i].initial_solids.value_or(0) > 0)) continue;
    problems.add(spec.where(fmt::format("particles.{}.initial_solids", i)),
                 "with coating.growth mass_and_radius they would make the particle larger than its diameter "
                 "at once; 0");
  }
  for (const ZoneSpec& zone : spec.output.zones) {
    if (zone.size_classes == 1) continue;
    problems.add(spec.where(zone.where.substr(zone.where.rfind(": ") + 2) + ".size_classes"),
                 "with coating.growth mass_and_radius particles would change their class; 1");
  }
}

}  // namespace

void check_heat(const CaseSpec& spec, core::InputProblems& problems) {
  check_conduction(spec, problems);
  if (!spec.heat && spec.spray.empty() && spec.coating.growth != heat::FilmGrowth::none) {
    problems.add(spec.where("coating.growth"),
                 "there are no films without heat or spray; none, or with one of them");
  }
  check_droplets(spec, problems);
  check_growing_radius(spec, problems);
  if (!spec.heat) {
    for (std::size_t i = 0; i < spec.particles.size(); ++i) {
      for (const char* key : {"initial_temperature", "initial_liquid", "initial_solids"}) {
        const std::string path = fmt::format("particles.{}.{}", i, key);
        if (spec.lines.contains(path)) problems.add(spec.where(path), "without heat it is of no use; heat");
      }
    }
    return;
  }
  if (spec.particles.empty() || !spec.gas || !spec.gas->heat) {
    problems.add(spec.where("heat"), spec.particles.empty()
                                         ? "it is that of particles, of which there are none; gas.heat alone"
                                         : "the gas must have a temperature; with gas.heat");
    return;
  }
  if (!(spec.gas->heat->conductivity > 0)) {
    problems.add(spec.where("gas.heat.conductivity"),
                 "0 leaves no heat transfer; with heat more than 0 W/m/K");
  }
  check_evaporation(spec, problems);
  for (const PopulationSpec& population : spec.particles) {
    const MaterialSpec& material = spec.materials[static_cast<std::size_t>(population.material)];
    if (material.heat_capacity) continue;
    problems.add(spec.where(fmt::format("materials.{}.heat_capacity", material.name)),
                 "missing; of particles with heat a heat capacity greater than 0 J/kg/K");
  }
}

}  // namespace pellicle::tools
