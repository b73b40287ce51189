// The gas solver of a case with walls: what the walls leave, and what is said about walls that leave too little.
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "core/error.hpp"
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
            "c.yaml:13: gas.boundaries.jet: boundary 'jet' is outside of the gas: walls keep it from every "
            "face that it "
            "covers of the bottom side; allowed: a part of the side that the gas reaches");
  EXPECT_EQ(error_of({"gas.boundaries.plate.region.disc.radius=45 mm"}),
            "c.yaml:14: gas.boundaries.plate: boundary 'plate' is an inlet of 0.006283 m2 of which walls "
            "leave 0.002737 m2 "
            "open; allowed: an inlet within the gas");
  EXPECT_EQ(
      error_of({"gas.inside=[0, 0, 200 mm]"}),
      "--set: gas.inside: it is out of the domain; a point within [-0.06, -0.06, 0] to [0.06, 0.06, 0.15] m");
  EXPECT_NE(error_of({"gas.boundaries.top.on=left"}).find("outside of the gas"), std::string::npos);
  const std::string closed = error_of({"walls.sieve.gas=no_slip", "walls.sieve.disc.radius=50 mm"});
  EXPECT_NE(closed.find("boundary 'jet' is outside of the gas"), std::string::npos) << closed;
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
