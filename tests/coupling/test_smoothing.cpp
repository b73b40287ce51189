// Smoothing by diffusion: sums, range and shape of what is spread.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/error.hpp"
#include "coupling/momentum_exchange.hpp"
#include "coupling/smoothing.hpp"
#include "tests/coupling/helpers.hpp"

namespace pellicle::coupling {
namespace {

using testing::stretched_faces;

const Box box{{0, 0, 0}, {0.03, 0.02, 0.06}};

std::vector<CellLoad> smooth(const CartesianGrid& grid, Real length, const std::vector<CellLoad>& before) {
  const DeviceArray<CellLoad> loads("tests::smoothing::loads", before.size());
  const auto host = Kokkos::create_mirror_view(loads);
  std::copy(before.begin(), before.end(), host.data());
  Kokkos::deep_copy(loads, host);
  Smoothing(GridLocator(grid), length).apply(loads);
  return testing::to_vector(loads, grid.cell_count());
}

/// A line of unit cells along an axis.
CartesianGrid unit_line(Index cells, bool periodic = false, int axis = 0) {
  Index3 count{1, 1, 1};
  Vec3 size{1, 1, 1};
  count[axis] = cells;
  size[axis] = static_cast<Real>(cells);
  std::array<bool, 3> around{false, false, false};
  around[static_cast<std::size_t>(axis)] = periodic;
  return {Box{{0, 0, 0}, size}, count, around};
}

/// Solids of a line after smoothing, from solids before.
std::vector<Real> smooth_solids(const CartesianGrid& grid, Real length, const std::vector<Real>& before) {
  std::vector<CellLoad> loads(before.size());
  for (std::size_t c = 0; c < before.size(); ++c) loads[c].solids = before[c];
  std::vector<Real> after;
  for (const CellLoad& load : smooth(grid, length, loads)) after.push_back(load.solids);
  return after;
}

/// With walls and without, uniform and stretched; the last ones have axes of one and two cells.
std::vector<CartesianGrid> grids() {
  const std::vector<Real> x = stretched_faces(0, 0.03, 8, 1.3), y = stretched_faces(0, 0.02, 5, 0.8),
                          z = stretched_faces(0, 0.06, 10, 1.1);
  return {CartesianGrid(box, {7, 4, 9}),
          CartesianGrid(box, {7, 4, 9}, {true, true, true}),
          CartesianGrid({x, y, z}),
          CartesianGrid({x, y, z}, {true, true, true}),
          CartesianGrid(box, {22, 1, 60}, {false, true, false}),
          CartesianGrid(box, {1, 2, 11}, {true, true, false})};
}

Real volume(const CartesianGrid& grid, std::size_t c) {
  const Index3 at = grid.coordinates(static_cast<Index>(c));
  return grid.volume(at.x, at.y, at.z);
}

/// Every fourth cell empty, forces of both signs.
std::vector<CellLoad> random_loads(const CartesianGrid& grid, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<Real> unit(-1, 1);
  std::vector<CellLoad> loads(static_cast<std::size_t>(grid.cell_count()));
  for (std::size_t c = 0; c < loads.size(); ++c) {
    if (c % 4 == 3) continue;
    loads[c] = {volume(grid, c) * 0.3 * (1 + unit(generator)),
                1 + unit(generator),
                {unit(generator), unit(generator), unit(generator)},
                {unit(generator), unit(generator), unit(generator)}};
  }
  return loads;
}

// The lengths go from a fraction of a cell to ten times the box. The sum of n random signs is far smaller than n, so
// the bound is on the sum of magnitudes.
TEST(Smoothing, KeepsTheSumsOfAllComponents) {
  for (const CartesianGrid& grid : grids()) {
    for (const Real length : {1e-3, 1e-2, 0.6}) {
      const std::vector<CellLoad> before = random_loads(grid, 3), after = smooth(grid, length, before);
      CellLoad change;
      Real scale = 0, solids = 0;
      for (std::size_t c = 0; c < before.size(); ++c) {
        change += after[c];
        change += -1.0 * before[c];
        scale += 1;
        solids += before[c].solids;
      }
      EXPECT_LT(std::abs(change.solids), 1e-13 * solids);
      EXPECT_LT(std::abs(change.coefficient), 1e-13 * scale);
      EXPECT_LT(norm(change.explicit_force), 1e-13 * scale);
      EXPECT_LT(norm(change.reaction), 1e-13 * scale);
    }
  }
}

TEST(Smoothing, UniformDensityStays) {
  for (const CartesianGrid& grid : grids()) {
    for (const Real length : {1e-3, 1e-2, 0.6}) {
      std::vector<CellLoad> before(static_cast<std::size_t>(grid.cell_count()));
      for (std::size_t c = 0; c < before.size(); ++c) {
        before[c] = volume(grid, c) * CellLoad{0.5, 3, {1, -2, 3}, {-1, 0, 7}};
      }
      const std::vector<CellLoad> after = smooth(grid, length, before);
      for (std::size_t c = 0; c < before.size(); ++c) {
        EXPECT_NEAR(after[c].solids / before[c].solids, 1, 1e-14);
        EXPECT_NEAR(after[c].coefficient / before[c].coefficient, 1, 1e-14);
        EXPECT_NEAR(after[c].explicit_force.y / before[c].explicit_force.y, 1, 1e-14);
        EXPECT_NEAR(after[c].reaction.z / before[c].reaction.z, 1, 1e-14);
      }
    }
  }
}

// The least density is 0 before. Only the face between the ends of a periodic axis brings a difference into the
// arithmetic: without one no load becomes negative, not even by rounding.
TEST(Smoothing, MakesNoNewExtremes) {
  for (const CartesianGrid& grid : grids()) {
    const bool periodic = grid.periodic(0) || grid.periodic(1) || grid.periodic(2);
    for (const Real length : {1e-3, 1e-2, 0.6}) {
      for (const bool point : {false, true}) {
        std::vector<CellLoad> before = random_loads(grid, 7);
        if (point) {
          std::fill(before.begin(), before.end(), CellLoad{});
          before[before.size() / 3].solids = 0.64 * volume(grid, before.size() / 3);
        }
        const std::vector<CellLoad> after = smooth(grid, length, before);
        Real most = 0;
        for (std::size_t c = 0; c < before.size(); ++c) {
          most = std::max(most, before[c].solids / volume(grid, c));
        }
        for (std::size_t c = 0; c < before.size(); ++c) {
          EXPECT_GE(after[c].solids / volume(grid, c), periodic ? -1e-16 : 0);
          EXPECT_LE(after[c].solids / volume(grid, c), most * (1 + 1e-14));
        }
      }
    }
  }
}

// With c = D dt / width^2, a step of (1 - c second difference) f' = f multiplies sum i^2 f by nothing and adds 2 c to
// it: three add length^2 / 2. The kernel falls by a factor of at least 1.5 a cell at 8 cells (1 + 1/(2c) -
// sqrt((1 + 1/(2c))^2 - 1) = 0.65), 1e-74 at the walls 400 cells away; what remains is the rounding of 801 terms.
TEST(Smoothing, PointLoadGetsHalfTheSquareAsVariance) {
  constexpr Index cells = 801, middle = 400;
  for (int axis = 0; axis < 3; ++axis) {
    for (const Real length : {0.3, 2.5, 8.0}) {
      std::vector<Real> point(cells, 0);
      point[middle] = 1;
      const std::vector<Real> after = smooth_solids(unit_line(cells, false, axis), length, point);
      Real variance = 0;
      for (Index i = 0; i < cells; ++i) {
        variance += static_cast<Real>((i - middle) * (i - middle)) * after[static_cast<std::size_t>(i)];
        const auto here = static_cast<std::size_t>(i), there = static_cast<std::size_t>(cells - 1 - i);
        EXPECT_NEAR(after[here], after[there], 1e-14 * after[here] + 1e-300);
      }
      EXPECT_NEAR(variance / (0.5 * length * length), 1, 1e-12);
    }
  }
}

// Three steps of backward Euler: the transform is (1 + k^2 b^2 / 12)^-3, and its integral over k / (2 pi) the value at
// the centre: 3 sqrt(12) / 16 / b = 0.6495 / b, where the Gaussian has 1 / (sqrt(pi) b) = 0.5642 / b.
TEST(Smoothing, PointLoadPeaksAsThreeStepsDo) {
  std::vector<Real> point(4001, 0);
  point[2000] = 1;
  EXPECT_NEAR(smooth_solids(unit_line(4001), 200, point)[2000] * 200, 0.6495190528, 1e-4);
}

// Cosines are eigenvectors of the discrete diffusion between walls, sines and cosines of a whole number of waves of
// that around a periodic line: each step divides them by 1 + 4 c sin^2(k / 2), k in radians a cell.
TEST(Smoothing, WavesAreDampedAsTheirEigenvaluesSay) {
  constexpr Index cells = 37;
  for (const bool periodic : {false, true}) {
    for (const int mode : {1, 5, 18}) {
      for (const Real length : {0.7, 4.0}) {
        const Real k = (periodic ? 2 : 1) * std::numbers::pi * mode / cells;
        std::vector<Real> wave(cells);
        const Real phase = periodic ? 0.4 : 0.5 * k;
        for (std::size_t i = 0; i < cells; ++i) wave[i] = std::cos(k * static_cast<Real>(i) + phase);
        const std::vector<Real> after = smooth_solids(unit_line(cells, periodic), length, wave);
        const Real c = length * length / 12, sine = std::sin(0.5 * k);
        const Real factor = std::pow(1 + 4 * c * sine * sine, -3);
        for (std::size_t i = 0; i < wave.size(); ++i) EXPECT_NEAR(after[i], factor * wave[i], 1e-14);
      }
    }
  }
}

// A wall reflects: a line between walls is half of a periodic one that holds the same loads and their mirror images.
// So the second moment about the wall of a load in the first cell, 1/4 before, is 1/4 + length^2 / 2 afterwards, and
// the first moment, by Cauchy and Schwarz, is at most the root of that.
TEST(Smoothing, WallsReflect) {
  constexpr std::size_t cells = 150;
  const Real length = 5;
  for (const std::size_t at : {0u, 3u, 149u}) {
    std::vector<Real> half(cells, 0), whole(2 * cells, 0);
    half[at] = 1;
    whole[cells + at] = 1;
    whole[cells - 1 - at] = 1;
    const std::vector<Real> after = smooth_solids(unit_line(cells), length, half);
    const std::vector<Real> mirrored = smooth_solids(unit_line(2 * cells, true), length, whole);
    Real sum = 0, first = 0, second = 0;
    for (std::size_t i = 0; i < cells; ++i) {
      EXPECT_NEAR(after[i], mirrored[cells + i], 1e-15);
      const Real distance = static_cast<Real>(at == 149 ? cells - 1 - i : i) + 0.5;
      sum += after[i];
      first += distance * after[i];
      second += distance * distance * after[i];
    }
    EXPECT_NEAR(sum, 1, 1e-14);
    if (at == 3) continue;
    EXPECT_NEAR(second, 0.25 + 0.5 * length * length, 1e-12);
    EXPECT_GT(first, 1.5);
    EXPECT_LT(first, std::sqrt(0.25 + 0.5 * length * length));
  }
}

/// Solves a dense system with pivoting.
std::vector<Real> solve_dense(std::vector<std::vector<Real>> m, std::vector<Real> right) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t r = k + 1; r < n; ++r) {
      if (std::abs(m[r][k]) > std::abs(m[pivot][k])) pivot = r;
    }
    std::swap(m[k], m[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t r = k + 1; r < n; ++r) {
      const Real factor = m[r][k] / m[k][k];
      for (std::size_t c = k; c < n; ++c) m[r][c] -= factor * m[k][c];
      right[r] -= factor * right[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t c = k + 1; c < n; ++c) right[k] -= m[k][c] * right[c];
    right[k] /= m[k][k];
  }
  return right;
}

/// Three steps of a balance over the cells of a line, face by face, by dense elimination: loads after.
std::vector<Real> smooth_dense(const std::vector<Real>& faces, bool periodic, Real length,
                               std::vector<Real> load) {
  const std::size_t n = load.size();
  for (int step = 0; step < 3; ++step) {
    std::vector<std::vector<Real>> m(n, std::vector<Real>(n, 0));
    for (std::size_t i = 0; i < n; ++i) m[i][i] = faces[i + 1] - faces[i];
    for (std::size_t i = 0; i + (periodic ? 0 : 1) < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const Real distance = 0.5 * (faces[i + 1] - faces[i] + faces[j + 1] - faces[j]);
      const Real flux = length * length / 12 / distance;
      m[i][i] += flux;
      m[i][j] -= flux;
      m[j][j] += flux;
      m[j][i] -= flux;
    }
    load = solve_dense(m, load);
    for (std::size_t i = 0; i < n; ++i) load[i] *= faces[i + 1] - faces[i];
  }
  return load;
}

TEST(Smoothing, StretchedLinesFollowTheirBalances) {
  const std::vector<Real> faces = stretched_faces(0, 0.06, 14, 1.25), one{0, 0.01};
  for (const bool periodic : {false, true}) {
    const CartesianGrid grid({one, one, faces}, {false, false, periodic});
    for (const Real length : {2e-3, 2e-2}) {
      std::vector<Real> before;
      for (const CellLoad& load : random_loads(grid, 11)) before.push_back(load.coefficient);
      const std::vector<Real> after = smooth_solids(grid, length, before);
      const std::vector<Real> expected = smooth_dense(faces, periodic, length, before);
      for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], expected[i], 1e-13);
    }
  }
}

bool same(const CellLoad& a, const CellLoad& b) {
  return a.solids == b.solids && a.coefficient == b.coefficient && a.explicit_force == b.explicit_force &&
         a.reaction == b.reaction;
}

// Line after line, each as a grid of its own, which one thread does: equal to the last bit to the grid done at once.
TEST(Smoothing, EqualsItsLinesOneByOneToTheLastBit) {
  const Real length = 8e-3;
  const std::vector<Real> one{0, 0.01};
  for (const CartesianGrid& grid : {grids()[3], grids()[4], grids()[5]}) {
    std::vector<CellLoad> expected = random_loads(grid, 19);
    const std::vector<CellLoad> after = smooth(grid, length, expected);
    for (int axis = 0; axis < 3; ++axis) {
      std::array<std::vector<Real>, 3> faces{one, one, one};
      std::array<bool, 3> periodic{false, false, false};
      const auto a = static_cast<std::size_t>(axis);
      faces[a] = grid.faces(axis);
      periodic[a] = grid.periodic(axis);
      const CartesianGrid line(faces, periodic);
      for (Index start = 0; start < grid.cell_count(); ++start) {
        Index3 at = grid.coordinates(start);
        if (at[axis] != 0 || grid.cells()[axis] == 1) continue;
        std::vector<CellLoad> loads;
        const auto cell = [&](Index i) {
          at[axis] = i;
          return static_cast<std::size_t>(grid.index(at.x, at.y, at.z));
        };
        for (Index i = 0; i < grid.cells()[axis]; ++i) loads.push_back(expected[cell(i)]);
        loads = smooth(line, length, loads);
        for (Index i = 0; i < grid.cells()[axis]; ++i) expected[cell(i)] = loads[static_cast<std::size_t>(i)];
      }
    }
    for (std::size_t c = 0; c < expected.size(); ++c) ASSERT_TRUE(same(after[c], expected[c]));
  }
}

TEST(Smoothing, LengthZeroChangesNothing) {
  const std::vector<CellLoad> before = random_loads(grids()[0], 23), after = smooth(grids()[0], 0, before);
  for (std::size_t c = 0; c < before.size(); ++c) EXPECT_TRUE(same(after[c], before[c]));
}

struct Pull {
  FixedCoefficientForce force;
  DeviceArray<dem::VelocitySpin> motion;
  Real dt;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const { force(p, motion(p).velocity(), dt); }
};

// Solids arrive in full and less ragged, and momentum closes step by step with a gas that follows what it is told.
TEST(Smoothing, ExchangeKeepsSolidsAndMomentum) {
  const std::array<bool, 3> around{false, true, false};
  const CartesianGrid transfer(box, {10, 7, 20}, around), grid(box, {5, 6, 32}, around);
  const auto from = testing::random_particles(box, 1500, 1.2e-3, 29);
  const auto cells = static_cast<std::size_t>(grid.cell_count());
  Real solids_sent = 0;
  for (const testing::TestParticle& p : from) solids_sent += testing::sphere_volume(p.radius);
  std::vector<Real> raggedness;
  for (const Real length : {0.0, 6e-3}) {
    CouplingOptions options;
    options.minimum_void_fraction = 0.7;
    options.smoothing_length = length;
    MomentumExchange exchange(options, transfer, grid, {1.2, 1.8e-5, {0, 0, -9.81}});
    const dem::Particles particles = testing::make_particles(from);
    exchange.initialise(particles);
    EXPECT_GT(exchange.bound_report().cells_over, 0);
    cfd::GasState gas;
    gas.velocity = HostArray<Vec3>("tests::smoothing::velocity", cells);
    gas.pressure_gradient = HostArray<Vec3>("tests::smoothing::pressure_gradient", cells);
    for (std::size_t c = 0; c < cells; ++c) gas.velocity(c) = {std::sin(static_cast<Real>(c)), 0.5, 1};
    const Real dt = 1e-4;
    for (int step = 0; step < 20; ++step) {
      exchange.sample_gas(gas.velocity, gas.pressure_gradient);
      exchange.compute_coefficients(particles);
      const auto force = std::get<FixedCoefficientForce>(exchange.fluid_force(particles));
      Kokkos::parallel_for("tests::smoothing::pull", DeviceRange(0, particles.count),
                           Pull{force, particles.velocity_spin, dt});
      const cfd::ParticleExchange& on_gas = exchange.deposit(particles, dt);
      Real solids = 0;
      for (std::size_t c = 0; c < cells; ++c) {
        solids += (1 - on_gas.void_fraction(c)) * volume(grid, c);
        EXPECT_GE(on_gas.void_fraction(c),
                  0.7 - 1e-9);  // the bound comes before the smoothing, and survives it
        const Real inertia = 1.2 * on_gas.void_fraction(c) / dt;
        gas.velocity(c) = 1 / (inertia + on_gas.exchange_coefficient(c)) *
                          (inertia * gas.velocity(c) + on_gas.explicit_force(c) + Vec3{0, 0, 500});
        gas.pressure_gradient(c) = 20.0 * gas.velocity(c);
      }
      EXPECT_NEAR(solids / solids_sent, 1, 1e-12);
      exchange.close_step(gas, dt);
      const ExchangeTotals& t = exchange.totals();
      EXPECT_LT(norm(t.particles_received + t.gas_received + t.pending), 1e-12 * t.gross);
      EXPECT_GT(norm(t.particles_received), 0.1 * t.gross);
    }
    Real change = 0;
    for (Index c = 0; c + 1 < transfer.cell_count(); ++c) {
      change += std::abs(exchange.transfer_void_fraction()(c + 1) - exchange.transfer_void_fraction()(c));
    }
    raggedness.push_back(change);
  }
  EXPECT_LT(raggedness[1], 0.5 * raggedness[0]);
}

TEST(Smoothing, ExchangeRefusesANegativeLength) {
  const CartesianGrid grid(box, {3, 2, 6});
  CouplingOptions options;
  for (const Real length : {-1e-3, std::numeric_limits<Real>::infinity(), std::nan("")}) {
    options.smoothing_length = length;
    EXPECT_THROW(MomentumExchange(options, grid, grid, {1.2, 1.8e-5, {}}), InputError);
  }
}

}  // namespace
}  // namespace pellicle::coupling
