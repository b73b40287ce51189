// Keys of what a run writes.
#include <fmt/format.h>

#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/model_families.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

namespace {

using core::Keys;
using core::Need;
using core::Size;
using core::TextRule;
namespace dimension = core::dimension;
namespace range = core::range;

constexpr core::RealRule interval{dimension::duration, range::non_negative};

void describe_snapshots(Keys& keys, SnapshotSpec& snapshots) {
  keys.real({"every", "0: none"}, interval, snapshots.every);
  keys.choices({"particles", "fields of particles.h5, besides the position"}, particle_snapshot_fields, {},
               snapshots.particles);
  keys.choices({"spray", "fields of spray.h5, besides the position; an empty list: no spray.h5"},
               spray_snapshot_fields, {}, snapshots.spray);
  keys.choices({"gas", "fields of gas.h5"}, gas_snapshot_fields, {}, snapshots.gas);
}

void describe_window(Keys& keys, WindowSpec& window) {
  keys.real({"from", "start"}, interval, window.from);
  real_or_unset(keys, {"to", "end", Need::has_default, "time.end"}, {dimension::duration, range::positive},
                window.to);
}

void describe_gas_average(Keys& keys, GasAverageSpec& average) {
  describe_window(keys, average.window);
  keys.choices({"gas", "fields of gas_average.h5, of each its mean and the RMS of the fluctuation about it"},
               gas_snapshot_fields, Size{1}, average.gas);
}

void describe_line(Keys& keys, LineSpec& line) {
  if (keys.reading()) line.where = keys.where();
  keys.text({"name", "of the file lines/NAME.csv", Need::required}, TextRule::name, line.name);
  keys.vector({"from", "where it starts", Need::required}, {dimension::length}, line.from);
  keys.vector({"to", "where it ends", Need::required}, {dimension::length}, line.to);
  if (keys.reading() && keys.given("from") && keys.given("to") && line.from == line.to) {
    keys.problem("to", "it is the same point as from; the other end of the line");
  }
  std::optional<Index> points;
  if (line.points > 0) points = line.points;
  keys.whole({"points", "number of bins along the line", Need::required}, {1, 1'000'000}, points);
  if (points) line.points = *points;
  keys.choice(
      {"depth_average", "direction in which bins reach through the whole domain", Need::has_default, "none"},
      axes, line.depth_average);
  real_or_unset(keys,
                {"thickness", "size of a bin across the line", Need::has_default,
                 "one gas cell; without gas, length / points"},
                {dimension::length, range::positive}, line.thickness);
  std::optional<int> quantity;
  if (!line.quantity.empty()) quantity = core::find_model(line_quantities, line.quantity);
  keys.choice({"quantity", "what is averaged", Need::required}, line_quantities, quantity);
  if (quantity) line.quantity = line_quantities[static_cast<std::size_t>(*quantity)].name;
  keys.section<WindowSpec>({"average", "time over which samples are taken, one every gas step"}, line.average,
                           describe_window);
}

void describe_plane_probe(Keys& keys, PlaneProbeSpec& plane) {
  static constexpr core::ModelInfo weights[] = {
      {"area", "each part of the plane counts by its open area"},
      {"flow", "by the gas that passes it, which back flow lowers"}};
  std::optional<int> axis = plane.axis;
  if (keys.reading()) axis.reset();
  keys.choice({"axis", "at right angles to the plane", Need::required}, axes, axis);
  if (axis) plane.axis = *axis;
  keys.real({"at", "coordinate of the plane along the axis", Need::required}, {dimension::length}, plane.at);
  keys.section<Box>({"box", "the part of the plane inside this box", Need::has_default, "the whole plane"},
                    plane.box, describe_flat_box);
  keys.section<PlaneProbeSpec::Disc>(
      {"disc", "the part of the plane within a circle", Need::has_default, "the whole plane"}, plane.disc,
      [](Keys& inner, PlaneProbeSpec::Disc& disc) {
        inner.vector({"centre", "of the circle", Need::required}, {dimension::length}, disc.centre);
        inner.real({"radius", "of the circle", Need::required}, {dimension::length, range::positive},
                   disc.radius);
      });
  if (keys.reading() && plane.box && plane.disc) keys.problem("disc", "there is a box too; one of the two");
  std::optional<int> weight = plane.by_flow ? 1 : 0;
  keys.choice({"mean", "how quantities of the gas are averaged"}, weights, weight);
  plane.by_flow = *weight == 1;
}

void describe_probe(Keys& keys, ProbeSpec& probe) {
  if (keys.reading()) probe.where = keys.where();
  keys.text({"name", "of the file probes/NAME.csv", Need::required}, TextRule::name, probe.name);
  keys.vector({"point", "gas at this point"}, {dimension::length}, probe.point);
  keys.section<PlaneProbeSpec>({"plane", "gas over a plane across an axis, or a part of it"}, probe.plane,
                               describe_plane_probe);
  keys.whole({"particle", "one particle by its id"}, {0}, probe.particle);
  keys.text({"wall", "forces of particles and gas on the wall of this name"}, TextRule::name, probe.wall);
  keys.choice({"side", "particles that leave through this open side"}, domain_sides, probe.side);
  keys.mark({"bed", "all particles together"}, probe.bed);
  keys.mark({"coating", "film and coating of all particles together"}, probe.coating);
  keys.exactly_one({"point", "plane", "particle", "wall", "side", "bed", "coating"});
  std::optional<std::vector<int>> positions;
  if (!probe.quantities.empty()) {
    positions.emplace();
    for (const auto& name : probe.quantities) positions->push_back(core::find_model(probe_quantities, name));
  }
  keys.choices({"quantities", "columns of the file", Need::has_default, "all that fit"}, probe_quantities,
               Size{1}, positions);
  keys.real({"every", "time between two rows"}, {dimension::duration, range::positive}, probe.every);
  keys.section<WindowSpec>(
      {"average",
       "time over which mean, RMS, smallest and largest of each column are formed, from every gas step"},
      probe.average, describe_window);
  if (!keys.reading()) return;
  const core::ModelList allowed = quantities_of(probe);
  probe.quantities.clear();
  if (!positions) return;  // filled in when all has been read
  for (const int position : *positions) {
    const auto name = probe_quantities[static_cast<std::size_t>(position)].name;
    probe.quantities.emplace_back(name);
    if (core::find_model(allowed, name) < 0) {
      keys.problem("quantities",
                   fmt::format("{} does not fit this kind of probe; {}", name, core::allowed_names(allowed)));
    }
  }
}

void describe_histogram(Keys& keys, HistogramSpec& histogram) {
  static constexpr core::ModelInfo weights[] = {{"number", "each particle counts the same"},
                                                {"mass", "each particle counts by its mass"}};
  if (keys.reading()) histogram.where = keys.where();
  keys.text({"name", "of the file histograms/NAME.csv", Need::required}, TextRule::name, histogram.name);
  std::optional<int> quantity;
  if (!histogram.quantity.empty()) quantity = core::find_model(particle_quantities, histogram.quantity);
  keys.choice({"quantity", "of each particle", Need::required}, particle_quantities, quantity);
  if (quantity) histogram.quantity = particle_quantities[static_cast<std::size_t>(*quantity)].name;
  keys.whole({"bins", "number of bins"}, {1, 100'000}, histogram.bins);
  keys.real({"min", "lower end of the first bin, SI", Need::has_default, "smallest value"}, {},
            histogram.min);
  keys.real({"max", "upper end of the last bin, SI", Need::has_default, "largest value"}, {}, histogram.max);
  std::optional<int> weight = histogram.by_mass ? 1 : 0;
  keys.choice({"weight", "what a particle counts"}, weights, weight);
  histogram.by_mass = *weight == 1;
  std::optional<int> against;
  if (histogram.against) against = core::find_model(particle_quantities, *histogram.against);
  keys.choice({"against", "a second quantity: the joint distribution of the two"}, particle_quantities,
              against);
  if (against) histogram.against = particle_quantities[static_cast<std::size_t>(*against)].name;
  keys.whole({"against_bins", "number of bins of the second quantity"}, {1, 10'000}, histogram.against_bins);
  keys.real({"against_min", "lower end of its first bin, SI", Need::has_default, "smallest value"}, {},
            histogram.against_min);
  keys.real({"against_max", "upper end of its last bin, SI", Need::has_default, "largest value"}, {},
            histogram.against_max);
  keys.real({"every", "time between two histograms; 0: only at the end"}, interval, histogram.every);
  if (keys.reading() && histogram.min && histogram.max && !(*histogram.max > *histogram.min)) {
    keys.problem("max", "it is not above min; a larger number");
  }
  if (!keys.reading()) return;
  if (histogram.against_min && histogram.against_max && !(*histogram.against_max > *histogram.against_min)) {
    keys.problem("against_max", "it is not above against_min; a larger number");
  }
  for (const char* key : {"against_min", "against_max"}) {
    if (keys.given(key) && !histogram.against && !keys.given("against"))
      keys.problem(key, "there is no second quantity; against as well");
  }
}

void describe_zone(Keys& keys, ZoneSpec& zone) {
  if (keys.reading()) zone.where = keys.where();
  keys.text({"name", "of the files zones/NAME.csv and others", Need::required}, TextRule::name, zone.name);
  keys.section<Box>({"box", "the zone is a box"}, zone.box, describe_box);
  keys.section<dem::CylinderRegion>({"cylinder", "the zone is a cylinder"}, zone.cylinder, describe_cylinder);
  keys.exactly_one({"box", "cylinder"});
  keys.real({"every", "time between two rows; 0: only at the end"}, interval, zone.every);
  keys.real({"shortest_absence", "a particle that is away for less has not left"}, interval,
            zone.shortest_absence);
  real_or_unset(keys,
                {"longest_time", "upper end of the distributions of cycle and residence times",
                 Need::has_default, "time.end"},
                {dimension::duration, range::positive}, zone.longest_time);
  keys.whole({"bins", "of these distributions"}, {1, 10'000}, zone.bins);
  keys.whole({"size_classes", "of equal width in diameter, for the sums in zones/NAME_groups.csv"}, {1, 100},
             zone.size_classes);
}

void describe_wetness(Keys& keys, WetnessSpec& wetness) {
  static constexpr core::ModelInfo samples[] = {
      {"gas_step",
       "contacts that began in the last particle step of each gas step; each counts for all particle steps "
       "of it"},
      {"particle_step", "all contacts; costs another search for pairs every particle step"}};
  if (keys.reading()) wetness.where = keys.where();
  keys.text({"name", "of the file histograms/NAME_wetness.csv", Need::required}, TextRule::name,
            wetness.name);
  keys.section<Box>({"box", "contacts in a box"}, wetness.box, describe_box);
  keys.section<dem::CylinderRegion>({"cylinder", "contacts in a cylinder"}, wetness.cylinder,
                                    describe_cylinder);
  keys.exactly_one({"box", "cylinder"});
  std::optional<int> measure = wetness.measure;
  keys.choice({"measure", "of the wetter of the two particles"}, wetness_measures, measure);
  wetness.measure = *measure;
  real_or_unset(keys,
                {"wettest", "upper end of the bins of wetness, SI; wetter ones are in one more",
                 Need::has_default, "0.02 kg/m2, or 1"},
                {.range = range::positive}, wetness.wettest);
  keys.whole({"bins", "of wetness; contacts of dry particles are in one more"}, {1, 10'000}, wetness.bins);
  keys.real({"fastest", "upper end of the bins of impact speed; faster ones are in one more"},
            {dimension::velocity, range::positive}, wetness.fastest);
  keys.whole({"speed_bins", "of impact speed"}, {1, 10'000}, wetness.speed_bins);
  std::optional<int> sample = wetness.sample;
  keys.choice({"sample", "which contacts are looked at"}, samples, sample);
  wetness.sample = *sample;
  keys.real({"every", "time between two histograms, each of all contacts so far; 0: only at the end"},
            interval, wetness.every);
}

}  // namespace

core::ModelList quantities_of(const ProbeSpec& probe) {
  if (probe.point) return gas_quantities;
  if (probe.plane) return plane_probe_quantities;
  if (probe.particle) return particle_quantities;
  if (probe.wall) return wall_quantities;
  if (probe.side) return side_quantities;
  if (probe.coating) return coating_quantities;
  return bed_quantities;
}

void describe_output(Keys& keys, CaseSpec& spec) {
  keys.section<OutputSpec>(
      {"output", "what is written to the results folder, besides summary.json"}, spec.output,
      [](Keys& inner, OutputSpec& output) {
        inner.section<OutputSpec>({"checkpoint", "state from which a run can go on"}, output,
                                  [](Keys& k, OutputSpec& o) {
                                    k.real({"every", "simulated time between two; 0: only at the end"},
                                           interval, o.checkpoint_every);
                                  });
        inner.section<SnapshotSpec>({"snapshots", "fields over time, for ParaView"}, output.snapshots,
                                    describe_snapshots);
        inner.section<GasAverageSpec>(
            {"average", "time averages of fields of the gas, cell by cell, from every gas step"},
            output.average, describe_gas_average);
        inner.list<LineSpec>({"lines", "time-averaged profiles along lines"}, {}, output.lines,
                             describe_line);
        inner.list<ProbeSpec>({"probes",
                               "values over time at points, over planes, of single "
                               "particles, of walls, of open sides, of the bed, of its coating"},
                              {}, output.probes, describe_probe);
        inner.list<HistogramSpec>({"histograms", "distributions over the particles"}, {}, output.histograms,
                                  describe_histogram);
        inner.list<ZoneSpec>({"zones", "where passing particles are followed: cycle and residence times"}, {},
                             output.zones, describe_zone);
        inner.list<WetnessSpec>(
            {"wetness", "regions in which contacts are counted by how wet and how fast they begin"}, {},
            output.wetness, describe_wetness);
      });
}

}  // namespace pellicle::tools
