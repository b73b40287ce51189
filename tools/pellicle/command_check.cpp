#include <fmt/format.h>
#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cfd/gas_solver.hpp"
#include "core/error.hpp"
#include "dem/engine.hpp"
#include "tools/pellicle/build_case.hpp"
#include "tools/pellicle/build_gas.hpp"
#include "tools/pellicle/case_checks.hpp"
#include "tools/pellicle/case_file.hpp"
#include "tools/pellicle/commands.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

/// Lines of "what   value".
class Facts {
 public:
  template <class... Args>
  void add(std::string_view what, fmt::format_string<Args...> format, Args&&... args) {
    text_ += fmt::format("  {:<16} {}\n", what, fmt::format(format, std::forward<Args>(args)...));
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string millimetres(Real length) { return fmt::format("{:.4g}", 1e3 * length); }

/// What the run saves with contacts softer than the real ones.
void add_true_moduli(Facts& facts, const CaseSpec& spec) {
  std::string softened;
  for (const auto& material : spec.materials) {
    if (!material.true_youngs_modulus) continue;
    softened += fmt::format("{}{} {:.3g} instead of {:.3g} Pa", softened.empty() ? "" : ", ", material.name,
                            material.youngs_modulus, *material.true_youngs_modulus);
  }
  if (softened.empty()) return;
  if (spec.contacts.linear) {
    facts.add("softened", "{}: no matter to linear springs", softened);
    return;
  }
  const Real real_bound = particle_step_bound(spec, true).bound;
  facts.add("softened",
            "{}; the true moduli would bound the particle step to {:.3g} s, {:.0f} times as many steps",
            softened, real_bound, particle_step_bound(spec).bound / real_bound);
}

void add_particles(Facts& facts, const CaseSpec& spec) {
  Real mass = 0;
  for (std::size_t i = 0; i < spec.particles.size(); ++i) {
    const auto& population = spec.particles[i];
    const Real density = spec.materials[static_cast<std::size_t>(population.material)].density;
    const auto sphere = [&](Real d) { return density * dem::sphere_volume(0.5 * d); };
    if (population.fill) {
      for (const Real radius : draw_radii(spec, i)) mass += sphere(2 * radius);
    }
    for (const auto& particle : population.list) mass += sphere(particle.diameter);
  }
  const DiameterRange diameters = diameter_range(spec);
  const std::string size = diameters.smallest == diameters.largest
                               ? millimetres(diameters.smallest)
                               : millimetres(diameters.smallest) + " to " + millimetres(diameters.largest);
  facts.add("particles", "{}, diameter {} mm, {:.4g} kg in all", particle_count(spec), size, mass);
  for (const auto& population : spec.particles) {
    if (!population.feed) continue;
    facts.add("feed", "about {} particles from {:g} to {:g} s", fed_count(spec, population),
              population.feed->from, population.feed->to);
  }
  const dem::TimeStepBound bound = particle_step_bound(spec);
  facts.add("particle step", "{:g} s, {:.0f} % of the bound {:.3g} s at impacts of {:g} m/s",
            spec.time.particle_step, 100 * spec.time.particle_step / bound.bound, bound.bound,
            spec.time.impact_speed);
  add_true_moduli(facts, spec);
}

/// Largest speed of the gas at an inlet [m/s], and its Courant number there.
void add_inlets(Facts& facts, const CaseSpec& spec, const CartesianGrid& grid) {
  for (const auto& patch : spec.gas->boundaries) {
    const auto* inlet = std::get_if<cfd::Inlet>(&patch.kind);
    if (inlet == nullptr || patch.wall) continue;
    const int axis = cfd::axis_of(patch.on);
    const Box& box = spec.domain.box;
    Real area = 1;
    for (int a = 0; a < 3; ++a) {
      if (a == axis) continue;
      const Real low = patch.region ? std::max(box.min[a], patch.region->min[a]) : box.min[a];
      const Real high = patch.region ? std::min(box.max[a], patch.region->max[a]) : box.max[a];
      area *= high - low;
    }
    // Without region other boundaries of the side take a part: then only a velocity says how fast the gas is.
    if (!inlet->velocity && (!patch.region || !inlet->flow_rate)) continue;
    const Real velocity = inlet->velocity ? *inlet->velocity : inlet->share * *inlet->flow_rate / area;
    const Real width = grid.width(axis, cfd::is_max(patch.on) ? grid.cells()[axis] - 1 : 0);
    facts.add("inlet " + patch.name, "{:.4g} m/s, Courant number {:.3g} at the inlet", velocity,
              velocity * spec.time.gas_step / width);
  }
}

/// How many parcels a particle will have met: below some ten the coating is as uneven as the parcels make it.
void add_spray(Facts& facts, const CaseSpec& spec) {
  const auto particles = static_cast<Real>(particle_count(spec));
  for (const auto& nozzle : spec.spray) {
    facts.add("spray " + nozzle.name, "{:.4g} g/min with {:.3g} % solids from {:g} to {:g} s",
              6e4 * nozzle.mass_rate, 100 * nozzle.solids_fraction, nozzle.from, nozzle.to);
    if (nozzle.sizes || particles == 0) continue;  // the mean volume is known when the run begins
    const Real parcel =
        nozzle.droplets_per_parcel * nozzle.density * dem::sphere_volume(0.5 * nozzle.droplet_diameter);
    const Real parcels = nozzle.mass_rate * (nozzle.to - nozzle.from) / parcel;
    facts.add("", "{:.4g} parcels of {:g} droplets, {:.3g} a particle{}", parcels, nozzle.droplets_per_parcel,
              parcels / particles,
              parcels < 10 * particles ? ": so few make coatings uneven, docs/theory/spray.md" : "");
  }
}

std::string cells_text(const CartesianGrid& grid) {
  Vec3 least = {1e300, 1e300, 1e300}, most{};
  for (int axis = 0; axis < 3; ++axis) {
    for (Index i = 0; i < grid.cells()[axis]; ++i) {
      least[axis] = std::min(least[axis], grid.width(axis, i));
      most[axis] = std::max(most[axis], grid.width(axis, i));
    }
  }
  const auto range = [&](int axis) {
    return grid.uniform(axis) ? millimetres(least[axis])
                              : millimetres(least[axis]) + "-" + millimetres(most[axis]);
  };
  return fmt::format("{} x {} x {} = {} cells of {} x {} x {} mm", grid.cells().x, grid.cells().y,
                     grid.cells().z, grid.cell_count(), range(0), range(1), range(2));
}

/// How far cells are from cubes and from their neighbours; an axis of one cell does not count.
std::string shape_text(const CartesianGrid& grid) {
  Real smallest = 1e300, largest = 0, aspect = 1, growth = 1;
  Vec3 least = {1e300, 1e300, 1e300}, most{};
  for (int axis = 0; axis < 3; ++axis) {
    const Index n = grid.cells()[axis];
    if (n == 1) continue;
    for (Index i = 0; i < n; ++i) {
      const Real width = grid.width(axis, i);
      least[axis] = std::min(least[axis], width);
      most[axis] = std::max(most[axis], width);
      if (i + 1 == n && !grid.periodic(axis)) continue;
      const Real next = grid.width(axis, (i + 1) % n);
      growth = std::max({growth, width / next, next / width});
    }
    smallest = std::min(smallest, least[axis]);
    largest = std::max(largest, most[axis]);
  }
  if (largest == 0) return "one cell";
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      if (a != b) aspect = std::max(aspect, most[a] / least[b]);
    }
  }
  return fmt::format(
      "sides from {} to {} mm, largest aspect ratio {:.4g}, neighbours differ by a factor of {:.4g}",
      millimetres(smallest), millimetres(largest), aspect, growth);
}

}  // namespace

std::string describe_case_text(const CaseSpec& spec) {
  Facts facts;
  const Vec3 size = spec.domain.box.max - spec.domain.box.min;
  facts.add("domain", "{} x {} x {} mm", millimetres(size.x), millimetres(size.y), millimetres(size.z));
  facts.add("time", "{:g} s in {:.0f} outer steps of {:g} s{}", spec.time.end,
            spec.time.end / spec.time.gas_step, spec.time.gas_step,
            spec.particles.empty() ? "" : fmt::format(", each of {} particle steps", spec.time.substeps()));
  if (!spec.particles.empty()) add_particles(facts, spec);
  if (spec.gas) {
    const CartesianGrid grid = make_grid(spec.gas->grid, spec.domain);
    facts.add("gas grid", "{}", cells_text(grid));
    facts.add("gas cells", "{}", shape_text(grid));
    add_inlets(facts, spec, grid);
    facts.add("convection", "{}",
              cfd::convection_models[static_cast<std::size_t>(spec.gas->options.convection)].name);
  }
  if (spec.gas && !spec.particles.empty()) {
    facts.add("drag", "{}", spec.coupling.drag);
    facts.add("transfer grid", "{}", cells_text(make_grid(spec.coupling.transfer_grid, spec.domain)));
  }
  if (!spec.particles.empty()) add_spray(facts, spec);
  facts.add("output", "{} lines, {} probes, {} histograms", spec.output.lines.size(),
            spec.output.probes.size(), spec.output.histograms.size());
  return fmt::format("{}\n{}", spec.title, facts.text());
}

namespace {

/// Builds what a run would build, so that all that can be wrong with the case shows.
void try_to_build(const CaseSpec& spec) {
  const Kokkos::ScopeGuard kokkos(Kokkos::InitializationSettings().set_disable_warnings(true));
  std::vector<dem::Wall> walls;
  try {
    if (!spec.particles.empty()) {
      dem::Engine particles(make_engine_setup(spec, spec.time.particle_step));
      particles.set_particles(make_particles(spec, particles.setup().walls));
      (void)make_feeds(spec, particles.setup());
      walls = particles.setup().walls;
    } else {
      walls = make_walls(spec);
    }
    if (!spec.gas) return;
    const cfd::GasSolver gas = make_gas_solver(spec, walls);
    if (!spec.particles.empty()) make_exchange(spec, gas);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", spec.file, error.what()));
  }
}

}  // namespace

int check_command(const std::string& case_file, const std::vector<std::string>& overrides) {
  const CaseSpec spec = load_case(case_file, overrides);
  try_to_build(spec);
  fmt::print("{}", describe_case_text(spec));
  for (const auto& warning : spec.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("{}: nothing wrong\n", case_file);
  return 0;
}

}  // namespace pellicle::tools
