// How many particles a case has, how large they are, and what step they allow.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.hpp"
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

Real mean_particle_volume(const PopulationSpec& population) {
  if (!population.sizes) return sphere_volume(population.diameter);
  return dem::SizeSampler(*population.sizes->distribution()).mean_volume();
}

std::int64_t count_fill(const CaseSpec& spec, std::size_t index) {
  const PopulationSpec& population = spec.particles[index];
  if (population.count) return *population.count;
  const bool by_mass = population.total_mass.has_value();
  const Real density = spec.materials[static_cast<std::size_t>(population.material)].density;
  const Real volume = by_mass
                          ? *population.total_mass / density
                          : *population.fill->solids_fraction * dem::region_volume(population.fill->region());
  const Real expected = volume / mean_particle_volume(population);
  if (!population.sizes) return whole_number(by_mass ? std::round(expected) : std::floor(expected));
  if (expected > std::numeric_limits<Index>::max()) return whole_number(expected);  // refused later
  const dem::SizeSampler sizes(*population.sizes->distribution());
  Real filled = 0;
  for (std::int64_t id = 0;; ++id) {
    const Real next = sphere_volume(draw_diameter(spec, index, sizes, id));
    if (filled + next > volume) {
      const bool nearer = filled + next - volume < volume - filled;
      return by_mass && nearer ? id + 1 : id;
    }
    filled += next;
  }
}

Real draw_diameter(const CaseSpec& spec, std::size_t index, const dem::SizeSampler& sizes, std::int64_t id) {
  return sizes.diameter(
      core::random_uniform(spec.seed, core::Purpose::diameter, static_cast<std::int64_t>(index), id));
}

std::vector<Real> draw_radii(const CaseSpec& spec, std::size_t index) {
  const PopulationSpec& population = spec.particles[index];
  std::vector<Real> radii(static_cast<std::size_t>(population.filled), 0.5 * population.diameter);
  if (!population.sizes) return radii;
  const dem::SizeSampler sizes(*population.sizes->distribution());
  for (std::size_t p = 0; p < radii.size(); ++p) {
    radii[p] = 0.5 * draw_diameter(spec, index, sizes, static_cast<std::int64_t>(p));
  }
  return radii;
}

std::int64_t particle_count(const PopulationSpec& population) {
  return population.fill ? population.filled : static_cast<std::int64_t>(population.list.size());
}

std::int64_t particle_count(const CaseSpec& spec) {
  std::int64_t count = 0;
  for (const auto& population : spec.particles) count += particle_count(population);
  return count;
}

DiameterRange diameter_range(const PopulationSpec& population) {
  DiameterRange range;
  const auto add = [&](Real smallest, Real largest) {
    range.smallest = range.smallest == 0 ? smallest : std::min(range.smallest, smallest);
    range.largest = std::max(range.largest, largest);
  };
  if (population.sizes) {
    const dem::SizeSampler sizes(*population.sizes->distribution());
    add(sizes.smallest(), sizes.largest());
  } else if (population.fill) {
    add(population.diameter, population.diameter);
  }
  for (const auto& particle : population.list) add(particle.diameter, particle.diameter);
  return range;
}

DiameterRange diameter_range(const CaseSpec& spec) {
  DiameterRange range;
  for (const auto& population : spec.particles) {
    const DiameterRange own = diameter_range(population);
    range.smallest = range.smallest == 0 ? own.smallest : std::min(range.smallest, own.smallest);
    range.largest = std::max(range.largest, own.largest);
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
      if (population.material == material_a) count += particle_count(population);
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
    smallest = std::min(smallest, diameter_range(population).smallest / 2);
  }
  const auto bound = dem::compute_time_step_bound(materials, smallest_radius, spec.time.impact_speed);
  return {bound.bound, bound.rayleigh_time, bound.contact_time};
}

}  // namespace pellicle::tools
