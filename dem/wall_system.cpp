#include "dem/wall_system.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/engine_arrays.hpp"
#include "dem/wall_bridges.hpp"

namespace pellicle::dem {

WallSystem::WallSystem(const std::vector<Wall>& walls, const Box& domain, const ContactOptions& contacts)
    : geometry_(make_wall_geometry(walls)),
      report_(make_array<WallReport>("dem::wall_system::report",
                                     static_cast<std::size_t>(wall_blocks) * walls.size())),
      report_scratch_(make_array<WallReport>("dem::wall_system::report_scratch",
                                             static_cast<std::size_t>(report_parts) * walls.size())) {
  if (!walls.empty() && contacts.springs() > 0)
    history_ = WallHistory("dem/wall_history", contacts.springs());
  if (!walls.empty() && contacts.cohesion) {
    bridges_ = WallHistory("dem/wall_bridges", 0);
    cohesion_ = *contacts.cohesion;
  }
  for (const Wall& wall : walls) {
    HostMotion m{};
    m.motion = wall.motion;
    m.turning = has_to_turn(wall);
    if (m.turning) m.arm = largest_arm(wall, domain.min, domain.max);
    m.top_speed = (m.turning ? norm(wall.motion.spin) * m.arm : 0) +
                  2 * std::numbers::pi * std::abs(wall.motion.frequency) * norm(wall.motion.amplitude);
    m.at_list = pose_of(m, -1);
    m.time_at_list = -1;
    const WallMotion& motion = m.motion;
    any_moves_ = any_moves_ || norm(motion.surface_velocity) + norm(motion.spin) + m.top_speed > 0;
    motions_.push_back(m);
  }
}

void WallSystem::set_allowances(const SkinOptions& skin, Real time_step, Real smallest_radius,
                                Real largest_radius) {
  if (motions_.empty()) return;
  const auto body = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, geometry_.body);
  for (std::size_t w = 0; w < motions_.size(); ++w) {
    HostMotion& m = motions_[w];
    m.allowance = 0;
    if (m.top_speed > 0) {
      m.allowance = std::clamp(skin.steps * time_step * m.top_speed, skin.smallest_fraction * smallest_radius,
                               skin.largest_fraction * largest_radius);
      // A wall that only vibrates never moves further than from one end to the other.
      if (!m.turning) m.allowance = std::min(m.allowance, 2 * norm(m.motion.amplitude));
    }
    body(w).allowance = m.allowance;
  }
  Kokkos::deep_copy(geometry_.body, body);
}

WallPose WallSystem::pose_of(const HostMotion& wall, Real time) const {
  return time < 0 ? compute_pose_at_rest(wall.motion) : compute_pose(wall.motion, wall.turning, time);
}

void WallSystem::move_to(Real time) {
  // Walls that rest before they begin to move do not have to be told so at every step.
  if (any_moves_ && (time >= 0 || time_ >= 0)) update_poses(geometry_, time);
  time_ = time;
}

bool WallSystem::list_outdated() const {
  if (!any_moves_) return false;
  return std::any_of(motions_.begin(), motions_.end(), [this](const HostMotion& wall) {
    if (wall.top_speed == 0) return false;
    Real moved = norm(pose_of(wall, time_).shift - wall.at_list.shift);
    if (wall.turning) {
      const Real angle =
          norm(wall.motion.spin) * (std::max<Real>(time_, 0) - std::max<Real>(wall.time_at_list, 0));
      moved += 2 * wall.arm * std::sin(0.5 * std::min(std::abs(angle), std::numbers::pi));
    }
    // The last part in 1e9 covers the rounding of both sides.
    return moved > wall.allowance * (1 + 1e-9);
  });
}

void WallSystem::build_list(const Particles& particles, const NeighbourList& neighbours, Real allowances) {
  pack_history(particles);
  build_wall_list(particles, neighbours, allowances, geometry_, list_, cohesion_);
  history_.unpack(list_);
  bridges_.unpack(list_);
  for (HostMotion& wall : motions_) {
    wall.at_list = pose_of(wall, time_);
    wall.time_at_list = time_;
  }
}

void WallSystem::add_contacts(const ContactInput& input, const ContactOptions& options,
                              const ContactResult& result) {
  const WallInput walls{geometry_, list_, history_.rows(), report_};
  add_wall_contacts(walls, input, options, result);
  if (options.cohesion) add_wall_bridge_forces(walls, bridges_.rows().memory, input, cohesion_, result);
}

std::size_t WallSystem::bytes() const {
  return bytes_of(list_.particle) + bytes_of(list_.offset) + bytes_of(list_.surface) + bytes_of(list_.near) +
         bytes_of(report_) + bytes_of(report_scratch_) + history_.bytes() + bridges_.bytes();
}

std::vector<WallReport> WallSystem::collect_reports() {
  return collect_wall_reports(report_, report_scratch_);
}

}  // namespace pellicle::dem
