// One number of one particle, on the device and on the host.
#pragma once

#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "dem/particles.hpp"
#include "heat/film_laws.hpp"
#include "tools/pellicle/output_fields.hpp"
#include "tools/pellicle/particle_columns.hpp"

namespace pellicle::tools {

/// Value of particle_quantities[quantity] (output_fields.hpp).
KOKKOS_INLINE_FUNCTION Real particle_quantity(int quantity, const ParticleSample& particle) {
  const dem::PositionRadius& place = particle.position_radius;
  const dem::VelocitySpin& motion = particle.velocity_spin;
  switch (quantity) {
    case 0:
      return motion.vx;
    case 1:
      return motion.vy;
    case 2:
      return motion.vz;
    case 3:
      return Kokkos::sqrt(norm_squared(motion.velocity()));
    case 4:
      return motion.wx;
    case 5:
      return motion.wy;
    case 6:
      return motion.wz;
    case 7:
      return place.x;
    case 8:
      return place.y;
    case 9:
      return place.z;
    case 10:
      return 2 * place.radius;
    case 11:
      return particle.mass;
    case 12:
      return 0.5 * particle.mass * norm_squared(motion.velocity());
    case 13:
      return particle.acceleration.z;
    case 14:
      return particle.temperature;
    case 15:
      return particle.film.liquid;
    case 16:
      return particle.film.solids;
    case 17:
      return heat::coating_thickness(place.radius, particle.film.solids, particle.solids_density);
    case 18:
      return static_cast<Real>(particle.hit.hits);
    case 19:
      return particle.hit.first_hit;
    default:
      return particle.hit.last_hit;
  }
}
static_assert(particle_quantities.size() == 21 && particle_quantities[3].name == "particle_speed" &&
                  particle_quantities[7].name == "particle_position_x" &&
                  particle_quantities[12].name == "particle_kinetic_energy" &&
                  particle_quantities[17].name == "coating_thickness" &&
                  particle_quantities[20].name == "last_hit_time",
              "the codes above are positions in particle_quantities");

/// A host copy of the particles, in the order of their ids, for output. Columns that the case has not are empty.
struct HostParticles {
  std::vector<dem::PositionRadius> position_radius;
  std::vector<dem::VelocitySpin> velocity_spin;
  std::vector<Real> mass;
  std::vector<dem::Vec3f> acceleration;
  std::vector<Real> temperature;
  std::vector<heat::Film> film;
  std::vector<spray::HitRecord> hits;
  Real solids_density = 1;
  std::size_t count() const { return mass.size(); }
  ParticleSample sample(std::size_t p) const;
};

/// Copies the particles to the host and sorts them by id.
HostParticles copy_to_host(const ParticleColumns& columns);

}  // namespace pellicle::tools
