// Impacts of single spheres on a floor or on each other, many side by side in one engine.
#pragma once

#include <cmath>
#include <vector>

#include "tests/dem/bed.hpp"

namespace pellicle::tests {

/// An elastic solid.
struct Solid {
  Real youngs_modulus, poisson_ratio, density;
};

/// E of a rigid floor against this solid, 1/E* = (1 − ν²)/E.
inline Real wall_modulus(const Solid& s) {
  return s.youngs_modulus / (1 - s.poisson_ratio * s.poisson_ratio);
}

inline Real sphere_mass(const Solid& s, Real radius) {
  return s.density * 4.0 / 3.0 * M_PI * radius * radius * radius;
}

/// Elastic normal impact, closed form (Hertz 1882): ½ m* v² = (8/15) E* √R* δ^(5/2).
struct HertzImpact {
  Real reduced_mass, modulus, reduced_radius, speed;

  Real overlap() const {
    return std::pow(15 * reduced_mass * speed * speed / (16 * modulus * std::sqrt(reduced_radius)), 0.4);
  }
  Real force(Real overlap) const {
    return 4.0 / 3.0 * modulus * std::sqrt(reduced_radius) * std::pow(overlap, 1.5);
  }
  /// 2 δ/v ∫ dx/√(1 − x^(5/2)) = 2.943275 δ/v.
  Real contact_time() const { return 2.943275 * overlap() / speed; }
};

/// What meets what.
enum class Partner { floor, equal_sphere };

struct ImpactSeries {
  Solid solid;
  Real radius;
  Partner partner = Partner::floor;
  Real restitution = 1;
  Real sliding_friction = 0;
  dem::ContactOptions laws{};
  Real steps_per_contact = 1000;  ///< Δt = contact time of the elastic impact at the largest speed over this

  HertzImpact hertz(Real speed) const {
    const Real share = partner == Partner::floor ? 1 : 0.5;
    return {share * sphere_mass(solid, radius), share * wall_modulus(solid), share * radius, speed};
  }
};

/// Of the sphere before or after; the floor's normal is +z. With a partner sphere (below, at −z) that one moves with
/// −velocity, and with a spin of its own.
struct ImpactState {
  Vec3 velocity, spin, partner_spin;
};

/// Lets each sphere hit its partner and returns the states after all contacts have ended. Where `partner` is a sphere,
/// velocities are relative to nothing: partner spheres start with the opposite velocity.
inline std::vector<ImpactState> run_impacts(const ImpactSeries& series,
                                            const std::vector<ImpactState>& before) {
  Real fastest = 0, slowest = 1e30;
  const bool pair = series.partner == Partner::equal_sphere;
  for (const ImpactState& s : before) {
    const Real speed = -s.velocity.z * (pair ? 2 : 1);
    fastest = std::max(fastest, speed);
    slowest = std::min(slowest, speed);
  }
  const Real r = series.radius;
  const Real step = series.hertz(fastest).contact_time() / series.steps_per_contact;
  const Real pitch = 8 * r;
  const auto count = static_cast<Real>(before.size());
  dem::EngineSetup setup;
  setup.domain.box = {{0, 0, 0}, {pitch * (count + 1), pitch, pitch}};
  const Solid& s = series.solid;
  setup.materials = {{"solid", s.density, s.youngs_modulus, s.poisson_ratio, false},
                     {"floor", 0, 0, 0, true}};
  setup.pairs = {{0, 0, series.restitution, series.sliding_friction, 0},
                 {0, 1, series.restitution, series.sliding_friction, 0}};
  setup.contacts = series.laws;
  setup.contacts.overlap_limit = 1;
  setup.time_step = step;
  if (!pair) setup.walls = {dem::PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 1}};
  std::vector<dem::ParticleSeed> seeds;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const ImpactState& b = before[i];
    const Real x = pitch * (static_cast<Real>(i) + 1);
    const Real gap = 1.5 * fastest * step;
    if (pair) {
      seeds.push_back({{x, pitch / 2, pitch / 2 + r + gap / 2}, b.velocity, b.spin, r, 0, false});
      seeds.push_back({{x, pitch / 2, pitch / 2 - r - gap / 2}, -b.velocity, b.partner_spin, r, 0, false});
    } else {
      seeds.push_back({{x, pitch / 2, r + gap}, b.velocity, b.spin, r, 0, false});
    }
  }
  dem::Engine engine(setup);
  engine.set_particles(seeds);
  // Until even the slowest has met its partner and nothing has touched since.
  const auto least = static_cast<int>(3 * fastest / slowest);
  for (int k = 0;; k += 10) {
    advance(engine, 10);
    const auto report = engine.collect_report();
    if (k > least && report.touching_pairs + report.touching_walls == 0) break;
    if (k > 40 * series.steps_per_contact) {
      ADD_FAILURE() << "still in contact";
      break;
    }
  }
  const auto all = grains(engine.particles());
  std::vector<ImpactState> after;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Grain& g = all[pair ? 2 * i : i];
    after.push_back({g.velocity, g.spin, pair ? all[2 * i + 1].spin : Vec3{}});
  }
  return after;
}

}  // namespace pellicle::tests
