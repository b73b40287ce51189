// What a case chooses about the exchange between gas and particles.
#pragma once

#include <array>
#include <string_view>

#include "core/cartesian_grid.hpp"
#include "core/model_list.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "coupling/deposition_kernels.hpp"
#include "coupling/drag_laws.hpp"

namespace pellicle::coupling {

/// How the gas takes the drag.
enum class Exchange {
  implicit,   ///< linear in the gas velocity of the new step; what that misses is carried into later steps
  explicit_,  ///< exactly what the particles received
  one_way     ///< not at all: the particles feel the gas, the gas does not feel the particles
};

/// How often the momentum exchange coefficient of a particle is computed.
enum class Coefficients { gas_step, substep };

/// Names of the case file, in the order of the enums.
inline constexpr core::ModelInfo exchange_models[] = {
    {"implicit", "drag implicit in the gas velocity; what that misses is carried into later steps"},
    {"explicit", "the gas gets exactly what the particles received during the step"},
    {"one_way", "the particles feel the gas, the gas does not feel the particles"},
};
inline constexpr core::ModelInfo coefficients_models[] = {
    {"gas_step", "the momentum exchange coefficient of each particle is computed once a gas step"},
    {"substep", "it is computed anew with the particle's own velocity every particle step"},
};

struct CouplingOptions {
  DragLaw drag = Beetstra{};
  Deposition deposition = Divided{};
  Exchange exchange = Exchange::implicit;
  /// -V grad p on the particles, and with it their buoyancy -density V gravity (the gas's pressure is without the
  /// hydrostatic part).
  bool pressure_gradient_force = true;
  Coefficients coefficients = Coefficients::gas_step;
  Real minimum_void_fraction = 0.36;
  /// Share of the pending momentum that the gas is given a step, in (0, 1]. docs/theory/coupling.md derives the bound
  /// 2 / (1 + 2 (1 - eps) / eps).
  Real pending_release = 0.1;
  /// What particles bring to the cells is smoothed over this length (Smoothing) [m]; 0: it is not.
  Real smoothing_length = 0;
};

struct GasProperties {
  Real density = 0;    ///< [kg/m3]
  Real viscosity = 0;  ///< dynamic [Pa s]
  Vec3 gravity;        ///< for the buoyancy of the particles [m/s2]
  /// Drag feels the density of each cell's gas. Buoyancy stays that of `density`: what lighter gas changes of it is in the
  /// pressure gradient, since the pressure is without the hydrostatic part of `density`.
  bool density_varies = false;
  bool sutherland = false;  ///< the viscosity is that of air at the cell's temperature

  bool vary() const { return density_varies || sutherland; }
};

/// Transfer grid of about cubic cells over the gas grid's box: along each axis the whole number of cells whose size is
/// nearest to `cell_size` [m] (at least one), with the gas grid's periodic axes. Throws InputError if cell_size <= 0.
CartesianGrid make_transfer_grid(const CartesianGrid& gas, Real cell_size);
/// Transfer grid of so many equal cells over the gas grid's box.
CartesianGrid make_transfer_grid(const CartesianGrid& gas, Index3 cells);

}  // namespace pellicle::coupling
