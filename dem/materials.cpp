#include "dem/materials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "dem/particles.hpp"

namespace pellicle::dem {
namespace {

using std::numbers::pi;

/// Restitution that a damping ratio gives when the force is clipped at zero (PHYSICS.md 3, [c]).
Real clipped_restitution(Real ratio) {
  if (ratio < 1) {
    const Real q = std::sqrt(1 - ratio * ratio);
    return std::exp(-(ratio / q) * (pi - std::atan2(2 * ratio * q, 1 - 2 * ratio * ratio)));
  }
  if (ratio == 1) return std::exp(-2.0);
  const Real q = std::sqrt(ratio * ratio - 1);
  return std::exp(-(ratio / q) * std::log((ratio + q) / (ratio - q)));
}

Real effective_youngs_modulus(const Material& a, const Material& b) {
  Real compliance = 0;
  if (!a.rigid) compliance += (1 - a.poisson_ratio * a.poisson_ratio) / a.youngs_modulus;
  if (!b.rigid) compliance += (1 - b.poisson_ratio * b.poisson_ratio) / b.youngs_modulus;
  return compliance > 0 ? 1 / compliance : 0;
}

Real effective_shear_modulus(const Material& a, const Material& b) {
  Real compliance = 0;
  if (!a.rigid) compliance += 2 * (2 - a.poisson_ratio) * (1 + a.poisson_ratio) / a.youngs_modulus;
  if (!b.rigid) compliance += 2 * (2 - b.poisson_ratio) * (1 + b.poisson_ratio) / b.youngs_modulus;
  return compliance > 0 ? 1 / compliance : 0;
}

Real sphere_mass(const Material& material, Real radius) { return material.density * sphere_volume(radius); }

}  // namespace

Real compute_damping_ratio(Real restitution, bool clip) {
  if (!(restitution > 0) || restitution > 1) {
    throw std::invalid_argument("restitution must be in (0, 1]");
  }
  if (restitution == 1) return 0;
  if (!clip) {
    const Real l = std::log(restitution);
    return -l / std::sqrt(l * l + pi * pi);
  }
  // The closed form falls monotonically from 1 at Λ = 0; bisect to the last bit.
  Real low = 0;
  Real high = 1;
  while (clipped_restitution(high) > restitution) high *= 2;
  for (int step = 0; step < 200; ++step) {
    const Real middle = 0.5 * (low + high);
    (clipped_restitution(middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<PairParameters> make_pair_table(const std::vector<Material>& materials,
                                            const std::vector<PairProperties>& pairs, bool clip) {
  const auto n = materials.size();
  std::vector<PairParameters> table(n * n);
  std::vector<bool> given(n * n, false);
  for (const auto& pair : pairs) {
    const auto a = static_cast<std::size_t>(pair.material_a);
    const auto b = static_cast<std::size_t>(pair.material_b);
    if (a >= n || b >= n) throw std::invalid_argument("contact pair names a material that does not exist");
    if (given[a * n + b]) {
      throw std::invalid_argument("contact pair between " + materials[a].name + " and " + materials[b].name +
                                  " is given twice");
    }
    PairParameters p;
    p.effective_youngs_modulus = effective_youngs_modulus(materials[a], materials[b]);
    p.effective_shear_modulus = effective_shear_modulus(materials[a], materials[b]);
    p.damping_ratio = compute_damping_ratio(pair.restitution, clip);
    if (p.effective_youngs_modulus > 0) {
      p.tangential_stiffness_ratio = 4 * p.effective_shear_modulus / p.effective_youngs_modulus;
      p.tangential_damping_ratio = 2 * std::sqrt(p.tangential_stiffness_ratio);
    }
    p.sliding_friction = pair.sliding_friction;
    p.rolling_friction = pair.rolling_friction;
    p.normal_stiffness = pair.normal_stiffness;
    table[a * n + b] = table[b * n + a] = p;
    given[a * n + b] = given[b * n + a] = true;
  }
  return table;
}

void require_pairs(const std::vector<Material>& materials, const std::vector<PairProperties>& pairs,
                   const std::vector<bool>& of_particles, const std::vector<bool>& of_walls) {
  const auto listed = [&pairs](std::size_t a, std::size_t b) {
    return std::any_of(pairs.begin(), pairs.end(), [a, b](const PairProperties& p) {
      const auto first = static_cast<std::size_t>(p.material_a);
      const auto second = static_cast<std::size_t>(p.material_b);
      return (first == a && second == b) || (first == b && second == a);
    });
  };
  for (std::size_t a = 0; a < materials.size(); ++a) {
    for (std::size_t b = 0; b < materials.size(); ++b) {
      if (of_particles[a] && (of_particles[b] || of_walls[b]) && !listed(a, b)) {
        throw std::invalid_argument("no contact pair between " + materials[a].name + " and " +
                                    materials[b].name);
      }
    }
  }
}

void require_stiffness(const std::vector<Material>& materials, const std::vector<PairProperties>& pairs) {
  for (const PairProperties& pair : pairs) {
    if (pair.normal_stiffness > 0) continue;
    throw std::invalid_argument(
        "the linear contact between " + materials.at(static_cast<std::size_t>(pair.material_a)).name +
        " and " + materials.at(static_cast<std::size_t>(pair.material_b)).name + " has no normal stiffness");
  }
}

Real compute_linear_stiffness(const Material& a, const RadiusRange& radii_a, const Material& b,
                              const RadiusRange& radii_b, Real largest_overlap, Real speed) {
  if (!radii_a.any()) {
    return radii_b.any() ? compute_linear_stiffness(b, radii_b, a, radii_a, largest_overlap, speed) : 0;
  }
  // The worst pair may lie inside the ranges (0.79 : 1 for equal densities), where m*/R² is flat: a few radii will do.
  constexpr int steps = 20;
  const auto radius = [](const RadiusRange& range, int i) {
    return range.smallest + (range.largest - range.smallest) * i / steps;
  };
  Real stiffness = 0;
  for (int i = 0; i <= steps; ++i) {
    const Real ra = radius(radii_a, i);
    const Real ma = sphere_mass(a, ra);
    for (int j = 0; j <= (radii_b.any() ? steps : 0); ++j) {
      const Real rb = radius(radii_b, j);
      const Real mb = sphere_mass(b, rb);
      const Real reduced_mass = radii_b.any() ? ma * mb / (ma + mb) : ma;
      const Real overlap = largest_overlap * (radii_b.any() ? std::min(ra, rb) : ra);
      stiffness = std::max(stiffness, reduced_mass * speed * speed / (overlap * overlap));
    }
  }
  return stiffness;
}

TimeStepBound compute_linear_time_step_bound(const std::vector<Material>& materials,
                                             const std::vector<PairProperties>& pairs,
                                             const std::vector<Real>& smallest_radius) {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  TimeStepBound result{infinity, infinity, infinity};
  const auto inverse_mass = [&](int material) {
    const auto m = static_cast<std::size_t>(material);
    const Real radius = m < smallest_radius.size() ? smallest_radius[m] : 0;
    return radius > 0 && radius < infinity ? 1 / sphere_mass(materials[m], radius) : 0;
  };
  for (const PairProperties& pair : pairs) {
    const Real inverse = inverse_mass(pair.material_a) + inverse_mass(pair.material_b);
    if (inverse == 0) continue;
    result.contact_time = std::min(result.contact_time, pi / std::sqrt(pair.normal_stiffness * inverse));
  }
  result.bound = result.contact_time / 20;
  return result;
}

TimeStepBound compute_time_step_bound(const std::vector<Material>& materials,
                                      const std::vector<Real>& smallest_radius, Real impact_speed) {
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  TimeStepBound result{infinity, infinity, infinity};
  const auto has_particles = [&](std::size_t m) {
    return m < smallest_radius.size() && smallest_radius[m] > 0 && smallest_radius[m] < infinity;
  };
  for (std::size_t a = 0; a < materials.size(); ++a) {
    if (!has_particles(a) || materials[a].rigid) continue;
    const Real radius = smallest_radius[a];
    const Real nu = materials[a].poisson_ratio;
    const Real shear_modulus = materials[a].youngs_modulus / (2 * (1 + nu));
    result.rayleigh_time =
        std::min(result.rayleigh_time,
                 pi * radius * std::sqrt(materials[a].density / shear_modulus) / (0.1631 * nu + 0.8766));
    const Real mass = sphere_mass(materials[a], radius);
    for (std::size_t b = 0; b < materials.size(); ++b) {
      const Real modulus = effective_youngs_modulus(materials[a], materials[b]);
      // A wall of material b: R* = R, m* = m. Particles of b: the reduced ones.
      Real reduced_radius = radius;
      Real reduced_mass = mass;
      if (has_particles(b)) {
        const Real other = smallest_radius[b];
        const Real other_mass = sphere_mass(materials[b], other);
        reduced_radius = radius * other / (radius + other);
        reduced_mass = mass * other_mass / (mass + other_mass);
      }
      // Hertz contact time; PHYSICS.md 3.
      const Real contact_time =
          2.87 *
          std::pow(reduced_mass * reduced_mass / (reduced_radius * modulus * modulus * impact_speed), 0.2);
      result.contact_time = std::min(result.contact_time, contact_time);
    }
  }
  result.bound = std::min(0.2 * result.rayleigh_time, result.contact_time / 20);
  return result;
}

}  // namespace pellicle::dem
