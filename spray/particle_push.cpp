#include "spray/particle_push.hpp"

#include <utility>

namespace pellicle::spray {
namespace {

constexpr Index push_block = 512;

struct PushParticles {
  dem::Particles particles;
  ParticlePushes pushes;
  Real half_step;
  DeviceArray<Vec3> partial;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index end = Kokkos::min((block + 1) * push_block, particles.count);
    Vec3 sum;
    for (Index p = block * push_block; p < end; ++p) sum += push(p);
    partial(block) = sum;
  }

 private:
  KOKKOS_INLINE_FUNCTION Vec3 push(Index p) const {
    const ParticlePush got = pushes.of(p);
    if (got.mass == 0 && got.momentum[0] == 0 && got.momentum[1] == 0 && got.momentum[2] == 0) return {};
    pushes.of(p) = ParticlePush{};
    dem::VelocitySpin& motion = particles.velocity_spin(p);
    if (motion.inverse_mass == 0) return {};  // what holds it takes it
    const Real mass = particles.mass(p);
    const Real caught = pushes.unit.water * static_cast<Real>(got.mass);
    const Vec3 before = motion.velocity() - half_step * convert<Real>(particles.acceleration(p));
    Vec3 change;
    for (int axis = 0; axis < 3; ++axis) {
      const Real brought = pushes.unit.impulse * static_cast<Real>(got.momentum[axis]);
      change[axis] = (brought - caught * before[axis]) / (mass + caught);
    }
    motion.vx += change.x;
    motion.vy += change.y;
    motion.vz += change.z;
    return mass * change;
  }
};

}  // namespace

Vec3 push_particles(const dem::Particles& particles, const ParticlePushes& pushes, Real half_step,
                    DeviceArray<Vec3>& partial) {
  const Index blocks = (particles.count + push_block - 1) / push_block;
  if (blocks == 0) return {};
  if (partial.extent(0) < static_cast<std::size_t>(blocks)) {
    partial =
        DeviceArray<Vec3>(Kokkos::view_alloc(Kokkos::WithoutInitializing, "spray::particle_push::partial"),
                          static_cast<std::size_t>(2 * blocks));
  }
  Kokkos::parallel_for("spray::particle_push::push", DeviceRange(0, blocks),
                       PushParticles{particles, pushes, half_step, partial});
  const auto host = Kokkos::create_mirror_view_and_copy(
      Kokkos::HostSpace{}, Kokkos::subview(partial, std::pair<Index, Index>(0, blocks)));
  Vec3 sum;
  for (Index b = 0; b < blocks; ++b) sum += host(b);
  return sum;
}

}  // namespace pellicle::spray
