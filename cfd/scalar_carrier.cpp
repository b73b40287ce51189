// What carries a scalar: mass for the moisture, heat capacity for the temperature, each with its own continuity.
#include "cfd/scalar_transport.hpp"

namespace pellicle::cfd {

void ScalarTransport::keep_flux() {
  flux_ = make_face_field(geometry_.stencil, "cfd::scalar_transport::flux");
  flux_out_.assign(boundaries_.pieces.size(), 0);
}

bool ScalarTransport::vapour_matters(const ScalarTransport* vapour) const {
  return vapour != nullptr && options_.vapour_capacity.has_value();
}

void ScalarTransport::compute_content(const GasFields& fields, const ScalarTransport* vapour) {
  const Real more = vapour_matters(vapour) ? *options_.vapour_capacity - options_.capacity : 0;
  const Real* moisture = vapour_matters(vapour) ? vapour->value_.data() : nullptr;
  for_entries("cfd::scalar_transport::content", geometry_.stencil.cells(), [&](Index c) {
    const Real mass = fields.density(c) * fields.void_fraction(c) * geometry_.volume(c);
    content_(c) = mass * (options_.capacity + (moisture ? more * moisture[c] : 0));
  });
}

// Dry gas and vapour carry their own heat: the flux of heat capacity is c_gas (j - j_vapour) + c_vapour j_vapour.
void ScalarTransport::prepare_carrier(const GasFields& fields, const ScalarTransport* vapour) {
  const bool moist = vapour_matters(vapour);
  const Real capacity = options_.capacity;
  const Real more = moist ? *options_.vapour_capacity - capacity : 0;
  const Real brought = moist ? *options_.vapour_capacity : capacity;
  for_entries("cfd::scalar_transport::content_old", geometry_.stencil.cells(), [&](Index c) {
    const Real volume = geometry_.volume(c);
    const Real mass = fields.density_old(c) * fields.void_fraction_old(c) * volume;
    content_old_(c) = mass * (capacity + (moist ? more * vapour->old_(c) : 0));
    gain_(c) = brought * fields.mass_source(c) * volume;
  });
  compute_content(fields, vapour);
  const char* labels[] = {"cfd::scalar_transport::carrier_x", "cfd::scalar_transport::carrier_y",
                          "cfd::scalar_transport::carrier_z"};
  for (std::size_t a = 0; a < 3; ++a) {
    const Real* mass = fields.mass_flux[a].data();
    for_entries(labels[a], geometry_.stencil.faces(static_cast<int>(a)), [&](Index f) {
      carrier_[a](f) = capacity * mass[f] + (moist ? more * vapour->flux_[a](f) : 0);
    });
  }
  for (std::size_t b = 0; b < carrier_out_.size(); ++b) {
    carrier_out_[b] =
        capacity * fields.piece_density[b] * fields.piece_flow[b] + (moist ? more * vapour->flux_out_[b] : 0);
  }
}

// Of vapour, whose reference is 0.
void ScalarTransport::compute_flux(const GasFields& fields) {
  const char* labels[] = {"cfd::scalar_transport::flux_x", "cfd::scalar_transport::flux_y",
                          "cfd::scalar_transport::flux_z"};
  const Real* v = excess_.data();
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    for_faces(labels[a], geometry_.stencil, axis, [&](Index f, Index m, Index p, Index, Index) {
      const Real along = carrier_[a](f);
      flux_[a](f) =
          along * (along >= 0 ? v[m] : v[p]) + correction_[a](f) - conductance_[a](f) * (v[p] - v[m]);
    });
    copy_periodic_faces(geometry_.stencil, axis, flux_[a]);
  }
  for (std::size_t b = 0; b < boundaries_.pieces.size(); ++b) {
    const PieceTerms terms = piece_terms(fields, b);
    flux_out_[b] = out_through(terms, b);
  }
}

}  // namespace pellicle::cfd
