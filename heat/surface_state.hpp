// What a particle's surface and heat carry: temperature and film, for every particle.
#pragma once

#include <vector>

#include "core/types.hpp"
#include "core/views.hpp"
#include "dem/companion.hpp"
#include "dem/engine.hpp"
#include "dem/particles.hpp"
#include "heat/film_growth.hpp"

namespace pellicle::heat {

/// What the spray has left on a particle.
struct Film {
  Real liquid = 0;  ///< [kg]
  Real solids = 0;  ///< [kg]
  KOKKOS_INLINE_FUNCTION Film& operator+=(const Film& b) {
    liquid += b.liquid;
    solids += b.solids;
    return *this;
  }
  friend KOKKOS_INLINE_FUNCTION Film operator-(const Film& a, const Film& b) {
    return {a.liquid - b.liquid, a.solids - b.solids};
  }
};

/// Heat capacities that count towards a particle's enthalpy.
struct HeatCapacities {
  Real reference_temperature = 273.15;  ///< from which enthalpies count [K]
  Real liquid = 4186;                   ///< [J/kg/K]
  Real solids = 1000;                   ///< of the dry coating [J/kg/K]
};

/// Sums over all particles, fixed ones too, in an order that does not depend on threads.
struct SurfaceTotals {
  Film film;          ///< [kg]
  Real enthalpy = 0;  ///< (m c + m_liquid c_liquid + m_solids c_solids) (T - T_ref) [J]
  KOKKOS_INLINE_FUNCTION SurfaceTotals& operator+=(const SurfaceTotals& b) {
    film += b.film;
    enthalpy += b.enthalpy;
    return *this;
  }
};

/// What a fed particle begins with.
struct Newcomer {
  Real temperature = 0;  ///< [K]
  Film film_share{};     ///< of the particle's mass
};

/// Temperature and film of all particles; follows them through memory (dem::Engine::attach).
class SurfaceState final : public dem::Companion {
 public:
  /// `particles` is that of the engine it is attached to; `heat_capacity` of each material [J/kg/K]; `solids_density` of the
  /// dry coating [kg/m3] is needed where it counts in the radius.
  SurfaceState(const dem::Particles& particles, const std::vector<Real>& heat_capacity,
               const HeatCapacities& capacities, Real initial_temperature,
               FilmGrowth growth = FilmGrowth::none, Real solids_density = 0);

  const DeviceArray<Real>& temperature() const { return temperature_.values(); }  ///< [K]
  const DeviceArray<Film>& film() const { return film_.values(); }                ///< [kg]
  const DeviceArray<Real>& heat_capacity() const { return heat_capacity_; }       ///< by material [J/kg/K]
  const HeatCapacities& capacities() const { return capacities_; }

  /// Temperature [K] and film [kg] of every particle by its id; to be called after the particles were set.
  void set_by_id(const std::vector<Real>& temperature, const std::vector<Film>& film);

  /// Takes the masses and radii that particles have now for those without films; to be called after the particles were set.
  void note_bare_particles();
  /// The particles with the masses that they have without films, which are what enthalpies count.
  dem::Particles bare(dem::Particles particles) const {
    if (growth_ != FilmGrowth::none) particles.mass = bare_mass_.values();
    return particles;
  }
  /// Unless growth is none: gives the engine's particles the mass of their films too, and with mass_and_radius the coating's
  /// thickness.
  void grow(dem::Engine& engine);

  /// What particles that are added from here on begin with; until the first call, the initial temperature and no film.
  void expect(const Newcomer& newcomer) { newcomer_ = newcomer; }

  SurfaceTotals compute_totals() const;
  /// What particles that left, and those that were fed, took along and brought, since the start.
  const SurfaceTotals& left() const { return left_; }
  const SurfaceTotals& entered() const { return entered_; }

  void reset(Index count) override;
  void add(Index first, Index count) override;
  void reorder(const DeviceArray<std::int32_t>& order, Index before, Index count,
               const DeviceArray<Real>& scratch) override;
  void save(core::CheckpointWriter& file, Index count) const override;
  void load(const core::CheckpointReader& file, Index count) override;
  std::size_t bytes() const override {
    return temperature_.bytes() + film_.bytes() + (growth_ != FilmGrowth::none ? bare_mass_.bytes() : 0) +
           (radius_grows() ? bare_radius_.bytes() : 0);
  }

 private:
  bool radius_grows() const { return growth_ == FilmGrowth::mass_and_radius; }
  /// Over entries first to last - 1, or those that `order` names there unless it is empty.
  SurfaceTotals sum(Index first, Index last, const DeviceArray<std::int32_t>& order = {}) const;

  const dem::Particles& particles_;
  DeviceArray<Real> heat_capacity_;
  HeatCapacities capacities_;
  dem::FollowingArray<Real> temperature_;
  dem::FollowingArray<Film> film_;
  FilmGrowth growth_;
  dem::FollowingArray<Real> bare_mass_;          // in use if films add to it
  dem::FollowingArray<Real> bare_radius_;        // in use if they add to it
  DeviceArray<Real> whole_mass_, whole_radius_;  // likewise, free between uses
  Real solids_density_;
  Newcomer newcomer_;
  SurfaceTotals left_, entered_;
};

}  // namespace pellicle::heat
