// Keys of materials, walls and contacts.
#include <fmt/format.h>

#include <cmath>

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

void describe_material(Keys& keys, MaterialSpec& material) {
  keys.real({"density", "of the solid, without pores between particles", Need::required},
            {dimension::density, range::positive}, material.density);
  keys.real({"youngs_modulus", "a smaller one than the real allows a larger particle step; overlaps grow",
             Need::required},
            {dimension::pressure, range::positive}, material.youngs_modulus);
  keys.real({"poisson_ratio", "of the solid", Need::required},
            {dimension::pure_number, {.min = 0, .max = 0.5}}, material.poisson_ratio);
}

void describe_plane(Keys& keys, PlaneSpec& plane) {
  keys.vector({"point", "any point of the plane", Need::required}, {dimension::length}, plane.point);
  keys.vector({"normal", "direction from the plane to the particles' side, of any length", Need::required},
              {}, plane.normal);
  if (!keys.reading() || !keys.given("normal")) return;
  const Real length = norm(plane.normal);
  if (length > 0) {
    // A normal of length 1 is kept to the bit, so that the resolved file reads back as it is.
    if (std::abs(length - 1) > 1e-15) plane.normal *= 1 / length;
  } else {
    keys.problem("normal", "it has no length; a direction such as [0, 0, 1]");
  }
}

void describe_wall(Keys& keys, WallSpec& wall, CaseSpec& spec) {
  static constexpr core::ModelInfo box_list[] = {{"domain", "the six sides of the domain"}};
  if (keys.reading()) wall.where = keys.where();
  keys.text({"name", "of the wall", Need::required}, TextRule::name, wall.name);
  std::optional<int> box;
  if (wall.box) box = 0;
  keys.choice({"box", "the sides of the domain, except those of periodic directions"}, box_list, box);
  wall.box = box.has_value();
  keys.choices({"open", "sides of the box without wall: particles leave there and are counted"}, domain_sides,
               Size{0, 6}, wall.open);
  keys.section<PlaneSpec>({"plane", "an unbounded plane"}, wall.plane, describe_plane);
  keys.exactly_one({"box", "plane"});
  material_key(keys, {"material", "of the wall; one that is not among materials is rigid", Need::required},
               spec, wall.material, true);
  keys.vector({"velocity", "of the surface along itself, like a belt; the wall stays where it is"},
              {dimension::velocity}, wall.velocity);
  if (!keys.reading()) return;
  if (wall.plane && !wall.open.empty()) keys.problem("open", "a plane has no sides; only with box");
  const Real speed = norm(wall.velocity);
  const auto moves_along = [&](const Vec3& normal) {
    return std::abs(dot(wall.velocity, normal)) <= 1e-9 * speed;
  };
  if (wall.plane && !moves_along(wall.plane->normal)) {
    keys.problem("velocity", "it leads through the plane; a velocity at right angles to the normal");
  }
}

void describe_pair(Keys& keys, PairSpec& pair, CaseSpec& spec) {
  if (keys.reading()) pair.where = keys.where();
  std::optional<std::vector<std::string>> names;
  if (!keys.reading() && !spec.materials.empty()) {
    names = {spec.materials[static_cast<std::size_t>(pair.material_a)].name,
             spec.materials[static_cast<std::size_t>(pair.material_b)].name};
  }
  keys.texts({"between", "two materials, or twice the same", Need::required}, TextRule::name,
             Size::exactly(2), names);
  if (keys.reading() && names) {
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string& name = (*names)[i];
      const int found = find_material(spec, name);
      if (found < 0) {
        keys.problem("between", fmt::format("no material \"{}\"; {}", name, material_names(spec, true)));
      } else {
        (i == 0 ? pair.material_a : pair.material_b) = found;
      }
    }
  }
  keys.real({"restitution", "speed after over speed before a head-on impact", Need::required},
            {dimension::pure_number, {.min = 0, .max = 1, .min_excluded = true}}, pair.restitution);
  keys.real({"sliding_friction", "Coulomb's coefficient", Need::required},
            {dimension::pure_number, range::non_negative}, pair.sliding_friction);
  keys.real({"rolling_friction", "rolling torque over normal force and reduced radius R*"},
            {dimension::pure_number, range::non_negative}, pair.rolling_friction);
}

}  // namespace

void describe_materials_and_walls(Keys& keys, CaseSpec& spec) {
  std::vector<MaterialSpec> listed;
  for (const auto& material : spec.materials) {
    if (!material.rigid) listed.push_back(material);
  }
  keys.named<MaterialSpec>({"materials", "solids by name"}, listed, describe_material);
  if (keys.reading()) spec.materials = listed;
  keys.list<WallSpec>({"walls", "what particles bounce off"}, {}, spec.walls,
                      [&](Keys& inner, WallSpec& wall) { describe_wall(inner, wall, spec); });
}

void describe_contacts(Keys& keys, CaseSpec& spec) {
  keys.section<ContactSpec>(
      {"contacts", "how particles meet particles and walls"}, spec.contacts,
      [&](Keys& inner, ContactSpec& contacts) {
        inner.section<ContactSpec>(
            {"model", "laws of the contact forces"}, contacts, [](Keys& model, ContactSpec& c) {
              model.choice({"normal", "force along the line of centres"}, normal_contact_models, c.normal);
              model.choice({"tangential", "friction"}, tangential_contact_models, c.tangential);
              model.choice({"rolling", "resistance to rolling"}, rolling_models, c.rolling);
              model.flag(
                  {"clip", "no attraction when particles part; false is for comparison with closed forms"},
                  c.clip);
            });
        inner.list<PairSpec>({"pairs", "properties of each pair of materials that can meet"}, {},
                             contacts.pairs,
                             [&](Keys& pair_keys, PairSpec& pair) { describe_pair(pair_keys, pair, spec); });
        inner.real({"overlap_limit", "a larger overlap, over the smaller radius, stops the run"},
                   {dimension::pure_number, {.min = 0, .max = 1, .min_excluded = true}},
                   contacts.overlap_limit);
      });
}

}  // namespace pellicle::tools
