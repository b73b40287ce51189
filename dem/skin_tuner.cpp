#include "dem/skin_tuner.hpp"

#include <algorithm>
#include <cmath>

namespace pellicle::dem {
namespace {

/// Shares from 0.4 down to 0.025, each 1/√2 of the one before.
constexpr Real largest_share = 0.4;
constexpr std::int64_t last_rung = 8;

/// What a build costs, in entries a particle that are looked at in a substep: the value with which a bed of 50,000
/// particles in motion ran quickest (docs/performance.md); the times of the parts, 170 to 230 ns and 1.4 to 4 ns, leave
/// it open.
constexpr Real build_cost = 40;

/// A period ends with so many builds, or steps where hardly any are needed.
constexpr std::int64_t period_builds = 4;
constexpr std::int64_t period_steps = 400;

/// Periods without a trial once the rungs beside home are known to be worse.
constexpr std::int64_t long_rest = 16;

/// Less of a gain may be chance.
constexpr Real least_gain = 0.01;

}  // namespace

SkinTuner::SkinTuner(Real fraction) {
  state.rung = std::clamp<std::int64_t>(std::llround(2 * std::log2(largest_share / fraction)), 0, last_rung);
}

Real SkinTuner::fraction() const { return largest_share * std::exp2(-0.5 * static_cast<Real>(state.rung)); }

bool SkinTuner::note_step(Real entries_per_particle, bool outdated) {
  ++state.steps;
  state.entries += entries_per_particle;
  if (outdated) ++state.builds;
  if (state.builds < period_builds && state.steps < period_steps) return false;
  const Real cost =
      (state.entries + build_cost * static_cast<Real>(state.builds)) / static_cast<Real>(state.steps);
  state.steps = state.builds = 0;
  state.entries = 0;
  const std::int64_t rung = state.rung;
  compare(cost);
  return state.rung != rung;
}

void SkinTuner::compare(Real cost) {
  if (state.rest > 0) {
    state.home_cost = cost;
    if (--state.rest == 0) begin_trial();
    return;
  }
  if (state.home_cost < 0 || cost < (1 - least_gain) * state.home_cost) {
    state.worse = state.home_cost < 0 ? 0 : 1;
    state.home_cost = cost;
  } else {
    state.rung -= state.direction;
    state.direction = -state.direction;
    ++state.worse;
  }
  begin_trial();
}

void SkinTuner::begin_trial() {
  const std::int64_t next = state.rung + state.direction;
  if (state.worse < 2 && next >= 0 && next <= last_rung) {
    state.rung = next;
    return;
  }
  if (state.worse < 2) state.direction = -state.direction;
  state.worse = 0;
  state.rest = long_rest;
}

}  // namespace pellicle::dem
