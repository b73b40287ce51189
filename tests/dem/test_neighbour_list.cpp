// The neighbour lists against a search of all pairs, images included.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <ostream>
#include <vector>

#include "dem/wall_list.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

using tests::random_vector;

struct Cloud {
  std::vector<PositionRadius> place;
  std::vector<VelocitySpin> motion;  // id = index
};

/// `count` points at random in (and, along open axes, a little out of) the box, with radii as often small as large and
/// speeds from 0 to far too fast.
Cloud make_cloud(const Box& box, int count, Real radius_from, Real radius_to, Real outside, int seed) {
  Cloud cloud;
  const Vec3 length = box.max - box.min;
  for (int p = 0; p < count; ++p) {
    const Vec3 x = random_vector(seed, p);
    const Vec3 v = random_vector(seed + 1, p);
    const Real share = 0.5 + 0.5 * random_vector(seed + 2, p).x;
    const Real stretch = 0.5 * (1 + outside);
    cloud.place.push_back({box.min.x + length.x * (0.5 + stretch * x.x),
                           box.min.y + length.y * (0.5 + stretch * x.y),
                           box.min.z + length.z * (0.5 + stretch * x.z),
                           radius_from * std::pow(radius_to / radius_from, share)});
    const Real speed = std::pow(10.0, 3 * random_vector(seed + 2, p).y);
    cloud.motion.push_back({speed * v.x, speed * v.y, speed * v.z, 0, 0, 0, 1, 0, p});
  }
  return cloud;
}

struct Rows {
  std::map<int, std::vector<int>> pairs, walls;  // id -> ids, id -> walls, in list order
  std::vector<int> order;                        // ids in canonical order
};

/// Builds with particle order[s] of the cloud in place s of memory.
Rows build_rows(const Domain& domain, const SkinOptions& skin, const std::vector<PlaneWall>& walls,
                Real time_step, const Cloud& cloud, const std::vector<int>& order, bool half = false) {
  const std::size_t n = cloud.place.size();
  Particles particles;
  particles.count = static_cast<Index>(n);
  particles.position_radius = DeviceArray<PositionRadius>("test::neighbour_list::place", n);
  particles.velocity_spin = DeviceArray<VelocitySpin>("test::neighbour_list::motion", n);
  const auto place = Kokkos::create_mirror_view(particles.position_radius);
  const auto motion = Kokkos::create_mirror_view(particles.velocity_spin);
  for (std::size_t s = 0; s < n; ++s) {
    place(s) = cloud.place[static_cast<std::size_t>(order[s])];
    motion(s) = cloud.motion[static_cast<std::size_t>(order[s])];
  }
  Kokkos::deep_copy(particles.position_radius, place);
  Kokkos::deep_copy(particles.velocity_spin, motion);
  const auto [small, large] = std::minmax_element(
      cloud.place.begin(), cloud.place.end(),
      [](const PositionRadius& a, const PositionRadius& b) { return a.radius < b.radius; });
  NeighbourSearch search(domain, skin, small->radius, large->radius);
  NeighbourList list;
  list.half = half;
  search.build(particles, time_step, list,
               DeviceArray<Real>("test::neighbour_list::scratch", NeighbourSearch::scratch_size(n)));
  WallList wall_list;
  build_wall_list(particles, list, 1, make_wall_geometry({walls.begin(), walls.end()}), wall_list);
  Kokkos::fence();
  const auto offset = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, list.offset);
  const auto partner = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, list.partner);
  const auto wall_offset = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, wall_list.offset);
  const auto wall = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, wall_list.surface);
  const auto wall_particle = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, wall_list.particle);
  const auto canonical = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, search.order());
  Rows rows;
  for (std::size_t p = 0; p < n; ++p) {
    const int id = order[p];
    auto& row = rows.pairs[id];
    for (int s = offset(p); s < offset(p + 1); ++s)
      row.push_back(order[static_cast<std::size_t>(partner(s))]);
    rows.walls[id];
    rows.order.push_back(order[static_cast<std::size_t>(canonical(p))]);
  }
  for (int k = 0; k < wall_list.count; ++k) {
    auto& row = rows.walls.at(order[static_cast<std::size_t>(wall_particle(k))]);
    EXPECT_TRUE(row.empty()) << "a particle has two rows";
    for (int s = wall_offset(k); s < wall_offset(k + 1); ++s) row.push_back(wall(s));
  }
  return rows;
}

/// Radius of each particle and what it may move: its own speed over `steps` steps, within the bounds of the skin.
std::vector<Real> expected_reach(const SkinOptions& skin, Real time_step, const Cloud& cloud) {
  Real smallest = cloud.place[0].radius;
  Real largest = smallest;
  for (const auto& x : cloud.place) {
    smallest = std::min(smallest, x.radius);
    largest = std::max(largest, x.radius);
  }
  std::vector<Real> reach;
  for (std::size_t p = 0; p < cloud.place.size(); ++p) {
    const Real travel = skin.steps * time_step * norm(cloud.motion[p].velocity());
    reach.push_back(cloud.place[p].radius + std::min(std::max(travel, skin.smallest_fraction * smallest),
                                                     skin.largest_fraction * largest));
  }
  return reach;
}

struct Situation {
  const char* name;
  Domain domain;
  int count;
  Real radius_from, radius_to;
  Real outside;  // share of the box by which points may lie out of it
};

std::ostream& operator<<(std::ostream& out, const Situation& situation) { return out << situation.name; }

class NeighbourList : public ::testing::TestWithParam<Situation> {};

TEST_P(NeighbourList, HoldsExactlyWhatIsInReach) {
  const Situation& s = GetParam();
  const Real time_step = 1e-4;
  const SkinOptions skin;
  const Box& box = s.domain.box;
  const Cloud cloud = make_cloud(box, s.count, s.radius_from, s.radius_to, s.outside, 11);
  const std::vector<PlaneWall> walls{{"floor", box.min, {0, 0, 1}, {}, 0},
                                     {"slope", 0.5 * (box.min + box.max), {0.6, 0, 0.8}, {}, 0}};
  std::vector<int> order(cloud.place.size());
  std::iota(order.begin(), order.end(), 0);
  const Rows rows = build_rows(s.domain, skin, walls, time_step, cloud, order);

  const std::vector<Real> own_reach = expected_reach(skin, time_step, cloud);
  int listed = 0;
  const Vec3 length = box.max - box.min;
  for (std::size_t a = 0; a < cloud.place.size(); ++a) {
    std::vector<int> expected;
    for (std::size_t b = 0; b < cloud.place.size(); ++b) {
      if (a == b) continue;
      const Real reach = own_reach[a] + own_reach[b];
      bool near = false;
      for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
          for (int k = -1; k <= 1; ++k) {
            if ((i != 0 && s.domain.periodic.x == 0) || (j != 0 && s.domain.periodic.y == 0) ||
                (k != 0 && s.domain.periodic.z == 0))
              continue;
            const Vec3 image{i * length.x, j * length.y, k * length.z};
            near = near || norm(cloud.place[b].position() + image - cloud.place[a].position()) < reach;
          }
        }
      }
      if (near) expected.push_back(static_cast<int>(b));
    }
    // Sorted, each partner once: with the rows of both, every pair exactly twice.
    std::vector<int> row = rows.pairs.at(static_cast<int>(a));
    listed += static_cast<int>(row.size());
    std::sort(row.begin(), row.end());
    EXPECT_EQ(row, expected) << "particle " << a;
    std::vector<int> expected_walls;
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const Real distance = dot(walls[w].normal, cloud.place[a].position() - walls[w].point);
      if (distance < own_reach[a]) expected_walls.push_back(static_cast<int>(w));
    }
    EXPECT_EQ(rows.walls.at(static_cast<int>(a)), expected_walls) << "particle " << a;
  }
  EXPECT_GT(listed, s.count) << "too few neighbours to test anything";
  EXPECT_EQ(listed % 2, 0);
}

TEST_P(NeighbourList, DoesNotDependOnTheOrderInMemory) {
  const Situation& s = GetParam();
  const Cloud cloud = make_cloud(s.domain.box, s.count, s.radius_from, s.radius_to, s.outside, 12);
  const std::vector<PlaneWall> walls{{"floor", s.domain.box.min, {0, 0, 1}, {}, 0}};
  std::vector<int> order(cloud.place.size());
  std::iota(order.begin(), order.end(), 0);
  const Rows rows = build_rows(s.domain, {}, walls, 1e-4, cloud, order);
  std::vector<int> shuffled = order;
  std::sort(shuffled.begin(), shuffled.end(),
            [](int a, int b) { return random_vector(13, a).x < random_vector(13, b).x; });
  ASSERT_NE(shuffled, order);
  const Rows again = build_rows(s.domain, {}, walls, 1e-4, cloud, shuffled);
  EXPECT_EQ(rows.pairs, again.pairs);  // rows in the same order, entry by entry
  EXPECT_EQ(rows.walls, again.walls);
  EXPECT_EQ(rows.order, again.order);
}

TEST(HalfList, HasEachPairOfABlockOnceAndOthersTwice) {
  // Three blocks, the last not full.
  const Domain domain{{{0, 0, 0}, {0.06, 0.05, 0.04}}, {1, 0, 0}, {}, {}};
  Cloud cloud = make_cloud(domain.box, 2 * list_block + 300, 0.001, 0.0015, 0, 12);
  for (std::size_t p = 0; p < cloud.motion.size(); p += 10) cloud.motion[p].inverse_mass = 0;
  std::vector<int> order(cloud.place.size());
  std::iota(order.begin(), order.end(), 0);
  const Rows full = build_rows(domain, {}, {}, 1e-4, cloud, order);
  const Rows half = build_rows(domain, {}, {}, 1e-4, cloud, order, true);
  std::size_t once = 0;
  std::size_t twice = 0;
  for (const auto& [p, row] : full.pairs) {
    std::vector<int> expected;
    for (const int q : row) {
      if (p % 10 == 0 && q % 10 == 0) continue;
      const bool together = p / list_block == q / list_block;
      if (together && q < p) continue;
      ++(together ? once : twice);
      expected.push_back(q);
    }
    EXPECT_EQ(half.pairs.at(p), expected) << p;
  }
  EXPECT_GT(once, 1000U);
  EXPECT_GT(twice, 1000U);
}

// Radius 2 mm: cells of at least 5.6 mm. A periodic axis of 12 mm has two cells, of 17 mm three, of 40 mm seven.
INSTANTIATE_TEST_SUITE_P(
    All, NeighbourList,
    ::testing::Values(
        Situation{"Closed", {{{-0.01, 0.02, 0}, {0.04, 0.06, 0.03}}}, 600, 0.002, 0.002, 0},
        Situation{"PointsOutside", {{{-0.01, 0.02, 0}, {0.04, 0.06, 0.03}}}, 600, 0.002, 0.002, 0.4},
        Situation{"Polydisperse", {{{0, 0, 0}, {0.05, 0.04, 0.03}}}, 700, 0.0005, 0.002, 0},
        Situation{"SizeRatio3", {{{0, 0, 0}, {0.05, 0.04, 0.03}}}, 900, 0.0008, 0.0024, 0.2},
        Situation{"SizeRatio20", {{{0, 0, 0}, {0.05, 0.04, 0.03}}}, 1500, 0.0002, 0.004, 0.2},
        Situation{"SizeRatio300", {{{0, 0, 0}, {0.05, 0.04, 0.03}}}, 1200, 0.00002, 0.006, 0},
        // Two reaches of the largest are 22.4 mm: one cell of the coarsest level, twenty and more of the finest.
        Situation{"PeriodicSizeRatio20",
                  {{{0, -0.01, 0}, {0.0225, 0.0225, 0.03}}, {1, 1, 0}},
                  900,
                  0.0002,
                  0.004,
                  0},
        Situation{
            "PeriodicSizeRatio3", {{{0, 0, 0}, {0.02, 0.03, 0.0135}}, {1, 0, 1}}, 500, 0.0008, 0.0024, 0},
        Situation{"OneCell", {{{0, 0, 0}, {0.009, 0.008, 0.01}}}, 60, 0.001, 0.002, 0},
        Situation{"PeriodicTwoThreeSevenCells",
                  {{{0.1, 0, -0.02}, {0.112, 0.017, 0.02}}, {1, 1, 1}},
                  200,
                  0.001,
                  0.002,
                  0},
        Situation{"PeriodicAlongY", {{{0, 0, 0}, {0.03, 0.012, 0.03}}, {0, 1, 0}}, 300, 0.002, 0.002, 0},
        Situation{"PeriodicAlongX", {{{0, 0, 0}, {0.04, 0.03, 0.012}}, {1, 0, 0}}, 300, 0.001, 0.002, 0},
        Situation{"SmallParticlesInALargeDomain", {{{0, 0, 0}, {3, 2, 1}}}, 300, 0.00001, 0.00002, -0.9999}),
    [](const auto& situation) { return std::string(situation.param.name); });

TEST(NeighbourSearch, RefusesAPeriodicAxisThatHoldsTwoImages) {
  Domain domain{{{0, 0, 0}, {0.1, 0.0111, 0.1}}, {0, 1, 0}};
  EXPECT_THROW(NeighbourSearch(domain, {}, 0.001, 0.002), std::invalid_argument);
  domain.box.max.y = 0.0113;  // two reaches are 4 × 2 mm × 1.4 = 11.2 mm
  EXPECT_NO_THROW(NeighbourSearch(domain, {}, 0.001, 0.002));
}

/// What it takes to look for the neighbours of all particles: candidates tested, and runs of them looked up.
struct Effort {
  Real candidates = 0, runs = 0, entries = 0;
  Index cells = 0;
};

/// Points at random, `solids_fraction` of the box in large spheres and as much in small ones.
Effort measure_effort(Real size_ratio, Real solids_fraction, bool periodic, bool hierarchical) {
  const Real length = 0.1;
  const Real large = 0.01;
  Cloud cloud;
  for (const Real radius : {large, large / size_ratio}) {
    const int count =
        static_cast<int>(solids_fraction * std::pow(length, 3) / (4.0 / 3.0 * M_PI * std::pow(radius, 3)));
    for (int k = 0; k < count; ++k) {
      const auto p = static_cast<int>(cloud.place.size());
      const Vec3 x = 0.5 * length * (random_vector(31, p) + Vec3{1, 1, 1});
      cloud.place.push_back({x.x, x.y, x.z, radius});
      cloud.motion.push_back({0, 0, 0, 0, 0, 0, 1, 0, p});
    }
  }
  Particles particles;
  const std::size_t n = cloud.place.size();
  particles.count = static_cast<Index>(n);
  particles.position_radius = DeviceArray<PositionRadius>("test::neighbour_list::place", n);
  particles.velocity_spin = DeviceArray<VelocitySpin>("test::neighbour_list::motion", n);
  std::copy(cloud.place.begin(), cloud.place.end(), particles.position_radius.data());
  std::copy(cloud.motion.begin(), cloud.motion.end(), particles.velocity_spin.data());
  const Domain domain{{{0, 0, 0}, {length, length, length}}, {periodic ? 1 : 0, periodic ? 1 : 0, 0}};
  NeighbourSearch search(domain, {}, hierarchical ? large / size_ratio : large, large);
  dem::NeighbourList list;
  list.half = false;
  search.build(particles, 0, list,
               DeviceArray<Real>("test::neighbour_list::scratch", NeighbourSearch::scratch_size(n)));
  Kokkos::fence();
  Effort effort;
  for (std::size_t p = 0; p < n; ++p) {
    PositionRadius self = particles.position_radius(p);
    self.radius = reach_of(self, list.displacement(p));
    visit_runs<true>(search.grid(), search.cell_start(), self, [&](std::int32_t begin, std::int32_t end) {
      effort.candidates += end - begin;
      effort.runs += 1;
    });
  }
  const auto total = static_cast<Real>(n);
  effort.candidates /= total;
  effort.runs /= total;
  effort.entries = list.offset(n) / total;
  effort.cells = search.grid().cell_count();
  EXPECT_LE(effort.cells, 2 * particles.count + 256 * most_levels);
  return effort;
}

TEST(NeighbourSearch, CostsAParticleNoMoreWhereSizesDiffer) {
  // In operations, not in time. Among equal spheres of reach a, cells 2a wide: the run of a particle is at most 27 cells
  // for the 4π/3 (2a)³ that hold its neighbours, so that at most 27·3/4π = 6.4 candidates, the particle itself and the
  // scatter of small numbers apart, are tested for one that is in reach. Cells of another level fit a pair better or
  // worse: the large neighbours of a small particle are looked for within 27 cells of 2A, of which (A + a)³ 4π/3 is of
  // use, which is 8 times more; but they are few.
  for (const bool periodic : {false, true}) {
    const Effort equal = measure_effort(1.0001, 0.25, periodic, true);
    for (const Real ratio : {3.0, 10.0}) {
      const Effort effort = measure_effort(ratio, 0.25, periodic, true);
      EXPECT_LT(effort.candidates, 6.5 * effort.entries + 20) << ratio;
      EXPECT_LT(effort.candidates, 3 * equal.candidates) << ratio;
      EXPECT_LT(effort.runs, 6 * equal.runs) << ratio;
    }
  }
  // Without levels the same costs a hundred times as much: the test sees the difference.
  const Effort levels = measure_effort(10, 0.05, false, true);
  const Effort flat = measure_effort(10, 0.05, false, false);
  EXPECT_GT(flat.candidates, 30 * levels.candidates);
}

/// Pairs that touch, found among all.
std::int64_t count_touching(const Domain& domain, const std::vector<tests::Grain>& grains) {
  std::int64_t touching = 0;
  for (std::size_t a = 0; a < grains.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      Vec3 d = grains[a].position - grains[b].position;
      for (int axis = 0; axis < 3; ++axis) {
        const Real l = domain.length()[axis];
        if (domain.periodic[axis] != 0) d[axis] -= l * std::round(d[axis] / l);
      }
      touching += norm(d) < grains[a].radius + grains[b].radius ? 1 : 0;
    }
  }
  return touching;
}

TEST(NeighbourSearch, MissesNoContactWhileParticlesMove) {
  // A fast and a slow crowd of two sizes that collide for 300 steps; the lists are rebuilt when somebody has used up
  // what it may move. Contacts at every step are those that a search of all pairs finds.
  auto setup = tests::glass_setup({0.03, 0.03, 0.03}, 5e-6, 0.9);
  setup.domain.periodic = {1, 0, 1};
  setup.contacts.overlap_limit = 1;  // soft grains, hard impacts
  tests::add_box_walls(setup);
  std::vector<Real> radii(120);
  for (std::size_t p = 0; p < 120; ++p) radii[p] = p % 2 == 0 ? 0.0018 : 0.001;
  const auto centres = tests::scatter({{0, 0.0018, 0}, {0.03, 0.0282, 0.03}}, radii, 0, 21);
  std::vector<ParticleSeed> seeds;
  for (int p = 0; p < 120; ++p) {
    const auto i = static_cast<std::size_t>(p);
    seeds.push_back({centres[i], (p % 3 == 0 ? 6.0 : 0.2) * random_vector(22, p), {}, radii[i], 0, false});
  }
  Engine engine(setup);
  engine.set_particles(seeds);
  std::int64_t seen = 0;
  for (int step = 0; step < 300; ++step) {
    const auto expected = count_touching(setup.domain, tests::grains(engine.particles()));
    tests::advance(engine, 1);
    ASSERT_EQ(engine.collect_report().touching_pairs, expected) << "step " << step;
    seen += expected;
  }
  EXPECT_GT(seen, 100);
  EXPECT_GT(engine.list_builds(), 5);
  EXPECT_LT(engine.list_builds(), 150) << "lists are to last for some steps";
}

}  // namespace
}  // namespace pellicle::dem
