#include <gtest/gtest.h>

#include "core/checkpoint.hpp"
#include "core/ledger.hpp"
#include "core/timers.hpp"
#include "tests/core/temporary_folder.hpp"

using namespace pellicle;
using namespace pellicle::core;

TEST(Ledger, DefectByHand) {
  Ledger ledger;
  ledger.open(Conserved::gas_mass, 10.0);
  ledger.add_through_boundaries(Conserved::gas_mass, 3.0);
  ledger.add_through_boundaries(Conserved::gas_mass, -1.0);
  ledger.add_source(Conserved::gas_mass, 0.5);
  ledger.add_gross(Conserved::gas_mass, 3.0);
  ledger.add_gross(Conserved::gas_mass, -17.0);
  ledger.set_stock(Conserved::gas_mass, 12.7);
  // 12.7 - 10 - 2 - 0.5 = 0.2; the scale is 20, what was exchanged, since that is more than the 10 at the start.
  EXPECT_NEAR(ledger.defect(Conserved::gas_mass), 0.01, 1e-15);
  EXPECT_EQ(ledger.defect(Conserved::water), 0);
  EXPECT_FALSE(ledger.is_open(Conserved::water));
}

TEST(Ledger, MomentumIsAVector) {
  Ledger ledger;
  ledger.open(Conserved::momentum, Vec3{0, 0, 5});
  ledger.set_stock(Conserved::momentum, Vec3{3, 4, 5});
  EXPECT_NEAR(ledger.defect(Conserved::momentum), 1.0, 1e-15);
  ledger.set_totals(Conserved::momentum, Vec3{3, 0, 0}, Vec3{0, 4, 0}, 2);
  EXPECT_EQ(ledger.defect(Conserved::momentum), 0);
}

// A million terms of 0.1 miss 1e5 by 1.3e-6 in a plain sum; the sum with the lost parts kept is right to round-off.
TEST(Ledger, LongSumsLoseNothing) {
  Ledger ledger;
  ledger.open(Conserved::solids, 0.0);
  for (int i = 0; i < 1000000; ++i) {
    ledger.add_through_boundaries(Conserved::solids, 0.1);
    ledger.add_gross(Conserved::solids, 0.1);
  }
  ledger.set_stock(Conserved::solids, 100000.0);
  EXPECT_LT(ledger.defect(Conserved::solids), 1e-15);
}

TEST(Ledger, Restart) {
  pellicle::tests::TemporaryFolder folder;
  Ledger ledger;
  ledger.open(Conserved::momentum, Vec3{1, 2, 3});
  for (int i = 0; i < 1000; ++i) ledger.add_source(Conserved::momentum, Vec3{0.1, 0.2, 1e-9 * i});
  ledger.add_gross(Conserved::momentum, 7);
  CheckpointWriter out(folder / "c.h5");
  ledger.save(out);
  out.close();
  Ledger again;
  again.load(CheckpointReader(folder / "c.h5"));
  EXPECT_FALSE(again.is_open(Conserved::energy));
  for (Ledger* l : {&ledger, &again}) {
    l->add_source(Conserved::momentum, Vec3{0.3, 0, 0});
    l->set_stock(Conserved::momentum, Vec3{});
  }
  EXPECT_EQ(ledger.defect(Conserved::momentum), again.defect(Conserved::momentum));
  EXPECT_GT(ledger.defect(Conserved::momentum), 1.0);
}

TEST(Timers, InnerTimeIsNotCountedTwice) {
  Timers timers;
  const double begin = wall_clock();
  {
    const Timers::Scope outer(timers, Part::gas);
    const double inner_begin = wall_clock();
    {
      const Timers::Scope inner(timers, Part::output);
      while (wall_clock() - inner_begin < 0.02) {
      }
    }
    const double rest = wall_clock();
    while (wall_clock() - rest < 0.005) {
    }
  }
  const double all = wall_clock() - begin;
  EXPECT_GE(timers.seconds(Part::output), 0.02);
  EXPECT_GE(timers.seconds(Part::gas), 0.005);
  EXPECT_LE(timers.total(), all);
  // The gas's own part is what is left: had the inner time been counted twice, the total would exceed `all`.
  EXPECT_LE(timers.seconds(Part::gas), all - timers.seconds(Part::output));
  EXPECT_EQ(timers.seconds(Part::contacts), 0);
}
