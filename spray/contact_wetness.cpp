#include "spray/contact_wetness.hpp"

#include "dem/cell_grid.hpp"
#include "dem/wall_candidates.hpp"
#include "dem/wall_list.hpp"
#include "spray/region_identity.hpp"

namespace pellicle::spray {
namespace {

constexpr Real pi = 3.14159265358979323846;

/// Bins of one region and what falls into them.
struct Bins {
  ZoneShape shape;
  WetnessMeasure measure;
  Real wet_bins_per_unit, speed_bins_per_unit;
  Index bins, speed_bins;
  std::int64_t weight;  ///< that one contact counts
  DeviceArray<std::int64_t> counts;

  KOKKOS_INLINE_FUNCTION Real wetness(const heat::Film& film, Real radius) const {
    if (!(film.liquid > 0)) return 0;
    if (measure == WetnessMeasure::liquid_fraction) return film.liquid / (film.liquid + film.solids);
    return film.liquid / (4 * pi * radius * radius);
  }
  /// Whole numbers: the same whatever the order.
  KOKKOS_INLINE_FUNCTION void add(Real wetness, Real speed) const {
    const Index row = wetness > 0 ? 1 + bin_of(wetness * wet_bins_per_unit, bins) : 0;
    const Index column = bin_of(speed * speed_bins_per_unit, speed_bins);
    Kokkos::atomic_add(&counts(row * (speed_bins + 1) + column), weight);
  }

 private:
  KOKKOS_INLINE_FUNCTION static Index bin_of(Real place, Index bins) {
    return place < static_cast<Real>(bins) ? static_cast<Index>(place) : bins;
  }
};

/// A particle and where it was a substep ago.
struct Moved {
  dem::Particles particles;
  DeviceArray<heat::Film> film;
  Real step;  ///< [s]

  /// The velocity [m/s] that took it from its last place to this one: that half a substep ago. See dem::MotionKernel.
  KOKKOS_INLINE_FUNCTION Vec3 velocity(Index p) const {
    const dem::VelocitySpin& motion = particles.velocity_spin(p);
    if (motion.inverse_mass == 0) return {0, 0, 0};
    return motion.velocity() - (0.5 * step) * convert<Real>(particles.acceleration(p));
  }
};

template <bool Repeats>
struct CountPairs {
  Bins bins;
  Moved moved;
  dem::CellGrid cells;
  DeviceArray<std::int32_t> cell_start, order;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    const dem::PositionRadius self = moved.particles.position_radius(p);
    if (!bins.shape.contains(self.position(), self.radius)) return;  // nor is any point of contact
    const std::int32_t id = moved.particles.velocity_spin(p).id;
    const Vec3 velocity = moved.velocity(p);
    dem::visit_runs<Repeats>(cells, cell_start, self, [&](std::int32_t begin, std::int32_t end) {
      for (std::int32_t slot = begin; slot < end; ++slot) {
        const Index q = order(slot);
        const dem::PositionRadius other = moved.particles.position_radius(q);
        Vec3 apart = self.position() - other.position();
        if (Repeats) apart = cells.domain.shortest(apart);
        const Real sum = self.radius + other.radius;
        const Real squared = norm_squared(apart);
        if (squared >= sum * sum || moved.particles.velocity_spin(q).id <= id) continue;
        const Vec3 relative = velocity - moved.velocity(q);
        if (norm_squared(apart - moved.step * relative) < sum * sum) continue;  // it began earlier
        const Real distance = Kokkos::sqrt(squared);
        const Vec3 normal = distance > 0 ? (1 / distance) * apart : Vec3{0, 0, 1};
        const Real overlap = sum - distance;
        if (!bins.shape.contains(self.position() - (self.radius - 0.5 * overlap) * normal)) continue;
        const Real wetness =
            Kokkos::max(bins.wetness(moved.film(p), self.radius), bins.wetness(moved.film(q), other.radius));
        bins.add(wetness, Kokkos::max(-dot(relative, normal), Real(0)));
      }
    });
  }
};

/// Of each particle near walls, the places where it touches them.
struct CountWalls {
  Bins bins;
  Moved moved;
  dem::WallGeometry walls;
  dem::WallList list;

  KOKKOS_INLINE_FUNCTION void operator()(const Index k) const {
    const Index p = list.particle(k);
    const dem::PositionRadius self = moved.particles.position_radius(p);
    if (!bins.shape.contains(self.position(), self.radius)) return;
    dem::WallCandidates candidates;
    const std::int32_t end = list.offset(k + 1);
    for (std::int32_t slot = list.offset(k); slot < end; ++slot) {
      const std::int32_t s = list.surface(slot);
      const dem::ClosestPoint at = walls.closest(s, self.position());
      if (at.distance < self.radius) candidates.insert({at, s, walls.wall_of(s)});
    }
    candidates.select(walls, self.radius);
    const Vec3 velocity = moved.velocity(p);
    for (int i = 0; i < candidates.count(); ++i) {
      const dem::ClosestPoint& at = candidates[i].at;
      const Vec3 relative = velocity - walls.pose(candidates[i].wall).velocity_at(at.point, at.towards);
      // Where it was as the wall sees it.
      const Vec3 before = self.position() - moved.step * relative;
      if (walls.closest(candidates[i].surface, before).distance < self.radius) continue;
      if (!bins.shape.contains(at.point)) continue;
      bins.add(bins.wetness(moved.film(p), self.radius), Kokkos::max(dot(relative, at.towards), Real(0)));
    }
  }
};

std::vector<std::int64_t> to_host(const DeviceArray<std::int64_t>& counts) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, counts);
  return {host.data(), host.data() + host.extent(0)};
}

std::string path_of(const WetnessOptions& options, const char* what) {
  return "wetness/" + options.name + "/" + what;
}

}  // namespace

ContactWetness::ContactWetness(const WetnessOptions& options)
    : options_(options),
      pairs_("spray::contact_wetness::pairs",
             static_cast<std::size_t>(options.bins + 2) * static_cast<std::size_t>(options.speed_bins + 1)),
      walls_("spray::contact_wetness::walls", pairs_.extent(0)) {}

void ContactWetness::count(int k, int substeps, const dem::Engine& engine,
                           const DeviceArray<heat::Film>& film) {
  const dem::Particles& particles = engine.particles();
  if (particles.count == 0 || (k != 0 && !options_.every_substep)) return;
  Bins bins{options_.shape,
            options_.measure,
            options_.bins / options_.wettest,
            options_.speed_bins / options_.fastest,
            options_.bins,
            options_.speed_bins,
            options_.every_substep ? 1 : substeps,
            pairs_};
  const Moved moved{particles, film, engine.setup().time_step};
  const dem::NeighbourSearch& search = *engine.search();
  const DeviceRange all(0, particles.count);
  if (engine.setup().domain.repeats()) {
    Kokkos::parallel_for("spray::contact_wetness::count_pairs_periodic", all,
                         CountPairs<true>{bins, moved, search.grid(), search.cell_start(), search.order()});
  } else {
    Kokkos::parallel_for("spray::contact_wetness::count_pairs", all,
                         CountPairs<false>{bins, moved, search.grid(), search.cell_start(), search.order()});
  }
  const dem::WallSystem& walls = engine.walls();
  if (walls.list().count == 0) return;
  bins.counts = walls_;
  Kokkos::parallel_for("spray::contact_wetness::count_walls", DeviceRange(0, walls.list().count),
                       CountWalls{bins, moved, walls.geometry(), walls.list()});
}

WetnessCounts ContactWetness::counts() const {
  return {options_.bins + 2, options_.speed_bins + 1, to_host(pairs_), to_host(walls_)};
}

void ContactWetness::save(core::CheckpointWriter& file) const {
  file.write(path_of(options_, "is"), identity_of(options_));
  file.write(path_of(options_, "pairs"), to_host(pairs_));
  file.write(path_of(options_, "walls"), to_host(walls_));
}

void ContactWetness::load(const core::CheckpointReader& file) {
  if (!goes_on(file, path_of(options_, "is"), identity_of(options_), "wetness of " + options_.name)) return;
  for (const auto& [what, counts] : {std::pair("pairs", pairs_), std::pair("walls", walls_)}) {
    const auto host = Kokkos::create_mirror_view(counts);
    file.read_into(path_of(options_, what), host);
    Kokkos::deep_copy(counts, host);
  }
}

}  // namespace pellicle::spray
