// Boundary regions: areas to the last bit, flows as asked, messages.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "cfd/boundary_pieces.hpp"
#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

const std::string here = "bed.yaml:12: gas.boundaries.1";

std::string message_of(const CartesianGrid& grid, const std::vector<BoundaryPatch>& patches) {
  try {
    GasSolver solver(grid, make_air(), patches);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

const CartesianGrid grid_of_7(Box{{0, 0, 0}, {0.07, 0.02, 0.1}}, {7, 2, 10});

// Edges of the slot at 0.0333 and 0.0381 cut two faces of 0.01; the flow through the boundary faces must be that of
// the slot's own area.
TEST(Boundaries, InletWhoseEdgesCutFacesDeliversItsFlow) {
  const Box slot{{0.0333, -1, -1}, {0.0381, 1, 1}};
  for (const bool by_rate : {false, true}) {
    const Inlet inlet = by_rate ? Inlet{{}, 1e-3} : Inlet{40.0, {}};
    GasSolver solver(grid_of_7, make_air(),
                     {{"slot", Side::z_min, slot, inlet, here},
                      {"rest", Side::z_min, {}, Inlet{2.0, {}}, here},
                      {"top", Side::z_max, {}, Outlet{0}, here}});
    const auto exchange = make_empty_exchange(grid_of_7);
    advance(solver, exchange, 1e-4, 10);
    const Real slot_area = (0.0381 - 0.0333) * 0.02;
    const Real slot_flow = by_rate ? 1e-3 : 40 * slot_area;
    const Real rest_flow = 2.0 * (0.07 * 0.02 - slot_area);
    // Round-off of sums of a dozen areas.
    EXPECT_NEAR(solver.balance().patches[0].mass_in / (1.2 * 1e-3 * slot_flow), 1, 1e-13);
    EXPECT_NEAR(solver.balance().patches[1].mass_in / (1.2 * 1e-3 * rest_flow), 1, 1e-13);
    EXPECT_EQ(solver.balance().patches[0].mass_out, 0);
    Real bottom = 0;
    for (Index j = 0; j < 2; ++j) {
      for (Index i = 0; i < 7; ++i) bottom += solver.state().volume_flux[2](i + 7 * j);
    }
    EXPECT_NEAR(bottom / (slot_flow + rest_flow), 1, 1e-13);
    EXPECT_NEAR(solver.balance().patches[2].mass_out / (1.2 * 1e-3 * (slot_flow + rest_flow)), 1, 1e-9);
  }
}

TEST(Boundaries, PiecesAddUpToTheFaces) {
  const FlowGeometry geometry(grid_of_7);
  const Boundaries cut = cut_boundaries(
      geometry, {{"a", Side::z_min, Box{{0.0333, 0.003, 0}, {0.0381, 0.012, 0}}, Inlet{1.0, {}}, here},
                 {"b", Side::z_min, Box{{0.0381, 0, 0}, {0.052, 0.02, 0}}, Inlet{2.0, {}}, here},
                 {"out", Side::x_max, {}, Outlet{3}, here}});
  std::array<std::vector<Real>, 3> sum;
  for (std::size_t a = 0; a < 3; ++a) sum[a].assign(geometry.area[a].extent(0), 0);
  Real inlet_area = 0;
  for (const BoundaryPiece& piece : cut.pieces) {
    sum[static_cast<std::size_t>(piece.axis)][static_cast<std::size_t>(piece.face)] += piece.area;
    if (piece.patch == 0) inlet_area += piece.area;
  }
  EXPECT_NEAR(inlet_area, 0.0048 * 0.009, 1e-18);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t f = 0; f < sum[a].size(); ++f) {
      if (sum[a][f] > 0) {
        EXPECT_NEAR(sum[a][f] / geometry.area[a](f), 1, 1e-14);
      }
    }
  }
}

TEST(Boundaries, MessagesSayWhereAndWhat) {
  const BoundaryPatch top{"top", Side::z_max, {}, Outlet{0}, "bed.yaml:20: gas.boundaries.9"};
  const auto expect = [&](const std::vector<BoundaryPatch>& patches, const std::string& what,
                          const CartesianGrid& grid) {
    const std::string message = message_of(grid, patches);
    EXPECT_NE(message.find(what), std::string::npos) << message;
    EXPECT_EQ(message.find("bed.yaml:"), 0u) << message;
    EXPECT_NE(message.find("allowed: "), std::string::npos) << message;
  };
  const auto region = [](Real from, Real to) { return Box{{from, -1, -1}, {to, 1, 1}}; };
  expect({{"a", Side::z_min, region(0, 0.03), Inlet{1.0, {}}, here},
          {"b", Side::z_min, region(0.02, 0.05), Inlet{1.0, {}}, here},
          top},
         "'b' overlaps boundary 'a' on the bottom side", grid_of_7);
  expect({{"a", Side::z_min, region(0.08, 0.09), Inlet{1.0, {}}, here}, top},
         "covers no face of the bottom side", grid_of_7);
  expect({{"a", Side::z_min, Box{{0, 0, 0.05}, {1, 1, 0.06}}, Inlet{1.0, {}}, here}, top}, "covers no face",
         grid_of_7);
  expect(
      {{"a", Side::z_min, region(-1, 1), Inlet{1.0, {}}, here}, {"b", Side::z_min, {}, NoSlip{}, here}, top},
      "'b' covers no face", grid_of_7);
  expect({{"a", Side::z_min, {}, Inlet{1.0, {}}, here}, {"b", Side::z_min, {}, NoSlip{}, here}, top},
         "takes the rest of the bottom side, as 'a' does", grid_of_7);
  expect({{"a", Side::z_min, {}, Inlet{1.0, {}}, here}}, "has no way out", grid_of_7);
  expect({{"a", Side::z_min, {}, Inlet{1.0, 2.0}, here}, top},
         "exactly one of velocity, flow_rate and mass_flow", grid_of_7);
  expect({{"a", Side::z_min, {}, Inlet{}, here}, top}, "exactly one of velocity, flow_rate and mass_flow",
         grid_of_7);
  expect({{"a", Side::x_min, {}, NoSlip{{1, 0, 0}}, here}}, "moves at right angles", grid_of_7);
  const CartesianGrid periodic(grid_of_7.box(), grid_of_7.cells(), {true, false, false});
  expect({{"a", Side::x_max, {}, Outlet{0}, here}}, "where the domain is periodic", periodic);
}

// A closed box with one opening for what comes in elsewhere: an inlet that draws as much as another gives needs no
// outlet.
TEST(Boundaries, SuctionMayBalanceInflow) {
  GasSolver solver(
      grid_of_7, make_air(),
      {{"in", Side::z_min, {}, Inlet{1.0, {}}, here}, {"suction", Side::z_max, {}, Inlet{-1.0, {}}, here}});
  const auto exchange = make_empty_exchange(grid_of_7);
  advance(solver, exchange, 1e-3, 50);
  EXPECT_LT(solver.balance().mass_defect(), 1e-12);
  EXPECT_GT(solver.state().velocity(grid_of_7.index(3, 0, 5)).z, 0.9);
}

// Half a symmetric domain with a plane of symmetry gives the flow of the whole one, cell by cell: a jet between walls
// without shear bends towards the outlets on both sides. With particles, whose drag and void fraction jump.
// Tolerance: the faces next to the plane interpolate tangential stress otherwise, which leaves 1e-3; 6e-2 if the pressure
// is extrapolated to the plane instead of mirrored there.
TEST(Boundaries, PlaneOfSymmetryMirrorsTheFlow) {
  for (const Convection scheme : {Convection::upwind, Convection::central}) {
    GasOptions options = make_air(scheme);
    options.viscosity = 1e-3;
    make_tight(options);
    options.solver.max_outer_iterations = 20;
    options.solver.outer_tolerance = 1e-13;
    const auto run = [&](bool whole) {
      const Index nx = whole ? 12 : 6;
      const Real width = whole ? 0.12 : 0.06;
      const CartesianGrid grid(Box{{0, 0, 0}, {width, 0.01, 0.1}}, {nx, 1, 10});
      auto patches = symmetry_on({Side::y_min, Side::y_max, Side::z_max});
      patches.push_back({"jet", Side::z_min, Box{{0.04, -1, -1}, {0.08, 1, 1}}, Inlet{1.0, {}}, here});
      patches.push_back({"left", Side::x_min, {}, Outlet{0}, here});
      if (whole) {
        patches.push_back({"right", Side::x_max, {}, Outlet{0}, here});
      } else {
        patches.push_back({"plane", Side::x_max, {}, Symmetry{}, here});
      }
      GasSolver solver(grid, options, patches);
      auto exchange = make_empty_exchange(grid);
      for (Index c = 0; c < grid.cell_count(); ++c) {
        const Index3 at = grid.coordinates(c);
        const Real from_plane = 0.06 - grid.center(0, at.x);
        if (at.z < 4 || std::abs(from_plane) > 0.03) continue;
        exchange.void_fraction(c) = 0.6;
        exchange.exchange_coefficient(c) = 20;
        exchange.explicit_force(c) = {3 * from_plane, 0, 1};
      }
      solver.initialise(Vec3{}, exchange.void_fraction);
      advance(solver, exchange, 1e-3, 60);
      // Iterated, the books of momentum close, the normal stress on the plane included.
      EXPECT_LT(solver.balance().momentum_defect(), 1e-10);
      std::vector<Vec3> values;
      for (Index k = 0; k < 10; ++k) {
        for (Index i = 0; i < 6; ++i) {
          values.push_back(solver.state().velocity(i + nx * k));
          values.push_back(1e-2 * solver.state().pressure_gradient(i + nx * k));
        }
      }
      return values;
    };
    const std::vector<Vec3> whole = run(true), half = run(false);
    Real worst = 0;
    for (std::size_t v = 0; v < whole.size(); ++v) {
      worst = std::max(worst, norm(whole[v] - half[v]));
    }
    std::printf("whole and half a domain differ by %.2e m/s\n", worst);
    EXPECT_LT(worst, 5e-3);
    // Next to the plane gas really moves across.
    EXPECT_GT(std::abs(half[34].x), 1e-2);
  }
}

// Couette flow is linear: exact on any grid, wall shear included, for each moving side.
TEST(Boundaries, MovingWallDragsTheGasLinearly) {
  const CartesianGrid grid(std::array<std::vector<Real>, 3>{{{0, 1}, make_stretched_faces(2, 9), {0, 1}}},
                           {true, false, true});
  GasOptions options = make_air();
  options.viscosity = 1;
  options.density = 1;
  make_tight(options);
  for (const Side side : {Side::y_min, Side::y_max}) {
    GasSolver solver(grid, options, {{"belt", side, {}, NoSlip{{3, 0, -1}}, here}});
    advance(solver, make_empty_exchange(grid), 100, 20);
    for (Index j = 0; j < 9; ++j) {
      const Real share = side == Side::y_max ? grid.center(1, j) / 2 : 1 - grid.center(1, j) / 2;
      EXPECT_NEAR(solver.state().velocity(j).x, 3 * share, 1e-10);
      EXPECT_NEAR(solver.state().velocity(j).z, -share, 1e-10);
    }
  }
}

// A channel between two sides of the domain, from a uniform inlet to a parabola: the walls take what the pressure loses over
// the section less what momentum gains, 6/5 of the inlet's. 40 rows; the outlet is 5 lengths of development away.
TEST(Boundaries, SidesTakeThePressureDrop) {
  constexpr Real height = 0.1, width = 0.02, length = 0.4, speed = 1, density = 1;
  const CartesianGrid grid(Box{{0, 0, 0}, {length, width, height}}, {40, 1, 40});
  GasOptions options = make_air(Convection::central);
  options.density = density;
  options.viscosity = 0.01;
  make_tight(options);
  auto patches = symmetry_on({Side::y_min, Side::y_max});
  patches.push_back({"in", Side::x_min, {}, Inlet{speed, {}}, "case.yaml:2"});
  patches.push_back({"out", Side::x_max, {}, Outlet{3}, "case.yaml:3"});
  GasSolver gas(grid, options, patches);
  gas.initialise({speed, 0, 0});
  const ParticleExchange exchange = make_empty_exchange(grid);
  for (int step = 0; step < 200; ++step) gas.update(0.02, exchange);
  const std::array<Vec3, 6> forces = gas.side_forces();
  const Real section = height * width;
  const Real expected = gas.pressure_drop("in", "out") * section - 0.2 * density * speed * speed * section;
  const Vec3 floor = forces[static_cast<std::size_t>(Side::z_min)];
  const Vec3 roof = forces[static_cast<std::size_t>(Side::z_max)];
  EXPECT_NEAR(floor.x, 0.5 * expected, 0.005 * expected);  // the inlet's own shear is a few thousandths
  EXPECT_NEAR(roof.x, floor.x, 1e-8 * expected);
  EXPECT_NEAR(roof.z, -floor.z, 1e-8 * roof.z);
  EXPECT_GT(roof.z, 3 * length * width);  // upwards, by more than the outlet's pressure
  EXPECT_LT(roof.z, gas.patch_pressure("in") * length * width);
  for (const Side side : {Side::x_min, Side::x_max, Side::y_min, Side::y_max}) {
    EXPECT_EQ(norm(forces[static_cast<std::size_t>(side)]), 0);  // openings and planes of symmetry
  }
}

}  // namespace
}  // namespace pellicle::cfd
