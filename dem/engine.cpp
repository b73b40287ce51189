#include "dem/engine.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"
#include "dem/cohesion.hpp"
#include "dem/engine_arrays.hpp"

namespace pellicle::dem {

Engine::Engine(const EngineSetup& setup)
    : setup_(setup),
      walls_(setup.walls, setup.domain.box, setup.contacts),
      tuner_(setup.skin.smallest_fraction),
      history_(setup.contacts.springs(), setup.contacts.cohesion.has_value()),
      flags_("dem::engine::flags"),
      leaving_("dem::engine::leaving", domain_side_count) {
  if (!(setup.time_step > 0)) throw std::invalid_argument("the particle time step must be positive");
  auto& options = setup_.contacts;
  std::visit([&](auto& law) { law.clip = options.clip; }, options.normal);
  std::visit([&](auto& law) { law.time_step = setup.time_step; }, options.tangential);
  std::visit([&](auto& law) { law.time_step = setup.time_step; }, options.rolling);
  if (std::holds_alternative<Linear>(options.normal)) require_stiffness(setup_.materials, setup_.pairs);
  const auto table = make_pair_table(setup_.materials, setup_.pairs, options.clip);
  table_ = make_array<PairParameters>("dem::engine::pair_table", table.size());
  const auto host = Kokkos::create_mirror_view(table_);
  std::copy(table.begin(), table.end(), host.data());
  Kokkos::deep_copy(table_, host);
  step_.gravity = setup_.gravity;
  step_.time_step = setup_.time_step;
  flags_() = MotionFlags{};
}

void Engine::set_particles(const std::vector<ParticleSeed>& seeds) {
  std::vector<bool> of_particles(setup_.materials.size(), false);
  std::vector<bool> of_walls(setup_.materials.size(), false);
  for (const ParticleSeed& s : seeds) of_particles.at(static_cast<std::size_t>(s.material)) = true;
  for (const Wall& w : setup_.walls) of_walls.at(static_cast<std::size_t>(w.material)) = true;
  for (const int material : setup_.later.materials)
    of_particles.at(static_cast<std::size_t>(material)) = true;
  require_pairs(setup_.materials, setup_.pairs, of_particles, of_walls);
  allocate(seeds.size());
  for (Companion* companion : companions_) companion->reset(particles_.count);
  walls_.forget();
  search_.clear();
  tuner_ = SkinTuner(setup_.skin.smallest_fraction);
  started_ = false;
  left_ = 0;
  left_by_side_ = {};
  entered_mass_ = left_mass_ = 0;
  entered_momentum_ = left_momentum_ = gravity_impulse_ = grown_momentum_ = Vec3{};
  grown_mass_ = 0;
  volume_time_ = 0;
  next_id_ = 0;
  one_particle_material_ = true;
  any_fixed_ = false;
  take_stock(seeds);
  if (largest_radius_ == 0) return;
  search_.emplace_back(setup_.domain, skin(), smallest_radius_, largest_radius_);
  walls_.set_allowances(setup_.skin, setup_.time_step, smallest_radius_, largest_radius_);
  if (seeds.empty()) return;
  put_particles(seeds, 0);
  const ParticleTotals totals = compute_totals();
  moving_mass_ = totals.mass;
  moving_volume_ = totals.volume;
  canonicalise();
}

SkinOptions Engine::skin() const {
  SkinOptions skin = setup_.skin;
  if (setup_.contacts.cohesion) skin.reach = bridge_reach(*setup_.contacts.cohesion, smallest_radius_);
  if (skin.tuned) skin.smallest_fraction = tuner_.fraction();
  return skin;
}

void Engine::tune_skin(bool outdated) {
  if (!setup_.skin.tuned || list_.count == 0) return;
  if (!tuner_.note_step(neighbours_per_particle(), outdated)) return;
  search_.front().set_smallest_fraction(tuner_.fraction());
  list_valid_ = false;
}

void Engine::advance(int count, core::Timers& timers, const SubstepHook& before_motion) {
  advance(count, NoFluid{}, timers, before_motion);
}

void Engine::begin_substep(core::Timers& timers) {
  walls_.move_to(wall_time());
  if (!list_valid_) {
    const core::Timers::Scope scope(timers, core::Part::neighbours);
    if (!search_.empty()) build_lists();
    Kokkos::fence("dem::engine::list_built");
    list_valid_ = true;
    steps_since_build_ = 0;
    ++builds_;
  } else if (walls_.list_outdated()) {
    const core::Timers::Scope scope(timers, core::Part::neighbours);
    walls_.build_list(particles_, list_, 2);
  }
  // The first kick takes the velocity from the start of the step to its middle only.
  step_.kick = started_ ? setup_.time_step : 0.5 * setup_.time_step;
  const core::Timers::Scope scope(timers, core::Part::contacts);
  const ContactInput input{setup_.domain,
                           particles_,
                           list_,
                           table_,
                           static_cast<Index>(setup_.materials.size()),
                           step_.kick,
                           one_particle_material_,
                           any_fixed_};
  compute_contact_forces(input, setup_.contacts, result_);
  if (setup_.contacts.cohesion) add_bridge_forces(input, *setup_.contacts.cohesion, result_);
  walls_.add_contacts(input, setup_.contacts, result_);
  Kokkos::fence("dem::engine::contacts_done");
}

void Engine::build_lists() {
  history_.pack(list_);
  search_.front().build(particles_, setup_.time_step, list_, work_);
  history_.unpack(list_);
  result_.springs = history_.slots();
  walls_.build_list(particles_, list_, 1);
}

Real Engine::wall_time() const {
  return walls_since_ < 0 ? Real(-1) : static_cast<Real>(substeps_ - walls_since_) * setup_.time_step;
}

void Engine::end_substep() {
  started_ = true;
  ++substeps_;
  if (++steps_since_build_ >= Displacement::most_steps) list_valid_ = false;
  gravity_impulse_ += step_.kick * moving_mass_ * setup_.gravity;
  volume_time_ += step_.kick * moving_volume_;
  const bool outdated = flags_().list_outdated != 0;
  tune_skin(outdated);
  if (outdated) {
    list_valid_ = false;
    flags_().list_outdated = 0;
    if (flags_().broken_particle >= 0) {
      const auto motion = Kokkos::create_mirror_view_and_copy(
          Kokkos::HostSpace{}, Kokkos::subview(particles_.velocity_spin, flags_().broken_particle));
      const auto place = Kokkos::create_mirror_view_and_copy(
          Kokkos::HostSpace{}, Kokkos::subview(particles_.position_radius, flags_().broken_particle));
      throw RunError("particle " + std::to_string(motion().id) + " has velocity (" +
                     std::to_string(motion().vx) + ", " + std::to_string(motion().vy) + ", " +
                     std::to_string(motion().vz) + ") m/s near (" + std::to_string(place().x) + ", " +
                     std::to_string(place().y) + ", " + std::to_string(place().z) +
                     ") m: not a number or too fast; a smaller particle_step or stiffer particles may help");
    }
  }
}

ContactReport Engine::collect_report() {
  ContactReport sum;
  if (result_.report.extent(0) == 0) return sum;
  const Index blocks = contact_block_count(particles_.count);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, result_.report);
  // Blocks beyond the present ones carry what they saw before particles left.
  for (Index b = 0; b < static_cast<Index>(host.extent(0)); ++b) {
    const BlockReport& r = host(b);
    sum.include(r);
    sum.support_impulse += r.support_impulse;
    if (b < blocks) sum.touching_pairs += r.touching;
    if (b < blocks) sum.bridges += r.bridges;
  }
  sum.touching_pairs /= 2;
  sum.bridges /= 2;
  Kokkos::deep_copy(result_.report, BlockReport{});
  for (const WallReport& r : walls_.collect_reports()) {
    sum.include(r);
    sum.wall_impulse += r.impulse;
    sum.touching_walls += r.touching;
    sum.wall_bridges += r.bridges;
    sum.crowded_walls += r.crowded;
    sum.walls.push_back({-r.impulse, r.angular_impulse, r.touching});
  }
  if (!(sum.largest_overlap <= setup_.contacts.overlap_limit)) stop_for_overlap(sum.largest_overlap);
  return sum;
}

void Engine::stop_for_overlap(Real overlap) const {
  throw RunError("two bodies overlapped by " + std::to_string(overlap) +
                 " of the smaller radius, over the limit of " +
                 std::to_string(setup_.contacts.overlap_limit) +
                 " (contacts.overlap_limit); a larger youngs_modulus or a smaller particle_step may help");
}

std::size_t Engine::bytes() const {
  std::size_t total = bytes_of(particles_.position_radius) + bytes_of(particles_.velocity_spin) +
                      bytes_of(particles_.mass) + bytes_of(particles_.acceleration) +
                      bytes_of(particles_.angular_acceleration);
  total += bytes_of(work_) + bytes_of(result_.touching) + bytes_of(free_order_) + bytes_of(result_.report);
  total +=
      bytes_of(list_.offset) + bytes_of(list_.partner) + bytes_of(list_.owner) + bytes_of(list_.displacement);
  total += walls_.bytes();
  for (const NeighbourSearch& search : search_) total += search.bytes();
  total += history_.bytes();
  for (const Companion* companion : companions_) total += companion->bytes();
  return total;
}

Real Engine::neighbours_per_particle() const {
  return list_.count == 0 ? 0 : static_cast<Real>(list_.entries) / list_.count;
}

}  // namespace pellicle::dem
