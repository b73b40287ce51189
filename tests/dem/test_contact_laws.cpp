// Contact laws as functions of scalars, and the contact loop on single contacts, against numbers worked out elsewhere
// with 30 digits from the equations of docs/theory/dem.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "dem/contact_laws.hpp"
#include "dem/contact_loop.hpp"
#include "dem/wall_system.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

using tests::random_vector;

// The laws: a dozen roundings.
constexpr Real round_off = 1e-13;

// A contact of glass beads of 3 mm that overlap by 4 % of R*.
constexpr ContactState contact_at(Real approach_speed) { return {3e-5, 7.5e-4, 1.77e-5, approach_speed}; }
// E* 5 MPa, G* 1.1 MPa, Λ 0.122; 2 √(4 G*/E*) = 1.876166303929372.
constexpr PairParameters glass{5e6, 1.1e6, 0.122, 1.876166303929372, 0.3, 0.05};

TEST(Hertz, AddsSpringAndDamping) {
  const Hertz law;
  // (4/3) E* √R* δ^(3/2) = 0.03 N; 2 √(5/6) Λ √(S_n m*) v_n = 0.0145 N at 0.4 m/s.
  EXPECT_NEAR(law(contact_at(0), glass).force, 0.03, 0.03 * round_off);
  EXPECT_NEAR(law(contact_at(0.4), glass).force, 0.04451748738590807, 0.045 * round_off);
  EXPECT_NEAR(law(contact_at(-0.4), glass).force, 0.01548251261409193, 0.045 * round_off);
  EXPECT_NEAR(law(contact_at(0.4), glass).stiffness_mass_root, 0.1629417073680032, 0.16 * round_off);
}

TEST(Hertz, PullsOnlyWithoutClip) {
  EXPECT_EQ(Hertz{true}(contact_at(-1), glass).force, 0);
  EXPECT_NEAR(Hertz{false}(contact_at(-1), glass).force, 0.03 - 2.5 * 0.01451748738590807, 0.04 * round_off);
}

TEST(ViscousCoulomb, IsViscousBelowTheLimitAndCoulombAbove) {
  const NormalForce normal{0.03, 0.1629417073680032};
  const ContactState c = contact_at(0);
  // Δt 1e-5 s: (2/7) m*/(6 Δt) = 0.0843 is below the critical damping of S_t, 0.3057, and bounds it.
  const ViscousCoulomb coarse{1e-5};
  EXPECT_NEAR(coarse(c, normal, 1e-3, glass), 0.08428571428571429, 0.1 * round_off);
  // Δt 1e-6 s: the critical damping holds.
  const ViscousCoulomb fine{1e-6};
  EXPECT_NEAR(fine(c, normal, 1e-3, glass), 0.3057057408685679, 0.3 * round_off);
  EXPECT_NEAR(fine(c, normal, 0, glass), 0.3057057408685679, 0.3 * round_off);
  // µ F_n = 0.009 N is reached at 0.009/0.3057 = 0.0294 m/s; above, the force stays.
  EXPECT_NEAR(fine(c, normal, 0.029, glass), 0.3057057408685679, 0.3 * round_off);
  EXPECT_NEAR(fine(c, normal, 0.030, glass) * 0.030, 0.009, 0.009 * round_off);
  EXPECT_NEAR(fine(c, normal, 7, glass) * 7, 0.009, 0.009 * round_off);
  // No friction where the normal force was clipped, or pulls.
  EXPECT_EQ(fine(c, {0, 0.16}, 1, glass), 0);
  EXPECT_EQ(fine(c, {-0.1, 0.16}, 1, glass), 0);
}

TEST(ConstantTorque, IsSteadyAndNeverReversesTheSpin) {
  const ConstantTorque law{1e-5};
  const ContactState c = contact_at(0);
  // µ_r R* F_n = 0.05 × 7.5e-4 m × 0.03 N.
  EXPECT_NEAR(law(c, 0.03, 100, 1e9, glass) * 100, 1.125e-6, 1.125e-6 * round_off);
  EXPECT_NEAR(law(c, 0.03, 1000, 1e9, glass) * 1000, 1.125e-6, 1.125e-6 * round_off);
  // Below 1.125e-6 N m × 1.5 × 1e-5 s × 1e9/(kg m²) = 0.016875 rad/s two thirds of what stops it.
  EXPECT_NEAR(law(c, 0.03, 0.0168, 1e9, glass), 2.0 / 3.0 / (1e-5 * 1e9), 1e-4 * round_off);
  EXPECT_NEAR(law(c, 0.03, 0.0169, 1e9, glass) * 0.0169, 1.125e-6, 1.125e-6 * round_off);
  EXPECT_EQ(law(c, -0.01, 100, 1e9, glass), 0);
}

/// Contact forces and torques of particles as given, by the loop, in the order given; `touching` are the contacts of
/// each in the substep before (0: none yet).
struct LoopResult {
  std::vector<Vec3> force, torque;
  std::vector<std::int32_t> touching;
  BlockReport report;
  WallReport wall_report;
};

/// `half`: over half lists, in single precision, instead of full lists in double precision.
LoopResult run_loop(const EngineSetup& setup, const std::vector<ParticleSeed>& seeds,
                    std::int32_t touching = 0, bool half = false) {
  const std::size_t n = seeds.size();
  ContactInput in;
  in.domain = setup.domain;
  in.particles.count = static_cast<Index>(n);
  in.particles.position_radius = DeviceArray<PositionRadius>("test::contact_laws::place", n);
  in.particles.velocity_spin = DeviceArray<VelocitySpin>("test::contact_laws::motion", n);
  in.particles.mass = DeviceArray<Real>("test::contact_laws::mass", n);
  const auto place = Kokkos::create_mirror_view(in.particles.position_radius);
  const auto motion = Kokkos::create_mirror_view(in.particles.velocity_spin);
  Real largest = 0;
  Real smallest = 1;
  in.one_particle_material = true;
  for (std::size_t p = 0; p < n; ++p) {
    const ParticleSeed& s = seeds[p];
    const Real r = s.radius;
    const Real mass =
        setup.materials[static_cast<std::size_t>(s.material)].density * 4 / 3 * M_PI * r * r * r;
    place(p) = {s.position.x, s.position.y, s.position.z, r};
    motion(p) = {s.velocity.x, s.velocity.y,           s.velocity.z, s.spin.x,           s.spin.y,
                 s.spin.z,     s.fixed ? 0 : 1 / mass, s.material,   static_cast<int>(p)};
    largest = std::max(largest, r);
    smallest = std::min(smallest, r);
    in.one_particle_material = in.one_particle_material && s.material == 0;
  }
  Kokkos::deep_copy(in.particles.position_radius, place);
  Kokkos::deep_copy(in.particles.velocity_spin, motion);
  WallSystem walls(setup.walls, setup.domain.box);
  const auto table = make_pair_table(setup.materials, setup.pairs, setup.contacts.clip);
  in.table = DeviceArray<PairParameters>("test::contact_laws::table", table.size());
  const auto table_host = Kokkos::create_mirror_view(in.table);
  std::copy(table.begin(), table.end(), table_host.data());
  Kokkos::deep_copy(in.table, table_host);
  in.materials = static_cast<Index>(setup.materials.size());
  in.kick = setup.time_step;
  NeighbourSearch search(setup.domain, setup.skin, smallest, largest);
  in.list.half = half;
  search.build(in.particles, setup.time_step, in.list,
               DeviceArray<Real>("test::contact_laws::scratch", NeighbourSearch::scratch_size(n)));
  walls.move_to(0);
  walls.build_list(in.particles, in.list, 1);

  ContactOptions options = setup.contacts;
  options.tangential = ViscousCoulomb{setup.time_step};
  options.rolling = ConstantTorque{setup.time_step};
  ContactResult out;
  out.load = DeviceArray<ContactLoad>("test::contact_laws::load", n);
  out.touching = DeviceArray<std::int32_t>("test::contact_laws::touching", n);
  out.report = DeviceArray<BlockReport>("test::contact_laws::report",
                                        static_cast<std::size_t>(contact_block_count(in.particles.count)));
  Kokkos::deep_copy(out.touching, touching);
  compute_contact_forces(in, options, out);
  walls.add_contacts(in, options, out);
  Kokkos::fence();
  LoopResult result;
  const auto load = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, out.load);
  const auto report = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, out.report);
  for (std::size_t p = 0; p < n; ++p) {
    result.force.push_back(load(p).force);
    result.torque.push_back(load(p).torque);
    result.touching.push_back(static_cast<std::int32_t>(load(p).touching));
  }
  result.report = report(0);
  if (walls.count() > 0) result.wall_report = walls.collect_reports().at(0);
  return result;
}

/// The overlap is a difference of lengths a hundred times larger and carries a power of 1.5; torques at rest are
/// differences of slips: four digits beyond the 16 of double.
constexpr Real close = 1e-12;
/// Single precision: 30 roundings of 6e-8, and slips that are a twentieth of the velocities they come from.
constexpr Real close_in_single = 4e-5;

void expect_close(const Vec3& value, const Vec3& expected, const char* what, Real relative = close) {
  const Real tolerance = relative * norm(expected);
  EXPECT_LE(norm(value - expected), tolerance)
      << what << ": (" << value.x << ", " << value.y << ", " << value.z << ") instead of (" << expected.x
      << ", " << expected.y << ", " << expected.z << ")";
}

/// Spheres of 1 and 2 mm, the second at (1.2, 1.6, 2.0) mm from the first: they overlap by 0.17 mm.
EngineSetup pair_setup() {
  auto setup = tests::glass_setup({0.03, 0.03, 0.03}, 1e-5);
  setup.materials = {
      {"glass", 2500, 1e7, 0.25, false}, {"wall", 0, 0, 0, true}, {"other", 4000, 2e7, 0.3, false}};
  setup.pairs = {{0, 0, 0.7, 0.1, 0.05}, {0, 1, 0.9, 0.2, 0.02}, {0, 2, 0.7, 0.1, 0.05}, {2, 2, 0.5, 0, 0}};
  return setup;
}

struct PairCase {
  const char* name;
  Vec3 velocity[2], spin[2];
  int second_material;
  Vec3 force, torque[2];
};

TEST(ContactLoop, PairsAgreeWithHandCalculation) {
  const Vec3 fast_velocity[2]{{0.3, 0.1, 0.2}, {-0.1, 0.2, -0.3}};
  const Vec3 fast_spin[2]{{2000, -1500, 1000}, {600, 1400, -250}};
  const Vec3 slow_velocity[2]{{0.3, 0.4, 0.5}, {0.29, 0.41, 0.51}};
  const Vec3 slow_spin[2]{{0.5, -0.2, 0.3}, {0.1, 0.4, -0.25}};
  const PairCase cases[] = {
      {"slides, one material",
       {fast_velocity[0], fast_velocity[1]},
       {fast_spin[0], fast_spin[1]},
       0,
       {-0.198250160869685, -0.2087001376668408, -0.3246287135500546},
       {{-3.770906483619519e-5, 9.91059767952863e-6, 1.565512336072062e-5},
        {-6.429660151021067e-5, -1.685646315883301e-5, 5.11049688305664e-5}}},
      {"sticks, one material",
       {slow_velocity[0], slow_velocity[1]},
       {slow_spin[0], slow_spin[1]},
       0,
       {-0.1755456972392161, -0.2329700526970601, -0.291358162345672},
       {{-1.811144283275342e-7, -2.942756081519155e-7, 2.601440953736469e-7},
        {-5.183993062754384e-8, -1.167324055473761e-6, 1.048908250899941e-6}}},
      {"slides, two materials",
       {fast_velocity[0], fast_velocity[1]},
       {fast_spin[0], fast_spin[1]},
       2,
       {-0.2655314822251912, -0.2795279290174416, -0.4347998665103932},
       {{-5.050661162319317e-5, 1.327401541586935e-5, 2.09680945132893e-5},
        {-8.611731675855278e-5, -2.257714005377982e-5, 6.844876222608664e-5}}},
      {"sticks, two materials",
       {slow_velocity[0], slow_velocity[1]},
       {slow_spin[0], slow_spin[1]},
       2,
       {-0.2362057877994307, -0.313802744011177, -0.3924053567698115},
       {{-1.855245827656326e-7, -3.122667786966469e-7, 2.762182388614358e-7},
        {-5.755822657879669e-8, -1.212880696391016e-6, 1.089749426815352e-6}}},
  };
  for (const PairCase& c : cases) {
    SCOPED_TRACE(c.name);
    const Vec3 x{0.01, 0.01, 0.01};
    const std::vector<ParticleSeed> seeds{
        {x, c.velocity[0], c.spin[0], 1e-3, 0, false},
        {x + Vec3{0.0012, 0.0016, 0.002}, c.velocity[1], c.spin[1], 2e-3, c.second_material, false}};
    // A contact counts as one for the cap of the rolling torque when it has just begun (0) and when it goes on (1).
    for (const int touching : {0, 1, 2, 3}) {
      const bool half = half_lists && touching >= 2;
      const Real relative = half ? close_in_single : close;
      const LoopResult result = run_loop(pair_setup(), seeds, touching % 2, half);
      expect_close(result.force[0], c.force, "force", relative);
      expect_close(result.force[1], -c.force, "force on the second", relative);
      expect_close(result.torque[0], c.torque[0], "torque", relative);
      expect_close(result.torque[1], c.torque[1], "torque on the second", relative);
      EXPECT_EQ(result.touching, (std::vector<std::int32_t>{1, 1}));
      EXPECT_EQ(result.report.touching, 2);
      // δ = 3 mm − √8 mm.
      EXPECT_NEAR(result.report.largest_overlap, 3 - std::sqrt(8.0), relative);
    }
  }
}

TEST(ContactLoop, WallsAgreeWithHandCalculation) {
  auto setup = pair_setup();
  // A wall at z = 0 whose surface moves; the sphere of 1 mm stands 0.95 mm above it.
  setup.walls = {PlaneWall{"belt", {0.02, 0.03, 0}, {0, 0, 1}, {0.01, -0.02, 0}, 1}};
  struct WallCase {
    Vec3 velocity, spin, force, torque;
  };
  const WallCase cases[] = {
      {{0.3, 0.1, -0.2},
       {500, -200, 300},
       {-0.02031892673136812, -0.02518700292742507, 0.161805740007951},
       {-2.655248849017426e-5, 2.035291467844789e-5, -1.574901425472269e-6}},
      {{0.011, -0.02, -0.2},
       {0.4, -0.2, 0.3},
       {-5.934119456780721e-5, -1.894928902165272e-5, 0.161805740007951},
       {-1.297028966982072e-7, 1.122246709032354e-7, -8.377580409572782e-8}},
  };
  for (const WallCase& c : cases) {
    const LoopResult result = run_loop(setup, {{{0.01, 0.01, 0.00095}, c.velocity, c.spin, 1e-3, 0, false}});
    expect_close(result.force[0], c.force, "force");
    expect_close(result.torque[0], c.torque, "torque");
    EXPECT_EQ(result.wall_report.touching, 1);
    EXPECT_NEAR(result.wall_report.largest_overlap, 0.05, 1e-12);
    EXPECT_NEAR(result.wall_report.largest_approach_speed, 0.2, 1e-14);
    expect_close(result.wall_report.impulse, 1e-5 * c.force, "impulse of the wall");
  }
}

TEST(ContactLoop, CapOfTheRollingTorqueIsSharedAmongContacts) {
  // The slow pair, its rolling torque capped, as if each had five contacts: a fifth of the torque of one contact.
  auto setup = pair_setup();
  setup.pairs[0].sliding_friction = 0;
  const Vec3 x{0.01, 0.01, 0.01};
  const std::vector<ParticleSeed> seeds{
      {x, {0.3, 0.4, 0.5}, {0.5, -0.2, 0.3}, 1e-3, 0, false},
      {x + Vec3{0.0012, 0.0016, 0.002}, {}, {0.1, 0.4, -0.25}, 2e-3, 0, false}};
  const LoopResult one = run_loop(setup, seeds, 1);
  const LoopResult five = run_loop(setup, seeds, 5);
  expect_close(one.torque[0], 5.0 * five.torque[0], "torque");
  // With I = 0.4 m R² and all of it acting, two thirds of the relative spin go within the step.
  const Real mass = 2500 * 4.0 / 3.0 * M_PI * 1e-9;
  const Vec3 change = 1e-5 * (1 / (0.4 * mass * 1e-6) + 1 / (0.4 * 8 * mass * 4e-6)) * one.torque[0];
  expect_close(change, -2.0 / 3.0 * Vec3{0.4, -0.6, 0.55}, "change of the relative spin");
}

TEST(ContactLoop, PairForcesAreOppositeToTheLastBit) {
  // 300 pairs of random size, place, speed and spin, far from each other; frictionless ones show the rolling torque.
  for (const int which : {0, 1, 2, 3}) {
    const bool friction = which % 2 == 0;
    auto setup = tests::glass_setup({1, 1, 1}, 1e-5, 0.7, friction ? 0.3 : 0.0, 0.02);
    setup.domain.periodic = {1, 0, 1};  // some pairs reach over the edge
    std::vector<ParticleSeed> seeds;
    for (int pair = 0; pair < 300; ++pair) {
      const int layer = pair / 100;
      const int row = pair / 10 % 10;
      const Vec3 x{0.1 * (pair % 10), 0.05 + 0.1 * row, 0.1 * layer};
      const Vec3 sizes = 0.002 * random_vector(1, pair);
      const Real ri = 0.003 + sizes.x;
      const Real rj = 0.003 + sizes.y;
      const Vec3 n = random_vector(2, pair);
      const Vec3 d = (0.9 * (ri + rj) / norm(n)) * n;
      seeds.push_back({x - 0.5 * d, random_vector(3, pair), 100.0 * random_vector(4, pair), ri, 0, false});
      seeds.push_back({x + 0.5 * d, random_vector(5, pair), 100.0 * random_vector(6, pair), rj, 0, false});
    }
    const LoopResult result = run_loop(setup, seeds, 0, half_lists && which >= 2);
    for (std::size_t p = 0; p < seeds.size(); p += 2) {
      ASSERT_EQ(result.touching[p], 1) << p;
      ASSERT_GT(norm(result.force[p]), 0);
      EXPECT_EQ(result.force[p], -result.force[p + 1]) << p;
      if (friction) continue;
      ASSERT_GT(norm(result.torque[p]), 0);
      EXPECT_EQ(result.torque[p], -result.torque[p + 1]) << p;
    }
  }
}

TEST(ContactLoop, HalfAndFullListsAgree) {
  // 3000 particles, three blocks of half lists, much overlapping, of two materials; every tenth is fixed. Fixed particles do
  // not touch each other.
  auto setup = pair_setup();
  setup.domain = {{{0, 0, 0}, {0.06, 0.06, 0.06}}, {1, 0, 1}, {}, {}};
  std::vector<ParticleSeed> seeds;
  for (int p = 0; p < 3000; ++p) {
    const Vec3 x = 0.03 * (random_vector(1, p) + Vec3{1, 1, 1});
    seeds.push_back({x, random_vector(2, p), 100.0 * random_vector(3, p),
                     1e-3 * (1.5 + random_vector(4, p).x), p % 3 == 0 ? 2 : 0, p % 10 == 0});
  }
  // Near each other in memory what is near in space, or hardly a pair is within a block.
  std::sort(seeds.begin(), seeds.end(),
            [](const auto& a, const auto& b) { return a.position.z < b.position.z; });
  const LoopResult full = run_loop(setup, seeds, 3);
  const LoopResult half = run_loop(setup, seeds, 3, true);
  EXPECT_EQ(half.touching, full.touching);
  Real largest_force = 0;
  Real largest_torque = 0;
  for (std::size_t p = 0; p < seeds.size(); ++p) {
    largest_force = std::max(largest_force, norm(full.force[p]));
    largest_torque = std::max(largest_torque, norm(full.torque[p]));
  }
  ASSERT_GT(std::accumulate(full.touching.begin(), full.touching.end(), 0), 5000);
  // A particle has up to 30 contacts, each with an error of 2.4e-6 of its force at most (test_contact_precision.cpp), that
  // is much less than 1e-5 of the largest sum.
  for (std::size_t p = 0; p < seeds.size(); ++p) {
    EXPECT_LT(norm(half.force[p] - full.force[p]), 1e-5 * largest_force) << p;
    EXPECT_LT(norm(half.torque[p] - full.torque[p]), 1e-5 * largest_torque) << p;
  }
}

}  // namespace
}  // namespace pellicle::dem
