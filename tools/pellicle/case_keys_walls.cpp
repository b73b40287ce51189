// Keys of walls.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

using core::Keys;
using core::Need;
using core::Size;
using core::TextRule;
namespace dimension = core::dimension;
namespace range = core::range;

constexpr core::Dimension frequency{"a frequency", "Hz", "50 Hz"};

constexpr core::ModelInfo gas_wall_list[] = {{"no_slip", "the gas sticks to it"},
                                             {"free_slip", "the gas slips along it without shear"},
                                             {"open", "the gas passes it"}};

/// A direction of any length, made one of length 1.
void direction_key(Keys& keys, const core::Key& key, Vec3& direction) {
  keys.vector(key, {}, direction);
  if (!keys.reading() || !keys.given(key.name)) return;
  const Real length = norm(direction);
  if (length > 0) {
    // A direction of length 1 is kept to the bit, so that the resolved file reads back as it is.
    if (std::abs(length - 1) > 1e-15) direction *= 1 / length;
  } else {
    keys.problem(key.name, "it has no length; a direction such as [0, 0, 1]");
  }
}

void describe_plane(Keys& keys, PlaneSpec& plane) {
  keys.vector({"point", "any point of the plane", Need::required}, {dimension::length}, plane.point);
  direction_key(keys,
                {"normal", "direction from the plane to the particles' side, of any length", Need::required},
                plane.normal);
}

void describe_disc(Keys& keys, DiscSpec& disc) {
  keys.vector({"centre", "its middle", Need::required}, {dimension::length}, disc.centre);
  direction_key(keys, {"normal", "direction of its axis, of any length", Need::required}, disc.normal);
  describe_ring(keys, disc.radius, disc.inner_radius);
}

void describe_spin(Keys& keys, SpinSpec& spin) {
  keys.real({"rate", "angular velocity; positive turns right-handed about the axis", Need::required},
            {dimension::angular_velocity}, spin.rate);
  direction_key(keys, {"axis", "direction of the axis, of any length", Need::required}, spin.axis);
  keys.vector({"through", "any point of the axis", Need::required}, {dimension::length}, spin.through);
}

void describe_vibration(Keys& keys, VibrationSpec& vibration) {
  keys.vector({"amplitude", "largest displacement", Need::required}, {dimension::length},
              vibration.amplitude);
  keys.real({"frequency", "displacement is amplitude times sin(2 pi frequency t + phase)", Need::required},
            {frequency, range::positive}, vibration.frequency);
  keys.real({"phase", "at t = 0"}, {dimension::angle}, vibration.phase);
}

void describe_shape(Keys& keys, WallSpec& wall, const std::string& case_file) {
  static constexpr core::ModelInfo box_list[] = {{"domain", "the six sides of the domain"}};
  std::optional<int> box;
  if (wall.box) box = 0;
  keys.choice({"box", "the sides of the domain, except those of periodic directions"}, box_list, box);
  wall.box = box.has_value();
  keys.choices({"open", "sides of the box without wall: particles leave there and are counted"}, domain_sides,
               Size{0, 6}, wall.open);
  keys.section<PlaneSpec>({"plane", "an unbounded plane, solid behind"}, wall.plane, describe_plane);
  keys.section<DiscSpec>({"disc", "a thin disc, or an annulus"}, wall.disc, describe_disc);
  keys.section<dem::CylinderRegion>({"cylinder", "a thin open tube, touched from inside and outside"},
                                    wall.cylinder, describe_cylinder);
  keys.section<dem::ConeRegion>({"cone", "a thin open cone or frustum, touched from inside and outside"},
                                wall.cone, describe_cone);
  keys.section<Box>({"block", "a solid box"}, wall.block, describe_box);
  keys.text({"stl", "a file of triangles, thin; its path is relative to the case file"}, TextRule::any,
            wall.stl);
  keys.choice({"unit", "that the coordinates of the STL file are in", Need::has_default, "`m`"}, length_units,
              wall.unit);
  keys.exactly_one({"box", "plane", "disc", "cylinder", "cone", "block", "stl"});
  if (!keys.reading()) return;
  if (!wall.box && !wall.open.empty()) {
    keys.problem("open", "only the sides of a box can be open; no open, or box: domain");
  }
  if (wall.stl && !wall.unit) wall.unit = 0;
  if (!wall.stl && wall.unit)
    keys.problem("unit", "there is no file that it says something of; only with stl");
  // The resolved file, which is written elsewhere, must find the mesh too (resolved_yaml).
  if (wall.stl && std::filesystem::path(*wall.stl).is_relative()) {
    wall.stl = std::filesystem::absolute(std::filesystem::path(case_file).parent_path() / *wall.stl)
                   .lexically_normal()
                   .string();
  }
}

void describe_wall(Keys& keys, WallSpec& wall, CaseSpec& spec) {
  if (keys.reading()) wall.where = keys.where();
  keys.text({"name", "of the wall", Need::required}, TextRule::name, wall.name);
  describe_shape(keys, wall, spec.file);
  material_key(keys, {"material", "of the wall; one that is not among materials is rigid", Need::required},
               spec, wall.material, true);
  keys.vector({"velocity", "of the surface along itself, like a belt; the wall stays where it is"},
              {dimension::velocity}, wall.velocity);
  keys.section<SpinSpec>({"spin", "the wall turns"}, wall.spin, describe_spin);
  keys.section<VibrationSpec>({"vibration", "the wall swings to and fro"}, wall.vibration,
                              describe_vibration);
  keys.vector({"torque_about", "point that the torque on the wall is reported about", Need::has_default,
               "spin.through, else [0, 0, 0]"},
              {dimension::length}, wall.torque_about);
  keys.choice({"gas", "what it is to the gas; the sides of the domain get theirs from gas.boundaries"},
              gas_wall_list, wall.gas);
  keys.real({"temperature", "towards particles that touch it, with heat.contact_conduction",
             Need::has_default, "none: it takes no heat"},
            {dimension::temperature, range::positive}, wall.temperature);
  if (!keys.reading()) return;
  const Real speed = norm(wall.velocity);
  const auto leads_through = [&](const Vec3& normal) {
    return std::abs(dot(wall.velocity, normal)) > 1e-9 * speed;
  };
  if ((wall.plane && leads_through(wall.plane->normal)) || (wall.disc && leads_through(wall.disc->normal))) {
    keys.problem("velocity", "it leads through the wall; a velocity at right angles to the normal");
  }
  if (wall.box && wall.spin) {
    keys.problem("spin", "the sides of the domain cannot turn; any other shape");
  }
}

}  // namespace

void describe_walls(Keys& keys, CaseSpec& spec) {
  keys.list<WallSpec>({"walls", "what particles bounce off"}, {}, spec.walls,
                      [&](Keys& inner, WallSpec& wall) { describe_wall(inner, wall, spec); });
}

}  // namespace pellicle::tools
