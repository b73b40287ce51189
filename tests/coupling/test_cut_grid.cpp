// Particles in vessels that walls cut out of the gas grid: their volume stays in the gas, on their side of thin walls.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "cfd/gas_solver.hpp"
#include "core/error.hpp"
#include "coupling/cut_grid.hpp"
#include "tests/coupling/helpers.hpp"

namespace pellicle::coupling {
namespace {

using testing::make_particles;
using testing::TestParticle;

constexpr Real pi = std::numbers::pi;
const GasProperties air{1.2, 1.8e-5, {0, 0, -9.81}};

cfd::ImmersedSurface make_surface(cfd::SurfaceShape shape) {
  return {"wall", {std::move(shape)}, {}, {}, {}};
}

// A cone that widens upwards within a box, with a thin tube in it: the gas comes in through a disc and an annulus.
struct ConeWithTube {
  static constexpr Real tube_radius = 0.03, tube_low = 0.08, tube_high = 0.2;
  CartesianGrid grid{Box{{-0.1, -0.1, 0}, {0.1, 0.1, 0.3}}, {20, 19, 18}};
  cfd::ImmersedGeometry immersed;
  ConeWithTube() {
    const Vec3 up{0, 0, 1};
    immersed.surfaces = {
        make_surface(cfd::RevolvedSurface{{0, 0, 0}, up, 0.06, 0, 0.09, 0.3}),
        make_surface(cfd::RevolvedSurface{{0, 0, 0}, up, tube_radius, tube_low, tube_radius, tube_high})};
    immersed.inside = {0, 0, 1e-4};
  }
  static Real cone_radius(Real z) { return 0.06 + 0.1 * z; }
  bool in_tube(Index cell) const {
    const Index3 at = grid.coordinates(cell);
    const Real z = grid.center(2, at.z);
    return std::hypot(grid.center(0, at.x), grid.center(1, at.y)) < tube_radius && z > tube_low &&
           z < tube_high;
  }
};

/// Particles anywhere in the gas, their surfaces clear of cone and tube.
std::vector<TestParticle> particles_in_vessel(int count, unsigned seed) {
  std::vector<TestParticle> made;
  for (const TestParticle& p :
       testing::random_particles(Box{{-0.09, -0.09, 0.003}, {0.09, 0.09, 0.297}}, count, 3e-3, seed)) {
    const Real r = std::hypot(p.position.x, p.position.y);
    const bool in_cone = r + 1.01 * p.radius < ConeWithTube::cone_radius(p.position.z);
    const bool on_tube = std::abs(r - ConeWithTube::tube_radius) < 1.01 * p.radius &&
                         p.position.z > ConeWithTube::tube_low - p.radius &&
                         p.position.z < ConeWithTube::tube_high + p.radius;
    if (in_cone && !on_tube) made.push_back(p);
  }
  return made;
}

/// Particles that touch the tube all around, from within (side -1) or without (+1), away from its ends.
std::vector<TestParticle> particles_at_tube(Real side, Real radius) {
  std::vector<TestParticle> made;
  for (int n = 0; n < 400; ++n) {
    const Real angle = 2 * pi * n / 400, r = ConeWithTube::tube_radius + side * 1.001 * radius;
    made.push_back({{r * std::cos(angle), r * std::sin(angle), 0.11 + 0.06 * n / 400}, radius});
  }
  return made;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

Real total_volume(const std::vector<TestParticle>& particles) {
  Real sum = 0;
  for (const TestParticle& p : particles) sum += testing::sphere_volume(p.radius);
  return sum;
}

TEST(CutGrid, VolumeOfParticlesIsInTheOpenVolumeOfCells) {
  const ConeWithTube vessel;
  const cfd::FlowGeometry geometry(vessel.grid, vessel.immersed);
  std::vector<TestParticle> from = particles_in_vessel(8000, 3);
  // Some half in the cone, deeper than any contact: many of their pieces lie in cells without gas.
  for (int n = 0; n < 2000; ++n) {
    const Real z = 0.01 + 0.28 * n / 2000, r = ConeWithTube::cone_radius(z) + 5e-4, angle = 0.7 * n;
    from.push_back({{r * std::cos(angle), r * std::sin(angle), z}, 1e-3});
  }
  ASSERT_GT(from.size(), 5000u);
  const dem::Particles particles = make_particles(from);
  for (const Deposition& kernel : {Deposition(Divided{}), Deposition(Centroid{})}) {
    // Without the walls some of it would be in cells without gas.
    Footprint blind(GridLocator(vessel.grid), kernel);
    blind.compute(particles);
    int astray = 0;
    for (const FootprintEntry& e : testing::to_vector(blind.view().entries, blind.entry_count())) {
      if (!(geometry.volume(e.cell) > 0)) ++astray;
    }
    EXPECT_GT(astray, 3);
    CouplingOptions options;
    options.deposition = kernel;
    MomentumExchange exchange(options, vessel.grid, vessel.grid, air, &geometry);
    exchange.initialise(particles);
    EXPECT_EQ(exchange.bound_report().cells_left_over, 0);
    Real solids = 0, least = 1;
    for (Index c = 0; c < vessel.grid.cell_count(); ++c) {
      const Real eps = exchange.exchange().void_fraction(c);
      if (!(geometry.volume(c) > 0)) {
        ASSERT_EQ(eps, 1) << c;
      }
      solids += (1 - eps) * geometry.volume(c);
      least = std::min(least, eps);
    }
    // 1 - eps loses 1e-16 of each cell's volume; the particles are about 2 % of it.
    EXPECT_NEAR(solids / total_volume(from), 1, 1e-12);
    EXPECT_GE(least,
              options.minimum_void_fraction - 1e-9);  // the bound's tolerance is 1e-10 of a cell's capacity
  }
}

// Half a cell open, by hand; and a particle beyond it belongs to the nearest cell with gas.
TEST(CutGrid, VoidFractionIsThatOfTheOpenVolume) {
  const CartesianGrid grid(Box{{0, 0, 0}, {1, 0.2, 0.2}}, {10, 1, 1});
  cfd::ImmersedGeometry immersed;
  immersed.surfaces = {make_surface(cfd::PlaneSurface{{1, 0, 0}, 0.35})};
  immersed.inside = {0.1, 0.1, 0.1};
  const cfd::FlowGeometry geometry(grid, immersed);
  ASSERT_EQ(geometry.open_cells, 4);
  MomentumExchange exchange(CouplingOptions{}, grid, grid, air, &geometry);
  const Real volume = testing::sphere_volume(0.01);
  exchange.initialise(
      make_particles({{{0.32, 0.1, 0.1}, 0.01}, {{0.62, 0.1, 0.1}, 0.01}, {{0.05, 0.1, 0.1}, 0.01}}));
  // 0.1 x 0.2 x 0.2 m3 a cell. The half cell is cut to 1e-7 of a cell.
  EXPECT_NEAR(exchange.exchange().void_fraction(3), 1 - 2 * volume / 0.002, 1e-8);
  EXPECT_NEAR(exchange.exchange().void_fraction(0), 1 - volume / 0.004, 1e-15);
  for (const Index c : {1, 2, 4, 5, 6, 7, 8, 9}) EXPECT_EQ(exchange.exchange().void_fraction(c), 1) << c;
}

// Gas that moves within the tube only: a particle beside the wall feels that of its own side, and what it brings stays
// there.
TEST(CutGrid, NothingIsSampledOrDepositedThroughAThinWall) {
  const ConeWithTube vessel;
  const cfd::FlowGeometry geometry(vessel.grid, vessel.immersed);
  const GridLocator locator(vessel.grid);
  const Real radius = 2.5e-3;
  std::vector<TestParticle> from = particles_at_tube(-1, radius);
  const std::size_t within = from.size();
  append(from, particles_at_tube(1, radius));
  const dem::Particles particles = make_particles(from);
  std::size_t in_wrong_cells = 0;
  for (std::size_t p = 0; p < from.size(); ++p) {
    const Vec3& x = from[p].position;
    const Index cell = vessel.grid.index(locator.x.locate(x.x), locator.y.locate(x.y), locator.z.locate(x.z));
    if (vessel.in_tube(cell) != (p < within)) ++in_wrong_cells;
  }
  EXPECT_GT(in_wrong_cells, 50u);  // their centres lie in cells that belong to the other side
  const auto cells = static_cast<std::size_t>(vessel.grid.cell_count());
  const HostArray<Vec3> velocity("tests::cut_grid::velocity", cells);
  const HostArray<Vec3> gradient("tests::cut_grid::gradient", cells);
  for (Index c = 0; c < vessel.grid.cell_count(); ++c) velocity(c).z = vessel.in_tube(c) ? 1 : 0;
  for (const Deposition& kernel : {Deposition(Divided{}), Deposition(Centroid{})}) {
    CouplingOptions options;
    options.deposition = kernel;
    MomentumExchange exchange(options, vessel.grid, vessel.grid, air, &geometry);
    exchange.initialise(particles);
    exchange.sample_gas(velocity, gradient);
    exchange.compute_coefficients(particles);
    const auto sampled = testing::to_vector(exchange.sampled_gas(), particles.count);
    for (std::size_t p = 0; p < from.size(); ++p) {
      // Weights are whole 33rds: their sum is 1 to round-off.
      EXPECT_NEAR(sampled[p].velocity.z, p < within ? 1 : 0, p < within ? 1e-14 : 0) << p;
    }
    Real solids_within = 0;
    for (Index c = 0; c < vessel.grid.cell_count(); ++c) {
      if (vessel.in_tube(c)) solids_within += (1 - exchange.exchange().void_fraction(c)) * geometry.volume(c);
    }
    EXPECT_NEAR(solids_within / (static_cast<Real>(within) * testing::sphere_volume(radius)), 1, 1e-12);
  }
}

TEST(CutGrid, TheBoundSpreadsAlongTheTubeButNotThroughIt) {
  const ConeWithTube vessel;
  const cfd::FlowGeometry geometry(vessel.grid, vessel.immersed);
  const GridLocator locator(vessel.grid);
  const Index full = vessel.grid.index(locator.x.locate(0.024), locator.y.locate(0), locator.z.locate(0.14));
  ASSERT_TRUE(vessel.in_tube(full));
  ASSERT_FALSE(vessel.in_tube(full + 1));
  const Real most = 0.64;
  for (const bool cut : {true, false}) {
    const DeviceArray<CellLoad> loads("tests::cut_grid::loads",
                                      static_cast<std::size_t>(vessel.grid.cell_count()));
    const auto host = Kokkos::create_mirror_view(loads);
    host(full).solids = 20 * geometry.volume(full);
    host(full).reaction = {1, 2, 3};
    Kokkos::deep_copy(loads, host);
    VoidFractionBound bound(locator, 1 - most, cut ? make_cut_grid(geometry) : CutGrid{});
    EXPECT_EQ(bound.apply(loads).cells_left_over, 0);
    const auto after = testing::to_vector(loads, vessel.grid.cell_count());
    CellLoad sum;
    Real without = 0;
    for (Index c = 0; c < vessel.grid.cell_count(); ++c) {
      const CellLoad& load = after[static_cast<std::size_t>(c)];
      sum += load;
      if (!vessel.in_tube(c)) without += load.solids;
      if (cut) {
        ASSERT_LE(load.solids, (1 + 1e-9) * most * geometry.volume(c)) << c;
      }
    }
    EXPECT_NEAR(sum.solids / (20 * geometry.volume(full)), 1, 1e-13);
    EXPECT_NEAR(sum.reaction.z, 3, 1e-12);
    if (cut) {
      EXPECT_EQ(without, 0);
    } else {
      EXPECT_GT(without, geometry.volume(full));
    }
  }
}

/// How many of the 33 pieces are in each cell of the layer of four in which the particle's centre is in cell 0.
std::vector<Index> pieces_in_cells(const std::vector<Box>& obstacles, const Vec3& centre, Real radius) {
  const CartesianGrid grid(Box{{0, 0, 0}, {2, 2, 1}}, {2, 2, 1});
  cfd::ImmersedGeometry immersed;
  for (const Box& box : obstacles)
    immersed.surfaces.push_back(make_surface(cfd::BoxSurface{box.min, box.max}));
  immersed.inside = {0.5, 0.5, 0.5};
  const cfd::FlowGeometry geometry(grid, immersed);
  const GridLocator locator(grid);
  Footprint footprint(locator, Divided{}, make_cut_grid(geometry));
  footprint.compute(make_particles({{centre, radius}}));
  std::vector<Index> pieces(4, 0);
  for (const FootprintEntry& e : testing::to_vector(footprint.view().entries, footprint.entry_count())) {
    pieces[static_cast<std::size_t>(e.cell)] += e.pieces;
  }
  return pieces;
}

// Four cells around an edge, one or two of them filled: what is round the corner is reached one way or the other.
TEST(CutGrid, PiecesGoRoundCornersButNotThroughThem) {
  const Real radius = 0.3;
  const Box right{{0.98, -0.5, -0.5}, {2.5, 1.02, 1.5}}, behind{{-0.5, 0.98, -0.5}, {1.02, 2.5, 1.5}};
  const Vec3 centre{0.93, 0.91, 0.5};
  const std::vector<Index> free = pieces_in_cells({}, centre, radius);
  for (const Index n : free) ASSERT_GT(n, 0);
  // A filled cell's pieces go home; the one diagonally across keeps its own.
  EXPECT_EQ(pieces_in_cells({right}, centre, radius),
            (std::vector<Index>{free[0] + free[1], 0, free[2], free[3]}));
  EXPECT_EQ(pieces_in_cells({behind}, centre, radius),
            (std::vector<Index>{free[0] + free[2], free[1], 0, free[3]}));
  // Both filled: the gas is in one cell only.
  const std::vector<Index> alone = pieces_in_cells({right, behind}, centre, radius);
  EXPECT_EQ(alone, (std::vector<Index>{33, 0, 0, 0}));
}

/// Drag and motion of the test's particles over one substep.
template <class Force>
struct Substep {
  Force force;
  dem::Particles particles;
  Real dt;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    const dem::VelocitySpin motion = particles.velocity_spin(p);
    force(p, motion.velocity(), dt);
    particles.position_radius(p).x += dt * motion.vx;
    particles.position_radius(p).y += dt * motion.vy;
    particles.position_radius(p).z += dt * motion.vz;
  }
};

// What the particles received, what the gas was given and what is pending cancel; and what the gas itself books, from
// the open volumes of its own cells, is what it was given.
TEST(CutGrid, MomentumOfParticlesAndGasAgreesInACutVessel) {
  const ConeWithTube vessel;
  cfd::GasOptions gas_options;
  gas_options.density = air.density;
  gas_options.viscosity = air.viscosity;
  gas_options.solver.pressure_tolerance = 1e-13;
  gas_options.solver.loose_pressure_tolerance = 1e-3;
  gas_options.solver.momentum_tolerance = 1e-14;
  gas_options.solver.outer_tolerance = 1e-13;
  gas_options.solver.max_outer_iterations = 40;
  cfd::BoundaryPatch jet{"jet", cfd::Side::z_min, {}, cfd::Inlet{5.0, {}}, "case.yaml:2"};
  jet.disc = cfd::DiscRegion{{0, 0, 0}, 0.05, 0};
  cfd::GasSolver gas(vessel.grid, gas_options,
                     {jet, {"outlet", cfd::Side::z_max, {}, cfd::Outlet{0}, "case.yaml:3"}}, vessel.immersed);
  std::vector<TestParticle> from = particles_in_vessel(4000, 8);
  append(from, particles_at_tube(-1, 2.5e-3));
  append(from, particles_at_tube(1, 2.5e-3));
  const dem::Particles particles = make_particles(from);
  MomentumExchange exchange(CouplingOptions{}, vessel.grid, vessel.grid, air, &gas.geometry());
  exchange.initialise(particles);
  gas.initialise(Vec3{}, exchange.exchange().void_fraction);
  const Real dt = 2e-4;
  for (int step = 0; step < 5; ++step) {
    exchange.sample_gas(gas.state().velocity, gas.state().pressure_gradient);
    exchange.compute_coefficients(particles);
    std::visit(
        [&](const auto& force) {
          Kokkos::parallel_for("tests::cut_grid::substep", DeviceRange(0, particles.count),
                               Substep<std::decay_t<decltype(force)>>{force, particles, dt});
        },
        exchange.fluid_force(particles));
    gas.update(dt, exchange.deposit(particles, dt));
    exchange.close_step(gas.state(), dt);
    const ExchangeTotals& totals = exchange.totals();
    ASSERT_GT(totals.gross, 0);
    const Vec3 booked = gas.balance().drag + gas.balance().particle_pressure;
    for (int axis = 0; axis < 3; ++axis) {
      const Real left = totals.particles_received[axis] + totals.gas_received[axis] + totals.pending[axis];
      // Round-off of some thousand cells and particles.
      EXPECT_NEAR(left, 0, 1e-12 * totals.gross) << "step " << step << " axis " << axis;
      EXPECT_NEAR(booked[axis], totals.gas_received[axis], 1e-12 * totals.gross) << "step " << step;
    }
  }
  EXPECT_LT(gas.balance().mass_defect(), 1e-12);
  EXPECT_LT(gas.balance().momentum_defect(), 1e-9);  // as without particles (tests/cfd)
}

TEST(CutGrid, RefusesOtherCellsAndSmoothing) {
  const ConeWithTube vessel;
  const cfd::FlowGeometry cut(vessel.grid, vessel.immersed), whole(vessel.grid);
  const CartesianGrid coarse(vessel.grid.box(), {10, 10, 9});
  const auto error_of = [&](const CouplingOptions& options, const CartesianGrid& transfer,
                            const cfd::FlowGeometry& walls) {
    try {
      const MomentumExchange exchange(options, transfer, vessel.grid, air, &walls);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CouplingOptions smooth;
  smooth.smoothing_length = 0.01;
  EXPECT_EQ(error_of({}, coarse, cut).find("coupling.transfer_grid: "), 0u);
  EXPECT_EQ(error_of(smooth, vessel.grid, cut).find("coupling.smoothing_length: "), 0u);
  EXPECT_EQ(error_of({}, vessel.grid, cut), "");
  EXPECT_EQ(error_of(smooth, coarse, whole), "");
}

}  // namespace
}  // namespace pellicle::coupling
