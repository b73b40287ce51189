// The momentum equations of the cells: coefficients, residual, solution.
#pragma once

#include <array>
#include <vector>

#include "cfd/bicgstab.hpp"
#include "cfd/boundary_pieces.hpp"
#include "cfd/convection.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_fields.hpp"
#include "cfd/gas_options.hpp"

namespace pellicle::cfd {

/// What the change in time, drag and relaxation add to a cell's equation, the same for all three components:
/// keep (own + inertia) is added to the diagonal for relaxation, and times the velocity at hand to the right-hand side.
struct Inertia {
  HostArray<Real> all;  ///< on the diagonal: of time and drag [kg/s]
  HostArray<Real>
      old;        ///< mass of the gas at the start of the step per time: times its velocity a force [kg/s]
  Real keep = 0;  ///< 1 / relaxation factor - 1
};

/// Per cell and component: (own + inertia) u = sum of near u_N + source + forces, where own and near hold convection
/// (upwind; the rest of the scheme is in source) and viscous stress. The equation is the momentum balance less
/// u times continuity (Patankar 1980), so own is the sum of near but for boundaries.
class MomentumEquation {
 public:
  MomentumEquation(const FlowGeometry& geometry, const Boundaries& boundaries, const GasOptions& options);

  /// Once a step, when the void fraction is known: viscous conductances, normal stress at walls.
  void prepare(const GasFields& fields, Real dt);
  /// Coefficients from the mass fluxes and velocities at hand.
  void assemble(const GasFields& fields);
  /// 3 cells: sum of near u_N + source [N], from the velocities at hand.
  void compute_influx(const GasFields& fields, const HostArray<Real>& influx) const;
  /// Solves for the velocity in `fields`, with what `inertia` adds to the equation and the `force` [N], 3 cells.
  TransportReport solve(const GasFields& fields, const Inertia& inertia, const HostArray<Real>& force,
                        Real tolerance);

  /// Coefficients of u itself, 3 cells [kg/s].
  const HostArray<Real>& own() const { return own_; }
  const ConvectionCorrection& convection() const { return correction_; }
  /// Momentum that a boundary piece carries into the gas per second, by convection and by viscous stress [N].
  Vec3 convected_inflow(const GasFields& fields, std::size_t b) const;
  Vec3 shear_force(const GasFields& fields, std::size_t b) const;
  /// Viscous force of a piece of the geometry's surfaces on the gas [N].
  Vec3 surface_shear(const GasFields& fields, std::size_t b) const;

 private:
  Real surface_conductance(const GasFields& fields, std::size_t b) const;
  void add_surfaces(const GasFields& fields);
  void add_skew_stress(const GasFields& fields);
  void add_boundaries(const GasFields& fields);
  struct RowSum;
  template <class Result>
  void apply(const char* label, const Real* u, Result&& result) const;
  struct Correction {
    const float* values;
    Real residual;
    bool fast;  ///< sweeps converge fast enough
  };
  template <class T, class Term>
  T sum_along_row(const Row& row, Term&& term) const;
  struct Begun {
    Real defect = 0, right_side = 0;  ///< roots of sums of squares
    Real rate = 0;                    ///< what a sweep leaves, about
  };
  template <bool keeps>
  Begun begin(const GasFields& fields, const Inertia& inertia, const Real* force, Real factor);
  Real compute_defect(const Real* u, Real factor);
  void pack(const Row& row) const;
  Real sweep(const float* d, float* next);
  Correction solve_correction(Real defect, Real target, int& sweeps);

  const FlowGeometry& geometry_;
  const Boundaries& boundaries_;
  const GasOptions& options_;
  ConvectionCorrection correction_;
  FaceField conductance_;               ///< mu area / distance [kg/s]; 0 on boundary faces
  FaceField tangential_conductance_;    ///< the same times the face's void fraction
  std::vector<std::int32_t> piece_of_;  ///< of each cell, its largest piece of a surface; -1: none
  std::vector<Vec3> surface_velocity_;  ///< of each piece of the geometry's surfaces [m/s]
  std::vector<Real> wall_stress_;       ///< of each boundary piece: normal force on the gas along +axis [N]
  std::vector<Vec3> transposed_;  ///< likewise by the transposed gradient, with a model of turbulence [N]
  std::array<HostArray<Real>, 6> near_,
      normal_;  ///< x-, x+, y-, y+, z-, z+; for components across, along that axis
  HostArray<Real> own_, source_, inverse_;
  // Of sweeps: row by row of cells, in it value by value or component by component.
  HostArray<float> packed_, defect_;
  std::array<HostArray<float>, 2> trial_;
  std::vector<Real> row_change_;                ///< sum of squares
  std::vector<std::array<Real, 2>> row_begun_;  ///< sum of squares of the right-hand side, largest rate
  bool swept_roughly_ = false;  ///< one sweep did not do in the last rough solve: only saves time
  bool coloured_ = true;        ///< rows can be coloured like a chess board
  bool open_ends_ = true;       ///< no coefficient at the ends of rows
  BiCGStab linear_solver_;
  FixedSum sum_;
};

}  // namespace pellicle::cfd
