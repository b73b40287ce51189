// What the chosen convection scheme adds to upwind.
#pragma once

#include "cfd/boundary_pieces.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_fields.hpp"
#include "cfd/gas_options.hpp"

namespace pellicle::cfd {

/// Per axis of faces.
struct ConvectionCorrection {
  explicit ConvectionCorrection(const FlowGeometry& geometry);
  /// mass flux * (face value - upwind value), faces of the axis, three components one after the other [N]. The
  /// component along the axis is that of the superficial velocity, which does not jump with the void fraction.
  FaceField momentum_flux;
  /// Face value of the superficial velocity along the axis [m/s].
  FaceField normal_value;
};

/// Computes the correction from the velocities and mass fluxes at hand.
void compute_convection_correction(const FlowGeometry& geometry, const Boundaries& boundaries,
                                   Convection scheme, const GasFields& fields,
                                   const ConvectionCorrection& result);

}  // namespace pellicle::cfd
