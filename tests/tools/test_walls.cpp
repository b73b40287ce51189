// Walls of a case file: what is read, what becomes of it in the engine, what is refused, and what outputs say of walls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "core/csv.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/dem/meshes.hpp"
#include "tests/tools/cases_for_tests.hpp"
#include "tools/pellicle/build_case.hpp"
#include "tools/pellicle/build_walls.hpp"
#include "tools/pellicle/case_file.hpp"
#include "tools/pellicle/probes.hpp"

namespace pellicle::tools {
namespace {

using tests::TemporaryFolder;
using tests::vessel_case;

/// What is wrong with the case, without the place.
std::string errors(const std::vector<std::string>& overrides) {
  try {
    parse_case(vessel_case, "c.yaml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CaseWalls, BecomeShapesThatMove) {
  const TemporaryFolder folder;
  core::write_file_atomically(folder / "insert.stl",
                              tests::binary_stl(tests::box_triangles({18, 18, 60}, {22, 22, 70})));
  const CaseSpec spec = parse_case(vessel_case, (folder / "case.yaml").string());
  const auto walls = make_engine_setup(spec, 1e-6).walls;
  ASSERT_EQ(walls.size(), 5U);
  const dem::RevolvedShape plate = walls[0].revolved.at(0);
  EXPECT_EQ(plate.origin, (Vec3{0.02, 0.02, 0.002}));
  EXPECT_EQ(plate.axis, (Vec3{0, 0, 1}));
  EXPECT_EQ(plate.r0, 0.001);
  EXPECT_EQ(plate.r1, 0.018);
  EXPECT_EQ(plate.z1 - plate.z0, 0);
  // 60 rpm about -z: one turn a second.
  EXPECT_NEAR(walls[0].motion.spin.z, -2 * M_PI, 1e-14);
  EXPECT_EQ(walls[0].torque_about, (Vec3{0.02, 0.02, 0}));
  EXPECT_FALSE(has_to_turn(walls[0]));
  const dem::RevolvedShape tube = walls[1].revolved.at(0);
  EXPECT_EQ(tube.r0, 0.018);
  EXPECT_EQ(tube.r1, 0.018);
  EXPECT_NEAR(tube.z1 - tube.z0, 0.06, 1e-16);
  EXPECT_EQ(walls[1].torque_about, (Vec3{0, 0, 1}));
  const dem::RevolvedShape funnel = walls[2].revolved.at(0);
  EXPECT_EQ(funnel.r0, 0.005);
  EXPECT_EQ(funnel.r1, 0.018);
  EXPECT_NEAR(funnel.z1, 0.01, 1e-16);
  EXPECT_EQ(walls[3].boxes.at(0).max, (Vec3{0.03, 0.015, 0.005}));
  EXPECT_EQ(walls[3].motion.amplitude, (Vec3{0, 0, 0.001}));
  EXPECT_EQ(walls[3].motion.frequency, 50);
  EXPECT_NEAR(walls[3].motion.phase, M_PI / 2, 1e-15);
  // The mesh is found beside the case file, and is in mm.
  ASSERT_TRUE(walls[4].mesh);
  EXPECT_EQ(walls[4].mesh->triangles.size(), 12U);
  EXPECT_NEAR(walls[4].mesh->corners[0].x, 0.018, 1e-9);
}

TEST(CaseWalls, MistakesAreNamed) {
  EXPECT_EQ(
      errors({"walls.plate.disc.inner_radius=18 mm"}),
      "--set: walls.plate.disc.inner_radius: 0.018 m is not below the radius of 0.018 m; a smaller one");
  EXPECT_EQ(errors({"walls.plate.spin.axis=[0, 0, 0]"}),
            "--set: walls.plate.spin.axis: it has no length; a direction such as [0, 0, 1]");
  EXPECT_EQ(
      errors({"walls.plate.velocity=[0, 0, 1]"}),
      "--set: walls.plate.velocity: it leads through the wall; a velocity at right angles to the normal");
  EXPECT_EQ(errors({"walls.tube.unit=mm"}),
            "--set: walls.tube.unit: there is no file that it says something of; only with stl");
  EXPECT_EQ(errors({"walls.tube={name: tube, material: steel, box: domain, spin: {rate: 1, axis: [0, 0, 1], "
                    "through: [0, 0, 0]}}"}),
            "--set: walls.tube.spin: the sides of the domain cannot turn; any other shape");
  EXPECT_EQ(errors({"output.probes.load.wall=tub"}),
            "--set: output.probes.load.wall: no wall \"tub\"; plate, tube, funnel, step, insert");
  EXPECT_NE(errors({"output.probes.load.quantities=[pressure]"})
                .find("does not fit this kind of probe; wall_force_x"),
            std::string::npos);
}

TEST(CaseWalls, BadMeshesAreNamedWithFileAndLine) {
  const TemporaryFolder folder;
  const std::string name = (folder / "case.yaml").string();
  const auto error = [&] {
    const CaseSpec spec = parse_case(vessel_case, name);
    try {
      make_wall(spec, spec.walls[4]);
    } catch (const InputError& problem) {
      return std::string(problem.what());
    }
    return std::string("no error");
  };
  const std::string mesh = (folder / "insert.stl").string();
  const std::string place = name + ":17: walls.insert.stl: " + mesh + ": ";
  EXPECT_EQ(error(), place + "it cannot be read; a file that is there");
  core::write_file_atomically(mesh, "not a mesh");
  EXPECT_EQ(error(), place +
                         "it is no STL file: it neither begins with \"solid\" nor has the size of a binary "
                         "one; an STL file, ASCII or binary");
}

TEST(CaseWalls, ProbeGivesMeansSinceTheRowBefore) {
  const TemporaryFolder folder;
  const ResultsFolder results(folder / "r", ResultsFolder::Existing::refuse);
  core::TimeControl time(1, 0.1, 0.1);
  ProbeSpec spec;
  spec.name = "load";
  spec.wall = "tube";
  spec.quantities = {"wall_force_z", "wall_torque_y", "wall_contacts"};
  spec.every = 0.2;
  const Box box{{0, 0, 0}, {1, 1, 1}};
  std::vector<WallFigures> walls{{"other", {9, 9, 9}, {9, 9, 9}, 9}, {"tube", {}, {}, 0}};
  const auto give = [&](Vec3 impulse, Vec3 angular) {
    walls[1].impulse += impulse;
    walls[1].angular_impulse += angular;
    ++walls[1].contacts;
  };
  {
    Probes probes({spec}, time, results, box, nullptr, std::nullopt);
    probes.sample({.step = 0, .time = 0, .walls = &walls});
    give({1, 2, 3}, {0, 4, 0});
    probes.sample({.step = 1, .time = 0.1, .walls = &walls});  // no row
    give({1, 2, 5}, {0, 2, 0});
    probes.sample({.step = 2, .time = 0.2, .walls = &walls});  // 8 N s and 6 N m s in 0.2 s
    core::CheckpointWriter file(folder / "checkpoint.h5");
    give({0, 0, 1}, {0, 0, 0});
    probes.save(file);
    file.close();
    probes.flush();
  }
  Probes probes({spec}, time, results, box, nullptr, 0.2);
  const core::CheckpointReader file(folder / "checkpoint.h5");
  probes.load(file);
  give({0, 0, 1}, {0, 1, 0});
  probes.sample({.step = 4, .time = 0.4, .walls = &walls});  // 2 N s, 1 N m s
  probes.flush();
  EXPECT_EQ(
      core::read_file(results.csv("probes", "load")),
      "time [s],wall_force_z [N],wall_torque_y [N m],wall_contacts [-]\n0,0,0,0\n0.2,40,30,2\n0.4,10,5,4\n");
}

}  // namespace
}  // namespace pellicle::tools
