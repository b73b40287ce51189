#include "tools/pellicle/case_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>

#include "core/time_control.hpp"
#include "tools/pellicle/model_families.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

namespace {

/// Largest solids fraction that a fill can reach: where spheres moved apart from random places nearly jam, and
/// lattices of touching spheres.
constexpr Real largest_fraction(dem::FillPattern pattern) {
  switch (pattern) {
    case dem::FillPattern::lattice:
      return std::numbers::pi / 6;
    case dem::FillPattern::random:
      return 0.60;
    case dem::FillPattern::hexagonal:
      return std::numbers::pi / (3 * std::numbers::sqrt2);
  }
  return 0;
}

class Checker {
 public:
  Checker(CaseSpec& spec, core::InputProblems& problems) : spec_(spec), problems_(problems) {}

  void check_all() {
    if (!spec_.gas && spec_.particles.empty()) {
      problems_.add(spec_.file + ":1", "there is nothing to simulate; particles, gas, or both");
      return;
    }
    check_names();
    if (!check_cell_counts()) return;  // what follows would make the grids
    check_steps();
    if (!spec_.particles.empty()) check_particles();
    check_sides();
    if (!spec_.particles.empty()) check_periodic_width();
    if (spec_.gas && !spec_.particles.empty()) check_coupling();
    for (const auto& nozzle : spec_.spray) check_nozzle(nozzle);
    if (spec_.droplets.two_way && !spec_.gas)
      problems_.add(spec_.where("droplets.momentum"), "there is no gas to push; one_way, or gas");
    for (const auto& line : spec_.output.lines) check_line(line);
    for (const auto& probe : spec_.output.probes) check_probe(probe);
    check_gas_average();
    for (const auto& field : spec_.output.snapshots.gas) {
      if (spec_.gas) check_carried(": output.snapshots", "gas", field);
    }
    for (const auto& field : spec_.output.snapshots.particles) {
      check_followed(": output.snapshots", "particles",
                     field == "temperature" ? std::string_view("particle_temperature") : field);
    }
    for (const auto& field : spec_.output.snapshots.spray) {
      if (field == "temperature" && !spec_.droplets.evaporation && !spec_.spray.empty())
        wrong(": output.snapshots", "spray",
              "temperature needs droplets.evaporation, which the case has not; another name");
    }
    for (const auto& histogram : spec_.output.histograms) {
      if (spec_.particles.empty())
        wrong(histogram.where, "quantity", "a case without particles has none; no histograms");
      check_followed(histogram.where, "quantity", histogram.quantity);
      if (histogram.against) check_followed(histogram.where, "against", *histogram.against);
    }
    for (const auto& zone : spec_.output.zones) {
      if (spec_.particles.empty())
        wrong(zone.where, "name", "a case without particles has none that pass; no zones");
    }
    for (const auto& wetness : spec_.output.wetness) {
      if (spec_.particles.empty() || !spec_.follows("film_liquid"))
        wrong(wetness.where, "name", "no particle of this case can be wet; heat or spray, or no wetness");
      if (wetness.measure == 1 && wetness.wettest > 1)
        wrong(wetness.where, "wettest", "no fraction is above 1; at most 1");
    }
    warn_of_unused();
  }

 private:
  /// Reports a key of the entry whose place is `where`.
  void wrong(const std::string& where, std::string_view key, const std::string& what) {
    problems_.add(spec_.where(fmt::format("{}.{}", path_of(where), key)), what);
  }
  void wrong_key(const std::string& path, const std::string& what) { problems_.add(spec_.where(path), what); }
  void warn(const std::string& path, const std::string& what) {
    spec_.warnings.push_back(spec_.where(path) + ": " + what);
  }
  static std::string path_of(const std::string& where) { return where.substr(where.rfind(": ") + 2); }
  static std::string text(const Vec3& v) { return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x, v.y, v.z); }
  std::string domain_text() const {
    return fmt::format("within {} to {} m", text(spec_.domain.box.min), text(spec_.domain.box.max));
  }
  bool inside(const Vec3& point) const {
    const Box& box = spec_.domain.box;
    for (int axis = 0; axis < 3; ++axis) {
      const Real slack = 1e-9 * (box.max[axis] - box.min[axis]);
      if (point[axis] < box.min[axis] - slack || point[axis] > box.max[axis] + slack) return false;
    }
    return true;
  }

  template <class Entry>
  void check_unique(const std::vector<Entry>& entries) {
    std::set<std::string> names;
    for (const auto& entry : entries) {
      if (!names.insert(entry.name).second) {
        wrong(entry.where, "name",
              fmt::format("another one is called {} already; a name of its own", entry.name));
      }
    }
  }

  void check_names() {
    check_unique(spec_.walls);
    if (spec_.gas) check_unique(spec_.gas->boundaries);
    check_unique(spec_.spray);
    check_unique(spec_.output.lines);
    check_unique(spec_.output.probes);
    check_unique(spec_.output.histograms);
    check_unique(spec_.output.zones);
    check_unique(spec_.output.wetness);
  }

  /// Cells are counted by an Index; says whether they can be.
  bool check_cell_counts() {
    bool good = true;
    const auto check = [&](const std::string& path, const GridSpec& grid) {
      const std::int64_t cells = std::int64_t{grid.cells.x} * grid.cells.y * grid.cells.z;
      if (cells <= std::numeric_limits<Index>::max()) return;
      wrong_key(path, fmt::format("{} cells; at most {}", cells, std::numeric_limits<Index>::max()));
      good = false;
    };
    if (spec_.gas) check("gas.grid", spec_.gas->grid);
    if (spec_.gas && !spec_.particles.empty()) check("coupling.transfer_grid", spec_.coupling.transfer_grid);
    return good;
  }

  void check_steps() {
    const TimeSpec& time = spec_.time;
    if (time.gas_step > time.end) {
      wrong_key("time.gas_step",
                fmt::format("{:g} s is longer than time.end {:g} s; at most that", time.gas_step, time.end));
    }
    if (!core::whole_multiple(time.gas_step, time.particle_step)) {
      wrong_key("time.particle_step",
                fmt::format("{:g} s does not divide the gas step of {:g} s; gas_step over a whole number",
                            time.particle_step, time.gas_step));
    }
    if (spec_.particles.empty()) return;
    const dem::TimeStepBound bound = particle_step_bound(spec_);
    if (time.particle_step <= bound.bound) return;
    const std::string what = fmt::format("{:g} s is over the bound of {:.3g} s ({})", time.particle_step,
                                         bound.bound, describe_bound(spec_, bound));
    if (time.allow_large_step) {
      warn("time.particle_step", what + ": contacts may blow up");
    } else {
      wrong_key("time.particle_step", what + "; at most the bound, or time.allow_large_step: true");
    }
  }

  void check_particles() {
    check_pairs();
    check_stiffness();
    check_cohesion();
    for (const auto& population : spec_.particles) {
      if (population.fill) check_fill(population);
      if (population.feed) check_feed(*population.feed);
      for (std::size_t i = 0; i < population.list.size(); ++i) check_listed(population, i);
    }
    const std::int64_t count = particle_count(spec_) + fed_count(spec_);
    if (count > std::numeric_limits<Index>::max()) {
      wrong_key("particles",
                fmt::format("they are {}; at most {}", count, std::numeric_limits<Index>::max()));
    }
  }

  void check_pairs() {
    std::set<std::pair<int, int>> given;
    for (const auto& pair : spec_.contacts.pairs) {
      const auto both = std::minmax(pair.material_a, pair.material_b);
      if (!given.insert(both).second) {
        wrong(pair.where, "between",
              fmt::format("{} and {} have a pair already; each pair once", material(both.first),
                          material(both.second)));
      }
    }
    const int materials = static_cast<int>(spec_.materials.size());
    for (int a = 0; a < materials; ++a) {
      for (int b = a; b < materials; ++b) {
        if (can_meet(spec_, a, b) && !given.contains({a, b})) {
          wrong_key("contacts.pairs",
                    fmt::format("no pair for {} and {}, which can meet; an entry with between: [{}, {}]",
                                material(a), material(b), material(a), material(b)));
        }
      }
    }
  }
  void check_stiffness() {
    constexpr std::string_view name = dem::Linear::info.name;
    if (spec_.contacts.normal == name) return;
    if (spec_.contacts.linear) {
      wrong_key("contacts.linear", fmt::format("the normal law is {}; only with contacts.model.normal: {}",
                                               spec_.contacts.normal, name));
    }
    for (const auto& pair : spec_.contacts.pairs) {
      if (!pair.normal_stiffness) continue;
      wrong(pair.where, "normal_stiffness",
            fmt::format("the normal law is {}; only with contacts.model.normal: {}", spec_.contacts.normal,
                        name));
    }
  }
  /// The fit of the bridge's force ends at a tenth of R_w³ (Willett et al. 2000).
  void check_cohesion() {
    if (!spec_.contacts.cohesion) return;
    const Real radius = diameter_range(spec_).smallest / 2;
    const Real largest = 0.1 * radius * radius * radius;
    const Real volume = spec_.contacts.cohesion->willett.bridge_volume;
    if (volume > largest) {
      wrong_key(
          "contacts.cohesion.bridge_volume",
          fmt::format(
              "{:.3g} m3 is too much for the smallest particles, which it would drown; at most {:.3g} m3, "
              "a tenth of R^3",
              volume, largest));
    }
  }
  const std::string& material(int index) const {
    return spec_.materials[static_cast<std::size_t>(index)].name;
  }

  void check_fill(const PopulationSpec& population) {
    const FillSpec& fill = *population.fill;
    const dem::FillRegion region = fill.region();
    const Box bounds = dem::region_bounds(region);
    if (!(inside(bounds.min) && inside(bounds.max))) {
      wrong(fill.where, fill.box ? "box" : (fill.cylinder ? "cylinder" : (fill.cone ? "cone" : "annulus")),
            "it reaches out of the domain; " + domain_text());
    }
    const std::int64_t count = particle_count(population);
    if (count < 1) {
      problems_.add(population.where,
                    "it comes to no particle at all; a mass or solids fraction of at least one particle");
      return;
    }
    Real volume = 0;
    for (const auto& other : spec_.particles) {
      const bool together = &other == &population || (other.fill && other.fill->mixes_with(fill));
      if (together) volume += static_cast<Real>(particle_count(other)) * mean_particle_volume(other);
    }
    const Real fraction = volume / dem::region_volume(region);
    const Real limit = largest_fraction(fill.pattern);
    if (fraction > limit) {
      problems_.add(
          fill.where,
          fmt::format("{} particles do not fit: {} would take {} the region's volume; at most {:.3g} % "
                      "with pattern {}",
                      count,
                      volume > 1.0001 * static_cast<Real>(count) * mean_particle_volume(population)
                          ? "with those of the same region they"
                          : "they",
                      fraction < 1 ? fmt::format("{:.3g} % of", 100 * fraction)
                                   : fmt::format("{:.3g} times", fraction),
                      100 * limit, fill_patterns[static_cast<std::size_t>(fill.pattern)].name));
    }
  }

  void check_nozzle(const NozzleSpec& nozzle) {
    if (spec_.particles.empty()) {
      wrong(nozzle.where, "name", "a case without particles has nothing to spray; particles, or no spray");
    }
    if (!inside(nozzle.position)) {
      wrong(nozzle.where, "position", text(nozzle.position) + " m is out of the domain; " + domain_text());
    }
    if (!(nozzle.to > nozzle.from)) {
      wrong(nozzle.where, "to",
            fmt::format("from {:g} to {:g} s is no time; later than from", nozzle.from, nozzle.to));
    }
    if (!nozzle.sizes) return;
    try {
      (void)dem::SizeSampler(*nozzle.sizes->distribution());  // throws here, not later
    } catch (const std::invalid_argument& error) {
      wrong(nozzle.where, "droplet_diameter",
            fmt::format("{}; a distribution with sizes between its bounds", error.what()));
    }
  }

  void check_feed(const FeedSpec& feed) {
    const Box bounds = feed.box ? *feed.box : dem::region_bounds(*feed.disc);
    if (!(inside(bounds.min) && inside(bounds.max))) {
      wrong(feed.where, feed.box ? "box" : "disc", "it reaches out of the domain; " + domain_text());
    }
    if (!(feed.to > feed.from)) {
      wrong(feed.where, "to",
            fmt::format("from {:g} to {:g} s is no time; later than from", feed.from, feed.to));
    }
  }

  void check_listed(const PopulationSpec& population, std::size_t i) {
    const std::string path = fmt::format("{}.list.{}", path_of(population.where), i);
    const Vec3& position = population.list[i].position;
    if (!inside(position)) {
      wrong_key(path + ".position",
                fmt::format("{} m is outside the domain; {}", text(position), domain_text()));
    }
    for (const auto& wall : spec_.walls) {
      if (wall.plane && dot(position - wall.plane->point, wall.plane->normal) <= 0) {
        wrong_key(path + ".position",
                  fmt::format("{} m is behind the wall {}; on the side its normal points to", text(position),
                              wall.name));
      }
    }
  }

  bool periodic(cfd::Side side) const {
    return spec_.domain.periodic[static_cast<std::size_t>(cfd::axis_of(side))];
  }

  /// Whether particles may leave there: without box walls through every side that does not repeat.
  bool open(cfd::Side side) const {
    const auto left_out = [&](const WallSpec& w) {
      return std::find(w.open.begin(), w.open.end(), side) != w.open.end();
    };
    const bool boxed =
        std::any_of(spec_.walls.begin(), spec_.walls.end(), [](const WallSpec& w) { return w.box; });
    return !periodic(side) && (!boxed || std::any_of(spec_.walls.begin(), spec_.walls.end(), left_out));
  }

  void check_sides() {
    for (const auto& wall : spec_.walls) {
      for (const cfd::Side side : wall.open) {
        if (periodic(side)) {
          wrong(wall.where, "open",
                fmt::format("{} is a periodic side, which has no wall; sides that are not periodic",
                            side_name(side)));
        }
      }
      if (!wall.box) continue;
      for (int axis = 0; axis < 3; ++axis) {
        if (wall.velocity[axis] == 0 || spec_.domain.periodic[static_cast<std::size_t>(axis)]) continue;
        for (const cfd::Side side :
             {static_cast<cfd::Side>(2 * axis), static_cast<cfd::Side>(2 * axis + 1)}) {
          if (std::find(wall.open.begin(), wall.open.end(), side) == wall.open.end()) {
            wrong(wall.where, "velocity",
                  fmt::format("it leads through the {} side; a velocity along all closed sides, or a plane",
                              side_name(side)));
            break;
          }
        }
      }
    }
    if (!spec_.gas) return;
    for (const auto& patch : spec_.gas->boundaries) {
      if (patch.wall) {
        check_boundary_wall(patch);
        continue;
      }
      if (periodic(patch.on)) {
        wrong(patch.where, "on",
              fmt::format("{} is a periodic side; sides that are not periodic", side_name(patch.on)));
      }
      if (patch.region && !(inside(patch.region->min) && inside(patch.region->max))) {
        wrong(patch.where, "region", "it reaches out of the domain; " + domain_text());
      }
      if (patch.disc && std::holds_alternative<cfd::Inlet>(patch.kind)) check_inlet_disc(patch);
    }
  }
  /// A disc may be cut by a plane of symmetry. Else what lies beyond the domain would bring in no gas, unsaid.
  void check_inlet_disc(const cfd::BoundaryPatch& patch) {
    const auto mirrors = [&](cfd::Side side) {
      return std::any_of(spec_.gas->boundaries.begin(), spec_.gas->boundaries.end(), [&](const auto& other) {
        return !other.wall && other.on == side && std::holds_alternative<cfd::Symmetry>(other.kind);
      });
    };
    const Box& box = spec_.domain.box;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == cfd::axis_of(patch.on)) continue;
      const Real slack = 1e-9 * (box.max[axis] - box.min[axis]);
      const Real centre = patch.disc->centre[axis], radius = patch.disc->radius;
      for (const bool upper : {false, true}) {
        const auto side = static_cast<cfd::Side>(2 * axis + (upper ? 1 : 0));
        const Real beyond = upper ? centre + radius - box.max[axis] : box.min[axis] - (centre - radius);
        const bool middle_is_out = upper ? centre > box.max[axis] + slack : centre < box.min[axis] - slack;
        if (beyond <= slack || (mirrors(side) && !middle_is_out)) continue;
        wrong(patch.where, "region.disc",
              fmt::format("it reaches {:.4g} m beyond the {} side of the domain; a disc {}, or a plane of "
                          "symmetry on that side with its centre in the domain",
                          beyond, side_name(side), domain_text()));
      }
    }
  }
  /// A wall that is a boundary is one that the gas sees, and no other boundary.
  void check_boundary_wall(const cfd::BoundaryPatch& patch) {
    const auto wall = std::find_if(spec_.walls.begin(), spec_.walls.end(),
                                   [&](const WallSpec& w) { return w.name == *patch.wall; });
    std::string names;
    for (const auto& w : spec_.walls) {
      if (!w.box && w.gas != GasWall::open) names += (names.empty() ? "" : ", ") + w.name;
    }
    const std::string allowed = names.empty() ? "the case has none that fits" : names;
    if (wall == spec_.walls.end()) {
      wrong(patch.where, "on_wall", fmt::format("no wall \"{}\"; {}", *patch.wall, allowed));
      return;
    }
    if (wall->box) {
      wrong(patch.where, "on_wall",
            fmt::format("\"{}\" is the sides of the domain; on: SIDE, or {}", *patch.wall, allowed));
    } else if (wall->gas == GasWall::open) {
      wrong(patch.where, "on_wall",
            fmt::format("the gas passes \"{}\" (gas: open), it does not see it; {}", *patch.wall, allowed));
    } else if (!std::holds_alternative<cfd::NoSlip>(patch.kind) && wall->gas == GasWall::free_slip) {
      wrong(
          patch.where, "on_wall",
          fmt::format("\"{}\" says with gas: free_slip what it is to the gas; one of the two", *patch.wall));
    }
    const bool twice =
        std::any_of(spec_.gas->boundaries.begin(), spec_.gas->boundaries.end(),
                    [&](const auto& other) { return &other < &patch && other.wall == patch.wall; });
    if (twice)
      wrong(patch.where, "on_wall", fmt::format("\"{}\" is a boundary already; another wall", *patch.wall));
  }

  static std::string_view side_name(cfd::Side side) {
    return domain_sides[static_cast<std::size_t>(side)].name;
  }

  void check_periodic_width() {
    const Real least = least_periodic_width(spec_);
    for (int axis = 0; axis < 3; ++axis) {
      const Real length = spec_.domain.box.max[axis] - spec_.domain.box.min[axis];
      if (spec_.domain.periodic[static_cast<std::size_t>(axis)] && length < least) {
        wrong_key("domain.periodic", fmt::format("the domain is {:.3g} m wide along {}, too narrow for these "
                                                 "particles to be periodic; at least {:.3g} m",
                                                 length, "xyz"[axis], least));
      }
    }
  }

  void check_coupling() {
    check_transfer_grid();
    // Beyond this the carried momentum grows (docs/theory/coupling.md).
    const Real least = spec_.coupling.minimum_void_fraction;
    const Real limit = std::min(1.0, 2 / (1 + 2 * (1 - least) / least));
    if (!(spec_.coupling.pending_release < limit)) {
      wrong_key("coupling.pending_release",
                fmt::format("{:g} is unstable with minimum_void_fraction {:g}; less than {:.4g}",
                            spec_.coupling.pending_release, least, limit));
    }
  }

  void check_transfer_grid() {
    const CartesianGrid grid = make_grid(spec_.coupling.transfer_grid, spec_.domain);
    const Real diameter = diameter_range(spec_).largest;
    for (int axis = 0; axis < 3; ++axis) {
      Real narrowest = grid.width(axis, 0);
      for (Index i = 1; i < grid.cells()[axis]; ++i) narrowest = std::min(narrowest, grid.width(axis, i));
      if (narrowest < diameter) {
        warn("coupling.transfer_grid", fmt::format("cells of {:.3g} m along {} are smaller than a particle "
                                                   "of {:.3g} m: the void fraction will be "
                                                   "ragged",
                                                   narrowest, "xyz"[axis], diameter));
      }
    }
  }

  /// A quantity can be shown only if what it belongs to is there.
  void check_quantity(const std::string& where, std::string_view key, const std::string& name) {
    const bool of_gas = core::find_model(gas_quantities, name) >= 0;
    if (of_gas && !spec_.gas)
      wrong(where, key,
            fmt::format("{} needs gas, which the case has not; {}", name,
                        core::allowed_names(particle_quantities)));
    if (of_gas && spec_.gas) check_carried(where, key, name);
    if (!of_gas) check_followed(where, key, name);
    if (!of_gas && spec_.particles.empty()) {
      wrong(where, key,
            fmt::format("{} needs particles, which the case has not; {}", name,
                        core::allowed_names(gas_quantities)));
    }
  }

  /// Temperature, film and hits of particles are there only with heat or spray.
  void check_followed(const std::string& where, std::string_view key, std::string_view name) {
    if (spec_.follows(name)) return;
    const bool of_heat = name.starts_with("particle_temperature");
    const bool of_spray = name == "hits" || name.ends_with("hit_time");
    wrong(where, key,
          fmt::format("{} needs {}, which the case has not; another name", name,
                      name.starts_with("wall_heat") ? "heat.contact_conduction"
                      : of_heat                     ? "heat"
                      : of_spray                    ? "spray"
                                                    : "heat or spray"));
  }

  /// Temperature and moisture are there only if the gas has them.
  void check_carried(const std::string& where, std::string_view key, const std::string& name) {
    const bool warm = name == "gas_temperature" || name == "temperature" || name == "relative_humidity";
    const bool moist = name == "vapour_mass_fraction" || name == "relative_humidity";
    if (warm && !spec_.gas->heat) {
      wrong(where, key, fmt::format("{} needs a temperature of the gas; gas.heat, or another name", name));
    }
    if (moist && !spec_.gas->moisture) {
      wrong(where, key, fmt::format("{} needs moisture of the gas; gas.moisture, or another name", name));
    }
    if (is_turbulent_quantity(name) && !spec_.gas->options.turbulence) {
      wrong(where, key,
            fmt::format("{} needs a model of turbulence; gas.turbulence: k_epsilon, or another name", name));
    }
  }

  void check_line(const LineSpec& line) {
    if (!inside(line.from))
      wrong(line.where, "from",
            fmt::format("{} m is outside the domain; {}", text(line.from), domain_text()));
    if (!inside(line.to))
      wrong(line.where, "to", fmt::format("{} m is outside the domain; {}", text(line.to), domain_text()));
    check_quantity(line.where, "quantity", line.quantity);
    const Vec3 along = line.to - line.from;
    if (line.depth_average && std::abs(along[*line.depth_average]) > 1e-9 * norm(along)) {
      wrong(line.where, "depth_average",
            "the line runs along that direction; one at right angles to the line");
    }
    check_window(spec_.where(path_of(line.where) + ".average"), line.average);
  }

  /// Of an average whose key is at `where`.
  void check_window(const std::string& where, const WindowSpec& window) {
    if (!(window.to > window.from)) {
      problems_.add(
          where, fmt::format("from {:g} to {:g} s is no time; to later than from", window.from, window.to));
    } else if (window.from >= spec_.time.end) {
      problems_.add(where, fmt::format("it begins at {:g} s, after the end of the run; before {:g} s",
                                       window.from, spec_.time.end));
    }
  }

  void check_gas_average() {
    if (!spec_.output.average) return;
    check_window(spec_.where("output.average"), spec_.output.average->window);
    if (!spec_.gas) {
      wrong_key("output.average", "it averages the gas, which the case has not; no average");
      return;
    }
    for (const auto& field : spec_.output.average->gas) check_carried(": output.average", "gas", field);
  }

  void check_plane(const ProbeSpec& probe) {
    const PlaneProbeSpec& plane = *probe.plane;
    if (!spec_.gas)
      wrong(probe.where, "plane", "a plane shows the gas, which the case has not; particle or bed");
    const Box& box = spec_.domain.box;
    const Real low = box.min[plane.axis];
    const Real high = box.max[plane.axis];
    const Real slack = 1e-9 * (high - low);
    if (plane.at < low - slack || plane.at > high + slack) {
      wrong(probe.where, "plane.at",
            fmt::format("{:g} m is outside the domain; {:g} to {:g} m", plane.at, low, high));
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == plane.axis) continue;
      const bool misses_box =
          plane.box && !(plane.box->min[axis] < box.max[axis] && plane.box->max[axis] > box.min[axis]);
      const bool misses_disc =
          plane.disc && (plane.disc->centre[axis] + plane.disc->radius <= box.min[axis] ||
                         plane.disc->centre[axis] - plane.disc->radius >= box.max[axis]);
      if (!misses_box && !misses_disc) continue;
      wrong(probe.where, misses_box ? "plane.box" : "plane.disc",
            fmt::format("it has no part in the domain along {}; {}", "xyz"[axis], domain_text()));
      return;
    }
  }

  void check_probe(const ProbeSpec& probe) {
    if (probe.average) {
      check_window(spec_.where(path_of(probe.where) + ".average"), *probe.average);
      const std::string file = probe.name + "_average";
      if (std::any_of(spec_.output.probes.begin(), spec_.output.probes.end(),
                      [&](const ProbeSpec& other) { return other.name == file; })) {
        wrong(probe.where, "average", fmt::format("a probe is called {}, as its file; another name", file));
      }
    }
    if (probe.particle) {
      for (const auto& name : probe.quantities) check_followed(probe.where, "quantities", name);
    }
    if (probe.point) {
      if (!spec_.gas)
        wrong(probe.where, "point", "a point shows the gas, which the case has not; particle or bed");
      if (!inside(*probe.point)) {
        wrong(probe.where, "point",
              fmt::format("{} m is outside the domain; {}", text(*probe.point), domain_text()));
      }
      for (const auto& name : probe.quantities) {
        if (spec_.gas) check_carried(probe.where, "quantities", name);
      }
    } else if (probe.plane) {
      check_plane(probe);
      for (const auto& name : probe.quantities) {
        if (spec_.gas) check_carried(probe.where, "quantities", name);
      }
    } else if (spec_.particles.empty() && !(probe.wall && spec_.gas)) {
      wrong(probe.where,
            probe.bed       ? "bed"
            : probe.coating ? "coating"
                            : (probe.wall ? "wall" : (probe.side ? "side" : "particle")),
            "the case has no particles; point or plane");
    } else if (probe.coating && !spec_.follows("film_solids")) {
      wrong(probe.where, "coating", "nothing coats particles in this case; heat or spray, or bed");
    } else if (probe.side && !open(static_cast<cfd::Side>(*probe.side))) {
      wrong(probe.where, "side",
            fmt::format("nothing can leave through {}; a side that is named in open of the box of walls",
                        side_name(static_cast<cfd::Side>(*probe.side))));
    } else if (probe.wall && std::none_of(spec_.walls.begin(), spec_.walls.end(),
                                          [&](const WallSpec& w) { return w.name == *probe.wall; })) {
      std::string names;
      for (const auto& wall : spec_.walls) names += (names.empty() ? "" : ", ") + wall.name;
      wrong(probe.where, "wall",
            fmt::format("no wall \"{}\"; {}", *probe.wall, names.empty() ? "the case has none" : names));
    } else if (probe.wall) {
      check_wall_quantities(probe);
    } else if (probe.particle && *probe.particle >= particle_count(spec_) + fed_count(spec_)) {
      wrong(probe.where, "particle",
            fmt::format("there is no particle {}; 0 to {}", *probe.particle,
                        particle_count(spec_) + fed_count(spec_) - 1));
    }
  }

  /// Forces of particles need particles, those of the gas a wall that it sees.
  void check_wall_quantities(const ProbeSpec& probe) {
    const auto wall = std::find_if(spec_.walls.begin(), spec_.walls.end(),
                                   [&](const WallSpec& w) { return w.name == *probe.wall; });
    const bool is_seen = spec_.gas && (wall->box || wall->gas != GasWall::open);
    for (const auto& name : probe.quantities) {
      const bool of_gas = name.starts_with("gas_force");
      const bool of_heat = name.starts_with("wall_heat");
      if (of_heat) check_followed(probe.where, "quantities", name);
      if (of_heat && spec_.follows(name) && !wall->temperature) {
        wrong(probe.where, "quantities",
              fmt::format("{} needs a wall with a temperature; another wall or quantity", name));
      }
      if (of_gas && !is_seen) {
        wrong(probe.where, "quantities",
              fmt::format("{} needs a wall that the gas sees; another wall or quantity", name));
      }
      if (!of_gas && spec_.particles.empty()) {
        wrong(probe.where, "quantities",
              fmt::format("{} needs particles, which the case has not; gas_force_x, gas_force_y, gas_force_z",
                          name));
      }
    }
  }

  /// Keys that say nothing in this case.
  void warn_of_unused() {
    const auto given = [&](const std::string& path) { return spec_.lines.contains(path); };
    const auto unused = [&](const std::string& path, std::string_view why) {
      if (given(path)) warn(path, fmt::format("of no use: the case has no {}", why));
    };
    if (spec_.spray.empty()) {
      unused("output.snapshots.spray", "spray");
      unused("droplets", "spray");
    }
    if (spec_.particles.empty()) {
      if (!spec_.gas) unused("walls", "particles and no gas");
      for (const auto* path : {"time.particle_step", "time.impact_speed", "time.settle", "materials",
                               "contacts", "coupling", "output.snapshots.particles"}) {
        unused(path, "particles");
      }
    } else if (!spec_.gas) {
      unused("time.courant", "gas");
      unused("coupling", "gas");
      unused("output.snapshots.gas", "gas");
    }
  }

  CaseSpec& spec_;
  core::InputProblems& problems_;
};

}  // namespace

void check_case(CaseSpec& spec, core::InputProblems& problems) {
  Checker(spec, problems).check_all();
  check_heat(spec, problems);
}

}  // namespace pellicle::tools
