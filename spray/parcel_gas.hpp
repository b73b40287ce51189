// The gas that parcels fly through, as their kernels see it, and what they give to its cells.
#pragma once

#include <cstdint>

#include "cfd/gas_property_laws.hpp"
#include "coupling/cut_grid.hpp"
#include "coupling/grid_locator.hpp"
#include "spray/parcel_motion_laws.hpp"

namespace pellicle::spray {

/// Sums over the droplets in a cell since they were last looked at, in whole units: the same in whatever order they are
/// added. In one cache line.
struct alignas(64) CellGains {
  std::int64_t impulse[3] = {};  ///< of drag, on the gas
  std::int64_t bounced[3] = {};  ///< on the droplets, of bouncing off particles
  std::int64_t mass_time = 0;    ///< mass of the droplets times the time that they fell
  std::int64_t dragged = 0;      ///< mass of the droplets times the share of their slip that they lost
};

/// What one of the units is worth. Powers of two times the mass of the largest parcel: a droplet's velocity is kept to 6e-11
/// m/s, and 5e6 parcels at 100 m/s fit into a cell, for 0.05 ms.
struct GainUnits {
  Real impulse = 0;    ///< [N s]
  Real mass_time = 0;  ///< [kg s]
  Real mass = 0;       ///< [kg]
};
inline GainUnits make_units(Real largest_parcel_mass) {
  return {largest_parcel_mass * 0x1p-34, largest_parcel_mass * 0x1p-55, largest_parcel_mass * 0x1p-34};
}

/// Adds to the gains of cells. Empty if droplets do not push the gas.
struct GasGains {
  DeviceArray<CellGains> cell;
  GainUnits unit;

  KOKKOS_INLINE_FUNCTION bool is_on() const { return cell.extent(0) > 0; }
  /// The gas of a cell takes the opposite of an impulse [N s] on droplets; returns that impulse in whole units.
  KOKKOS_INLINE_FUNCTION Vec3 take_impulse(Index c, const Vec3& impulse) const {
    Vec3 whole;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t units = whole_units(impulse[axis] / unit.impulse);
      Kokkos::atomic_add(&cell(c).impulse[axis], -units);
      whole[axis] = unit.impulse * static_cast<Real>(units);
    }
    return whole;
  }
  /// Books an impulse [N s] that droplets get as they bounce; returns it in whole units.
  KOKKOS_INLINE_FUNCTION Vec3 book_bounce(Index c, const Vec3& impulse) const {
    Vec3 whole;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t units = whole_units(impulse[axis] / unit.impulse);
      Kokkos::atomic_add(&cell(c).bounced[axis], units);
      whole[axis] = unit.impulse * static_cast<Real>(units);
    }
    return whole;
  }
  KOKKOS_INLINE_FUNCTION void book_flight(Index c, Real mass, Real time, Real lost_share) const {
    Kokkos::atomic_add(&cell(c).mass_time, whole_units(mass * time / unit.mass_time));
    Kokkos::atomic_add(&cell(c).dragged, whole_units(mass * lost_share / unit.mass));
  }

 private:
  KOKKOS_INLINE_FUNCTION static std::int64_t whole_units(Real x) {
    return static_cast<std::int64_t>(Kokkos::round(x));
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
  bool sutherland = false;        ///< viscosity is that of air at the temperature
  GasGains gains;

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
