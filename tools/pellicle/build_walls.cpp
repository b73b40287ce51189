#include "tools/pellicle/build_walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/error.hpp"
#include "core/log.hpp"
#include "dem/stl.hpp"
#include "tools/pellicle/case_checks.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {
namespace {

constexpr std::array<Real, 3> metres{1, 1e-2, 1e-3};  // in the order of length_units

dem::PlaneShape make_side(const Box& box, cfd::Side side) {
  const int axis = cfd::axis_of(side);
  const bool upper = cfd::is_max(side);
  dem::PlaneShape plane{};
  plane.normal[axis] = upper ? -1 : 1;
  plane.offset = dot(plane.normal, upper ? box.max : box.min);
  return plane;
}

void add_sides(const CaseSpec& spec, const WallSpec& wall, dem::Wall& made) {
  for (int s = 0; s < 6; ++s) {
    const auto side = static_cast<cfd::Side>(s);
    if (spec.domain.periodic[static_cast<std::size_t>(cfd::axis_of(side))]) continue;
    if (std::find(wall.open.begin(), wall.open.end(), side) != wall.open.end()) continue;
    made.planes.push_back(make_side(spec.domain.box, side));
  }
}

dem::RevolvedShape revolve(const Vec3& from, const Vec3& to, Real radius_from, Real radius_to) {
  const Real length = norm(to - from);
  return {from, (1 / length) * (to - from), radius_from, 0, radius_to, length};
}

/// A mesh in the wrong unit is a thousand times too large or too small: away from the domain, or smaller than a particle.
void check_size(const CaseSpec& spec, const WallSpec& wall, const dem::MeshReport& report) {
  const auto largest = [](const Vec3& v) { return std::max({v.x, v.y, v.z}); };
  const Box& box = spec.domain.box;
  const Real domain = largest(box.max - box.min);
  const Real size = largest(report.max - report.min);
  bool apart = false;
  for (int axis = 0; axis < 3; ++axis) {
    apart = apart || report.min[axis] > box.max[axis] || report.max[axis] < box.min[axis];
  }
  const Real particle = diameter_range(spec).smallest;
  const bool tiny = size < 0.01 * domain && size < particle;
  if (!apart && !tiny && size <= 50 * domain) return;
  const auto text = [](const Vec3& v) { return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v.x, v.y, v.z); };
  throw std::invalid_argument(fmt::format(
      "with unit {} it reaches from {} to {} m, which is {}; coordinates that fit the domain from {} to {} "
      "m, "
      "or another unit",
      length_units[static_cast<std::size_t>(wall.unit.value_or(0))].name, text(report.min), text(report.max),
      tiny    ? fmt::format("smaller than a particle of {:.4g} m", particle)
      : apart ? "apart from the domain"
              : "far larger than the domain",
      text(box.min), text(box.max)));
}

void add_mesh(const CaseSpec& spec, const WallSpec& wall, dem::Wall& made) {
  try {
    dem::MeshReport report;
    const Real scale = metres.at(static_cast<std::size_t>(wall.unit.value_or(0)));
    made.mesh = std::make_shared<dem::TriangleMesh>(dem::read_stl(*wall.stl, scale, report));
    check_size(spec, wall, report);
    core::log().info("wall {}: {}", wall.name, dem::describe_mesh(report));
    const std::string doubts = dem::doubts_about_mesh(report);
    if (!doubts.empty()) core::log().warn("wall {}: {}", wall.name, doubts);
  } catch (const std::invalid_argument& error) {
    const std::string path = wall.where.substr(wall.where.rfind(": ") + 2);
    throw InputError(spec.where(path + ".stl") + ": " + *wall.stl + ": " + error.what());
  }
}

}  // namespace

dem::Wall make_wall(const CaseSpec& spec, const WallSpec& wall) {
  dem::Wall made;
  made.name = wall.name;
  made.material = wall.material;
  made.motion.surface_velocity = wall.velocity;
  if (wall.spin) {
    made.motion.spin = wall.spin->rate * wall.spin->axis;
    made.motion.through = wall.spin->through;
    made.torque_about = wall.spin->through;
  }
  if (wall.vibration) {
    made.motion.amplitude = wall.vibration->amplitude;
    made.motion.frequency = wall.vibration->frequency;
    made.motion.phase = wall.vibration->phase;
  }
  if (wall.torque_about) made.torque_about = *wall.torque_about;
  if (wall.box) add_sides(spec, wall, made);
  if (wall.plane) made.planes.push_back({wall.plane->normal, dot(wall.plane->normal, wall.plane->point)});
  if (wall.disc) {
    made.revolved.push_back(
        {wall.disc->centre, wall.disc->normal, wall.disc->inner_radius, 0, wall.disc->radius, 0});
  }
  if (wall.cylinder) {
    made.revolved.push_back(
        revolve(wall.cylinder->from, wall.cylinder->to, wall.cylinder->radius, wall.cylinder->radius));
  }
  if (wall.cone)
    made.revolved.push_back(
        revolve(wall.cone->from, wall.cone->to, wall.cone->from_radius, wall.cone->to_radius));
  if (wall.block) made.boxes.push_back({wall.block->min, wall.block->max});
  if (wall.stl) add_mesh(spec, wall, made);
  return made;
}

}  // namespace pellicle::tools
