// The standard k-epsilon model: turbulent kinetic energy, its dissipation, the viscosity of the eddies, wall functions.
#pragma once

#include <vector>

#include "cfd/boundary.hpp"
#include "cfd/boundary_pieces.hpp"
#include "cfd/flow_geometry.hpp"
#include "cfd/gas_fields.hpp"
#include "cfd/gas_options.hpp"
#include "cfd/scalar_transport.hpp"
#include "cfd/turbulence_laws.hpp"

namespace pellicle::cfd {

/// Solves, after the momentum of a step (Launder & Spalding, Comput. Methods Appl. Mech. Eng. 3 (1974) 269; every term
/// with the void fraction),
/// d(eps rho k)/dt + div(eps rho u k) = div[eps (mu + mu_t/sigma_k) grad k] + eps (G - rho epsilon),
/// d(eps rho epsilon)/dt + div(eps rho u epsilon) = div[eps (mu + mu_t/sigma_e) grad epsilon]
///   + eps (C_1 G - C_2 rho epsilon) epsilon/k,   G = mu_t (2 S:S - 2/3 (div u)^2),   mu_t = C_mu rho k^2/epsilon.
/// What is taken away is implicit (Patankar 1980), so that both stay positive. docs/theory/turbulence.md.
class KEpsilon {
 public:
  /// Throws InputError for options out of range.
  KEpsilon(const FlowGeometry& geometry, const Boundaries& boundaries,
           const std::vector<BoundaryPatch>& patches, const GasOptions& options,
           const ScalarScratch& scratch);

  /// Initial k and epsilon, from the velocities in `fields` where the options do not say.
  void initialise(GasFields& fields);
  /// Once a step: viscosity of gas and eddies together, and the layers at walls.
  void prepare(GasFields& fields);
  /// Advances k and epsilon by dt [s] on the fluxes and velocities that the step ended with.
  ScalarReport update(GasFields& fields, Real dt);

  const HostArray<Real>& k() const { return k_.value(); }
  const HostArray<Real>& epsilon() const { return epsilon_.value(); }

  void save(core::CheckpointWriter& writer) const;
  void load(core::CheckpointReader& reader, GasFields& fields);

 private:
  /// A piece of a wall that the gas sticks to, and the cell beside it.
  struct WallPiece {
    Index cell = 0;
    std::size_t piece = 0;  ///< of the boundaries, or of the geometry's surfaces
    bool is_immersed = false;
    Real area = 0;      ///< [m2]
    Real distance = 0;  ///< from the wall to where the velocity is [m]
    /// The same, but not less than half a cell: the gas of a small cut cell goes along with its neighbour, and the log law
    /// holds for that one's distance [m].
    Real log_distance = 0;
    Vec3 normal;    ///< unit vector into the gas
    Vec3 velocity;  ///< of the wall [m/s]
  };

  void collect_walls();
  static const WallLayer& layer_of(const GasFields& fields, const WallPiece& wall);
  Real wall_stress(const GasFields& fields, const WallPiece& wall) const;
  void compute_production(const GasFields& fields);
  void apply_wall_functions(const GasFields& fields);
  void set_sources(const GasFields& fields, Real dt);
  void keep_above_floor();
  void compute_eddy_viscosity(const GasFields& fields) const;
  void compute_layers(GasFields& fields) const;

  const FlowGeometry& geometry_;
  const Boundaries& boundaries_;
  const GasOptions& options_;
  Real fastest_inlet_ = 0;  ///< [m/s]
  ScalarTransport k_, epsilon_;
  std::vector<WallPiece> walls_;      ///< in the order of cells
  HostArray<Real> production_;        ///< G [kg/m/s3]
  HostArray<Real> wall_dissipation_;  ///< of cells beside walls [m2/s3]; -1 elsewhere
  HostArray<Real> floored_;
  ScalarSource k_source_, epsilon_source_;
};

}  // namespace pellicle::cfd
