// Transport of one scalar by the gas: implicit finite volumes on the mass fluxes that the gas step ended with.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cfd/boundary_pieces.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_fields.hpp"
#include "cfd/gas_options.hpp"
#include "cfd/scalar_balance.hpp"
#include "cfd/scalar_options.hpp"
#include "cfd/scalar_scratch.hpp"

namespace pellicle::core {
class CheckpointWriter;
class CheckpointReader;
}  // namespace pellicle::core

namespace pellicle::cfd {

struct ScalarReport {
  int solves = 0;      ///< linear solves: deferred corrections and returns to upwind
  int iterations = 0;  ///< of all linear solves together
  int returned = 0;    ///< cells whose faces went back to upwind to keep the value within its bounds
};

/// Solves d(eps rho c v)/dt + div(c j v) = div(eps k grad v) + source for a value v: implicit Euler, convection by
/// deferred correction, less v times the continuity of c (Patankar 1980), so that a uniform value stays uniform whatever
/// the void fraction does and whatever continuity leaves. j is the mass flux and c the capacity; where vapour has
/// another one, each of the two gases carries its own. docs/theory/scalars.md has the equations.
class ScalarTransport {
 public:
  /// `patches`: what each patch of the boundaries means for the scalar. Throws InputError for properties out of range
  /// and for an inlet without a value, naming the scalar as `name`.
  ScalarTransport(std::string name, const FlowGeometry& geometry, const Boundaries& boundaries,
                  const std::vector<ScalarBoundary>& patches, const ScalarOptions& options, Convection scheme,
                  const ScalarScratch& scratch);
  /// With scratch memory of its own.
  ScalarTransport(std::string name, const FlowGeometry& geometry, const Boundaries& boundaries,
                  const std::vector<ScalarBoundary>& patches, const ScalarOptions& options,
                  Convection scheme);

  /// Uniform, as the options say.
  void set_values();
  /// A value per cell.
  void set_values(const HostArray<Real>& value);
  /// The balance begins, with the values at hand. `vapour`, here and below: the moisture, if the gas carries it.
  void initialise(const GasFields& fields, const ScalarTransport* vapour = nullptr);
  /// Advances by dt [s], from `fields` of the end of a gas step: void fraction and density old and new, mass fluxes and
  /// sources, flows of the boundary pieces; the vapour has been advanced before.
  /// Throws RunError if a solve does not converge or a value is not finite.
  ScalarReport update(const GasFields& fields, Real dt, const ScalarSource& source,
                      const ScalarTransport* vapour = nullptr);
  /// From here on update also keeps the flux through the faces, for what it carries.
  void keep_flux();

  /// Per cell: [K] or [kg/kg].
  const HostArray<Real>& value() const { return value_; }
  const ScalarBalance& balance() const { return balance_; }

  void save(core::CheckpointWriter& writer) const;
  void load(core::CheckpointReader& reader, const GasFields& fields, const ScalarTransport* vapour = nullptr);

 private:
  struct Bounds {
    Real low, high;
  };
  /// Value at a boundary face: fixed + free * value in the cell.
  struct FaceOfBoundary {
    Real fixed = 0, free = 0;
  };
  /// What a boundary piece does to its cell: (inflow + conductance) (given - own).
  struct PieceTerms {
    Real inflow = 0;       ///< capacity that comes in with the given value, per second
    Real conductance = 0;  ///< towards the given value
    Real given = 0;        ///< less the reference
  };

  void check(const std::vector<ScalarBoundary>& patches) const;
  PieceTerms piece_terms(const GasFields& fields, std::size_t b) const;
  bool vapour_matters(const ScalarTransport* vapour) const;
  void compute_content(const GasFields& fields, const ScalarTransport* vapour);
  void prepare_carrier(const GasFields& fields, const ScalarTransport* vapour);
  Real conductivity(const GasFields& fields, Index cell) const;
  Real half_conductance(const GasFields& fields, std::size_t b) const;
  Real layer_coefficient(const GasFields& fields, Index cell, const WallLayer& layer) const;
  void prepare(const GasFields& fields);
  void assemble(const GasFields& fields, Real dt, const ScalarSource& source);
  Real out_through(const PieceTerms& terms, std::size_t b) const;
  void set_boundary_values(const GasFields& fields);
  template <Convection scheme>
  void compute_correction();
  void compute_correction();
  void collect_right_side();
  template <class Take>
  void apply(const char* label, const Real* x, Take&& take) const;
  TransportReport solve(Real tolerance);
  Bounds find_bounds(const GasFields& fields, Real dt, const ScalarSource& source);
  int flag_cells_beyond(const Bounds& bounds);
  void drop_flagged_corrections();
  void stay_within_bounds(const Bounds& bounds, ScalarReport& report);
  void finish(const GasFields& fields, Real dt, const ScalarSource& source);
  void compute_flux(const GasFields& fields);
  void add_boundaries_to_balance(const GasFields& fields, Real dt);
  void add_leftover_to_balance(Real dt);
  void update_stock();
  void publish();

  std::string name_;
  const FlowGeometry& geometry_;
  const Boundaries& boundaries_;
  std::vector<ScalarBoundary> piece_conditions_;  ///< of each boundary piece
  ScalarOptions options_;
  Convection scheme_;

  HostArray<Real> value_, excess_, old_;  ///< excess: value less the reference, the unknown
  // What carries the value, with its own continuity: capacity of the gas.
  HostArray<Real> content_;        ///< of a cell, at the end of the step [J/K], [kg]
  std::vector<Real> carrier_out_;  ///< flux of it out through each boundary piece [J/K/s], [kg/s]
  FaceField flux_;  ///< of what is transported, through faces with two cells; empty unless it is kept
  std::vector<Real> flux_out_;  ///< likewise through each boundary piece

  std::array<std::vector<FaceOfBoundary>, 6> boundary_values_;  ///< per side and place, as Boundaries::values

  // Handles to what the scratch memory holds.
  FaceField carrier_, conductance_, correction_;
  std::array<HostArray<Real>, 6> near_;
  HostArray<Real> own_, base_, rhs_, storage_, content_old_, gain_;
  std::vector<char> flagged_;
  BiCGStab linear_solver_;
  ScalarBalance balance_;
  FixedSum sum_;
};

}  // namespace pellicle::cfd
