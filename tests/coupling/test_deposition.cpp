// Sums over cells, the bound of the void fraction, and the mapping between grids: nothing is lost on the way.
#include <gtest/gtest.h>

#include <map>

#include "core/error.hpp"
#include "coupling/cell_sums.hpp"
#include "coupling/grid_mapping.hpp"
#include "coupling/void_fraction_bound.hpp"
#include "tests/coupling/helpers.hpp"

namespace pellicle::coupling {
namespace {

using testing::make_particles;
using testing::TestParticle;

const Box box{{0, 0, 0}, {0.03, 0.02, 0.06}};

template <class T>
void fill(const DeviceArray<T>& view, const std::vector<T>& values) {
  const auto host = Kokkos::create_mirror_view(view);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(view, host);
}

std::vector<CellLoad> make_loads(const std::vector<TestParticle>& particles) {
  std::vector<CellLoad> loads;
  for (const TestParticle& p : particles) {
    loads.push_back({testing::sphere_volume(p.radius), 1 + p.velocity.x, p.velocity, 2.0 * p.velocity});
  }
  return loads;
}

CellLoad total(const std::vector<CellLoad>& loads) {
  CellLoad sum;
  for (const CellLoad& load : loads) sum += load;
  return sum;
}

void expect_same_total(const CellLoad& a, const CellLoad& b, Real scale) {
  EXPECT_NEAR(a.solids / b.solids, 1, 1e-13);
  EXPECT_NEAR(a.coefficient / b.coefficient, 1, 1e-13);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(a.explicit_force[axis], b.explicit_force[axis], 1e-13 * scale);
    EXPECT_NEAR(a.reaction[axis], b.reaction[axis], 2e-13 * scale);
  }
}

// Particles in random order, so that threads reach a cell in any order. The test sums serially, cell by cell in
// particle order: equal to the last bit.
TEST(CellSums, EqualTheSerialSumToTheLastBit) {
  const CartesianGrid grid(box, {7, 2, 9}, {true, false, false});
  const auto from = testing::random_particles(box, 20000, 1.5e-3, 5);
  const dem::Particles particles = make_particles(from);
  const auto loads = make_loads(from);
  for (const Deposition& kernel : {Deposition(Divided{}), Deposition(Centroid{})}) {
    Footprint footprint(GridLocator(grid), kernel);
    footprint.compute(particles);
    const auto begin = testing::to_vector(footprint.view().begin, particles.count + 1);
    const auto entries = testing::to_vector(footprint.view().entries, footprint.entry_count());
    std::vector<CellLoad> expected(static_cast<std::size_t>(grid.cell_count()));
    for (std::size_t p = 0; p < from.size(); ++p) {
      for (Index e = begin[p]; e < begin[p + 1]; ++e) {
        const FootprintEntry entry = entries[static_cast<std::size_t>(e)];
        expected[static_cast<std::size_t>(entry.cell)] += (footprint.view().share * entry.pieces) * loads[p];
      }
    }
    const DeviceArray<CellLoad> load("tests::deposition::load", loads.size());
    const DeviceArray<CellLoad> result("tests::deposition::result", expected.size());
    fill(load, loads);
    CellSums sums(grid.cell_count());
    for (int repeat = 0; repeat < 3; ++repeat) {
      sums.compute(footprint, load, result);
      const auto found = testing::to_vector(result, grid.cell_count());
      for (std::size_t c = 0; c < expected.size(); ++c) {
        ASSERT_EQ(found[c].solids, expected[c].solids);
        ASSERT_EQ(found[c].coefficient, expected[c].coefficient);
        ASSERT_EQ(found[c].explicit_force, expected[c].explicit_force);
        ASSERT_EQ(found[c].reaction, expected[c].reaction);
      }
      expect_same_total(total(found), total(loads), 20000);
    }
  }
}

/// Loads of cells with solids fractions drawn around `mean`, momentum to match.
std::vector<CellLoad> random_cells(const CartesianGrid& grid, Real mean, Real spread, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<Real> unit(-1, 1);
  std::vector<CellLoad> loads;
  for (Index c = 0; c < grid.cell_count(); ++c) {
    const Index3 at = grid.coordinates(c);
    const Real volume = grid.volume(at.x, at.y, at.z);
    loads.push_back({volume * std::max(0.0, mean + spread * unit(generator)),
                     2 + unit(generator),
                     {unit(generator), unit(generator), unit(generator)},
                     {unit(generator), unit(generator), unit(generator)}});
  }
  return loads;
}

struct BoundCase {
  const char* name;
  CartesianGrid grid;
  Real mean, spread;
};

TEST(VoidFractionBound, KeepsSolidsAndMomentumAndHoldsEverywhere) {
  const std::vector<BoundCase> cases{
      {"loose", CartesianGrid(box, {7, 4, 9}), 0.5, 0.3},
      {"dense", CartesianGrid(box, {7, 4, 9}), 0.6, 0.2},
      {"nearly full, one layer", CartesianGrid(box, {12, 1, 20}), 0.625, 0.1},
      {"nearly full, periodic", CartesianGrid(box, {7, 2, 9}, {true, true, true}), 0.63, 0.1},
      {"stretched",
       CartesianGrid({testing::stretched_faces(0, 0.03, 8, 1.15), testing::stretched_faces(0, 0.02, 5, 0.8),
                      testing::stretched_faces(0, 0.06, 10, 1.1)}),
       0.5, 0.4}};
  for (const BoundCase& c : cases) {
    const auto before = random_cells(c.grid, c.mean, c.spread, 17);
    const DeviceArray<CellLoad> loads("tests::deposition::loads", before.size());
    fill(loads, before);
    VoidFractionBound bound(GridLocator(c.grid), 0.36);
    const BoundReport report = bound.apply(loads);
    const auto after = testing::to_vector(loads, c.grid.cell_count());
    Index over = 0;
    for (Index i = 0; i < c.grid.cell_count(); ++i) {
      const Index3 at = c.grid.coordinates(i);
      const Real volume = c.grid.volume(at.x, at.y, at.z);
      if (before[static_cast<std::size_t>(i)].solids > 0.64 * volume) ++over;
      EXPECT_LE(after[static_cast<std::size_t>(i)].solids / volume, 0.64 * (1 + 1e-9)) << c.name;
      EXPECT_GE(after[static_cast<std::size_t>(i)].solids, 0) << c.name;
    }
    EXPECT_EQ(report.cells_over, over) << c.name;
    EXPECT_GT(over, 0) << c.name;
    EXPECT_EQ(report.cells_left_over, 0) << c.name;
    RecordProperty(std::string("sweeps, ") + c.name, report.iterations);
    expect_same_total(total(after), total(before), static_cast<Real>(before.size()));
  }
}

TEST(VoidFractionBound, LeavesCellsUnderTheBoundAlone) {
  const CartesianGrid grid(box, {7, 4, 9});
  const auto before = random_cells(grid, 0.4, 0.2, 3);
  const DeviceArray<CellLoad> loads("tests::deposition::loads", before.size());
  fill(loads, before);
  EXPECT_EQ(VoidFractionBound(GridLocator(grid), 0.36).apply(loads).iterations, 0);
  const auto after = testing::to_vector(loads, grid.cell_count());
  for (std::size_t c = 0; c < before.size(); ++c) EXPECT_EQ(after[c].solids, before[c].solids);
}

// One cell at 0.84, capacity 0.64, six empty neighbours of equal size: each gets a sixth of 0.20, and the same share
// (0.20 / 6 / 0.84) of the momentum.
TEST(VoidFractionBound, ExcessGoesToTheNeighboursWithItsMomentum) {
  const CartesianGrid grid(Box{{0, 0, 0}, {3, 3, 3}}, {3, 3, 3});
  std::vector<CellLoad> before(27);
  before[13] = {0.84, 8.4, {1, 2, 3}, {4, 5, 6}};
  const DeviceArray<CellLoad> loads("tests::deposition::loads", before.size());
  fill(loads, before);
  const BoundReport report = VoidFractionBound(GridLocator(grid), 0.36).apply(loads);
  EXPECT_EQ(report.iterations, 1);
  const auto after = testing::to_vector(loads, 27);
  EXPECT_NEAR(after[13].solids, 0.64, 1e-15);
  for (const std::size_t c : {4u, 10u, 12u, 14u, 16u, 22u}) {
    EXPECT_NEAR(after[c].solids, 0.2 / 6, 1e-15);
    EXPECT_NEAR(after[c].coefficient, 8.4 * 0.2 / 6 / 0.84, 1e-14);
    EXPECT_NEAR(after[c].reaction.z, 6 * 0.2 / 6 / 0.84, 1e-14);
  }
}

TEST(VoidFractionBound, ReportsThatThereIsNoRoom) {
  const CartesianGrid grid(Box{{0, 0, 0}, {2, 1, 1}}, {2, 1, 1});
  const DeviceArray<CellLoad> loads("tests::deposition::loads", 2);
  fill(loads, std::vector<CellLoad>{{0.9, 0, {}, {}}, {0.5, 0, {}, {}}});
  EXPECT_GT(VoidFractionBound(GridLocator(grid), 0.36).apply(loads).cells_left_over, 0);
}

TEST(GridMapping, KeepsTotalsBetweenAnyGridsAndCopiesBetweenEqualOnes) {
  const CartesianGrid coarse(box, {4, 2, 6}), fine(box, {12, 4, 30}), odd(box, {7, 3, 11}),
      stretched({testing::stretched_faces(0, 0.03, 8, 1.15), testing::stretched_faces(0, 0.02, 5, 0.8),
                 testing::stretched_faces(0, 0.06, 10, 1.1)});
  for (const CartesianGrid* from : {&coarse, &fine, &odd, &stretched}) {
    for (const CartesianGrid* to : {&coarse, &fine, &odd, &stretched}) {
      const GridMapping mapping(*from, *to);
      EXPECT_EQ(mapping.is_identity(), from == to);
      const HostArray<Real> source("tests::deposition::source", static_cast<std::size_t>(from->cell_count()));
      const HostArray<Real> target("tests::deposition::target", static_cast<std::size_t>(to->cell_count()));
      Real before = 0, after = 0;
      Vec3 moment_before, moment_after;
      for (Index c = 0; c < from->cell_count(); ++c) {
        const Index3 at = from->coordinates(c);
        source(c) = 1 + std::sin(static_cast<Real>(c));
        before += source(c) * from->volume(at.x, at.y, at.z);
      }
      mapping.map(source, target);
      for (Index c = 0; c < to->cell_count(); ++c) {
        const Index3 at = to->coordinates(c);
        after += target(c) * to->volume(at.x, at.y, at.z);
        EXPECT_GE(target(c), 0);
        EXPECT_LE(target(c), 2);
      }
      EXPECT_NEAR(after / before, 1, 1e-13);
    }
  }
}

// From coarse to a grid that divides its cells: values repeat. From fine to coarse: volume means.
TEST(GridMapping, RepeatsAndAverages) {
  const CartesianGrid one(Box{{0, 0, 0}, {2, 1, 1}}, {2, 1, 1});
  const CartesianGrid three({std::vector<Real>{0, 0.5, 1.5, 2}, {0, 1}, {0, 1}});
  const HostArray<Vec3> a("tests::deposition::a", 2), b("tests::deposition::b", 3);
  a(0) = {1, 10, 0};
  a(1) = {3, 20, 0};
  GridMapping(one, three).map(a, b);
  EXPECT_DOUBLE_EQ(b(0).x, 1);
  EXPECT_DOUBLE_EQ(b(1).x, 2);  // half of each
  EXPECT_DOUBLE_EQ(b(2).x, 3);
  GridMapping(three, one).map(b, a);
  EXPECT_DOUBLE_EQ(a(0).x, 1.5);  // (0.5 x 1 + 0.5 x 2) / 1
  EXPECT_DOUBLE_EQ(a(1).y, 17.5);
  EXPECT_THROW(GridMapping(one, CartesianGrid(Box{{0, 0, 0}, {2, 1, 1.1}}, {2, 1, 1})), InputError);
}

}  // namespace
}  // namespace pellicle::coupling
