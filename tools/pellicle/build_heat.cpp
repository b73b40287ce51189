#include "tools/pellicle/build_heat.hpp"

#include "core/model_variant.hpp"
#include "dem/normal_laws.hpp"
#include "tools/pellicle/case_checks.hpp"

namespace pellicle::tools {

namespace {

template <class Family>
Family named(const std::string& name) {
  return core::make_model<Family>(core::find_model(core::model_list<Family>(), name));
}

}  // namespace

heat::HeatOptions make_heat_options(const CaseSpec& spec) {
  const GasSpec& gas = *spec.gas;
  heat::HeatOptions options;
  options.nusselt = named<heat::TransferLaw>(spec.heat->nusselt);
  options.sherwood = named<heat::TransferLaw>(spec.heat->sherwood);
  options.saturation = named<heat::SaturationLaw>(spec.heat->saturation);
  options.evaporation = *spec.heat->evaporation;
  options.stefan_flow = spec.heat->stefan_flow;
  options.one_way = spec.coupling.exchange == coupling::Exchange::one_way;
  options.gas = {.capacity = gas.heat->capacity,
                 .conductivity = gas.heat->conductivity,
                 .diffusivity = gas.moisture ? gas.moisture->diffusivity : 0,
                 .viscosity = gas.options.viscosity,
                 .sutherland = gas.options.viscosity_law == cfd::ViscosityLaw::sutherland,
                 .pressure = gas.options.reference_pressure};
  const Real reference = gas.heat->reference_temperature.value_or(gas.heat->initial_temperature);
  options.water = {reference, spec.heat->latent_heat, gas.heat->vapour_capacity,
                   spec.coating.liquid_heat_capacity};
  // Given at another temperature: by Kirchhoff's law that at the reference.
  options.water.latent +=
      options.water.latent - options.water.evaporation(spec.heat->latent_heat_temperature);
  return options;
}

// The true modulus matters where contacts are Hertz's: linear springs know none.
heat::ConductionOptions make_conduction_options(const CaseSpec& spec) {
  heat::ConductionOptions options;
  const bool hertz = spec.contacts.normal == dem::Hertz::info.name;
  for (const MaterialSpec& m : spec.materials) {
    const Real factor = 1 / (1 - m.poisson_ratio * m.poisson_ratio);
    heat::ConductingSolid solid{m.conductivity.value_or(0), 0, 0};
    if (!m.rigid && hertz) {
      solid.modulus = factor * m.youngs_modulus;
      solid.true_modulus = factor * m.true_youngs_modulus.value_or(m.youngs_modulus);
    }
    options.solids.push_back(solid);
  }
  for (const WallSpec& wall : spec.walls) options.wall_temperature.push_back(wall.temperature);
  return options;
}

heat::SurfaceState make_surface(const CaseSpec& spec, const dem::Particles& particles) {
  std::vector<Real> capacities;
  for (const MaterialSpec& material : spec.materials)
    capacities.push_back(material.heat_capacity.value_or(0));
  heat::HeatCapacities film;
  film.liquid = spec.coating.liquid_heat_capacity;
  film.solids = spec.coating.solids_heat_capacity;
  // With films alone temperatures are of no use.
  const heat::FilmGrowth growth = spec.coating.growth;
  const Real solids = spec.coating.solids_density;
  if (!spec.heat) return {particles, capacities, film, film.reference_temperature, growth, solids};
  const GasHeatSpec& gas = *spec.gas->heat;
  film.reference_temperature = gas.reference_temperature.value_or(gas.initial_temperature);
  return {particles, capacities, film, *spec.heat->initial_temperature, growth, solids};
}

Real initial_temperature(const CaseSpec& spec, const PopulationSpec& population) {
  return population.initial_temperature.value_or(*spec.heat->initial_temperature);
}

heat::Film initial_film(const PopulationSpec& population, Real mass) {
  return {population.initial_liquid.value_or(0) * mass, population.initial_solids.value_or(0) * mass};
}

// Ids count listed particles first, then those of fills.
void set_initial_surface(const CaseSpec& spec, const std::vector<dem::ParticleSeed>& seeds,
                         heat::SurfaceState& surface) {
  std::vector<Real> temperature;
  std::vector<heat::Film> film;
  const auto append = [&](const PopulationSpec& population, std::size_t count) {
    const Real density = spec.materials[static_cast<std::size_t>(population.material)].density;
    for (std::size_t n = 0; n < count; ++n) {
      const Real mass = density * dem::sphere_volume(seeds[film.size()].radius);
      temperature.push_back(initial_temperature(spec, population));
      film.push_back(initial_film(population, mass));
    }
  };
  for (const PopulationSpec& population : spec.particles) append(population, population.list.size());
  for (const PopulationSpec& population : spec.particles) {
    if (population.fill) append(population, static_cast<std::size_t>(population.filled));
  }
  surface.set_by_id(temperature, film);
}

}  // namespace pellicle::tools
