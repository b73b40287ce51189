#include "cfd/gas_scalars.hpp"

#include <fmt/format.h>

#include <string>
#include <variant>

#include "core/checkpoint.hpp"
#include "core/error.hpp"

namespace pellicle::cfd {

Real incoming_density(const BoundaryPatch& patch, const GasOptions& options) {
  if (options.density_law == DensityLaw::constant) return options.density;
  const auto value = [&](Scalar scalar) {
    const auto* known = std::get_if<GivenValue>(&patch.scalars[index_of(scalar)]);
    return known ? known->value : 0;
  };
  return ideal_gas_density(options.reference_pressure, value(Scalar::temperature), value(Scalar::moisture));
}

GasScalars::GasScalars(const FlowGeometry& geometry, const Boundaries& boundaries,
                       const std::vector<BoundaryPatch>& patches, const GasOptions& options,
                       const std::optional<ScalarScratch>& scratch)
    : geometry_(geometry), boundaries_(boundaries), options_(options) {
  check();
  for (std::size_t i = 0; i < scalar_count; ++i) {
    if (!options.scalars[i]) continue;
    std::vector<ScalarBoundary> conditions;
    conditions.reserve(patches.size());
    for (const BoundaryPatch& patch : patches) conditions.push_back(patch.scalars[i]);
    ScalarOptions own = *options.scalars[i];
    if (options.turbulence) {
      const bool heat = i == index_of(Scalar::temperature);
      own.turbulent_number = heat ? options.turbulence->prandtl_number : options.turbulence->schmidt_number;
    }
    transport_[i].emplace(std::string(scalar_names[i]), geometry, boundaries, conditions, own,
                          options.convection, scratch.value());
  }
  auto& moisture = transport_[index_of(Scalar::moisture)];
  const auto& heat = options.scalars[index_of(Scalar::temperature)];
  if (moisture && heat && heat->vapour_capacity) moisture->keep_flux();
  // A volume flow rate is at the inlet's own temperature and moisture.
  for (const BoundaryPiece& piece : boundaries.pieces) {
    auto& density = given_density_.emplace_back();
    if (piece.kind != PieceKind::inlet || !has_varying_density()) continue;
    if (piece.inward_speed() > 0) {
      density = incoming_density(patches[static_cast<std::size_t>(piece.patch)], options);
    }
  }
}

const ScalarTransport* GasScalars::vapour() const {
  const auto& moisture = transport_[index_of(Scalar::moisture)];
  return moisture ? &*moisture : nullptr;
}

void GasScalars::check() const {
  const bool warm = options_.scalars[index_of(Scalar::temperature)].has_value();
  const auto refuse = [](const char* what) { throw InputError(fmt::format("gas: {}", what)); };
  if (!warm && options_.density_law == DensityLaw::ideal_gas) {
    refuse(
        "the density of an ideal gas needs a temperature; allowed: a constant density, or solve for the "
        "heat");
  }
  if (!warm && options_.viscosity_law == ViscosityLaw::sutherland) {
    refuse("Sutherland's viscosity needs a temperature; allowed: a constant one, or solve for the heat");
  }
  if (!warm && options_.boussinesq) {
    refuse("buoyancy needs a temperature; allowed: leave it out, or solve for the heat");
  }
  if (options_.boussinesq && options_.density_law == DensityLaw::ideal_gas) {
    refuse("an ideal gas has its own buoyancy; allowed: Boussinesq's with a constant density");
  }
  if (options_.density_law == DensityLaw::ideal_gas && !boundaries_.has_outlet) {
    refuse(
        "an ideal gas at constant pressure needs an outlet to expand into; allowed: an outlet, or "
        "Boussinesq's "
        "buoyancy with a constant density");
  }
  if (!(options_.reference_pressure > 0)) refuse("the reference pressure is not positive; allowed: > 0 Pa");
  const auto& moisture = options_.scalars[index_of(Scalar::moisture)];
  if (moisture && moisture->reference != 0) refuse("moisture counts from 0; allowed: a reference of 0");
}

void GasScalars::initialise(GasFields& fields) {
  for (std::size_t i = 0; i < scalar_count; ++i) {
    if (transport_[i]) transport_[i]->set_values();
  }
  compute_density(fields);
  Kokkos::deep_copy(fields.density_old, fields.density);
  Kokkos::deep_copy(fields.mass_source, 0.0);
  compute_viscosity_and_buoyancy(fields);
  set_face_densities(fields);
  for (auto& scalar : transport_) {
    if (scalar) scalar->initialise(fields, vapour());  // their values are all set by now
  }
}

void GasScalars::prepare(GasFields& fields) {
  if (has_varying_density()) {
    Kokkos::deep_copy(fields.density_old, fields.density);
    compute_density(fields);
    set_face_densities(fields);
  }
  compute_viscosity_and_buoyancy(fields);
}

void GasScalars::compute_density(const GasFields& fields) const {
  if (!has_varying_density()) {
    Kokkos::deep_copy(fields.density, options_.density);
    return;
  }
  const auto& moisture = transport_[index_of(Scalar::moisture)];
  const Real* temperature = transport_[index_of(Scalar::temperature)]->value().data();
  const Real* vapour = moisture ? moisture->value().data() : nullptr;
  for_entries("cfd::gas_scalars::density", fields.cells, [&](Index c) {
    fields.density(c) =
        ideal_gas_density(options_.reference_pressure, temperature[c], vapour ? vapour[c] : 0);
  });
}

void GasScalars::compute_viscosity_and_buoyancy(const GasFields& fields) const {
  const auto& heat = transport_[index_of(Scalar::temperature)];
  if (options_.viscosity_law == ViscosityLaw::sutherland) {
    const Real* temperature = heat->value().data();
    for_entries("cfd::gas_scalars::viscosity", fields.cells,
                [&](Index c) { fields.molecular_viscosity(c) = sutherland_viscosity(temperature[c]); });
  } else {
    Kokkos::deep_copy(fields.molecular_viscosity, options_.viscosity);
  }
  if (has_varying_density()) {
    for_entries("cfd::gas_scalars::weight", fields.cells,
                [&](Index c) { fields.excess_density(c) = fields.density(c) - options_.density; });
  } else if (options_.boussinesq) {
    const Boussinesq& b = *options_.boussinesq;
    const Real* temperature = heat->value().data();
    for_entries("cfd::gas_scalars::boussinesq", fields.cells, [&](Index c) {
      fields.excess_density(c) = -options_.density * b.expansion * (temperature[c] - b.temperature);
    });
  }
}

void GasScalars::set_face_densities(GasFields& fields) const {
  const char* labels[] = {"cfd::gas_scalars::face_density_x", "cfd::gas_scalars::face_density_y",
                          "cfd::gas_scalars::face_density_z"};
  const Real* rho = fields.density.data();
  const Real* old = fields.density_old.data();
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for_faces(labels[a], geometry_.stencil, axis, [&](Index f, Index m, Index p, Index position, Index) {
      const Real w = geometry_.axis[a].linear_minus[static_cast<std::size_t>(position)];
      fields.face_density[a](f) = rho[p] + w * (rho[m] - rho[p]);
      fields.face_density_old[a](f) = old[p] + w * (old[m] - old[p]);
    });
    copy_periodic_faces(geometry_.stencil, axis, fields.face_density[a]);
    copy_periodic_faces(geometry_.stencil, axis, fields.face_density_old[a]);
  }
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    fields.piece_density[b] = given_density_[b].value_or(fields.density(boundaries_.pieces[b].cell));
  }
}

ScalarReport GasScalars::update(const GasFields& fields, Real dt,
                                const std::array<ScalarSource, scalar_count>& sources) {
  ScalarReport total;
  auto& moisture = transport_[index_of(Scalar::moisture)];
  auto& heat = transport_[index_of(Scalar::temperature)];
  const auto count = [&](const ScalarReport& report) {
    total.solves += report.solves;
    total.iterations += report.iterations;
    total.returned += report.returned;
  };
  if (moisture) count(moisture->update(fields, dt, sources[index_of(Scalar::moisture)]));
  if (heat) {
    count(heat->update(fields, dt, sources[index_of(Scalar::temperature)], vapour()));
  }
  return total;
}

void GasScalars::save(core::CheckpointWriter& writer, const GasFields& fields) const {
  if (has_varying_density()) writer.write("gas/density", fields.density);
  for (const auto& scalar : transport_) {
    if (scalar) scalar->save(writer);
  }
}

// Moisture first: the content of the temperature depends on it.
void GasScalars::load(core::CheckpointReader& reader, GasFields& fields) {
  if (has_varying_density()) reader.read_into("gas/density", fields.density);
  Kokkos::deep_copy(fields.density_old, fields.density);
  for (const Scalar scalar : {Scalar::moisture, Scalar::temperature}) {
    auto& transport = transport_[index_of(scalar)];
    if (transport) transport->load(reader, fields, vapour());
  }
  compute_viscosity_and_buoyancy(fields);
  set_face_densities(fields);
}

}  // namespace pellicle::cfd
