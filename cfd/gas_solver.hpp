// The gas solver: volume-averaged incompressible flow on a Cartesian grid, one implicit step at a time.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "cfd/boundary.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_balance.hpp"
#include "cfd/gas_options.hpp"
#include "cfd/gas_state.hpp"
#include "cfd/scalar_balance.hpp"
#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::core {
class CheckpointWriter;
class CheckpointReader;
}  // namespace pellicle::core

namespace pellicle::cfd {

/// What a step cost and how well it converged.
struct StepReport {
  int outer_iterations = 0;
  int pressure_iterations = 0;    ///< of the linear solver, all outer iterations together
  int momentum_iterations = 0;    ///< likewise
  Real continuity_residual = 0;   ///< sum of |mass residuals| / gas throughput, after the last pressure solve
  Real momentum_residual = 0;     ///< relative, after the last momentum solve
  Real velocity_change = 0;       ///< relative change of the face velocities by the last outer iteration
  int scalar_iterations = 0;      ///< of all scalars' linear solves
  int scalar_cells_returned = 0;  ///< cells where a scalar's bounds asked for upwind
  bool converged = true;          ///< velocity_change is below outer_tolerance
  Real divergence = 0;      ///< largest |d eps/dt + div(eps u)| dt of a cell, after the last pressure solve
  Real courant_number = 0;  ///< largest sum over axes of |u| dt / cell width
};

/// Solves d(eps rho)/dt + div(eps rho u) = 0 and
/// d(eps rho u)/dt + div(eps rho u u) = -eps grad p + div(eps tau) - beta u + F (model A; Anderson & Jackson 1967)
/// by finite volumes on a collocated Cartesian grid: SIMPLEC (Van Doormaal & Raithby 1984), face velocities by a
/// consistent momentum interpolation (Cubero & Fueyo 2007), forces that jump balanced at the faces (Mencinger &
/// Zun 2007), implicit Euler; then the scalars that the options name, on the step's final fluxes. docs/theory/gas.md
/// and docs/theory/scalars.md have the equations.
class GasSolver {
 public:
  /// A side without a patch is a no-slip wall at rest. Throws InputError for patches that overlap, cover no face,
  /// lie on a periodic side, or let gas in with no way out.
  /// `immersed`: surfaces within the domain; throws std::invalid_argument as cut_cells does.
  GasSolver(const CartesianGrid& grid, const GasOptions& options, std::vector<BoundaryPatch> patches,
            const ImmersedGeometry& immersed = {});
  ~GasSolver();
  GasSolver(GasSolver&&) noexcept;
  GasSolver& operator=(GasSolver&&) noexcept;

  /// Starts from a uniform velocity [m/s]; void fraction per cell. Pressure 0, time and balance begin anew.
  void initialise(const Vec3& velocity, const HostArray<Real>& void_fraction);
  /// Starts from a velocity field [m/s]; void fraction per cell.
  void initialise(const HostArray<Vec3>& velocity, const HostArray<Real>& void_fraction);
  /// Starts from a uniform velocity without particles.
  void initialise(const Vec3& velocity = {});

  /// Advances by dt [s]. Throws RunError if the gas does not converge or is no longer finite, saying where and when;
  /// the state is then that of the failed step.
  StepReport update(Real dt, const ParticleExchange& exchange);

  /// Largest sum over axes of |u| dt / cell width that a step of dt [s] from here begins with; u is the larger velocity
  /// of each cell's two faces, inlets included.
  Real courant_number(Real dt) const;

  const CartesianGrid& grid() const;
  const FlowGeometry& geometry() const;
  /// Force of the gas on a surface within the domain [N], by its number: pressure and viscous stress of the last step.
  Vec3 surface_force(std::size_t surface) const;
  /// Of all surfaces, in their order.
  std::vector<Vec3> surface_forces() const;
  /// Force of the gas on each side of the domain [N], in the order of Side: pressure and viscous stress of the last step
  /// where the side is a wall, not on inlets, outlets and planes of symmetry.
  std::array<Vec3, 6> side_forces() const;
  const GasOptions& options() const;
  const GasState& state() const;
  const GasBalance& balance() const;
  /// Totals of a scalar; null where it is not solved.
  const ScalarBalance* balance(Scalar scalar) const;

  /// Area-averaged pressure over a patch [Pa]; throws std::invalid_argument for an unknown name.
  Real patch_pressure(const std::string& name) const;
  /// Pressure over one patch less that over another [Pa].
  Real pressure_drop(const std::string& from, const std::string& to) const;
  /// Area-averaged pressure over the plane axis = coordinate, linear between cell centres [Pa].
  Real plane_pressure(int axis, Real coordinate) const;

  /// Forgets what only makes the next solve cheaper, so that a run that goes on and one that resumes do the same.
  /// To be called when a checkpoint is written.
  void drop_solver_hierarchies();
  void save(core::CheckpointWriter& writer) const;
  /// For a solver of the same grid and patches; throws RunError if the checkpoint has other sizes.
  void load(core::CheckpointReader& reader);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pellicle::cfd
