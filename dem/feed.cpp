#include "dem/feed.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/random.hpp"
#include "dem/engine_arrays.hpp"
#include "dem/particles.hpp"

namespace pellicle::dem {
namespace {

/// Random places that a particle tries in an outer step before it waits for the next.
constexpr std::uint32_t attempts = 200;
/// Places that are looked at before the run: particles do not enter at this step.
constexpr std::int64_t no_step = -1;

/// Indices of the particles that reach into a box around `centre`, in the order of memory.
Index find_near(const Particles& particles, const Domain& domain, const Vec3& centre, const Vec3& half,
                const DeviceArray<PositionRadius>& found) {
  const auto place = particles.position_radius;
  Index count = 0;
  Kokkos::parallel_scan(
      "dem::feed::find_near", DeviceRange(0, particles.count),
      KOKKOS_LAMBDA(const Index p, Index& rank, const bool final) {
        const PositionRadius sphere = place(p);
        const Vec3 d = domain.shortest(sphere.position() - centre);
        bool near = true;
        for (int axis = 0; axis < 3; ++axis) {
          near = near && Kokkos::abs(d[axis]) <= half[axis] + sphere.radius;
        }
        if (!near) return;
        if (final && rank < static_cast<Index>(found.extent(0))) found(rank) = sphere;
        ++rank;
      },
      count);
  return count;
}

}  // namespace

Feed::Feed(const FeedSetup& setup) : setup_(setup) {
  if (const auto* distribution = std::get_if<SizeDistribution>(&setup_.diameter))
    sizes_.emplace(*distribution);
}

void Feed::keep_clear_of(const std::vector<Wall>& walls) {
  constexpr std::uint32_t samples = 512;
  obstacles_ = Obstacles(walls);
  std::vector<Vec3> points;
  for (std::uint32_t n = 0; n < samples; ++n) points.push_back(place(0, no_step, n));
  obstacles_.choose_sides(points);
}

std::optional<std::int32_t> Feed::wall_without_room() {
  constexpr std::uint32_t samples = 2000;
  std::map<std::int32_t, int> in_the_way;
  const Real radius = (1 - 1e-6) * largest_radius();
  const Real duration = std::min(setup_.to - setup_.from, obstacles_.longest_period());
  for (std::uint32_t n = 0; n < samples; ++n) {
    // Multiples of the golden ratio spread times evenly, whatever their number.
    if (duration > 0) obstacles_.move_to(setup_.from + std::fmod(std::numbers::phi * n, 1.0) * duration);
    const auto overlap = obstacles_.deepest(place(largest_radius(), no_step, n), radius);
    if (!overlap) return std::nullopt;
    ++in_the_way[overlap->wall];
  }
  return std::max_element(in_the_way.begin(), in_the_way.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

Real Feed::smallest_radius() const {
  return 0.5 * (sizes_ ? sizes_->smallest() : std::get<Real>(setup_.diameter));
}
Real Feed::largest_radius() const {
  return 0.5 * (sizes_ ? sizes_->largest() : std::get<Real>(setup_.diameter));
}

std::int64_t Feed::expected_particles() const {
  const Real volume = sizes_ ? sizes_->mean_volume() : sphere_volume(0.5 * std::get<Real>(setup_.diameter));
  const Real each = setup_.by_count ? 1 : setup_.density * volume;
  return static_cast<std::int64_t>(std::min(1e9, due(setup_.to) / each));
}

Real Feed::next_diameter() const {
  if (!sizes_) return std::get<Real>(setup_.diameter);
  return sizes_->diameter(core::random_uniform(setup_.seed, core::Purpose::diameter, setup_.stream, fed_, 1));
}

Real Feed::amount(Real diameter) const {
  return setup_.by_count ? 1 : setup_.density * sphere_volume(0.5 * diameter);
}

Real Feed::due(Real time) const {
  return setup_.rate * std::max(Real{0}, std::min(time, setup_.to) - setup_.from);
}

bool Feed::is_due(Real time) const {
  // Sums of rounded masses and products of rounded times may differ in the last bits where they should be equal.
  return amount_ + amount(next_diameter()) <= due(time) * (1 + 1e-12);
}

Real Feed::waiting(Real time) const {
  return std::max(Real{0}, due(time) - amount_ - amount(next_diameter()));
}

Box Feed::reach() const {
  const Real radius = largest_radius();
  const auto* const disc = std::get_if<DiscRegion>(&setup_.region);
  Box box = disc != nullptr ? region_bounds(*disc) : std::get<Box>(setup_.region);
  for (int a = 0; a < 3; ++a) {
    box.min[a] -= radius;
    box.max[a] += radius;
  }
  return box;
}

Vec3 Feed::place(Real radius, std::int64_t step, std::uint32_t attempt) const {
  const Vec3 share = core::random_uniform3(setup_.seed + static_cast<std::uint64_t>(setup_.stream),
                                           core::Purpose::feed_position, step, fed_, attempt);
  if (const auto* box = std::get_if<Box>(&setup_.region)) {
    Vec3 x;
    for (int a = 0; a < 3; ++a) {
      const Real width = box->max[a] - box->min[a];
      const Real margin = std::min(radius, 0.5 * width);
      x[a] = box->min[a] + margin + share[a] * (width - 2 * margin);
    }
    return x;
  }
  const auto& disc = std::get<DiscRegion>(setup_.region);
  const Vec3 first = perpendicular_to(disc.normal);
  const Vec3 second = cross(disc.normal, first);
  const Real out = std::max(Real{0}, disc.radius - radius) * std::sqrt(share.x);
  const Real angle = 2 * std::numbers::pi * share.y;
  return disc.centre + (out * std::cos(angle)) * first + (out * std::sin(angle)) * second;
}

std::vector<ParticleSeed> Feed::draw(Real time, std::int64_t step, const std::vector<PlacedSphere>& near,
                                     Real wall_time) {
  obstacles_.move_to(wall_time);
  std::vector<ParticleSeed> entering;
  std::vector<PlacedSphere> taken = near;
  while (is_due(time)) {
    const Real diameter = next_diameter();
    const Real radius = 0.5 * diameter;
    const auto is_free = [&](const Vec3& x) {
      return obstacles_.clear(x, radius) &&
             std::all_of(taken.begin(), taken.end(), [&](const PlacedSphere& other) {
               const Real reach = radius + other.radius;
               return norm_squared(setup_.domain.shortest(other.position - x)) >= reach * reach;
             });
    };
    std::uint32_t attempt = 0;
    Vec3 x = place(radius, step, attempt);
    while (!is_free(x) && ++attempt < attempts) x = place(radius, step, attempt);
    if (attempt == attempts) break;
    taken.push_back({x, radius});
    ParticleSeed particle = setup_.particle;
    particle.position = x;
    particle.radius = radius;
    entering.push_back(particle);
    ++fed_;
    amount_ += amount(diameter);
    mass_ += setup_.density * sphere_volume(0.5 * diameter);
  }
  return entering;
}

void Feed::save(core::CheckpointWriter& file, const std::string& name) const {
  file.write(name + "/fed", fed_);
  file.write(name + "/amount", amount_);
  file.write(name + "/mass", mass_);
}

void Feed::load(const core::CheckpointReader& file, const std::string& name) {
  fed_ = file.read_int64(name + "/fed");
  amount_ = file.read_double(name + "/amount");
  mass_ = file.read_double(name + "/mass");
}

std::vector<PlacedSphere> spheres_near(const Engine& engine, const Box& box) {
  const Particles& particles = engine.particles();
  const Vec3 centre = 0.5 * (box.min + box.max), half = 0.5 * (box.max - box.min);
  std::vector<PlacedSphere> spheres;
  if (particles.count == 0) return spheres;
  const Domain& domain = engine.setup().domain;
  const Index count = find_near(particles, domain, centre, half, {});
  if (count == 0) return spheres;
  const auto found = make_array<PositionRadius>("dem::feed::near", static_cast<std::size_t>(count));
  find_near(particles, domain, centre, half, found);
  const auto host = host_copy(found, count);
  for (Index p = 0; p < count; ++p) spheres.push_back({host(p).position(), host(p).radius});
  return spheres;
}

}  // namespace pellicle::dem
