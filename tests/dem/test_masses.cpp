// Particles whose mass changes: they move as others of that mass, and the books know it.
#include <gtest/gtest.h>

#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

constexpr Real growth = 1.3;

EngineSetup bouncing_setup(Real density) {
  auto setup = tests::glass_setup({0.02, 0.02, 0.02}, 1e-6, 0.8, 0.3, 0.01);
  setup.materials[0].density = density;
  setup.gravity = {0, 0, -9.81};
  tests::add_box_walls(setup);
  return setup;
}

/// One falls onto the floor with spin, another onto it; a third is fixed.
std::vector<ParticleSeed> bouncing_seeds() {
  std::vector<ParticleSeed> seeds(3);
  seeds[0] = {{0.01, 0.01, 0.0015}, {0.1, 0, -0.3}, {0, 40, 5}, 1e-3, 0, false};
  seeds[1] = {{0.0103, 0.01, 0.0041}, {0, 0.05, -0.5}, {}, 1.5e-3, 0, false};
  seeds[2] = {{0.016, 0.01, 0.001}, {}, {}, 1e-3, 0, true};
  return seeds;
}

/// Every particle `growth` times as heavy.
void grow(Engine& engine) {
  const auto n = static_cast<std::size_t>(engine.particles().count);
  const DeviceArray<Real> mass("test::masses::mass", n);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, engine.particles().mass);
  const auto grown = Kokkos::create_mirror_view(mass);
  for (std::size_t p = 0; p < n; ++p) grown(p) = growth * host(p);
  Kokkos::deep_copy(mass, grown);
  engine.set_masses(mass);
}

/// What grows at the start moves as what was so heavy from the start: masses differ by a rounding, which the bounces blow
/// up a little.
TEST(Masses, GrownParticlesFallBounceAndSpinAsOthersOfThatMass) {
  Engine grown(bouncing_setup(2500)), heavy(bouncing_setup(growth * 2500));
  grown.set_particles(bouncing_seeds());
  heavy.set_particles(bouncing_seeds());
  grow(grown);
  tests::advance(grown, 20000);
  tests::advance(heavy, 20000);
  const auto a = tests::grains(grown.particles()), b = tests::grains(heavy.particles());
  EXPECT_GT(norm(grown.collect_report().wall_impulse), 0) << "nothing has met the floor";
  for (std::size_t p = 0; p < a.size(); ++p) {
    EXPECT_NEAR(norm(a[p].position - b[p].position), 0, 1e-9) << p;
    EXPECT_NEAR(norm(a[p].velocity - b[p].velocity), 0, 1e-7) << p;
    EXPECT_NEAR(norm(a[p].spin - b[p].spin), 0, 1e-4) << p;
    EXPECT_NEAR(a[p].mass / b[p].mass, 1, 1e-15) << p;
  }
  EXPECT_TRUE(a[2].fixed);
}

/// Momentum of a bed that grows in flight: what gravity, walls, fixed particles and growth gave it, to rounding.
TEST(Masses, BooksOfMassAndMomentumClose) {
  Engine engine(bouncing_setup(2500));
  engine.set_particles(bouncing_seeds());
  const Real mass = engine.compute_totals().mass;
  const Vec3 before = engine.compute_totals().momentum;
  Vec3 given{};
  Real gross = 0;
  for (int n = 0; n < 4; ++n) {
    tests::advance(engine, 1500);
    const ContactReport report = engine.collect_report();
    given += report.wall_impulse - report.support_impulse;
    gross += norm(report.wall_impulse);
    const Vec3 at = engine.compute_totals().momentum;
    const Vec3 grown = engine.grown_momentum();
    grow(engine);
    // At unchanged velocity.
    EXPECT_NEAR(norm(engine.grown_momentum() - grown - (growth - 1) * at) / norm(at), 0, 1e-12);
  }
  const ParticleTotals totals = engine.compute_totals();
  EXPECT_NEAR(totals.mass / (mass + engine.grown_mass()), 1, 1e-14);
  EXPECT_NEAR(totals.mass / (mass * growth * growth * growth * growth), 1, 1e-13);
  const Vec3 missing = totals.momentum - before - given - engine.gravity_impulse() - engine.grown_momentum();
  EXPECT_GT(gross, 1e-6);
  EXPECT_NEAR(norm(missing) / gross, 0, 1e-12);
}

}  // namespace
}  // namespace pellicle::dem
