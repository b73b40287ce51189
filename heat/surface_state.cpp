#include "heat/surface_state.hpp"

#include <algorithm>

#include "heat/film_laws.hpp"

namespace pellicle::heat {
namespace {

/// Particles whose amounts are summed in one go; fixed, so that sums do not depend on threads.
constexpr Index sum_block = 512;

struct SumSurface {
  Index first, last;
  DeviceArray<std::int32_t> order;  // empty: as they are
  DeviceArray<Real> temperature, mass, heat_capacity;
  DeviceArray<Film> film;
  DeviceArray<dem::VelocitySpin> velocity_spin;
  HeatCapacities capacities;
  DeviceArray<SurfaceTotals> result;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index begin = first + block * sum_block;
    const Index end = Kokkos::min(begin + sum_block, last);
    SurfaceTotals sum;
    for (Index k = begin; k < end; ++k) {
      const Index p = order.extent(0) > 0 ? order(k) : k;
      const Film f = film(p);
      const Real capacity = mass(p) * heat_capacity(velocity_spin(p).material) +
                            f.liquid * capacities.liquid + f.solids * capacities.solids;
      sum += {f, capacity * (temperature(p) - capacities.reference_temperature)};
    }
    result(block) = sum;
  }
};

struct Begin {
  Newcomer newcomer;
  DeviceArray<Real> mass, temperature;
  DeviceArray<Film> film;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    temperature(p) = newcomer.temperature;
    film(p) = {newcomer.film_share.liquid * mass(p), newcomer.film_share.solids * mass(p)};
  }
};

struct AddFilms {
  DeviceArray<Real> bare;
  DeviceArray<Film> film;
  DeviceArray<Real> whole;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    whole(p) = bare(p) + film(p).liquid + film(p).solids;
  }
};

struct AddCoatings {
  DeviceArray<Real> bare;
  DeviceArray<Film> film;
  Real solids_density;
  DeviceArray<Real> whole;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    whole(p) = bare(p) + coating_thickness(bare(p), film(p).solids, solids_density);
  }
};

struct NoteRadii {
  DeviceArray<dem::PositionRadius> place;
  DeviceArray<Real> radius;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const { radius(p) = place(p).radius; }
};

void note_radii(const dem::Particles& particles, Index first, Index last, const DeviceArray<Real>& radius) {
  Kokkos::parallel_for("heat::surface_state::note_radii", DeviceRange(first, last),
                       NoteRadii{particles.position_radius, radius});
}

}  // namespace

SurfaceState::SurfaceState(const dem::Particles& particles, const std::vector<Real>& heat_capacity,
                           const HeatCapacities& capacities, Real initial_temperature, FilmGrowth growth,
                           Real solids_density)
    : particles_(particles),
      heat_capacity_("heat::surface_state::heat_capacity", heat_capacity.size()),
      capacities_(capacities),
      temperature_("heat::surface_state::temperature", "heat/temperature", initial_temperature),
      film_("heat::surface_state::film", "heat/film"),
      growth_(growth),
      bare_mass_("heat::surface_state::bare_mass", "heat/bare_mass"),
      bare_radius_("heat::surface_state::bare_radius", "heat/bare_radius"),
      solids_density_(solids_density),
      newcomer_{initial_temperature, {}} {
  const auto host = Kokkos::create_mirror_view(heat_capacity_);
  std::copy(heat_capacity.begin(), heat_capacity.end(), host.data());
  Kokkos::deep_copy(heat_capacity_, host);
}

void SurfaceState::set_by_id(const std::vector<Real>& temperature, const std::vector<Film>& film) {
  const Index count = particles_.count;
  const auto motion = dem::host_copy(particles_.velocity_spin, count);
  const std::pair<Index, Index> range(0, count);
  const auto device_temperature = Kokkos::subview(temperature_.values(), range);
  const auto device_film = Kokkos::subview(film_.values(), range);
  const auto host_temperature = Kokkos::create_mirror_view(device_temperature);
  const auto host_film = Kokkos::create_mirror_view(device_film);
  for (Index p = 0; p < count; ++p) {
    const auto id = static_cast<std::size_t>(motion(p).id);
    host_temperature(p) = temperature.at(id);
    host_film(p) = film.at(id);
  }
  Kokkos::deep_copy(device_temperature, host_temperature);
  Kokkos::deep_copy(device_film, host_film);
}

void SurfaceState::note_bare_particles() {
  if (growth_ == FilmGrowth::none || particles_.count == 0) return;
  const std::pair<Index, Index> range(0, particles_.count);
  Kokkos::deep_copy(Kokkos::subview(bare_mass_.values(), range), Kokkos::subview(particles_.mass, range));
  if (radius_grows()) note_radii(particles_, 0, particles_.count, bare_radius_.values());
}

void SurfaceState::grow(dem::Engine& engine) {
  const Index count = particles_.count;
  if (growth_ == FilmGrowth::none || count == 0) return;
  const auto make_room = [count](DeviceArray<Real>& array, const char* label) {
    if (array.extent(0) >= static_cast<std::size_t>(count)) return;
    array = DeviceArray<Real>(Kokkos::view_alloc(std::string(label), Kokkos::WithoutInitializing),
                              static_cast<std::size_t>(count + count / 4));
  };
  make_room(whole_mass_, "heat::surface_state::whole_mass");
  Kokkos::parallel_for("heat::surface_state::add_films", DeviceRange(0, count),
                       AddFilms{bare_mass_.values(), film(), whole_mass_});
  if (!radius_grows()) {
    engine.set_masses(whole_mass_);
    return;
  }
  make_room(whole_radius_, "heat::surface_state::whole_radius");
  Kokkos::parallel_for("heat::surface_state::add_coatings", DeviceRange(0, count),
                       AddCoatings{bare_radius_.values(), film(), solids_density_, whole_radius_});
  engine.set_sizes(whole_mass_, whole_radius_);
}

SurfaceTotals SurfaceState::sum(Index first, Index last, const DeviceArray<std::int32_t>& order) const {
  SurfaceTotals total;
  if (last <= first) return total;
  const Index blocks = (last - first + sum_block - 1) / sum_block;
  const DeviceArray<SurfaceTotals> result(
      Kokkos::view_alloc("heat::surface_state::sums", Kokkos::WithoutInitializing),
      static_cast<std::size_t>(blocks));
  Kokkos::parallel_for("heat::surface_state::sum", DeviceRange(0, blocks),
                       SumSurface{first, last, order, temperature(), bare(particles_).mass, heat_capacity_,
                                  film(), particles_.velocity_spin, capacities_, result});
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, result);
  for (Index b = 0; b < blocks; ++b) total += host(b);
  return total;
}

SurfaceTotals SurfaceState::compute_totals() const { return sum(0, particles_.count); }

void SurfaceState::reset(Index count) {
  temperature_.reset(count);
  film_.reset(count);
  if (growth_ != FilmGrowth::none) bare_mass_.reset(count);
  if (radius_grows()) bare_radius_.reset(count);
  left_ = entered_ = {};
}

void SurfaceState::add(Index first, Index count) {
  temperature_.add(first, count);
  film_.add(first, count);
  if (growth_ != FilmGrowth::none) {
    bare_mass_.add(first, count);
    const std::pair<Index, Index> range(first, first + count);
    Kokkos::deep_copy(Kokkos::subview(bare_mass_.values(), range), Kokkos::subview(particles_.mass, range));
  }
  if (radius_grows()) {
    bare_radius_.add(first, count);
    note_radii(particles_, first, first + count, bare_radius_.values());
  }
  Kokkos::parallel_for("heat::surface_state::begin", DeviceRange(first, first + count),
                       Begin{newcomer_, particles_.mass, temperature(), film()});
  entered_ += sum(first, first + count);
}

void SurfaceState::reorder(const DeviceArray<std::int32_t>& order, Index before, Index count,
                           const DeviceArray<Real>& scratch) {
  left_ += sum(count, before, order);
  temperature_.reorder(order, before, count, scratch);
  film_.reorder(order, before, count, scratch);
  if (growth_ != FilmGrowth::none) bare_mass_.reorder(order, before, count, scratch);
  if (radius_grows()) bare_radius_.reorder(order, before, count, scratch);
}

void SurfaceState::save(core::CheckpointWriter& file, Index count) const {
  temperature_.save(file, count);
  film_.save(file, count);
  if (growth_ != FilmGrowth::none) bare_mass_.save(file, count);
  if (radius_grows()) bare_radius_.save(file, count);
  for (const auto& [name, totals] : {std::pair("left", left_), std::pair("entered", entered_)}) {
    const std::string path = std::string("heat/") + name;
    file.write(path + "_liquid", totals.film.liquid);
    file.write(path + "_solids", totals.film.solids);
    file.write(path + "_enthalpy", totals.enthalpy);
  }
}

void SurfaceState::load(const core::CheckpointReader& file, Index count) {
  temperature_.load(file, count);
  film_.load(file, count);
  if (growth_ != FilmGrowth::none) bare_mass_.load(file, count);
  if (radius_grows()) bare_radius_.load(file, count);
  for (const auto& [name, totals] : {std::pair("left", &left_), std::pair("entered", &entered_)}) {
    const std::string path = std::string("heat/") + name;
    totals->film.liquid = file.read_double(path + "_liquid");
    totals->film.solids = file.read_double(path + "_solids");
    totals->enthalpy = file.read_double(path + "_enthalpy");
  }
}

}  // namespace pellicle::heat
