#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/error.hpp"
#include "core/files.hpp"
#include "core/hdf5_file.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/tools/particles_for_tests.hpp"
#include "tools/pellicle/snapshots.hpp"

using namespace pellicle;
using namespace pellicle::tools;
using pellicle::tests::TemporaryFolder;

namespace {

const std::vector<std::string> all_particle_fields{"id",   "velocity", "spin",  "radius",      "diameter",
                                                   "mass", "material", "speed", "acceleration"};

HostParticles some_particles(int count) {
  std::vector<tests::MadeUpParticle> made_up;
  for (int n = 0; n < count; ++n) {
    const int id = count - 1 - n;  // stored backwards
    made_up.push_back({{0.1 * id, 0.2, 0.3}, {0.3 * id, 0, 0.4 * id}, id, 1e-3 * (id + 1)});
  }
  return copy_to_host(tests::make_particles(made_up));
}

int count_of(const std::string& text, const std::string& part) {
  int found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace

TEST(ParticleSnapshots, FieldsInTheOrderOfIds) {
  TemporaryFolder folder;
  ParticleSnapshots snapshots(folder.path(), all_particle_fields);
  snapshots.write(0, 0, some_particles(3));
  snapshots.write(500, 0.05, some_particles(2));
  const core::Hdf5File file(folder / "particles.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.members("/"), (std::vector<std::string>{"rows", "step0000000000", "step0000000500"}));
  EXPECT_EQ(file.attribute_double("step0000000500", "time"), 0.05);
  EXPECT_EQ(file.attribute_int64("step0000000500", "step"), 500);
  EXPECT_EQ(file.read<std::int32_t>("step0000000000/id"), (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_EQ(file.shape("step0000000000/position"), (std::vector<std::size_t>{3, 3}));
  EXPECT_EQ(file.read<double>("step0000000000/position"),
            (std::vector<double>{0, 0.2, 0.3, 0.1, 0.2, 0.3, 0.1 * 2, 0.2, 0.3}));
  EXPECT_EQ(file.read<double>("step0000000000/radius"), (std::vector<double>{1e-3, 1e-3 * 2, 1e-3 * 3}));
  EXPECT_EQ(file.read<double>("step0000000000/spin")[4], 0.2);
  EXPECT_NEAR(file.read<double>("step0000000000/speed")[2], 1.0, 1e-15);
  EXPECT_EQ(file.shape("step0000000500/velocity"), (std::vector<std::size_t>{2, 3}));
}

TEST(ParticleSnapshots, ResumeDropsLaterSteps) {
  TemporaryFolder folder;
  {
    ParticleSnapshots snapshots(folder.path(), {"id"});
    for (int n = 0; n < 4; ++n) snapshots.write(std::int64_t{100} * n, 0.1 * n, some_particles(n + 1));
  }
  {
    ParticleSnapshots snapshots(folder.path(), {"id", "speed"}, 150);
    snapshots.write(200, 0.2, some_particles(7));
  }
  {
    const core::Hdf5File file(folder / "particles.h5", core::Hdf5File::Mode::read);
    EXPECT_EQ(file.members("/"),
              (std::vector<std::string>{"rows", "step0000000000", "step0000000100", "step0000000200"}));
    EXPECT_EQ(file.shape("step0000000200/id"), (std::vector<std::size_t>{7}));
  }
  const std::string xdmf = core::read_file(folder / "particles.xdmf");
  EXPECT_EQ(count_of(xdmf, "<Time Value"), 3);
  EXPECT_EQ(count_of(xdmf, "Name=\"speed\""), 1);
  EXPECT_EQ(count_of(xdmf, "NumberOfElements=\"7\""), 1);
  EXPECT_EQ(
      count_of(xdmf,
               "Dimensions=\"7\" NumberType=\"Int\" Precision=\"4\" Format=\"HDF\">particles.h5:/rows<"),
      3);
  EXPECT_EQ(count_of(xdmf, folder.path().string()), 0);  // paths are relative
  // A new run begins new files.
  ParticleSnapshots snapshots(folder.path(), {"id"});
  snapshots.write(0, 0, some_particles(1));
  EXPECT_EQ(count_of(core::read_file(folder / "particles.xdmf"), "<Time Value"), 1);
}

TEST(ParticleSnapshots, HalfWrittenStepIsDropped) {
  TemporaryFolder folder;
  {
    ParticleSnapshots snapshots(folder.path(), {"id"});
    snapshots.write(100, 0.1, some_particles(1));
    core::Hdf5File file(folder / "particles.h5", core::Hdf5File::Mode::append);
    file.write_number("step0000000050/position", 1.0);  // without the attributes that come last
    file.close();
  }
  ParticleSnapshots snapshots(folder.path(), {"id"}, 100);
  const core::Hdf5File file(folder / "particles.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.members("/"), (std::vector<std::string>{"rows", "step0000000100"}));
}

TEST(ParticleSnapshots, DamagedFileIsKeptAside) {
  TemporaryFolder folder;
  core::write_file_atomically(folder / "particles.h5", "not HDF5");
  ParticleSnapshots snapshots(folder.path(), {"id"}, 100);
  snapshots.write(200, 0.2, some_particles(1));
  EXPECT_EQ(core::read_file(folder / "particles.h5.damaged"), "not HDF5");
  const core::Hdf5File file(folder / "particles.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.members("/").size(), 2u);
}

// A child that does nothing else than writing snapshots is killed: what the XDMF file names can be read.
TEST(ParticleSnapshots, KilledRunLeavesReadableFiles) {
  TemporaryFolder folder;
  const HostParticles particles = some_particles(5000);
  const pid_t child = fork();
  if (child == 0) {
    ParticleSnapshots snapshots(folder.path(), {"id", "velocity"});
    for (int step = 0;; ++step) {
      snapshots.write(step, 0.1 * step, particles);
      usleep(5000);
    }
  }
  usleep(150000);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  const int named = count_of(core::read_file(folder / "particles.xdmf"), "<Time Value");
  EXPECT_GT(named, 3);
  const core::Hdf5File file(folder / "particles.h5", core::Hdf5File::Mode::read);
  for (int step = 0; step < named; ++step) {
    EXPECT_EQ(file.read<double>("step000000" +
                                std::string(step < 10    ? "000"
                                            : step < 100 ? "00"
                                                         : "0") +
                                std::to_string(step) + "/velocity")
                  .size(),
              15000u);
  }
}

// Parcels come and go: none at first, two, none again, and a run that resumes among those.
TEST(SpraySnapshots, AsManyRowsAsParcelsFly) {
  TemporaryFolder folder;
  HostParcels two;
  two.state.push_back({{0.1, 0.2, 0.3}, {3, 4, 0}, 30e-6, 10});
  two.state.push_back({{0.4, 0.5, 0.6}, {0, 0, -2}, 40e-6, 20.5});
  two.name = {{7, 0, 0}, {3, 1, 0}};
  two.mass = {1e-9, 2e-9};
  two.liquid = {0.5e-9, 1.5e-9};
  two.temperature = {300, 310};
  const std::vector<std::string> fields{"id",       "nozzle", "velocity", "speed",      "diameter",
                                        "droplets", "mass",   "liquid",   "temperature"};
  {
    SpraySnapshots snapshots(folder.path(), fields);
    snapshots.write(0, 0, {});
  }
  EXPECT_EQ(count_of(core::read_file(folder / "spray.xdmf"), "NumberOfElements=\"1\""), 1);
  {
    SpraySnapshots snapshots(folder.path(), fields, 0);
    snapshots.write(10, 0.1, two);
    snapshots.write(20, 0.2, {});
  }
  const core::Hdf5File file(folder / "spray.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.members("/"),
            (std::vector<std::string>{"rows", "step0000000000", "step0000000010", "step0000000020"}));
  EXPECT_EQ(file.shape("step0000000000/position"), (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(file.shape("step0000000020/mass"), (std::vector<std::size_t>{0}));
  const std::string group = "step0000000010/";
  EXPECT_EQ(file.attribute_double("step0000000010", "time"), 0.1);
  EXPECT_EQ(file.read<double>(group + "position"), (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}));
  EXPECT_EQ(file.read<double>(group + "velocity"), (std::vector<double>{3, 4, 0, 0, 0, -2}));
  EXPECT_EQ(file.read<double>(group + "speed"), (std::vector<double>{5, 2}));
  EXPECT_EQ(file.read<std::int32_t>(group + "id"), (std::vector<std::int32_t>{7, 3}));
  EXPECT_EQ(file.read<std::int32_t>(group + "nozzle"), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(file.read<double>(group + "diameter"), (std::vector<double>{30e-6, 40e-6}));
  EXPECT_EQ(file.read<double>(group + "droplets"), (std::vector<double>{10, 20.5}));
  EXPECT_EQ(file.read<double>(group + "mass"), (std::vector<double>{1e-9, 2e-9}));
  EXPECT_EQ(file.read<double>(group + "liquid"), (std::vector<double>{0.5e-9, 1.5e-9}));
  EXPECT_EQ(file.read<double>(group + "temperature"), (std::vector<double>{300, 310}));
  const std::string xdmf = core::read_file(folder / "spray.xdmf");
  EXPECT_EQ(count_of(xdmf, "NumberOfElements=\"2\""), 1);
  EXPECT_EQ(count_of(xdmf, "spray.h5:/step0000000010/mass"), 1);
  EXPECT_EQ(count_of(xdmf, "step0000000020/mass"), 0);  // readers refuse a grid of nothing
}

TEST(GasSnapshots, CellsInXdmfOrder) {
  TemporaryFolder folder;
  const CartesianGrid grid(
      std::array<std::vector<Real>, 3>{std::vector<Real>{0, 1, 3}, {0, 0.5}, {0, 0.1, 0.3, 0.7}});
  HostArray<Vec3> velocity("test::velocity", 6);
  HostArray<Real> pressure("test::pressure", 6), void_fraction("test::void_fraction", 6);
  for (Index c = 0; c < 6; ++c) {
    velocity(c) = {1.0 * c, 2.0 * c, 3.0 * c};
    pressure(c) = 10.0 * c;
    void_fraction(c) = 0.1 * c;
  }
  GasFields gas;
  gas.grid = &grid;
  gas.velocity = velocity;
  gas.pressure = pressure;
  gas.void_fraction = void_fraction;
  GasSnapshots snapshots(folder.path(), {"velocity", "pressure", "solids_fraction"}, grid);
  snapshots.write(10, 0.5, gas);
  const core::Hdf5File file(folder / "gas.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.read<double>("grid/z"), (std::vector<double>{0, 0.1, 0.3, 0.7}));
  EXPECT_EQ(file.shape("step0000000010/velocity"), (std::vector<std::size_t>{3, 1, 2, 3}));
  EXPECT_EQ(file.read<double>("step0000000010/velocity")[3 * 5 + 1], 10.0);
  EXPECT_EQ(file.shape("step0000000010/pressure"), (std::vector<std::size_t>{3, 1, 2}));
  EXPECT_EQ(file.read<double>("step0000000010/solids_fraction")[2], 1 - 0.1 * 2);
  const std::string xdmf = core::read_file(folder / "gas.xdmf");
  EXPECT_EQ(count_of(xdmf, "TopologyType=\"3DRectMesh\" Dimensions=\"4 2 3\""), 1);
  EXPECT_EQ(count_of(xdmf, "gas.h5:/grid/x"), 1);
}
