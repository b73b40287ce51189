// One number of one particle, on the device and on the host.
#pragma once

#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "dem/particles.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

/// Value of particle_quantities[quantity] (output_fields.hpp).
KOKKOS_INLINE_FUNCTION Real particle_quantity(int quantity, const dem::PositionRadius& place,
                                              const dem::VelocitySpin& motion, Real mass,
                                              const dem::Vec3f& acceleration) {
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
      return mass;
    case 12:
      return 0.5 * mass * norm_squared(motion.velocity());
    default:
      return acceleration.z;
  }
}
static_assert(particle_quantities.size() == 14 && particle_quantities[3].name == "particle_speed" &&
                  particle_quantities[7].name == "particle_position_x" &&
                  particle_quantities[12].name == "particle_kinetic_energy",
              "the codes above are positions in particle_quantities");

/// A host copy of the particles, in the order of their ids, for output.
struct HostParticles {
  std::vector<dem::PositionRadius> position_radius;
  std::vector<dem::VelocitySpin> velocity_spin;
  std::vector<Real> mass;
  std::vector<dem::Vec3f> acceleration;
  std::size_t count() const { return mass.size(); }
};

/// Copies the particles to the host and sorts them by id.
HostParticles copy_to_host(const dem::Particles& particles);

}  // namespace pellicle::tools
