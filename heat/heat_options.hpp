// What the exchange of heat and vapour between gas and particles is made of.
#pragma once

#include "core/types.hpp"
#include "heat/evaporation_laws.hpp"
#include "heat/saturation_laws.hpp"
#include "heat/transfer_laws.hpp"

namespace pellicle::heat {

/// The gas, as far as its temperature and moisture do not say it.
struct GasHeatProperties {
  Real capacity = 1007;        ///< of dry gas at constant pressure [J/kg/K]
  Real conductivity = 0.0263;  ///< [W/m/K]
  Real diffusivity = 2.6e-5;   ///< of vapour in it [m2/s]
  Real viscosity = 1.8e-5;     ///< [Pa s]
  bool sutherland = false;     ///< the viscosity is that of air at the gas's temperature instead
  Real pressure = 101325;      ///< [Pa]
};

struct HeatOptions {
  TransferLaw nusselt, sherwood;
  SaturationLaw saturation;
  bool evaporation = true;   ///< and condensation; needs moisture
  bool stefan_flow = false;  ///< vapour that evaporates carries more along
  bool one_way = false;      ///< the gas gives without losing, and never hears of the particles
  WaterEnthalpy water{298.15, 2.4417e6, 1872, 4181};
  GasHeatProperties gas;
};

}  // namespace pellicle::heat
