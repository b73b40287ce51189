// One move of all parcels: through the gas, until a particle, a wall or an open side ends it.
#pragma once

#include <cstdint>

#include "dem/cell_grid.hpp"
#include "dem/particles.hpp"
#include "spray/injector.hpp"
#include "spray/parcel_gas.hpp"
#include "spray/parcel_motion_laws.hpp"
#include "spray/parcels.hpp"
#include "spray/particle_push.hpp"
#include "spray/wall_crossing.hpp"

namespace pellicle::spray {

/// The particles that parcels may hit, and how to find those near a place.
struct ParcelTargets {
  dem::Particles particles;
  dem::CellGrid cells;                   ///< of the last list build
  DeviceArray<std::int32_t> cell_start;  ///< slots at which its cells begin
  DeviceArray<std::int32_t> order;       ///< the particle in a slot
  Real largest_speed = 0;                ///< that particles hardly exceed [m/s]; it widens the search
};

/// Everything about one move, a functor over parcels. Times are in s since the beginning of the outer step.
struct ParcelMove {
  Parcels parcels;
  DeviceArray<NozzleView> nozzle;
  DeviceArray<std::int64_t> dried;  ///< parcels that ran dry, by nozzle; empty unless they evaporate
  WholeUnits units;
  ParticlePushes pushes;  ///< empty unless droplets push particles
  ParcelGas gas;
  ParcelTargets targets;
  MovingWalls walls;
  dem::Domain domain;
  Vec3 gravity;  ///< [m/s2]
  Real begin = 0, end = 0;
  std::uint64_t seed = 0;
  std::int64_t substep = 0;  ///< of the run: what the random numbers of captures are drawn for
};

/// Moves all parcels that fly and are born before the end of the move.
void move_parcels(const ParcelMove& move);

/// What of the particles bounds a move.
struct ParticleBounds {
  Real largest_speed = 0;    ///< of those that move [m/s]
  Real smallest_radius = 0;  ///< [m]; 0 without particles
};
ParticleBounds find_bounds(const dem::Particles& particles);

/// Largest speed [m/s] of a parcel; 0 if there is none.
Real largest_parcel_speed(const Parcels& parcels);

}  // namespace pellicle::spray
