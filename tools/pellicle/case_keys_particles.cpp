// Keys of materials, walls and contacts.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

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
  keys.real({"true_youngs_modulus",
             "of the real solid: the particle step that it would need is reported, and contacts conduct heat "
             "as it would"},
            {dimension::pressure, range::positive}, material.true_youngs_modulus);
  keys.real({"poisson_ratio", "of the solid", Need::required},
            {dimension::pure_number, {.min = 0, .max = 0.5}}, material.poisson_ratio);
  keys.real({"heat_capacity", "of the solid; required of particles with heat"},
            {dimension::heat_capacity, range::positive}, material.heat_capacity);
  keys.real({"conductivity", "of the solid, for heat; required of particles with heat.contact_conduction",
             Need::has_default, "none: a wall that resists no heat"},
            {dimension::heat_conductivity, range::positive}, material.conductivity);
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
  keys.real({"normal_stiffness", "of the linear law", Need::has_default, "by contacts.linear"},
            {dimension::stiffness, range::positive}, pair.normal_stiffness);
}

void describe_cohesion(Keys& keys, CohesionSpec& cohesion) {
  dem::Willett& law = cohesion.willett;
  keys.choice({"model", "what the attraction is"}, cohesion_models, cohesion.model);
  keys.real({"bridge_volume", "liquid in one bridge", Need::required}, {dimension::volume, range::positive},
            law.bridge_volume);
  keys.real({"surface_tension", "of the liquid", Need::required},
            {dimension::surface_tension, range::positive}, law.surface_tension);
  keys.real({"contact_angle", "between liquid and solid"},
            {dimension::angle, {.min = 0, .max = 0.5 * std::numbers::pi, .max_excluded = true}},
            law.contact_angle);
}

void describe_linear(Keys& keys, LinearSpec& linear) {
  keys.real({"largest_overlap", "of an impact at that speed, over the smaller radius"},
            {dimension::pure_number, {.min = 0, .max = 1, .min_excluded = true}}, linear.largest_overlap);
  std::optional<Real> speed;
  if (linear.speed > 0) speed = linear.speed;
  keys.real({"speed", "of the impact", Need::has_default, "time.impact_speed"},
            {dimension::velocity, range::positive}, speed);
  if (speed) linear.speed = *speed;
}

}  // namespace

void describe_materials_and_walls(Keys& keys, CaseSpec& spec) {
  std::vector<MaterialSpec> listed;
  for (const auto& material : spec.materials) {
    if (!material.rigid) listed.push_back(material);
  }
  keys.named<MaterialSpec>({"materials", "solids by name"}, listed, describe_material);
  if (keys.reading()) spec.materials = listed;
  describe_walls(keys, spec);
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
        inner.section<CohesionSpec>({"cohesion", "attraction between particles; none without this section"},
                                    contacts.cohesion, describe_cohesion);
        inner.section<LinearSpec>(
            {"linear", "stiffness of the linear law for pairs that give none; only with model.normal linear"},
            contacts.linear, describe_linear);
        inner.list<PairSpec>({"pairs", "properties of each pair of materials that can meet"}, {},
                             contacts.pairs,
                             [&](Keys& pair_keys, PairSpec& pair) { describe_pair(pair_keys, pair, spec); });
        inner.real({"overlap_limit", "a larger overlap, over the smaller radius, stops the run"},
                   {dimension::pure_number, {.min = 0, .max = 1, .min_excluded = true}},
                   contacts.overlap_limit);
      });
}

}  // namespace pellicle::tools
