// Case files that between them give every key a value other than its default.
#pragma once

namespace pellicle::tests {

inline constexpr const char* spouted_bed_case = R"(title: "a bed, with everything"
seed: 42
domain: {min: [0, 0, 0], max: ["40 mm", "10 mm", "100 mm"], periodic: [y]}
gravity: [0.1, 0, -9.8]
time: {end: "2 s", gas_step: "0.1 ms", particle_step: "5 us", impact_speed: "3 m/s", settle: "0.1 s",
       allow_large_step: true, courant: 0.8}
materials:
  glass: {density: "2.5 g/cm3", youngs_modulus: "10 MPa", poisson_ratio: 0.22}
  steel: {density: 7800, youngs_modulus: 2e9, poisson_ratio: 0.3, true_youngs_modulus: "2e11 Pa"}
walls:
  - {name: sides, box: domain, open: [top, right], material: acrylic, velocity: [0, 0.5, 0]}
  - {name: floor, plane: {point: [0, 0, "1 mm"], normal: [0, 0, 2]}, material: steel, velocity: [0.1, 0, 0]}
contacts:
  model: {normal: hertz, tangential: viscous_coulomb, rolling: none, clip: false}
  overlap_limit: 0.3
  pairs:
    - {between: [glass, glass], restitution: 0.97, sliding_friction: 0.3, rolling_friction: 0.01}
    - {between: [acrylic, glass], restitution: 0.9, sliding_friction: 0.2}
    - {between: [glass, steel], restitution: 0.8, sliding_friction: 0.1}
particles:
  - {material: glass, count: 100, diameter: "2 mm", velocity: [0, 0, -0.1], spin: [1, 2, 3],
     fill: {box: {min: [0, 0, "10 mm"], max: ["40 mm", "10 mm", "60 mm"]}, pattern: lattice}}
  - {material: glass, total_mass: "1 g", diameter: "1.5 mm",
     fill: {cylinder: {from: ["20 mm", "5 mm", "60 mm"], to: ["20 mm", "5 mm", "95 mm"], radius: "5 mm"}}}
  - {material: glass, diameter: "1 mm", fill: {box: {min: [0, 0, "61 mm"], max: ["10 mm", "10 mm", "70 mm"]},
                                              solids_fraction: "10 %"}}
  - material: glass
    fixed: true
    list:
      - {position: ["20 mm", "5 mm", "97 mm"], velocity: [0, 0, 1], spin: [0, 1, 0], diameter: "2 mm", fixed: false}
      - {position: ["25 mm", "5 mm", "97 mm"], diameter: "3 mm"}
gas:
  density: 1.2
  viscosity: "18 uPa s"
  velocity: [0, 0, 0.5]
  body_force: [0, 0, "5 Pa/m"]
  grid: {cells: [8, 2, 20], growth: [1, 1, 1.05]}
  convection: upwind
  boundaries:
    - {name: jet, on: bottom, region: {box: {min: ["15 mm", 0, 0], max: ["25 mm", "10 mm", 0]}}, inlet: {velocity: "10 m/s"}}
    - {name: plate, on: bottom, inlet: {flow_rate: "1 m3/h"}}
    - {name: belt, on: left, wall: {velocity: [0, 0, 1]}}
    - {name: mirror, on: right, region: {box: {min: ["40 mm", 0, 0], max: ["40 mm", "10 mm", "50 mm"]}}, symmetry: {}}
    - {name: slip, on: right, free_slip: {}}
    - {name: top, on: top, outlet: {pressure: "1 kPa"}}
  solver: {pressure_tolerance: 1e-9, loose_pressure_tolerance: 1e-2, momentum_tolerance: 1e-8, outer_tolerance: 1e-5,
           max_outer_iterations: 4, max_linear_iterations: 100, velocity_relaxation: 0.9, pressure_solver: amgcl,
           require_convergence: true}
coupling: {drag: koch_hill, deposition: centroid, transfer_grid: {cell_size: "5 mm"}, exchange: explicit,
           pressure_gradient_force: false, coefficients: substep, minimum_void_fraction: 0.4, pending_release: 0.2,
           smoothing_length: "6 mm"}
output:
  checkpoint: {every: "0.1 s"}
  snapshots: {every: "0.05 s", particles: [velocity, speed], gas: [pressure]}
  average: {from: "0.2 s", to: "1.8 s", gas: [velocity, solids_fraction]}
  lines:
    - {name: low, from: [0, "5 mm", "20 mm"], to: ["40 mm", "5 mm", "20 mm"], points: 8, depth_average: y,
       thickness: "4 mm", quantity: particle_velocity_z, average: {from: "0.5 s", to: "1.5 s"}}
    - {name: high, from: [0, "5 mm", "50 mm"], to: ["40 mm", "5 mm", "50 mm"], points: 10, quantity: gas_speed}
  probes:
    - {name: centre, point: ["20 mm", "5 mm", "30 mm"], quantities: [pressure, void_fraction], every: "2 ms",
       average: {from: "0.25 s", to: "1 s"}}
    - {name: bead, particle: 7, average: {}}
    - {name: whole, bed: {}}
    - {name: out, side: top, quantities: [left_mass, outflow_rate]}
    - {name: throat, plane: {axis: z, at: "40 mm", box: {min: ["10 mm", 0, 0], max: ["30 mm", "10 mm", 0]}, mean: flow}}
    - {name: round, plane: {axis: x, at: "20 mm", disc: {centre: [0, "5 mm", "50 mm"], radius: "4 mm"}},
       quantities: [mass_flow, pressure]}
  histograms:
    - {name: speeds, quantity: particle_speed, bins: 20, min: 0, max: 2, weight: mass, every: "0.5 s"}
    - {name: rising, quantity: particle_velocity_z, against: particle_diameter, against_bins: 5,
       against_min: 0.001, against_max: 0.002}
  zones:
    - {name: middle, box: {min: [0, 0, "20 mm"], max: ["40 mm", "10 mm", "40 mm"]}, every: "0.1 s",
       shortest_absence: "10 ms", longest_time: "1 s", bins: 25, size_classes: 3}
    - {name: core, cylinder: {from: ["20 mm", "5 mm", 0], to: ["20 mm", "5 mm", "60 mm"], radius: "4 mm"}}
)";

/// The same domain with cells given by their faces; gas alone.
inline constexpr const char* channel_case = R"(domain: {min: [0, 0, 0], max: [1, 1, 1], periodic: [x]}
time: {end: 1, gas_step: 0.01}
gas:
  density: 1
  viscosity: 0.01
  grid:
    faces: {x: [0, 0.5, 1], y: [0, 0.1, 0.4, 1], z: [0, 1]}
)";

/// Gas that is warm and moist, of a density and viscosity that follow.
inline constexpr const char* humid_case = R"(domain: {min: [0, 0, 0], max: [1, 1, 1], periodic: [x]}
time: {end: 1, gas_step: 0.01}
gas:
  density: {law: ideal_gas}
  viscosity: {law: sutherland}
  reference_pressure: "1 bar"
  heat: {initial_temperature: "20 degC", capacity: "1 kJ/kg/K", vapour_capacity: 1900, conductivity: "30 mW/m/K",
         reference_temperature: "0 degC"}
  moisture: {initial_relative_humidity: 0.5, diffusivity: "30 mm2/s"}
  grid: {cells: [2, 3, 4]}
  boundaries:
    - {name: below, on: bottom, inlet: {velocity: 1, temperature: "80 degC", relative_humidity: "10 %"}}
    - {name: above, on: top, outlet: {pressure: 0, temperature: "25 degC", vapour_mass_fraction: 0.01}}
    - {name: hot, on: front, wall: {temperature: "100 degC"}}
    - {name: jacket, on: back, wall: {heat_transfer: {coefficient: "5 W/m2/K", temperature: "15 degC"}}}
)";

/// A wet particle that dries.
inline constexpr const char* drying_case = R"(domain: {min: [0, 0, 0], max: [1, 1, 1]}
time: {end: 1, gas_step: 0.01, particle_step: 1e-5}
materials: {bead: {density: 1500, youngs_modulus: 1e6, poisson_ratio: 0.3, heat_capacity: "0.9 kJ/kg/K",
                   conductivity: "0.8 W/m/K", true_youngs_modulus: "60 GPa"}}
walls: [{name: plate, disc: {centre: [0.5, 0.5, 0.1], normal: [0, 0, 1], radius: 0.1}, material: bead, temperature: "60 degC"}]
contacts: {pairs: [{between: [bead, bead], restitution: 0.9, sliding_friction: 0.3}]}
particles:
  - {material: bead, diameter: "10 mm", initial_temperature: "40 degC", initial_liquid: 0.05, initial_solids: "1 %",
     list: [{position: [0.5, 0.5, 0.5]}]}
gas:
  density: 1.2
  viscosity: 1.8e-5
  heat: {initial_temperature: 300}
  moisture: {initial_vapour_mass_fraction: 0.01}
  grid: {cells: [2, 3, 4]}
  boundaries: [{name: out, on: top, outlet: {}}]
heat: {nusselt: ranz_marshall, sherwood: ranz_marshall, evaporation: true, saturation: clausius_clapeyron, stefan_flow: true,
       contact_conduction: true,
       latent_heat: "2501 kJ/kg", latent_heat_temperature: "0 degC", initial_temperature: "30 degC"}
coating: {growth: mass, liquid_heat_capacity: "4.2 kJ/kg/K", solids_density: "1.3 g/cm3", solids_heat_capacity: 1400}
)";

/// Warm gas of constant density that rises, dry.
inline constexpr const char* rising_case = R"(domain: {min: [0, 0, 0], max: [1, 1, 1]}
time: {end: 1, gas_step: 0.01}
gas:
  density: 1.2
  viscosity: 1.8e-5
  heat: {initial_temperature: 300, buoyancy: {temperature: 310, expansion: "3e-3 1/K"}}
  moisture: {initial_vapour_mass_fraction: 0.02}
  grid: {cells: [2, 3, 4]}
  boundaries:
    - {name: damp, on: left, inlet: {velocity: 0.1, temperature: 320, vapour_mass_fraction: 0.03}}
    - {name: out, on: right, outlet: {temperature: 300, relative_humidity: 0.5}}
)";

/// Turbulent gas.
inline constexpr const char* turbulent_case = R"(domain: {min: [0, 0, 0], max: [1, 1, 1]}
time: {end: 1, gas_step: 0.01}
gas:
  density: 1.2
  viscosity: 1.8e-5
  turbulence: k_epsilon
  k_epsilon: {initial_k: "0.5 m2/s2", initial_epsilon: "10 m2/s3", prandtl_number: 0.85, schmidt_number: 0.8,
              largest_viscosity_ratio: 1e4}
  grid: {cells: [2, 3, 4]}
  boundaries:
    - {name: in, on: left, inlet: {velocity: 10, turbulence: {intensity: "10 %", length_scale: "1 cm"}}}
    - {name: out, on: right, outlet: {}}
)";

/// A plane flow: cells from sizes and zones.
inline constexpr const char* refined_case =
    R"(domain: {min: [0, 0, 0], max: ["100 mm", "5 mm", "200 mm"], periodic: [z]}
time: {end: 0.01, gas_step: 0.001}
gas:
  density: 1.2
  viscosity: 1.8e-5
  grid:
    cell_size: "6 mm"
    max_growth: 1.2
    zones:
      - {box: {min: ["40 mm", 0, 0], max: ["60 mm", "5 mm", "50 mm"]}, cell_size: "2 mm"}
      - {box: {min: ["48 mm", 0, 0], max: ["52 mm", "5 mm", "200 mm"]}, cell_size: "1 mm"}
    single_cell: [y]
  boundaries:
    - {name: front, on: front, symmetry: {}}
    - {name: back, on: back, symmetry: {}}
)";

/// Gas in a cone with a thin tube in it, and a sieve that it passes.
inline constexpr const char* chamber_case =
    R"(domain: {min: ["-60 mm", "-60 mm", 0], max: ["60 mm", "60 mm", "150 mm"]}
time: {end: 0.01, gas_step: 0.001}
walls:
  - {name: cone, cone: {from: [0, 0, 0], to: [0, 0, "160 mm"], from_radius: "30 mm", to_radius: "50 mm"}, material: steel}
  - {name: tube, cylinder: {from: [0, 0, "30 mm"], to: [0, 0, "90 mm"], radius: "15 mm"}, material: steel, gas: free_slip}
  - {name: sieve, disc: {centre: [0, 0, "10 mm"], normal: [0, 0, 1], radius: "35 mm"}, material: steel, gas: open}
gas:
  density: 1.2
  viscosity: 1.8e-5
  inside: [0, 0, "50 mm"]
  grid: {cells: [12, 12, 15]}
  boundaries:
    - {name: jet, on: bottom, region: {disc: {centre: [0, 0, 0], radius: "5 mm"}}, inlet: {flow_rate: "3.5 m3/h", share: 0.5}}
    - {name: plate, on: bottom, region: {disc: {centre: [0, 0, 0], radius: "30 mm", inner_radius: "5 mm"}}, inlet: {velocity: 1}}
    - {name: top, on: top, outlet: {}}
)";

/// A block that blows, and a vent by mass.
inline constexpr const char* blower_case =
    R"(domain: {min: ["-60 mm", "-60 mm", 0], max: ["60 mm", "60 mm", "150 mm"]}
time: {end: 0.01, gas_step: 0.001}
walls:
  - {name: plug, block: {min: ["-22 mm", "-18 mm", "31 mm"], max: ["17 mm", "13 mm", "58 mm"]}, material: steel}
gas:
  density: 1.2
  viscosity: 1.8e-5
  inside: [0, 0, "100 mm"]
  grid: {cells: [12, 12, 15]}
  boundaries:
    - {name: blow, on_wall: plug, inlet: {mass_flow: "1 g/s", share: 0.5}}
    - {name: top, on: top, outlet: {}}
)";

/// Particles of every way to be spread in size.
inline constexpr const char* powders_case = R"(domain: {min: [0, 0, 0], max: ["40 mm", "40 mm", "100 mm"]}
time: {end: 0.1, particle_step: 1e-6, settle: {until: quiet, at_most: "0.5 s", speed: "2 mm/s"}}
materials: {glass: {density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.22}}
contacts:
  model: {normal: linear, tangential: mindlin, rolling: epsd2}
  linear: {largest_overlap: 0.05, speed: "50 cm/s"}
  cohesion: {model: willett, bridge_volume: "1e-3 uL", surface_tension: "72 mN/m", contact_angle: "20 deg"}
  pairs: [{between: [glass, glass], restitution: 0.9, sliding_friction: 0.3, normal_stiffness: "0.5 kN/m"}]
particles:
  - {material: glass, total_mass: "2 g", diameter: {uniform: {min: "1 mm", max: "2 mm"}},
     fill: {box: {min: [0, 0, 0], max: ["40 mm", "40 mm", "20 mm"]}}}
  - {material: glass, count: 300, diameter: {normal: {mean: "1.5 mm", sd: "0.3 mm", min: "1 mm", max: "2 mm"}},
     fill: {box: {min: [0, 0, "20 mm"], max: ["40 mm", "40 mm", "40 mm"]}}}
  - {material: glass, diameter: {log_normal: {median: "1.5 mm", geometric_sd: 1.3, by: mass, min: "0.8 mm", max: "3 mm"}},
     fill: {box: {min: [0, 0, "40 mm"], max: ["40 mm", "40 mm", "60 mm"]}, solids_fraction: 0.1}}
  - {material: glass, count: 200, diameter: {rosin_rammler: {size: "2 mm", spread: 2, min: "1 mm", max: "4 mm"}},
     fill: {cone: {from: ["20 mm", "20 mm", "60 mm"], to: ["20 mm", "20 mm", "80 mm"], from_radius: "10 mm",
                   to_radius: "20 mm"}}}
  - {material: glass, count: 100, diameter: {table: {diameters: ["1 mm", "2 mm"], shares: [3, 1], by: mass}},
     fill: {annulus: {from: ["20 mm", "20 mm", "80 mm"], to: ["20 mm", "20 mm", "90 mm"], inner_radius: "8 mm",
                      outer_radius: "20 mm"}, pattern: hexagonal}}
  - {material: glass, count: 100, diameter: {table: {diameters: ["1 mm", "2 mm", "3 mm"], finer: [0, 0.2, 1]}},
     fill: {box: {min: [0, 0, "90 mm"], max: ["40 mm", "40 mm", "100 mm"]}}}
  - {material: glass, diameter: {uniform: {min: "1 mm", max: "2 mm"}}, velocity: [0, 0, -1],
     feed: {disc: {centre: ["20 mm", "20 mm", "100 mm"], normal: [0, 0, 2], radius: "10 mm"}, mass_rate: "20 g/s",
            from: "10 ms", to: "50 ms"}}
  - {material: glass, diameter: "2 mm", feed: {box: {min: [0, 0, "100 mm"], max: ["40 mm", "40 mm", "100 mm"]},
                                              rate: "1000 1/s"}}
)";

/// Walls of every shape and motion.
inline constexpr const char* vessel_case = R"(domain: {min: [0, 0, 0], max: ["40 mm", "40 mm", "100 mm"]}
time: {end: 0.1, particle_step: 1e-6}
materials: {glass: {density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.22}}
contacts: {pairs: [{between: [glass, glass], restitution: 0.9, sliding_friction: 0.3},
                   {between: [glass, steel], restitution: 0.9, sliding_friction: 0.3}]}
particles:
  - {material: glass, count: 50, diameter: "2 mm", fill: {box: {min: ["10 mm", "10 mm", "40 mm"], max: ["30 mm", "30 mm", "60 mm"]}}}
walls:
  - {name: plate, material: steel, disc: {centre: ["20 mm", "20 mm", "2 mm"], normal: [0, 0, 2], radius: "18 mm", inner_radius: "1 mm"},
     spin: {rate: "60 rpm", axis: [0, 0, -3], through: ["20 mm", "20 mm", 0]}}
  - {name: tube, material: steel, cylinder: {from: ["20 mm", "20 mm", "20 mm"], to: ["20 mm", "20 mm", "80 mm"], radius: "18 mm"},
     torque_about: [0, 0, 1]}
  - {name: funnel, material: steel, cone: {from: ["20 mm", "20 mm", "10 mm"], to: ["20 mm", "20 mm", "20 mm"], from_radius: "5 mm",
                                           to_radius: "18 mm"}}
  - {name: step, material: steel, block: {min: ["25 mm", "10 mm", 0], max: ["30 mm", "15 mm", "5 mm"]},
     vibration: {amplitude: [0, 0, "1 mm"], frequency: "50 Hz", phase: "90 deg"}}
  - {name: insert, material: steel, stl: insert.stl, unit: mm}
output: {probes: [{name: load, wall: tube, quantities: [wall_force_z, wall_torque_y], every: "1 ms"}]}
)";

/// Two nozzles with everything that nozzles have; no gas.
inline constexpr const char* sprayed_case = R"(domain: {min: [0, 0, 0], max: ["40 mm", "40 mm", "100 mm"]}
time: {end: 0.1, particle_step: 1e-6, parcel_step: "2e-6 s"}
materials: {glass: {density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.22}}
contacts: {pairs: [{between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}]}
particles:
  - {material: glass, count: 50, diameter: "2 mm", fill: {box: {min: ["10 mm", "10 mm", "40 mm"], max: ["30 mm", "30 mm", "60 mm"]}}}
coating: {solids_density: 1300}
spray:
  - {name: gun, position: ["20 mm", "20 mm", "10 mm"], axis: [0, 3, 4], cone_angle: "30 deg", nozzle_radius: "0.5 mm",
     speed: "20 m/s", mass_rate: "5 g/min", solids_fraction: "20 %", droplet_diameter: "30 um", droplets_per_parcel: 10,
     density: 1050, temperature: "25 degC", from: "10 ms", to: "50 ms",
     capture: {weber: [10, 100], efficiency: [1, 0.2], surface_tension: "60 mN/m"}}
  - {name: ring, position: [0, 0, "90 mm"], axis: [0, 0, -1], cone_angle: "60 deg", pattern: hollow, speed: "10 m/s",
     mass_rate: "1 g/min", droplet_diameter: {log_normal: {median: "30 um", geometric_sd: 1.3, by: mass, min: "10 um", max: "80 um"}}}
  - {name: third, position: [0, 0, "90 mm"], pattern: hollow, cone_angle: 1, inner_cone_angle: 0.5, speed: 1, mass_rate: 1,
     droplet_diameter: {uniform: {min: "10 um", max: "80 um"}}}
  - {name: fourth, position: [0, 0, "90 mm"], speed: 1, mass_rate: 1,
     droplet_diameter: {normal: {mean: "30 um", sd: "5 um", min: "10 um", max: "80 um"}}}
  - {name: fifth, position: [0, 0, "90 mm"], speed: 1, mass_rate: 1,
     droplet_diameter: {rosin_rammler: {size: "30 um", spread: 3, min: "10 um", max: "80 um"}}}
  - {name: sixth, position: [0, 0, "90 mm"], speed: 1, mass_rate: 1,
     droplet_diameter: {table: {diameters: ["10 um", "20 um"], shares: [3, 1], by: mass}}}
  - {name: seventh, position: [0, 0, "90 mm"], speed: 1, mass_rate: 1,
     droplet_diameter: {table: {diameters: ["10 um", "20 um"], finer: [0, 1]}}}
output:
  probes: [{name: coated, coating: {}, quantities: [coating_mass_cov]}]
  snapshots: {spray: [id, mass]}
  wetness:
    - {name: low, box: {min: [0, 0, 0], max: ["40 mm", "40 mm", "50 mm"]}, measure: liquid_fraction, wettest: 0.9, bins: 9,
       fastest: "2 m/s", speed_bins: 10, sample: particle_step, every: "1 ms"}
    - {name: core, cylinder: {from: ["20 mm", "20 mm", 0], to: ["20 mm", "20 mm", "60 mm"], radius: "4 mm"}}
)";

/// Droplets that push the gas.
inline constexpr const char* mist_case = R"(domain: {min: [0, 0, 0], max: [1, 1, 1]}
time: {end: 1, gas_step: 0.01, particle_step: 1e-5}
materials: {bead: {density: 1500, youngs_modulus: 1e6, poisson_ratio: 0.3, heat_capacity: 900}}
contacts: {pairs: [{between: [bead, bead], restitution: 0.9, sliding_friction: 0.3}]}
particles: [{material: bead, diameter: "10 mm", list: [{position: [0.5, 0.5, 0.5]}]}]
gas:
  density: 1.2
  viscosity: 1.8e-5
  heat: {initial_temperature: 300}
  moisture: {initial_vapour_mass_fraction: 0.01}
  grid: {cells: [2, 3, 4]}
  boundaries: [{name: out, on: top, outlet: {}}]
heat: {}
spray: [{name: gun, position: [0.2, 0.2, 0.2], speed: 10, mass_rate: "1 g/min", solids_fraction: 0.2, droplet_diameter: "30 um"}]
droplets: {momentum: two_way, evaporation: true}
)";

/// Two particles and nothing else.
inline constexpr const char* two_particles_case = R"(domain: {min: [0, 0, 0], max: [1, 1, 1]}
time: {end: 0.1, particle_step: 1e-5}
materials: {glass: {density: 2500, youngs_modulus: 1e7, poisson_ratio: 0.22}}
contacts: {pairs: [{between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}]}
particles: [{material: glass, list: [{position: [0.5, 0.5, 0.5], diameter: 0.01}, {position: [0.5, 0.5, 0.6], diameter: 0.01}]}]
)";

}  // namespace pellicle::tests
