// Inside of GasSolver; only its own files include this.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cfd/boundary_pieces.hpp"
#include "cfd/face_balance.hpp"
#include "cfd/field_memory.hpp"
#include "cfd/fixed_sum.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_fields.hpp"
#include "cfd/gas_scalars.hpp"
#include "cfd/gas_solver.hpp"
#include "cfd/momentum.hpp"
#include "cfd/pressure_system.hpp"
#include "cfd/turbulence.hpp"

namespace pellicle::cfd {

struct GasSolver::Impl {
  Impl(const CartesianGrid& grid, const GasOptions& gas_options, std::vector<BoundaryPatch> boundary_patches,
       const ImmersedGeometry& immersed);

  void initialise(const HostArray<Real>& void_fraction);
  void check_exchange(const ParticleExchange& exchange);
  bool stays_as_it_is(const ParticleExchange& exchange);
  void take_exchange(const ParticleExchange& exchange, Real dt);
  void prepare_inertia(Real dt);
  Real compute_continuity_residual(Real dt);
  Real growth_of_gas(Real eps, Real eps_old, Real rho, Real rho_old, Real dt) const;
  Real gas_throughput() const;
  void solve_pressure(Real dt, bool tightly, StepReport& report);
  void solve_momentum(Real tolerance, StepReport& report);
  void update_mass_flux();
  Real face_velocity_change();
  void take_mass_source(const ParticleExchange& exchange, Real dt);
  void finish_step(Real dt, const ParticleExchange& exchange, StepReport& report);
  void add_to_balance(Real dt, const ParticleExchange& exchange);
  void update_stocks();
  void copy_velocity_to_state();
  Real check_and_find_courant(Real dt);
  Real fastest_inlet(Real dt) const;
  [[noreturn]] void fail_for_courant(Real courant, Real dt) const;
  Real find_divergence(Real dt);
  Index most_changed_cell() const;
  [[noreturn]] void fail(const std::string& what, Index cell) const;
  Index worst_cell() const;

  FieldMemory memory;  ///< before the fields
  FlowGeometry geometry;
  GasOptions options;
  std::vector<BoundaryPatch> patches;
  Boundaries boundaries;
  GasFields fields;
  MomentumEquation momentum;
  FaceBalance faces;
  PressureMatrix pressure_matrix;
  PressureLinearSolver pressure_solver;
  GasState state;
  GasBalance balance;
  std::optional<ScalarScratch> scalar_scratch;  ///< of all scalars, of k and of epsilon
  GasScalars scalars;
  std::optional<KEpsilon> turbulence;

  HostArray<Real> influx, cell_force, rhs, correction;
  Inertia inertia;
  FaceField before;                 ///< face velocities at the start of an outer iteration
  std::vector<Real> inverse_width;  ///< of cells along x [1/m]
  std::vector<Real> row_courant;    ///< largest of each row of cells
  std::vector<std::array<Real, 3>>
      row_through;      ///< volume flow through the faces of each row, all counted up [m3/s]
  int still_steps = 0;  ///< in a row, up to the one at hand, in which gas and void fraction did not change
  Real displaced = 0;   ///< by the growth of the gas in a step [m3/s]
  FixedSum sum;
};

}  // namespace pellicle::cfd
