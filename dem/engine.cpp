#include "dem/engine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"

namespace pellicle::dem {
namespace {

/// Outer steps between two re-sorts of memory: neighbours drift apart slowly, a sort costs about one list build.
constexpr std::int64_t sort_interval = 64;

/// Particles whose sums are formed in one go; fixed, so that totals do not depend on threads.
constexpr Index sum_block = 512;

template <class T>
DeviceArray<T> make_array(const char* label, std::size_t n) {
  return DeviceArray<T>(Kokkos::view_alloc(std::string(label)), n);
}

void permute(const Particles& from, const DeviceArray<std::int32_t>& touching_from,
             const DeviceArray<std::int32_t>& order, const Particles& to,
             const DeviceArray<std::int32_t>& touching_to) {
  Kokkos::parallel_for(
      "dem::engine::permute", DeviceRange(0, to.count), KOKKOS_LAMBDA(const Index slot) {
        const Index p = order(slot);
        to.position_radius(slot) = from.position_radius(p);
        to.velocity_spin(slot) = from.velocity_spin(p);
        to.mass(slot) = from.mass(p);
        to.acceleration(slot) = from.acceleration(p);
        to.angular_acceleration(slot) = from.angular_acceleration(p);
        touching_to(slot) = touching_from(p);
      });
}

/// How many particles are beyond an open side, and the highest index of one that is beyond a closed side.
struct Outside {
  std::int32_t left = 0;
  std::int32_t lost = -1;
};

/// 0 inside, 1 beyond an open side, 2 beyond a closed one. Periodic sides are crossed freely until the next wrap.
KOKKOS_INLINE_FUNCTION int classify(const Domain& domain, const PositionRadius& place) {
  const Vec3 x = place.position();
  int result = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(x[axis] == x[axis])) result = 2;
    if (domain.periodic[axis] != 0) continue;
    if (x[axis] < domain.box.min[axis]) result = domain.open_min[axis] != 0 ? Kokkos::max(result, 1) : 2;
    if (x[axis] > domain.box.max[axis]) result = domain.open_max[axis] != 0 ? Kokkos::max(result, 1) : 2;
  }
  return result;
}

Outside find_outside(const Domain& domain, const Particles& particles) {
  const auto place = particles.position_radius;
  std::int32_t left = 0;
  std::int32_t lost = -1;
  Kokkos::parallel_reduce(
      "dem::engine::find_outside", DeviceRange(0, particles.count),
      KOKKOS_LAMBDA(const Index p, std::int32_t& l, std::int32_t& w) {
        const int where = classify(domain, place(p));
        if (where == 1) ++l;
        if (where == 2 && p > w) w = p;
      },
      Kokkos::Sum<std::int32_t>(left), Kokkos::Max<std::int32_t>(lost));
  return {left, lost < 0 ? -1 : lost};
}

/// New place of every particle that stays, in the present order; returns how many stay.
Index rank_staying(const Domain& domain, const Particles& particles, const DeviceArray<std::int32_t>& order) {
  const auto place = particles.position_radius;
  std::int32_t staying = 0;
  Kokkos::parallel_scan(
      "dem::engine::rank_staying", DeviceRange(0, particles.count),
      KOKKOS_LAMBDA(const Index p, std::int32_t& rank, const bool final) {
        const bool stays = classify(domain, place(p)) != 1;
        if (final && stays) order(rank) = p;
        if (stays) ++rank;
      },
      staying);
  return staying;
}

struct BlockTotals {
  Real mass, volume, kinetic_energy, potential_energy, moment, largest_speed;
  Vec3 momentum, angular_momentum;
};

void sum_blocks(const Particles& particles, const Vec3& gravity, Real half_step,
                const DeviceArray<BlockTotals>& blocks) {
  Kokkos::parallel_for(
      "dem::engine::sum_blocks", DeviceRange(0, static_cast<Index>(blocks.extent(0))),
      KOKKOS_LAMBDA(const Index block) {
        BlockTotals t{};
        const Index end = Kokkos::min((block + 1) * sum_block, particles.count);
        for (Index p = block * sum_block; p < end; ++p) {
          const VelocitySpin motion = particles.velocity_spin(p);
          if (motion.inverse_mass == 0) continue;
          const PositionRadius place = particles.position_radius(p);
          const Real mass = particles.mass(p);
          const Real inertia = 0.4 * mass * place.radius * place.radius;
          const Vec3 v = motion.velocity();
          t.mass += mass;
          t.volume += 4.0 / 3.0 * Kokkos::numbers::pi * place.radius * place.radius * place.radius;
          t.moment += mass * place.z;
          t.kinetic_energy += 0.5 * mass * norm_squared(v) + 0.5 * inertia * norm_squared(motion.spin());
          t.potential_energy -= mass * dot(gravity, place.position());
          const Vec3 half_step_velocity = v - half_step * particles.acceleration(p);
          const Vec3 half_step_spin = motion.spin() - half_step * particles.angular_acceleration(p);
          t.momentum += mass * half_step_velocity;
          t.angular_momentum += mass * cross(place.position(), half_step_velocity) + inertia * half_step_spin;
          t.largest_speed = Kokkos::max(t.largest_speed, norm(v));
        }
        blocks(block) = t;
      });
}

}  // namespace

Engine::Engine(const EngineSetup& setup) : setup_(setup), flags_("dem::engine::flags") {
  if (!(setup.time_step > 0)) throw std::invalid_argument("the particle time step must be positive");
  auto& options = setup_.contacts;
  std::visit([&](auto& law) { law.clip = options.clip; }, options.normal);
  std::visit([&](auto& law) { law.time_step = setup.time_step; }, options.tangential);
  std::visit([&](auto& law) { law.time_step = setup.time_step; }, options.rolling);
  planes_ = make_device_planes(setup_.walls);
  const auto table = make_pair_table(setup_.materials, setup_.pairs, options.clip);
  table_ = make_array<PairParameters>("dem::engine::pair_table", table.size());
  const auto host = Kokkos::create_mirror_view(table_);
  std::copy(table.begin(), table.end(), host.data());
  Kokkos::deep_copy(table_, host);
  step_.gravity = setup_.gravity;
  step_.time_step = setup_.time_step;
  flags_() = MotionFlags{};
}

void Engine::allocate(std::size_t n) {
  const auto make = [n](Particles& p, const char* place, const char* motion, const char* mass,
                        const char* acceleration, const char* angular) {
    p.position_radius = make_array<PositionRadius>(place, n);
    p.velocity_spin = make_array<VelocitySpin>(motion, n);
    p.mass = make_array<Real>(mass, n);
    p.acceleration = make_array<Vec3>(acceleration, n);
    p.angular_acceleration = make_array<Vec3>(angular, n);
    p.count = static_cast<Index>(n);
  };
  make(particles_, "dem::engine::position_radius", "dem::engine::velocity_spin", "dem::engine::mass",
       "dem::engine::acceleration", "dem::engine::angular_acceleration");
  make(scratch_, "dem::engine::position_radius_scratch", "dem::engine::velocity_spin_scratch",
       "dem::engine::mass_scratch", "dem::engine::acceleration_scratch",
       "dem::engine::angular_acceleration_scratch");
  result_.force = make_array<Vec3>("dem::engine::force", n);
  result_.torque = make_array<Vec3>("dem::engine::torque", n);
  result_.touching = make_array<std::int32_t>("dem::engine::touching", n);
  result_.touching_new = make_array<std::int32_t>("dem::engine::touching_new", n);
  result_.report = make_array<BlockReport>("dem::engine::report",
                                           static_cast<std::size_t>(contact_block_count(particles_.count)));
  touching_scratch_ = make_array<std::int32_t>("dem::engine::touching_scratch", n);
  list_valid_ = false;
}

void Engine::set_particles(const std::vector<ParticleSeed>& seeds) {
  std::vector<bool> of_particles(setup_.materials.size(), false);
  std::vector<bool> of_walls(setup_.materials.size(), false);
  for (const ParticleSeed& s : seeds) of_particles.at(static_cast<std::size_t>(s.material)) = true;
  for (const PlaneWall& w : setup_.walls) of_walls.at(static_cast<std::size_t>(w.material)) = true;
  require_pairs(setup_.materials, setup_.pairs, of_particles, of_walls);
  allocate(seeds.size());
  search_.clear();
  started_ = false;
  left_ = 0;
  left_momentum_ = gravity_impulse_ = Vec3{};
  volume_time_ = 0;
  if (seeds.empty()) return;
  const auto place = Kokkos::create_mirror_view(particles_.position_radius);
  const auto motion = Kokkos::create_mirror_view(particles_.velocity_spin);
  const auto mass = Kokkos::create_mirror_view(particles_.mass);
  for (std::size_t p = 0; p < seeds.size(); ++p) {
    const ParticleSeed& s = seeds[p];
    const Real density = setup_.materials.at(static_cast<std::size_t>(s.material)).density;
    mass(p) = density * (4.0 / 3.0) * std::numbers::pi * s.radius * s.radius * s.radius;
    place(p) = {s.position.x, s.position.y, s.position.z, s.radius};
    motion(p) = {s.velocity.x,
                 s.velocity.y,
                 s.velocity.z,
                 s.spin.x,
                 s.spin.y,
                 s.spin.z,
                 s.fixed ? 0 : 1 / mass(p),
                 s.material,
                 static_cast<std::int32_t>(p)};
  }
  Kokkos::deep_copy(particles_.position_radius, place);
  Kokkos::deep_copy(particles_.velocity_spin, motion);
  Kokkos::deep_copy(particles_.mass, mass);
  one_particle_material_ =
      std::all_of(seeds.begin(), seeds.end(), [](const ParticleSeed& s) { return s.material == 0; });
  take_stock();
  search_.emplace_back(setup_.domain, setup_.skin, smallest_radius_, largest_radius_, start_count_);
  canonicalise();
}

void Engine::advance(int count, core::Timers& timers) { advance(count, NoFluid{}, timers); }

void Engine::begin_substep(core::Timers& timers) {
  if (!list_valid_) {
    const core::Timers::Scope scope(timers, core::Part::neighbours);
    if (!search_.empty()) search_.front().build(particles_, planes_, setup_.time_step, list_);
    Kokkos::fence("dem::engine::list_built");
    list_valid_ = true;
    ++builds_;
  }
  // The first kick takes the velocity from the start of the step to its middle only.
  step_.kick = started_ ? setup_.time_step : 0.5 * setup_.time_step;
  const core::Timers::Scope scope(timers, core::Part::contacts);
  const ContactInput input{setup_.domain, particles_,
                           list_,         planes_,
                           table_,        static_cast<Index>(setup_.materials.size()),
                           step_.kick,    one_particle_material_};
  compute_contact_forces(input, setup_.contacts, result_);
  Kokkos::fence("dem::engine::contacts_done");
}

void Engine::end_substep() {
  std::swap(result_.touching, result_.touching_new);
  started_ = true;
  ++substeps_;
  gravity_impulse_ += step_.kick * moving_mass_ * setup_.gravity;
  volume_time_ += step_.kick * moving_volume_;
  if (flags_().list_outdated != 0) {
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

void Engine::sort_memory() {
  if (search_.empty()) return;
  // A build yields the canonical order; the lists it also makes name particles by their old place and are dropped.
  search_.front().build(particles_, planes_, setup_.time_step, list_);
  scratch_.count = particles_.count;
  permute(particles_, result_.touching, search_.front().order(), scratch_, touching_scratch_);
  std::swap(particles_, scratch_);
  std::swap(result_.touching, touching_scratch_);
  list_valid_ = false;
  outer_steps_since_sort_ = 0;
}

void Engine::canonicalise() { sort_memory(); }

void Engine::remove_left() {
  const Index staying = rank_staying(setup_.domain, particles_, touching_scratch_);
  const auto order =
      make_array<std::int32_t>("dem::engine::staying_order", static_cast<std::size_t>(staying));
  Kokkos::deep_copy(order, Kokkos::subview(touching_scratch_, std::pair<Index, Index>(0, staying)));
  left_ += particles_.count - staying;
  const Vec3 momentum = compute_totals().momentum;
  scratch_.count = staying;
  permute(particles_, result_.touching, order, scratch_, touching_scratch_);
  std::swap(particles_, scratch_);
  std::swap(result_.touching, touching_scratch_);
  list_valid_ = false;
  const ParticleTotals rest = compute_totals();
  left_momentum_ += momentum - rest.momentum;
  moving_mass_ = rest.mass;
  moving_volume_ = rest.volume;
}

void Engine::prepare_outer_step() {
  if (particles_.count == 0) return;
  const Outside outside = find_outside(setup_.domain, particles_);
  if (outside.lost >= 0) {
    const auto place = Kokkos::create_mirror_view_and_copy(
        Kokkos::HostSpace{}, Kokkos::subview(particles_.position_radius, outside.lost));
    const auto motion = Kokkos::create_mirror_view_and_copy(
        Kokkos::HostSpace{}, Kokkos::subview(particles_.velocity_spin, outside.lost));
    throw RunError("particle " + std::to_string(motion().id) + " is outside the domain at (" +
                   std::to_string(place().x) + ", " + std::to_string(place().y) + ", " +
                   std::to_string(place().z) +
                   ") m, beyond a side that is not open; no wall held it, or it was too fast for the wall");
  }
  if (outside.left > 0) remove_left();
  if (++outer_steps_since_sort_ >= sort_interval) sort_memory();
}

ContactReport Engine::collect_report() {
  ContactReport sum;
  if (result_.report.extent(0) == 0) return sum;
  const Index blocks = contact_block_count(particles_.count);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, result_.report);
  // Blocks beyond the present ones carry what they saw before particles left.
  for (Index b = 0; b < static_cast<Index>(host.extent(0)); ++b) {
    const BlockReport& r = host(b);
    sum.largest_overlap = std::max(sum.largest_overlap, r.largest_overlap);
    sum.largest_depth = std::max(sum.largest_depth, r.largest_depth);
    sum.largest_approach_speed = std::max(sum.largest_approach_speed, r.largest_approach_speed);
    sum.wall_impulse += r.wall_impulse;
    sum.support_impulse += r.support_impulse;
    if (b < blocks) sum.touching_pairs += r.touching;
    if (b < blocks) sum.touching_walls += r.touching_walls;
  }
  sum.touching_pairs /= 2;
  Kokkos::deep_copy(result_.report, BlockReport{});
  if (!(sum.largest_overlap <= setup_.contacts.overlap_limit)) stop_for_overlap(sum.largest_overlap);
  return sum;
}

void Engine::stop_for_overlap(Real overlap) const {
  throw RunError("two bodies overlapped by " + std::to_string(overlap) +
                 " of the smaller radius, over the limit of " +
                 std::to_string(setup_.contacts.overlap_limit) +
                 " (contacts.overlap_limit); a larger youngs_modulus or a smaller particle_step may help");
}

ParticleTotals Engine::compute_totals() const {
  ParticleTotals totals;
  if (particles_.count == 0) return totals;
  const auto blocks = make_array<BlockTotals>(
      "dem::engine::block_totals", static_cast<std::size_t>((particles_.count + sum_block - 1) / sum_block));
  sum_blocks(particles_, setup_.gravity, 0.5 * setup_.time_step, blocks);
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, blocks);
  Real moment = 0;
  for (std::size_t b = 0; b < host.extent(0); ++b) {
    totals.mass += host(b).mass;
    totals.volume += host(b).volume;
    totals.kinetic_energy += host(b).kinetic_energy;
    totals.potential_energy += host(b).potential_energy;
    totals.momentum += host(b).momentum;
    totals.angular_momentum += host(b).angular_momentum;
    totals.largest_speed = std::max(totals.largest_speed, host(b).largest_speed);
    moment += host(b).moment;
  }
  totals.mean_height = totals.mass > 0 ? moment / totals.mass : 0;
  return totals;
}

Real Engine::neighbours_per_particle() const {
  if (list_.count == 0) return 0;
  std::int32_t total = 0;
  Kokkos::deep_copy(total, Kokkos::subview(list_.offset, list_.count));
  return static_cast<Real>(total) / list_.count;
}

namespace {

/// Host copy of the part of an array that is in use.
template <class T>
auto host_copy(const DeviceArray<T>& array, Index count) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{},
                                             Kokkos::subview(array, std::pair<Index, Index>(0, count)));
}

template <class T>
void read_array(const core::CheckpointReader& file, const char* name, const DeviceArray<T>& array) {
  const auto host = Kokkos::create_mirror_view(array);
  file.read_into(name, host);
  Kokkos::deep_copy(array, host);
}

}  // namespace

void Engine::take_stock() {
  const auto place = host_copy(particles_.position_radius, particles_.count);
  start_count_ = particles_.count;
  smallest_radius_ = largest_radius_ = place(0).radius;
  for (std::size_t p = 0; p < place.extent(0); ++p) {
    smallest_radius_ = std::min(smallest_radius_, place(p).radius);
    largest_radius_ = std::max(largest_radius_, place(p).radius);
  }
  const ParticleTotals totals = compute_totals();
  moving_mass_ = totals.mass;
  moving_volume_ = totals.volume;
}

void Engine::save(core::CheckpointWriter& file) const {
  const Index n = particles_.count;
  file.write("dem/count", std::int64_t{n});
  file.write("dem/substeps", substeps_);
  file.write("dem/list_builds", builds_);
  file.write("dem/left", left_);
  file.write("dem/left_momentum", left_momentum_);
  file.write("dem/gravity_impulse", gravity_impulse_);
  file.write("dem/volume_time", volume_time_);
  file.write("dem/started", std::int64_t{started_ ? 1 : 0});
  if (n == 0) return;
  file.write("dem/smallest_radius", smallest_radius_);
  file.write("dem/largest_radius", largest_radius_);
  file.write("dem/start_count", start_count_);
  file.write("dem/moving_mass", moving_mass_);
  file.write("dem/moving_volume", moving_volume_);
  file.write("dem/one_particle_material", std::int64_t{one_particle_material_ ? 1 : 0});
  file.write("dem/position_radius", host_copy(particles_.position_radius, n));
  file.write("dem/velocity_spin", host_copy(particles_.velocity_spin, n));
  file.write("dem/mass", host_copy(particles_.mass, n));
  file.write("dem/acceleration", host_copy(particles_.acceleration, n));
  file.write("dem/angular_acceleration", host_copy(particles_.angular_acceleration, n));
  file.write("dem/touching", host_copy(result_.touching, n));
}

void Engine::load(core::CheckpointReader& file) {
  const auto n = file.read_int64("dem/count");
  allocate(static_cast<std::size_t>(n));
  substeps_ = file.read_int64("dem/substeps");
  builds_ = file.read_int64("dem/list_builds");
  left_ = file.read_int64("dem/left");
  left_momentum_ = file.read_vec3("dem/left_momentum");
  gravity_impulse_ = file.read_vec3("dem/gravity_impulse");
  volume_time_ = file.read_double("dem/volume_time");
  started_ = file.read_int64("dem/started") != 0;
  search_.clear();
  if (n == 0) return;
  read_array(file, "dem/position_radius", particles_.position_radius);
  read_array(file, "dem/velocity_spin", particles_.velocity_spin);
  read_array(file, "dem/mass", particles_.mass);
  read_array(file, "dem/acceleration", particles_.acceleration);
  read_array(file, "dem/angular_acceleration", particles_.angular_acceleration);
  read_array(file, "dem/touching", result_.touching);
  smallest_radius_ = file.read_double("dem/smallest_radius");
  largest_radius_ = file.read_double("dem/largest_radius");
  start_count_ = file.read_int64("dem/start_count");
  moving_mass_ = file.read_double("dem/moving_mass");
  moving_volume_ = file.read_double("dem/moving_volume");
  one_particle_material_ = file.read_int64("dem/one_particle_material") != 0;
  search_.emplace_back(setup_.domain, setup_.skin, smallest_radius_, largest_radius_, start_count_);
  canonicalise();
}

}  // namespace pellicle::dem
