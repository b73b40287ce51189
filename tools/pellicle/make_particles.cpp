// The particles of a case: lists, and fills of regions.
#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/key_reader.hpp"
#include "core/log.hpp"
#include "dem/fill.hpp"
#include "dem/obstacles.hpp"
#include "dem/particles.hpp"
#include "tools/pellicle/build_case.hpp"
#include "tools/pellicle/case_checks.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {
namespace {

[[noreturn]] void refuse(const FillSpec& fill, const std::vector<Real>& radii, std::size_t fit) {
  Real volume = 0;
  for (const Real r : radii) volume += dem::sphere_volume(r);
  throw InputError(
      fmt::format("{}: {} particles do not fit{} with pattern {} (the solids fraction would be {:.3g}); a "
                  "larger region, or "
                  "fewer particles (wide regions take up to 0.60 with random, 0.52 with lattice, 0.74 with "
                  "hexagonal; narrow "
                  "ones, and those with walls or particles in them, take less)",
                  fill.where, radii.size(), fit > 0 ? fmt::format(", only {} do", fit) : "",
                  fill_patterns[static_cast<std::size_t>(fill.pattern)].name,
                  volume / dem::region_volume(fill.region())));
}

/// Places the fills of a case one region after the other.
class Filler {
 public:
  Filler(const CaseSpec& spec, const dem::Obstacles& obstacles, const std::vector<dem::ParticleSeed>& listed)
      : spec_(spec),
        obstacles_(obstacles),
        seed_(spec.seed),
        centres_(spec.particles.size()),
        radii_(spec.particles.size()) {
    for (const auto& p : listed) placed_.push_back({p.position, p.radius});
  }

  /// Places a population, and those that mix with it, unless that was done with an earlier one.
  void place(std::size_t population) {
    if (!radii_[population].empty()) return;
    const FillSpec& fill = *spec_.particles[population].fill;
    std::vector<std::size_t> together;
    std::vector<Real> radii;
    for (std::size_t i = population; i < spec_.particles.size(); ++i) {
      const auto& other = spec_.particles[i].fill;
      if (i != population && !(other && other->mixes_with(fill))) continue;
      together.push_back(i);
      radii_[i] = draw_radii(spec_, i);
      radii.insert(radii.end(), radii_[i].begin(), radii_[i].end());
    }
    const auto centres = dem::fill_region(fill.region(), fill.pattern, radii, seed_++, placed_,
                                          fill_is_fixed(population) ? dem::Obstacles() : obstacles_);
    if (centres.size() < radii.size()) refuse(fill, radii, centres.size());
    auto next = centres.begin();
    for (const std::size_t i : together) {
      const auto end = next + static_cast<std::ptrdiff_t>(radii_[i].size());
      centres_[i].assign(next, end);
      next = end;
    }
    for (std::size_t p = 0; p < radii.size(); ++p) placed_.push_back({centres[p], radii[p]});
  }

  void append(std::size_t population, std::vector<dem::ParticleSeed>& particles) const {
    const PopulationSpec& p = spec_.particles[population];
    for (std::size_t i = 0; i < radii_[population].size(); ++i) {
      particles.push_back(
          {centres_[population][i], p.velocity, p.spin, radii_[population][i], p.material, p.fixed});
    }
  }

 private:
  /// Fixed particles may stand in walls.
  bool fill_is_fixed(std::size_t population) const { return spec_.particles[population].fixed; }

  const CaseSpec& spec_;
  const dem::Obstacles& obstacles_;
  std::uint64_t seed_;
  std::vector<dem::PlacedSphere> placed_;
  std::vector<std::vector<Vec3>> centres_;
  std::vector<std::vector<Real>> radii_;
};

/// A listed particle that starts further inside a wall than this share of its radius would be shot out of it.
constexpr Real deepest_start = 0.1;

std::string text(const Vec3& v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); }

/// Names listed particles that start inside walls; fills keep clear of walls by themselves.
void check_listed(const CaseSpec& spec, const std::vector<dem::Wall>& walls,
                  const dem::Obstacles& obstacles) {
  core::InputProblems problems;
  int id = 0;
  for (std::size_t population = 0; population < spec.particles.size(); ++population) {
    const auto& list = spec.particles[population].list;
    for (std::size_t i = 0; i < list.size(); ++i, ++id) {
      const ListedParticleSpec& p = list[i];
      const auto overlap = p.fixed ? std::nullopt : obstacles.deepest(p.position, 0.5 * p.diameter);
      if (!overlap || overlap->depth <= 1e-3 * p.diameter) continue;
      const std::string where = spec.where(fmt::format("particles.{}.list.{}.position", population, i));
      const std::string what = fmt::format(
          "particle {} of radius {:.4g} m at {} m starts {:.4g} m inside the wall {}", id, 0.5 * p.diameter,
          text(p.position), overlap->depth, walls[static_cast<std::size_t>(overlap->wall)].name);
      if (overlap->depth > std::min(deepest_start, spec.contacts.overlap_limit) * 0.5 * p.diameter) {
        problems.add(where, what + "; a place at least its radius away from every wall");
      } else {
        core::log().warn("{}: {}", where, what);
      }
    }
  }
  problems.throw_if_any();
}

/// Warns of particles that a closed mesh parts from most of the others.
void check_closed_meshes(const std::vector<dem::ParticleSeed>& particles, const std::vector<dem::Wall>& walls,
                         const dem::Obstacles& obstacles) {
  for (const std::int32_t wall : obstacles.closed_meshes()) {
    std::vector<bool> within(particles.size());
    std::size_t inside = 0, all = 0, first = 0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      if (particles[p].fixed) continue;
      within[p] = obstacles.encloses(wall, particles[p].position);
      inside += within[p] ? 1 : 0;
      ++all;
    }
    const std::size_t few = std::min(inside, all - inside);
    if (few == 0 || 2 * few == all) continue;
    const bool few_inside = few == inside;
    while (particles[first].fixed || within[first] != few_inside) ++first;
    core::log().warn(
        "wall {}: {} of {} particles start {} its closed surface and the others on its other side; the first "
        "is "
        "particle {} of radius {:.4g} m at {} m",
        walls[static_cast<std::size_t>(wall)].name, few, all, few_inside ? "within" : "outside", first,
        particles[first].radius, text(particles[first].position));
  }
}

}  // namespace

std::vector<dem::ParticleSeed> make_particles(const CaseSpec& spec, const std::vector<dem::Wall>& walls) {
  const dem::Obstacles obstacles(walls);
  check_listed(spec, walls, obstacles);
  std::vector<dem::ParticleSeed> particles;
  // Listed particles first, so that fills keep clear of them; ids follow this order.
  for (const PopulationSpec& population : spec.particles) {
    for (const ListedParticleSpec& p : population.list) {
      particles.push_back({p.position, p.velocity, p.spin, 0.5 * p.diameter, population.material, p.fixed});
    }
  }
  Filler filler(spec, obstacles, particles);
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    if (spec.particles[i].fill) filler.place(i);
  }
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    if (spec.particles[i].fill) filler.append(i, particles);
  }
  check_closed_meshes(particles, walls, obstacles);
  return particles;
}

std::vector<dem::Feed> make_feeds(const CaseSpec& spec, const dem::EngineSetup& engine) {
  core::InputProblems problems;
  std::vector<dem::Feed> feeds;
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    const PopulationSpec& population = spec.particles[i];
    if (!population.feed) continue;
    const FeedSpec& feed = *population.feed;
    dem::FeedSetup setup;
    if (feed.box) setup.region = *feed.box;
    if (feed.disc) setup.region = *feed.disc;
    setup.domain = engine.domain;
    setup.from = feed.from;
    setup.to = feed.to;
    setup.by_count = feed.rate.has_value();
    setup.rate = feed.rate ? *feed.rate : *feed.mass_rate;
    setup.density = spec.materials[static_cast<std::size_t>(population.material)].density;
    setup.diameter = population.diameter;
    if (population.sizes) setup.diameter = *population.sizes->distribution();
    setup.particle = {{}, population.velocity, population.spin, 0, population.material, false};
    setup.seed = spec.seed;
    setup.stream = static_cast<std::int64_t>(i);
    feeds.emplace_back(setup);
    feeds.back().keep_clear_of(engine.walls);
    if (const auto wall = feeds.back().wall_without_room()) {
      problems.add(feed.where,
                   fmt::format("the wall {} leaves no room for a particle of {:.4g} m, the largest of this "
                               "feed; a {} where spheres of that size are clear of walls",
                               engine.walls[static_cast<std::size_t>(*wall)].name,
                               2 * feeds.back().largest_radius(), feed.box ? "box" : "disc"));
    }
  }
  problems.throw_if_any();
  return feeds;
}

}  // namespace pellicle::tools
