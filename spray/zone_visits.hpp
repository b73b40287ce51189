// Which particles pass through a zone, when, and what they gain from one pass to the next.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"
#include "dem/companion.hpp"
#include "dem/particles.hpp"
#include "heat/surface_state.hpp"
#include "spray/zone_shape.hpp"

namespace pellicle::spray {

struct ZoneOptions {
  std::string name;
  ZoneShape shape;
  /// A particle that is away for less than this has not left [s].
  Real shortest_absence = 0;
  Real longest_time = 1;  ///< upper end of the histograms; what is longer is in one more bin [s]
  Index bins = 50;
  Index size_classes = 1;  ///< of equal width in radius
};

/// Of one particle. Times are -1 until there is one.
struct Visit {
  Real entered = -1;      ///< the last entry [s]
  Real left = -1;         ///< when it was last seen to leave [s]
  Real first_entry = -1;  ///< [s]
  Real residence = 0;     ///< in all visits that have ended [s]
  Real solids = 0;        ///< coating at the last entry [kg]
  std::int32_t entries = 0;
  std::int32_t inside = 0;
};

/// Sums over the cycles of one particle, from entry to entry; there are entries - 1, of together entered - first_entry.
struct Cycles {
  Real time_squared = 0;  ///< [s2]
  Real gain = 0;          ///< coating gained [kg]
  Real gain_squared = 0;  ///< [kg2]
  Real time_gain = 0;     ///< [s kg]
};

/// Sums over particles.
struct ZoneSums {
  Real particles = 0, inside = 0, entered = 0;  ///< entered: have entered at least once
  Real entries = 0, cycles = 0, visits = 0;     ///< visits: have ended
  Real residence = 0;                           ///< [s]
  Real cycle_time = 0, cycle_time_squared = 0;  ///< [s], [s2]
  Real gain = 0, gain_squared = 0, time_gain = 0;
  Real solids = 0, solids_squared = 0;  ///< coating now [kg], [kg2]

  KOKKOS_INLINE_FUNCTION ZoneSums& operator+=(const ZoneSums& b) {
    particles += b.particles;
    inside += b.inside;
    entered += b.entered;
    entries += b.entries;
    cycles += b.cycles;
    visits += b.visits;
    residence += b.residence;
    cycle_time += b.cycle_time;
    cycle_time_squared += b.cycle_time_squared;
    gain += b.gain;
    gain_squared += b.gain_squared;
    time_gain += b.time_gain;
    solids += b.solids;
    solids_squared += b.solids_squared;
    return *this;
  }
};

/// Particles whose id leaves the same rest are one group: the scatter between groups gives the error of a mean.
inline constexpr Index zone_groups = 16;

/// Distributions so far; the last bin holds what is longer than all others.
struct ZoneHistograms {
  std::vector<std::int64_t> cycle_time;  ///< of cycles that have ended
  std::vector<std::int64_t> open_cycle;  ///< since the last entry, of particles that have entered
  std::vector<std::int64_t> residence;   ///< of visits that have ended
};

/// Visits of all particles to one zone; follows them through memory (dem::Engine::attach). A particle that is in the zone
/// at the start has not entered it: its first entry is the first that was seen.
class ZoneVisits final : public dem::Companion {
 public:
  ZoneVisits(const ZoneOptions& options, const dem::Particles& particles);

  /// Looks where all particles are, at `time` [s]; `film` may be empty. To be called once an outer step.
  void update(Real time, const DeviceArray<heat::Film>& film);

  /// Entry group + zone_groups x class; the same for any number of threads. `time` is now [s].
  std::vector<ZoneSums> compute_sums(Real time, const DeviceArray<heat::Film>& film) const;
  /// Radius [m] between which the size classes lie, of the particles at the start.
  std::array<Real, 2> radii() const { return {smallest_radius_, largest_radius_}; }
  ZoneHistograms compute_histograms(Real time) const;
  /// When it was begun to watch [s].
  Real start() const { return start_; }
  const ZoneOptions& options() const { return options_; }

  void reset(Index count) override;
  void add(Index first, Index count) override;
  void reorder(const DeviceArray<std::int32_t>& order, Index before, Index count,
               const DeviceArray<Real>& scratch) override;
  void save(core::CheckpointWriter& file, Index count) const override;
  /// A zone that is new, or another one than the checkpoint's, begins now, with a warning.
  void load(const core::CheckpointReader& file, Index count) override;
  std::size_t bytes() const override { return visits_.bytes() + cycles_.bytes(); }

 private:
  void find_radii();

  ZoneOptions options_;
  const dem::Particles& particles_;
  dem::FollowingArray<Visit> visits_;
  dem::FollowingArray<Cycles> cycles_;
  DeviceArray<std::int64_t> cycle_counts_, residence_counts_;
  Real smallest_radius_ = 0, largest_radius_ = 0;  // [m]; 0 until they are known
  Real start_ = 0;                                 // [s]
  bool started_ = false;
};

}  // namespace pellicle::spray
