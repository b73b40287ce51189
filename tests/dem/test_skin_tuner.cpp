// The search for the allowance that costs least, on models of how long lists last and how long they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "dem/skin_tuner.hpp"

namespace pellicle::dem {
namespace {

/// Lists of 4 + slope × share entries that last `lifetime` × share substeps.
struct Model {
  Real slope, lifetime;

  Real entries(Real share) const { return 4 + slope * share; }
  Real cost(Real share) const { return entries(share) + 40 / std::max(1.0, lifetime * share); }
};

/// The shares in use over a run.
std::vector<Real> run(const Model& model, int steps, SkinTuner& tuner) {
  std::vector<Real> shares;
  Real age = 0;
  for (int k = 0; k < steps; ++k) {
    shares.push_back(tuner.fraction());
    const bool outdated = ++age >= model.lifetime * tuner.fraction();
    const bool changed = tuner.note_step(model.entries(tuner.fraction()), outdated);
    if (outdated || changed) age = 0;
  }
  return shares;
}

TEST(SkinTuner, FindsTheBestShareWhereverItIs) {
  for (const Model& model : {Model{10, 150}, Model{10, 3000}, Model{40, 100}, Model{2, 100}}) {
    for (const Real start : {0.025, 0.1, 0.4}) {
      SkinTuner tuner(start);
      const auto shares = run(model, 40000, tuner);
      Real best = 1e9;
      for (int rung = 0; rung <= 8; ++rung)
        best = std::min(best, model.cost(0.4 * std::pow(0.5, 0.5 * rung)));
      Real cost = 0;
      for (std::size_t k = 10000; k < shares.size(); ++k) cost += model.cost(shares[k]) / 30000;
      EXPECT_LT(cost, 1.05 * best) << model.slope << ' ' << model.lifetime << ' ' << start;
    }
  }
}

TEST(SkinTuner, MakesListsShortWhereNothingMoves) {
  SkinTuner tuner(0.1);
  const auto shares = run({10, 1e9}, 4000, tuner);
  EXPECT_NEAR(shares.back(), 0.025, 1e-12);
}

TEST(SkinTuner, FollowsAChange) {
  SkinTuner tuner(0.1);
  run({10, 1e9}, 20000, tuner);
  run({10, 150}, 4000, tuner);
  EXPECT_GT(tuner.fraction(), 0.1);
}

TEST(SkinTuner, GoesOnFromItsState) {
  SkinTuner straight(0.1);
  run({10, 150}, 1000, straight);
  SkinTuner resumed(0.1);
  resumed.state = straight.state;
  EXPECT_EQ(run({10, 150}, 1000, straight), run({10, 150}, 1000, resumed));
}

}  // namespace
}  // namespace pellicle::dem
