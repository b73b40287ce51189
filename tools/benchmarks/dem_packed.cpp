// Particle-steps per second and core of the DEM engine on packed beds of any size, timed in blocks of steps, median of
// several; bytes per particle; where the time goes.
//
//   OMP_NUM_THREADS=1 build/release/dem_packed --positions bed.txt --steps 200 --repeats 5
//   build/release/dem_packed --sizes 10000,50000,200000,1000000,5000000 --steps 40
//
// The bed is 3 mm glass beads (E 1e7 Pa, ν 0.22, e 0.97, µ 0.3) in a box, at a step of 1e-5 s. With --positions (three
// columns [m], of a bed settled in a box of 145 × 60 mm) that bed and its mirror images stand side by side, without walls
// between them. Without, a block of 36.25 × 30 mm is settled between periodic sides first (about half a minute), and
// copies of it fill the box; of the beads that the walls would cut, none are kept.

#include <CLI/CLI.hpp>
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/timers.hpp"
#include "dem/engine.hpp"
#include "dem/fill.hpp"

namespace {

using namespace pellicle;

constexpr Real radius = 0.0015;   // [m]
constexpr Real time_step = 1e-5;  // [s]

/// A settled bed: centres [m] over a floor at z = 0.
struct Bed {
  std::vector<Vec3> positions;
  Real width = 0, depth = 0;  // [m]
  bool walls = true;          // whether it settled between walls, or periodic sides
};

struct Options {
  std::string positions_file;
  std::vector<int> sizes{50000};
  int steps = 200;
  int repeats = 5;
  double rolling = 0;
  double agitation = 0;  // [m/s]
};

Bed read_bed(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  Bed bed{{}, 0.145, 0.06, true};
  Vec3 x;
  if (!(in >> x.x)) {  // a line of titles
    in.clear();
    in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    in >> x.x;
  }
  for (; in >> x.y >> x.z; in >> x.x) bed.positions.push_back(x);
  if (bed.positions.empty()) throw std::runtime_error(file + " has no lines of three numbers");
  return bed;
}

dem::EngineSetup make_setup(const Vec3& size, bool periodic, Real rolling) {
  dem::EngineSetup setup;
  setup.domain.box = {{0, 0, 0}, size};
  if (periodic) setup.domain.periodic = {1, 1, 0};
  setup.materials = {{"glass", 2505, 1e7, 0.22, false}, {"wall", 0, 0, 0, true}};
  setup.pairs = {{0, 0, 0.97, 0.3, rolling}, {0, 1, 0.97, 0.3, rolling}};
  if (rolling == 0) setup.contacts.rolling = dem::NoRolling{};
  setup.gravity = {0, 0, -9.81};
  setup.time_step = time_step;
  for (int axis = 0; axis < 3; ++axis) {
    if (setup.domain.periodic[axis] != 0) continue;
    for (int side = 0; side < 2; ++side) {
      dem::PlaneWall wall;
      wall.point = side == 0 ? setup.domain.box.min : setup.domain.box.max;
      wall.normal[axis] = side == 0 ? 1 : -1;
      wall.material = 1;
      setup.walls.emplace_back(wall);
    }
  }
  return setup;
}

void run(dem::Engine& engine, int steps, core::Timers& timers) {
  for (int done = 0; done < steps; done += 10) {
    engine.prepare_outer_step();
    engine.advance(std::min(10, steps - done), timers);
  }
}

Bed settle_bed() {
  Bed bed{{}, 0.145 / 4, 0.03, false};
  const Vec3 size{bed.width, bed.depth, 0.3};
  dem::Engine engine(make_setup(size, true, 0));
  std::vector<dem::ParticleSeed> seeds;
  // Away from the sides, where the filling does not know that they repeat.
  const Box inside{{0, 0, 0}, size};
  for (const Vec3& x :
       dem::fill_region(inside, dem::FillPattern::random, std::vector<Real>(6250, radius), 1)) {
    seeds.push_back({x, {}, {}, radius, 0, false});
  }
  engine.set_particles(seeds);
  core::Timers timers;
  run(engine, 30000, timers);
  const auto place =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, engine.particles().position_radius);
  for (Index p = 0; p < engine.particles().count; ++p) {
    bed.positions.push_back({place(p).x - bed.width * std::floor(place(p).x / bed.width),
                             place(p).y - bed.depth * std::floor(place(p).y / bed.depth), place(p).z});
  }
  return bed;
}

/// About `count` beads: copies of a bed side by side in a box about as wide and deep as 145 × 60 mm are, or wider.
struct Scene {
  std::vector<dem::ParticleSeed> seeds;
  Vec3 size;
};

Scene make_scene(const Bed& bed, int count, Real agitation) {
  const Real per_area = static_cast<Real>(bed.positions.size()) / (bed.width * bed.depth);
  const Real area = count / per_area;
  Scene scene;
  scene.size = {std::sqrt(area * 0.145 / 0.06), std::sqrt(area * 0.06 / 0.145), 0.3};
  const auto one = static_cast<int>(bed.positions.size());
  if (bed.walls && count % one == 0) {
    // Whole copies, so that no wall cuts the bed and loosens it.
    const int copies = count / one;
    int along = std::max(1, static_cast<int>(std::sqrt(copies)));
    while (copies % along != 0) --along;
    const int across = copies / along;
    scene.size = {along * bed.width, across * bed.depth, 0.3};
  }
  unsigned state = 12345;
  const auto random = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<double>(state) / 4294967296.0 - 0.5;
  };
  const auto nx = static_cast<int>(std::ceil(scene.size.x / bed.width - 1e-9));
  const auto ny = static_cast<int>(std::ceil(scene.size.y / bed.depth - 1e-9));
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      for (const Vec3& from : bed.positions) {
        // Every second copy of a bed that settled between walls is a mirror image: beads that lay against a wall lie
        // against their image in the same way, so that beds of all sizes are equally quiet.
        const bool turn_x = bed.walls && i % 2 == 1;
        const bool turn_y = bed.walls && j % 2 == 1;
        const Vec3 x{(turn_x ? bed.width - from.x : from.x) + i * bed.width,
                     (turn_y ? bed.depth - from.y : from.y) + j * bed.depth, from.z};
        const Real least = 0.9 * radius;  // beads that settled at a wall are in it a little
        if (x.x < least || x.y < least || x.x > scene.size.x - least || x.y > scene.size.y - least) continue;
        dem::ParticleSeed seed;
        seed.position = x;
        seed.radius = radius;
        seed.velocity = agitation * Vec3{random(), random(), random()};
        scene.seeds.push_back(seed);
      }
    }
  }
  return scene;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void time_bed(const Bed& bed, int count, const Options& options) {
  Scene scene = make_scene(bed, count, options.agitation);
  auto setup = make_setup(scene.size, false, options.rolling);
  if (options.agitation > 0) setup.gravity = {};
  dem::Engine engine(setup);
  engine.set_particles(scene.seeds);
  scene.seeds = {};
  core::Timers timers;
  run(engine, 20, timers);
  const auto start = engine.collect_report();
  std::vector<double> rates;
  timers.reset();
  const auto builds = engine.list_builds();
  const double n = engine.particles().count;
  for (int r = 0; r < options.repeats; ++r) {
    const double begin = seconds_now();
    run(engine, options.steps, timers);
    rates.push_back(n * options.steps / (seconds_now() - begin));
  }
  const auto report = engine.collect_report();
  std::sort(rates.begin(), rates.end());
  const int threads = Kokkos::DefaultHostExecutionSpace().concurrency();
  const double per_core = 1e-6 / threads;
  const double total = timers.total();
  const auto lists = static_cast<double>(engine.list_builds() - builds);
  const double steps = static_cast<double>(options.repeats) * options.steps;
  std::printf(
      "%d particles, %d threads, %d x %d steps: %.2f million particle-steps/s/core (min %.2f, max %.2f)\n",
      engine.particles().count, threads, options.repeats, options.steps, rates[rates.size() / 2] * per_core,
      rates.front() * per_core, rates.back() * per_core);
  std::printf(
      "  contacts per particle %.2f, then %.2f; neighbours per particle %.1f; %.0f list builds (one in %.1f "
      "steps)\n",
      2.0 * static_cast<double>(start.touching_pairs) / n,
      2.0 * static_cast<double>(report.touching_pairs) / n, engine.neighbours_per_particle(), lists,
      steps / std::max(1.0, lists));
  std::printf(
      "  share of time: contacts %.1f %%, neighbours %.1f %%, motion %.1f %%; a list build %.0f "
      "ns/particle/core\n",
      100 * timers.seconds(core::Part::contacts) / total,
      100 * timers.seconds(core::Part::neighbours) / total, 100 * timers.seconds(core::Part::motion) / total,
      1e9 * timers.seconds(core::Part::neighbours) / std::max(1.0, lists) / n * threads);
  std::printf("  memory %.1f bytes per particle\n", static_cast<double>(engine.bytes()) / n);
  std::fflush(stdout);
}

int run_benchmark(int argc, char** argv) {
  CLI::App app{"Particle-steps per second of the DEM engine on packed beds"};
  Options options;
  app.add_option("--positions", options.positions_file, "settled positions, three columns [m]");
  app.add_option("--sizes", options.sizes, "beads, about; several sizes are timed one after the other")
      ->delimiter(',');
  app.add_option("--steps", options.steps, "steps a timing");
  app.add_option("--repeats", options.repeats, "timings");
  app.add_option("--rolling", options.rolling, "rolling friction; 0: no rolling law");
  app.add_option("--agitation", options.agitation, "initial random speed [m/s], gravity off");
  CLI11_PARSE(app, argc, argv);
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const Bed bed = options.positions_file.empty() ? settle_bed() : read_bed(options.positions_file);
  for (const int count : options.sizes) time_bed(bed, count, options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run_benchmark(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dem_packed: %s\n", error.what());
    return 1;
  }
}
