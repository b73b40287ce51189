// What a case chooses about turbulence.
#pragma once

#include <optional>

#include "core/model_list.hpp"
#include "core/types.hpp"

namespace pellicle::cfd {

enum class Turbulence { none, k_epsilon };

/// Names of the case file, in the order of the enum.
inline constexpr core::ModelInfo turbulence_models[] = {
    {"none", "the viscosity of the gas alone", "-"},
    {"k_epsilon", "standard k-epsilon model with wall functions, void fraction in its equations",
     "Launder & Spalding 1974"},
};

struct KEpsilonOptions {
  std::optional<Real> initial_k{};  ///< [m2/s2]; default: 5 % of the largest of initial and inlet velocity
  std::optional<Real> initial_epsilon{};  ///< [m2/s3]; default: ten times the viscosity of the gas
  Real prandtl_number = 0.9;              ///< turbulent: eddy viscosity over eddy diffusivity of heat
  Real schmidt_number = 0.7;              ///< turbulent: likewise of vapour
  Real largest_viscosity_ratio = 1e5;     ///< eddy viscosity over that of the gas, at most
};

/// Turbulence of the gas that an inlet brings.
struct InletTurbulence {
  Real intensity = 0.05;  ///< root mean square of a velocity component over the inlet velocity
  std::optional<Real>
      length_scale{};  ///< of the eddies [m]; default: 0.07 diameters of a disc of the inlet's area
};

}  // namespace pellicle::cfd
