// What the droplets of a parcel exchange with the gas in flight, heat and vapour, as stateless functions of scalars: the
// laws of particles (heat/evaporation_laws.hpp) for a lone sphere, Ranz & Marshall (1952).
#pragma once

#include <Kokkos_Core.hpp>

#include "core/types.hpp"
#include "heat/evaporation_laws.hpp"
#include "heat/saturation_laws.hpp"
#include "heat/transfer_laws.hpp"

namespace pellicle::spray {

/// What all droplets share; `on` false: they take the gas's temperature, and nothing evaporates.
struct DropletHeat {
  bool on = false;
  heat::WaterEnthalpy water{};
  Real solids_capacity = 0;  ///< [J/kg/K]
  Real dry_capacity = 0;     ///< of dry gas [J/kg/K]
  Real conductivity = 0;     ///< of the gas [W/m/K]
  Real diffusivity = 0;      ///< of vapour in it [m2/s]
  Real pressure = 0;         ///< [Pa]
  int saturation = 0;        ///< a position in the list of heat::SaturationLaw
  bool stefan_flow = false;

  /// Of so much liquid and solids [kg]: [J/K].
  KOKKOS_INLINE_FUNCTION Real capacity(Real liquid, Real solids) const {
    return liquid * water.liquid_capacity + solids * solids_capacity;
  }
};

/// A parcel of equal droplets.
struct DropletLoad {
  Real liquid, solids;  ///< of all droplets together [kg]
  Real warmth;          ///< temperature over the reference [K]
  Real diameter;        ///< [m]
  Real droplets;
};

/// The gas around them.
struct DropletSurroundings {
  Real density, viscosity;  ///< [kg/m3], [Pa s]
  Real warmth;              ///< temperature over the reference [K]
  Real vapour;              ///< mass fraction
};

struct DropletExchange {
  Real evaporated = 0;  ///< [kg]; negative: condensed
  Real heat = 0;        ///< from the gas [J]
  Real reach =
      0;  ///< mass of gas that would come to the droplets' state if it were all that they exchange with [kg]
};

/// What a parcel exchanges within `time` [s] at a slip [m/s]. Never more than the liquid there is; where there is none, heat
/// alone: dust does not get wet again.
KOKKOS_INLINE_FUNCTION DropletExchange exchange_of(const DropletHeat& law, const DropletLoad& load,
                                                   const DropletSurroundings& gas, Real slip, Real time) {
  constexpr Real pi = 3.14159265358979323846;
  const heat::WaterEnthalpy& water = law.water;
  const Real gas_capacity = law.dry_capacity * (1 - gas.vapour) + water.vapour_capacity * gas.vapour;
  const Real size = load.droplets * pi * load.diameter;
  // Nu = still + stirred Pr^(1/3), Sh likewise with Sc.
  const heat::TransferLine line =
      heat::RanzMarshall{}(Real(1), gas.density * slip * load.diameter / gas.viscosity);
  const auto number = [&](Real ratio) { return line.still + line.stirred * Kokkos::cbrt(ratio); };
  heat::Conductances k{number(gas.viscosity * gas_capacity / law.conductivity) * law.conductivity * size, 0};
  heat::ParticleHeat held{load.warmth, law.capacity(load.liquid, load.solids)};
  DropletExchange found;
  found.reach = time * k.heat / gas_capacity;
  if (!(load.liquid > 0)) {
    found.heat = time * heat::limited_response(held, k.heat, 0, 0, time).heat(gas.warmth, gas.vapour);
    return found;
  }
  const auto saturation = [&](Real temperature) {
    return heat::saturated_fraction_by(law.saturation, temperature, law.pressure);
  };
  const Real temperature = water.reference + load.warmth;
  const Real latent = water.evaporation(temperature);
  const heat::ValueAndSlope start = saturation(temperature);
  const Real surface = start.value;
  k.vapour = number(gas.viscosity / (gas.density * law.diffusivity)) * gas.density * law.diffusivity * size;
  if (law.stefan_flow) k.vapour *= heat::stefan_factor(surface, gas.vapour);
  found.reach = Kokkos::fmax(found.reach, time * k.vapour);
  // With the heat capacity at the end, about: what evaporates takes its own along.
  const Real soon = Kokkos::fmin(time * k.vapour * (surface - gas.vapour), 0.9 * load.liquid);
  held.capacity -= water.liquid_capacity * Kokkos::fmax(soon, Real(0));
  const heat::ValueAndSlope chord =
      heat::find_chord(saturation, start, held, k, water, gas.warmth, gas.vapour, time);
  const heat::ParticleResponse r = heat::wet_response(held, k, chord, latent, time);
  found.evaporated = time * r.evaporation(gas.warmth, gas.vapour);
  found.heat = time * r.heat(gas.warmth, gas.vapour);
  if (found.evaporated <= load.liquid) return found;
  held.capacity = law.capacity(0, load.solids);
  found.evaporated = load.liquid;
  // Droplets of liquid alone leave nothing that could be warmer: the gas gives what evaporation takes.
  found.heat = held.capacity > 0
                   ? time * heat::limited_response(held, k.heat, load.liquid / time, latent, time)
                                .heat(gas.warmth, gas.vapour)
                   : load.liquid * latent;
  return found;
}

}  // namespace pellicle::spray
