#include "tools/pellicle/bed.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace pellicle::tools {

BedFigures compute_bed_figures(const HostParticles& particles, Real floor) {
  BedFigures bed;
  const std::size_t n = particles.count();
  bed.particles = static_cast<Real>(n);
  if (n == 0) return bed;
  std::vector<Real> heights(n);
  Real mass = 0;
  for (std::size_t p = 0; p < n; ++p) {
    const auto& place = particles.position_radius[p];
    const Vec3 velocity = particles.velocity_spin[p].velocity();
    const Real speed = norm(velocity);
    heights[p] = place.z - floor;
    mass += particles.mass[p];
    bed.mean_height += particles.mass[p] * heights[p];
    bed.mean_speed += speed;
    bed.largest_speed = std::max(bed.largest_speed, speed);
    bed.kinetic_energy += 0.5 * particles.mass[p] * norm_squared(velocity);
    bed.solids_volume += dem::sphere_volume(place.radius);
  }
  bed.mean_height /= mass;
  bed.mean_speed /= static_cast<Real>(n);
  // The lowest height with at least 99 % of the centres at or below it.
  const std::size_t rank = (99 * n + 99) / 100 - 1;
  std::nth_element(heights.begin(), heights.begin() + static_cast<std::ptrdiff_t>(rank), heights.end());
  bed.bed_height = heights[rank];
  return bed;
}

Real bed_quantity(std::string_view name, const BedFigures& bed, const GasFields* gas,
                  const ContactFigures& contacts) {
  if (name == "bed_height") return bed.bed_height;
  if (name == "mean_height") return bed.mean_height;
  if (name == "mean_speed") return bed.mean_speed;
  if (name == "largest_speed") return bed.largest_speed;
  if (name == "kinetic_energy") return bed.kinetic_energy;
  if (name == "particles") return bed.particles;
  if (name == "solids_volume") return bed.solids_volume;
  if (name == "contacts_per_particle") return contacts.contacts_per_particle;
  if (name == "largest_overlap") return contacts.largest_overlap_ratio;
  if (name == "pressure_drop") return gas != nullptr ? pressure_drop(*gas) : std::nan("");
  if (name == "gas_kinetic_energy") return gas != nullptr ? gas_kinetic_energy(*gas) : std::nan("");
  throw std::logic_error("no bed quantity " + std::string(name));
}

}  // namespace pellicle::tools
