#include "tools/pellicle/case_keys.hpp"

#include <fmt/format.h>

#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

using core::Key;
using core::Keys;
using core::Need;
using core::Size;
using core::TextRule;
namespace dimension = core::dimension;
namespace range = core::range;

void describe_corners(Keys& keys, Box& box, bool may_be_flat) {
  keys.vector({"min", "corner with the smallest coordinates", Need::required}, {dimension::length}, box.min);
  keys.vector({"max", "corner with the largest coordinates", Need::required}, {dimension::length}, box.max);
  if (!keys.reading() || !keys.given("min") || !keys.given("max")) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(box.max[axis] > box.min[axis]) && !(may_be_flat && box.max[axis] == box.min[axis])) {
      keys.problem("max",
                   fmt::format("{} m is not beyond min {} m along {}; larger coordinates than those of min",
                               box.max[axis], box.min[axis], "xyz"[axis]));
      return;
    }
  }
}

void describe_domain(Keys& keys, DomainSpec& domain) {
  describe_box(keys, domain.box);
  std::vector<int> periodic;
  for (int axis = 0; axis < 3; ++axis) {
    if (domain.periodic[static_cast<std::size_t>(axis)]) periodic.push_back(axis);
  }
  std::optional<std::vector<int>> read = periodic;
  keys.choices({"periodic", "directions in which what leaves on one side comes back on the other"}, axes,
               Size{0, 3}, read);
  if (keys.reading()) {
    for (const int axis : *read) domain.periodic[static_cast<std::size_t>(axis)] = true;
  }
}

constexpr core::ModelInfo settle_ends[] = {{"quiet", "the root mean square speed stays below `speed`"}};

void describe_settling(Keys& keys, SettleSpec& settle) {
  std::optional<int> until = settle.until;
  keys.choice({"until", "what ends it before at_most", Need::required}, settle_ends, until);
  keys.real({"at_most", "after so long t = 0 comes all the same", Need::required},
            {dimension::duration, range::positive}, settle.at_most);
  keys.real({"speed", "of moving particles, root mean square, spin included"},
            {dimension::velocity, range::positive}, settle.speed);
}

void describe_time(Keys& keys, TimeSpec& time) {
  keys.real({"end", "simulated time of the run, after settling", Need::required},
            {dimension::duration, range::positive}, time.end);
  real_or_unset(keys,
                {"gas_step", "outer step: the gas advances by it, gas and particles exchange once a step",
                 Need::has_default, "required with gas; else 10 particle steps"},
                {dimension::duration, range::positive}, time.gas_step);
  real_or_unset(keys,
                {"particle_step", "step of the particles; gas_step is a whole multiple of it",
                 Need::has_default, "required with particles"},
                {dimension::duration, range::positive}, time.particle_step);
  keys.real({"parcel_step", "how often parcels of the spray move, in whole particle steps", Need::has_default,
             "as seldom as their path stays below a particle's radius, or every particle step"},
            {dimension::duration, range::positive}, time.parcel_step);
  keys.real({"courant",
             "of the gas: where it would be larger, an outer step is divided into equal parts, each of whole "
             "particle steps",
             Need::has_default, "outer steps are not divided"},
            {dimension::pure_number, range::positive}, time.courant);
  real_or_unset(keys,
                {"impact_speed", "largest impact speed expected, for the bound on particle_step",
                 Need::has_default, "largest initial speed, at least 1 m/s"},
                {dimension::velocity, range::positive}, time.impact_speed);
  std::optional<Real> settle = time.settle;
  keys.real_or_section<SettleSpec>({"settle", "particles settle for so long without gas, before t = 0"},
                                   {dimension::duration, range::non_negative}, settle, time.settle_until,
                                   describe_settling);
  if (settle) time.settle = *settle;
  keys.flag({"allow_large_step", "accept a particle_step beyond the stability bound"}, time.allow_large_step);
}

}  // namespace

void describe_box(Keys& keys, Box& box) { describe_corners(keys, box, false); }
void describe_flat_box(Keys& keys, Box& box) { describe_corners(keys, box, true); }

void describe_ring(Keys& keys, Real& radius, Real& inner_radius) {
  keys.real({"radius", "of the disc", Need::required}, {dimension::length, range::positive}, radius);
  keys.real({"inner_radius", "of the hole in its middle; 0: no hole"},
            {dimension::length, range::non_negative}, inner_radius);
  if (keys.reading() && keys.given("radius") && !(inner_radius < radius)) {
    keys.problem("inner_radius", fmt::format("{:g} m is not below the radius of {:g} m; a smaller one",
                                             inner_radius, radius));
  }
}

void real_or_unset(Keys& keys, const Key& key, const core::RealRule& rule, Real& value) {
  std::optional<Real> held;
  if (value != 0) held = value;
  keys.real(key, rule, held);
  if (held) value = *held;
}

int find_material(const CaseSpec& spec, std::string_view name) {
  for (std::size_t i = 0; i < spec.materials.size(); ++i) {
    if (spec.materials[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

std::string material_names(const CaseSpec& spec, bool with_rigid) {
  std::string names;
  for (const auto& material : spec.materials) {
    if (with_rigid || !material.rigid) names += (names.empty() ? "" : ", ") + material.name;
  }
  return names.empty() ? "none is defined" : names;
}

void material_key(Keys& keys, const Key& key, CaseSpec& spec, int& material, bool may_be_new) {
  std::optional<std::string> name;
  const auto index = static_cast<std::size_t>(material);
  if (!keys.reading() && index < spec.materials.size()) name = spec.materials[index].name;
  keys.text(key, TextRule::name, name);
  if (!keys.reading() || !name) return;
  material = find_material(spec, *name);
  if (material < 0 && may_be_new) {
    material = static_cast<int>(spec.materials.size());
    spec.materials.push_back({.name = *name, .rigid = true});
  } else if (material < 0) {
    keys.problem(key.name, fmt::format("no material \"{}\"; {}", *name, material_names(spec, false)));
    material = 0;
  } else if (!may_be_new && spec.materials[static_cast<std::size_t>(material)].rigid) {
    keys.problem(key.name, fmt::format("\"{}\" is a wall's material without properties; {}", *name,
                                       material_names(spec, false)));
  }
}

void describe_case(Keys& keys, CaseSpec& spec) {
  const Key title{"title", "one line that says what the case is", Need::has_default, "name of the case"};
  std::optional<std::string> given_title;
  if (!spec.title.empty()) given_title = spec.title;
  keys.text(title, TextRule::any, given_title);
  if (given_title) spec.title = *given_title;

  keys.whole({"seed", "of all random numbers"}, {0, std::numeric_limits<std::int64_t>::max()}, spec.seed);
  keys.section<DomainSpec>({"domain", "the box that holds everything", Need::required}, spec.domain,
                           describe_domain);
  keys.vector({"gravity", "acceleration of gravity"}, {dimension::acceleration}, spec.gravity);
  keys.section<TimeSpec>({"time", "how long, and in which steps", Need::required}, spec.time, describe_time);
  describe_materials_and_walls(keys, spec);
  describe_contacts(keys, spec);
  describe_particles(keys, spec);
  describe_gas(keys, spec);
  describe_coupling(keys, spec);
  describe_heat_and_films(keys, spec);
  describe_spray(keys, spec);
  describe_output(keys, spec);
}

}  // namespace pellicle::tools
