#include "spray/spray.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/to_device.hpp"

namespace pellicle::spray {
namespace {

/// Particles are faster within an outer step than at its beginning by no more than this [m/s]; it widens the search, and
/// one that is faster still is met at the next move.
constexpr Real speed_margin = 1;

/// Where every wall is at a time [s] after walls began to move.
struct FindPoses {
  DeviceArray<dem::WallBody> body;
  DeviceArray<dem::WallPose> pose;
  Real time;
  KOKKOS_INLINE_FUNCTION void operator()(const Index w) const {
    pose(w) = time < 0 ? dem::compute_pose_at_rest(body(w).motion)
                       : dem::compute_pose(body(w).motion, body(w).turning, time);
  }
};

/// Ranks of a parcel among those that fly on (lower half) and among those that were captured (upper half).
constexpr std::int64_t captured_unit = std::int64_t{1} << 32;

/// Parts the parcels: those that fly on go aside in their order, what was captured becomes hits.
struct PartParcels {
  Parcels from, to;
  DeviceArray<Hit> hits;
  DeviceArray<std::int64_t> ended;
  DeviceArray<EndedWater> ended_water;
  DeviceArray<NozzleView> nozzle;
  WholeUnits units;
  ParticlePushes pushes;
  DeviceArray<dem::VelocitySpin> velocity_spin;
  ParcelGas gas;
  Real time;  ///< at which the outer step began [s]

  KOKKOS_INLINE_FUNCTION void operator()(const Index i, std::int64_t& rank, const bool final) const {
    const ParcelEnd end = from.end(i);
    if (final) {
      const ParcelName name = from.name(i);
      if (end.fate == ParcelFate::flying) {
        const auto place = static_cast<Index>(rank & (captured_unit - 1));
        to.state(place) = from.state(i);
        to.name(place) = name;
        to.end(place) = ParcelEnd{};
        if (from.evaporate) to.water(place) = from.water(i);
      } else {
        // Whole numbers: the order of adding does not matter.
        const Index row = name.nozzle * fate_count + static_cast<int>(end.fate);
        Kokkos::atomic_inc(&ended(row));
        if (from.evaporate) add_water(row, from.water(i), nozzle(name.nozzle));
      }
      if (end.fate == ParcelFate::captured)
        hits(static_cast<Index>(rank / captured_unit)) = make_hit(i, end, name);
    }
    if (end.fate == ParcelFate::flying) rank += 1;
    if (end.fate == ParcelFate::captured) rank += captured_unit;
  }

  KOKKOS_INLINE_FUNCTION void add_water(Index row, const ParcelWater& water, const NozzleView& n) const {
    EndedWater& sum = ended_water(row);
    Kokkos::atomic_add(&sum.evaporated, water.evaporated);
    Kokkos::atomic_add(&sum.enthalpy, water.enthalpy);
    if (water.evaporated >= n.liquid_units) Kokkos::atomic_inc(&sum.dust);
  }

  KOKKOS_INLINE_FUNCTION Hit make_hit(Index i, const ParcelEnd& end, const ParcelName& name) const {
    const ParcelState parcel = from.state(i);
    Hit hit;
    hit.id = velocity_spin(end.particle).id;
    hit.nozzle = name.nozzle;
    hit.number = name.number;
    hit.particle = end.particle;
    hit.cell = gas.velocity.extent(0) > 0 ? gas.cell_of(parcel.position) : -1;
    hit.time = time + end.time;
    hit.film = content_of(from, i, nozzle(name.nozzle), units);
    if (from.evaporate) hit.enthalpy = units.heat * static_cast<Real>(from.water(i).enthalpy);
    if (pushes.is_on()) {
      const Real mass = mass_of(from, i, nozzle(name.nozzle), units);
      pushes.capture(end.particle, mass * parcel.velocity, mass);
    }
    return hit;
  }
};

struct CountCaptured {
  DeviceArray<ParcelEnd> end;
  KOKKOS_INLINE_FUNCTION void operator()(const Index i, Index& count) const {
    if (end(i).fate == ParcelFate::captured) ++count;
  }
};

constexpr Index sum_block = 512;

/// What the parcels of one nozzle are and have, in blocks of a fixed size.
struct SumFlying {
  Parcels parcels;
  DeviceArray<NozzleView> nozzle;
  WholeUnits units;
  std::int32_t which;
  DeviceArray<FlyingWater> partial;
  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index end = Kokkos::min((block + 1) * sum_block, parcels.count);
    FlyingWater sum;
    for (Index i = block * sum_block; i < end; ++i) {
      if (parcels.name(i).nozzle != which) continue;
      sum.mass += mass_of(parcels, i, nozzle(which), units);
      if (!parcels.evaporate) continue;
      sum.solids += content_of(parcels, i, nozzle(which), units).solids;
      sum.evaporated += units.water * static_cast<Real>(parcels.water(i).evaporated);
      sum.enthalpy += units.heat * static_cast<Real>(parcels.water(i).enthalpy);
    }
    partial(block) = sum;
  }
};

/// Momentum [kg m/s] of the parcels of each fate from one on, in blocks of a fixed size.
struct SumMomentum {
  Parcels parcels;
  DeviceArray<NozzleView> nozzle;
  WholeUnits units;
  Index first;
  DeviceArray<Vec3> partial;
  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index begin = first + block * sum_block;
    const Index end = Kokkos::min(begin + sum_block, parcels.count);
    Vec3 sum[fate_count];
    for (Index i = begin; i < end; ++i) {
      sum[static_cast<int>(parcels.end(i).fate)] +=
          mass_of(parcels, i, nozzle(parcels.name(i).nozzle), units) * parcels.state(i).velocity;
    }
    for (int fate = 0; fate < fate_count; ++fate) partial(block * fate_count + fate) = sum[fate];
  }
};

}  // namespace

Spray::Spray(const SprayOptions& options, const std::vector<dem::Wall>& walls)
    : options_(options),
      records_("spray::spray::hit_record", "spray/hit_record"),
      ended_("spray::spray::ended", options.nozzles.size() * fate_count),
      pose_at_end_("spray::spray::pose_at_end", walls.size()) {
  std::vector<NozzleView> views;
  std::vector<Real> temperatures;
  Real largest = 0;
  for (const Nozzle& nozzle : options_.nozzles) {
    injectors_.emplace_back(nozzle, static_cast<std::int32_t>(injectors_.size()), options_.seed);
    largest = std::max(largest, injectors_.back().parcel_mass());
    temperatures.push_back(nozzle.temperature);
  }
  units_ = make_units(largest);
  for (Injector& injector : injectors_) {
    if (options_.heat.on) injector.let_evaporate(options_.solids_density, options_.heat, units_);
    views.push_back(injector.view());
  }
  if (options_.heat.on) {
    const std::size_t rows = injectors_.size() * fate_count;
    parcels_.evaporate = aside_.evaporate = true;
    ended_water_ = DeviceArray<EndedWater>("spray::spray::ended_water", rows);
    dried_ = DeviceArray<std::int64_t>("spray::spray::dried", injectors_.size());
    evaporated_.resize(rows);
    ended_enthalpy_.resize(rows);
    dust_.resize(rows);
  }
  nozzle_ = to_device("spray::spray::nozzle", views);
  nozzle_temperature_ = to_device("spray::spray::nozzle_temperature", temperatures);
  for (const dem::Wall& wall : walls) {
    walls_move_ = walls_move_ || dem::has_to_turn(wall) ||
                  norm_squared(wall.motion.amplitude) * wall.motion.frequency != 0;
  }
}

int Spray::choose_stride(const ParticleBounds& bounds, Real substep) const {
  if (options_.parcel_step > 0) {
    return std::clamp(static_cast<int>(std::lround(options_.parcel_step / substep)), 1, substeps_);
  }
  if (!(bounds.smallest_radius > 0)) return 1;
  Real speed = largest_parcel_speed(parcels_);
  for (const Injector& injector : injectors_) speed = std::max(speed, injector.nozzle().speed);
  const Real substeps = bounds.smallest_radius / (std::max(speed, Real(1e-9)) * substep);
  return static_cast<int>(std::clamp(std::floor(substeps), Real(1), static_cast<Real>(substeps_)));
}

void Spray::inject(Real time, int substeps, const dem::Engine& engine) {
  time_ = time;
  substeps_ = substeps;
  const Real substep = engine.setup().time_step;
  half_step_ = 0.5 * substep;
  const Real end = time + substeps * substep;
  std::int64_t wanted = parcels_.count;
  for (const Injector& injector : injectors_)
    wanted += std::max<std::int64_t>(0, injector.due(end) - injector.injected());
  reserve(parcels_, static_cast<Index>(wanted));
  const Index before = parcels_.count;
  for (Injector& injector : injectors_) injector.add(time, end, parcels_, units_);
  if (parcels_.count == 0) return;
  make_pushes(engine.particles().count);
  if (options_.watch_momentum) {
    const Vec3 born = sum_momentum(before)[static_cast<std::size_t>(ParcelFate::flying)];
    for (int axis = 0; axis < 3; ++axis) momentum_[static_cast<std::size_t>(axis)].add(born[axis]);
  }
  const ParticleBounds bounds = find_bounds(engine.particles());
  largest_speed_ = bounds.largest_speed + speed_margin;
  stride_ = choose_stride(bounds, substep);
}

MovingWalls Spray::walls_during(const dem::Engine& engine, int substeps) const {
  const dem::WallGeometry& geometry = engine.walls().geometry();
  if (!walls_move_) return {geometry, geometry.pose};
  // The same number as the engine's own when that time has come: a path goes on where the last one ended.
  const Real substep = engine.setup().time_step;
  const Real now = engine.wall_time();
  const Real then = now < 0 ? now : static_cast<Real>(std::llround(now / substep) + substeps) * substep;
  Kokkos::parallel_for("spray::spray::find_poses", DeviceRange(0, static_cast<Index>(pose_at_end_.extent(0))),
                       FindPoses{geometry.body, pose_at_end_, then});
  return {geometry, pose_at_end_};
}

bool Spray::move(int k, const dem::Engine& engine, const ParcelGas& gas) {
  if (parcels_.count == 0 || k % stride_ != 0) return false;
  const int ahead = std::min(stride_, substeps_ - k);
  const Real substep = engine.setup().time_step;
  ParcelMove move;
  move.parcels = parcels_;
  move.nozzle = nozzle_;
  move.dried = dried_;
  move.units = units_;
  move.pushes = pushes_;
  move.gas = gas;
  if (const dem::NeighbourSearch* search = engine.search(); search != nullptr) {
    move.targets = {engine.particles(), search->grid(), search->cell_start(), search->order(),
                    largest_speed_};
  }
  move.walls = walls_during(engine, ahead);
  move.domain = engine.setup().domain;
  move.gravity = options_.gravity;
  move.begin = k * substep;
  move.end = (k + ahead) * substep;
  move.seed = options_.seed;
  move.substep = engine.substeps();
  move_parcels(move);
  return true;
}

std::array<Vec3, fate_count> Spray::sum_momentum(Index first) const {
  std::array<Vec3, fate_count> sum{};
  const Index blocks = (parcels_.count - first + sum_block - 1) / sum_block;
  if (blocks == 0) return sum;
  const std::size_t size = static_cast<std::size_t>(blocks) * fate_count;
  if (momentum_scratch_.extent(0) < size) {
    momentum_scratch_ = DeviceArray<Vec3>(
        Kokkos::view_alloc(Kokkos::WithoutInitializing, "spray::spray::momentum"), 2 * size);
  }
  Kokkos::parallel_for("spray::spray::sum_momentum", DeviceRange(0, blocks),
                       SumMomentum{parcels_, nozzle_, units_, first, momentum_scratch_});
  const auto host = Kokkos::create_mirror_view_and_copy(
      Kokkos::HostSpace{}, Kokkos::subview(momentum_scratch_, std::pair<std::size_t, std::size_t>(0, size)));
  for (std::size_t i = 0; i < size; ++i) sum[i % fate_count] += host(i);
  return sum;
}

ParcelMomentum Spray::momentum() const {
  if (!options_.watch_momentum) return {};
  const auto vector = [&](std::size_t first) {
    return Vec3{momentum_[first].value(), momentum_[first + 1].value(), momentum_[first + 2].value()};
  };
  return {vector(0),
          vector(3),
          vector(6),
          vector(9),
          sum_momentum(0)[static_cast<std::size_t>(ParcelFate::flying)],
          {pushed_[0].value(), pushed_[1].value(), pushed_[2].value()}};
}

void Spray::collect(const dem::Particles& particles, const heat::SurfaceState& surface, const ParcelGas& gas,
                    const DeviceArray<Real>& gas_temperature) {
  if (parcels_.count == 0) return;
  if (options_.watch_momentum) {
    const std::array<Vec3, fate_count> sum = sum_momentum(0);
    for (std::size_t fate = 1; fate < fate_count; ++fate) {
      for (int axis = 0; axis < 3; ++axis)
        momentum_[3 * fate + static_cast<std::size_t>(axis)].add(sum[fate][axis]);
    }
  }
  Index captured = 0;
  Kokkos::parallel_reduce("spray::spray::count_captured", DeviceRange(0, parcels_.count),
                          CountCaptured{parcels_.end}, captured);
  hits_.reserve(captured);
  reserve(aside_, parcels_.count);
  std::int64_t ranks = 0;
  Kokkos::parallel_scan("spray::spray::part_parcels", DeviceRange(0, parcels_.count),
                        PartParcels{parcels_, aside_, hits_.hits(), ended_, ended_water_, nozzle_, units_,
                                    pushes_, particles.velocity_spin, gas, time_},
                        ranks);
  std::swap(parcels_, aside_);
  parcels_.count = static_cast<Index>(ranks & (captured_unit - 1));
  aside_.count = 0;
  if (options_.heat.on) count_ended_water();
  if (pushes_.is_on()) push(particles);
  if (captured == 0) return;
  hits_.sort(captured);
  HitTargets targets{surface.bare(particles), surface.film(),       records_.values(), {},
                     surface.heat_capacity(), surface.capacities(), gas_temperature,   nozzle_temperature_,
                     options_.heat.on};
  const bool warm = gas_temperature.extent(0) > 0;
  if (warm) targets.temperature = surface.temperature();
  add_hits(hits_.hits(), captured, targets);
  if (!warm) return;
  const HitHeat heat = sum_heat(hits_.hits(), captured, heat_scratch_);
  enthalpy_.add(heat.enthalpy);
  free_heat_.add(heat.free_heat);
}

void Spray::make_pushes(Index particles) {
  if (!options_.push_particles || pushes_.of.extent(0) >= static_cast<std::size_t>(particles)) return;
  // All is 0 between two outer steps: nothing is to be kept.
  pushes_ = {
      DeviceArray<ParticlePush>("spray::spray::pushes", static_cast<std::size_t>(particles + particles / 4)),
      units_};
}

void Spray::push(const dem::Particles& particles) {
  const Vec3 given = push_particles(particles, pushes_, half_step_, push_scratch_);
  for (int axis = 0; axis < 3; ++axis) pushed_[static_cast<std::size_t>(axis)].add(given[axis]);
}

void Spray::count_ended_water() {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, ended_water_);
  for (std::size_t row = 0; row < host.extent(0); ++row) {
    evaporated_[row].add(units_.water * static_cast<Real>(host(row).evaporated));
    ended_enthalpy_[row].add(units_.heat * static_cast<Real>(host(row).enthalpy));
    dust_[row] += host(row).dust;
  }
  Kokkos::deep_copy(ended_water_, EndedWater{});
}

std::vector<FlyingWater> Spray::sum_flying() const {
  std::vector<FlyingWater> all(injectors_.size());
  const Index blocks = (parcels_.count + sum_block - 1) / sum_block;
  if (blocks == 0) return all;
  const DeviceArray<FlyingWater> partial(
      Kokkos::view_alloc(Kokkos::WithoutInitializing, "spray::spray::flying"),
      static_cast<std::size_t>(blocks));
  for (std::size_t n = 0; n < all.size(); ++n) {
    Kokkos::parallel_for("spray::spray::sum_flying", DeviceRange(0, blocks),
                         SumFlying{parcels_, nozzle_, units_, static_cast<std::int32_t>(n), partial});
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, partial);
    for (Index b = 0; b < blocks; ++b) {
      all[n].mass += host(b).mass;
      all[n].solids += host(b).solids;
      all[n].evaporated += host(b).evaporated;
      all[n].enthalpy += host(b).enthalpy;
    }
  }
  return all;
}

std::vector<NozzleFigures> Spray::figures() const {
  const auto ended = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, ended_);
  const auto dried = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, dried_);
  const std::vector<FlyingWater> flying = sum_flying();
  std::vector<NozzleFigures> all;
  for (std::size_t n = 0; n < injectors_.size(); ++n) {
    const Injector& injector = injectors_[n];
    const auto row_of = [&](ParcelFate fate) { return n * fate_count + static_cast<std::size_t>(fate); };
    const auto parcels = [&](ParcelFate fate) {
      return static_cast<Real>(ended(row_of(fate))) * injector.parcel_mass();
    };
    const auto lost = [&](ParcelFate fate) {
      return evaporated_.empty() ? Real(0) : evaporated_[row_of(fate)].value();
    };
    const auto mass = [&](ParcelFate fate) { return parcels(fate) - lost(fate); };
    NozzleFigures f;
    f.name = injector.nozzle().name;
    f.parcels = injector.injected();
    f.injected = static_cast<Real>(f.parcels) * injector.parcel_mass();
    f.captured = mass(ParcelFate::captured);
    f.wall_loss = mass(ParcelFate::wall_loss);
    f.overspray = mass(ParcelFate::overspray);
    f.in_flight = flying[n].mass;
    f.evaporated = flying[n].evaporated + lost(ParcelFate::captured) + lost(ParcelFate::wall_loss) +
                   lost(ParcelFate::overspray) + lost(ParcelFate::evaporated);
    f.solids_fraction = injector.nozzle().solids_fraction;
    f.captured_solids = f.solids_fraction * parcels(ParcelFate::captured);
    f.wall_solids = f.solids_fraction * parcels(ParcelFate::wall_loss);
    f.overspray_solids = f.solids_fraction * parcels(ParcelFate::overspray);
    f.in_flight_solids = options_.heat.on ? flying[n].solids : f.solids_fraction * f.in_flight;
    if (options_.heat.on) {
      const Real solids = f.solids_fraction * injector.parcel_mass();
      f.dried = static_cast<Real>(dried(n)) * solids;
      f.dust_captured = static_cast<Real>(dust_[row_of(ParcelFate::captured)]) * solids;
    }
    all.push_back(f);
  }
  return all;
}

SprayHeat Spray::heat() const {
  SprayHeat heat{enthalpy_.value(), free_heat_.value()};
  if (!options_.heat.on) return heat;
  const std::vector<FlyingWater> flying = sum_flying();
  for (std::size_t n = 0; n < injectors_.size(); ++n) {
    const auto ended = [&](ParcelFate fate) {
      return ended_enthalpy_[n * fate_count + static_cast<std::size_t>(fate)].value();
    };
    heat.injected += static_cast<Real>(injectors_[n].injected()) * units_.heat *
                     static_cast<Real>(injectors_[n].enthalpy(units_));
    heat.wall_loss += ended(ParcelFate::wall_loss);
    heat.overspray += ended(ParcelFate::overspray);
    heat.in_flight += flying[n].enthalpy;
  }
  return heat;
}

std::size_t Spray::bytes() const {
  return parcels_.bytes() + aside_.bytes() + hits_.bytes() + records_.bytes();
}

void Spray::save(core::CheckpointWriter& file) const {
  spray::save(parcels_, file);
  std::vector<std::int64_t> injected;
  for (const Injector& injector : injectors_) injected.push_back(injector.injected());
  file.write("spray/injected", injected);
  file.write("spray/ended", Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, ended_));
  if (options_.heat.on) {
    std::vector<double> sums;
    for (const auto* list : {&evaporated_, &ended_enthalpy_}) {
      for (const core::ExactSum& sum : *list) sums.insert(sums.end(), {sum.parts()[0], sum.parts()[1]});
    }
    file.write("spray/ended_water", sums);
    file.write("spray/dust", dust_);
    file.write("spray/dried", Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, dried_));
  }
  const auto enthalpy = enthalpy_.parts();
  const auto free_heat = free_heat_.parts();
  std::vector<double> momentum;
  for (const core::ExactSum& sum : momentum_)
    momentum.insert(momentum.end(), {sum.parts()[0], sum.parts()[1]});
  for (const core::ExactSum& sum : pushed_) momentum.insert(momentum.end(), {sum.parts()[0], sum.parts()[1]});
  file.write("spray/momentum", momentum);
  file.write("spray/heat", std::vector<double>{enthalpy[0], enthalpy[1], free_heat[0], free_heat[1]});
}

void Spray::load(const core::CheckpointReader& file) {
  spray::load(parcels_, file);
  std::vector<std::int64_t> injected(injectors_.size());
  file.read_into("spray/injected", injected);
  for (std::size_t n = 0; n < injectors_.size(); ++n) injectors_[n].set_injected(injected[n]);
  const auto ended = Kokkos::create_mirror_view(ended_);
  file.read_into("spray/ended", ended);
  Kokkos::deep_copy(ended_, ended);
  if (options_.heat.on) {
    std::vector<double> sums(4 * evaporated_.size());
    file.read_into("spray/ended_water", sums);
    std::size_t at = 0;
    for (auto* list : {&evaporated_, &ended_enthalpy_}) {
      for (core::ExactSum& sum : *list) {
        sum.set_parts(sums[at], sums[at + 1]);
        at += 2;
      }
    }
    file.read_into("spray/dust", dust_);
    const auto dried = Kokkos::create_mirror_view(dried_);
    file.read_into("spray/dried", dried);
    Kokkos::deep_copy(dried_, dried);
  }
  std::vector<double> momentum(2 * (momentum_.size() + pushed_.size()));
  file.read_into("spray/momentum", momentum);
  for (std::size_t i = 0; i < momentum_.size(); ++i)
    momentum_[i].set_parts(momentum[2 * i], momentum[2 * i + 1]);
  for (std::size_t i = 0; i < pushed_.size(); ++i) {
    const std::size_t at = 2 * (momentum_.size() + i);
    pushed_[i].set_parts(momentum[at], momentum[at + 1]);
  }
  std::vector<double> heat(4);
  file.read_into("spray/heat", heat);
  enthalpy_.set_parts(heat[0], heat[1]);
  free_heat_.set_parts(heat[2], heat[3]);
}

}  // namespace pellicle::spray
