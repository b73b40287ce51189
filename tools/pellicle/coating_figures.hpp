// Film and coating of all particles together.
#pragma once

#include <string_view>

#include "tools/pellicle/particle_quantities.hpp"

namespace pellicle::tools {

struct CoatingFigures {
  Real mass = 0, mass_mean = 0;  ///< solids [kg]
  Real mass_variation = 0;       ///< standard deviation over mean; not a number without coating
  Real coated_share = 0;
  Real thickness_mean = 0;  ///< [m]
  Real thickness_variation = 0;
  Real liquid = 0;  ///< [kg]
  Real wet_share = 0;
  Real temperature_mean = 0;  ///< [K]
};

CoatingFigures compute_coating_figures(const HostParticles& particles);

/// Value of one of coating_quantities.
Real coating_quantity(std::string_view name, const CoatingFigures& coating);

}  // namespace pellicle::tools
