// Particle-steps per second and core of the DEM engine on a packed bed, timed in blocks of steps, median of several.
//
//   OMP_NUM_THREADS=1 build/release/dem_packed --positions bed.txt --steps 200 --repeats 5
//
// The bed is 3 mm glass beads (E 1e7 Pa, ν 0.22, e 0.97, µ 0.3) in a box of 145 × 60 mm at a step of 1e-5 s. Without
// --positions (three columns [m]) it is filled at random and settled first, which takes a minute or two.

#include <CLI/CLI.hpp>
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "core/timers.hpp"
#include "dem/engine.hpp"
#include "dem/fill.hpp"

namespace {

using namespace pellicle;

std::vector<Vec3> read_positions(const std::string& file) {
  std::ifstream in(file);
  std::vector<Vec3> positions;
  Vec3 x;
  while (in >> x.x >> x.y >> x.z) positions.push_back(x);
  return positions;
}

dem::EngineSetup make_setup(const Vec3& size, Real rolling) {
  dem::EngineSetup setup;
  setup.domain.box = {{0, 0, 0}, size};
  setup.materials = {{"glass", 2505, 1e7, 0.22, false}, {"wall", 0, 0, 0, true}};
  setup.pairs = {{0, 0, 0.97, 0.3, rolling}, {0, 1, 0.97, 0.3, rolling}};
  if (rolling == 0) setup.contacts.rolling = dem::NoRolling{};
  setup.gravity = {0, 0, -9.81};
  setup.time_step = 1e-5;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      dem::PlaneWall wall;
      wall.point = side == 0 ? setup.domain.box.min : setup.domain.box.max;
      wall.normal[axis] = side == 0 ? 1 : -1;
      wall.material = 1;
      setup.walls.push_back(wall);
    }
  }
  return setup;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

int run_benchmark(int argc, char** argv) {
  CLI::App app{"Particle-steps per second of the DEM engine on a packed bed"};
  std::string positions_file;
  int count = 50000;
  int steps = 200;
  int repeats = 5;
  double rolling = 0;
  double agitation = 0;
  app.add_option("--positions", positions_file, "settled positions, three columns [m]");
  app.add_option("--count", count, "beads to fill and settle when no positions are given");
  app.add_option("--steps", steps, "steps a timing");
  app.add_option("--repeats", repeats, "timings");
  app.add_option("--rolling", rolling, "rolling friction; 0: no rolling law");
  app.add_option("--agitation", agitation, "initial random speed [m/s], gravity off");
  CLI11_PARSE(app, argc, argv);
  const Kokkos::ScopeGuard kokkos(argc, argv);
  const Vec3 size{0.145, 0.06, 0.5 * std::max(1.0, count / 50000.0)};
  auto setup = make_setup(size, rolling);
  if (agitation > 0) setup.gravity = {};
  dem::Engine engine(setup);
  const bool settle = positions_file.empty();
  const std::vector<Vec3> positions =
      settle ? dem::fill_region(Box{{0, 0, 0}, size}, dem::FillPattern::random,
                                std::vector<Real>(static_cast<std::size_t>(count), 0.0015), 1)
             : read_positions(positions_file);
  std::vector<dem::ParticleSeed> seeds;
  unsigned state = 12345;
  const auto random = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<double>(state) / 4294967296.0 - 0.5;
  };
  for (const Vec3& x : positions) {
    dem::ParticleSeed seed;
    seed.position = x;
    seed.radius = 0.0015;
    seed.velocity = agitation * Vec3{random(), random(), random()};
    seeds.push_back(seed);
  }
  engine.set_particles(seeds);
  core::Timers timers;
  const auto run = [&](int n) {
    for (int done = 0; done < n; done += 10) {
      engine.prepare_outer_step();
      engine.advance(std::min(10, n - done), timers);
    }
  };
  run(settle ? 30000 : 20);
  engine.collect_report();
  std::vector<double> rates;
  timers.reset();
  const auto builds = engine.list_builds();
  for (int r = 0; r < repeats; ++r) {
    const double begin = seconds_now();
    run(steps);
    rates.push_back(engine.particles().count * static_cast<double>(steps) / (seconds_now() - begin));
  }
  const auto report = engine.collect_report();
  std::sort(rates.begin(), rates.end());
  const int threads = Kokkos::DefaultHostExecutionSpace().concurrency();
  const double per_core = 1e-6 / threads;
  const double total = timers.total();
  std::printf(
      "%d particles, %d threads, %d x %d steps: %.2f million particle-steps/s/core (min %.2f, max %.2f)\n",
      engine.particles().count, threads, repeats, steps, rates[rates.size() / 2] * per_core,
      rates.front() * per_core, rates.back() * per_core);
  std::printf(
      "contacts per particle %.2f, neighbours per particle %.1f, list builds %lld (one in %.1f steps)\n",
      2.0 * static_cast<double>(report.touching_pairs) / engine.particles().count,
      engine.neighbours_per_particle(), static_cast<long long>(engine.list_builds() - builds),
      static_cast<double>(repeats) * steps /
          std::max(1.0, static_cast<double>(engine.list_builds() - builds)));
  std::printf("share of time: contacts %.1f %%, neighbours %.1f %%, motion %.1f %%\n",
              100 * timers.seconds(core::Part::contacts) / total,
              100 * timers.seconds(core::Part::neighbours) / total,
              100 * timers.seconds(core::Part::motion) / total);
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
