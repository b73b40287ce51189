// The gas that parcels fly through, as their kernels see it, and what they give to its cells.
#pragma once

#include <cstdint>

#include "cfd/gas_property_laws.hpp"
#include "coupling/cut_grid.hpp"
#include "coupling/grid_locator.hpp"
#include "spray/droplet_evaporation_laws.hpp"
#include "spray/parcel_motion_laws.hpp"
#include "spray/whole_units.hpp"

namespace pellicle::spray {

/// Sums over the droplets in a cell since they were last looked at, in whole units: the same in whatever order they are
/// added. In one cache line.
struct alignas(64) CellGains {
  std::int64_t impulse[3] = {};  ///< of drag, on the gas
  std::int64_t bounced[3] = {};  ///< on the droplets, of bouncing off particles
  std::int64_t mass_time = 0;    ///< mass of the droplets times the time that they fell
  std::int64_t dragged = 0;      ///< mass of the droplets times the share of their slip that they lost
};

/// The same of what droplets evaporate.
struct alignas(64) VapourGains {
  std::int64_t vapour = 0;        ///< less what condensed
  std::int64_t heat = 0;          ///< that the gas got, with the enthalpy c_p (T - T_ref) of that vapour
  std::int64_t momentum[3] = {};  ///< of that vapour
  std::int64_t reach = 0;         ///< see DropletExchange
};

/// Adds to the gains of cells. Empty if droplets do not push the gas.
struct GasGains {
  DeviceArray<CellGains> cell;
  WholeUnits unit;

  KOKKOS_INLINE_FUNCTION bool is_on() const { return cell.extent(0) > 0; }
  /// The gas of a cell takes the opposite of an impulse [N s] on droplets; returns that impulse in whole units.
  KOKKOS_INLINE_FUNCTION Vec3 take_impulse(Index c, const Vec3& impulse) const {
    Vec3 taken;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t units = whole(impulse[axis] / unit.impulse);
      Kokkos::atomic_add(&cell(c).impulse[axis], -units);
      taken[axis] = unit.impulse * static_cast<Real>(units);
    }
    return taken;
  }
  /// Books an impulse [N s] that droplets get as they bounce; returns it in whole units.
  KOKKOS_INLINE_FUNCTION Vec3 book_bounce(Index c, const Vec3& impulse) const {
    Vec3 taken;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t units = whole(impulse[axis] / unit.impulse);
      Kokkos::atomic_add(&cell(c).bounced[axis], units);
      taken[axis] = unit.impulse * static_cast<Real>(units);
    }
    return taken;
  }
  KOKKOS_INLINE_FUNCTION void book_flight(Index c, Real mass, Real time, Real lost_share) const {
    Kokkos::atomic_add(&cell(c).mass_time, whole(mass * time / unit.mass_time));
    Kokkos::atomic_add(&cell(c).dragged, whole(mass * lost_share / unit.mass));
  }
};

/// The gas that parcels fly through; without gas `drag` has no viscosity and the arrays are empty.
struct ParcelGas {
  DragGas drag;  ///< where the arrays below do not say otherwise
  coupling::GridLocator grid;
  coupling::CutGrid cut;          ///< empty where walls do not cut the grid
  DeviceArray<Vec3> velocity;     ///< of its cells [m/s]
  DeviceArray<Real> density;      ///< [kg/m3]; empty: the same everywhere
  DeviceArray<Real> temperature;  ///< [K]; empty unless something follows from it
  DeviceArray<Real> vapour;       ///< mass fraction; empty unless droplets evaporate
  bool sutherland = false;        ///< viscosity is that of air at the temperature
  GasGains gains;
  DeviceArray<VapourGains> vapour_gains;  ///< empty unless droplets evaporate
  DropletHeat heat;

  /// Cell whose gas a droplet at this place [m] is in: on its own side of thin walls, and with gas.
  KOKKOS_INLINE_FUNCTION Index cell_of(const Vec3& place) const {
    const Index cell = grid.index(grid.x.locate(grid.x.wrap(place.x)), grid.y.locate(grid.y.wrap(place.y)),
                                  grid.z.locate(grid.z.wrap(place.z)));
    return cut.is_cut() ? cut.home(cell, place) : cell;
  }
  KOKKOS_INLINE_FUNCTION DragGas drag_in(Index cell) const {
    DragGas here = drag;
    if (density.extent(0) > 0) here.density = density(cell);
    if (sutherland) here.viscosity = cfd::sutherland_viscosity(temperature(cell));
    return here;
  }
};

}  // namespace pellicle::spray
