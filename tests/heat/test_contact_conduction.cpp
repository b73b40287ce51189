// Conduction at contacts: numbers by hand, two spheres against their exact exponential, a chain between two walls against
// resistances in series, a random bed against a sum over all pairs, and bounds that no step may break.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "heat/contact_conduction.hpp"
#include "tests/core/kernel_labels.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::heat {
namespace {

using ::pellicle::tests::glass_setup;

constexpr Real reference = 298.15;  // [K]
constexpr Real glass_capacity = 840, glass_conductivity = 1.4;
constexpr Real rounding = 1e-12;

TEST(ConductionLaws, AgreeWithHandNumbers) {
  // Equal bodies: 2 k. Resistances of 1/4 and 1/12 m K/W over 1 m: 4 / (1 + 1/3). One without: 4 k.
  EXPECT_DOUBLE_EQ(conductance_per_radius({1.4, 0, 0}, {1.4, 0, 0}), 2.8);
  EXPECT_DOUBLE_EQ(conductance_per_radius({1, 0, 0}, {3, 0, 0}), 3);
  EXPECT_DOUBLE_EQ(conductance_per_radius({1.4, 0, 0}, {0, 0, 0}), 5.6);
  EXPECT_EQ(conductance_per_radius({0, 0, 0}, {0, 0, 0}), 0);
  // Eight times as stiff: half the radius. With one of two bodies so stiff: 1/E* = 1/8 + 1 in place of 2.
  EXPECT_DOUBLE_EQ(conductance_per_radius({1, 1e7, 8e7}, {1, 1e7, 8e7}), 1);
  EXPECT_NEAR(conductance_per_radius({1, 1e7, 8e7}, {1, 1e7, 1e7}), 2 * std::cbrt(1.125 / 2), rounding);
  // sqrt(0.5 mm x 2 um); 0.5 (1 - exp(-0.4)).
  EXPECT_NEAR(contact_radius(0.5e-3, 2e-6), 3.1622776601683795e-5, 1e-17);
  EXPECT_NEAR(conducted_heat(0.2, 0.5, 1), 0.16483997698218034, 1e-15);
  EXPECT_NEAR(conducted_heat(0.2, 0.5, 1e-6) / 1.9999996e-7, 1, rounding);  // h t (1 - x/2), x = 4e-7
}

/// An engine, its particles' temperatures and the conduction between them. Time steps are so short that nothing moves.
struct Bed {
  explicit Bed(const dem::EngineSetup& setup, const std::vector<dem::ParticleSeed>& seeds,
               const std::vector<Real>& temperatures, const std::vector<std::optional<Real>>& walls = {})
      : engine(setup),
        surface(engine.particles(), std::vector<Real>(setup.materials.size(), glass_capacity),
                {reference, 4181, 1300}, reference),
        conduction(
            {std::vector<ConductingSolid>(setup.materials.size(), {glass_conductivity, 0, 0}), walls}) {
    engine.attach(surface);
    engine.set_particles(seeds);
    surface.set_by_id(temperatures, std::vector<Film>(seeds.size()));
    tests::advance(engine, 1);
  }
  void step(Real dt) { conduction.update(engine, surface, dt); }
  std::vector<Real> temperatures() const {
    const auto motion =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, engine.particles().velocity_spin);
    const auto values = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, surface.temperature());
    std::vector<Real> by_id(static_cast<std::size_t>(engine.particles().count));
    for (Index p = 0; p < engine.particles().count; ++p)
      by_id[static_cast<std::size_t>(motion(p).id)] = values(p);
    return by_id;
  }
  Real enthalpy() const { return surface.compute_totals().enthalpy; }

  dem::Engine engine;
  SurfaceState surface;
  ContactConduction conduction;
};

Real heat_capacity(Real radius) { return tests::glass_mass(radius) * glass_capacity; }

dem::ParticleSeed seed(const Vec3& position, Real radius, bool fixed = false) {
  dem::ParticleSeed made;
  made.position = position;
  made.radius = radius;
  made.fixed = fixed;
  return made;
}

/// h (1/C_1 + 1/C_2) by hand, for spheres of 1 and 1.5 mm that overlap by 0.02 mm: R* = 0.6 mm.
TEST(ContactConduction, TwoSpheresRelaxAsTheirExactExponential) {
  constexpr Real r1 = 1e-3, r2 = 1.5e-3, overlap = 2e-5;
  const Real conductance = 2 * glass_conductivity * std::sqrt(0.6e-3 * overlap);
  const Real c1 = heat_capacity(r1), c2 = heat_capacity(r2);
  const Real rate = conductance * (1 / c1 + 1 / c2);
  const Real mean = (c1 * 300 + c2 * 360) / (c1 + c2);
  for (const bool fixed : {false, true}) {
    for (const Real dt : {1e-3, 1.0, 100.0}) {  // the time constant is 22 s
      Bed bed(glass_setup({0.02, 0.02, 0.02}, 1e-10),
              {seed({0.01, 0.01, 0.01}, r1, fixed), seed({0.01, 0.01, 0.01 + r1 + r2 - overlap}, r2, fixed)},
              {300, 360});
      const Real energy = bed.enthalpy();
      for (int n = 0; n < 20; ++n) bed.step(dt);
      EXPECT_EQ(bed.conduction.parts(), 1);
      const Real left = std::exp(-rate * 20 * dt);
      // The overlap is a difference of millimetres: eleven digits of it.
      EXPECT_NEAR(bed.temperatures()[0], mean + (300 - mean) * left, 1e-8) << dt << fixed;
      EXPECT_NEAR(bed.temperatures()[1], mean + (360 - mean) * left, 1e-8) << dt << fixed;
      EXPECT_NEAR(bed.enthalpy() / energy, 1, rounding);
    }
  }
}

/// Five spheres in a row, pressed together between walls of 400 and 300 K. Under one force the overlap with a rigid wall is
/// half that of two spheres (Hertz), so nothing moves. Resistances: 1/(2 k sqrt(R/2 d)) and 1/(2 k sqrt(R d/2)), the same.
TEST(ContactConduction, AChainBetweenWallsConductsAsResistancesInSeries) {
  constexpr Real radius = 1e-3, overlap = 2e-5;
  auto setup = glass_setup({0.01, 0.01, 10 * radius - 5 * overlap}, 1e-10);
  for (const bool upper : {false, true}) {
    dem::PlaneWall wall;
    wall.point = {0, 0, upper ? setup.domain.box.max.z : 0};
    wall.normal = {0, 0, upper ? -1.0 : 1.0};
    wall.material = 1;
    setup.walls.emplace_back(wall);
  }
  std::vector<dem::ParticleSeed> seeds;
  for (int n = 0; n < 5; ++n)
    seeds.push_back(seed({0.005, 0.005, radius - overlap / 2 + n * (2 * radius - overlap)}, radius));
  const Real conductance = 2 * glass_conductivity * std::sqrt(radius / 2 * overlap);
  const Real flux = 100 * conductance / 6;
  // To the steady state from elsewhere, in steps of 1/16, 1/31 and 16 of C/h (31 s). In a step a contact conducts as if it
  // had the resistance x / (1 - exp(-x)) times as large, x = h dt / C, with C / 2 for a pair.
  for (const Real dt : {2.0, 1.0, 500.0}) {
    Bed bed(setup, seeds, std::vector<Real>(5, 310), {400, 300});
    const Real energy = bed.enthalpy();
    for (int n = 0; n < 2000; ++n) bed.step(dt);
    const Real hot = bed.conduction.heat_to_walls()[0], cold = bed.conduction.heat_to_walls()[1];
    EXPECT_NEAR((bed.enthalpy() + hot + cold - energy) / cold, 0, 1e-11)
        << dt;  // rounding of 4000 sums and more
    const std::vector<Real> t = bed.temperatures();
    for (std::size_t n = 0; n < 4; ++n) EXPECT_NEAR(t[n] - t[n + 1], (t[0] - t[4]) / 4, 2e-5) << dt;
    bed.step(dt);
    const Real rate = (bed.conduction.heat_to_walls()[1] - cold) / dt;
    EXPECT_NEAR(bed.conduction.heat_to_walls()[0] - hot, -rate * dt, 1e-6 * rate * dt) << dt;
    EXPECT_LE(rate, flux);
    if (dt > 10) continue;
    const Real x = conductance * dt / heat_capacity(radius);
    const Real of_wall = x / (1 - std::exp(-x)), of_pair = 2 * x / (1 - std::exp(-2 * x));
    const Real resistances = 2 * of_wall + 4 * of_pair;
    EXPECT_NEAR(t[0], 400 - 100 * of_wall / resistances, 1e-4) << dt;
    EXPECT_NEAR(rate / flux, 6 / resistances, 1e-5) << dt;
  }
  Bed bed(setup, seeds, {400 - 100 / 6., 400 - 200 / 6., 350, 300 + 200 / 6., 300 + 100 / 6.}, {400, 300});
  bed.step(1e-3);
  EXPECT_NEAR(bed.conduction.heat_to_walls()[1] / (flux * 1e-3), 1, 1e-4);  // x = 6e-5
  EXPECT_NEAR(bed.conduction.heat_to_walls()[0] / (flux * 1e-3), -1, 1e-4);
}

/// A sphere pressed against one warm wall: C dT/dt = h (T_w - T), h = 2 k sqrt(R overlap).
TEST(ContactConduction, ASphereOnAHotWallFollowsItsExponential) {
  constexpr Real radius = 1e-3, overlap = 1e-5, dt = 3;
  auto setup = glass_setup({0.01, 0.01, 0.01}, 1e-10);
  tests::add_box_walls(setup);  // bottom is the fifth
  Bed bed(setup, {seed({0.005, 0.005, radius - overlap}, radius)}, {300},
          {std::nullopt, std::nullopt, std::nullopt, std::nullopt, Real(380), std::nullopt});
  for (int n = 0; n < 10; ++n) bed.step(dt);
  const Real rate = 2 * glass_conductivity * std::sqrt(radius * overlap) / heat_capacity(radius);
  EXPECT_NEAR(bed.temperatures()[0], 380 - 80 * std::exp(-rate * 10 * dt), 1e-8);
  EXPECT_NEAR(bed.conduction.heat_to_walls()[4],
              -heat_capacity(radius) * 80 * (1 - std::exp(-rate * 10 * dt)), 1e-10);
  EXPECT_EQ(bed.conduction.heat_to_walls()[5], 0);
}

/// More particles than a block of the half lists holds, every fifth one fixed, some across a periodic side; against a sum
/// over all pairs.
TEST(ContactConduction, ARandomBedAgreesWithASumOverAllPairs) {
  constexpr std::size_t count = 1500;
  constexpr Real dt = 0.05;
  auto setup = glass_setup({0.03, 0.03, 0.03}, 1e-12);
  setup.domain.periodic = {1, 0, 0};
  std::vector<Real> radii, temperatures;
  for (std::size_t p = 0; p < count; ++p) {
    radii.push_back(0.9e-3 + 0.2e-3 * tests::random_vector(5, static_cast<int>(p)).x);
    temperatures.push_back(330 + 40 * tests::random_vector(6, static_cast<int>(p)).x);
  }
  const auto centres = tests::scatter({{0, 0.001, 0.001}, {0.03, 0.029, 0.029}}, radii, 0.05, 7);
  std::vector<dem::ParticleSeed> seeds;
  for (std::size_t p = 0; p < count; ++p) seeds.push_back(seed(centres[p], radii[p], p % 5 == 0));
  Bed bed(setup, seeds, temperatures);
  const Real energy = bed.enthalpy();
  bed.step(dt);
  EXPECT_NEAR(bed.enthalpy() / energy, 1, rounding);
  const std::vector<Real> found = bed.temperatures();
  std::size_t touching = 0, of_fixed = 0;
  for (std::size_t p = 0; p < count; ++p) {
    Real heat = 0;
    for (std::size_t q = 0; q < count; ++q) {
      const Real overlap = radii[p] + radii[q] - norm(setup.domain.shortest(centres[q] - centres[p]));
      if (q == p || !(overlap > 0)) continue;
      ++touching;
      of_fixed += p % 5 == 0 && q % 5 == 0 ? 1 : 0;
      const Real h =
          2 * glass_conductivity * std::sqrt(radii[p] * radii[q] / (radii[p] + radii[q]) * overlap);
      const Real a = heat_capacity(radii[p]), b = heat_capacity(radii[q]);
      heat +=
          a * b / (a + b) * (1 - std::exp(-h * (1 / a + 1 / b) * dt)) * (temperatures[q] - temperatures[p]);
    }
    // Overlaps are differences of millimetres, and the particles have moved by a step of 1e-12 s.
    EXPECT_NEAR(found[p], temperatures[p] + heat / heat_capacity(radii[p]), 1e-7) << p;
  }
  EXPECT_GT(touching, 400U);
  EXPECT_GT(of_fixed, 10U);
}

/// A step of 1000 time constants, in a heap of spheres of which each has many neighbours: nobody passes the warmest or the
/// coldest, and energy is kept.
TEST(ContactConduction, NoStepCarriesAnybodyBeyondItsNeighbours) {
  auto setup = glass_setup({0.02, 0.02, 0.02}, 1e-12);
  std::vector<dem::ParticleSeed> seeds;
  std::vector<Real> temperatures;
  for (int n = 0; n < 216; ++n) {
    const Vec3 at{0.004 + 1.9e-3 * (n % 6), 0.004 + 1.9e-3 * ((n / 6) % 6), 0.004 + 1.9e-3 * (n / 36)};
    seeds.push_back(seed(at, 1e-3, true));
    temperatures.push_back(n % 2 == 0 ? 300 : 400);
  }
  Bed bed(setup, seeds, temperatures);
  const Real energy = bed.enthalpy();
  bed.step(5000);
  EXPECT_GT(bed.conduction.parts(), 100);
  EXPECT_NEAR(bed.enthalpy() / energy, 1, rounding);
  for (const Real t : bed.temperatures()) {
    EXPECT_GE(t, 300);
    EXPECT_LE(t, 400);
  }
}

TEST(ContactConduction, ASteadyStepAllocatesNothing) {
  Bed bed(glass_setup({0.02, 0.02, 0.02}, 1e-10),
          {seed({0.01, 0.01, 0.01}, 1e-3), seed({0.01, 0.01, 0.01199}, 1e-3)}, {300, 360});
  for (int n = 0; n < 2; ++n) bed.step(1e-3);
  const ::pellicle::tests::LabelHooks hooks;
  bed.step(1e-3);
  EXPECT_GT(::pellicle::tests::seen().launched.size(), 3U);
  ::pellicle::tests::expect_nothing_allocated();
}

}  // namespace
}  // namespace pellicle::heat
