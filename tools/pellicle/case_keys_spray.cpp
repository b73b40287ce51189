// Keys of the spray: nozzles, and the droplets that leave them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "spray/swept_capture_laws.hpp"
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

constexpr core::Range cone_angles{.min = 0, .max = 2 * std::numbers::pi};

void describe_capture(Keys& keys, CaptureSpec& capture) {
  constexpr Size points{1, spray::most_efficiency_points};
  const auto list = [&](const core::Key& key, const core::RealRule& rule, std::vector<Real>& values) {
    std::optional<std::vector<Real>> held;
    if (!values.empty()) held = values;
    keys.reals(key, rule, points, held);
    if (held) values = *held;
  };
  list({"weber", "impact Weber numbers (density normal_speed^2 diameter / surface_tension), increasing",
        Need::required},
       {dimension::pure_number, range::non_negative}, capture.weber);
  list({"efficiency", "share of the droplets that stay at each; linear in between, constant beyond",
        Need::required},
       {dimension::pure_number, range::from_0_to_1}, capture.efficiency);
  keys.real({"surface_tension", "of the droplets"}, {dimension::surface_tension, range::positive},
            capture.surface_tension);
  if (!keys.reading() || !keys.given("weber") || !keys.given("efficiency")) return;
  if (capture.weber.size() != capture.efficiency.size()) {
    keys.problem("efficiency", fmt::format("{} shares for {} Weber numbers; one for each",
                                           capture.efficiency.size(), capture.weber.size()));
  }
  if (std::adjacent_find(capture.weber.begin(), capture.weber.end(), std::greater_equal<>()) !=
      capture.weber.end()) {
    keys.problem("weber", "they do not increase; numbers in increasing order");
  }
}

void describe_diameter(Keys& keys, NozzleSpec& nozzle) {
  std::optional<Real> diameter;
  if (nozzle.droplet_diameter != 0) diameter = nozzle.droplet_diameter;
  keys.real_or_section<SizesSpec>(
      {"droplet_diameter", "of all droplets, or how they are spread in size", Need::required},
      {dimension::length, range::positive}, diameter, nozzle.sizes, describe_sizes);
  if (diameter) nozzle.droplet_diameter = *diameter;
}

void describe_cone_angles(Keys& keys, NozzleSpec& nozzle) {
  keys.real({"cone_angle", "full angle of the cone that droplets leave in; 0: a parallel beam"},
            {dimension::angle, cone_angles}, nozzle.cone_angle);
  keys.choice({"pattern", "where in the cone they go"}, spray_patterns, nozzle.pattern);
  keys.real({"inner_cone_angle", "full angle of the cone inside a hollow one that stays free of droplets",
             Need::has_default, "0.8 of cone_angle with pattern hollow"},
            {dimension::angle, cone_angles}, nozzle.inner_cone_angle);
  if (!keys.reading() || !nozzle.inner_cone_angle) return;
  if (nozzle.pattern != spray::SprayPattern::hollow)
    keys.problem("inner_cone_angle", "a full cone has none; only with pattern hollow");
  if (*nozzle.inner_cone_angle > nozzle.cone_angle) {
    keys.problem("inner_cone_angle", "it is wider than cone_angle; a smaller one");
  }
}

void describe_nozzle(Keys& keys, NozzleSpec& nozzle) {
  if (keys.reading()) nozzle.where = keys.where();
  keys.text({"name", "of the nozzle", Need::required}, TextRule::name, nozzle.name);
  keys.vector({"position", "centre of the orifice", Need::required}, {dimension::length}, nozzle.position);
  keys.vector({"axis", "direction of the spray, of any length"}, {}, nozzle.axis);
  if (keys.reading() && keys.given("axis")) {
    const Real length = norm(nozzle.axis);
    if (length == 0) keys.problem("axis", "it has no length; a direction such as [0, 0, 1]");
    // An axis of length 1 is kept to the bit, so that the resolved file reads back as it is.
    if (length > 0 && std::abs(length - 1) > 1e-15) nozzle.axis *= 1 / length;
  }
  describe_cone_angles(keys, nozzle);
  keys.real({"nozzle_radius", "of the orifice"}, {dimension::length, range::non_negative},
            nozzle.nozzle_radius);
  keys.real({"speed", "of the droplets as they leave", Need::required},
            {dimension::velocity, range::positive}, nozzle.speed);
  keys.real({"mass_rate", "of liquid and solids together", Need::required},
            {dimension::mass_flow_rate, range::positive}, nozzle.mass_rate);
  keys.real({"solids_fraction", "share of the mass that is solids"},
            {dimension::pure_number, range::from_0_to_1}, nozzle.solids_fraction);
  keys.real({"density", "of a droplet"}, {dimension::density, range::positive}, nozzle.density);
  keys.real({"temperature",
             "of the droplets as they leave; without droplets.evaporation they take that of the gas at once, "
             "and the summary says what heat that is"},
            {dimension::temperature, range::positive}, nozzle.temperature);
  describe_diameter(keys, nozzle);
  keys.real({"droplets_per_parcel",
             "that move as one; all parcels of a nozzle have the mass of so many droplets of the "
             "mean volume"},
            {dimension::pure_number, range::positive}, nozzle.droplets_per_parcel);
  keys.real({"from", "when it opens"}, {dimension::duration, range::non_negative}, nozzle.from);
  real_or_unset(keys, {"to", "when it closes", Need::has_default, "time.end"},
                {dimension::duration, range::positive}, nozzle.to);
  keys.section<CaptureSpec>(
      {"capture",
       "how many of the droplets that hit a particle stay; the others bounce off. Without "
       "it all stay"},
      nozzle.capture, describe_capture);
}

void describe_droplets(Keys& keys, DropletSpec& droplets) {
  static constexpr core::ModelInfo momenta[] = {
      {"one_way", "the gas drags droplets and does not feel them"},
      {"two_way",
       "the gas gets the opposite of what droplets get, particles the impulse of those that they capture or "
       "throw back"}};
  std::optional<int> momentum = droplets.two_way ? 1 : 0;
  keys.choice({"momentum", "whether droplets push the gas and the particles"}, momenta, momentum);
  droplets.two_way = *momentum == 1;
  keys.flag({"evaporation",
             "droplets keep the temperature that they leave with, and exchange heat and vapour with the "
             "gas; needs heat.evaporation"},
            droplets.evaporation);
}

}  // namespace

void describe_spray(Keys& keys, CaseSpec& spec) {
  keys.list<NozzleSpec>({"spray", "nozzles"}, {}, spec.spray, describe_nozzle);
  std::optional<DropletSpec> held;
  if (!keys.reading() && !spec.spray.empty()) held = spec.droplets;
  keys.section<DropletSpec>({"droplets", "what droplets of the spray do in flight besides flying"}, held,
                            describe_droplets);
  if (keys.reading() && held) spec.droplets = *held;
}

}  // namespace pellicle::tools
