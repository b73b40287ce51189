// The closed forms of MFIX's DEM verification cases 1 to 4 (Garg, Galvin, Li & Pannala 2012, MFIX-DEM documentation;
// cases DEM01 to DEM04): a sphere dropped on a floor, bouncing, two stacked ones, one that slides.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/verification/dem/impacts.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::dem {
namespace {

using namespace tests;

constexpr Real g = 9.80665;  // as in those cases

/// Spheres side by side on a floor, each with its own stiffness [N/m] and restitution against everything.
struct Bouncer {
  Real stiffness, restitution;
};

EngineSetup spring_setup(const std::vector<Bouncer>& spheres, Real radius, Real density, Real time_step) {
  EngineSetup setup;
  const auto count = static_cast<Real>(spheres.size());
  setup.domain.box = {{0, 0, -radius}, {4 * radius * (count + 1), 8 * radius, 12 * radius}};
  const int floor = static_cast<int>(spheres.size());
  for (const Bouncer& b : spheres) {
    const int a = static_cast<int>(setup.materials.size());
    setup.materials.push_back({"solid " + std::to_string(a), density, 1e7, 0.25, false});
    for (int other = 0; other <= a; ++other) {
      setup.pairs.push_back({other, a, b.restitution, 0, 0, b.stiffness});
    }
    setup.pairs.push_back({a, floor, b.restitution, 0, 0, b.stiffness});
  }
  setup.materials.push_back({"floor", 0, 0, 0, true});
  setup.walls = {PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, floor}};
  setup.contacts.normal = Linear{};
  setup.contacts.overlap_limit = 2;
  setup.gravity = {0, 0, -g};
  setup.time_step = time_step;
  return setup;
}

TEST(Mfix, Dem01SphereDroppedOnALinearSpringDashpot) {
  // d 0.2 m, 2600 kg/m³, centre at 0.5 m, textbook damping, attraction allowed until the overlap is gone. Closed form:
  // s = y − R: s'' + 2 β ω s' + ω² s = −g from s' = −√(2 g (0.5 m − R)).
  const Real radius = 0.1, density = 2600, height = 0.5, step = 1e-5;
  std::vector<Bouncer> spheres;
  for (const Real k : {1e4, 2.5e4, 5e4, 1e5}) {
    for (const Real e : {1.0, 0.9, 0.8, 0.7, 0.6}) spheres.push_back({k, e});
  }
  auto setup = spring_setup(spheres, radius, density, step);
  setup.contacts.clip = false;
  std::vector<ParticleSeed> seeds;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    seeds.push_back({{4 * radius * (static_cast<Real>(i) + 1), 4 * radius, height},
                     {},
                     {},
                     radius,
                     static_cast<int>(i),
                     false});
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  std::vector<Real> lowest(spheres.size(), 1), released(spheres.size(), 0), speed(spheres.size(), 0);
  for (int k = 1; k < 41000; ++k) {
    advance(engine, 1);
    if (k * step < 0.28) continue;
    const auto place =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, engine.particles().position_radius);
    const auto motion =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, engine.particles().velocity_spin);
    for (Index p = 0; p < engine.particles().count; ++p) {
      const auto i = static_cast<std::size_t>(motion(p).id);
      lowest[i] = std::min(lowest[i], place(p).z);
      if (released[i] > 0 || place(p).z < radius || motion(p).vz < 0) continue;
      // Back along the parabola to where the contact ended.
      const Real v = motion(p).vz, over = place(p).z - radius;
      speed[i] = std::sqrt(v * v + 2 * g * over);
      released[i] = k * step - (speed[i] - v) / g;
    }
  }
  Real low = 0, rebound = 0, time = 0, apex = 0;
  const Real mass = sphere_mass({1e7, 0.25, density}, radius);
  const Real v0 = std::sqrt(2 * g * (height - radius)), touch = std::sqrt(2 * (height - radius) / g);
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Real omega = std::sqrt(spheres[i].stiffness / mass), ln = std::log(spheres[i].restitution);
    const Real beta = -ln / std::sqrt(M_PI * M_PI + ln * ln), q = omega * std::sqrt(1 - beta * beta);
    const Real a = g / (omega * omega), b = (beta * omega * a - v0) / q;
    const auto s = [&](Real t) {
      return std::exp(-beta * omega * t) * (a * std::cos(q * t) + b * std::sin(q * t)) - a;
    };
    const auto ds = [&](Real t) {
      return std::exp(-beta * omega * t) *
             ((q * b - beta * omega * a) * std::cos(q * t) - (q * a + beta * omega * b) * std::sin(q * t));
    };
    const auto root = [](const auto& f, Real left, Real right) {  // by bisection; f changes sign once
      const bool sign = f(left) > 0;
      for (int n = 0; n < 100; ++n)
        (((f(0.5 * (left + right)) > 0) == sign) ? left : right) = 0.5 * (left + right);
      return left;
    };
    const Real turn = root(ds, 0.0, M_PI / q);
    const Real release = root(s, turn, turn + M_PI / q);
    const Real out = ds(release);
    low = std::max(low, std::abs(lowest[i] - radius - s(turn)) / std::abs(s(turn)));
    rebound = std::max(rebound, std::abs(speed[i] / out - 1));
    time = std::max(time, std::abs((released[i] - touch) / release - 1));
    apex = std::max(apex, std::abs(speed[i] * speed[i] / (out * out) - 1));
    if (spheres[i].stiffness == 1e4 && spheres[i].restitution == 0.9) {
      // Against the published figures: y_min, time of release, apex.
      EXPECT_NEAR(radius + s(turn), 0.0016239794, 1e-9);
      EXPECT_NEAR(touch + release, 0.39743489, 1e-8);
      EXPECT_NEAR(radius + out * out / (2 * g), 0.41243182, 1e-8);
    }
  }
  const std::string why =
      "the dashpot sets in and ends within a step, each off by up to its impulse in half a step: 2 β ω Δt = "
      "3.1e-4 (20 drops, k 1e4 to "
      "1e5 N/m, e "
      "0.6 to 1)";
  expect_small("MFIX DEM01: largest overlap, relative deviation", low, 3.2e-4, why);
  expect_small("MFIX DEM01: rebound speed, relative deviation", rebound, 3.2e-4, why);
  expect_small("MFIX DEM01: contact time, relative deviation", time, 2e-5, why);
  expect_small("MFIX DEM01: height after the rebound, relative deviation", apex, 6.4e-4,
               "twice that of the speed");
}

TEST(Mfix, Dem02BouncesLowerEachTime) {
  // h_k = R + (h_0 − R) e^(2k) for a hard sphere. A contact of k = 2e7 N/m lasts 2.3 ms, in which gravity matters by
  // g t/v, 0.8 % of the impact speed of 2.8 m/s and the more the slower it gets.
  const Real radius = 0.1, density = 2600, height = 0.5, step = 4e-5;
  const std::vector<Bouncer> spheres = {{2e7, 0.9}, {2e7, 0.8}, {2e7, 0.7}};
  auto setup = spring_setup(spheres, radius, density, step);
  std::vector<ParticleSeed> seeds;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    seeds.push_back({{4 * radius * (static_cast<Real>(i) + 1), 4 * radius, height},
                     {},
                     {},
                     radius,
                     static_cast<int>(i),
                     false});
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  // Heights above the floor at the apexes, from the energy in flight.
  std::vector<std::vector<Real>> apexes(spheres.size());
  std::vector<Real> before(spheres.size(), 0);
  for (int k = 1; k * step < 1.1; k += 10) {
    advance(engine, 10);
    for (const Grain& s : grains(engine.particles())) {
      const auto i = static_cast<std::size_t>(s.id);
      if (before[i] > 0 && s.velocity.z <= 0) {
        apexes[i].push_back(s.position.z - radius + 0.5 * s.velocity.z * s.velocity.z / g);
      }
      before[i] = s.velocity.z;
    }
  }
  Real largest = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    ASSERT_GE(apexes[i].size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      const Real e = spheres[i].restitution;
      const Real hard = (height - radius) * std::pow(e, 2.0 * (static_cast<Real>(k) + 1));
      largest = std::max(largest, std::abs(apexes[i][k] / hard - 1));
    }
  }
  expect_small("MFIX DEM02: height of the first two bounces, e 0.7 to 0.9, relative deviation", largest, 0.02,
               "hard-sphere form; gravity acts during a soft contact (g t_c/v = 0.8 to 1.7 %), the step has "
               "its scatter");
}

TEST(Mfix, Dem03TwoStackedSpheresBetweenWalls) {
  // d 1 mm, 20000 (lower) and 10000 kg/m³, k 1e3 N/m everywhere, between walls 1.8 mm apart, from rest at 0.45 and
  // 1.35 mm. Positions [mm] at 0.1, 0.2, … 1 ms: the ODEs integrated by RK4 with 5e-8 s, apart from this code.
  struct Reference {
    Real restitution;
    std::array<std::pair<Real, Real>, 10> positions;
  };
  const std::array<Reference, 2> references = {{{1,
                                                 {{{0.43267465, 1.3813858},
                                                   {0.42458167, 1.3730907},
                                                   {0.43322889, 1.3378502},
                                                   {0.42563606, 1.3784694},
                                                   {0.43623748, 1.3791393},
                                                   {0.44942825, 1.3500904},
                                                   {0.42888151, 1.3829273},
                                                   {0.4241585, 1.3677214},
                                                   {0.43377522, 1.3392636},
                                                   {0.42712799, 1.3835532}}}},
                                                {0.5,
                                                 {{{0.43717553, 1.371868},
                                                   {0.42974449, 1.3708757},
                                                   {0.43025919, 1.3604661},
                                                   {0.43109178, 1.3649555},
                                                   {0.43388368, 1.3682542},
                                                   {0.43547399, 1.3677282},
                                                   {0.43422663, 1.3672077},
                                                   {0.43262074, 1.3662998},
                                                   {0.43223678, 1.3657958},
                                                   {0.43283858, 1.366288}}}}}};
  for (const Reference& reference : references) {
    const Real radius = 5e-4, step = 1e-7;
    EngineSetup setup;
    setup.domain.box = {{0, 0, 0}, {4e-3, 4e-3, 1.8e-3}};
    setup.materials = {
        {"lower", 20000, 1e7, 0.25, false}, {"upper", 10000, 1e7, 0.25, false}, {"wall", 0, 0, 0, true}};
    for (int a = 0; a < 3; ++a) {
      for (int b = a; b < 3; ++b) setup.pairs.push_back({a, b, reference.restitution, 0, 0, 1e3});
    }
    setup.walls = {PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 2},
                   PlaneWall{"lid", {0, 0, 1.8e-3}, {0, 0, -1}, {}, 2}};
    setup.contacts.normal = Linear{};
    setup.contacts.clip = false;
    setup.gravity = {0, 0, -g};
    setup.time_step = step;
    Engine engine(setup);
    engine.set_particles({{{2e-3, 2e-3, 0.45e-3}, {}, {}, radius, 0, false},
                          {{2e-3, 2e-3, 1.35e-3}, {}, {}, radius, 1, false}});
    Real largest = 0;
    for (const auto& [lower, upper] : reference.positions) {
      advance(engine, 1000);
      const auto all = grains(engine.particles());
      largest = std::max(
          {largest, std::abs(all[0].position.z * 1e3 - lower), std::abs(all[1].position.z * 1e3 - upper)});
    }
    expect_small("MFIX DEM03: positions of two stacked spheres through 1 ms, e " +
                     show(reference.restitution) + ", largest deviation [mm]",
                 largest, 1e-6,
                 "Verlet, ω Δt = 0.002: phase error 1e-6 rad of amplitudes of 0.05 mm; figures of 8 digits");
  }
}

/// A sphere set down with 0.1 m/s without spin: the time when it has ceased to slide, and its motion then.
void check_slip(const std::string& name, const ContactOptions& laws) {
  const Real radius = 5e-4, v0 = 0.1, step = 4e-6;
  const Solid solid{1e7, 0.25, 1e4};
  Real velocity = 0, spin = 0, time = 0;
  for (const Real friction : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    EngineSetup setup;
    setup.domain.box = {{0, 0, 0}, {0.02, 0.01, 0.01}};
    setup.materials = {{"solid", solid.density, solid.youngs_modulus, solid.poisson_ratio, false},
                       {"floor", 0, 0, 0, true}};
    setup.pairs = {{0, 0, 0.9, friction, 0}, {0, 1, 0.9, friction, 0}};
    setup.contacts = laws;
    setup.gravity = {0, 0, -g};
    setup.walls = {PlaneWall{"floor", {0, 0, 0}, {0, 0, 1}, {}, 1}};
    setup.time_step = step;
    const Real weight = sphere_mass(solid, radius) * g;
    const Real overlap = std::pow(0.75 * weight / (wall_modulus(solid) * std::sqrt(radius)), 2.0 / 3.0);
    Engine engine(setup);
    engine.set_particles({{{0.005, 0.005, radius - overlap}, {v0, 0, 0}, {}, radius, 0, false}});
    const Real end = 2 * v0 / (7 * friction * g);
    // The end of the slip, from the deceleration over its first half and the final speed.
    const auto half = static_cast<int>(end / step / 2);
    advance(engine, half);
    const Real deceleration = (v0 - grains(engine.particles())[0].velocity.x) / (half * step);
    advance(engine, 2 * half);
    // Mean over as long again: a spring rocks a little after it has caught the sphere.
    Real v = 0, w = 0;
    for (int k = 0; k < 100; ++k) {
      advance(engine, half / 50);
      const Grain s = grains(engine.particles())[0];
      v += s.velocity.x / 100;
      w += s.spin.y / 100;
    }
    velocity = std::max(velocity, std::abs(v / v0 - 5.0 / 7));
    spin = std::max(spin, std::abs(w * radius / v0 - 5.0 / 7));
    time = std::max(time, std::abs(friction * g * (v0 - v) / deceleration / v0 - 2.0 / 7));
  }
  const std::string why = "at any µ (0.2 to 1 tried); the lever is short by δ/R = 1e-3";
  expect_small("MFIX DEM04, " + name + ": v/v_0 when it rolls, minus 5/7", velocity, 5e-4, why);
  expect_small("MFIX DEM04, " + name + ": ω R/v_0 when it rolls, minus 5/7", spin, 1e-3, why);
  expect_small("MFIX DEM04, " + name + ": µ g t/v_0 at the end of the slip, minus 2/7", time, 5e-4, why);
}

TEST(Mfix, Dem04SlidesUntilItRolls) { check_slip("viscous_coulomb", ContactOptions{}); }

}  // namespace
}  // namespace pellicle::dem
