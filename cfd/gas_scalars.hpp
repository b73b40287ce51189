// Temperature and moisture of the gas, and what of the gas depends on them: density, viscosity, buoyancy.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cfd/boundary.hpp"
#include "cfd/scalar_transport.hpp"

namespace pellicle::cfd {

/// Density of the gas that an inlet brings [kg/m3].
Real incoming_density(const BoundaryPatch& patch, const GasOptions& options);

class GasScalars {
 public:
  /// `scratch`: needed where options have scalars. Throws InputError for laws that need a temperature where none is solved, and as ScalarTransport does.
  GasScalars(const FlowGeometry& geometry, const Boundaries& boundaries,
             const std::vector<BoundaryPatch>& patches, const GasOptions& options,
             const std::optional<ScalarScratch>& scratch);

  /// Initial values; density and viscosity follow.
  void initialise(GasFields& fields);
  /// Once a step: the density at its end, from temperature and moisture at its start, the viscosity, and the weight
  /// that buoyancy acts with.
  void prepare(GasFields& fields);
  /// Advances moisture, then temperature, on the fluxes that the gas step ended with.
  ScalarReport update(const GasFields& fields, Real dt,
                      const std::array<ScalarSource, scalar_count>& sources);

  const std::optional<ScalarTransport>& operator[](Scalar scalar) const {
    return transport_[index_of(scalar)];
  }
  bool has_varying_density() const { return options_.density_law != DensityLaw::constant; }

  void save(core::CheckpointWriter& writer, const GasFields& fields) const;
  void load(core::CheckpointReader& reader, GasFields& fields);

 private:
  void check() const;
  const ScalarTransport* vapour() const;
  void compute_density(const GasFields& fields) const;
  void compute_viscosity_and_buoyancy(const GasFields& fields) const;
  void set_face_densities(GasFields& fields) const;

  const FlowGeometry& geometry_;
  const Boundaries& boundaries_;
  const GasOptions& options_;
  std::array<std::optional<ScalarTransport>, scalar_count> transport_;
  std::vector<std::optional<Real>> given_density_;  ///< of what each boundary piece lets in; none: the cell's
};

}  // namespace pellicle::cfd
