// All that outputs may ask of the particles: what the engine has, and what other folders keep beside it.
#pragma once

#include "core/types.hpp"
#include "dem/particles.hpp"
#include "heat/film_laws.hpp"
#include "heat/surface_state.hpp"
#include "spray/hit_record.hpp"

namespace pellicle::tools {

/// Everything about one particle. What a case has not is as it is here.
struct ParticleSample {
  dem::PositionRadius position_radius{};
  dem::VelocitySpin velocity_spin{};
  Real mass = 0;
  dem::Vec3f acceleration;
  Real temperature = 0;  ///< [K]
  heat::Film film{};     ///< [kg]
  spray::HitRecord hit{};
  Real solids_density = 1;    ///< of the dry coating [kg/m3]
  bool radius_grows = false;  ///< the radius is that of the particle with its dry coating

  /// Of the dry coating [m].
  KOKKOS_INLINE_FUNCTION Real coating_thickness() const {
    return radius_grows ? heat::coating_thickness_within(position_radius.radius, film.solids, solids_density)
                        : heat::coating_thickness(position_radius.radius, film.solids, solids_density);
  }
};

/// Device arrays in the particles' order; those that a case has not are empty.
struct ParticleColumns {
  dem::Particles particles;
  DeviceArray<Real> temperature{};
  DeviceArray<heat::Film> film{};
  DeviceArray<spray::HitRecord> hits{};
  Real solids_density = 1;  ///< [kg/m3]
  bool radius_grows = false;

  ParticleColumns() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): particles without heat and spray are all that most have
  ParticleColumns(const dem::Particles& all) : particles(all) {}

  KOKKOS_INLINE_FUNCTION ParticleSample operator()(Index p) const {
    ParticleSample sample;
    sample.position_radius = particles.position_radius(p);
    sample.velocity_spin = particles.velocity_spin(p);
    sample.mass = particles.mass(p);
    if (particles.acceleration.extent(0) > 0) sample.acceleration = particles.acceleration(p);
    if (temperature.extent(0) > 0) sample.temperature = temperature(p);
    if (film.extent(0) > 0) sample.film = film(p);
    if (hits.extent(0) > 0) sample.hit = hits(p);
    sample.solids_density = solids_density;
    sample.radius_grows = radius_grows;
    return sample;
  }
};

}  // namespace pellicle::tools
