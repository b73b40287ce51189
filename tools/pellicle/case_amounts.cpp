// How many particles a case has, how large they are, and what step they allow.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "dem/cohesion.hpp"
#include "dem/fill.hpp"
#include "dem/materials.hpp"
#include "dem/neighbour_list.hpp"
#include "dem/particles.hpp"
#include "tools/pellicle/case_checks.hpp"

namespace pellicle::tools {

namespace {

/// Beyond what an index can count nothing is exact any more.
std::int64_t whole_number(Real value) { return static_cast<std::int64_t>(std::min(value, 1e18)); }

}  // namespace

Real mean_particle_volume(const PopulationSpec& population) {
  if (!population.sizes) return dem::sphere_volume(0.5 * population.diameter);
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
    const Real next = dem::sphere_volume(0.5 * draw_diameter(spec, index, sizes, id));
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

std::int64_t fed_count(const CaseSpec& spec, const PopulationSpec& population) {
  if (!population.feed) return 0;
  const FeedSpec& feed = *population.feed;
  const Real density = spec.materials[static_cast<std::size_t>(population.material)].density;
  const Real rate = feed.rate ? *feed.rate : *feed.mass_rate / (density * mean_particle_volume(population));
  return whole_number(std::ceil(rate * std::max(Real{0}, feed.to - feed.from)));
}

std::int64_t fed_count(const CaseSpec& spec) {
  std::int64_t count = 0;
  for (const auto& population : spec.particles) count += fed_count(spec, population);
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
  } else if (population.fill || population.feed) {
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
  const DiameterRange diameters = diameter_range(spec);
  const Real bridge =
      spec.contacts.cohesion ? dem::bridge_reach(spec.contacts.cohesion->willett, diameters.smallest / 2) : 0;
  return 2 * diameters.largest * (1 + dem::SkinOptions{}.largest_fraction) + 4 * bridge;
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
      if (population.material == material_a)
        count += particle_count(population) + fed_count(spec, population);
    }
    return count > 1 || (count == 1 && of_walls(material_a));
  }
  return (of_particles(material_a) && (of_particles(material_b) || of_walls(material_b))) ||
         (of_particles(material_b) && of_walls(material_a));
}

std::vector<dem::Material> make_materials(const CaseSpec& spec, bool true_moduli) {
  std::vector<dem::Material> materials;
  for (const auto& m : spec.materials) {
    const Real modulus = true_moduli ? m.true_youngs_modulus.value_or(m.youngs_modulus) : m.youngs_modulus;
    materials.push_back({m.name, m.density, modulus, m.poisson_ratio, m.rigid});
  }
  return materials;
}

std::vector<dem::PairProperties> make_pairs(const CaseSpec& spec) {
  const auto materials = make_materials(spec);
  std::vector<dem::RadiusRange> radii(materials.size());
  for (const auto& population : spec.particles) {
    dem::RadiusRange& range = radii[static_cast<std::size_t>(population.material)];
    const DiameterRange own = diameter_range(population);
    range.smallest = range.any() ? std::min(range.smallest, own.smallest / 2) : own.smallest / 2;
    range.largest = std::max(range.largest, own.largest / 2);
  }
  std::vector<dem::PairProperties> pairs;
  for (const PairSpec& p : spec.contacts.pairs) {
    Real stiffness = p.normal_stiffness.value_or(0);
    if (stiffness == 0 && spec.contacts.linear) {
      const auto a = static_cast<std::size_t>(p.material_a);
      const auto b = static_cast<std::size_t>(p.material_b);
      stiffness =
          dem::compute_linear_stiffness(materials[a], radii[a], materials[b], radii[b],
                                        spec.contacts.linear->largest_overlap, spec.contacts.linear->speed);
      if (stiffness == 0) stiffness = 1;  // neither has particles
    }
    pairs.push_back(
        {p.material_a, p.material_b, p.restitution, p.sliding_friction, p.rolling_friction, stiffness});
  }
  const int count = static_cast<int>(materials.size());
  for (int a = 0; a < count; ++a) {
    for (int b = a; b < count; ++b) {
      const bool given = std::any_of(
          spec.contacts.pairs.begin(), spec.contacts.pairs.end(),
          [&](const PairSpec& p) { return std::minmax(p.material_a, p.material_b) == std::minmax(a, b); });
      if (!given && !can_meet(spec, a, b)) pairs.push_back({a, b, 1, 0, 0, 1});
    }
  }
  return pairs;
}

dem::TimeStepBound particle_step_bound(const CaseSpec& spec, bool true_moduli) {
  const auto materials = make_materials(spec, true_moduli);
  std::vector<Real> smallest_radius(materials.size(), std::numeric_limits<Real>::infinity());
  for (const auto& population : spec.particles) {
    Real& smallest = smallest_radius[static_cast<std::size_t>(population.material)];
    smallest = std::min(smallest, diameter_range(population).smallest / 2);
  }
  if (spec.contacts.linear) {
    return dem::compute_linear_time_step_bound(materials, make_pairs(spec), smallest_radius);
  }
  return dem::compute_time_step_bound(materials, smallest_radius, spec.time.impact_speed);
}

std::string describe_bound(const CaseSpec& spec, const dem::TimeStepBound& bound) {
  if (spec.contacts.linear) {
    return fmt::format("a twentieth of the contact time {:.3g} s of the linear springs", bound.contact_time);
  }
  return fmt::format(
      "a fifth of the Rayleigh time {:.3g} s, a twentieth of the contact time {:.3g} s at {:g} m/s",
      bound.rayleigh_time, bound.contact_time, spec.time.impact_speed);
}

}  // namespace pellicle::tools
