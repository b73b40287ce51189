// Every choice a case file offers, as lists of names with what they mean; the lists of models are those of their folders.
#pragma once

#include <string_view>
#include <vector>

#include "core/model_list.hpp"

namespace pellicle::tools {

// In the order of their enumerations.
extern const core::ModelList axes;           ///< 0, 1, 2
extern const core::ModelList domain_sides;   ///< cfd::Side
extern const core::ModelList length_units;   ///< of meshes
extern const core::ModelList fill_patterns;  ///< dem::FillPattern

extern const core::ModelList normal_contact_models;
extern const core::ModelList tangential_contact_models;
extern const core::ModelList rolling_models;
extern const core::ModelList cohesion_models;
extern const core::ModelList drag_laws;
extern const core::ModelList depositions;
extern const core::ModelList transfer_laws;
extern const core::ModelList saturation_laws;
extern const core::ModelList spray_patterns;  ///< spray::SprayPattern

/// Quantities of lines: of particles, then of the gas. Quantities of probes also have those of the bed.
extern const core::ModelList line_quantities;
extern const core::ModelList probe_quantities;
extern const core::ModelList plane_probe_quantities;  // plane_quantities, then gas_quantities

/// One family as `pellicle models` shows it.
struct ModelFamily {
  std::string_view key;  ///< path in the case file
  std::string_view title;
  core::ModelList models;
};

/// All families, in the order of the case file.
const std::vector<ModelFamily>& model_families();
/// What outputs can show, of particles, of the gas, of the bed.
const std::vector<ModelFamily>& quantity_families();

}  // namespace pellicle::tools
