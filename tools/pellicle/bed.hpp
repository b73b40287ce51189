// The bed as a whole, in a few numbers.
#pragma once

#include <limits>
#include <string_view>

#include "core/types.hpp"
#include "tools/pellicle/gas_fields.hpp"
#include "tools/pellicle/particle_quantities.hpp"

namespace pellicle::tools {

/// What only the contact search knows; nan where it is not known.
struct ContactFigures {
  Real contacts_per_particle = std::numeric_limits<Real>::quiet_NaN();
  Real largest_overlap_ratio = std::numeric_limits<Real>::quiet_NaN();  ///< overlap / radius, since the start
};

/// One line of a bed probe; names and meaning as bed_quantities (output_fields.hpp).
struct BedFigures {
  Real bed_height = 0, mean_height = 0, mean_speed = 0, largest_speed = 0, kinetic_energy = 0, particles = 0,
       solids_volume = 0;
};

/// Heights are above `floor` [m], along z.
BedFigures compute_bed_figures(const HostParticles& particles, Real floor);

/// Value of the bed quantity of that name; nan if it needs gas and there is none.
Real bed_quantity(std::string_view name, const BedFigures& bed, const GasFields* gas,
                  const ContactFigures& contacts);

}  // namespace pellicle::tools
