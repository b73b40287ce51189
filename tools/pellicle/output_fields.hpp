// What can be written to the results folder: the names that the case file takes, one list for each kind of output.
// Every description ends with the unit in square brackets, which is also what column headers show.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/model_list.hpp"

namespace pellicle::tools {

/// Fields of a particle snapshot (particles.h5); the position is always written.
inline constexpr std::array<core::ModelInfo, 14> particle_snapshot_fields{{
    {"id", "number of the particle, the same through the run [-]"},
    {"velocity", "velocity of the centre, three components [m/s]"},
    {"spin", "angular velocity, three components [rad/s]"},
    {"radius", "radius [m]"},
    {"diameter", "diameter [m]"},
    {"mass", "mass, also of a fixed particle [kg]"},
    {"material", "number of the material, in the order of the case file [-]"},
    {"speed", "magnitude of the velocity [m/s]"},
    {"acceleration", "acceleration in the last substep, three components [m/s2]"},
    {"temperature", "temperature; needs heat [K]"},
    {"film_liquid", "liquid in the film; needs heat or spray [kg]"},
    {"film_solids", "solids in the film: the coating; needs heat or spray [kg]"},
    {"coating_thickness", "thickness of the dry coating; needs heat or spray [m]"},
    {"hits", "spray parcels captured; needs spray [-]"},
}};

/// Fields of a snapshot of the spray (spray.h5), a row a parcel in flight; the position is always written.
inline constexpr std::array<core::ModelInfo, 9> spray_snapshot_fields{{
    {"id", "number of the parcel among those of its nozzle, the same through the run [-]"},
    {"nozzle", "number of the nozzle, in the order of the case file [-]"},
    {"velocity", "velocity of the droplets, three components [m/s]"},
    {"speed", "magnitude of the velocity [m/s]"},
    {"diameter", "diameter of each droplet [m]"},
    {"droplets", "droplets that the parcel stands for; no whole number [-]"},
    {"mass", "mass of all droplets of the parcel [kg]"},
    {"liquid", "liquid in them [kg]"},
    {"temperature", "of the droplets; needs droplets.evaporation [K]"},
}};

/// Fields of a gas snapshot (gas.h5), all at cell centres.
inline constexpr std::array<core::ModelInfo, 11> gas_snapshot_fields{{
    {"velocity", "interstitial gas velocity, three components [m/s]"},
    {"pressure", "gas pressure without its hydrostatic part [Pa]"},
    {"void_fraction", "fraction of the cell that is gas [-]"},
    {"solids_fraction", "fraction of the cell that is particles [-]"},
    {"pressure_gradient", "gradient of the pressure, three components [Pa/m]"},
    {"temperature", "gas temperature; needs gas.heat [K]"},
    {"vapour_mass_fraction", "mass of vapour per mass of moist gas; needs gas.moisture [-]"},
    {"density", "gas density [kg/m3]"},
    {"turbulent_kinetic_energy", "k; needs gas.turbulence [m2/s2]"},
    {"turbulent_dissipation", "epsilon, at which k becomes heat; needs gas.turbulence [m2/s3]"},
    {"eddy_viscosity", "dynamic viscosity of the eddies; needs gas.turbulence [Pa s]"},
}};

/// One number of one particle: what lines, histograms and particle probes can show. The position in this list is the
/// code that the device functions take (ParticleQuantity in particle_quantities.hpp).
inline constexpr std::array<core::ModelInfo, 21> particle_quantities{{
    {"particle_velocity_x", "x component of the particle velocity [m/s]"},
    {"particle_velocity_y", "y component of the particle velocity [m/s]"},
    {"particle_velocity_z", "z component of the particle velocity [m/s]"},
    {"particle_speed", "magnitude of the particle velocity [m/s]"},
    {"particle_spin_x", "x component of the particle's angular velocity [rad/s]"},
    {"particle_spin_y", "y component of the particle's angular velocity [rad/s]"},
    {"particle_spin_z", "z component of the particle's angular velocity [rad/s]"},
    {"particle_position_x", "x coordinate of the particle's centre [m]"},
    {"particle_position_y", "y coordinate of the particle's centre [m]"},
    {"particle_position_z", "z coordinate of the particle's centre [m]"},
    {"particle_diameter", "diameter of the particle [m]"},
    {"particle_mass", "mass of the particle [kg]"},
    {"particle_kinetic_energy", "kinetic energy of translation of the particle [J]"},
    {"particle_acceleration_z", "z component of the particle's acceleration in the last substep [m/s2]"},
    {"particle_temperature", "temperature of the particle; needs heat [K]"},
    {"film_liquid", "liquid in the film on the particle; needs heat or spray [kg]"},
    {"film_solids", "solids in the film on the particle: its coating; needs heat or spray [kg]"},
    {"coating_thickness", "thickness of the dry coating; needs heat or spray [m]"},
    {"hits", "spray parcels that the particle has captured; needs spray [-]"},
    {"first_hit_time", "when the particle captured its first parcel, -1 if never; needs spray [s]"},
    {"last_hit_time", "when the particle captured its last parcel, -1 if never; needs spray [s]"},
}};

/// One number of one gas cell: what lines and point probes can show, in the order of GasQuantity.
inline constexpr std::array<core::ModelInfo, 17> gas_quantities{{
    {"gas_velocity_x", "x component of the interstitial gas velocity [m/s]"},
    {"gas_velocity_y", "y component of the interstitial gas velocity [m/s]"},
    {"gas_velocity_z", "z component of the interstitial gas velocity [m/s]"},
    {"gas_speed", "magnitude of the interstitial gas velocity [m/s]"},
    {"superficial_velocity_x", "x component of void fraction times gas velocity [m/s]"},
    {"superficial_velocity_y", "y component of void fraction times gas velocity [m/s]"},
    {"superficial_velocity_z", "z component of void fraction times gas velocity [m/s]"},
    {"pressure", "gas pressure without its hydrostatic part [Pa]"},
    {"void_fraction", "fraction of the volume that is gas [-]"},
    {"solids_fraction", "fraction of the volume that is particles [-]"},
    {"gas_temperature", "temperature of the gas; needs gas.heat [K]"},
    {"vapour_mass_fraction", "mass of vapour per mass of moist gas; needs gas.moisture [-]"},
    {"relative_humidity", "vapour pressure over that of saturation; needs gas.heat and gas.moisture [-]"},
    {"gas_density", "density of the gas [kg/m3]"},
    {"turbulent_kinetic_energy", "turbulent kinetic energy of the gas, k; needs gas.turbulence [m2/s2]"},
    {"turbulent_dissipation", "dissipation of k, epsilon; needs gas.turbulence [m2/s3]"},
    {"eddy_viscosity", "dynamic viscosity of the gas's eddies; needs gas.turbulence [Pa s]"},
}};

/// Columns of a bed probe.
inline constexpr std::array<core::ModelInfo, 11> bed_quantities{{
    {"bed_height",
     "height below which 99 % of the particles' centres lie, above the floor of the domain [m]"},
    {"mean_height", "mean height of the particles' centres, weighted by mass, above the floor [m]"},
    {"mean_speed", "mean speed of the particles [m/s]"},
    {"largest_speed", "speed of the fastest particle [m/s]"},
    {"kinetic_energy", "kinetic energy of translation of all particles [J]"},
    {"pressure_drop", "mean gas pressure of the lowest minus that of the highest layer of cells [Pa]"},
    {"gas_kinetic_energy", "kinetic energy of all gas [J]"},
    {"contacts_per_particle", "twice the touching pairs of particles over the number of particles [-]"},
    {"largest_overlap", "largest overlap since the start, as a fraction of the radius [-]"},
    {"particles", "number of particles in the domain [-]"},
    {"solids_volume", "volume of all particles [m3]"},
}};

/// Columns of a coating probe.
inline constexpr std::array<core::ModelInfo, 9> coating_quantities{{
    {"coating_mass", "solids in the films of all particles [kg]"},
    {"coating_mass_mean", "the same over the number of particles [kg]"},
    {"coating_mass_cov", "standard deviation of a particle's coating over its mean [-]"},
    {"coated_share", "share of the particles with any coating [-]"},
    {"coating_thickness_mean", "mean thickness of the dry coating, uncoated particles included [m]"},
    {"coating_thickness_cov", "standard deviation of the thickness over its mean [-]"},
    {"film_liquid_mass", "liquid in the films of all particles [kg]"},
    {"wet_share", "share of the particles with liquid on them [-]"},
    {"particle_temperature_mean", "mean temperature of the particles; 0 without heat [K]"},
}};

/// Columns of a wall probe: what particles and gas do to the wall, averaged since the row before.
inline constexpr std::array<core::ModelInfo, 12> wall_quantities{{
    {"wall_force_x", "x component of the force of the particles on the wall [N]"},
    {"wall_force_y", "y component of the force of the particles on the wall [N]"},
    {"wall_force_z", "z component of the force of the particles on the wall [N]"},
    {"wall_torque_x", "x component of the torque of the particles on the wall [N m]"},
    {"wall_torque_y", "y component of the torque of the particles on the wall [N m]"},
    {"wall_torque_z", "z component of the torque of the particles on the wall [N m]"},
    {"wall_contacts", "contacts of particles with the wall at the moment of the row [-]"},
    {"gas_force_x", "x component of the force of the gas on the wall, pressure and shear [N]"},
    {"gas_force_y", "y component of the force of the gas on the wall [N]"},
    {"gas_force_z", "z component of the force of the gas on the wall [N]"},
    {"wall_heat_rate", "heat that particles conduct to the wall [W]"},
    {"wall_heat", "the same since t = 0 [J]"},
}};

/// Columns of a probe of a side through which particles leave.
inline constexpr std::array<core::ModelInfo, 4> side_quantities{{
    {"outflow_mass_rate", "mass of the particles that left a second, since the row before [kg/s]"},
    {"outflow_rate", "particles that left a second, since the row before [1/s]"},
    {"left_mass", "mass of all that have left, settling included [kg]"},
    {"left_particles", "number of all that have left, settling included [-]"},
}};

/// Columns of a plane probe besides gas_quantities, which are then means over the plane.
inline constexpr std::array<core::ModelInfo, 3> plane_quantities{{
    {"volume_flow", "gas that passes the plane along its axis [m3/s]"},
    {"mass_flow", "mass of the gas that passes the plane along its axis [kg/s]"},
    {"open_area", "area of the plane's part that is in the domain and not behind a wall [m2]"},
}};

/// What the wetness of a contact is that of, in the order of spray::WetnessMeasure.
inline constexpr std::array<core::ModelInfo, 2> wetness_measures{{
    {"liquid_per_surface",
     "liquid over the surface of the bare particle, the thickness of the wet film (1 kg/m2 of water: 1 mm) "
     "[kg/m2]"},
    {"liquid_fraction", "liquid over liquid and solids of the film [-]"},
}};

/// All quantities a line may show: particle_quantities, then gas_quantities.
std::string line_quantity_names();

/// Whether a quantity of the gas is there only with a model of turbulence.
bool is_turbulent_quantity(std::string_view name);

/// The unit at the end of a description, without brackets: "m/s".
std::string_view unit_of(const core::ModelInfo& info);

/// "particle_speed [m/s]", the header of a column; the bare name if the quantity is unknown.
std::string column_header(std::string_view quantity);

}  // namespace pellicle::tools
