#include "heat/contact_conduction.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "core/to_device.hpp"
#include "dem/wall_candidates.hpp"

namespace pellicle::heat {
namespace {

/// Parts of the list of particles near walls, whose heat is summed for each wall; fixed, so that the sums do not depend on
/// threads.
constexpr Index wall_parts = 64;

/// More parts of a step than this make no sense: a gas step is then far too long for such particles.
constexpr int most_parts = 10000;

/// Heat capacities, and how many particles are fixed.
struct FindCapacities {
  dem::Particles particles;
  DeviceArray<Real> material_capacity;
  DeviceArray<Film> film;
  HeatCapacities capacities;
  DeviceArray<Real> capacity;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Index& fixed) const {
    const dem::VelocitySpin& motion = particles.velocity_spin(p);
    const Film f = film(p);
    capacity(p) = particles.mass(p) * material_capacity(motion.material) + f.liquid * capacities.liquid +
                  f.solids * capacities.solids;
    if (motion.inverse_mass == 0) ++fixed;
  }
};

/// What every contact of two particles conducts.
struct PairConductance {
  dem::Particles particles;
  dem::Domain domain;
  DeviceArray<Real> per_radius;
  Index materials;
  DeviceArray<Real> temperature, capacity;
  Real step;

  /// From q to p; the same from both sides but for the sign, to the last bit.
  KOKKOS_INLINE_FUNCTION Conducted operator()(Index p, Index q) const {
    const dem::PositionRadius a = particles.position_radius(p);
    const dem::PositionRadius b = particles.position_radius(q);
    const Real square = norm_squared(domain.shortest(b.position() - a.position()));
    const Real sum = a.radius + b.radius;
    if (!(square < sum * sum)) return {};
    const Index of_p = particles.velocity_spin(p).material, of_q = particles.velocity_spin(q).material;
    const Real overlap = sum - Kokkos::sqrt(square);
    const Real conductance =
        per_radius(of_p * materials + of_q) * contact_radius(a.radius * b.radius / sum, overlap);
    const Real c_p = capacity(p), c_q = capacity(q);
    const Real heat = conducted_heat(conductance, c_p * c_q / (c_p + c_q), step);
    return {heat * (temperature(q) - temperature(p)), heat, conductance * step};
  }
};

KOKKOS_INLINE_FUNCTION void add(Conducted& sum, const Conducted& of_pair, Real sign) {
  sum.heat += sign * of_pair.heat;
  sum.bound += of_pair.bound;
  sum.linear += of_pair.linear;
}

/// Over the neighbour list. A work item is what nobody else writes to: a block of particles of a half list, where a pair
/// within the block stands once; a particle of a full list.
struct ConductPairs {
  PairConductance pair;
  dem::NeighbourList list;
  DeviceArray<Conducted> flow;

  KOKKOS_INLINE_FUNCTION Index block_size() const { return list.half ? dem::list_block : 1; }
  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index begin = block * block_size();
    const Index end = Kokkos::min(begin + block_size(), list.count);
    for (Index p = begin; p < end; ++p) flow(p) = Conducted{};
    for (Index p = begin; p < end; ++p) {
      Conducted sum = flow(p);
      for (std::int32_t slot = list.offset(p); slot < list.offset(p + 1); ++slot) {
        const Index q = list.partner(slot);
        const Conducted got = pair(p, q);
        if (!(got.linear > 0)) continue;
        add(sum, got, 1);
        if (list.half && q >= begin && q < end) add(flow(q), got, -1);
      }
      flow(p) = sum;
    }
  }
};

/// Half lists have no pairs of two fixed particles, which DEM does not need: found by their cells.
template <bool Repeats>
struct ConductFixedPairs {
  PairConductance pair;
  dem::CellGrid cells;
  DeviceArray<std::int32_t> cell_start, order;
  DeviceArray<Conducted> flow;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    if (pair.particles.velocity_spin(p).inverse_mass != 0) return;
    Conducted sum = flow(p);
    dem::visit_runs<Repeats>(cells, cell_start, pair.particles.position_radius(p),
                             [&](std::int32_t begin, std::int32_t end) {
                               for (std::int32_t slot = begin; slot < end; ++slot) {
                                 const Index q = order(slot);
                                 if (q == p || pair.particles.velocity_spin(q).inverse_mass != 0) continue;
                                 add(sum, pair(p, q), 1);
                               }
                             });
    flow(p) = sum;
  }
};

/// Over the list of particles near walls.
struct ConductWalls {
  dem::Particles particles;
  dem::WallList list;
  dem::WallGeometry walls;
  DeviceArray<Real> per_radius;
  Index materials, wall_count;
  DeviceArray<Real> wall_temperature, temperature, capacity;
  Real step;
  DeviceArray<Conducted> flow;
  DeviceArray<Real> wall_heat;

  KOKKOS_INLINE_FUNCTION void operator()(const Index part) const {
    for (Index w = 0; w < wall_count; ++w) wall_heat(part * wall_count + w) = 0;
    const std::int64_t count = list.count;
    const auto begin = static_cast<Index>(part * count / wall_parts);
    const auto end = static_cast<Index>((part + 1) * count / wall_parts);
    for (Index k = begin; k < end; ++k) conduct(k, part);
  }

  KOKKOS_INLINE_FUNCTION void conduct(Index k, Index part) const {
    const Index p = list.particle(k);
    const dem::PositionRadius self = particles.position_radius(p);
    dem::WallCandidates touched;
    for (std::int32_t slot = list.offset(k); slot < list.offset(k + 1); ++slot) {
      const std::int32_t s = list.surface(slot);
      const dem::ClosestPoint at = walls.closest(s, self.position());
      if (at.distance < self.radius) touched.insert({at, s, walls.wall_of(s)});
    }
    if (touched.count() == 0) return;
    touched.select(walls, self.radius);
    const Index material = particles.velocity_spin(p).material;
    Conducted sum = flow(p);
    for (int i = 0; i < touched.count(); ++i) {
      const Index w = touched[i].wall;
      if (wall_temperature(w) < 0) continue;
      const Real conductance = per_radius(material * materials + walls.body(w).material) *
                               contact_radius(self.radius, self.radius - touched[i].at.distance);
      const Real heat = conducted_heat(conductance, capacity(p), step);
      const Conducted got{heat * (wall_temperature(w) - temperature(p)), heat, conductance * step};
      add(sum, got, 1);
      wall_heat(part * wall_count + w) -= got.heat;
    }
    flow(p) = sum;
  }
};

/// How far particles are carried towards their neighbours; beyond 1 they might pass them.
struct FindLargest {
  DeviceArray<Conducted> flow;
  DeviceArray<Real> capacity;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p, Real& bound, Real& linear) const {
    bound = Kokkos::max(bound, flow(p).bound / capacity(p));
    linear = Kokkos::max(linear, flow(p).linear / capacity(p));
  }
};

struct TakeHeat {
  DeviceArray<Conducted> flow;
  DeviceArray<Real> capacity, temperature;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    temperature(p) += flow(p).heat / capacity(p);
  }
};

template <class T>
void ensure_size(DeviceArray<T>& array, Index count, const char* label) {
  if (array.extent(0) >= static_cast<std::size_t>(count)) return;
  array = DeviceArray<T>(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)),
                         static_cast<std::size_t>(count + count / 4));
}

}  // namespace

ContactConduction::ContactConduction(const ConductionOptions& options)
    : materials_(static_cast<Index>(options.solids.size())),
      walls_(static_cast<Index>(options.wall_temperature.size())),
      wall_heat_("heat::contact_conduction::wall_heat",
                 static_cast<std::size_t>(wall_parts) * options.wall_temperature.size()),
      wall_heat_host_(Kokkos::create_mirror_view(wall_heat_)),
      heat_to_walls_(options.wall_temperature.size(), 0) {
  std::vector<Real> per_radius, temperatures;
  for (const ConductingSolid& a : options.solids) {
    for (const ConductingSolid& b : options.solids) per_radius.push_back(conductance_per_radius(a, b));
  }
  for (const std::optional<Real>& temperature : options.wall_temperature) {
    temperatures.push_back(temperature.value_or(-1));
    any_warm_wall_ = any_warm_wall_ || temperature.has_value();
  }
  per_radius_ = to_device("heat::contact_conduction::per_radius", per_radius);
  wall_temperature_ = to_device("heat::contact_conduction::wall_temperature", temperatures);
}

void ContactConduction::find_flows(const dem::Engine& engine, const SurfaceState& surface, Real step) {
  const dem::Particles& particles = engine.particles();
  const dem::NeighbourList& list = engine.neighbours();
  const dem::Domain& domain = engine.setup().domain;
  const PairConductance pair{particles, domain, per_radius_, materials_, surface.temperature(),
                             capacity_, step};
  const ConductPairs pairs{pair, list, flow_};
  const Index blocks = (list.count + pairs.block_size() - 1) / pairs.block_size();
  Kokkos::parallel_for("heat::contact_conduction::pairs", DeviceRange(0, blocks), pairs);
  if (list.half && fixed_ > 1) {
    const dem::NeighbourSearch& search = *engine.search();
    const DeviceRange all(0, particles.count);
    if (domain.repeats()) {
      Kokkos::parallel_for(
          "heat::contact_conduction::fixed_pairs_periodic", all,
          ConductFixedPairs<true>{pair, search.grid(), search.cell_start(), search.order(), flow_});
    } else {
      Kokkos::parallel_for(
          "heat::contact_conduction::fixed_pairs", all,
          ConductFixedPairs<false>{pair, search.grid(), search.cell_start(), search.order(), flow_});
    }
  }
  if (!any_warm_wall_) return;
  Kokkos::parallel_for(
      "heat::contact_conduction::walls", DeviceRange(0, wall_parts),
      ConductWalls{particles, engine.walls().list(), engine.walls().geometry(), per_radius_, materials_,
                   walls_, wall_temperature_, surface.temperature(), capacity_, step, flow_, wall_heat_});
}

void ContactConduction::apply(const dem::Engine& engine, const SurfaceState& surface) {
  Kokkos::parallel_for("heat::contact_conduction::take_heat", DeviceRange(0, engine.particles().count),
                       TakeHeat{flow_, capacity_, surface.temperature()});
  if (!any_warm_wall_) return;
  Kokkos::deep_copy(wall_heat_host_, wall_heat_);
  for (Index part = 0; part < wall_parts; ++part) {
    for (Index w = 0; w < walls_; ++w)
      heat_to_walls_[static_cast<std::size_t>(w)] += wall_heat_host_(part * walls_ + w);
  }
}

void ContactConduction::update(const dem::Engine& engine, const SurfaceState& surface, Real step) {
  const dem::Particles& particles = engine.particles();
  const Index count = particles.count;
  if (count == 0 || engine.neighbours().count != count) return;  // no substep yet since they came
  ensure_size(capacity_, count, "heat::contact_conduction::capacity");
  ensure_size(flow_, count, "heat::contact_conduction::flow");
  Kokkos::parallel_reduce("heat::contact_conduction::find_capacities", DeviceRange(0, count),
                          FindCapacities{surface.bare(particles), surface.heat_capacity(), surface.film(),
                                         surface.capacities(), capacity_},
                          fixed_);
  find_flows(engine, surface, step);
  Real bound = 0, linear = 0;
  Kokkos::parallel_reduce("heat::contact_conduction::find_largest", DeviceRange(0, count),
                          FindLargest{flow_, capacity_}, Kokkos::Max<Real>(bound), Kokkos::Max<Real>(linear));
  parts_ = bound <= 1 ? 1 : static_cast<int>(std::ceil(std::min(linear, Real(2 * most_parts))));
  if (parts_ > most_parts) {
    throw RunError("heat.contact_conduction: a particle takes the temperature of its neighbours within " +
                   std::to_string(step / linear) + " s, far less than the gas step of " +
                   std::to_string(step) + " s; a smaller gas step, or a smaller conductivity");
  }
  for (int part = 0; part < parts_; ++part) {
    if (parts_ > 1) find_flows(engine, surface, step / parts_);
    apply(engine, surface);
  }
}

void ContactConduction::save(core::CheckpointWriter& file) const {
  file.write("heat/heat_to_walls", heat_to_walls_);
}

void ContactConduction::load(const core::CheckpointReader& file) {
  file.read_into("heat/heat_to_walls", heat_to_walls_);
}

}  // namespace pellicle::heat
