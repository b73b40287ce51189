#include "tools/pellicle/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <utility>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "core/progress.hpp"
#include "core/version.hpp"
#include "coupling/substeps.hpp"
#include "tools/pellicle/build_case.hpp"
#include "tools/pellicle/build_gas.hpp"
#include "tools/pellicle/build_heat.hpp"
#include "tools/pellicle/build_spray.hpp"

namespace pellicle::tools {
namespace {

using core::Conserved;
using core::Part;

volatile std::sig_atomic_t stop_requested = 0;

}  // namespace

void request_stop() noexcept { stop_requested = 1; }

int run_simulation(const CaseSpec& spec, const RunOptions& options) {
  stop_requested = 0;
  return Simulation(spec, options).run();
}

Simulation::Simulation(const CaseSpec& spec, const RunOptions& options)
    : spec_(spec),
      options_(options),
      time_(spec.time.end, spec.time.gas_step, spec.time.particle_step,
            spec.particles.empty() ? 0 : spec.time.longest_settling()) {
  if (!spec_.particles.empty()) {
    particles_.emplace(make_engine_setup(spec_, time_.particle_step()));
    zones_ = make_zones(spec_, particles_->particles());
    for (spray::ZoneVisits& zone : zones_) particles_->attach(zone);
    wetness_ = make_wetness(spec_);
    feeds_ = make_feeds(spec_, particles_->setup());
    const bool sprayed = !spec_.spray.empty();
    if (spec_.heat || sprayed)
      particles_->attach(surface_.emplace(make_surface(spec_, particles_->particles())));
    if (sprayed) {
      spray_.emplace(make_spray_options(spec_), particles_->setup().walls);
      particles_->attach(spray_->hit_records());
    }
  }
  if (spec_.gas) {
    gas_.emplace(make_gas_solver(spec_, particles_ ? particles_->setup().walls : make_walls(spec_)));
    no_particles_ = cfd::make_empty_exchange(gas_->grid());
  }
  if (particles_ && gas_) exchange_.emplace(make_exchange(spec_, *gas_));
  if (spec_.heat) heat_.emplace(make_heat_options(spec_), gas_->geometry().volume);
  if (spray_ && exchange_) {
    droplet_gas_.emplace(make_droplet_gas(spec_, *exchange_, gas_->geometry().volume, spray_->units()));
  }
  if (spec_.heat && spec_.heat->contact_conduction) conduction_.emplace(make_conduction_options(spec_));
  for (const WallSpec& wall : spec_.walls) {
    walls_.push_back({wall.name, {}, {}, 0, {}, {}});
    if (wall.temperature) walls_.back().heat = 0;
  }
  if (particles_) particles_->hold_walls();  // until t = 0
  if (options_.until) time_.end_at(*options_.until);
  checkpoints_ = time_.schedule(spec_.output.checkpoint_every, "output.checkpoint.every");
  // Everything that can be wrong with the input has shown by the end of start(); the folder is touched only then.
  options_.resume ? resume() : start();
}

void Simulation::start() {
  if (particles_) {
    const std::vector<dem::ParticleSeed> seeds = make_particles(spec_, particles_->setup().walls);
    particles_->set_particles(seeds);
    if (surface_) surface_->note_bare_particles();
    if (spec_.heat) set_initial_surface(spec_, seeds, *surface_);
    if (surface_) surface_->grow(*particles_);
  }
  folder_.emplace(options_.output_folder,
                  options_.overwrite ? ResultsFolder::Existing::overwrite : ResultsFolder::Existing::refuse);
  folder_->write_case(options_.case_yaml_text);
  core::log().open_file(folder_->run_log());
  outputs_.emplace(spec_, *folder_, time_, gas_ ? &gas_->grid() : nullptr, std::nullopt);
  if (!time_.settling()) release_gas();
}

void Simulation::resume() {
  folder_.emplace(options_.output_folder, ResultsFolder::Existing::resume);
  if (!folder_->has_checkpoint()) {
    throw InputError(folder_->path().string() + ": holds no checkpoint to resume from; run without --resume");
  }
  core::CheckpointReader file(folder_->checkpoint());
  core::require_same_case(file.read_string("case"), options_.case_yaml_text);
  folder_->write_case(options_.case_yaml_text);  // time.end and outputs may be new
  core::log().open_file(folder_->run_log());
  time_.load(file);
  if (particles_) particles_->load(file);
  for (std::size_t i = 0; i < feeds_.size(); ++i) feeds_[i].load(file, "feeds/" + std::to_string(i));
  if (gas_ && time_.step() >= 0) gas_->load(file);
  if (exchange_ && time_.step() >= 0) exchange_->load(file);
  if (heat_ && time_.step() >= 0) heat_->load(file);
  if (conduction_ && time_.step() >= 0) conduction_->load(file);
  if (spray_) spray_->load(file);
  if (droplet_gas_) droplet_gas_->load(file);
  for (spray::ContactWetness& region : wetness_) region.load(file);
  if (surface_ && time_.step() >= 0) {
    settled_left_surface_ = {
        {file.read_double("run/settled_left_liquid"), file.read_double("run/settled_left_solids")},
        file.read_double("run/settled_left_enthalpy")};
  }
  ledger_.load(file);
  outputs_.emplace(spec_, *folder_, time_, gas_ ? &gas_->grid() : nullptr, time_.step());
  outputs_->load(file);
  wall_impulse_ = file.read_vec3("run/wall_impulse");
  support_impulse_ = file.read_vec3("run/support_impulse");
  for (WallFigures& wall : walls_) {
    const std::string path = "run/walls/" + wall.name;
    wall.impulse = file.read_vec3(path + "/impulse");
    wall.angular_impulse = file.read_vec3(path + "/angular_impulse");
    wall.contacts = file.read_int64(path + "/contacts");
    wall.gas_impulse = file.read_vec3(path + "/gas_impulse");
  }
  note_heat_to_walls();
  summary_.gas.load(file);
  settled_gravity_ = file.read_vec3("run/settled_gravity");
  settled_wall_ = file.read_vec3("run/settled_wall");
  settled_volume_time_ = file.read_double("run/settled_volume_time");
  settled_left_mass_ = file.read_double("run/settled_left_mass");
  settled_grown_mass_ = file.read_double("run/settled_grown_mass");
  settled_grown_momentum_ = file.read_vec3("run/settled_grown_momentum");
  quiet_steps_ = file.read_int64("run/quiet_steps");
  summary_.largest_overlap = file.read_double("run/largest_overlap");
  summary_.largest_overlap_ratio = file.read_double("run/largest_overlap_ratio");
  summary_.largest_impact_speed = file.read_double("run/largest_impact_speed");
  summary_.particle_steps = file.read_double("run/particle_steps");
  // Wall times are no part of the state: they come from the summary of the run that is resumed.
  const Summary before = read_summary(folder_->summary());
  wall_before_ = before.wall_seconds;
  setup_before_ = before.setup_seconds;
  summary_.settling_seconds = before.settling_seconds;
  for (int part = 0; part < core::part_count; ++part) {
    timers_.add(static_cast<Part>(part), before.wall_by_part[static_cast<std::size_t>(part)]);
  }
  core::log().info("resumed at t = {:g} s", time_.time());
}

int Simulation::run() {
  for (const std::string& warning : spec_.warnings) core::log().warn("{}", warning);
  for (const std::string& message : time_.messages()) core::log().warn("{}", message);
  wall_begin_ = core::wall_clock();
  summary_.setup_seconds = setup_before_ + wall_begin_ - made_;
  core::Progress progress(time_.time(), time_.end());
  try {
    if (!options_.resume) {
      if (time_.step() == 0) write_outputs();
      write_checkpoint();
    }
    while (!time_.finished() && stop_requested == 0) {
      advance_outer_step();
      write_outputs(time_.finished() || stop_requested != 0);
      if (checkpoints_.due(time_.step())) write_checkpoint();
      progress.update(time_.time(), [this] { return describe_progress(); });
    }
    progress.finish();
    report_numerics();
    write_checkpoint();
  } catch (const RunError& failure) {
    progress.finish();
    write_summary("failed", failure.what());
    throw RunError(std::string(failure.what()) + " (at t = " + std::to_string(time_.time()) + " s; " +
                   folder_->checkpoint().string() + " holds the last good state)");
  }
  write_summary(stop_requested == 0 ? "done" : "stopped");
  return stop_requested == 0 ? 0 : static_cast<int>(ExitCode::interrupted);
}

/// What the engines had to put up with since this process began, for the log.
void Simulation::report_numerics() const {
  for (std::size_t i = 0; i < feeds_.size(); ++i) {
    if (!feeds_[i].is_due(time_.time())) continue;
    core::log().warn("feed {}: there was no room for all particles; {:.3g} {} wait to enter", i,
                     feeds_[i].waiting(time_.time()), feeds_[i].counts_particles() ? "particles" : "kg");
  }
  const GasConvergence& gas = summary_.gas;
  if (gas.steps > 0) {
    core::log().info(
        "largest Courant number of the gas: {:.3g}; no step's last outer iteration changed its velocities by "
        "more than {:.2g} of the largest",
        gas.largest_courant_number, gas.largest_velocity_change);
    // A tenth is what the first step of a jet into gas at rest has; steps that go on like that are too long.
    if (constexpr Real large_change = 0.2; gas.largest_velocity_change > large_change) {
      core::log().warn(
          "that is much: take a smaller time.gas_step or a larger gas.solver.max_outer_iterations");
    }
  }
  if (crowded_steps_ > 0) {
    core::log().warn("in {} gas steps a transfer cell stayed below coupling.minimum_void_fraction",
                     crowded_steps_);
  }
  if (crowded_walls_ > 0) {
    core::log().warn(
        "{} times a particle overlapped more triangles of walls than are compared; a coarser mesh may help",
        crowded_walls_);
  }
}

void Simulation::advance_outer_step() {
  feed_particles();
  const int parts = choose_parts();
  for (int part = 0; part < parts; ++part) {
    sample_gas();
    inject_spray(part, parts);
    move_particles(parts);
    collect_spray(parts);
    deposit_particles(parts);
    exchange_heat(parts);
    if (surface_ && !time_.settling()) surface_->grow(*particles_);
    if (!time_.settling()) move_gas(parts);
  }
  watch_contacts();
  time_.advance();
  if (time_.step() > 0) watch_zones();
  if (spec_.time.settle_until && time_.settling()) watch_settling();
  if (time_.step() == 0) release_gas();  // from below: the bed has settled
}

/// Ends the settling when the particles have been slower than asked for during the time in which free fall from rest
/// makes them ten times as fast: at the start they rest too.
void Simulation::watch_settling() {
  const SettleSpec& settle = *spec_.time.settle_until;
  const dem::ParticleTotals totals = particles_->compute_totals();
  const Real speed = totals.mass > 0 ? std::sqrt(2 * totals.kinetic_energy / totals.mass) : 0;
  quiet_steps_ = speed < settle.speed ? quiet_steps_ + 1 : 0;
  const Real gravity = norm(spec_.gravity);
  const Real fall = gravity > 0 ? 10 * settle.speed / gravity : 0;
  const auto needed =
      std::max(std::int64_t{20}, static_cast<std::int64_t>(std::ceil(fall / time_.gas_step())));
  if (quiet_steps_ >= needed) {
    core::log().info("settled after {:.4g} s: {:.3g} m/s", settle.at_most + time_.time(), speed);
    time_.end_settling();
  } else if (time_.step() == -1) {
    core::log().warn(
        "not settled after {:g} s: {:.3g} m/s is over time.settle.speed {:g} m/s, or was until now",
        settle.at_most, speed, settle.speed);
  }
}

void Simulation::feed_particles() {
  if (time_.settling()) return;
  const core::Timers::Scope scope(timers_, Part::neighbours);
  std::size_t population = 0;
  for (dem::Feed& feed : feeds_) {
    while (!spec_.particles[population].feed) ++population;
    const PopulationSpec& fed = spec_.particles[population++];
    if (!feed.is_due(time_.time())) continue;
    if (spec_.heat) {
      surface_->expect({initial_temperature(spec_, fed), initial_film(fed, 1)});
    }
    particles_->add_particles(feed.draw(
        time_.time(), time_.step(), dem::spheres_near(*particles_, feed.reach()), particles_->wall_time()));
  }
}

/// Equal parts of the outer step in which gas and particles take turns, for the Courant number asked for. Follows from the
/// state alone, so that a run that resumes chooses the same.
int Simulation::choose_parts() const {
  if (!gas_ || !spec_.time.courant || time_.settling()) return 1;
  const Real needed = gas_->courant_number(time_.gas_step()) / *spec_.time.courant;
  return core::choose_parts(needed, particles_ ? time_.substeps() : 0);
}

void Simulation::sample_gas() {
  if (particles_) {
    const core::Timers::Scope scope(timers_, Part::neighbours);
    particles_->prepare_outer_step();
  }
  if (!coupled()) return;
  const core::Timers::Scope scope(timers_, Part::coupling);
  const cfd::GasState& gas = gas_->state();
  exchange_->sample_gas(gas.velocity, gas.pressure_gradient, gas.density,
                        gas.scalars[index_of(cfd::Scalar::temperature)]);
  exchange_->compute_coefficients(particles_->particles());
}

void Simulation::move_particles(int parts) {
  if (!particles_) return;
  const int substeps = time_.substeps() / parts;
  summary_.particle_steps += static_cast<double>(particles_->particles().count) * substeps;
  if (!coupled()) {
    particles_->advance(substeps, timers_, substep_hook(substeps));
    return;
  }
  coupling::advance_particles(*particles_, substeps, exchange_->fluid_force(particles_->particles()), timers_,
                              substep_hook(substeps));
}

void Simulation::deposit_particles(int parts) {
  if (!coupled()) return;
  const core::Timers::Scope scope(timers_, Part::coupling);
  exchange_->deposit(particles_->particles(), time_.gas_step() / parts);
  if (exchange_->bound_report().cells_left_over > 0) ++crowded_steps_;
}

void Simulation::exchange_heat(int parts) {
  if (!heat_ || !coupled()) return;
  const core::Timers::Scope scope(timers_, Part::heat);
  heat_->update(particles_->particles(), *exchange_, gas_->state(), *surface_, time_.gas_step() / parts);
  if (!conduction_) return;
  conduction_->update(*particles_, *surface_, time_.gas_step() / parts);
  note_heat_to_walls();
}

void Simulation::note_heat_to_walls() {
  if (!conduction_) return;
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (walls_[w].heat) walls_[w].heat = conduction_->heat_to_walls()[w];
  }
}

Real Simulation::heat_to_walls() const {
  Real sum = 0;
  for (const WallFigures& wall : walls_) sum += wall.heat.value_or(0);
  return sum;
}

void Simulation::move_gas(int parts) {
  if (!gas_) return;
  const Real dt = time_.gas_step() / parts;
  {
    const core::Timers::Scope scope(timers_, Part::gas);
    cfd::ParticleExchange felt = exchange_ ? exchange_->exchange() : no_particles_;
    if (heat_) heat_->add_to(felt);
    if (droplet_gas_) droplet_gas_->add_to(felt);
    summary_.gas.add(gas_->update(dt, felt), dt);
    add_gas_forces(dt);
  }
  if (!coupled()) return;
  const core::Timers::Scope scope(timers_, Part::coupling);
  exchange_->close_step(gas_->state(), dt);
}

/// What the gas does to the walls that it sees.
void Simulation::add_gas_forces(Real dt) {
  const auto& surfaces = gas_->geometry().surfaces;
  const std::vector<Vec3> forces = gas_->surface_forces();
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const auto wall = std::find_if(walls_.begin(), walls_.end(),
                                   [&](const WallFigures& w) { return w.name == surfaces[s].name; });
    if (wall != walls_.end()) wall->gas_impulse += dt * forces[s];
  }
  const bool boxed =
      std::any_of(spec_.walls.begin(), spec_.walls.end(), [](const WallSpec& wall) { return wall.box; });
  if (!boxed) return;
  const std::array<Vec3, 6> sides = gas_->side_forces();
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const WallSpec& wall = spec_.walls[w];
    if (!wall.box) continue;
    for (std::size_t side = 0; side < sides.size(); ++side) {
      const bool left_out =
          std::find(wall.open.begin(), wall.open.end(), static_cast<cfd::Side>(side)) != wall.open.end();
      if (!left_out) walls_[w].gas_impulse += dt * sides[side];
    }
  }
}

/// t = 0: the particles have settled, the gas begins around them, and the ledger opens.
void Simulation::release_gas() {
  if (wall_begin_ > 0) summary_.settling_seconds = wall_before_ + core::wall_clock() - wall_begin_;
  if (exchange_) {
    exchange_->initialise(particles_->particles());
    gas_->initialise(spec_.gas->velocity, exchange_->exchange().void_fraction);
  } else if (gas_) {
    gas_->initialise(spec_.gas->velocity);
  }
  if (particles_) {
    settled_gravity_ = particles_->gravity_impulse();
    settled_volume_time_ = particles_->volume_time();
    settled_wall_ = impulse_through_walls();
    ledger_.open(Conserved::particle_mass, particles_->compute_totals().mass);
    settled_left_mass_ = particles_->left_mass();
    settled_grown_mass_ = particles_->grown_mass();
    settled_grown_momentum_ = particles_->grown_momentum();
    particles_->start_walls();
    for (WallFigures& wall : walls_) wall.impulse = wall.angular_impulse = Vec3{};
    watch_zones();
  }
  if (gas_) ledger_.open(Conserved::gas_mass, gas_->balance().mass_initial);
  if (surface_) settled_left_surface_ = surface_->left();
  if (gas_ && gas_->balance(cfd::Scalar::temperature)) ledger_.open(Conserved::energy, energy_stock());
  if (has_vapour()) ledger_.open(Conserved::water, water_stock());
  open_spray_ledger();
  Vec3 momentum{};
  if (gas_) momentum += gas_->balance().momentum;
  if (particles_) momentum += particles_->compute_totals().momentum;
  ledger_.open(Conserved::momentum, momentum);
}

/// What walls and fixed particles gave to the moving ones, less what left with some of them, since the start. Contacts
/// book what a fixed particle receives: what it gives is the opposite.
Vec3 Simulation::impulse_through_walls() const {
  return wall_impulse_ - support_impulse_ - particles_->left_momentum();
}

void Simulation::watch_zones() {
  const core::Timers::Scope scope(timers_, Part::output);
  for (spray::ZoneVisits& zone : zones_) zone.update(time_.time(), particle_columns().film);
}

void Simulation::watch_contacts() {
  if (!particles_) return;
  const core::Timers::Scope scope(timers_, Part::contacts);
  contacts_ = particles_->collect_report();
  wall_impulse_ += contacts_.wall_impulse;
  support_impulse_ += contacts_.support_impulse;
  for (std::size_t w = 0; w < contacts_.walls.size(); ++w) {
    walls_[w].impulse += contacts_.walls[w].impulse;
    walls_[w].angular_impulse += contacts_.walls[w].angular_impulse;
    walls_[w].contacts = contacts_.walls[w].touching;
  }
  crowded_walls_ += contacts_.crowded_walls;
  summary_.largest_overlap = std::max(summary_.largest_overlap, contacts_.largest_depth);
  summary_.largest_overlap_ratio = std::max(summary_.largest_overlap_ratio, contacts_.largest_overlap);
  summary_.largest_impact_speed = std::max(summary_.largest_impact_speed, contacts_.largest_approach_speed);
}

/// Sensible heat of the gas, latent heat of its vapour, enthalpy of the particles with their films [J].
Real Simulation::energy_stock() const {
  Real stock = gas_->balance(cfd::Scalar::temperature)->stock;
  if (!heat_) return stock;
  if (const auto* vapour = gas_->balance(cfd::Scalar::moisture)) {
    stock += heat_->options().water.latent * vapour->stock;
  }
  return stock + surface_->compute_totals().enthalpy + summary_.spray.heat.in_flight;
}

/// Vapour in the gas, liquid on the particles and in flight [kg].
Real Simulation::water_stock() const {
  Real stock = has_vapour() ? gas_->balance(cfd::Scalar::moisture)->stock : 0;
  if (surface_) stock += surface_->compute_totals().film.liquid;
  return stock + summary_.spray.liquid_in_flight();
}

/// What gas and particles exchange with each other stays inside, unless the gas gives without losing: that is a source, by
/// choice of the user.
void Simulation::update_heat_ledger() {
  const cfd::ScalarBalance* warmth = gas_->balance(cfd::Scalar::temperature);
  const cfd::ScalarBalance* vapour = gas_->balance(cfd::Scalar::moisture);
  const Real latent = heat_ ? heat_->options().water.latent : 0;
  const bool one_way = heat_ && heat_->options().one_way;
  const heat::HeatTotals given = one_way ? heat_->totals() : heat::HeatTotals{};
  Real enthalpy = 0;  // that came with particles, with the droplets that they captured, and from walls [J]
  if (heat_) {
    enthalpy = surface_->entered().enthalpy - (surface_->left().enthalpy - settled_left_surface_.enthalpy) +
               summary_.spray.enthalpy_kept(spec_.droplets.evaporation) - heat_to_walls();
  }
  if (warmth) {
    const Real through =
        warmth->through_boundaries() + enthalpy + (vapour ? latent * vapour->through_boundaries() : 0);
    ledger_.set_stock(Conserved::energy, energy_stock());
    ledger_.set_totals(Conserved::energy, Vec3{through, 0, 0},
                       Vec3{heat_ ? given.heat - latent * given.evaporated : warmth->sources, 0, 0},
                       warmth->gross + (vapour ? latent * vapour->gross : 0) + std::abs(heat_to_walls()));
  }
  if (vapour) {
    ledger_.set_stock(Conserved::water, water_stock());
    ledger_.set_totals(
        Conserved::water,
        Vec3{vapour->through_boundaries() + films_that_came().liquid + summary_.spray.liquid_kept(), 0, 0},
        Vec3{heat_ ? -given.evaporated : vapour->sources, 0, 0},
        vapour->gross + summary_.spray.liquid_injected());
  }
}

/// Mass of the gas; momentum of gas, particles and what is still in transit between them. Through the boundaries goes
/// what the gas exchanges with its boundaries and what walls give to particles; gravity is a source.
void Simulation::update_ledger() {
  if (time_.step() < 0) return;
  Vec3 stock{}, through{}, sources{};
  Real gross = 0;
  Real pending = 0;
  update_spray_ledger();
  if (gas_) update_heat_ledger();
  if (gas_) {
    const cfd::GasBalance& gas = gas_->balance();
    ledger_.set_stock(Conserved::gas_mass, gas.mass);
    ledger_.set_totals(Conserved::gas_mass, Vec3{gas.mass_in() - gas.mass_out(), 0, 0},
                       Vec3{gas.mass_given, 0, 0}, gas.mass_in() + gas.mass_out() + std::abs(gas.mass_given));
    stock += gas.momentum;
    through += gas.convected + gas.boundary_pressure + gas.boundary_shear;
    sources += gas.body_force + gas.vapour;
    gross += norm(gas.gross);
  }
  if (summary_.spray.two_way) {
    stock += summary_.spray.momentum.in_flight;
    through += summary_.spray.momentum_kept() + summary_.spray.impulses.bounced;
    // The gas counts the momentum of all vapour as a source, also of that which comes from droplets; that of captured droplets
    // went out with them, and particles get it again, or what of it weightless films do not take.
    sources += summary_.spray.impulses.gravity - summary_.spray.impulses.vapour +
               summary_.spray.momentum.to_particles;
    gross += norm(summary_.spray.momentum.injected) + norm(summary_.spray.impulses.on_gas);
  }
  if (exchange_) {
    stock += exchange_->totals().pending;
    gross += exchange_->totals().gross;
    pending = norm(exchange_->totals().pending);
    // What the gas gives to fixed particles leaves through whatever holds them.
    through -= exchange_->totals().fixed_received;
    if (exchange_->options().exchange == coupling::Exchange::one_way) {
      // The gas gives without losing: a source of momentum, by choice of the user.
      sources += exchange_->totals().particles_received;
    } else if (!exchange_->options().pressure_gradient_force) {
      // The gas gets (1 - eps) grad p, which no particle gives: likewise.
      sources += gas_->balance().particle_pressure;
    }
  }
  if (particles_) {
    const dem::ParticleTotals totals = particles_->compute_totals();
    stock += totals.momentum;
    through += impulse_through_walls() - settled_wall_ + particles_->entered_momentum();
    // Films come and go with the velocity of their particles.
    sources += particles_->grown_momentum() - settled_grown_momentum_;
    const Real grown = particles_->grown_mass() - settled_grown_mass_;
    const Real left_mass = particles_->left_mass() - settled_left_mass_;
    ledger_.set_stock(Conserved::particle_mass, totals.mass);
    ledger_.set_totals(Conserved::particle_mass, Vec3{particles_->entered_mass() - left_mass, 0, 0},
                       Vec3{grown, 0, 0}, particles_->entered_mass() + left_mass);
    const Vec3 gravity = particles_->gravity_impulse() - settled_gravity_;
    sources += gravity;
    gross += norm(gravity);
    if (exchange_ && exchange_->options().pressure_gradient_force) {
      sources +=
          (-spec_.gas->options.density * (particles_->volume_time() - settled_volume_time_)) * spec_.gravity;
    }
  }
  summary_.instantaneous_momentum_defect = gross > 0 ? pending / gross : 0;
  ledger_.set_stock(Conserved::momentum, stock);
  ledger_.set_totals(Conserved::momentum, through, sources, gross);
}

Real Simulation::contacts_per_particle() const {
  if (!particles_ || particles_->particles().count == 0) return 0;
  return 2.0 * static_cast<Real>(contacts_.touching_pairs) / particles_->particles().count;
}

void Simulation::write_outputs(bool last) {
  if (time_.step() < 0) return;
  const core::Timers::Scope scope(timers_, Part::output);
  OutputState state;
  state.step = time_.step();
  state.time = time_.time();
  state.contacts = {contacts_per_particle(), summary_.largest_overlap_ratio};
  GasFields fields;
  ParticleColumns columns;
  if (particles_) {
    columns = particle_columns();
    state.particles = &columns;
  }
  state.walls = &walls_;
  if (particles_) state.zones = &zones_;
  if (particles_) state.wetness = &wetness_;
  if (spray_) state.spray = &*spray_;
  if (particles_) state.sides = &particles_->left_by_side();
  if (gas_) {
    const cfd::GasState& gas = gas_->state();
    fields = {&gas_->grid(),
              gas.velocity,
              gas.pressure,
              gas.void_fraction,
              gas.pressure_gradient,
              gas.density,
              gas.scalars[index_of(cfd::Scalar::temperature)],
              gas.scalars[index_of(cfd::Scalar::moisture)],
              spec_.gas->options.reference_pressure,
              gas.turbulent_kinetic_energy,
              gas.turbulent_dissipation,
              gas.eddy_viscosity};
    for (std::size_t a = 0; a < 3; ++a) {
      fields.volume_flux[a] = gas.volume_flux[a];
      fields.open_area[a] = gas_->geometry().area[a];
    }
    state.gas = &fields;
  }
  outputs_->sample(state, last);
}

ParticleColumns Simulation::particle_columns() const {
  ParticleColumns columns = particles_->particles();
  if (heat_) columns.temperature = surface_->temperature();
  if (spray_) columns.hits = spray_->hit_record();
  if (surface_) {
    columns.film = surface_->film();
    columns.solids_density = spec_.coating.solids_density;
    columns.radius_grows = spec_.coating.growth == heat::FilmGrowth::mass_and_radius;
  }
  return columns;
}

void Simulation::write_checkpoint() {
  const core::Timers::Scope scope(timers_, Part::output);
  // What resuming cannot have is dropped here too, so that both go on the same way.
  if (particles_) particles_->canonicalise();
  if (gas_) gas_->drop_solver_hierarchies();
  outputs_->flush();
  write_summary("running");
  core::CheckpointWriter file(folder_->checkpoint());
  file.write("case", options_.case_yaml_text);
  time_.save(file);
  if (particles_) particles_->save(file);
  for (std::size_t i = 0; i < feeds_.size(); ++i) feeds_[i].save(file, "feeds/" + std::to_string(i));
  if (gas_ && time_.step() >= 0) gas_->save(file);
  if (exchange_ && time_.step() >= 0) exchange_->save(file);
  if (heat_ && time_.step() >= 0) heat_->save(file);
  if (conduction_ && time_.step() >= 0) conduction_->save(file);
  if (spray_) spray_->save(file);
  if (droplet_gas_) droplet_gas_->save(file);
  for (const spray::ContactWetness& region : wetness_) region.save(file);
  if (surface_ && time_.step() >= 0) {
    file.write("run/settled_left_liquid", settled_left_surface_.film.liquid);
    file.write("run/settled_left_solids", settled_left_surface_.film.solids);
    file.write("run/settled_left_enthalpy", settled_left_surface_.enthalpy);
  }
  ledger_.save(file);
  outputs_->save(file);
  file.write("run/wall_impulse", wall_impulse_);
  file.write("run/support_impulse", support_impulse_);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const std::string path = "run/walls/" + walls_[w].name;
    file.write(path + "/impulse", walls_[w].impulse);
    file.write(path + "/angular_impulse", walls_[w].angular_impulse);
    file.write(path + "/contacts", walls_[w].contacts);
    file.write(path + "/gas_impulse", walls_[w].gas_impulse);
  }
  summary_.gas.save(file);
  file.write("run/settled_gravity", settled_gravity_);
  file.write("run/settled_wall", settled_wall_);
  file.write("run/settled_volume_time", settled_volume_time_);
  file.write("run/settled_left_mass", settled_left_mass_);
  file.write("run/settled_grown_mass", settled_grown_mass_);
  file.write("run/settled_grown_momentum", settled_grown_momentum_);
  file.write("run/quiet_steps", quiet_steps_);
  file.write("run/largest_overlap", summary_.largest_overlap);
  file.write("run/largest_overlap_ratio", summary_.largest_overlap_ratio);
  file.write("run/largest_impact_speed", summary_.largest_impact_speed);
  file.write("run/particle_steps", summary_.particle_steps);
  file.close();
}

void Simulation::write_summary(const std::string& status, const std::string& message) {
  update_ledger();
  summary_.status = status;
  summary_.message = message;
  summary_.title = spec_.title;
  summary_.program_version = version();
  summary_.program_commit = commit();
  summary_.simulated_seconds = std::max<Real>(time_.time(), 0);
  summary_.wall_seconds = wall_before_ + core::wall_clock() - wall_begin_;
  if (time_.settling()) summary_.settling_seconds = summary_.wall_seconds;
  summary_.set_times(timers_);
  summary_.set_defects(ledger_);
  summary_.threads = Host().concurrency();
  summary_.gas_steps = gas_ ? std::max<std::int64_t>(time_.step(), 0) : 0;
  summary_.walls = walls_;
  if (particles_) {
    summary_.particles = particles_->particles().count;
    summary_.engine_bytes = static_cast<std::int64_t>(particles_->bytes());
    summary_.contacts_per_particle = contacts_per_particle();
    summary_.particles_left_through_open_sides = particles_->left_through_open_sides();
    summary_.left_by_side = particles_->left_by_side();
    summary_.mass_left = particles_->left_mass();
    summary_.particles_fed = 0;
    summary_.mass_fed = 0;
    for (const dem::Feed& feed : feeds_) {
      summary_.particles_fed += feed.fed_particles();
      summary_.mass_fed += feed.fed_mass();
    }
  }
  if (gas_) summary_.gas_boundaries = collect_gas_boundaries(*gas_);
  summary_.peak_memory_bytes = peak_memory_bytes();
  tools::write_summary(folder_->summary(), summary_);
}

std::string Simulation::describe_progress() const {
  if (!particles_) return {};
  return std::to_string(particles_->particles().count) + " particles, largest overlap " +
         fmt::format("{:.1f}", 100 * summary_.largest_overlap_ratio) + " % of the radius";
}

}  // namespace pellicle::tools
