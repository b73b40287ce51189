#include <gtest/gtest.h>

#include <limits>

#include "core/checkpoint.hpp"
#include "core/time_control.hpp"
#include "tests/core/temporary_folder.hpp"

using namespace pellicle;
using namespace pellicle::core;

TEST(ChooseParts, DivideTheParticleSteps) {
  // Divisors of 12: 1, 2, 3, 4, 6, 12.
  EXPECT_EQ(choose_parts(0.3, 12), 1);
  EXPECT_EQ(choose_parts(1, 12), 1);
  EXPECT_EQ(choose_parts(1.01, 12), 2);
  EXPECT_EQ(choose_parts(3, 12), 3);
  EXPECT_EQ(choose_parts(3 * (1 + 1e-14), 12), 3);
  EXPECT_EQ(choose_parts(4.5, 12), 6);
  EXPECT_EQ(choose_parts(7, 12), 12);
  EXPECT_EQ(choose_parts(50, 12), 12);  // no particle step is divided
  EXPECT_EQ(choose_parts(2, 7), 7);
  // Without particles any number.
  EXPECT_EQ(choose_parts(4.5, 0), 5);
  EXPECT_EQ(choose_parts(1e9, 0), 1000);
  EXPECT_EQ(choose_parts(std::numeric_limits<Real>::quiet_NaN(), 0), 1);
}

TEST(TimeControl, WholeMultiples) {
  EXPECT_EQ(whole_multiple(1e-4, 1e-5), 10);
  EXPECT_EQ(whole_multiple(0.3, 0.1), 3);  // 0.3 / 0.1 is 2.9999999999999996
  EXPECT_EQ(whole_multiple(4, 1e-4), 40000);
  EXPECT_FALSE(whole_multiple(1e-4, 3e-5));
  EXPECT_FALSE(whole_multiple(1e-5, 1e-4));
  EXPECT_FALSE(whole_multiple(0, 1e-4));
}

TEST(TimeControl, TimeIsAProductNotASum) {
  TimeControl time(1, 1e-4, 1e-5);
  EXPECT_EQ(time.substeps(), 10);
  int steps = 0;
  while (!time.finished()) {
    time.advance();
    ++steps;
  }
  EXPECT_EQ(steps, 10000);
  EXPECT_EQ(time.time(), 10000 * 1e-4);
  EXPECT_TRUE(time.messages().empty());
}

TEST(TimeControl, Settling) {
  TimeControl time(1e-3, 1e-4, 1e-4, 3e-4);
  EXPECT_EQ(time.step(), -3);
  EXPECT_TRUE(time.settling());
  for (int i = 0; i < 3; ++i) time.advance();
  EXPECT_FALSE(time.settling());
  EXPECT_EQ(time.time(), 0);
  const Schedule schedule = time.schedule(2e-4, "x");
  EXPECT_FALSE(schedule.due(-2));
  EXPECT_TRUE(schedule.due(0));
}

TEST(TimeControl, SchedulesHitWholeSteps) {
  TimeControl time(1, 1e-4, 1e-5);
  const Schedule schedule = time.schedule(0.05, "output.snapshots.every");
  EXPECT_EQ(schedule.steps, 500);
  EXPECT_TRUE(schedule.due(0) && schedule.due(500) && schedule.due(10000));
  EXPECT_FALSE(schedule.due(499) || schedule.due(501));
  EXPECT_TRUE(time.messages().empty());

  EXPECT_EQ(time.schedule(2.7e-4, "output.checkpoint.every").steps, 3);
  ASSERT_EQ(time.messages().size(), 1u);
  EXPECT_EQ(
      time.messages()[0],
      "output.checkpoint.every = 0.00027 s is not a whole number of gas steps of 0.0001 s: 0.0003 s is used");
  EXPECT_EQ(time.schedule(1e-6, "x").steps, 1);
  EXPECT_EQ(time.messages().size(), 2u);
  EXPECT_FALSE(time.schedule(0, "x").due(0));
}

TEST(TimeControl, WindowsHoldTheirLengthInSamples) {
  TimeControl time(4, 1e-4, 1e-5);
  const StepWindow window = time.window(0.5, 4, "average");
  int samples = 0;
  for (std::int64_t step = 0; step <= time.end_step(); ++step) samples += window.contains(step);
  EXPECT_EQ(samples, 35000);
  EXPECT_FALSE(window.contains(5000));
  EXPECT_TRUE(window.contains(5001) && window.contains(40000));
  EXPECT_EQ(time.window(0, 1e30, "average").to, 40000);
}

TEST(TimeControl, EndsAreRounded) {
  TimeControl time(1.00003, 1e-4, 1e-4);
  EXPECT_EQ(time.end_step(), 10000);
  EXPECT_EQ(time.messages().size(), 1u);
  time.end_at(0.5);
  EXPECT_EQ(time.end_step(), 5000);
  time.end_at(2);
  EXPECT_EQ(time.end_step(), 5000);
}

TEST(TimeControl, RefusesImpossibleSteps) {
  EXPECT_THROW(TimeControl(1, 1e-4, 3e-5), std::invalid_argument);
  EXPECT_THROW(TimeControl(1, 0, 0), std::invalid_argument);
  EXPECT_THROW(TimeControl(-1, 1e-4, 1e-4), std::invalid_argument);
}

TEST(TimeControl, Restart) {
  pellicle::tests::TemporaryFolder folder;
  TimeControl time(1, 1e-4, 1e-5, 0.1);
  for (int i = 0; i < 1234; ++i) time.advance();
  CheckpointWriter out(folder / "c.h5");
  time.save(out);
  out.close();
  TimeControl again(2, 1e-4, 1e-5, 0.1);
  again.load(CheckpointReader(folder / "c.h5"));
  EXPECT_EQ(again.step(), 234);
  EXPECT_EQ(again.end_step(), 20000);
}
