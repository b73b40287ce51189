// The particles of a case: lists, and fills of regions.
#include <fmt/format.h>

#include "core/error.hpp"
#include "dem/fill.hpp"
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
                  "ones, and what is there already, take less)",
                  fill.where, radii.size(), fit > 0 ? fmt::format(", only {} do", fit) : "",
                  fill_patterns[static_cast<std::size_t>(fill.pattern)].name,
                  volume / dem::region_volume(fill.region())));
}

/// Places the fills of a case one region after the other.
class Filler {
 public:
  Filler(const CaseSpec& spec, const std::vector<dem::ParticleSeed>& listed)
      : spec_(spec), seed_(spec.seed), centres_(spec.particles.size()), radii_(spec.particles.size()) {
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
    const auto centres = dem::fill_region(fill.region(), fill.pattern, radii, seed_++, placed_);
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
  const CaseSpec& spec_;
  std::uint64_t seed_;
  std::vector<dem::PlacedSphere> placed_;
  std::vector<std::vector<Vec3>> centres_;
  std::vector<std::vector<Real>> radii_;
};

}  // namespace

std::vector<dem::ParticleSeed> make_particles(const CaseSpec& spec) {
  std::vector<dem::ParticleSeed> particles;
  // Listed particles first, so that fills keep clear of them; ids follow this order.
  for (const PopulationSpec& population : spec.particles) {
    for (const ListedParticleSpec& p : population.list) {
      particles.push_back({p.position, p.velocity, p.spin, 0.5 * p.diameter, population.material, p.fixed});
    }
  }
  Filler filler(spec, particles);
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    if (spec.particles[i].fill) filler.place(i);
  }
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    if (spec.particles[i].fill) filler.append(i, particles);
  }
  return particles;
}

std::vector<dem::Feed> make_feeds(const CaseSpec& spec, const dem::Domain& domain) {
  std::vector<dem::Feed> feeds;
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    const PopulationSpec& population = spec.particles[i];
    if (!population.feed) continue;
    const FeedSpec& feed = *population.feed;
    dem::FeedSetup setup;
    if (feed.box) setup.region = *feed.box;
    if (feed.disc) setup.region = *feed.disc;
    setup.domain = domain;
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
  }
  return feeds;
}

}  // namespace pellicle::tools
