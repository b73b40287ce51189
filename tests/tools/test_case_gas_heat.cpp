// Keys of the heat and the moisture of the gas: what they come to, and what is refused.
#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "tests/tools/cases_for_tests.hpp"
#include "tools/pellicle/case_file.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {
namespace {

using tests::drying_case;
using tests::humid_case;
using tests::rising_case;

std::string errors(const char* text, const std::vector<std::string>& assignments) {
  try {
    parse_case(text, "c.yaml", assignments);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(CaseGasHeat, IsRead) {
  const GasSpec gas = *parse_case(humid_case, "c.yaml").gas;
  const cfd::GasOptions& o = gas.options;
  EXPECT_EQ(o.density_law, cfd::DensityLaw::ideal_gas);
  EXPECT_EQ(o.viscosity_law, cfd::ViscosityLaw::sutherland);
  EXPECT_FALSE(o.boussinesq.has_value());
  const cfd::ScalarOptions& heat = *o.scalars[0];
  EXPECT_EQ(heat.capacity, 1000);
  EXPECT_EQ(*heat.vapour_capacity, 1900);
  EXPECT_DOUBLE_EQ(heat.conductivity, 0.03);
  EXPECT_DOUBLE_EQ(heat.initial, 293.15);
  EXPECT_DOUBLE_EQ(heat.reference, 273.15);
  const cfd::ScalarOptions& moisture = *o.scalars[1];
  EXPECT_DOUBLE_EQ(moisture.diffusivity, 3e-5);
  EXPECT_EQ(moisture.reference, 0);
  // Half of 2338.8 Pa (ASHRAE, 20 degC) of 1 bar: X = 0.011694, w = 0.622 X / (1 - 0.378 X) = 0.00731.
  EXPECT_NEAR(moisture.initial, 0.00731, 2e-5);
  // 1e5 / (8.314463 * 293.15) * M, of dry air 1.1883; moist air is lighter by 0.378 X.
  EXPECT_NEAR(o.density, 1.1883 * (1 - 0.378 * 0.011694), 2e-4);
  EXPECT_NEAR(o.viscosity, 1.813e-5, 1e-8);
  const auto& inlet = gas.boundaries[0].scalars;
  EXPECT_DOUBLE_EQ(std::get<cfd::GivenValue>(inlet[0]).value, 353.15);
  // A tenth of 47411.6 Pa at 80 degC: X = 0.047412, w = 0.0300.
  EXPECT_NEAR(std::get<cfd::GivenValue>(inlet[1]).value, 0.0300, 1e-4);
  EXPECT_EQ(std::get<cfd::GivenValue>(gas.boundaries[1].scalars[1]).value, 0.01);
  EXPECT_DOUBLE_EQ(std::get<cfd::GivenValue>(gas.boundaries[2].scalars[0]).value, 373.15);
  const auto jacket = std::get<cfd::Surroundings>(gas.boundaries[3].scalars[0]);
  EXPECT_EQ(jacket.coefficient, 5);
  EXPECT_DOUBLE_EQ(jacket.value, 288.15);
  EXPECT_TRUE(std::holds_alternative<cfd::Insulated>(gas.boundaries[3].scalars[1]));
}

TEST(CaseGasHeat, BuoyancyHasDefaults) {
  EXPECT_EQ(parse_case(rising_case, "c.yaml").gas->options.boussinesq->temperature, 310);
  EXPECT_EQ(parse_case(rising_case, "c.yaml").gas->options.boussinesq->expansion, 3e-3);
  const auto plain = *parse_case(rising_case, "c.yaml", {"gas.heat.buoyancy={}"}).gas->options.boussinesq;
  EXPECT_EQ(plain.temperature, 300);
  EXPECT_EQ(plain.expansion, 1.0 / 300);
}

TEST(CaseGasHeat, ContradictionsAreRefused) {
  const auto humid = [](const std::string& assignment) { return errors(humid_case, {assignment}); };
  const auto channel = [](const std::string& assignment) {
    return errors(tests::channel_case, {assignment});
  };
  EXPECT_EQ(errors(humid_case, {}), "accepted");
  EXPECT_TRUE(says(humid("gas.boundaries.below.inlet={velocity: 1, vapour_mass_fraction: 0}"),
                   "gas.boundaries.below.inlet.temperature: missing; a temperature"));
  EXPECT_TRUE(says(humid("gas.boundaries.below.inlet={velocity: 1, temperature: 300}"),
                   "gas.boundaries.below.inlet.vapour_mass_fraction: missing"));
  EXPECT_TRUE(
      says(humid("gas.boundaries.below.inlet.vapour_mass_fraction=0.1"), "says the same; one of the two"));
  EXPECT_TRUE(says(humid("gas.boundaries.jacket.wall.temperature=300"), "has a given temperature as well"));
  EXPECT_TRUE(says(humid("gas.heat.buoyancy={}"), "an ideal gas has its own"));
  EXPECT_TRUE(says(humid("gas.density={law: ideal}"), "\"ideal\" is unknown, the nearest is ideal_gas"));
  EXPECT_TRUE(says(channel("gas.density={law: ideal_gas}"), "gas.density: an ideal gas needs a temperature"));
  EXPECT_TRUE(says(channel("gas.viscosity={law: sutherland}"), "gas.viscosity: the law needs a temperature"));
  EXPECT_TRUE(says(channel("gas.boundaries=[{name: w, on: top, wall: {temperature: 300}}]"),
                   "wall.temperature: without gas.heat it is of no use"));
  EXPECT_TRUE(says(channel("gas.moisture={initial_relative_humidity: 0.5}"),
                   "relative to what temperature is not said"));
  EXPECT_TRUE(says(channel("gas.boundaries=[{name: o, on: top, outlet: {relative_humidity: 0.5}}]"),
                   "relative_humidity: without gas.moisture it is of no use"));
  EXPECT_TRUE(
      says(channel("output.probes=[{name: p, point: [0.5, 0.5, 0.5], quantities: [gas_temperature]}]"),
           "gas_temperature needs a temperature of the gas; gas.heat"));
  EXPECT_TRUE(says(channel("output.snapshots.gas=[vapour_mass_fraction]"), "needs moisture of the gas"));
}

TEST(CaseTurbulence, KeysAreTakenOver) {
  const GasSpec gas = *parse_case(tests::turbulent_case, "c.yaml").gas;
  ASSERT_TRUE(gas.options.turbulence.has_value());
  EXPECT_EQ(gas.options.turbulence->initial_k, 0.5);
  EXPECT_EQ(gas.options.turbulence->initial_epsilon, 10);
  EXPECT_EQ(gas.options.turbulence->prandtl_number, 0.85);
  EXPECT_EQ(gas.options.turbulence->schmidt_number, 0.8);
  EXPECT_EQ(gas.options.turbulence->largest_viscosity_ratio, 1e4);
  EXPECT_DOUBLE_EQ(gas.boundaries[0].turbulence.intensity, 0.1);
  EXPECT_DOUBLE_EQ(*gas.boundaries[0].turbulence.length_scale, 0.01);
  const GasSpec plain = *parse_case(tests::turbulent_case, "c.yaml", {"gas.k_epsilon="}).gas;
  EXPECT_EQ(plain.options.turbulence->prandtl_number, 0.9);
  EXPECT_FALSE(plain.options.turbulence->initial_k.has_value());
  EXPECT_FALSE(parse_case(tests::channel_case, "c.yaml").gas->options.turbulence.has_value());
}

TEST(CaseTurbulence, ContradictionsAreRefused) {
  const auto turbulent = [](const std::string& assignment) {
    return errors(tests::turbulent_case, {assignment});
  };
  EXPECT_EQ(turbulent("gas.velocity=[1, 0, 0]"), "accepted");
  EXPECT_TRUE(says(turbulent("gas.turbulence=none"), "gas.k_epsilon: of no use without the model"));
  EXPECT_TRUE(says(turbulent("gas.turbulence=k_omega"), "none, k_epsilon"));
  EXPECT_TRUE(says(errors(tests::turbulent_case, {"gas.turbulence=none", "gas.k_epsilon="}),
                   "inlet.turbulence: there is no model of turbulence"));
  EXPECT_TRUE(says(turbulent("gas.boundaries.in.inlet.turbulence.length_scale=0"), "greater than 0"));
  EXPECT_TRUE(says(errors(tests::channel_case, {"output.snapshots.gas=[eddy_viscosity]"}),
                   "eddy_viscosity needs a model of turbulence; gas.turbulence: k_epsilon"));
}

TEST(CaseHeat, KeysOfParticlesAreRead) {
  const CaseSpec spec = parse_case(drying_case, "c.yaml");
  const HeatSpec& heat = *spec.heat;
  EXPECT_EQ(heat.nusselt, "ranz_marshall");
  EXPECT_EQ(heat.saturation, "clausius_clapeyron");
  EXPECT_TRUE(heat.stefan_flow);
  EXPECT_EQ(heat.latent_heat, 2.501e6);
  EXPECT_NEAR(heat.latent_heat_temperature, 273.15, 1e-12);
  EXPECT_NEAR(*heat.initial_temperature, 303.15, 1e-12);
  EXPECT_NEAR(*spec.particles[0].initial_temperature, 313.15, 1e-12);
  EXPECT_EQ(spec.particles[0].initial_liquid, 0.05);
  EXPECT_EQ(spec.particles[0].initial_solids, 0.01);
  EXPECT_EQ(spec.materials[0].heat_capacity, 900);
  EXPECT_EQ(spec.coating.solids_density, 1300);
  EXPECT_EQ(spec.coating.liquid_heat_capacity, 4200);
}

// Without moisture nothing evaporates, and particles begin as warm as the gas.
TEST(CaseHeat, DefaultsFollowFromTheGas) {
  const CaseSpec wet = parse_case(drying_case, "c.yaml", {"heat={}", "walls="});
  EXPECT_TRUE(*wet.heat->evaporation);
  EXPECT_EQ(*wet.heat->initial_temperature, 300);
  EXPECT_EQ(wet.heat->nusselt, "gunn");
  const CaseSpec dry = parse_case(drying_case, "c.yaml", {"heat={}", "walls=", "gas.moisture="});
  EXPECT_FALSE(*dry.heat->evaporation);
}

TEST(CaseHeat, WhatCannotBeIsRefused) {
  const auto drying = [](const std::string& assignment) { return errors(drying_case, {assignment}); };
  EXPECT_EQ(drying("heat.latent_heat=0"),
            "--set: heat.latent_heat: \"0\" is out of range; an energy per mass greater than 0");
  EXPECT_NE(drying("gas.moisture=").find("heat.evaporation: there is no vapour without gas.moisture"),
            std::string::npos);
  EXPECT_NE(drying("gas.heat=").find("heat: the gas must have a temperature; with gas.heat"),
            std::string::npos);
  EXPECT_NE(drying("gas.boundaries=[]").find("heat.evaporation: the vapour needs an outlet"),
            std::string::npos);
  EXPECT_NE(drying("materials.bead.heat_capacity=").find("materials.bead.heat_capacity: missing"),
            std::string::npos);
  EXPECT_NE(drying("heat=").find("particles.0.initial_liquid: without heat it is of no use"),
            std::string::npos);
}

}  // namespace
}  // namespace pellicle::tools
