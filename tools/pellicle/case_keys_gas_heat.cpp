// Keys of what the gas carries: its heat and its moisture, and what of the gas depends on them.
#include "tools/pellicle/case_keys_gas_heat.hpp"

#include <fmt/format.h>

#include "cfd/gas_property_laws.hpp"

namespace pellicle::tools {

namespace {

using core::Keys;
using core::Need;
namespace dimension = core::dimension;
namespace range = core::range;

constexpr core::ModelInfo density_law_list[] = {
    {"ideal_gas",
     "p M / (R T) of moist air at gas.reference_pressure, from temperature and moisture at the start "
     "of each step"}};
constexpr core::ModelInfo viscosity_law_list[] = {{"sutherland",
                                                   "of air at the temperature at the start of each step",
                                                   "U.S. Standard Atmosphere 1976, eq. 51"}};

struct LawKeys {
  std::optional<int> law;
};

/// A number, or `{law: NAME}`; `follows_law` is which of the two.
void describe_property(Keys& keys, const core::Key& key, const core::RealRule& rule, core::ModelList laws,
                       Real& value, bool& follows_law) {
  std::optional<Real> number;
  std::optional<LawKeys> law;
  if (!keys.reading() && follows_law) law = LawKeys{0};
  if (!keys.reading() && !follows_law && value > 0) number = value;
  keys.real_or_section<LawKeys>(key, rule, number, law, [&](Keys& inner, LawKeys& held) {
    inner.choice({"law", "that it follows, in place of a number", Need::required}, laws, held.law);
  });
  if (!keys.reading()) return;
  if (number) value = *number;
  follows_law = law.has_value();
}

void describe_heat(Keys& keys, GasHeatSpec& heat) {
  keys.real({"initial_temperature", "of the gas", Need::required}, {dimension::temperature, range::positive},
            heat.initial_temperature);
  keys.real({"capacity", "of dry gas at constant pressure"}, {dimension::heat_capacity, range::positive},
            heat.capacity);
  keys.real({"vapour_capacity", "of vapour at constant pressure; of use with gas.moisture"},
            {dimension::heat_capacity, range::positive}, heat.vapour_capacity);
  keys.real({"conductivity", "of the gas"}, {dimension::heat_conductivity, range::non_negative},
            heat.conductivity);
  keys.real({"reference_temperature", "from which the balance of heat counts", Need::has_default,
             "the initial temperature"},
            {dimension::temperature, range::positive}, heat.reference_temperature);
  keys.section<BuoyancySpec>(
      {"buoyancy", "of a gas of constant density (Boussinesq); an ideal gas has its own"}, heat.buoyancy,
      [](Keys& inner, BuoyancySpec& buoyancy) {
        inner.real({"temperature", "at which there is none", Need::has_default, "the initial temperature"},
                   {dimension::temperature, range::positive}, buoyancy.temperature);
        inner.real({"expansion", "share of the density that is lost per kelvin", Need::has_default,
                    "1 / temperature, as of an ideal gas"},
                   {dimension::thermal_expansion}, buoyancy.expansion);
      });
}

/// Mass fraction of vapour: itself, or a relative humidity at a temperature, if there is one.
void describe_humidity(Keys& keys, std::string_view fraction_name, std::string_view humidity_name,
                       const std::optional<Real>& temperature, Real pressure, std::optional<Real>& fraction) {
  keys.real({fraction_name, "mass of vapour per mass of moist gas"},
            {dimension::pure_number, range::from_0_to_1}, fraction);
  std::optional<Real> humidity;
  keys.real(
      {humidity_name, "vapour pressure over that of saturation at its temperature, in place of the fraction"},
      {dimension::pure_number, range::from_0_to_1}, humidity);
  if (!humidity) return;
  if (fraction) {
    keys.problem(humidity_name, fmt::format("{} says the same; one of the two", fraction_name));
  } else if (!temperature) {
    keys.problem(
        humidity_name,
        fmt::format("relative to what temperature is not said; with a temperature and gas.heat, or {}",
                    fraction_name));
  } else {
    fraction = cfd::humid_vapour_mass_fraction(*humidity, *temperature, pressure);
  }
}

std::optional<Real> initial_temperature(const GasSpec& gas) {
  if (gas.heat) return gas.heat->initial_temperature;
  return std::nullopt;
}

/// A key that has no use without a section that is not there.
bool needs(Keys& keys, std::string_view name, std::string_view section, bool there) {
  if (there || !keys.given(name)) return there;
  keys.problem(name, fmt::format("without {} it is of no use; {}, or without this key", section, section));
  return false;
}

}  // namespace

void describe_gas_properties(Keys& keys, GasSpec& gas) {
  cfd::GasOptions& o = gas.options;
  bool ideal = o.density_law == cfd::DensityLaw::ideal_gas;
  describe_property(keys, {"density", "of the gas", Need::required}, {dimension::density, range::positive},
                    density_law_list, o.density, ideal);
  bool sutherland = o.viscosity_law == cfd::ViscosityLaw::sutherland;
  describe_property(keys, {"viscosity", "dynamic", Need::required}, {dimension::viscosity, range::positive},
                    viscosity_law_list, o.viscosity, sutherland);
  keys.real({"reference_pressure",
             "absolute: of an ideal gas, and what relative humidities are turned into "
             "moisture with"},
            {dimension::pressure, range::positive}, o.reference_pressure);
  keys.section<GasHeatSpec>({"heat", "the gas has a temperature"}, gas.heat, describe_heat);
  keys.section<GasMoistureSpec>(
      {"moisture", "the gas carries vapour"}, gas.moisture, [&](Keys& inner, GasMoistureSpec& moisture) {
        std::optional<Real> fraction;
        if (!inner.reading()) fraction = moisture.initial_vapour_mass_fraction;
        describe_humidity(inner, "initial_vapour_mass_fraction", "initial_relative_humidity",
                          initial_temperature(gas), o.reference_pressure, fraction);
        moisture.initial_vapour_mass_fraction = fraction.value_or(0);
        inner.real({"diffusivity", "of vapour in the gas"}, {dimension::diffusivity, range::non_negative},
                   moisture.diffusivity);
      });
  if (!keys.reading()) return;
  o.density_law = ideal ? cfd::DensityLaw::ideal_gas : cfd::DensityLaw::constant;
  o.viscosity_law = sutherland ? cfd::ViscosityLaw::sutherland : cfd::ViscosityLaw::constant;
  if (ideal && !gas.heat) keys.problem("density", "an ideal gas needs a temperature; a number, or gas.heat");
  if (sutherland && !gas.heat)
    keys.problem("viscosity", "the law needs a temperature; a number, or gas.heat");
  if (ideal && gas.heat && gas.heat->buoyancy) {
    keys.problem("heat", "buoyancy is for a constant density, an ideal gas has its own; one of the two");
  }
  set_gas_options(gas);
}

void set_gas_options(GasSpec& gas) {
  cfd::GasOptions& o = gas.options;
  if (gas.moisture) {
    cfd::ScalarOptions& moisture = o.scalars[index_of(cfd::Scalar::moisture)].emplace();
    moisture.diffusivity = gas.moisture->diffusivity;
    moisture.initial = gas.moisture->initial_vapour_mass_fraction;
  }
  if (!gas.heat) return;
  const Real initial = gas.heat->initial_temperature;
  cfd::ScalarOptions& heat = o.scalars[index_of(cfd::Scalar::temperature)].emplace();
  heat.capacity = gas.heat->capacity;
  if (gas.moisture) heat.vapour_capacity = gas.heat->vapour_capacity;
  heat.conductivity = gas.heat->conductivity;
  heat.initial = initial;
  heat.reference = gas.heat->reference_temperature.value_or(initial);
  if (gas.heat->buoyancy) {
    const Real still = gas.heat->buoyancy->temperature.value_or(initial);
    o.boussinesq = cfd::Boussinesq{gas.heat->buoyancy->expansion.value_or(1 / still), still};
  }
  if (o.density_law == cfd::DensityLaw::ideal_gas) {
    const Real moisture = gas.moisture ? gas.moisture->initial_vapour_mass_fraction : 0;
    o.density = cfd::ideal_gas_density(o.reference_pressure, initial, moisture);
  }
  if (o.viscosity_law == cfd::ViscosityLaw::sutherland) o.viscosity = cfd::sutherland_viscosity(initial);
}

CarriedKeys take_carried_apart(const std::array<cfd::ScalarBoundary, cfd::scalar_count>& scalars) {
  CarriedKeys carried;
  const auto& temperature = scalars[index_of(cfd::Scalar::temperature)];
  if (const auto* given = std::get_if<cfd::GivenValue>(&temperature)) carried.temperature = given->value;
  if (const auto* outside = std::get_if<cfd::Surroundings>(&temperature)) carried.outside = *outside;
  const auto& moisture = scalars[index_of(cfd::Scalar::moisture)];
  if (const auto* given = std::get_if<cfd::GivenValue>(&moisture))
    carried.vapour_mass_fraction = given->value;
  return carried;
}

std::array<cfd::ScalarBoundary, cfd::scalar_count> put_carried_together(const CarriedKeys& carried) {
  std::array<cfd::ScalarBoundary, cfd::scalar_count> scalars{};
  auto& temperature = scalars[index_of(cfd::Scalar::temperature)];
  if (carried.temperature) temperature = cfd::GivenValue{*carried.temperature};
  if (carried.outside) temperature = *carried.outside;
  if (carried.vapour_mass_fraction) {
    scalars[index_of(cfd::Scalar::moisture)] = cfd::GivenValue{*carried.vapour_mass_fraction};
  }
  return scalars;
}

void describe_incoming_gas(Keys& keys, const GasSpec& gas, bool required, CarriedKeys& carried) {
  keys.real({"temperature",
             required ? "of the gas that comes in; required with gas.heat" : "of gas that comes back in",
             Need::has_default, required ? std::string_view{} : "that of the gas inside"},
            {dimension::temperature, range::positive}, carried.temperature);
  describe_humidity(keys, "vapour_mass_fraction", "relative_humidity", carried.temperature,
                    gas.options.reference_pressure, carried.vapour_mass_fraction);
  if (!keys.reading()) return;
  needs(keys, "temperature", "gas.heat", gas.heat.has_value());
  needs(keys, "vapour_mass_fraction", "gas.moisture", gas.moisture.has_value());
  needs(keys, "relative_humidity", "gas.moisture", gas.moisture.has_value());
  if (!required) return;
  if (gas.heat && !carried.temperature) {
    keys.problem("temperature", "missing; " + core::allowed_reals({dimension::temperature, range::positive}));
  }
  if (gas.moisture && !carried.vapour_mass_fraction && !keys.given("relative_humidity")) {
    keys.problem("vapour_mass_fraction", "missing; vapour_mass_fraction or relative_humidity");
  }
}

void describe_wall_heat(Keys& keys, const GasSpec& gas, CarriedKeys& carried) {
  keys.real({"temperature", "of its surface", Need::has_default, "no heat goes through the wall"},
            {dimension::temperature, range::positive}, carried.temperature);
  keys.section<cfd::Surroundings>(
      {"heat_transfer", "through the wall to surroundings, in place of temperature"}, carried.outside,
      [](Keys& inner, cfd::Surroundings& outside) {
        inner.real({"coefficient",
                    "heat per area and difference between the surroundings and the surface on the "
                    "side of the gas",
                    Need::required},
                   {dimension::heat_transfer, range::non_negative}, outside.coefficient);
        inner.real({"temperature", "of the surroundings", Need::required},
                   {dimension::temperature, range::positive}, outside.value);
      });
  if (!keys.reading()) return;
  needs(keys, "temperature", "gas.heat", gas.heat.has_value());
  needs(keys, "heat_transfer", "gas.heat", gas.heat.has_value());
  if (carried.temperature && carried.outside) {
    keys.problem("heat_transfer", "the wall has a given temperature as well; one of the two");
  }
}

}  // namespace pellicle::tools
