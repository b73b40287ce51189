// The motion of particles: both forms of its kernel agree to the last bit.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "dem/motion.hpp"
#include "tests/dem/bed.hpp"

#ifndef KOKKOS_ENABLE_CUDA

namespace pellicle::dem {
namespace {

using tests::random_vector;

struct Scene {
  Particles particles;
  ContactResult contacts;
  NeighbourList list;
};

Scene make_scene(Index count) {
  const auto n = static_cast<std::size_t>(count);
  Scene s;
  s.particles.count = count;
  s.particles.position_radius = DeviceArray<PositionRadius>("test::motion::place", n);
  s.particles.velocity_spin = DeviceArray<VelocitySpin>("test::motion::motion", n);
  s.particles.acceleration = DeviceArray<Vec3f>("test::motion::acceleration", n);
  s.particles.angular_acceleration = DeviceArray<Vec3f>("test::motion::angular_acceleration", n);
  s.contacts.load = DeviceArray<ContactLoad>("test::motion::load", n);
  s.contacts.touching = DeviceArray<std::int32_t>("test::motion::touching", n);
  s.list.displacement = DeviceArray<Displacement>("test::motion::displacement", n);
  for (Index p = 0; p < count; ++p) {
    const Vec3 x = random_vector(1, p);
    const Vec3 v = random_vector(2, p);
    const Vec3 w = 100.0 * random_vector(3, p);
    s.particles.position_radius(p) = {x.x, x.y, x.z, 1e-3 * (1.5 + x.x)};
    // Ids from small to so large that the end of a row, read as a number, is anything; some particles are fixed.
    const std::int32_t id = p % 2 == 0 ? p : 0x7ff00000 + p;
    s.particles.velocity_spin(p) = {v.x, v.y, v.z, w.x, w.y, w.z, p % 7 == 0 ? 0 : 3e4 * (1.5 + v.x), 1, id};
    s.particles.acceleration(p) = convert<float>(9.0 * random_vector(4, p));
    s.particles.angular_acceleration(p) = convert<float>(1e3 * random_vector(5, p));
    s.contacts.load(p) = {1e-3 * random_vector(6, p), 1e-6 * random_vector(7, p), static_cast<Real>(p % 13),
                          0};
    s.list.displacement(p) = {1e-4F * static_cast<float>(w.x), 0, 0, 5e-3F};
  }
  return s;
}

/// Along x with the particle's number, against the velocity otherwise.
struct SomeFluid {
  Vec3 operator()(Index p, const Vec3& velocity, Real) const {
    return Vec3{1e-6 * p, 0, 0} - 1e-4 * velocity;
  }
};

template <class T>
bool same_bits(const DeviceArray<T>& a, const DeviceArray<T>& b) {
  return std::memcmp(a.data(), b.data(), a.span() * sizeof(T)) == 0;
}

TEST(Motion, IsTheSameInLanesAsOneByOne) {
  constexpr Index count = 100;
  const Scene one = make_scene(count);
  const Scene lanes = make_scene(count);
  const MotionStep step{{0.1, -0.2, -9.81}, 1e-5, 0.7e-5};
  const MotionFlagsView one_flags("test::motion::one_flags");
  const MotionFlagsView lanes_flags("test::motion::lanes_flags");
  const MotionKernel<SomeFluid> kernel{one.particles, one.contacts, one.list, step, {}, one_flags};
  const MotionKernelInLanes<SomeFluid> kernel_in_lanes{lanes.particles, lanes.contacts, lanes.list, step, {},
                                                       lanes_flags};
  for (int k = 0; k < 3; ++k) {
    for (Index p = 0; p < count; ++p) kernel(p);
    for (Index block = 0; block * motion_block < count; ++block) kernel_in_lanes(block);
  }
  EXPECT_TRUE(same_bits(one.particles.position_radius, lanes.particles.position_radius));
  EXPECT_TRUE(same_bits(one.particles.velocity_spin, lanes.particles.velocity_spin));
  EXPECT_TRUE(same_bits(one.particles.acceleration, lanes.particles.acceleration));
  EXPECT_TRUE(same_bits(one.particles.angular_acceleration, lanes.particles.angular_acceleration));
  EXPECT_TRUE(same_bits(one.list.displacement, lanes.list.displacement));
  EXPECT_TRUE(same_bits(one.contacts.touching, lanes.contacts.touching));
  EXPECT_EQ(lanes.contacts.touching(25), 12);
  EXPECT_EQ(one_flags().list_outdated, 1);
  EXPECT_EQ(lanes_flags().list_outdated, 1);
  EXPECT_EQ(lanes_flags().broken_particle, -1);
}

TEST(Motion, FindsABrokenParticleInLanes) {
  const Scene scene = make_scene(4);
  scene.contacts.load(2).force.y = std::numeric_limits<Real>::quiet_NaN();
  const MotionFlagsView flags("test::motion::flags");
  const MotionKernelInLanes<NoFluid> kernel{
      scene.particles, scene.contacts, scene.list, {{}, 1e-5, 1e-5}, {}, flags};
  kernel(0);
  EXPECT_EQ(flags().broken_particle, 2);
}

}  // namespace
}  // namespace pellicle::dem

#endif
