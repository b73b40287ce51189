// Keys of populations of particles: how many, how large, where.
#include <fmt/format.h>

#include <cmath>

#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

using core::Keys;
using core::Need;
using core::Size;
namespace dimension = core::dimension;
namespace range = core::range;

constexpr core::ModelInfo share_of_list[] = {{"count", "shares of the number of particles"},
                                             {"mass", "shares of their mass"}};
static_assert(static_cast<int>(dem::ShareOf::count) == 0 && static_cast<int>(dem::ShareOf::mass) == 1);

/// What a size distribution is cut at.
template <class Sizes>
void describe_cut(Keys& keys, Sizes& sizes) {
  keys.real({"min", "smallest diameter", Need::required}, {dimension::length, range::positive}, sizes.min);
  keys.real({"max", "largest diameter", Need::required}, {dimension::length, range::positive}, sizes.max);
}

void describe_table(Keys& keys, dem::TableSizes& table) {
  const auto list = [&](const core::Key& key, const core::RealRule& rule, std::vector<Real>& values) {
    std::optional<std::vector<Real>> held;
    if (!values.empty()) held = values;
    keys.reals(key, rule, Size{1}, held);
    if (held) values = *held;
  };
  list({"diameters", "in increasing order", Need::required}, {dimension::length, range::positive},
       table.diameters);
  list({"shares", "of each diameter, in any unit; particles then have no other diameters"},
       {dimension::pure_number, range::non_negative}, table.shares);
  list({"finer", "share finer than each diameter, in any unit; linear in between"},
       {dimension::pure_number, range::non_negative}, table.finer);
  keys.exactly_one({"shares", "finer"});
  keys.choice({"by", "what the shares count"}, share_of_list, table.by);
}

}  // namespace

void describe_sizes(Keys& keys, SizesSpec& sizes) {
  keys.section<dem::UniformSizes>({"uniform", "every diameter from min to max equally often"}, sizes.uniform,
                                  describe_cut<dem::UniformSizes>);
  keys.section<dem::NormalSizes>({"normal", "normal by number"}, sizes.normal,
                                 [](Keys& inner, dem::NormalSizes& normal) {
                                   inner.real({"mean", "before the cut", Need::required},
                                              {dimension::length, range::positive}, normal.mean);
                                   inner.real({"sd", "standard deviation before the cut", Need::required},
                                              {dimension::length, range::positive}, normal.sd);
                                   describe_cut(inner, normal);
                                 });
  keys.section<dem::LogNormalSizes>(
      {"log_normal", "the logarithm of the diameter is normal"}, sizes.log_normal,
      [](Keys& inner, dem::LogNormalSizes& log_normal) {
        inner.real({"median", "half are smaller, before the cut", Need::required},
                   {dimension::length, range::positive}, log_normal.median);
        inner.real({"geometric_sd", "exp of the standard deviation of the logarithm", Need::required},
                   {dimension::pure_number, {.min = 1, .min_excluded = true}}, log_normal.geometric_sd);
        inner.choice({"by", "whether number or mass is normal"}, share_of_list, log_normal.by);
        describe_cut(inner, log_normal);
      });
  keys.section<dem::RosinRammlerSizes>(
      {"rosin_rammler", "by mass, the share finer than d is 1 - exp(-(d/size)^spread)"}, sizes.rosin_rammler,
      [](Keys& inner, dem::RosinRammlerSizes& rosin) {
        inner.real({"size", "63.2 % of the mass is finer, before the cut", Need::required},
                   {dimension::length, range::positive}, rosin.size);
        inner.real({"spread", "the larger, the narrower", Need::required},
                   {dimension::pure_number, range::positive}, rosin.spread);
        describe_cut(inner, rosin);
      });
  keys.section<dem::TableSizes>({"table", "given diameters, or a sieve analysis"}, sizes.table,
                                describe_table);
  keys.exactly_one({"uniform", "normal", "log_normal", "rosin_rammler", "table"});
}

namespace {

/// A round region: its axis, and radii greater than 0, or one of them 0 for a cone.
template <class Region>
void describe_axis(Keys& keys, Region& region) {
  keys.vector({"from", "one end of the axis", Need::required}, {dimension::length}, region.from);
  keys.vector({"to", "other end of the axis", Need::required}, {dimension::length}, region.to);
  if (keys.reading() && keys.given("from") && keys.given("to") && region.from == region.to) {
    keys.problem("to", "it is the same point as from; the other end of the axis");
  }
}

}  // namespace

void describe_cylinder(Keys& keys, dem::CylinderRegion& cylinder) {
  describe_axis(keys, cylinder);
  keys.real({"radius", "of the cylinder", Need::required}, {dimension::length, range::positive},
            cylinder.radius);
}

void describe_cone(Keys& keys, dem::ConeRegion& cone) {
  describe_axis(keys, cone);
  keys.real({"from_radius", "at from", Need::required}, {dimension::length, range::non_negative},
            cone.from_radius);
  keys.real({"to_radius", "at to", Need::required}, {dimension::length, range::non_negative}, cone.to_radius);
  if (keys.reading() && keys.given("from_radius") && keys.given("to_radius") && cone.from_radius == 0 &&
      cone.to_radius == 0) {
    keys.problem("to_radius", "both radii are 0; one greater than 0");
  }
}

namespace {

void describe_annulus(Keys& keys, dem::AnnulusRegion& annulus) {
  describe_axis(keys, annulus);
  keys.real({"inner_radius", "of the cylinder that is left out", Need::required},
            {dimension::length, range::positive}, annulus.inner_radius);
  keys.real({"outer_radius", "of the cylinder around it", Need::required},
            {dimension::length, range::positive}, annulus.outer_radius);
  if (keys.reading() && keys.given("inner_radius") && keys.given("outer_radius") &&
      annulus.outer_radius <= annulus.inner_radius) {
    keys.problem("outer_radius", "it is not beyond inner_radius; a larger one");
  }
}

void describe_fill(Keys& keys, FillSpec& fill) {
  if (keys.reading()) fill.where = keys.where();
  keys.section<Box>({"box", "the region is a box"}, fill.box, describe_box);
  keys.section<dem::CylinderRegion>({"cylinder", "the region is a cylinder"}, fill.cylinder,
                                    describe_cylinder);
  keys.section<dem::ConeRegion>({"cone", "the region is a cone, or a part of one cut off at right angles"},
                                fill.cone, describe_cone);
  keys.section<dem::AnnulusRegion>({"annulus", "the region is between two cylinders on the same axis"},
                                   fill.annulus, describe_annulus);
  keys.exactly_one({"box", "cylinder", "cone", "annulus"});
  keys.choice({"pattern", "how particles are placed"}, fill_patterns, fill.pattern);
  keys.real(
      {"solids_fraction", "as many particles as give this share of the region's volume; in place of count"},
      {dimension::pure_number, {.min = 0, .max = 0.74, .min_excluded = true}}, fill.solids_fraction);
}

void describe_disc(Keys& keys, dem::DiscRegion& disc) {
  keys.vector({"centre", "of the disc", Need::required}, {dimension::length}, disc.centre);
  keys.vector({"normal", "at right angles to it, of any length", Need::required}, {}, disc.normal);
  keys.real({"radius", "of the disc", Need::required}, {dimension::length, range::positive}, disc.radius);
  if (!keys.reading() || !keys.given("normal")) return;
  const Real length = norm(disc.normal);
  if (length == 0) keys.problem("normal", "it has no length; a direction such as [0, 0, 1]");
  // A normal of length 1 is kept to the bit, so that the resolved file reads back as it is.
  if (length > 0 && std::abs(length - 1) > 1e-15) disc.normal *= 1 / length;
}

void describe_feed(Keys& keys, FeedSpec& feed) {
  if (keys.reading()) feed.where = keys.where();
  keys.section<Box>({"box", "particles enter inside a box, or on it where it is flat"}, feed.box,
                    describe_flat_box);
  keys.section<dem::DiscRegion>({"disc", "particles enter with their centres on a disc"}, feed.disc,
                                describe_disc);
  keys.exactly_one({"box", "disc"});
  keys.real({"mass_rate", "mass that enters over time"}, {dimension::mass_flow_rate, range::positive},
            feed.mass_rate);
  keys.real({"rate", "particles that enter over time"}, {dimension::frequency, range::positive}, feed.rate);
  keys.exactly_one({"mass_rate", "rate"});
  keys.real({"from", "when it begins"}, {dimension::duration, range::non_negative}, feed.from);
  real_or_unset(keys, {"to", "when it ends", Need::has_default, "time.end"},
                {dimension::duration, range::positive}, feed.to);
}

void describe_listed(Keys& keys, ListedParticleSpec& particle) {
  keys.vector({"position", "of the centre", Need::required}, {dimension::length}, particle.position);
  keys.vector({"velocity", "initial", Need::has_default, "that of the population"}, {dimension::velocity},
              particle.velocity);
  keys.vector({"spin", "initial angular velocity", Need::has_default, "that of the population"},
              {dimension::angular_velocity}, particle.spin);
  real_or_unset(keys, {"diameter", "of this particle", Need::has_default, "that of the population"},
                {dimension::length, range::positive}, particle.diameter);
  keys.flag({"fixed", "whether it stays in place", Need::has_default, "that of the population"},
            particle.fixed);
}

/// How many particles a fill is to have is said in exactly one way.
void check_amount(Keys& keys, const PopulationSpec& population) {
  const int ways = (population.count ? 1 : 0) + (population.total_mass ? 1 : 0) +
                   (population.fill && population.fill->solids_fraction ? 1 : 0);
  if (population.fill) {
    if (ways != 1) {
      keys.problem(
          {}, fmt::format("{} of count, total_mass and fill.solids_fraction {} given; exactly one of them",
                          ways, ways == 1 ? "is" : "are"));
    }
    if (!keys.given("diameter")) {
      keys.problem("diameter", "missing; a fill needs a length greater than 0");
    }
  } else if (population.feed) {
    for (const auto* key : {"count", "total_mass"}) {
      if (keys.given(key)) keys.problem(key, "the rate of the feed says how many; only with fill");
    }
    if (population.fixed) keys.problem("fixed", "particles of a feed move; only with fill or list");
    if (!keys.given("diameter")) {
      keys.problem("diameter", "missing; a feed needs a length greater than 0");
    }
  } else {
    for (const auto* key : {"count", "total_mass"}) {
      if (keys.given(key)) keys.problem(key, "the list says how many; only with fill");
    }
    if (population.sizes) keys.problem("diameter", "particles of a list have no distribution; a length");
  }
}

void describe_diameter(Keys& keys, PopulationSpec& population) {
  std::optional<Real> diameter;
  if (population.diameter != 0) diameter = population.diameter;
  keys.real_or_section<SizesSpec>(
      {"diameter", "of each particle, or how the diameters of a fill are spread", Need::has_default,
       "required with fill and feed; else that of each particle"},
      {dimension::length, range::positive}, diameter, population.sizes, describe_sizes);
  if (diameter) population.diameter = *diameter;
}

void describe_population(Keys& keys, PopulationSpec& population, CaseSpec& spec) {
  if (keys.reading()) population.where = keys.where();
  material_key(keys, {"material", "one of materials", Need::required}, spec, population.material, false);
  keys.whole({"count", "number of particles of a fill"}, {}, population.count);
  keys.real({"total_mass", "mass of all particles of a fill, in place of count"},
            {dimension::mass, range::positive}, population.total_mass);
  describe_diameter(keys, population);
  keys.vector({"velocity", "initial"}, {dimension::velocity}, population.velocity);
  keys.vector({"spin", "initial angular velocity"}, {dimension::angular_velocity}, population.spin);
  keys.flag({"fixed", "stays in place, is felt by other particles and by the gas"}, population.fixed);
  keys.real({"initial_temperature", "with heat", Need::has_default, "heat.initial_temperature"},
            {dimension::temperature, range::positive}, population.initial_temperature);
  keys.real(
      {"initial_liquid", "with heat: liquid on a particle, over the particle's mass", Need::has_default, "0"},
      {dimension::pure_number, range::non_negative}, population.initial_liquid);
  keys.real({"initial_solids", "with heat: dry coating on a particle, over the particle's mass",
             Need::has_default, "0"},
            {dimension::pure_number, range::non_negative}, population.initial_solids);
  keys.section<FillSpec>({"fill", "a region to be filled"}, population.fill, describe_fill);
  keys.list<ListedParticleSpec>(
      {"list", "particles one by one; ids count them first, then those of fills, in the order of the file"},
      Size{1}, population.list, [&](Keys& inner, ListedParticleSpec& particle) {
        if (inner.reading()) {
          particle.velocity = population.velocity;
          particle.spin = population.spin;
          particle.diameter = population.diameter;
          particle.fixed = population.fixed;
        }
        describe_listed(inner, particle);
        if (inner.reading() && particle.diameter == 0) {
          inner.problem("diameter", "missing here and in the population; a length greater than 0");
        }
      });
  keys.section<FeedSpec>(
      {"feed", "particles that enter during the run; their ids go on from those of the start"},
      population.feed, describe_feed);
  keys.exactly_one({"fill", "list", "feed"});
  if (keys.reading()) check_amount(keys, population);
}

}  // namespace

void describe_particles(Keys& keys, CaseSpec& spec) {
  keys.list<PopulationSpec>(
      {"particles", "populations; without any the case is gas alone"}, {}, spec.particles,
      [&](Keys& inner, PopulationSpec& population) { describe_population(inner, population, spec); });
}

}  // namespace pellicle::tools
