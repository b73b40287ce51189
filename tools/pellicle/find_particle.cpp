#include "tools/pellicle/find_particle.hpp"

namespace pellicle::tools {

namespace {

/// At most one particle has the id, so that at most one thread writes.
struct FindId {
  Index id;
  ParticleColumns particles;
  DeviceArray<ParticleSample> found;
  DeviceArray<Index> count;

  KOKKOS_INLINE_FUNCTION void operator()(Index p) const {
    if (particles.particles.velocity_spin(p).id != id) return;
    found(0) = particles(p);
    count(0) = 1;
  }
};

}  // namespace

ParticleFinder::ParticleFinder()
    : found_("tools::find_particle::found", 1), count_("tools::find_particle::count", 1) {}

bool ParticleFinder::find(const ParticleColumns& particles, Index id, ParticleSample& sample) const {
  Kokkos::deep_copy(count_, 0);
  Kokkos::parallel_for("tools::find_particle::find_id", DeviceRange(0, particles.particles.count),
                       FindId{id, particles, found_, count_});
  Index count = 0;
  Kokkos::deep_copy(count, Kokkos::subview(count_, 0));
  if (count == 0) return false;
  Kokkos::deep_copy(sample, Kokkos::subview(found_, 0));
  return true;
}

}  // namespace pellicle::tools
