// Particles that enter while a run goes on, through a region and at a rate.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/checkpoint.hpp"
#include "dem/engine.hpp"
#include "dem/fill.hpp"
#include "dem/obstacles.hpp"
#include "dem/size_distribution.hpp"

namespace pellicle::dem {

/// What a feed is made of. Spheres are wholly inside the region, except across a direction in which it is flat: there
/// their centres are on it.
struct FeedSetup {
  std::variant<Box, DiscRegion> region;
  Domain domain;
  Real from = 0, to = 0;  ///< when particles are due [s]
  Real rate = 0;          ///< [kg/s], or [1/s] if it counts
  bool by_count = false;
  Real density = 0;                               ///< [kg/m3]
  std::variant<Real, SizeDistribution> diameter;  ///< [m]
  ParticleSeed particle;                          ///< velocity, spin and material of each
  std::uint64_t seed = 0;                         ///< of the random numbers
  std::int64_t stream = 0;                        ///< which of the feeds with this seed
};

/// Decides who enters when and where. By the time t, the n-th particle is due when the sum over the first n of mass
/// (or number) is at most rate × (t − from). It enters at a random place where it touches no other and no wall; if none is
/// found it waits, and those after it, for the next outer step. Random numbers depend on seed, stream, outer step and number
/// of the particle alone.
class Feed {
 public:
  /// Throws std::invalid_argument for a distribution that makes no sense.
  explicit Feed(const FeedSetup& setup);

  /// Keeps particles clear of these walls. Of each closed mesh the side that most of the region is on is room.
  void keep_clear_of(const std::vector<Wall>& walls);
  /// The wall that is in the way of the largest particle in all places and at all times that were tried, or in most of them
  /// of several; none if one of them is free. Walls begin to move at t = 0.
  std::optional<std::int32_t> wall_without_room();

  /// Whether a particle is due at `time` [s].
  bool is_due(Real time) const;
  /// A box that holds every particle of this feed where it enters [m].
  Box reach() const;
  /// Those that enter at an outer step, among spheres that are near, `wall_time` seconds after walls began to move.
  std::vector<ParticleSeed> draw(Real time, std::int64_t step, const std::vector<PlacedSphere>& near,
                                 Real wall_time = -1);

  std::int64_t fed_particles() const { return fed_; }
  Real fed_mass() const { return mass_; }  ///< [kg]
  /// Mass (or number) that is due by `time` and has not entered, less what the next particle needs to be due.
  Real waiting(Real time) const;

  /// Whether the rate is one of particles, not of mass.
  bool counts_particles() const { return setup_.by_count; }
  /// Radii of the smallest and largest particle [m], and about how many there will be.
  Real smallest_radius() const;
  Real largest_radius() const;
  std::int64_t expected_particles() const;

  void save(core::CheckpointWriter& file, const std::string& name) const;
  void load(const core::CheckpointReader& file, const std::string& name);

 private:
  Real next_diameter() const;
  Real amount(Real diameter) const;
  Real due(Real time) const;
  Vec3 place(Real radius, std::int64_t step, std::uint32_t attempt) const;

  FeedSetup setup_;
  std::optional<SizeSampler> sizes_;
  Obstacles obstacles_;
  std::int64_t fed_ = 0;
  Real amount_ = 0;  // fed, as the rate counts it
  Real mass_ = 0;
};

/// Spheres of the engine that reach into a box, or do so in a periodic image.
std::vector<PlacedSphere> spheres_near(const Engine& engine, const Box& box);

}  // namespace pellicle::dem
