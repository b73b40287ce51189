#include "spray/spray.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pellicle::spray {
namespace {

/// Particles are faster within an outer step than at its beginning by no more than this [m/s]; it widens the search, and
/// one that is faster still is met at the next move.
constexpr Real speed_margin = 1;

template <class T>
DeviceArray<T> to_device(const char* label, const std::vector<T>& values) {
  DeviceArray<T> array(Kokkos::view_alloc(Kokkos::WithoutInitializing, std::string(label)), values.size());
  const auto host = Kokkos::create_mirror_view(array);
  std::copy(values.begin(), values.end(), host.data());
  Kokkos::deep_copy(array, host);
  return array;
}

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
  DeviceArray<NozzleView> nozzle;
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
      } else {
        // Whole numbers: the order of adding does not matter.
        Kokkos::atomic_inc(&ended(name.nozzle * fate_count + static_cast<int>(end.fate)));
      }
      if (end.fate == ParcelFate::captured)
        hits(static_cast<Index>(rank / captured_unit)) = make_hit(i, end, name);
    }
    if (end.fate == ParcelFate::flying) rank += 1;
    if (end.fate == ParcelFate::captured) rank += captured_unit;
  }

  KOKKOS_INLINE_FUNCTION Hit make_hit(Index i, const ParcelEnd& end, const ParcelName& name) const {
    const ParcelState parcel = from.state(i);
    const NozzleView& n = nozzle(name.nozzle);
    const Real mass = n.density * volume_of(parcel);
    Hit hit;
    hit.id = velocity_spin(end.particle).id;
    hit.nozzle = name.nozzle;
    hit.number = name.number;
    hit.particle = end.particle;
    hit.cell = gas.velocity.extent(0) > 0 ? gas.cell_of(parcel.position) : -1;
    hit.time = time + end.time;
    hit.film.solids = n.solids_fraction * mass;
    hit.film.liquid = mass - hit.film.solids;
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

/// Mass [kg] of the parcels of one nozzle in blocks of a fixed size.
struct SumMass {
  Parcels parcels;
  DeviceArray<NozzleView> nozzle;
  std::int32_t which;
  DeviceArray<Real> partial;
  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index end = Kokkos::min((block + 1) * sum_block, parcels.count);
    Real sum = 0;
    for (Index i = block * sum_block; i < end; ++i) {
      if (parcels.name(i).nozzle == which) sum += nozzle(which).density * volume_of(parcels.state(i));
    }
    partial(block) = sum;
  }
};

/// Momentum [kg m/s] of the parcels of each fate from one on, in blocks of a fixed size.
struct SumMomentum {
  Parcels parcels;
  DeviceArray<NozzleView> nozzle;
  Index first;
  DeviceArray<Vec3> partial;
  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index begin = first + block * sum_block;
    const Index end = Kokkos::min(begin + sum_block, parcels.count);
    Vec3 sum[fate_count];
    for (Index i = begin; i < end; ++i) {
      const ParcelState parcel = parcels.state(i);
      sum[static_cast<int>(parcels.end(i).fate)] +=
          nozzle(parcels.name(i).nozzle).density * volume_of(parcel) * parcel.velocity;
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
  for (const Nozzle& nozzle : options_.nozzles) {
    injectors_.emplace_back(nozzle, static_cast<std::int32_t>(injectors_.size()), options_.seed);
    views.push_back(injectors_.back().view());
    temperatures.push_back(nozzle.temperature);
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
  const Real end = time + substeps * substep;
  std::int64_t wanted = parcels_.count;
  for (const Injector& injector : injectors_)
    wanted += std::max<std::int64_t>(0, injector.due(end) - injector.injected());
  reserve(parcels_, static_cast<Index>(wanted));
  const Index before = parcels_.count;
  for (Injector& injector : injectors_) injector.add(time, end, parcels_);
  if (parcels_.count == 0) return;
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
                       SumMomentum{parcels_, nozzle_, first, momentum_scratch_});
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
  return {vector(0), vector(3), vector(6), vector(9),
          sum_momentum(0)[static_cast<std::size_t>(ParcelFate::flying)]};
}

Real Spray::largest_parcel_mass() const {
  Real largest = 0;
  for (const Injector& injector : injectors_) largest = std::max(largest, injector.parcel_mass());
  return largest;
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
  Kokkos::parallel_scan(
      "spray::spray::part_parcels", DeviceRange(0, parcels_.count),
      PartParcels{parcels_, aside_, hits_.hits(), ended_, nozzle_, particles.velocity_spin, gas, time_},
      ranks);
  std::swap(parcels_, aside_);
  parcels_.count = static_cast<Index>(ranks & (captured_unit - 1));
  aside_.count = 0;
  if (captured == 0) return;
  hits_.sort(captured);
  HitTargets targets{surface.bare(particles), surface.film(),       records_.values(), {},
                     surface.heat_capacity(), surface.capacities(), gas_temperature,   nozzle_temperature_};
  const bool warm = gas_temperature.extent(0) > 0;
  if (warm) targets.temperature = surface.temperature();
  add_hits(hits_.hits(), captured, targets);
  if (!warm) return;
  const HitHeat heat = sum_heat(hits_.hits(), captured, heat_scratch_);
  enthalpy_.add(heat.enthalpy);
  free_heat_.add(heat.free_heat);
}

std::vector<NozzleFigures> Spray::figures() const {
  const auto ended = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, ended_);
  const Index blocks = (parcels_.count + sum_block - 1) / sum_block;
  const DeviceArray<Real> partial(Kokkos::view_alloc(Kokkos::WithoutInitializing, "spray::spray::mass"),
                                  static_cast<std::size_t>(blocks));
  std::vector<NozzleFigures> all;
  for (std::size_t n = 0; n < injectors_.size(); ++n) {
    const Injector& injector = injectors_[n];
    const auto mass = [&](ParcelFate fate) {
      return static_cast<Real>(ended(n * fate_count + static_cast<std::size_t>(fate))) *
             injector.parcel_mass();
    };
    NozzleFigures f;
    f.name = injector.nozzle().name;
    f.parcels = injector.injected();
    f.injected = static_cast<Real>(f.parcels) * injector.parcel_mass();
    f.captured = mass(ParcelFate::captured);
    f.wall_loss = mass(ParcelFate::wall_loss);
    f.overspray = mass(ParcelFate::overspray);
    f.solids_fraction = injector.nozzle().solids_fraction;
    if (blocks > 0) {
      Kokkos::parallel_for("spray::spray::sum_mass", DeviceRange(0, blocks),
                           SumMass{parcels_, nozzle_, static_cast<std::int32_t>(n), partial});
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, partial);
      for (Index b = 0; b < blocks; ++b) f.in_flight += host(b);
    }
    all.push_back(f);
  }
  return all;
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
  const auto enthalpy = enthalpy_.parts();
  const auto free_heat = free_heat_.parts();
  std::vector<double> momentum;
  for (const core::ExactSum& sum : momentum_)
    momentum.insert(momentum.end(), {sum.parts()[0], sum.parts()[1]});
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
  std::vector<double> momentum(2 * momentum_.size());
  file.read_into("spray/momentum", momentum);
  for (std::size_t i = 0; i < momentum_.size(); ++i)
    momentum_[i].set_parts(momentum[2 * i], momentum[2 * i + 1]);
  std::vector<double> heat(4);
  file.read_into("spray/heat", heat);
  enthalpy_.set_parts(heat[0], heat[1]);
  free_heat_.set_parts(heat[2], heat[3]);
}

}  // namespace pellicle::spray
