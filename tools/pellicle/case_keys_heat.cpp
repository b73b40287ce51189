// Keys of heat and vapour of the particles, and of the films on them.
#include "core/model_variant.hpp"
#include "heat/heat_options.hpp"
#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

using core::Keys;
using core::Need;
namespace dimension = core::dimension;
namespace range = core::range;

void describe_exchange(Keys& keys, HeatSpec& heat) {
  keys.choice({"nusselt", "law of the heat transfer between gas and particles"}, transfer_laws, heat.nusselt);
  keys.choice({"sherwood", "law of the transfer of vapour"}, transfer_laws, heat.sherwood);
  keys.flag({"evaporation", "and condensation, of water on particles", Need::has_default,
             "whether there is gas.moisture"},
            heat.evaporation);
  keys.choice({"saturation", "vapour pressure over water"}, saturation_laws, heat.saturation);
  keys.flag({"stefan_flow", "vapour that evaporates carries more of itself along"}, heat.stefan_flow);
  keys.flag({"contact_conduction", "of heat between particles that touch, and to walls with a temperature"},
            heat.contact_conduction);
  keys.real({"latent_heat",
             "of evaporation, at latent_heat_temperature; elsewhere it follows from the heat "
             "capacities of vapour and liquid"},
            {dimension::specific_energy, range::positive}, heat.latent_heat);
  keys.real({"latent_heat_temperature", "at which latent_heat is given"},
            {dimension::temperature, range::positive}, heat.latent_heat_temperature);
  keys.real({"initial_temperature", "of particles", Need::has_default, "that of the gas"},
            {dimension::temperature, range::positive}, heat.initial_temperature);
}

void describe_film(Keys& keys, CoatingSpec& coating) {
  keys.real({"liquid_heat_capacity", "of the liquid part of films"},
            {dimension::heat_capacity, range::positive}, coating.liquid_heat_capacity);
  keys.real({"solids_density", "of the dry coating"}, {dimension::density, range::positive},
            coating.solids_density);
  keys.real({"solids_heat_capacity", "of the same"}, {dimension::heat_capacity, range::positive},
            coating.solids_heat_capacity);
  keys.choice({"growth", "what films do to the particles' motion"}, heat::film_growth_models, coating.growth);
}

}  // namespace

void describe_heat_and_films(Keys& keys, CaseSpec& spec) {
  keys.section<HeatSpec>(
      {"heat", "particles have a temperature, and exchange heat and vapour with the gas; needs gas.heat"},
      spec.heat, describe_exchange);
  std::optional<CoatingSpec> held;
  if (!keys.reading() && (spec.heat || !spec.spray.empty())) held = spec.coating;
  keys.section<CoatingSpec>({"coating", "what films on particles are made of"}, held, describe_film);
  if (keys.reading() && held) spec.coating = *held;
}

}  // namespace pellicle::tools
