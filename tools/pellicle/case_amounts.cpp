// How many particles a case has, how large they are, and what step they allow.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/fill.hpp"
#include "dem/materials.hpp"
#include "dem/neighbour_list.hpp"
#include "tools/pellicle/case_checks.hpp"

namespace pellicle::tools {

namespace {

Real sphere_volume(Real diameter) { return std::numbers::pi / 6 * diameter * diameter * diameter; }

/// Beyond what an index can count nothing is exact any more.
std::int64_t whole_number(Real value) { return static_cast<std::int64_t>(std::min(value, 1e18)); }

}  // namespace

Real region_volume(const FillSpec& fill) {
  if (fill.box) return dem::region_volume(*fill.box);
  return dem::region_volume(
      dem::CylinderRegion{fill.cylinder->from, fill.cylinder->to, fill.cylinder->radius});
}

std::int64_t particle_count(const CaseSpec& spec, const PopulationSpec& population) {
  if (!population.fill) return static_cast<std::int64_t>(population.list.size());
  if (population.count) return *population.count;
  const Real volume = sphere_volume(population.diameter);
  if (population.total_mass) {
    const Real density = spec.materials[static_cast<std::size_t>(population.material)].density;
    return whole_number(std::round(*population.total_mass / (density * volume)));
  }
  return whole_number(
      std::floor(*population.fill->solids_fraction * region_volume(*population.fill) / volume));
}

std::int64_t particle_count(const CaseSpec& spec) {
  std::int64_t count = 0;
  for (const auto& population : spec.particles) count += particle_count(spec, population);
  return count;
}

DiameterRange diameter_range(const CaseSpec& spec) {
  DiameterRange range;
  const auto add = [&](Real diameter) {
    range.smallest = range.smallest == 0 ? diameter : std::min(range.smallest, diameter);
    range.largest = std::max(range.largest, diameter);
  };
  for (const auto& population : spec.particles) {
    if (population.fill) add(population.diameter);
    for (const auto& particle : population.list) add(particle.diameter);
  }
  return range;
}

Real least_periodic_width(const CaseSpec& spec) {
  return 2 * diameter_range(spec).largest * (1 + dem::SkinOptions{}.largest_fraction);
}

bool can_meet(const CaseSpec& spec, int material_a, int material_b) {
  const auto of_particles = [&](int material) {
    return std::any_of(spec.particles.begin(), spec.particles.end(),
                       [&](const PopulationSpec& p) { return p.material == material; });
  };
  const auto of_walls = [&](int material) {
    return std::any_of(spec.walls.begin(), spec.walls.end(),
                       [&](const WallSpec& w) { return w.material == material; });
  };
  if (material_a == material_b) {
    std::int64_t count = 0;
    for (const auto& population : spec.particles) {
      if (population.material == material_a) count += particle_count(spec, population);
    }
    return count > 1 || (count == 1 && of_walls(material_a));
  }
  return (of_particles(material_a) && (of_particles(material_b) || of_walls(material_b))) ||
         (of_particles(material_b) && of_walls(material_a));
}

StepBound particle_step_bound(const CaseSpec& spec) {
  std::vector<dem::Material> materials;
  for (const auto& m : spec.materials) {
    materials.push_back({m.name, m.density, m.youngs_modulus, m.poisson_ratio, m.rigid});
  }
  std::vector<Real> smallest_radius(materials.size(), std::numeric_limits<Real>::infinity());
  for (const auto& population : spec.particles) {
    Real& smallest = smallest_radius[static_cast<std::size_t>(population.material)];
    if (population.fill) smallest = std::min(smallest, population.diameter / 2);
    for (const auto& particle : population.list) smallest = std::min(smallest, particle.diameter / 2);
  }
  const auto bound = dem::compute_time_step_bound(materials, smallest_radius, spec.time.impact_speed);
  return {bound.bound, bound.rayleigh_time, bound.contact_time};
}

}  // namespace pellicle::tools
