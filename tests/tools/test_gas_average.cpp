#include <gtest/gtest.h>

#include <cmath>

#include "core/checkpoint.hpp"
#include "core/files.hpp"
#include "core/hdf5_file.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tools/pellicle/gas_average.hpp"

using namespace pellicle;
using namespace pellicle::tools;
using pellicle::tests::TemporaryFolder;

namespace {

constexpr Index cells = 24;

/// Fields of 2 x 3 x 4 cells that change from step to step, each cell in its own way.
struct Gas {
  CartesianGrid grid{Box{{0, 0, 0}, {0.2, 0.3, 0.4}}, {2, 3, 4}};
  HostArray<Vec3> velocity{"test::velocity", cells};
  HostArray<Real> pressure{"test::pressure", cells};
  HostArray<Real> void_fraction{"test::void_fraction", cells};
  GasFields fields;
  Gas() {
    fields.grid = &grid;
    fields.velocity = velocity;
    fields.pressure = pressure;
    fields.void_fraction = void_fraction;
  }
  static Real at(int step, Index number) {
    return 0.3 * number + std::sin(0.01 * step * step + number) * (1 + 0.1 * number);
  }
  void set(int step) {
    for (Index c = 0; c < cells; ++c) {
      velocity(c) = {at(step, 3 * c), at(step, 3 * c + 1), at(step, 3 * c + 2)};
      pressure(c) = 101325 + 1e-4 * at(step, c);
      void_fraction(c) = 0.4;
    }
  }
};

GasAverageSpec averaged(std::vector<std::string> fields, WindowSpec window = {0, 1}) {
  return {window, std::move(fields)};
}

void march(GasAverage& average, int from, int to) {
  Gas gas;
  for (int step = from; step <= to; ++step) {
    gas.set(step);
    average.sample(step, gas.fields);
  }
}

std::vector<std::byte> state_of(const GasAverage& average, const TemporaryFolder& folder) {
  core::CheckpointWriter out(folder / "state.h5");
  average.save(out);
  out.close();
  const core::CheckpointReader in(folder / "state.h5");
  std::vector<std::byte> all;
  for (const char* what : {"velocity/mean", "velocity/squares", "pressure/mean", "pressure/squares"}) {
    const auto values = in.read_doubles(std::string("output/average/") + what);
    const auto bytes = std::as_bytes(std::span(values));
    all.insert(all.end(), bytes.begin(), bytes.end());
  }
  return all;
}

}  // namespace

// Against two passes in long double over the same steps, number by number.
TEST(GasAverage, MeanAndRmsOfEachCell) {
  TemporaryFolder folder;
  core::TimeControl time(1, 1e-3, 1e-3);
  const Gas gas;
  GasAverage average(averaged({"velocity", "pressure"}, {0.1, 0.6}), time, gas.grid);
  march(average, 0, 1000);
  average.write(folder.path());
  const core::Hdf5File file(folder / "gas_average.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.members("/"), (std::vector<std::string>{"average", "grid"}));
  EXPECT_EQ(file.members("average"),
            (std::vector<std::string>{"pressure_mean", "pressure_rms", "velocity_mean", "velocity_rms"}));
  EXPECT_EQ(file.shape("average/velocity_rms"), (std::vector<std::size_t>{4, 3, 2, 3}));
  EXPECT_EQ(file.shape("average/pressure_mean"), (std::vector<std::size_t>{4, 3, 2}));
  EXPECT_EQ(file.attribute_int64("average", "step"), 600);
  EXPECT_DOUBLE_EQ(file.attribute_double("average", "time"), 0.6);
  EXPECT_DOUBLE_EQ(file.attribute_double("average", "from"), 0.1);
  EXPECT_EQ(file.attribute_int64("average/velocity_mean", "samples"), 500);
  const auto check = [&](const std::string& name, Index numbers, const auto& value, Real tolerance) {
    const auto mean = file.read<double>("average/" + name + "_mean");
    const auto rms = file.read<double>("average/" + name + "_rms");
    for (Index n = 0; n < numbers; ++n) {
      long double sum = 0, squares = 0;
      for (int step = 101; step <= 600; ++step) sum += value(step, n);
      for (int step = 101; step <= 600; ++step)
        squares += (value(step, n) - sum / 500) * (value(step, n) - sum / 500);
      EXPECT_NEAR(mean[static_cast<std::size_t>(n)], static_cast<Real>(sum / 500), tolerance) << name << n;
      EXPECT_NEAR(rms[static_cast<std::size_t>(n)], static_cast<Real>(std::sqrt(squares / 500)), tolerance)
          << name << n;
    }
  };
  // Numbers of about 20, rounded to 4e-15 in each of 500 updates.
  check("velocity", 3 * cells, Gas::at, 1e-13);
  // A pressure is rounded to 1.5e-11 Pa, by chance up or down in each of 500 updates: 1.6e-10 Pa. A fluctuation of 1e-4 Pa
  // keeps five digits, of which squares of pressures would leave none.
  check(
      "pressure", cells, [](int step, Index n) { return 101325 + 1e-4 * Gas::at(step, n); }, 6e-10);
}

TEST(GasAverage, AConstantFieldHasNoFluctuation) {
  TemporaryFolder folder;
  core::TimeControl time(1, 1e-3, 1e-3);
  Gas gas;
  GasAverage average(averaged({"void_fraction", "solids_fraction"}), time, gas.grid);
  march(average, 1, 300);
  average.write(folder.path());
  const core::Hdf5File file(folder / "gas_average.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.read<double>("average/void_fraction_mean"), std::vector<double>(cells, 0.4));
  EXPECT_EQ(file.read<double>("average/solids_fraction_mean"), std::vector<double>(cells, 1 - 0.4));
  EXPECT_EQ(file.read<double>("average/void_fraction_rms"), std::vector<double>(cells, 0));
  // Without particles there is no field of it: gas everywhere.
  TemporaryFolder other;
  gas.fields.void_fraction = {};
  GasAverage alone(averaged({"void_fraction"}), time, gas.grid);
  alone.sample(1, gas.fields);
  alone.write(other.path());
  EXPECT_EQ(core::Hdf5File(other / "gas_average.h5", core::Hdf5File::Mode::read)
                .read<double>("average/void_fraction_mean"),
            std::vector<double>(cells, 1));
}

TEST(GasAverage, NoFileBeforeTheFirstSample) {
  TemporaryFolder folder;
  core::TimeControl time(1, 1e-3, 1e-3);
  const Gas gas;
  GasAverage average(averaged({"pressure"}, {0.1, 1}), time, gas.grid);
  march(average, 0, 100);
  average.write(folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "gas_average.h5"));
  march(average, 101, 101);
  average.write(folder.path());
  march(average, 102, 110);
  average.write(folder.path());  // in place of the first
  const core::Hdf5File file(folder / "gas_average.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.attribute_int64("average/pressure_mean", "samples"), 10);
  const std::string xdmf = core::read_file(folder / "gas_average.xdmf");
  EXPECT_NE(xdmf.find("<Time Value=\"0.11\"/>"), std::string::npos) << xdmf;
  EXPECT_NE(xdmf.find("gas_average.h5:/average/pressure_rms"), std::string::npos) << xdmf;
  EXPECT_NE(xdmf.find("3DRectMesh\" Dimensions=\"5 4 3\""), std::string::npos) << xdmf;
}

TEST(GasAverage, RestartGoesOnToTheLastBit) {
  TemporaryFolder folder;
  core::TimeControl time(1, 1e-3, 1e-3);
  const Gas gas;
  const GasAverageSpec spec = averaged({"velocity", "pressure"}, {0.05, 1});
  GasAverage whole(spec, time, gas.grid), first(spec, time, gas.grid), second(spec, time, gas.grid);
  march(whole, 0, 400);
  march(first, 0, 123);
  core::CheckpointWriter out(folder / "c.h5");
  first.save(out);
  out.close();
  second.load(core::CheckpointReader(folder / "c.h5"));
  march(second, 124, 400);
  EXPECT_EQ(state_of(second, folder), state_of(whole, folder));

  // One more field begins by itself; a window that begins elsewhere is another average.
  GasAverage more(averaged({"pressure", "void_fraction"}, {0.05, 1}), time, gas.grid);
  more.load(core::CheckpointReader(folder / "c.h5"));
  march(more, 124, 130);
  more.write(folder.path());
  {
    const core::Hdf5File file(folder / "gas_average.h5", core::Hdf5File::Mode::read);
    EXPECT_EQ(file.attribute_int64("average/pressure_mean", "samples"), 80);
    EXPECT_EQ(file.attribute_int64("average/void_fraction_mean", "samples"), 7);
  }
  GasAverage later(averaged({"pressure"}, {0.1, 1}), time, gas.grid);
  later.load(core::CheckpointReader(folder / "c.h5"));
  march(later, 124, 130);
  later.write(folder.path());
  const core::Hdf5File file(folder / "gas_average.h5", core::Hdf5File::Mode::read);
  EXPECT_EQ(file.attribute_int64("average/pressure_mean", "samples"), 7);
}
