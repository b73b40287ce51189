// What a case chooses about the gas: properties, schemes, tolerances.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "cfd/gas_property_laws.hpp"
#include "cfd/scalar_options.hpp"
#include "cfd/turbulence_options.hpp"
#include "core/model_list.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::cfd {

/// How the convected velocity is taken from the cells to their faces.
enum class Convection { upwind, ultimate_quickest, central, quick };

/// Names of the case file, what they are, and where they come from; in the order of the enum.
inline constexpr core::ModelInfo convection_models[] = {
    {"upwind", "first order, bounded, most diffusive", "Courant, Isaacson & Rees 1952"},
    {"ultimate_quickest", "third-order upwind-biased face value with the ULTIMATE limiter",
     "Leonard 1991, without Courant terms since the step is implicit"},
    {"central", "linear interpolation, second order, not bounded", "any textbook"},
    {"quick", "third-order upwind-biased face value, not bounded", "Leonard 1979"},
};

/// Which solver the pressure equation gets; both give the same answer to within the tolerance.
enum class PressureSolver {
  multigrid,  ///< conjugate gradients with a geometric multigrid cycle on the 7-point stencil
  amgcl       ///< conjugate gradients with AMGCL's smoothed aggregation, hierarchy kept while it still serves
};

struct GasSolverOptions {
  Real pressure_tolerance =
      1e-10;  ///< of a step's last pressure solve: sum of |mass residuals| / gas throughput
  Real loose_pressure_tolerance =
      1e-2;  ///< of the pressure solves before the last: reduction of the residual
  Real momentum_tolerance =
      1e-9;  ///< relative, of a step's last momentum solve; those before: 100 times as much
  Real outer_tolerance = 1e-6;   ///< relative change of the face velocities that ends the outer iterations
  int max_outer_iterations = 2;  ///< of the SIMPLEC loop, each one pressure and one momentum solve
  int max_linear_iterations = 500;
  Real velocity_relaxation = 1;  ///< in (0, 1]; below 1 only for steps of many Courant numbers
  PressureSolver pressure_solver = PressureSolver::multigrid;
  bool require_convergence = false;  ///< a step whose outer iterations miss outer_tolerance stops the run
};

/// What the density follows.
enum class DensityLaw {
  constant,
  ideal_gas  ///< temperature and moisture at the start of the step, at the reference pressure (low Mach number)
};
enum class ViscosityLaw {
  constant,
  sutherland  ///< of air, at the temperature at the start of the step
};

/// Buoyancy of a gas of constant density: -density expansion (T - temperature) gravity.
struct Boussinesq {
  Real expansion = 0;    ///< [1/K]; 1/temperature for an ideal gas
  Real temperature = 0;  ///< at which the gas is as heavy as its density says [K]
};

struct GasOptions {
  /// [kg/m3]. Of an ideal gas: the density that the hydrostatic part of the pressure is counted with.
  Real density = 0;
  Real viscosity = 0;  ///< dynamic [Pa s]; of use where it is constant
  DensityLaw density_law = DensityLaw::constant;
  ViscosityLaw viscosity_law = ViscosityLaw::constant;
  Real reference_pressure = standard_atmosphere;  ///< absolute, everywhere, of an ideal gas [Pa]
  std::optional<Boussinesq> boussinesq;
  /// [m/s2]. The pressure solved for is p - density gravity.x, so gravity moves nothing by itself.
  Vec3 gravity{0, 0, -9.81};
  Vec3 body_force;  ///< on the gas, besides gravity, per volume of gas [N/m3]
  Convection convection = Convection::ultimate_quickest;
  GasSolverOptions solver;
  std::optional<KEpsilonOptions> turbulence;  ///< none: laminar, or eddies that the grid resolves
  std::array<std::optional<ScalarOptions>, scalar_count> scalars{};  ///< those that are solved, see Scalar
};

}  // namespace pellicle::cfd
