// Gas in vessels that surfaces cut out of the grid: nothing is lost, still gas stays still, ledgers close.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cfd/gas_solver.hpp"
#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

constexpr Real pi = std::numbers::pi;

ImmersedSurface make_surface(SurfaceShape shape, std::string name = "wall") {
  return {std::move(name), {std::move(shape)}, {}, {}, {}};
}

BoundaryPatch make_disc_inlet(Real radius, Real inner_radius, Inlet inlet, std::string name = "inlet") {
  BoundaryPatch patch{std::move(name), Side::z_min, {}, inlet, "case.yaml:2"};
  patch.disc = DiscRegion{{0, 0, 0}, radius, inner_radius};
  return patch;
}

// A cone that widens upwards within a box, with a thin tube in it: the gas comes in through a disc and an annulus.
struct ConeWithTube {
  CartesianGrid grid{Box{{-0.1, -0.1, 0}, {0.1, 0.1, 0.3}}, {14, 13, 18}};
  ImmersedGeometry immersed;
  std::vector<BoundaryPatch> patches;
  ConeWithTube() {
    immersed.surfaces = {make_surface(RevolvedSurface{{0, 0, 0}, {0, 0, 1}, 0.06, 0, 0.09, 0.3}, "cone"),
                         make_surface(RevolvedSurface{{0, 0, 0}, {0, 0, 1}, 0.03, 0.08, 0.03, 0.2}, "tube")};
    immersed.inside = {0, 0, 1e-4};
    patches = {make_disc_inlet(0.02, 0, Inlet{5.0, {}}, "jet"),
               make_disc_inlet(0.06, 0.02, Inlet{{}, 0.004, 0.75}, "plate"),
               {"outlet", Side::z_max, {}, Outlet{0}, "case.yaml:3"}};
  }
};

TEST(ImmersedFlow, InletsDeliverExactlyAndNothingIsLost) {
  const ConeWithTube vessel;
  GasOptions options = make_air(Convection::ultimate_quickest);
  make_tight(options);
  GasSolver gas(vessel.grid, options, vessel.patches, vessel.immersed);
  const ParticleExchange exchange = make_empty_exchange(vessel.grid);
  StepReport report;
  constexpr Real dt = 5e-4;
  for (int step = 0; step < 20; ++step) report = gas.update(dt, exchange);
  const Real time = 20 * dt;
  const Real jet = 5.0 * pi * 0.02 * 0.02 * options.density * time;
  const Real plate = 0.75 * 0.004 * options.density * time;
  const auto& balance = gas.balance();
  // Round-off of some hundred faces.
  EXPECT_NEAR(balance.patches[0].mass_in, jet, 1e-13 * jet);
  EXPECT_NEAR(balance.patches[1].mass_in, plate, 1e-13 * plate);
  EXPECT_NEAR(balance.patches[2].mass_out, jet + plate, 1e-10 * (jet + plate));
  EXPECT_LT(balance.mass_defect(), 1e-12);
  EXPECT_LT(balance.momentum_defect(), 1e-9);
  EXPECT_LT(report.continuity_residual, 1e-12);
  EXPECT_GT(gas.geometry().part_cells, 500);
  EXPECT_GT(gas.geometry().thin_faces, 50);
  // Where no gas is, nothing moves, and no face lets anything out of the cone.
  for (Index c = 0; c < vessel.grid.cell_count(); ++c) {
    if (gas.geometry().volume(c) > 0) continue;
    EXPECT_EQ(norm(gas.state().velocity(c)), 0);
  }
}

// Gas at rest under a uniform pressure, whatever its outlet's: surfaces push back with what the faces leave open.
TEST(ImmersedFlow, StillGasStaysStill) {
  const ConeWithTube vessel;
  GasOptions options = make_air(Convection::central);
  auto patches = vessel.patches;
  patches[0].kind = Inlet{0.0, {}};
  patches[1].kind = Inlet{0.0, {}};
  constexpr Real pressure = 1e-3;
  patches[2].kind = Outlet{pressure};
  make_tight(options);
  options.solver.loose_pressure_tolerance = 1e-12;
  GasSolver gas(vessel.grid, options, patches, vessel.immersed);
  const ParticleExchange exchange = make_empty_exchange(vessel.grid);
  // The first step brings the pressure from 0 to the outlet's, a blow of 1e-4 m/s, of which some 1e-7 m/s
  // are left and die away. Walls whose areas do not close would push as hard in every step.
  for (int step = 0; step < 4; ++step) gas.update(1e-3, exchange);
  for (Index c = 0; c < vessel.grid.cell_count(); ++c) {
    if (!(gas.geometry().volume(c) > 0)) continue;
    EXPECT_LT(norm(gas.state().velocity(c)), 1e-6);
    EXPECT_NEAR(gas.state().pressure(c), pressure, 1e-3 * pressure);
  }
  // The force of the pressure on the cone: on its shadow, the annulus between its ends, downwards, for the gas is
  // within and above. Chords between lattice points cost 1 %.
  const Real shadow = pi * (0.09 * 0.09 - 0.06 * 0.06);
  EXPECT_NEAR(gas.surface_force(0).z, -pressure * shadow, 0.01 * pressure * shadow);
  EXPECT_NEAR(gas.surface_force(0).x, 0, 1e-3 * pressure * shadow);
}

// A channel between two tilted planes, driven along them: plane Poiseuille flow whatever the tilt.
struct TiltedChannel {
  Real velocity_error = 0;  // of the mean flow, relative
  Real profile_error = 0;   // L2 of the cells' velocities over the largest
};

TiltedChannel run_tilted_channel(Index cells) {
  constexpr Real length = 1;
  const Vec3 along = (1 / std::sqrt(5.0)) * Vec3{2, 1, 0};
  const Vec3 across = (1 / std::sqrt(5.0)) * Vec3{-1, 2, 0};
  // Periodic along x and y: planes repeat with period length / sqrt(5) across; of these channels one is filled.
  const Real period = length / std::sqrt(5.0);
  const Real half = 0.3 * period;
  const Real middle = 0.5 * period;
  const CartesianGrid grid(Box{{0, 0, 0}, {length, length, 0.1}}, {cells, cells, 1}, {true, true, true});
  ImmersedGeometry immersed;
  ImmersedSurface walls{"walls", {}, {}, {}, {}};
  for (int k = -3; k <= 6; ++k) {
    walls.shapes.emplace_back(PlaneSurface{across, k * period + middle - half});
    walls.shapes.emplace_back(PlaneSurface{across, k * period + middle + half});
  }
  immersed.surfaces = {walls};
  immersed.inside = middle * across + 0.41 * along + Vec3{0, 0, 0.05};
  GasOptions options = make_air(Convection::central);
  options.density = 1;
  options.viscosity = 0.1;
  options.gravity = {};
  constexpr Real force = 1;
  options.body_force = force * along;
  make_tight(options);
  options.solver.max_outer_iterations = 3;
  GasSolver gas(grid, options, {}, immersed);
  const ParticleExchange exchange = make_empty_exchange(grid);
  // Viscous time half^2 / nu = 0.18 s.
  for (int step = 0; step < 60; ++step) gas.update(0.1, exchange);
  TiltedChannel result;
  Real sum = 0, volume = 0, square = 0;
  const Real largest = force * half * half / (2 * options.viscosity);
  for (Index c = 0; c < grid.cell_count(); ++c) {
    const Real v = gas.geometry().volume(c);
    if (!(v > 0)) continue;
    const Index3 at = grid.coordinates(c);
    const Vec3 centre{grid.center(0, at.x), grid.center(1, at.y), 0};
    Real y = std::remainder(dot(centre, across) - middle, period);
    const Real u = dot(gas.state().velocity(c), along);
    sum += v * u;
    volume += v;
    if (std::abs(y) < half - 1.5 * length / cells) {
      const Real exact = largest * (1 - y * y / (half * half));
      square += v * (u - exact) * (u - exact);
    }
  }
  result.velocity_error = std::abs(sum / volume / (2.0 / 3.0 * largest) - 1);
  result.profile_error = std::sqrt(square / volume) / largest;
  return result;
}

// Measured: 0.0194, 0.0072, 0.0022 and of the mean flow 0.054, 0.016, 0.0044 with 5, 11 and 21 cells across the channel. In
// cells that walls cut the stress is that of a straight profile, an error of the order of the cell in a layer as thin as
// a cell: order 2 would need the profile's curvature there, order 1 is what a wall along the cells' faces gives.
TEST(ImmersedFlow, TiltedChannelConverges) {
  const TiltedChannel coarse = run_tilted_channel(20);
  const TiltedChannel fine = run_tilted_channel(80);
  EXPECT_LT(fine.profile_error, 0.004);
  EXPECT_LT(fine.velocity_error, 0.008);
  EXPECT_GT(0.5 * std::log2(coarse.profile_error / fine.profile_error), 1.4);
  EXPECT_GT(0.5 * std::log2(coarse.velocity_error / fine.velocity_error), 1.5);
}

// A channel between two blocks whose sides lie on grid planes, driven along: the parabola of Poiseuille as between sides of
// the domain, each block taking half of the force.
TEST(ImmersedFlow, BlocksOnGridPlanesHoldTheGas) {
  constexpr Index n = 16;
  constexpr Real h = 1.0 / n, force = 2, viscosity = 0.5;
  for (const Index low : {2, 5}) {  // rows below and above the channel, which takes 9
    const CartesianGrid grid(Box{{0, 0, 0}, {4 * h, h, 1}}, {4, 1, n}, {true, true, false});
    const Real floor = low * h, roof = floor + 9 * h;
    ImmersedGeometry immersed;
    immersed.surfaces = {make_surface(BoxSurface{{-1, -1, -1}, {2, 2, floor}}, "floor"),
                         make_surface(BoxSurface{{-1, -1, roof}, {2, 2, 2}}, "roof")};
    immersed.inside = {0.3 * h, 0.3 * h, floor + 4.3 * h};
    GasOptions options = make_air(Convection::central);
    options.density = 1;
    options.viscosity = viscosity;
    options.body_force = {force, 0, 0};
    make_tight(options);
    GasSolver gas(grid, options, {}, immersed);
    const ParticleExchange exchange = make_empty_exchange(grid);
    for (int step = 0; step < 60; ++step) gas.update(1, exchange);
    // The finite volumes of a parabola between walls at half a cell: u = f/(2 mu) (z (H - z) + h2/4) at middles, for the
    // stress at a wall is taken over half a cell.
    for (Index k = low; k < low + 9; ++k) {
      const Real z = grid.center(2, k) - floor;
      const Real exact = force / (2 * viscosity) * (z * (9 * h - z) + 0.25 * h * h);
      EXPECT_NEAR(gas.state().velocity(grid.index(1, 0, k)).x, exact, 1e-5 * exact) << low << ' ' << k;
    }
    const auto forces = gas.surface_forces();
    const Real driven = force * 4 * h * h * 9 * h;
    EXPECT_NEAR(forces[0].x, 0.5 * driven, 1e-5 * driven);
    EXPECT_NEAR(forces[1].x, 0.5 * driven, 1e-5 * driven);
    EXPECT_LT(gas.balance().momentum_defect(), 1e-9);
  }
}

}  // namespace
}  // namespace pellicle::cfd
