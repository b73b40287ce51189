// Memory that a scalar needs while it is advanced and not between steps, so that scalars can share it.
#pragma once

#include <array>

#include "cfd/bicgstab.hpp"
#include "cfd/gas_state.hpp"
#include "cfd/stencil.hpp"
#include "core/views.hpp"

namespace pellicle::cfd {

/// 27 numbers a cell. Copies are handles to the same memory; it lives as long as one of them. Scalars that share it must
/// be advanced one after the other. Faces at the ends of the domain stay 0 in all of it.
struct ScalarScratch {
  explicit ScalarScratch(const Stencil& stencil);

  FaceField carrier;      ///< flux of the capacity [J/K/s], [kg/s]
  FaceField conductance;  ///< eps k area / distance of faces with two cells, half cells in series
  FaceField correction;   ///< flux of the scheme less that of upwind
  std::array<HostArray<Real>, 6> near;  ///< coefficients x-, x+, y-, y+, z-, z+
  HostArray<Real> own, base, rhs;       ///< of the equation own v = sum of near v_N + base
  HostArray<Real> storage;              ///< what changes with the cell's own value
  HostArray<Real> content_old;          ///< capacity of a cell at the beginning of the step [J/K], [kg]
  HostArray<Real> gain;                 ///< of it, by the source of mass, per second
  BiCGStab linear_solver;
};

}  // namespace pellicle::cfd
