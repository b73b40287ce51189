// The gas solver of a case with walls: what the walls leave, and what is said about walls that leave too little.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/files.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/tools/cases_for_tests.hpp"
#include "tools/pellicle/build_gas.hpp"
#include "tools/pellicle/case_file.hpp"

namespace pellicle::tools {
namespace {

cfd::GasSolver build(const std::vector<std::string>& overrides = {}) {
  const CaseSpec spec = parse_case(tests::chamber_case, "c.yaml", overrides);
  return make_gas_solver(spec, make_walls(spec));
}

std::string error_of(const std::vector<std::string>& overrides) {
  try {
    build(overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(BuildGas, WallsCutTheGrid) {
  const cfd::GasSolver gas = build();
  const cfd::FlowGeometry& geometry = gas.geometry();
  ASSERT_EQ(geometry.surfaces.size(), 2u);  // the gas passes the sieve
  EXPECT_TRUE(geometry.surfaces[0].sticks);
  EXPECT_FALSE(geometry.surfaces[1].sticks);
  Real volume = 0;
  for (Index c = 0; c < geometry.stencil.cells(); ++c) volume += geometry.volume(c);
  // A cone from 30 to 48.75 mm over 150 mm; chords of half a cell, 5 mm: s^2 / 6 r^2 of it, 0.3 %.
  const Real r0 = 0.03, r1 = 0.04875;
  const Real exact = std::numbers::pi * 0.15 / 3 * (r0 * r0 + r0 * r1 + r1 * r1);
  EXPECT_NEAR(volume, exact, 0.005 * exact);
  EXPECT_GT(geometry.thin_faces, 0);
  EXPECT_NE(describe_cut(geometry).find("faces closed by thin walls"), std::string::npos);
}

// A closed vessel needs a way in, and the gas must be where the inlets are.
TEST(BuildGas, MessagesSayWhatIsWrong) {
  EXPECT_EQ(error_of({"gas.boundaries.jet.region.disc.centre=[55 mm, 55 mm, 0]"}),
            "c.yaml:13: gas.boundaries.jet: boundary 'jet' is outside of the gas: all that it covers of the "
            "bottom side is behind wall 'cone'; allowed: a part of the side that the gas reaches");
  EXPECT_EQ(error_of({"gas.boundaries.plate.region.disc.radius=45 mm"}),
            "c.yaml:14: gas.boundaries.plate: boundary 'plate' is an inlet of 0.006283 m2 of which only "
            "0.002737 m2 is open, the rest being behind wall 'cone'; allowed: an inlet within the gas");
  EXPECT_EQ(
      error_of({"gas.inside=[0, 0, 200 mm]"}),
      "--set: gas.inside: it is out of the domain; a point within [-0.06, -0.06, 0] to [0.06, 0.06, 0.15] m");
  EXPECT_NE(error_of({"gas.boundaries.top.on=left"}).find("outside of the gas"), std::string::npos);
  const std::string closed = error_of({"walls.sieve.gas=no_slip", "walls.sieve.disc.radius=50 mm"});
  EXPECT_NE(closed.find(
                "boundary 'jet' is outside of the gas: all that it covers of the bottom side is behind wall "
                "'sieve'"),
            std::string::npos)
      << closed;
}

// The plate's radius is 30 mm, the domain ends at -60 mm.
TEST(BuildGas, AnInletDiscEndsInTheDomainOrAtAPlaneOfSymmetry) {
  const std::string disc = "gas.boundaries.plate.region.disc.centre=";
  const std::string open = tests::chamber_case;
  const std::string mirrored = open + "    - {name: mirror, on: left, symmetry: {}}\n";
  const std::string what =
      "; a disc within [-0.06, -0.06, 0] to [0.06, 0.06, 0.15] m, or a plane of symmetry on that side with "
      "its "
      "centre in the domain";
  const std::string path = "c.yaml:14: gas.boundaries.plate.region.disc: ";
  const auto refusal = [](const std::string& text, const std::string& assignment) -> std::string {
    try {
      parse_case(text, "c.yaml", {assignment});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(open, disc + "[-30 mm, 0, 0]"), "accepted");
  EXPECT_EQ(refusal(open, disc + "[-40 mm, 0, 0]"),
            path + "it reaches 0.01 m beyond the left side of the domain" + what);
  EXPECT_EQ(refusal(open, disc + "[0, 50 mm, 0]"),
            path + "it reaches 0.02 m beyond the back side of the domain" + what);
  EXPECT_EQ(refusal(mirrored, disc + "[-60 mm, 0, 0]"), "accepted");
  EXPECT_EQ(refusal(mirrored, disc + "[-70 mm, 0, 0]"),
            path + "it reaches 0.04 m beyond the left side of the domain" + what);
}

// Without gas.inside the inlets say where the gas is: the odd one is named, not the one that is right.
TEST(BuildGas, TheInletThatLiesApartIsNamed) {
  const std::string moved = "gas.boundaries.jet.region.disc.centre=[55 mm, 55 mm, 0]";
  const std::string two = error_of({"gas.inside=", moved});
  EXPECT_NE(two.find("walls part inlet 'plate' from inlet 'jet'"), std::string::npos) << two;
  EXPECT_NE(two.find("gas.inside"), std::string::npos) << two;
  const std::string three =
      error_of({"gas.inside=", moved, "gas.boundaries.plate.region.disc.inner_radius=10 mm",
                "gas.boundaries.top={name: nozzle, on: bottom, region: {disc: {centre: [0, 0, 0], radius: 4 "
                "mm}}, inlet: "
                "{velocity: 1}}"});
  EXPECT_NE(three.find("inlet 'jet' lies apart from 'plate', 'nozzle'"), std::string::npos) << three;
}

// A cone that ends below the top of the domain lets the gas out into the rest of it.
TEST(BuildGas, AVesselThatLeaksIsRefused) {
  EXPECT_EQ(error_of({}), "no error");
  const std::string text = error_of({"walls.cone.cone.to=[0, 0, 100 mm]"});
  EXPECT_EQ(text,
            "c.yaml:7: gas: the vessel is open: 'cone', 'tube' has gas on both sides, and the gas reaches "
            "the sides left, "
            "right, front, back of the domain, which no boundary and no wall names; allowed: walls without a "
            "gap between "
            "them and gas.inside within, or, where the gas shall stop at these sides, a wall `box: domain` "
            "or boundaries "
            "`wall: {}`");
  // Where it is meant so: a tube in a box, and a body in the gas.
  EXPECT_EQ(error_of({"walls.cone.cone.to=[0, 0, 100 mm]",
                      "walls.sieve={name: sides, box: domain, material: steel}"}),
            "no error");
  const CaseSpec spec = parse_case(tests::blower_case, "c.yaml");
  const Leaks around = find_leaks(spec, make_gas_solver(spec, make_walls(spec)).geometry());
  EXPECT_FALSE(around.is_open);
  EXPECT_EQ(around.message,
            "c.yaml:5: gas: the gas around 'plug' reaches the sides left, right, front, back, bottom of the "
            "domain, which "
            "no boundary and no wall names: it stops there as at a wall");
}

// Half of the smallest diagonal of the cells of 10 mm is 7.07 mm: a circle of less may lie between their middles.
TEST(BuildGas, ATubeThinnerThanCellsIsRefused) {
  EXPECT_EQ(error_of({"walls.tube.cylinder.radius=7.1 mm"}), "no error");
  EXPECT_EQ(error_of({"walls.tube.cylinder.radius=7 mm"}),
            "--set: walls.tube.cylinder.radius: wall 'tube' is 0.014 m wide, so thin that no cell of the gas "
            "may have its "
            "middle within it; allowed: a radius of at least 0.007071 m, smaller cells (gas.grid), or `gas: "
            "open` at a "
            "wall that the gas passes");
  EXPECT_EQ(error_of({"walls.tube.cylinder.radius=7 mm", "walls.tube.gas=open"}), "no error");
}

// The gas takes walls as standing still: what would change its room is refused, by name.
TEST(BuildGas, WallsThatMoveTheGasAreRefused) {
  const std::string swing = "walls.tube.vibration={amplitude: [0, 0, 6 mm], frequency: 10 Hz}";
  EXPECT_EQ(error_of({swing}),
            "--set: walls.tube.vibration: wall 'tube' swings by 0.006 m along z, and the gas, which takes it "
            "as standing "
            "still, has cells of 0.01 m there; allowed: at most half a cell, or `gas: open` at a wall that "
            "the gas passes");
  EXPECT_EQ(error_of({"walls.tube.vibration={amplitude: [0, 0, 4 mm], frequency: 10 Hz}"}), "no error");
  EXPECT_EQ(error_of({swing, "walls.tube.gas=open"}), "no error");
  const std::string turn = "rate: 10 rad/s, through: [0, 0, 0]";
  EXPECT_EQ(error_of({"walls.tube.spin={axis: [0, 0, 1], " + turn + "}"}), "no error");
  const std::string tumbles = error_of({"walls.tube.spin={axis: [1, 0, 0], " + turn + "}"});
  EXPECT_EQ(
      tumbles,
      "--set: walls.tube.spin: wall 'tube' is not the same at every angle about the axis, and the gas cannot "
      "follow "
      "it; allowed: a shape that is round about the axis, or `gas: open` at a wall that the gas passes");
}

// Triangles of a cone frustum with a cylinder on top, in mm as drawings have them.
std::string vessel_stl(int sectors) {
  std::string text = "solid vessel\n";
  const auto corner = [&](int i, Real r, Real z) {
    const Real angle = 2 * std::numbers::pi * (i % sectors) / sectors;
    return fmt::format("vertex {} {} {}\n", r * std::cos(angle), r * std::sin(angle), z);
  };
  const auto triangle = [&](const std::string& a, const std::string& b, const std::string& c) {
    text += "facet normal 0 0 0\nouter loop\n" + a + b + c + "endloop\nendfacet\n";
  };
  const Real profile[][2] = {{20, -1}, {50, 80}, {50, 151}};
  for (int ring = 0; ring < 2; ++ring) {
    const auto [r0, z0] = profile[ring];
    const auto [r1, z1] = profile[ring + 1];
    for (int i = 0; i < sectors; ++i) {
      triangle(corner(i, r0, z0), corner(i + 1, r0, z0), corner(i + 1, r1, z1));
      triangle(corner(i, r0, z0), corner(i + 1, r1, z1), corner(i, r1, z1));
    }
  }
  return text + "endsolid vessel\n";
}

TEST(BuildGas, AVesselFromAnStlFileLosesNothing) {
  const tests::TemporaryFolder folder;
  core::write_file_atomically((folder / "vessel.stl").string(), vessel_stl(48));
  const CaseSpec spec =
      parse_case(R"(domain: {min: ["-60 mm", "-60 mm", 0], max: ["60 mm", "60 mm", "150 mm"]}
time: {end: 0.01, gas_step: 0.001}
walls: [{name: vessel, stl: vessel.stl, unit: mm, material: steel}]
gas:
  density: 1.2
  viscosity: 1.8e-5
  grid: {cells: [16, 16, 20]}
  boundaries:
    - {name: plate, on: bottom, region: {disc: {centre: [0, 0, 0], radius: "15 mm"}}, inlet: {flow_rate: "20 m3/h"}}
    - {name: top, on: top, outlet: {}}
  solver: {pressure_tolerance: 1e-13}
)",
                 (folder / "case.yaml").string());
  cfd::GasSolver gas = make_gas_solver(spec, make_walls(spec));
  EXPECT_EQ(find_leaks(spec, gas.geometry()).message, "");
  // A frustum from 20.37 mm (where it crosses the bottom) to 50 mm over 80 mm, and a cylinder of 70 mm; a polygon of 48
  // corners has 0.29 % less, chords of half a cell, 3.75 mm, another 0.1 to 0.4 %.
  const Real r0 = 0.02 + 0.03 / 81, r1 = 0.05;
  const Real exact = std::numbers::pi * (0.08 / 3 * (r0 * r0 + r0 * r1 + r1 * r1) + 0.07 * r1 * r1);
  Real volume = 0;
  for (Index c = 0; c < gas.geometry().stencil.cells(); ++c) volume += gas.geometry().volume(c);
  EXPECT_NEAR(volume, 0.9971 * exact, 0.005 * exact);
  const cfd::ParticleExchange exchange = cfd::make_empty_exchange(gas.grid());
  for (int step = 0; step < 10; ++step) gas.update(1e-3, exchange);
  const Real moved = 20.0 / 3600 * 1.2 * 0.01;
  EXPECT_NEAR(gas.balance().patches[0].mass_in, moved, 1e-13 * moved);
  EXPECT_NEAR(gas.balance().patches[1].mass_out, moved, 1e-10 * moved);
}

// A wall as an inlet, through the case file: half of a mass flow, exactly.
TEST(BuildGas, AWallCanBlow) {
  const CaseSpec spec = parse_case(tests::blower_case, "c.yaml");
  cfd::GasSolver gas = make_gas_solver(spec, make_walls(spec));
  const cfd::ParticleExchange exchange = cfd::make_empty_exchange(gas.grid());
  for (int step = 0; step < 5; ++step) gas.update(1e-3, exchange);
  EXPECT_NEAR(gas.balance().patches[0].mass_in, 0.5 * 1e-3 * 5e-3, 1e-15);
  EXPECT_NEAR(gas.balance().patches[1].mass_out, 0.5 * 1e-3 * 5e-3, 1e-12);
  const auto refused = [](const std::string& assignment) {
    try {
      parse_case(tests::blower_case, "c.yaml", {assignment});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string place = "gas.boundaries.blow.on_wall: ";
  EXPECT_NE(refused("gas.boundaries.blow.on_wall=plag").find(place + "no wall \"plag\"; plug"),
            std::string::npos);
  EXPECT_NE(refused("walls.plug.gas=free_slip").find(place + "\"plug\" says with gas: free_slip"),
            std::string::npos);
  EXPECT_NE(refused("walls.plug.gas=open").find(place + "the gas passes \"plug\""), std::string::npos);
  EXPECT_NE(refused("gas.boundaries.blow={name: blow, on_wall: plug, free_slip: {}}")
                .find(place + "a wall is a boundary"),
            std::string::npos);
  EXPECT_NE(refused("gas.boundaries.blow.on=left").find("on_wall"), std::string::npos);
  EXPECT_NE(refused("gas.boundaries.blow.inlet={velocity: 1, mass_flow: 1}").find("mass_flow"),
            std::string::npos);
}

// Which side the gas is on has to be said where no inlet says it.
TEST(BuildGas, WithoutInletInsideIsNeeded) {
  const std::string message =
      error_of({"gas.inside=", "gas.boundaries.jet.inlet=", "gas.boundaries.jet.wall={}",
                "gas.boundaries.plate.inlet=", "gas.boundaries.plate.wall={}"});
  EXPECT_NE(message.find("wall 'cone' divides the domain"), std::string::npos) << message;
  EXPECT_NE(message.find("gas.inside"), std::string::npos) << message;
}

// Particles need the cells that the walls cut; the message names the key and where it stands.
TEST(BuildGas, ExchangeInACutGridNeedsTheGasGridsCells) {
  const std::string text = std::string(tests::chamber_case) +
                           R"(materials: {glass: {density: 2500, youngs_modulus: 1e6, poisson_ratio: 0.22}}
contacts:
  pairs:
    - {between: [glass, glass], restitution: 0.9, sliding_friction: 0.3}
    - {between: [glass, steel], restitution: 0.9, sliding_friction: 0.3}
particles: [{material: glass, count: 10, diameter: "2 mm", fill: {box: {min: [0, 0, 0.05], max: [0.01, 0.01, 0.06]}}}]
coupling: {pending_release: 0.1}
)";
  const auto message_of = [&](std::vector<std::string> overrides) {
    overrides.emplace_back("time.particle_step=1e-5 s");
    const CaseSpec spec = parse_case(text, "c.yaml", overrides);
    const cfd::GasSolver gas = make_gas_solver(spec, make_walls(spec));
    try {
      const coupling::MomentumExchange exchange = make_exchange(spec, gas);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message_of({}), "");
  EXPECT_EQ(message_of({"coupling.smoothing_length=5 mm"}),
            "--set: coupling.smoothing_length: would smooth across the walls within the domain that cut the "
            "gas grid; "
            "allowed: 0");
  EXPECT_EQ(
      message_of({"coupling.transfer_grid.cells=[6, 6, 6]"}),
      "--set: coupling.transfer_grid: must have the cells of the gas grid, since walls within the domain cut "
      "them; allowed: leave it out");
}

}  // namespace
}  // namespace pellicle::tools
