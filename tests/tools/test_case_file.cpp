#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <variant>

#include "core/error.hpp"
#include "core/key_catalogue.hpp"
#include "tests/tools/cases_for_tests.hpp"
#include "tools/pellicle/build_case.hpp"
#include "tools/pellicle/case_checks.hpp"
#include "tools/pellicle/case_file.hpp"
#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/commands.hpp"
#include "tools/pellicle/model_families.hpp"

namespace {

using namespace pellicle;
using namespace pellicle::tools;
using namespace pellicle::tests;

/// What is wrong with a case after overrides; one line each.
std::string errors(const char* text, const std::vector<std::string>& overrides) {
  try {
    parse_case(text, "c.yaml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}
/// `c.yaml:line` of the first line of the bed that holds the text.
std::string at(const std::string& text) {
  const std::string bed(spouted_bed_case);
  const auto found = bed.find(text);
  EXPECT_NE(found, std::string::npos) << text;
  const auto end = bed.begin() + static_cast<std::ptrdiff_t>(std::min(found, bed.size()));
  return "c.yaml:" + std::to_string(1 + std::count(bed.begin(), end, '\n'));
}
std::string bed_errors(const std::string& assignment) { return errors(spouted_bed_case, {assignment}); }
std::string pair_errors(const std::string& assignment) { return errors(two_particles_case, {assignment}); }

TEST(CaseFile, ReadsTheBed) {
  const CaseSpec spec = parse_case(spouted_bed_case, "c.yaml");
  EXPECT_EQ(spec.title, "a bed, with everything");
  EXPECT_EQ(spec.seed, 42u);
  EXPECT_EQ(spec.domain.box.max.x, 0.04);
  EXPECT_TRUE(spec.domain.periodic[1]);
  EXPECT_EQ(spec.gravity.x, 0.1);
  EXPECT_EQ(spec.time.substeps(), 20);
  EXPECT_EQ(spec.time.impact_speed, 3);
  ASSERT_EQ(spec.materials.size(), 3u);
  EXPECT_EQ(spec.materials[0].name, "glass");
  EXPECT_EQ(spec.materials[0].density, 2500);
  EXPECT_EQ(spec.materials[2].name, "acrylic");
  EXPECT_TRUE(spec.materials[2].rigid);
  EXPECT_EQ(spec.walls[0].open, (std::vector{cfd::Side::z_max, cfd::Side::x_max}));
  EXPECT_EQ(spec.walls[1].plane->normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(spec.walls[1].material, 1);
  EXPECT_EQ(spec.contacts.rolling, "none");
  EXPECT_FALSE(spec.contacts.clip);
  EXPECT_EQ(spec.contacts.pairs[1].material_a, 2);
  EXPECT_EQ(spec.contacts.pairs[1].material_b, 0);
  EXPECT_EQ(*spec.particles[0].count, 100);
  EXPECT_EQ(spec.particles[0].fill->pattern, dem::FillPattern::lattice);
  EXPECT_EQ(*spec.particles[1].total_mass, 0.001);
  EXPECT_EQ(spec.particles[1].fill->cylinder->radius, 0.005);
  // Listed particles take from their population what they do not say.
  EXPECT_FALSE(spec.particles[3].list[0].fixed);
  EXPECT_TRUE(spec.particles[3].list[1].fixed);
  EXPECT_EQ(spec.gas->options.viscosity, 1.8e-5);
  EXPECT_EQ(spec.gas->options.gravity.x, 0.1);
  EXPECT_EQ(spec.gas->options.body_force.z, 5);
  EXPECT_EQ(spec.gas->options.convection, cfd::Convection::upwind);
  EXPECT_EQ(spec.gas->options.solver.pressure_solver, cfd::PressureSolver::amgcl);
  const auto& patches = spec.gas->boundaries;
  EXPECT_EQ(*std::get<cfd::Inlet>(patches[0].kind).velocity, 10);
  EXPECT_EQ(patches[0].region->max.x, 0.025);
  EXPECT_DOUBLE_EQ(*std::get<cfd::Inlet>(patches[1].kind).flow_rate, 1.0 / 3600);
  EXPECT_FALSE(patches[1].region.has_value());
  EXPECT_EQ(std::get<cfd::NoSlip>(patches[2].kind).velocity.z, 1);
  EXPECT_TRUE(std::holds_alternative<cfd::Symmetry>(patches[3].kind));
  EXPECT_TRUE(std::holds_alternative<cfd::FreeSlip>(patches[4].kind));
  EXPECT_EQ(std::get<cfd::Outlet>(patches[5].kind).pressure, 1000);
  EXPECT_EQ(patches[5].where, at("name: top") + ": gas.boundaries.top");
  EXPECT_EQ(spec.coupling.drag, "koch_hill");
  EXPECT_EQ(spec.coupling.exchange, coupling::Exchange::explicit_);
  EXPECT_EQ(spec.coupling.coefficients, coupling::Coefficients::substep);
  EXPECT_EQ(spec.coupling.transfer_grid.cells, (Index3{8, 2, 20}));
  EXPECT_EQ(spec.coupling.smoothing_length, 0.006);
  EXPECT_EQ(spec.output.lines[0].thickness, 0.004);
  EXPECT_EQ(*spec.output.lines[0].depth_average, 1);
  EXPECT_EQ(spec.output.lines[0].average.to, 1.5);
  EXPECT_EQ(spec.output.lines[1].average.to, 2);
  EXPECT_EQ(spec.output.probes[0].quantities, (std::vector<std::string>{"pressure", "void_fraction"}));
  EXPECT_EQ(spec.output.probes[0].average->from, 0.25);
  EXPECT_EQ(spec.output.probes[0].average->to, 1);
  EXPECT_EQ(spec.output.probes[1].average->from, 0);
  EXPECT_EQ(spec.output.probes[1].average->to, 2);  // time.end
  EXPECT_FALSE(spec.output.probes[2].average);
  EXPECT_EQ(spec.output.average->window.from, 0.2);
  EXPECT_EQ(spec.output.average->window.to, 1.8);
  EXPECT_EQ(spec.output.average->gas, (std::vector<std::string>{"velocity", "solids_fraction"}));
  EXPECT_EQ(*spec.output.probes[1].particle, 7);
  EXPECT_TRUE(spec.output.probes[2].bed);
  EXPECT_EQ(spec.output.probes[2].quantities.front(), "bed_height");
  EXPECT_TRUE(spec.output.histograms[0].by_mass);
  EXPECT_EQ(spec.where("gas.convection"), at("convection:") + ": gas.convection");
  EXPECT_EQ(spec.where("gas.nothing.here"), at("gas:\n") + ": gas.nothing.here");
}

// The stretched line of the bed runs through cells whose size is not the same along z.
TEST(CaseFile, DefaultsFollowFromOtherKeys) {
  const CaseSpec bed = parse_case(spouted_bed_case, "c.yaml");
  const CartesianGrid grid = make_grid(bed.gas->grid, bed.domain);
  EXPECT_NEAR(grid.width(2, 7) / grid.width(2, 6), 1.05, 1e-12);
  EXPECT_EQ(bed.output.lines[1].thickness, std::max(grid.width(2, grid.locate(2, 0.05)), 0.005));

  const CaseSpec pair = parse_case(two_particles_case, "folder/two.yaml");
  EXPECT_EQ(pair.title, "two");
  EXPECT_EQ(pair.time.gas_step, 10 * pair.time.particle_step);
  EXPECT_EQ(pair.time.impact_speed, 1);
  EXPECT_EQ(parse_case(two_particles_case, "c", {"particles.0.velocity=[0, 3, 4]"}).time.impact_speed, 5);

  const CaseSpec channel = parse_case(channel_case, "c.yaml");
  EXPECT_EQ(channel.time.particle_step, 0.01);
  EXPECT_EQ(channel.gas->grid.cells, (Index3{2, 3, 1}));
  EXPECT_EQ(channel.gas->options.convection, cfd::Convection::ultimate_quickest);

  const std::vector<std::string> no_transfer_grid{"coupling.transfer_grid="};
  EXPECT_EQ(parse_case(spouted_bed_case, "c.yaml", no_transfer_grid).coupling.transfer_grid.growth.z, 1.05);
}

TEST(CaseFile, ResolvedFileGivesTheSameCase) {
  for (const char* text : {spouted_bed_case, channel_case, humid_case, rising_case, drying_case, refined_case,
                           chamber_case, powders_case, vessel_case, sprayed_case, mist_case, turbulent_case,
                           blower_case, two_particles_case}) {
    const CaseSpec spec = parse_case(text, "some_case.yaml");
    const std::string resolved = resolved_yaml(spec);
    const CaseSpec again = parse_case(resolved, "another_name.yaml");
    EXPECT_EQ(resolved_yaml(again), resolved);
    EXPECT_EQ(describe_case_text(again), describe_case_text(spec));
    EXPECT_EQ(again.warnings.size() >= spec.warnings.size(), true);
  }
}

/// Paths of all keys that hold a value, without the indices and names of entries.
void collect_paths(const core::KeyInfo& section, const std::string& path, std::set<std::string>& paths) {
  for (const auto& key : section.children) {
    const std::string here = path.empty() ? key.name : path + "." + key.name;
    if (key.or_section) collect_paths(key, here, paths);
    if (key.type == core::KeyType::section) {
      collect_paths(key, here + (key.is_list || key.is_named ? ".*" : ""), paths);
    } else {
      paths.insert(here);
    }
  }
}

bool matches(const std::string& pattern, const std::string& path) {
  std::istringstream a(pattern), b(path);
  std::string p, q;
  for (;;) {
    const bool more_a = static_cast<bool>(std::getline(a, p, '.'));
    const bool more_b = static_cast<bool>(std::getline(b, q, '.'));
    if (more_a != more_b) return false;
    if (!more_a) return true;
    if (p != "*" && p != q) return false;
  }
}

// Keys of other kinds of cases aside, the bed gives every key there is: so the tests above cover them all.
TEST(CaseFile, TheTestsCoverEveryKey) {
  std::set<std::string> paths;
  collect_paths(core::catalogue_keys([](core::Keys& keys) {
                  CaseSpec spec;
                  describe_case(keys, spec);
                }),
                "", paths);
  EXPECT_GT(paths.size(), 100u);
  std::map<std::string, std::string> given = parse_case(spouted_bed_case, "c.yaml").lines;
  given.merge(std::map(parse_case(channel_case, "c.yaml").lines));
  given.merge(std::map(parse_case(humid_case, "c.yaml").lines));
  given.merge(std::map(parse_case(rising_case, "c.yaml").lines));
  given.merge(std::map(parse_case(drying_case, "c.yaml").lines));
  given.merge(std::map(parse_case(refined_case, "c.yaml").lines));
  given.merge(std::map(parse_case(turbulent_case, "c.yaml").lines));
  given.merge(std::map(parse_case(blower_case, "c.yaml").lines));
  given.merge(std::map(parse_case(chamber_case, "c.yaml").lines));
  given.merge(std::map(parse_case(powders_case, "c.yaml").lines));
  given.merge(std::map(parse_case(vessel_case, "c.yaml").lines));
  given.merge(std::map(parse_case(sprayed_case, "c.yaml").lines));
  given.merge(std::map(parse_case(mist_case, "c.yaml").lines));
  const std::set<std::string> elsewhere{"coupling.transfer_grid.cells", "coupling.transfer_grid.growth",
                                        "coupling.transfer_grid.faces.x", "coupling.transfer_grid.faces.y",
                                        "coupling.transfer_grid.faces.z"};
  for (const auto& path : paths) {
    if (elsewhere.contains(path)) continue;
    const bool covered = std::any_of(given.begin(), given.end(),
                                     [&](const auto& entry) { return matches(path, entry.first); });
    EXPECT_TRUE(covered) << path;
  }
}

TEST(CaseFile, Overrides) {
  const CaseSpec spec = parse_case(spouted_bed_case, "c.yaml",
                                   {"output.lines.high.points=29", "particles.0.count=50",
                                    "coupling.drag=rong", "gas.grid.cells=[4, 2, 10]", "time.end=3 s"});
  EXPECT_EQ(spec.output.lines[1].points, 29);
  EXPECT_EQ(*spec.particles[0].count, 50);
  EXPECT_EQ(spec.coupling.drag, "rong");
  EXPECT_EQ(spec.gas->grid.cells.z, 10);
  EXPECT_EQ(spec.time.end, 3);
  EXPECT_EQ(bed_errors("particles.0.diameter=-1 mm"),
            "--set: particles.0.diameter: \"-1 mm\" is out of range; a length greater than 0");
  EXPECT_EQ(bed_errors("coupling.drga=rong").substr(0, 65),
            "--set: coupling.drga: unknown key, the nearest is drag; known her");
}

TEST(CaseErrors, EveryOneSaysWhereWhatAndWhatIsAllowed) {
  const std::vector<std::string> overrides{
      "particles.0.material=glas", "time.end=-1", "gas.convection=upwin",
      "domain.min=[0, 0]",         "heating={}",  "particles.0.fill.pattern="};
  std::istringstream lines(errors(spouted_bed_case, overrides));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_TRUE(line.starts_with("--set: ")) << line;
    EXPECT_NE(line.find("; "), std::string::npos) << line;
  }
  EXPECT_EQ(count, 5);
}

TEST(CaseErrors, MissingKeys) {
  EXPECT_EQ(errors("title: x\n", {}),
            "c.yaml:1: domain: missing; a section\nc.yaml:1: time: missing; a section");
  EXPECT_EQ(bed_errors("time.gas_step="),
            at("time:") + ": time.gas_step: missing; with gas a time greater than 0 s");
  EXPECT_EQ(bed_errors("time.particle_step="),
            at("time:") + ": time.particle_step: missing; with particles a time greater than 0 s");
  EXPECT_EQ(bed_errors("particles.0.diameter="),
            at("count: 100") + ": particles.0.diameter: missing; a fill needs a length greater than 0");
  EXPECT_EQ(bed_errors("particles.3.list.1.diameter="),
            at("[\"25 mm\"") +
                ": particles.3.list.1.diameter: missing here and in the population; a length greater than 0");
  EXPECT_EQ(errors("domain: {min: [0, 0, 0], max: [1, 1, 1]}\ntime: {end: 1, gas_step: 1}\n", {}),
            "c.yaml:1: there is nothing to simulate; particles, gas, or both");
}

// d 10 mm, rho 2500, E 1e7, nu 0.22: G = 4.098e6, Rayleigh time pi R sqrt(rho/G)/(0.1631 nu + 0.8766) = 4.25e-4 s;
// m* = 6.545e-4 kg, R* = 2.5 mm, E* = 5.254e6: contact time at 1 m/s 2.87 (m*^2/(R* E*^2))^0.2 = 1.04e-3 s.
TEST(CaseErrors, Steps) {
  EXPECT_EQ(bed_errors("time.particle_step=3 us"),
            "--set: time.particle_step: 3e-06 s does not divide the gas step of 0.0001 s; gas_step over a "
            "whole number");
  EXPECT_EQ(
      bed_errors("time.end=1e-5"),
      at("time:") + ": time.gas_step: 0.0001 s is longer than time.end 1e-05 s; at most that\n" +
          at("average: {from: \"0.5 s\"") +
          ": output.lines.low.average: it begins at 0.5 s, after the end of the run; before 1e-05 s\n" +
          at("average: {from: \"0.25 s\"") +
          ": output.probes.centre.average: it begins at 0.25 s, after the end of the run; before 1e-05 s\n" +
          at("average: {from: \"0.2 s\"") +
          ": output.average: it begins at 0.2 s, after the end of the run; before 1e-05 s");
  EXPECT_EQ(pair_errors("time.particle_step=1e-3"),
            "--set: time.particle_step: 0.001 s is over the bound of 5.19e-05 s (a fifth of the Rayleigh "
            "time 0.000425 s, a twentieth of the contact time 0.00104 s at 1 m/s); at most the bound, or "
            "time.allow_large_step: true");
  const CaseSpec spec =
      parse_case(two_particles_case, "c.yaml", {"time.particle_step=1e-3", "time.allow_large_step=true"});
  ASSERT_EQ(spec.warnings.size(), 1u);
  EXPECT_EQ(spec.warnings[0].substr(0, 53), "--set: time.particle_step: 0.001 s is over the bound ");
}

// The same beads: m* = 6.545e-4 kg, δ = 1 % of 5 mm at 1 m/s: k = m* v²/δ² = 261.8 kN/m, t_c = π √(m*/k) = 1.57e-4 s.
TEST(CaseFile, LinearStiffnessFollowsFromTheOverlap) {
  const std::vector<std::string> linear{"contacts.model.normal=linear", "time.particle_step=5e-6"};
  const CaseSpec spec = parse_case(two_particles_case, "c.yaml", linear);
  EXPECT_EQ(spec.contacts.linear->largest_overlap, 0.01);
  EXPECT_EQ(spec.contacts.linear->speed, 1);
  EXPECT_NEAR(make_pairs(spec)[0].normal_stiffness, 261799.39, 0.01);
  EXPECT_NEAR(particle_step_bound(spec).bound, 7.853982e-6, 1e-12);
  auto own = linear;
  own.emplace_back("contacts.pairs.0.normal_stiffness=1e5");
  EXPECT_EQ(make_pairs(parse_case(two_particles_case, "c.yaml", own))[0].normal_stiffness, 1e5);
  EXPECT_EQ(errors(two_particles_case, {"contacts.model.normal=linear"}),
            "c.yaml:2: time.particle_step: 1e-05 s is over the bound of 7.85e-06 s (a twentieth of the "
            "contact time "
            "0.000157 s of the linear springs); at most the bound, or time.allow_large_step: true");
  EXPECT_EQ(pair_errors("contacts.linear={}"),
            "--set: contacts.linear: the normal law is hertz; only with contacts.model.normal: linear");
  EXPECT_EQ(
      pair_errors("contacts.pairs.0.normal_stiffness=10"),
      "--set: contacts.pairs.0.normal_stiffness: the normal law is hertz; only with contacts.model.normal: "
      "linear");
}

TEST(CaseErrors, Cohesion) {
  EXPECT_EQ(pair_errors("contacts.cohesion={bridge_volume: 20 uL, surface_tension: 0.07}"),
            "--set: contacts.cohesion.bridge_volume: 2e-08 m3 is too much for the smallest particles, which "
            "it would "
            "drown; at most 1.25e-08 m3, a tenth of R^3");
  EXPECT_EQ(pair_errors("contacts.cohesion={bridge_volume: 1 uL}"),
            "--set: contacts.cohesion.surface_tension: missing; a surface tension greater than 0");
}

TEST(CaseErrors, MaterialsAndPairs) {
  EXPECT_EQ(bed_errors("particles.0.material=glas"),
            "--set: particles.0.material: no material \"glas\"; glass, steel");
  EXPECT_EQ(bed_errors("particles.0.material=acrylic"),
            "--set: particles.0.material: \"acrylic\" is a wall's material without properties; glass, steel");
  EXPECT_EQ(bed_errors("contacts.pairs.0.between=[glass, wood]"),
            "--set: contacts.pairs.0.between: no material \"wood\"; glass, steel, acrylic");
  EXPECT_EQ(bed_errors("contacts.pairs.2="), at("  pairs:") +
                                                 ": contacts.pairs: no pair for glass and steel, which can "
                                                 "meet; an entry with between: [glass, steel]");
  EXPECT_EQ(bed_errors("contacts.pairs.2.between=[glass, acrylic]"),
            "--set: contacts.pairs.2.between: glass and acrylic have a pair already; each pair once\n" +
                at("  pairs:") +
                ": contacts.pairs: no pair for glass and steel, which can meet; an entry with between: "
                "[glass, steel]");
  EXPECT_EQ(
      bed_errors("contacts.pairs.0.restitution=0"),
      "--set: contacts.pairs.0.restitution: \"0\" is out of range; a number greater than 0 and at most 1");
  EXPECT_EQ(bed_errors("materials.glass.poisson_ratio=0.7"),
            "--set: materials.glass.poisson_ratio: \"0.7\" is out of range; a number from 0 to 0.5");
}

TEST(CaseErrors, Populations) {
  EXPECT_EQ(
      bed_errors("particles.0.total_mass=1"),
      at("count: 100") +
          ": particles.0: 2 of count, total_mass and fill.solids_fraction are given; exactly one of them");
  EXPECT_EQ(
      bed_errors("particles.0.count="),
      at("count: 100") +
          ": particles.0: 0 of count, total_mass and fill.solids_fraction are given; exactly one of them");
  EXPECT_EQ(bed_errors("particles.3.count=2"),
            "--set: particles.3.count: the list says how many; only with fill");
  EXPECT_EQ(bed_errors("particles.3.fill={box: {min: [0, 0, 0], max: [1, 1, 1]}}").substr(0, 74),
            at("- material: glass") + ": particles.3: fill and list are given; exactly one of fill, list");
  EXPECT_EQ(bed_errors("particles.0.diameter={normal: {mean: 1 mm, sd: 1 mm}}"),
            "--set: particles.0.diameter.normal.min: missing; a length greater than 0\n"
            "--set: particles.0.diameter.normal.max: missing; a length greater than 0");
  EXPECT_EQ(
      bed_errors("particles.0.diameter={uniform: {min: 2 mm, max: 1 mm}}"),
      "--set: particles.0.diameter: max must be greater than min; a distribution with sizes between its "
      "bounds");
  EXPECT_EQ(bed_errors("particles.0.diameter={}"),
            "--set: particles.0.diameter: none is given; exactly one of uniform, normal, log_normal, "
            "rosin_rammler, table");
  EXPECT_EQ(bed_errors("particles.3.diameter={uniform: {min: 1 mm, max: 2 mm}}").substr(0, 95),
            "--set: particles.3.diameter: particles of a list have no distribution; a length");
  EXPECT_EQ(bed_errors("particles.0.count=10000"),
            at("fill: {box: {min: [0, 0, \"10 mm\"]") +
                ": particles.0.fill: 10000 particles do not fit: they would take 2.09 times the region's "
                "volume; at most 52.4 % with pattern lattice");
  EXPECT_EQ(bed_errors("particles.2.fill.solids_fraction=0.65"),
            at("\"61 mm\"") +
                ": particles.2.fill: 1117 particles do not fit: they would take 65 % of the region's volume; "
                "at most 60 % with pattern random");
  EXPECT_EQ(bed_errors("particles.1.total_mass=1e-9"),
            at("total_mass") +
                ": particles.1: it comes to no particle at all; a mass or solids fraction of at least one "
                "particle");
  EXPECT_EQ(
      bed_errors("particles.0.fill.box.max=[1, 0.01, 0.06]"),
      at("fill: {box: {min: [0, 0, \"10 mm\"]") +
          ": particles.0.fill.box: it reaches out of the domain; within [0, 0, 0] to [0.04, 0.01, 0.1] m");
  EXPECT_EQ(bed_errors("particles.0.fill.box.max=[0, 0.01, 0.06]"),
            "--set: particles.0.fill.box.max: 0 m is not beyond min 0 m along x; larger coordinates than "
            "those of min");
  EXPECT_EQ(bed_errors("particles.3.list.0.position=[0.02, 0.005, 1]"),
            "--set: particles.3.list.0.position: [0.02, 0.005, 1] m is outside the domain; within [0, 0, 0] "
            "to [0.04, 0.01, 0.1] m");
  EXPECT_EQ(bed_errors("particles.3.list.0.position=[0.02, 0.005, 0.0005]"),
            "--set: particles.3.list.0.position: [0.02, 0.005, 0.0005] m is behind the wall floor; on the "
            "side its normal points to");
}

TEST(CaseErrors, WallsAndSides) {
  EXPECT_EQ(bed_errors("walls.floor.plane.normal=[0, 0, 0]"),
            "--set: walls.floor.plane.normal: it has no length; a direction such as [0, 0, 1]");
  EXPECT_EQ(
      bed_errors("walls.floor.velocity=[0, 0, 1]"),
      "--set: walls.floor.velocity: it leads through the wall; a velocity at right angles to the normal");
  EXPECT_EQ(bed_errors("walls.floor.open=[top]"),
            "--set: walls.floor.open: only the sides of a box can be open; no open, or box: domain");
  EXPECT_EQ(
      bed_errors("walls.sides.open=[top, front]"),
      "--set: walls.sides.open: front is a periodic side, which has no wall; sides that are not periodic");
  EXPECT_EQ(bed_errors("walls.sides.velocity=[0, 0, 1]"),
            "--set: walls.sides.velocity: it leads through the bottom side; a velocity along all closed "
            "sides, or a plane");
  EXPECT_EQ(bed_errors("walls.floor.name=sides"),
            "--set: walls.sides.name: another one is called sides already; a name of its own");
  EXPECT_EQ(bed_errors("gas.boundaries.top.on=back"),
            "--set: gas.boundaries.top.on: back is a periodic side; sides that are not periodic");
  EXPECT_EQ(bed_errors("gas.boundaries.jet.region.box.max=[1, 1, 1]"),
            at("name: jet") +
                ": gas.boundaries.jet.region: it reaches out of the domain; within [0, 0, 0] to [0.04, 0.01, "
                "0.1] m");
  EXPECT_EQ(bed_errors("gas.boundaries.jet.outlet={}"),
            at("name: jet") +
                ": gas.boundaries.jet: inlet and outlet are given; exactly one of inlet, outlet, wall, "
                "free_slip, symmetry");
  EXPECT_EQ(bed_errors("gas.boundaries.belt.wall.velocity=[1, 0, 0]"),
            at("name: belt") +
                ": gas.boundaries.belt.wall: its velocity leads through the side; a velocity along the side");
  EXPECT_EQ(bed_errors("domain.periodic=[x, y]").substr(0, 60),
            at("name: sides") + ": walls.sides.open: right is a periodic side, which");
}

TEST(CaseErrors, Grids) {
  EXPECT_EQ(errors(spouted_bed_case, {"gas.grid.cells=[2000, 2000, 2000]"}),
            at("grid:") + ": gas.grid: 8000000000 cells; at most 2147483647");
  EXPECT_EQ(bed_errors("gas.grid.cells=[0, 2, 2]"),
            "--set: gas.grid.cells.0: \"0\" is out of range; a whole number from 1 to 100000");
  EXPECT_EQ(errors(channel_case, {"gas.grid.faces.y=[0, 0.5, 0.4, 1]"}),
            "--set: gas.grid.faces.y: the coordinates do not increase; each larger than the one before");
  EXPECT_EQ(errors(channel_case, {"gas.grid.faces.y=[0, 0.5]"}),
            "--set: gas.grid.faces.y: from 0 to 0.5 m it is not the domain; from 0 to 1 m");
  EXPECT_EQ(errors(channel_case, {"gas.grid.growth=[1, 1, 2]"}),
            "--set: gas.grid.growth: faces say all about the cells; only with cells");
  EXPECT_EQ(
      bed_errors("coupling.transfer_grid.cells=[1, 1, 1]"),
      at("transfer_grid:") +
          ": coupling.transfer_grid: cells and cell_size are given; exactly one of cells, faces, cell_size");
  EXPECT_EQ(bed_errors("coupling.transfer_grid.cell_size=1e-9"),
            "--set: coupling.transfer_grid.cell_size: it gives 40000000 cells along x; at most 100000");
  EXPECT_EQ(bed_errors("coupling.pending_release=0.9"),
            "--set: coupling.pending_release: 0.9 is unstable with minimum_void_fraction 0.4; less than 0.5");
  EXPECT_EQ(bed_errors("coupling.smoothing_length=-1 mm"),
            "--set: coupling.smoothing_length: \"-1 mm\" is out of range; a length at least 0");
  EXPECT_EQ(
      bed_errors("domain.max=[0.04, 0.002, 0.1]").find("too narrow for these particles") != std::string::npos,
      true);
}

TEST(CaseErrors, RefinedGrids) {
  EXPECT_EQ(errors(refined_case, {"gas.grid.cells=[1, 1, 1]"})
                    .find("cells and cell_size are given; exactly one of "
                          "cells, faces, cell_size") != std::string::npos,
            true);
  EXPECT_EQ(errors(refined_case, {"gas.grid.growth=[1, 1, 2]"}),
            "--set: gas.grid.growth: cell_size says all about the cells; only with cells");
  EXPECT_EQ(errors(channel_case, {"gas.grid.max_growth=1.2"}),
            "--set: gas.grid.max_growth: there is no cell_size; only with cell_size");
  EXPECT_EQ(errors(refined_case, {"gas.grid.max_growth=1"}),
            "--set: gas.grid.max_growth: \"1\" is out of range; a number from 1.01 to 2");
  EXPECT_EQ(errors(refined_case, {"gas.grid.zones.0.cell_size=0"}),
            "--set: gas.grid.zones.0.cell_size: \"0\" is out of range; a length greater than 0");
  EXPECT_EQ(errors(refined_case, {"gas.grid.cell_size=1e-7"}),
            "--set: gas.grid.cell_size: with its zones it gives more than 100000 cells along an axis; larger "
            "sizes");
  EXPECT_EQ(
      errors(refined_case, {"gas.grid.zones.1.box.min=[0.1, 0, 0]", "gas.grid.zones.1.box.max=[0.2, 1, 1]"})
              .find("gas.grid.zones.1.box: it lies outside the domain along x; within 0 to 0.1 m") !=
          std::string::npos,
      true);
}

TEST(CaseFile, RefinedGrid) {
  const CaseSpec spec = parse_case(refined_case, "c.yaml");
  const CartesianGrid grid = make_grid(spec.gas->grid, spec.domain);
  EXPECT_EQ(grid.cells().y, 1);
  // 4 cells of 1 mm in the middle of x, from 48 to 52 mm; 2 mm at most from 40 to 60 mm.
  EXPECT_NEAR(grid.width(0, grid.locate(0, 0.0501)), 0.001, 1e-12);
  EXPECT_LE(grid.width(0, grid.locate(0, 0.0401)), 0.002);
  // Along z the second zone takes the whole height.
  EXPECT_EQ(grid.cells().z, 200);
  const std::string text = describe_case_text(spec);
  EXPECT_NE(text.find(fmt::format("gas grid         {} x 1 x 200 = {} cells", grid.cells().x,
                                  200 * grid.cells().x)),
            std::string::npos)
      << text;
  Real smallest = 1e-3, largest = 0;  // along z all cells have 1 mm
  for (Index i = 0; i < grid.cells().x; ++i) {
    smallest = std::min(smallest, grid.width(0, i));
    largest = std::max(largest, grid.width(0, i));
  }
  const std::string shape = fmt::format(
      "sides from {:.4g} to {:.4g} mm, largest aspect ratio {:.4g}, neighbours differ "
      "by a factor of 1.",
      1e3 * smallest, 1e3 * largest, std::max(1e3 * largest, 1e-3 / smallest));
  EXPECT_NE(text.find(shape), std::string::npos) << text << shape;
}

TEST(CaseErrors, PlaneProbes) {
  // All that a gas without temperature and moisture has.
  EXPECT_EQ(errors(channel_case,
                   {"output.probes=[{name: p, point: [0.5, 0.5, 0.5]}, {name: q, plane: {axis: z, at: 1}}]"}),
            "no error");
  EXPECT_EQ(bed_errors("output.probes.round.plane.at=50 mm"),
            "--set: output.probes.round.plane.at: 0.05 m is outside the domain; 0 to 0.04 m");
  EXPECT_EQ(bed_errors("output.probes.round.plane.disc.centre=[0, 0, 1]")
                    .find("plane.disc: it has no part in the domain along z") != std::string::npos,
            true);
  EXPECT_EQ(bed_errors("output.probes.round.plane.box={min: [0, 0, 0], max: [1, 1, 1]}")
                    .find("plane.disc: there is a box too; one of the two") != std::string::npos,
            true);
  EXPECT_EQ(bed_errors("output.probes.round.quantities=[bed_height]")
                    .find("bed_height does not fit this kind of probe; volume_flow, mass_flow, open_area, "
                          "gas_velocity_x") != std::string::npos,
            true);
}

TEST(CaseErrors, Outputs) {
  EXPECT_EQ(bed_errors("output.lines.low.from=[-1 mm, 5 mm, 20 mm]"),
            "--set: output.lines.low.from: [-0.001, 0.005, 0.02] m is outside the domain; within [0, 0, 0] "
            "to [0.04, 0.01, 0.1] m");
  EXPECT_EQ(bed_errors("output.lines.low.to=[0, 5 mm, 20 mm]"),
            "--set: output.lines.low.to: it is the same point as from; the other end of the line");
  EXPECT_EQ(bed_errors("output.lines.low.depth_average=x"),
            "--set: output.lines.low.depth_average: the line runs along that direction; one at right angles "
            "to the line");
  EXPECT_EQ(bed_errors("output.lines.low.average.to=0.1"),
            at("average: {from: \"0.5 s\"") +
                ": output.lines.low.average: from 0.5 to 0.1 s is no time; to later than from");
  EXPECT_EQ(
      bed_errors("output.lines.low.average.from=5").substr(0, 70),
      at("average: {from: \"0.5 s\"") + ": output.lines.low.average: from 5 to 1.5 s is no time; to la");
  EXPECT_EQ(
      bed_errors("output.average.from=1.9"),
      at("average: {from: \"0.2 s\"") + ": output.average: from 1.9 to 1.8 s is no time; to later than from");
  EXPECT_EQ(
      bed_errors("output.average.gas=[temperature]"),
      "--set: output.average.gas: temperature needs a temperature of the gas; gas.heat, or another name");
  EXPECT_EQ(pair_errors("output.average={}"),
            "--set: output.average: it averages the gas, which the case has not; no average");
  EXPECT_EQ(bed_errors("output.probes.bead.average={from: 2}"),
            "--set: output.probes.bead.average: from 2 to 2 s is no time; to later than from");
  EXPECT_EQ(bed_errors("output.probes.bead.average={from: 2, to: 3}"),
            "--set: output.probes.bead.average: it begins at 2 s, after the end of the run; before 2 s");
  EXPECT_EQ(
      bed_errors("output.probes.bead.name=centre_average"),
      at("average: {from: \"0.25 s\"") +
          ": output.probes.centre.average: a probe is called centre_average, as its file; another name");
  EXPECT_EQ(bed_errors("output.lines.high.name=low"),
            "--set: output.lines.low.name: another one is called low already; a name of its own");
  EXPECT_EQ(bed_errors("output.lines.high.name=../x"),
            "--set: output.lines.1.name: \"../x\" is no name; a name of letters, digits, _ and -");
  EXPECT_EQ(bed_errors("output.probes.centre.point=[1, 1, 1]"),
            "--set: output.probes.centre.point: [1, 1, 1] m is outside the domain; within [0, 0, 0] to "
            "[0.04, 0.01, 0.1] m");
  EXPECT_EQ(bed_errors("output.probes.centre.quantities=[particle_speed]").substr(0, 90),
            "--set: output.probes.centre.quantities: particle_speed does not fit this kind of probe; ga");
  EXPECT_EQ(bed_errors("output.probes.bead.particle=999").substr(0, 70),
            "--set: output.probes.bead.particle: there is no particle 999; 0 to 498");
  EXPECT_EQ(
      bed_errors("output.probes.out.side=bottom"),
      "--set: output.probes.out.side: nothing can leave through bottom; a side that is named in open of "
      "the box of walls");
  EXPECT_EQ(bed_errors("output.histograms.speeds.max=-1"),
            "--set: output.histograms.speeds.max: it is not above min; a larger number");
  EXPECT_EQ(pair_errors("output.probes=[{name: p, point: [0.5, 0.5, 0.5]}]"),
            "--set: output.probes.p.point: a point shows the gas, which the case has not; particle or bed");
  EXPECT_EQ(
      pair_errors("output.lines=[{name: l, from: [0, 0, 0], to: [1, 0, 0], points: 3, quantity: pressure}]")
          .substr(0, 75),
      "--set: output.lines.l.quantity: pressure needs gas, which the case has not;");
  EXPECT_EQ(
      bed_errors("output.histograms.speeds.quantity=coating_thickness"),
      "--set: output.histograms.speeds.quantity: coating_thickness needs heat or spray, which the case has "
      "not; another name");
  EXPECT_EQ(
      bed_errors("output.histograms.rising.against=hits"),
      "--set: output.histograms.rising.against: hits needs spray, which the case has not; another name");
  EXPECT_EQ(
      bed_errors("output.snapshots.particles=[temperature]"),
      "--set: output.snapshots.particles: particle_temperature needs heat, which the case has not; another "
      "name");
  EXPECT_EQ(bed_errors("output.probes.bead.quantities=[film_liquid]"),
            "--set: output.probes.bead.quantities: film_liquid needs heat or spray, which the case has not; "
            "another "
            "name");
  EXPECT_EQ(errors(channel_case, {"output.probes=[{name: b, bed: {}}]"}),
            "--set: output.probes.b.bed: the case has no particles; point or plane");
  EXPECT_EQ(errors(channel_case, {"output.histograms=[{name: h, quantity: particle_speed}]"}),
            "--set: output.histograms.h.quantity: a case without particles has none; no histograms");
}

TEST(CaseWarnings, KeysWithoutUse) {
  const auto warnings = parse_case(channel_case, "c.yaml", {"coupling.drag=rong", "time.settle=1"}).warnings;
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0], "--set: time.settle: of no use: the case has no particles");
  EXPECT_EQ(warnings[1], "--set: coupling: of no use: the case has no particles");
  EXPECT_EQ(parse_case(spouted_bed_case, "c.yaml", {"coupling.transfer_grid.cell_size=1 mm"}).warnings.size(),
            4u);
}

TEST(CaseAmounts, Counts) {
  const CaseSpec spec = parse_case(spouted_bed_case, "c.yaml");
  // 1 g / (2500 kg/m3 pi/6 (1.5 mm)^3) = 226.35; 10 % of 10 x 10 x 9 mm3 / (pi/6 mm3) = 171.9.
  EXPECT_EQ(particle_count(spec.particles[1]), 226);
  EXPECT_EQ(particle_count(spec.particles[2]), 171);
  EXPECT_EQ(particle_count(spec), 100 + 226 + 171 + 2);
  EXPECT_EQ(diameter_range(spec).smallest, 1e-3);
  EXPECT_EQ(diameter_range(spec).largest, 3e-3);
  EXPECT_TRUE(can_meet(spec, 0, 0));
  EXPECT_TRUE(can_meet(spec, 0, 1));
  EXPECT_FALSE(can_meet(spec, 1, 2));
}

// Sums over the particles themselves, against the rules: by mass the nearest sum, by solids fraction the last below.
TEST(CaseAmounts, DistributionsAreFilledUpToTheirTarget) {
  const CaseSpec spec = parse_case(powders_case, "c.yaml");
  const auto volume = [&](std::size_t population, std::size_t count) {
    CaseSpec copy = spec;
    copy.particles[population].filled = static_cast<std::int64_t>(count);
    Real sum = 0;
    for (const Real r : draw_radii(copy, population)) sum += 4.0 / 3.0 * M_PI * r * r * r;
    return sum;
  };
  const auto by_mass = static_cast<std::size_t>(particle_count(spec.particles[0]));
  const Real target = 0.002 / 2500;
  const Real off = std::abs(volume(0, by_mass) - target);
  EXPECT_LT(off, std::abs(volume(0, by_mass - 1) - target));
  EXPECT_LT(off, std::abs(volume(0, by_mass + 1) - target));
  const auto by_fraction = static_cast<std::size_t>(particle_count(spec.particles[2]));
  EXPECT_LE(volume(2, by_fraction), 0.1 * 32e-6);
  EXPECT_GT(volume(2, by_fraction + 1), 0.1 * 32e-6);
  // The bounds count for lists and steps, not what happened to be drawn.
  EXPECT_EQ(diameter_range(spec).smallest, 0.8e-3);
  EXPECT_EQ(diameter_range(spec).largest, 4e-3);
  // Populations draw their own numbers, the same ones at every reading, others with another seed.
  EXPECT_EQ(draw_radii(spec, 0), draw_radii(parse_case(powders_case, "d.yaml"), 0));
  EXPECT_NE(draw_radii(spec, 0), draw_radii(parse_case(powders_case, "c.yaml", {"seed=2"}), 0));
  EXPECT_NE(draw_radii(spec, 0)[0], draw_radii(parse_case(powders_case, "c.yaml",
                                                          {"particles.1.diameter={uniform: "
                                                           "{min: 1 mm, max: 2 mm}}"}),
                                               1)[0]);
}

// Populations of one region share it: neither fits at random around the other at 0.25 each, together they do.
TEST(CaseParticles, PopulationsOfOneRegionMix) {
  const std::string half =
      "{material: glass, diameter: 2 mm, fill: {box: {min: [0, 0, 0], max: [0.03, 0.03, 0.03]}, "
      "solids_fraction: 0.25}}";
  const CaseSpec spec = parse_case(powders_case, "c.yaml", {"particles=[" + half + ", " + half + "]"});
  const auto particles = make_particles(spec, {});
  ASSERT_EQ(particles.size(), 2u * static_cast<std::size_t>(spec.particles[0].filled));
  const std::size_t half_count = particles.size() / 2;
  Real heights[2] = {0, 0};
  for (std::size_t a = 0; a < particles.size(); ++a) {
    heights[a / half_count] += particles[a].position.z / static_cast<Real>(half_count);
    for (std::size_t b = 0; b < a; ++b) {
      ASSERT_GE(norm(particles[a].position - particles[b].position), 0.002 * (1 - 1e-9));
    }
  }
  // Mixed: both in the middle, within 4 standard errors of 28 mm/sqrt(12) over 1611 particles.
  EXPECT_NEAR(heights[0], 0.015, 4 * 0.028 / std::sqrt(12.0 * 1611));
  EXPECT_NEAR(heights[1], 0.015, 4 * 0.028 / std::sqrt(12.0 * 1611));
  const std::string refused = errors(powders_case, {"particles=[" + half + ", " + half + ", " + half + "]"});
  EXPECT_TRUE(refused.starts_with(
      "--set: particles.0.fill: 1611 particles do not fit: with those of the same region they "
      "would take 75 % of the region's volume; at most 60 % with pattern random"))
      << refused;
}

TEST(CaseErrors, Feeds) {
  const CaseSpec spec = parse_case(powders_case, "c.yaml");
  EXPECT_EQ(spec.particles[6].feed->disc->normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(spec.particles[7].feed->to, 0.1);
  EXPECT_EQ(fed_count(spec, spec.particles[7]), 100);
  // 20 g/s for 40 ms of spheres whose mean cube is (16 - 1)/4 = 3.75 mm3: 0.8 g / (2.5 mg/mm3 pi/6 3.75 mm3) = 162.97.
  EXPECT_EQ(fed_count(spec, spec.particles[6]), 163);
  const auto begins = [](const std::string& assignment, const std::string& message) {
    const std::string said = errors(powders_case, {assignment});
    EXPECT_TRUE(said.starts_with(message)) << said;
  };
  begins("particles.7.feed.mass_rate=1",
         "c.yaml:27: particles.7.feed: mass_rate and rate are given; exactly one");
  begins("particles.7.count=5",
         "--set: particles.7.count: the rate of the feed says how many; only with fill");
  begins("particles.7.fixed=true",
         "--set: particles.7.fixed: particles of a feed move; only with fill or list");
  begins("particles.6.feed.disc.radius=30 mm",
         "c.yaml:25: particles.6.feed.disc: it reaches out of the domain;");
  begins("particles.6.feed.to=5 ms",
         "--set: particles.6.feed.to: from 0.01 to 0.005 s is no time; later than from");
  begins("particles.6.diameter=", "c.yaml:24: particles.6.diameter: missing; a feed needs a length");
}

TEST(CaseErrors, OnlyOneMessageForSeveralOfWhichOneIsAllowed) {
  const std::string said = errors(powders_case, {"particles.6.feed.box.min=[0, 0, 0]"});
  EXPECT_TRUE(
      said.starts_with("c.yaml:25: particles.6.feed: box and disc are given; exactly one of box, disc"))
      << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

TEST(CaseErrors, RoundRegions) {
  EXPECT_EQ(errors(powders_case, {"particles.3.fill.cone.to_radius=30 mm"}).substr(0, 64),
            "c.yaml:17: particles.3.fill.cone: it reaches out of the domain; ");
  EXPECT_EQ(
      errors(powders_case, {"particles.3.fill.cone.to_radius=0", "particles.3.fill.cone.from_radius=0"}),
      "--set: particles.3.fill.cone.to_radius: both radii are 0; one greater than 0");
  EXPECT_EQ(errors(powders_case, {"particles.4.fill.annulus.outer_radius=5 mm"}),
            "--set: particles.4.fill.annulus.outer_radius: it is not beyond inner_radius; a larger one");
}

// Every enumeration of the case file is held by position in its list.
TEST(ModelFamilies, ListsFollowTheirEnumerations) {
  EXPECT_EQ(domain_sides[static_cast<std::size_t>(cfd::Side::z_min)].name, "bottom");
  EXPECT_EQ(domain_sides[static_cast<std::size_t>(cfd::Side::x_max)].name, "right");
  for (int side = 0; side < 6; ++side) {
    EXPECT_EQ(domain_sides[static_cast<std::size_t>(side)].name, cfd::name_of(static_cast<cfd::Side>(side)));
  }
  EXPECT_EQ(fill_patterns[static_cast<std::size_t>(dem::FillPattern::random)].name, "random");
  EXPECT_EQ(coupling::exchange_models[static_cast<std::size_t>(coupling::Exchange::one_way)].name, "one_way");
  EXPECT_EQ(coupling::coefficients_models[static_cast<std::size_t>(coupling::Coefficients::substep)].name,
            "substep");
  EXPECT_EQ(cfd::convection_models[static_cast<std::size_t>(cfd::Convection::quick)].name, "quick");
  for (const auto& family : model_families()) {
    EXPECT_FALSE(family.models.empty()) << family.key;
    for (const auto& model : family.models) EXPECT_FALSE(model.description.empty()) << model.name;
  }
}

TEST(CaseName, IsThatOfTheFolderOrTheFile) {
  EXPECT_EQ(case_name("cases/single_spout/case.yaml"), "single_spout");
  EXPECT_EQ(case_name("somewhere/bed.yaml"), "bed");
  EXPECT_EQ(case_name("/case.yaml"), "case");
}

}  // namespace
