// Runs a given bed of equal glass beads in a closed box with the DEM engine alone and prints, as one line of JSON, how
// fast it went and how many contacts a bead had at the start and at the end.
//
//   OMP_NUM_THREADS=1 build/release/dem_bed --bed bed.txt --size 0.145 0.06 0.3 --steps 280 --warm-up 20
//
// A bed file has one bead a line: position [m], then, if given, velocity [m/s] and angular velocity [rad/s]; lines that
// do not begin with a number are skipped. tools/benchmarks/dem_vs_peers runs this program beside other codes.

#include <CLI/CLI.hpp>
#include <Kokkos_Core.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/model_variant.hpp"
#include "core/timers.hpp"
#include "dem/engine.hpp"

namespace {

using namespace pellicle;

constexpr Real bead_radius = 0.0015;  // [m]
constexpr Real bead_density = 2505;   // [kg/m³]
constexpr Real youngs_modulus = 1e7;  // [Pa]
constexpr Real poisson_ratio = 0.22;  // [-]

struct Options {
  std::string bed_file;
  std::string output_file;
  std::string tangential = "viscous_coulomb";
  std::vector<Real> size{0.145, 0.06, 0.3};  // [m]
  int steps = 280;
  int warm_up = 20;
  int outer = 10;            // substeps an outer step
  Real time_step = 1e-5;     // [s]
  Real restitution = 0.97;   // [-]
  Real friction = 0.3;       // sliding, [-]
  Real gravity = 9.81;       // [m/s²]
  Real relaxation_time = 0;  // of a drag on every bead [s]; 0: none
  bool attraction = false;   // where a contact ends; allowed in the codes this is compared with
};

/// A drag −m v/τ on every bead, with which a bed comes to rest sooner.
struct RestingDrag {
  DeviceArray<Real> mass;
  Real rate;  // 1/τ [1/s]

  KOKKOS_INLINE_FUNCTION Vec3 operator()(Index p, const Vec3& velocity, Real) const {
    return -(rate * mass(p)) * velocity;
  }
};

std::vector<dem::ParticleSeed> read_bed(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  std::vector<dem::ParticleSeed> seeds;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    dem::ParticleSeed seed;
    seed.radius = bead_radius;
    Vec3& x = seed.position;
    if (!(words >> x.x >> x.y >> x.z)) continue;
    Vec3 v;
    Vec3 w;
    if (words >> v.x >> v.y >> v.z) seed.velocity = v;
    if (words >> w.x >> w.y >> w.z) seed.spin = w;
    seeds.push_back(seed);
  }
  if (seeds.empty()) throw std::runtime_error(file + " has no line with a position");
  return seeds;
}

/// Position, velocity, angular velocity and, of the last step, acceleration and angular acceleration, in the order of
/// the bed file.
void write_bed(const std::string& file, const dem::Particles& particles) {
  const auto place = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.position_radius);
  const auto motion = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.velocity_spin);
  const auto kick = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.acceleration);
  const auto turn = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, particles.angular_acceleration);
  std::vector<Index> at(static_cast<std::size_t>(particles.count));
  for (Index p = 0; p < particles.count; ++p) at.at(static_cast<std::size_t>(motion(p).id)) = p;
  std::ofstream out(file);
  out.precision(13);
  out << "# x y z [m] vx vy vz [m/s] wx wy wz [rad/s] ax ay az [m/s2] alphax alphay alphaz [rad/s2]\n";
  for (const Index p : at) {
    const auto& m = motion(p);
    const auto a = kick(p);
    const auto b = turn(p);
    out << place(p).x << ' ' << place(p).y << ' ' << place(p).z << ' ' << m.vx << ' ' << m.vy << ' ' << m.vz
        << ' ' << m.wx << ' ' << m.wy << ' ' << m.wz << ' ' << a.x << ' ' << a.y << ' ' << a.z << ' ' << b.x
        << ' ' << b.y << ' ' << b.z << '\n';
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + file);
}

dem::EngineSetup make_setup(const Options& options) {
  dem::EngineSetup setup;
  setup.domain.box = {{0, 0, 0}, {options.size[0], options.size[1], options.size[2]}};
  // The wall is as soft as the beads: so are the walls of the codes this is compared with.
  setup.materials = {{"glass", bead_density, youngs_modulus, poisson_ratio, false}};
  setup.pairs = {{0, 0, options.restitution, options.friction, 0}};
  const int law = core::find_model(core::model_list<dem::TangentialLaw>(), options.tangential);
  if (law < 0) throw std::runtime_error("no tangential law " + options.tangential);
  setup.contacts.tangential = core::make_model<dem::TangentialLaw>(law);
  setup.contacts.rolling = dem::NoRolling{};
  setup.contacts.clip = !options.attraction;
  setup.gravity = {0, 0, -options.gravity};
  setup.time_step = options.time_step;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      dem::PlaneWall wall;
      wall.point = side == 0 ? setup.domain.box.min : setup.domain.box.max;
      wall.normal[axis] = side == 0 ? 1 : -1;
      setup.walls.emplace_back(wall);
    }
  }
  return setup;
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--bed", options.bed_file, "one bead a line: x y z [vx vy vz [wx wy wz]]")->required();
  app.add_option("--size", options.size, "of the box from the origin [m]")->expected(3);
  app.add_option("--tangential", options.tangential, "contact law");
  app.add_option("--warm-up", options.warm_up, "steps before the clock runs");
  app.add_option("--steps", options.steps, "steps timed");
  app.add_option("--outer", options.outer, "steps an outer step, before which memory may be sorted");
  app.add_option("--time-step", options.time_step, "[s]");
  app.add_option("--restitution", options.restitution, "[-]");
  app.add_option("--friction", options.friction, "sliding [-]");
  app.add_flag("--attraction", options.attraction, "let damping pull two beads together as they part");
  app.add_option("--gravity", options.gravity, "downwards [m/s²]");
  app.add_option("--relaxation-time", options.relaxation_time, "of a drag on every bead [s]; 0: no drag");
  app.add_option("--output", options.output_file, "where the bed is written after the timed steps");
}

double wall_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double cpu_now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }  // of all threads

class Bed {
 public:
  explicit Bed(const Options& options) : options_(options), engine_(make_setup(options)) {
    engine_.set_particles(read_bed(options.bed_file));
  }

  void run(int steps) {
    for (int done = 0; done < steps; done += options_.outer) {
      engine_.prepare_outer_step();
      const int count = std::min(options_.outer, steps - done);
      if (options_.relaxation_time > 0) {
        // Memory may have been sorted: the drag reads the present arrays.
        engine_.advance(count, RestingDrag{engine_.particles().mass, 1 / options_.relaxation_time}, timers);
      } else {
        engine_.advance(count, timers);
      }
    }
  }

  /// Contacts of the last step, seen at the positions it started from.
  Real contacts_per_particle() {
    return 2.0 * static_cast<Real>(engine_.collect_report().touching_pairs) / engine_.particles().count;
  }

  dem::Engine& engine() { return engine_; }

  core::Timers timers;

 private:
  Options options_;
  dem::Engine engine_;
};

void run_benchmark(const Options& options) {
  Bed bed(options);
  bed.run(1);
  const Real contacts_start = bed.contacts_per_particle();
  bed.run(options.warm_up - 1);
  bed.timers.reset();
  const auto builds = bed.engine().list_builds();
  const double wall = wall_now();
  const double cpu = cpu_now();
  bed.run(options.steps);
  const double cpu_seconds = cpu_now() - cpu;
  const double wall_seconds = wall_now() - wall;
  const auto& timers = bed.timers;
  const double contacts = timers.seconds(core::Part::contacts);
  const double neighbours = timers.seconds(core::Part::neighbours);
  const double motion = timers.seconds(core::Part::motion);
  const auto built = bed.engine().list_builds() - builds;
  const auto totals = bed.engine().compute_totals();
  if (!options.output_file.empty()) write_bed(options.output_file, bed.engine().particles());
  const int entries_per_pair = dem::half_lists ? 1 : 2;
  const Real neighbours_per_particle = 2 * bed.engine().neighbours_per_particle() / entries_per_pair;
  bed.run(1);
  std::printf(
      "{\"particles\": %d, \"threads\": %d, \"steps\": %d, \"wall_seconds\": %.6f, \"cpu_seconds\": %.6f, "
      "\"contacts_per_particle_start\": %.5f, \"contacts_per_particle_end\": %.5f, \"list_builds\": %lld, "
      "\"neighbours_per_particle\": %.3f, \"kinetic_energy\": %.9g, \"contact_seconds\": %.6f, "
      "\"neighbour_seconds\": %.6f, \"motion_seconds\": %.6f, \"bytes_per_particle\": %.1f}\n",
      bed.engine().particles().count, Kokkos::DefaultHostExecutionSpace().concurrency(), options.steps,
      wall_seconds, cpu_seconds, contacts_start, bed.contacts_per_particle(), static_cast<long long>(built),
      neighbours_per_particle, totals.kinetic_energy, contacts, neighbours, motion,
      static_cast<double>(bed.engine().bytes()) / bed.engine().particles().count);
}

int run(int argc, char** argv) {
  CLI::App app{"Runs a bed of glass beads and tells how fast"};
  Options options;
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  const Kokkos::ScopeGuard kokkos(argc, argv);
  run_benchmark(options);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dem_bed: %s\n", error.what());
    return 1;
  }
}
