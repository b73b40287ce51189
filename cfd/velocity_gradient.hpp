// Velocity gradients of the cells, and the part of the viscous stress that needs all of them. Of use with a model of
// turbulence only: where the viscosity is uniform that part is none.
#pragma once

#include <vector>

#include "cfd/boundary_pieces.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_fields.hpp"

namespace pellicle::cfd {

/// Fills fields.velocity_gradient from the velocities at hand: differences of face values over the width of the cell,
/// beside a closed face over its open half.
void compute_velocity_gradient(const FlowGeometry& geometry, const Boundaries& boundaries,
                               const GasFields& fields);

/// Adds div{eps mu [(grad u)^T - 2/3 (div u) I]} to `source` [N], 3 cells; `conductance` is eps mu area / distance of the
/// faces. At outlets and walls without shear the gradient is that of the cell; walls that the gas sticks to and inlets
/// have none. What a boundary piece gives the gas goes to `piece_force` [N].
void add_transposed_stress(const FlowGeometry& geometry, const Boundaries& boundaries,
                           const GasFields& fields, const FaceField& conductance,
                           const HostArray<Real>& source, std::vector<Vec3>& piece_force);

}  // namespace pellicle::cfd
