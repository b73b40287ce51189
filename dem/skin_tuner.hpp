// How far particles may move between two builds of the neighbour lists, chosen while the run goes on.
#pragma once

#include <cstdint>

#include "core/types.hpp"

namespace pellicle::dem {

/// Looks for the least allowance (a share of the smallest radius) that costs least. A small one gives short lists that are
/// built often, a large one long lists that are built seldom; which is better depends on how the particles move. The cost
/// is counted, not timed, so that it is the same in every run: list entries looked at in every substep, and builds.
///
/// The shares form a ladder. A rung is kept for a period, then the next one is tried; one that is better becomes the new
/// home, and when both beside it were worse it stays home for longer.
class SkinTuner {
 public:
  /// All that it knows; a checkpoint keeps it.
  struct State {
    std::int64_t rung = 0;       ///< in use; the higher the smaller the share
    std::int64_t direction = 1;  ///< of the present or next trial
    std::int64_t worse = 0;      ///< rungs beside home that are known to be worse
    std::int64_t rest = 0;       ///< periods until the next trial
    std::int64_t steps = 0;      ///< of the present period
    std::int64_t builds = 0;     ///< in it that were due because somebody had moved too far
    Real entries = 0;            ///< that a particle had in its row, summed over its steps
    Real home_cost = -1;         ///< in entries a particle and substep; negative before the first period
  };

  /// Begins at the rung next to this share.
  explicit SkinTuner(Real fraction = 0.1);

  /// The share of the smallest radius that lists are to be built with.
  Real fraction() const;

  /// Tells of a substep: the entries that a particle had on average in its row, and whether somebody has moved so far
  /// that a build is due. True if lists are to be built with another share from now on.
  bool note_step(Real entries_per_particle, bool outdated);

  State state;

 private:
  void compare(Real cost);
  void begin_trial();
};

}  // namespace pellicle::dem
