// The walls of an engine: geometry, motion, the list of near particles, and what they have received.
#pragma once

#include <vector>

#include "dem/wall_contacts.hpp"

namespace pellicle::dem {

class WallSystem {
 public:
  WallSystem() = default;
  /// `domain` bounds the parts of unbounded walls that matter. Throws std::invalid_argument for too many triangles.
  /// `contacts` tell what contacts with walls remember, and whether there are liquid bridges.
  WallSystem(const std::vector<Wall>& walls, const Box& domain, const ContactOptions& contacts = {});

  /// How far walls may move between two searches follows the rule for particles: radii [m] of the smallest and largest
  /// one, time step in s.
  void set_allowances(const SkinOptions& skin, Real time_step, Real smallest_radius, Real largest_radius);

  /// Brings walls to `time` seconds after they began to move; negative: they rest where they begin.
  void move_to(Real time);

  /// Whether a wall has moved so far that particles which are not in the list may touch it.
  bool list_outdated() const;
  /// See build_wall_list; walls are where they were moved to last.
  void build_list(const Particles& particles, const NeighbourList& neighbours, Real allowances);

  /// What contacts remember goes from list to list by itself; around a re-sort of memory, pack it, then follow.
  void pack_history(const Particles& particles) {
    history_.pack(list_, particles.count);
    bridges_.pack(list_, particles.count);
  }
  void reorder_history(const DeviceArray<std::int32_t>& order, Index count) {
    history_.reorder(order, count);
    bridges_.reorder(order, count);
  }
  void forget() {
    history_.clear();
    bridges_.clear();
  }
  void save(core::CheckpointWriter& file) const {
    history_.save(file);
    bridges_.save(file);
  }
  void load(const core::CheckpointReader& file) {
    history_.load(file);
    bridges_.load(file);
  }

  /// Contacts, and liquid bridges where the options have them.
  void add_contacts(const ContactInput& input, const ContactOptions& options, const ContactResult& result);
  /// Reports of each wall since the last call.
  std::vector<WallReport> collect_reports();

  /// Device memory of the list and the reports, without that of the geometry [bytes].
  std::size_t bytes() const;
  const WallGeometry& geometry() const { return geometry_; }
  const WallList& list() const { return list_; }
  std::size_t count() const { return motions_.size(); }

 private:
  struct HostMotion {
    WallMotion motion;
    bool turning;
    Real arm;           ///< largest distance of a point from the axis [m]
    Real top_speed;     ///< that shapes move with [m/s]
    Real allowance;     ///< [m]
    WallPose at_list;   ///< when the list was built
    Real time_at_list;  ///< [s]
  };
  WallPose pose_of(const HostMotion& wall, Real time) const;

  WallGeometry geometry_;
  WallList list_;
  WallHistory history_;
  WallHistory bridges_;
  Willett cohesion_;  // of no volume without bridges
  DeviceArray<WallReport> report_;
  DeviceArray<WallReport> report_scratch_;
  std::vector<HostMotion> motions_;
  bool any_moves_ = false;
  Real time_ = -1;  // of the present poses [s]
};

}  // namespace pellicle::dem
