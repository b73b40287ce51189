#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "core/files.hpp"
#include "core/hdf5_file.hpp"
#include "core/views.hpp"
#include "tests/core/temporary_folder.hpp"

using namespace pellicle;
using namespace pellicle::core;
using pellicle::tests::TemporaryFolder;

namespace {

template <class Error, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

struct Packed {
  double a;
  std::int32_t b, c;
};

}  // namespace

TEST(Checkpoint, EveryBitComesBack) {
  TemporaryFolder folder;
  const double least = std::numeric_limits<double>::denorm_min();
  const std::vector<double> doubles{0.1, -0.0, least, 1e308, 1.0 / 3, std::nextafter(1.0, 2.0)};
  const std::vector<std::int32_t> small{-1, 0, 2147483647};
  const std::vector<std::int64_t> large{std::int64_t{1} << 60, -5};
  const std::vector<Vec3> vectors{{1, 2, 3}, {0.1, 0.2, 0.3}};
  const std::vector<Packed> packed{{1.5, 2, 3}, {-1.5, -2, -3}};
  HostArray<Real> view("test::checkpoint::view", 3);
  for (int i = 0; i < 3; ++i) view(i) = 0.7 * i;
  {
    CheckpointWriter out(folder / "checkpoint.h5");
    out.write("a/b/doubles", doubles);
    out.write("a/small", small);
    out.write("a/large", large);
    out.write("vectors", vectors);
    out.write("packed", packed);
    out.write("view", view);
    out.write("one", 0.3);
    out.write("count", std::int64_t{1} << 40);
    out.write("steps", 17);
    out.write("vector", Vec3{7, 8, 9});
    out.write("text", "a: 1\nb: \"two\"\n");
    out.write("empty_text", "");
    out.write("none", std::vector<double>{});
    out.close();
  }
  const CheckpointReader in(folder / "checkpoint.h5");
  const auto back = in.read_doubles("a/b/doubles");
  ASSERT_EQ(back.size(), doubles.size());
  for (std::size_t i = 0; i < doubles.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back[i]), std::bit_cast<std::uint64_t>(doubles[i]));
  }
  EXPECT_EQ(in.read_int32s("a/small"), small);
  EXPECT_EQ(in.read_int64s("a/large"), large);
  EXPECT_EQ(in.read_vec3s("vectors"), vectors);
  std::vector<Packed> packed_back(2);
  in.read_into("packed", packed_back);
  EXPECT_EQ(packed_back[1].a, -1.5);
  EXPECT_EQ(packed_back[1].c, -3);
  HostArray<Real> view_back("test::checkpoint::view_back", 3);
  in.read_into("view", view_back);
  EXPECT_EQ(view_back(2), 0.7 * 2);
  EXPECT_EQ(in.read_double("one"), 0.3);
  EXPECT_EQ(in.read_int64("count"), std::int64_t{1} << 40);
  EXPECT_EQ(in.read_int64("steps"), 17);
  EXPECT_EQ(in.read_vec3("vector"), (Vec3{7, 8, 9}));
  EXPECT_EQ(in.read_string("text"), "a: 1\nb: \"two\"\n");
  EXPECT_EQ(in.read_string("empty_text"), "");
  EXPECT_TRUE(in.read_doubles("none").empty());
  EXPECT_TRUE(in.has("a/b/doubles"));
  EXPECT_FALSE(in.has("a/b/c/d"));
}

TEST(Checkpoint, WrongNameOrSizeIsNamed) {
  TemporaryFolder folder;
  CheckpointWriter out(folder / "checkpoint.h5");
  out.write("gas/pressure", std::vector<double>(4));
  out.close();
  const CheckpointReader in(folder / "checkpoint.h5");
  EXPECT_NE(message_of<RunError>([&] { in.read_doubles("gas/velocity"); }).find("gas/velocity"),
            std::string::npos);
  std::vector<double> other(5);
  EXPECT_NE(message_of<RunError>([&] { in.read_into("gas/pressure", other); }).find("32 bytes"),
            std::string::npos);
}

TEST(Checkpoint, UnfinishedOneLeavesTheOldOne) {
  TemporaryFolder folder;
  const auto path = folder / "checkpoint.h5";
  {
    CheckpointWriter out(path);
    out.write("step", 1);
    out.close();
  }
  {
    CheckpointWriter out(path);
    out.write("step", 2);  // never closed: as if an exception had passed
  }
  EXPECT_EQ(CheckpointReader(path).read_int64("step"), 1);
  EXPECT_FALSE(std::filesystem::exists(temporary_name(path)));
}

// A child writes checkpoints in a loop and is killed at arbitrary moments: what is on disk is always complete.
TEST(Checkpoint, SurvivesKill) {
  TemporaryFolder folder;
  const auto path = folder / "checkpoint.h5";
  for (int round = 0; round < 10; ++round) {
    const pid_t child = fork();
    if (child == 0) {
      for (std::int64_t step = 0;; ++step) {
        CheckpointWriter out(path);
        out.write("begin", step);
        out.write("field", std::vector<double>(20000, static_cast<double>(step)));
        out.write("end", step);
        out.close();
      }
    }
    usleep(static_cast<useconds_t>(30000 + 3700 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    if (!std::filesystem::exists(path)) continue;  // killed before the first was complete
    const CheckpointReader in(path);
    EXPECT_EQ(in.read_int64("begin"), in.read_int64("end"));
    EXPECT_EQ(in.read_doubles("field").at(19999), static_cast<double>(in.read_int64("begin")));
  }
  EXPECT_TRUE(std::filesystem::exists(path)) << "the child never finished a checkpoint";
}

// A limit on the file size stands for a full disk: the system refuses to write in the same way.
TEST(Checkpoint, FullDiskIsReportedAndOldOneStays) {
  TemporaryFolder folder;
  const auto path = folder / "checkpoint.h5";
  {
    CheckpointWriter out(path);
    out.write("step", 1);
    out.close();
  }
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100000, 100000};
    setrlimit(RLIMIT_FSIZE, &limit);
    int code = 1;
    try {
      CheckpointWriter out(path);
      out.write("step", 2);
      out.write("field", std::vector<double>(1000000, 1.0));
      out.close();
    } catch (const RunError& error) {
      const std::string text = error.what();
      code = text.find("checkpoint.h5") != std::string::npos && text.find("too large") != std::string::npos
                 ? 0
                 : 2;
      if (code != 0) write_file_atomically(folder / "message", text);
    }
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << (std::filesystem::exists(folder / "message")
                                            ? read_file(folder / "message")
                                            : "nothing was thrown");
  EXPECT_EQ(CheckpointReader(path).read_int64("step"), 1);
}

TEST(Checkpoint, ForeignFilesAreRefused) {
  TemporaryFolder folder;
  EXPECT_NE(message_of<InputError>([&] { CheckpointReader in(folder / "none.h5"); }).find("no checkpoint"),
            std::string::npos);
  std::ofstream(folder / "text.h5") << "hello";
  EXPECT_NE(message_of<InputError>([&] { CheckpointReader in(folder / "text.h5"); }).find("not a checkpoint"),
            std::string::npos);
  {
    Hdf5File other(folder / "old.h5", Hdf5File::Mode::create);
    other.write_number("checkpoint/format", std::int64_t{99});
    other.write_text("checkpoint/program", "9.9");
    other.close();
  }
  EXPECT_NE(message_of<InputError>([&] { CheckpointReader in(folder / "old.h5"); }).find("format 99"),
            std::string::npos);
}

TEST(Checkpoint, SameCaseOnly) {
  const std::string then =
      "title: a\ntime: {end: 1, gas_step: 1e-4}\nlist: [1, 2]\noutput: {checkpoint: {every: 1}}\n";
  EXPECT_NO_THROW(require_same_case(then, then));
  EXPECT_NO_THROW(require_same_case(
      then, "title: b\ntime: {end: 2, gas_step: 1e-4}\nlist: [1, 2]\noutput: {lines: [{name: x}]}\n"));
  const std::string text = message_of<InputError>(
      [&] { require_same_case(then, "title: a\ntime: {end: 1, gas_step: 2e-4}\nlist: [1, 3]\nextra: 5\n"); });
  EXPECT_NE(text.find("time.gas_step: 1e-4 in the checkpoint, 2e-4 now"), std::string::npos) << text;
  EXPECT_NE(text.find("list.1: 2 in the checkpoint, 3 now"), std::string::npos) << text;
  EXPECT_NE(text.find("extra: absent in the checkpoint, 5 now"), std::string::npos) << text;
  EXPECT_EQ(text.find("output"), text.find("output may change")) << text;
}

TEST(Hdf5File, AppendShapeMembersRemove) {
  TemporaryFolder folder;
  const auto path = folder / "series.h5";
  const std::vector<double> values{1, 2, 3, 4, 5, 6};
  {
    Hdf5File file(path, Hdf5File::Mode::append);
    file.write("step1/field", std::span<const double>(values), std::array<std::size_t, 2>{2, 3});
    file.set_attribute("step1", "time", 0.5);
    file.set_attribute("step1", "step", std::int64_t{5});
    file.set_attribute("step1/field", "unit", "m/s");
    file.close();
  }
  {
    Hdf5File file(path, Hdf5File::Mode::append);
    file.write("step2/field", std::span<const double>(values));
    file.remove("step1/field");
    EXPECT_THROW(file.write("step2/field", std::span<const double>(values)), RunError);
    file.close();
  }
  const Hdf5File file(path, Hdf5File::Mode::read);
  EXPECT_EQ(file.members("/"), (std::vector<std::string>{"step1", "step2"}));
  EXPECT_TRUE(file.members("step1").empty());
  EXPECT_EQ(file.shape("step2/field"), std::vector<std::size_t>{6});
  EXPECT_EQ(file.attribute_double("step1", "time"), 0.5);
  EXPECT_EQ(file.attribute_int64("step1", "step"), 5);
  EXPECT_THROW(file.read<double>("step1/field"), RunError);
}
