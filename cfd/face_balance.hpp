// The momentum balance at the faces: pressure difference, drag, forces and inertia in series over the half cells on
// both sides, so that what jumps from cell to cell (drag, void fraction) is balanced where it jumps
// (Mencinger & Zun, J. Comput. Phys. 221 (2007) 524), with transient, drag and relaxation terms of the face's own
// velocity (Cubero & Fueyo, Numer. Heat Transfer B 52 (2007) 507).
#pragma once

#include <array>
#include <vector>

#include "cfd/boundary_pieces.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_fields.hpp"
#include "cfd/gas_options.hpp"
#include "cfd/momentum.hpp"
#include "cfd/pressure_system.hpp"

namespace pellicle::cfd {

/// Velocity of boundary faces from the flows of their pieces.
void set_boundary_velocities(const FlowGeometry& geometry, const Boundaries& boundaries,
                             const GasFields& fields);

class FaceBalance {
 public:
  FaceBalance(const FlowGeometry& geometry, const Boundaries& boundaries, const GasOptions& options);

  /// Once a step: void fraction, resistance and force of the faces.
  void prepare(const GasFields& fields);
  /// Face velocities that the momentum balance gives with the pressure at hand, and the coefficients of the pressure
  /// correction.
  void predict(GasFields& fields, const MomentumEquation& momentum, const HostArray<Real>& influx,
               const Inertia& inertia, Real dt, PressureMatrix& matrix);
  /// Changes pressure and face velocities by a pressure correction, and the cell velocities by the mean change of
  /// their faces.
  void correct(GasFields& fields, const HostArray<Real>& correction);
  /// Force on the gas of a cell but for its own drag -beta u [N], 3 cells: inertial force of the faces and the
  /// drag of the faces' gas, which the local pressure gradient holds up.
  void compute_cell_force(const GasFields& fields, const MomentumEquation& momentum,
                          const HostArray<Real>& force);
  /// Pressure gradient of each cell, without smearing across jumps; after compute_cell_force.
  void compute_pressure_gradient(const GasFields& fields, const HostArray<Vec3>& gradient) const;
  /// Pressure at a boundary piece: what the cell's half up to the boundary leaves; after compute_cell_force.
  Real boundary_pressure(const GasFields& fields, std::size_t b) const;
  /// Force of the pressure on the gas of a cell by the surfaces in it [N]: what its faces leave of the cell's pressure
  /// force; after compute_cell_force.
  Vec3 surface_pressure_force(const GasFields& fields, Index cell) const;

 private:
  void clear_closed_faces(const FaceField& field) const;
  void block_cell_force(const GasFields& fields, const HostArray<Real>& force) const;
  void predict_outlets(GasFields& fields, const MomentumEquation& momentum, const HostArray<Real>& influx,
                       const Inertia& inertia, Real dt, PressureMatrix& matrix);
  void set_boundary_inertia(const GasFields& fields);
  Real outlet_pressure(const GasFields& fields, std::size_t b) const;
  Real side_gradient(const GasFields& fields, Index cell, int axis, Index face) const;
  Real gradient_from(const GasFields& fields, Index cell, int axis, Real inertial, Real velocity) const;
  std::array<Real, 2> side_gradients(const GasFields& fields, const BlockedCell& blocked, int axis) const;

  const FlowGeometry& geometry_;
  const Boundaries& boundaries_;
  const GasOptions& options_;
  FaceField void_fraction_, void_fraction_old_;  ///< of faces: half cells in series
  FaceField resistance_;                         ///< beta / eps^2 [kg/m3/s]
  FaceField force_;                              ///< explicit force / eps + body force [N/m3]
  FaceField kinetic_;                            ///< 1 / eps^2 of the plus cell less that of the minus cell
  FaceField mobility_;                           ///< change of face velocity per pressure difference [m/s/Pa]
  FaceField inertial_;                           ///< inertial force of the face's gas [N/m3]
  FaceField jump_;                               ///< pressure step of the convective acceleration [Pa]
  std::vector<Real> outlet_mobility_;
};

}  // namespace pellicle::cfd
