// The working set of one gas step. Velocity components lie one after the other: entry of cell c and axis a is
// c + a * cells.
#pragma once

#include <vector>

#include "cfd/flow_geometry.hpp"
#include "cfd/gas_state.hpp"

namespace pellicle::cfd {

/// What wall functions say of the gas between a wall and the cell beside it.
struct WallLayer {
  Real viscosity = 0;  ///< shear stress = viscosity slip / distance [Pa s]
  Real scale = 0;      ///< velocity scale [m/s]; 0: no wall that the gas sticks to
  Real distance = 0;   ///< from the wall that the wall functions count with [m]
};

struct GasFields {
  GasFields(const FlowGeometry& geometry, std::size_t piece_count, bool is_turbulent = false);

  Index cells = 0;
  HostArray<Real> velocity, velocity_old;  ///< 3 cells [m/s]
  HostArray<Real> pressure;                ///< [Pa]
  HostArray<Real> void_fraction, void_fraction_old;
  HostArray<Real> exchange_coefficient;  ///< beta, and the vapour that becomes gas [kg/m3/s]
  HostArray<Real> force;                 ///< explicit force on the gas, 3 cells [N/m3]
  HostArray<Real> mass_source;           ///< [kg/m3/s]
  HostArray<Real> density, density_old;  ///< [kg/m3]
  HostArray<Real> excess_density;  ///< that gravity acts on: over the one of the hydrostatic pressure [kg/m3]
  HostArray<Real> viscosity;       ///< of gas and eddies together [Pa s]
  HostArray<Real> molecular_viscosity;  ///< [Pa s]; the same array without a model of turbulence
  // With a model of turbulence, else empty.
  HostArray<Real> eddy_viscosity;     ///< [Pa s]
  HostArray<Real> velocity_gradient;  ///< d u_b / d x_a in cell c: entry c + (3 a + b) cells [1/s]
  std::vector<WallLayer> piece_layer,
      surface_layer;                         ///< of boundary pieces, of pieces of the geometry's surfaces
  FaceField face_density, face_density_old;  ///< of faces with two cells; 0 on boundary faces [kg/m3]
  std::vector<Real> piece_density;           ///< of what flows through each boundary piece [kg/m3]
  FaceField superficial, superficial_old;    ///< face velocity [m/s]
  FaceField mass_flux;  ///< rho volume flux of faces with two cells; 0 on boundary faces [kg/s]
  std::vector<Real> piece_flow, piece_flow_old;  ///< outward volume flow of each boundary piece [m3/s]
};

}  // namespace pellicle::cfd
