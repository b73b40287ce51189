#include "tools/pellicle/build_spray.hpp"

#include "tools/pellicle/build_heat.hpp"

namespace pellicle::tools {
namespace {

spray::CaptureEfficiency make_efficiency(const CaptureSpec& spec) {
  spray::CaptureEfficiency made;
  made.points = static_cast<int>(spec.weber.size());
  made.surface_tension = spec.surface_tension;
  for (std::size_t i = 0; i < spec.weber.size(); ++i) {
    made.weber[i] = spec.weber[i];
    made.share[i] = spec.efficiency[i];
  }
  return made;
}

spray::Nozzle make_nozzle(const NozzleSpec& spec) {
  spray::Nozzle made;
  made.name = spec.name;
  made.position = spec.position;
  made.axis = spec.axis;
  made.cone_angle = spec.cone_angle;
  made.pattern = spec.pattern;
  made.inner_cone_angle = spec.inner_cone_angle.value_or(0);
  made.radius = spec.nozzle_radius;
  made.speed = spec.speed;
  made.mass_rate = spec.mass_rate;
  made.solids_fraction = spec.solids_fraction;
  made.density = spec.density;
  made.temperature = spec.temperature;
  if (spec.sizes) {
    made.diameter = *spec.sizes->distribution();
  } else {
    made.diameter = spec.droplet_diameter;
  }
  made.droplets_per_parcel = spec.droplets_per_parcel;
  made.from = spec.from;
  made.to = spec.to;
  if (spec.capture) made.efficiency = make_efficiency(*spec.capture);
  return made;
}

spray::DropletHeat make_droplet_heat(const CaseSpec& spec) {
  spray::DropletHeat heat;
  if (!spec.droplets.evaporation) return heat;
  const heat::HeatOptions options = make_heat_options(spec);
  heat.on = true;
  heat.water = options.water;
  heat.solids_capacity = spec.coating.solids_heat_capacity;
  heat.dry_capacity = options.gas.capacity;
  heat.conductivity = options.gas.conductivity;
  heat.diffusivity = options.gas.diffusivity;
  heat.pressure = options.gas.pressure;
  heat.saturation = static_cast<int>(options.saturation.index());
  heat.stefan_flow = options.stefan_flow;
  return heat;
}

}  // namespace

spray::SprayOptions make_spray_options(const CaseSpec& spec) {
  spray::SprayOptions options;
  for (const NozzleSpec& nozzle : spec.spray) options.nozzles.push_back(make_nozzle(nozzle));
  options.gravity = spec.gravity;
  options.parcel_step = spec.time.parcel_step.value_or(0);
  options.seed = spec.seed;
  options.watch_momentum = options.push_particles = spec.droplets.two_way;
  options.heat = make_droplet_heat(spec);
  options.solids_density = spec.coating.solids_density;
  return options;
}

spray::DropletGas make_droplet_gas(const CaseSpec& spec, const coupling::MomentumExchange& exchange,
                                   const HostArray<Real>& open_volume, const spray::WholeUnits& units) {
  const cfd::GasOptions& gas = spec.gas->options;
  spray::DropletGasOptions options;
  options.two_way = spec.droplets.two_way;
  options.heat = make_droplet_heat(spec);
  options.density_varies = gas.density_law != cfd::DensityLaw::constant;
  options.viscosity_follows = gas.viscosity_law == cfd::ViscosityLaw::sutherland;
  spray::ParcelGas around;
  around.drag = {gas.density, gas.viscosity};
  around.grid = exchange.gas_locator();
  around.cut = exchange.cut_grid();
  return {options, around, open_volume, units, spec.gravity};
}

}  // namespace pellicle::tools
