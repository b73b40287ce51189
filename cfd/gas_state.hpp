// The fields of the gas, on the host.
#pragma once

#include <array>

#include "cfd/scalar_options.hpp"
#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"

namespace pellicle::cfd {

/// One value a face, for the faces across each axis. The faces across x are numbered i + (nx + 1) (j + ny k) with
/// i = 0..nx, the others likewise; face i lies between cells i - 1 and i. Along a periodic axis the first and the
/// last face are the same face and hold the same value.
using FaceField = std::array<HostArray<Real>, 3>;

/// Everything a restart needs, and what others may read. Cell fields: i + nx (j + ny k).
struct GasState {
  Real time = 0;                      ///< since initialise [s]
  HostArray<Vec3> velocity;           ///< of the gas between the particles [m/s]
  HostArray<Real> pressure;           ///< without the hydrostatic part density gravity.x [Pa]
  HostArray<Real> void_fraction;      ///< at the end of the last step
  HostArray<Real> void_fraction_old;  ///< at its beginning
  HostArray<Vec3>
      pressure_gradient;           ///< what particles in the cell feel; jumps at a bed's edge are not smeared
  FaceField volume_flux;           ///< of gas along +axis [m3/s]; satisfies continuity
  FaceField superficial_velocity;  ///< volume_flux per area, over the open part of the face [m/s]
  std::array<HostArray<Real>, scalar_count> scalars{};  ///< [K], [kg/kg]; empty where not solved
  HostArray<Real> density;                              ///< at the end of the last step [kg/m3]
  // With a model of turbulence, else empty.
  HostArray<Real> turbulent_kinetic_energy{};  ///< k [m2/s2]
  HostArray<Real> turbulent_dissipation{};     ///< epsilon [m2/s3]
  HostArray<Real> eddy_viscosity{};            ///< [Pa s]
};

/// What the particles do to the gas during the coming step, per gas cell.
/// Force on the gas per volume of cell: -exchange_coefficient velocity + explicit_force.
struct ParticleExchange {
  HostArray<Real> void_fraction;                     ///< at the end of the step
  HostArray<Real> exchange_coefficient;              ///< beta [kg/m3/s], taken implicitly
  HostArray<Vec3> explicit_force;                    ///< [N/m3]
  std::array<ScalarSource, scalar_count> scalars{};  ///< heat and vapour; empty: none
  HostArray<Real>
      mass_source{};  ///< vapour that becomes gas, in the continuity equation [kg/m3/s]; empty: none
  HostArray<Vec3> mass_source_momentum{};  ///< that it brings along [N/m3]; of the same size as mass_source
};

/// Arrays for a grid: void fraction 1, no exchange. With these the solver is pure CFD.
ParticleExchange make_empty_exchange(const CartesianGrid& grid);

}  // namespace pellicle::cfd
