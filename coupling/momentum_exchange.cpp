#include "coupling/momentum_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "cfd/flow_geometry.hpp"
#include "cfd/gas_property_laws.hpp"
#include "core/checkpoint.hpp"
#include "core/error.hpp"

namespace pellicle::coupling {

namespace {

template <class T>
DeviceArray<T> make_device(const char* label, Index size) {
  return DeviceArray<T>(label, static_cast<std::size_t>(size));
}
template <class T>
HostArray<T> make_host(const char* label, Index size) {
  return HostArray<T>(label, static_cast<std::size_t>(size));
}

/// What the particles see of the gas, and their drag coefficients.
template <class Law>
struct ComputeCoefficients {
  Law law;
  dem::Particles particles;
  FootprintView transfer, gas;
  DeviceArray<Vec3> gas_velocity, gas_pressure_gradient;
  DeviceArray<Real> void_fraction;
  DeviceArray<SampledGas> sampled;
  DeviceArray<Received> received;
  LocalGas uniform;
  DeviceArray<LocalGas> local, sampled_local;
  bool pressure_gradient_force;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    const Real radius = particles.position_radius(p).radius;
    const Real volume = dem::sphere_volume(radius);
    SampledGas g;
    g.velocity = gas.sample(p, gas_velocity);
    g.void_fraction = transfer.sample(p, void_fraction);
    if (pressure_gradient_force) g.pressure_force = -volume * gas.sample(p, gas_pressure_gradient);
    const Real slip_speed = norm(g.velocity - particles.velocity_spin(p).velocity());
    const LocalGas around = local.extent(0) > 0 ? gas.sample(p, local) : uniform;
    g.drag_coefficient =
        volume * law(ParticleFlow{g.void_fraction, slip_speed, 2 * radius, around.density, around.viscosity});
    if (sampled_local.extent(0) > 0) sampled_local(p) = around;
    sampled(p) = g;
    received(p) = Received{};
  }
};

template <class Law>
void compute_coefficients_with(const ComputeCoefficients<Law>& kernel) {
  Kokkos::parallel_for("coupling::momentum_exchange::compute_coefficients",
                       DeviceRange(0, kernel.particles.count), kernel);
}

/// What each particle brings to its cells.
struct ComputeLoads {
  DeviceArray<dem::PositionRadius> position_radius;
  DeviceArray<SampledGas> sampled;
  DeviceArray<Received> received;
  DeviceArray<CellLoad> load;
  Exchange exchange;
  Real steps_per_second;  ///< 1 / gas step; 0 when nothing has been received yet

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    const Real radius = position_radius(p).radius;
    CellLoad made;
    made.solids = dem::sphere_volume(radius);
    if (steps_per_second > 0) {
      const SampledGas g = sampled(p);
      const Received r = received(p);
      const Vec3 mean_drag = steps_per_second * r.drag_impulse;
      made.reaction = -(mean_drag + (steps_per_second * r.time) * g.pressure_force);
      made.explicit_force = -mean_drag;
      if (exchange == Exchange::implicit) {
        // -K V u_new + (K V u_sampled - drag): the reaction itself, if u_new is u_sampled.
        made.coefficient = g.drag_coefficient;
        made.explicit_force += g.drag_coefficient * g.velocity;
      }
    }
    load(p) = made;
  }
};

/// Particles whose impulses are summed in one go; fixed, so that the sum does not depend on threads.
constexpr Index fixed_block = 512;

/// What the fixed particles of a block have received.
struct SumOnFixed {
  dem::Particles particles;
  DeviceArray<SampledGas> sampled;
  DeviceArray<Received> received;
  DeviceArray<Vec3> impulse;

  KOKKOS_INLINE_FUNCTION void operator()(const Index block) const {
    const Index end = Kokkos::min((block + 1) * fixed_block, particles.count);
    Vec3 sum;
    for (Index p = block * fixed_block; p < end; ++p) {
      if (particles.velocity_spin(p).inverse_mass != 0) continue;
      const Received r = received(p);
      sum += r.drag_impulse + r.time * sampled(p).pressure_force;
    }
    impulse(block) = sum;
  }
};

struct ComputeVoidFraction {
  GridLocator grid;
  DeviceArray<CellLoad> load;
  DeviceArray<Real> void_fraction;
  KOKKOS_INLINE_FUNCTION void operator()(const Index cell) const {
    const Index nx = grid.x.cells, ny = grid.y.cells;
    const Real volume = grid.volume(cell % nx, (cell / nx) % ny, cell / (nx * ny));
    void_fraction(cell) = 1 - load(cell).solids / volume;
  }
};

/// The same in the open volume of cells; 1 where no gas is.
struct ComputeOpenVoidFraction {
  DeviceArray<Real> volume;
  DeviceArray<CellLoad> load;
  DeviceArray<Real> void_fraction;
  KOKKOS_INLINE_FUNCTION void operator()(const Index cell) const {
    void_fraction(cell) = volume(cell) > 0 ? 1 - load(cell).solids / volume(cell) : Real(1);
  }
};

/// What walls leave of the cells; the footprints know no cells but the gas's, and smoothing no walls.
CutGrid cut_by(const cfd::FlowGeometry* walls, const CouplingOptions& options, const CartesianGrid& transfer,
               const CartesianGrid& gas) {
  if (walls == nullptr || !walls->is_cut) return {};
  if (!same_cells(transfer, gas)) {
    throw InputError(
        "coupling.transfer_grid: must have the cells of the gas grid, since walls within the domain cut "
        "them; "
        "allowed: leave it out");
  }
  if (options.smoothing_length != 0) {
    throw InputError(
        "coupling.smoothing_length: would smooth across the walls within the domain that cut the gas grid; "
        "allowed: 0");
  }
  return make_cut_grid(*walls);
}

void check(const CouplingOptions& options, const GasProperties& properties) {
  const Real least = options.minimum_void_fraction;
  if (!(least > 0 && least < 1)) {
    throw InputError("coupling.minimum_void_fraction: must be above 0 and below 1");
  }
  // Below the stability bound of the pressure-gradient part; see docs/theory/coupling.md.
  const Real largest_release = std::min(1.0, 2 / (1 + 2 * (1 - least) / least));
  if (!(options.pending_release > 0 && options.pending_release < largest_release)) {
    throw InputError("coupling.pending_release: must be above 0 and below " +
                     std::to_string(largest_release));
  }
  if (!(options.smoothing_length >= 0 && std::isfinite(options.smoothing_length))) {
    throw InputError("coupling.smoothing_length: must be 0 (no smoothing) or a positive length");
  }
  if (!(properties.density > 0 && properties.viscosity > 0)) {
    throw InputError("gas: density and viscosity must be positive");
  }
}

}  // namespace

MomentumExchange::MomentumExchange(const CouplingOptions& options, const CartesianGrid& transfer,
                                   const CartesianGrid& gas, const GasProperties& properties,
                                   const cfd::FlowGeometry* walls)
    : options_(options),
      properties_(properties),
      transfer_(transfer),
      gas_(gas),
      one_grid_(same_cells(transfer, gas)),
      cut_(cut_by(walls, options, transfer, gas)),
      transfer_footprint_(GridLocator(transfer), options.deposition, cut_),
      gas_footprint_(GridLocator(gas), options.deposition),
      sums_(transfer.cell_count()),
      bound_(transfer_footprint_.grid(), options.minimum_void_fraction, cut_),
      smoothing_(transfer_footprint_.grid(), options.smoothing_length),
      to_gas_(transfer, gas),
      to_transfer_(gas, transfer) {
  check(options, properties);
  const Index cells = transfer.cell_count(), gas_cells = gas.cell_count();
  gas_velocity_ = make_device<Vec3>("coupling::momentum_exchange::gas_velocity", gas_cells);
  gas_pressure_gradient_ = make_device<Vec3>("coupling::momentum_exchange::gas_pressure_gradient", gas_cells);
  if (properties_.vary()) {
    local_gas_ = make_device<LocalGas>("coupling::momentum_exchange::local_gas", gas_cells);
    local_gas_host_ = make_host<LocalGas>("coupling::momentum_exchange::local_gas_host", gas_cells);
  }
  void_fraction_ = make_device<Real>("coupling::momentum_exchange::void_fraction", cells);
  cell_load_ = make_device<CellLoad>("coupling::momentum_exchange::cell_load", cells);
  cell_load_host_ = make_host<CellLoad>("coupling::momentum_exchange::cell_load_host", cells);
  void_fraction_host_ = make_host<Real>("coupling::momentum_exchange::void_fraction_host", cells);
  solids_ = make_host<Real>("coupling::momentum_exchange::solids", cells);
  coefficient_ = make_host<Real>("coupling::momentum_exchange::coefficient", cells);
  force_ = make_host<Vec3>("coupling::momentum_exchange::force", cells);
  target_ = make_host<Vec3>("coupling::momentum_exchange::target", cells);
  pending_ = make_host<Vec3>("coupling::momentum_exchange::pending", cells);
  gas_solids_ = make_host<Real>("coupling::momentum_exchange::gas_solids", gas_cells);
  given_ = make_host<Vec3>("coupling::momentum_exchange::given", gas_cells);
  given_transfer_ = make_host<Vec3>("coupling::momentum_exchange::given_transfer", cells);
  volume_ = make_host<Real>("coupling::momentum_exchange::volume", cells);
  for (Index c = 0; c < cells; ++c) {
    const Index3 at = transfer.coordinates(c);
    volume_(c) = cut_.is_cut() ? walls->volume(c) : transfer.volume(at.x, at.y, at.z);
  }
  exchange_ = cfd::ParticleExchange{
      make_host<Real>("coupling::momentum_exchange::exchange_void_fraction", gas_cells),
      make_host<Real>("coupling::momentum_exchange::exchange_coefficient", gas_cells),
      make_host<Vec3>("coupling::momentum_exchange::exchange_explicit_force", gas_cells)};
  Kokkos::deep_copy(Device(), void_fraction_, 1);
  Kokkos::deep_copy(void_fraction_host_, 1);
  Kokkos::deep_copy(exchange_.void_fraction, 1);
}

void MomentumExchange::allocate_particles(Index count) {
  if (sampled_.extent(0) >= static_cast<std::size_t>(count) && sampled_.extent(0) > 0) return;
  sampled_ = make_device<SampledGas>("coupling::momentum_exchange::sampled", count);
  received_ = make_device<Received>("coupling::momentum_exchange::received", count);
  if (properties_.vary() && options_.coefficients == Coefficients::substep) {
    sampled_local_ = make_device<LocalGas>("coupling::momentum_exchange::sampled_local", count);
  }
  const Index blocks = (count + fixed_block - 1) / fixed_block;
  fixed_impulse_ = make_device<Vec3>("coupling::momentum_exchange::fixed_impulse", blocks);
  fixed_impulse_host_ = make_host<Vec3>("coupling::momentum_exchange::fixed_impulse_host", blocks);
}

void MomentumExchange::update_footprints(const dem::Particles& particles) {
  if (!transfer_footprint_.is_current(particles)) transfer_footprint_.compute(particles);
  if (!one_grid_ && !gas_footprint_.is_current(particles)) gas_footprint_.compute(particles);
}

void MomentumExchange::initialise(const dem::Particles& particles) {
  allocate_particles(particles.count);
  totals_ = {};
  Kokkos::deep_copy(pending_, Vec3{});
  deposit_loads(particles, 0);
  map_to_gas();
}

void MomentumExchange::sample_gas(const HostArray<Vec3>& velocity, const HostArray<Vec3>& pressure_gradient,
                                  const HostArray<Real>& density, const HostArray<Real>& temperature) {
  Kokkos::deep_copy(gas_velocity_, velocity);
  Kokkos::deep_copy(gas_pressure_gradient_, pressure_gradient);
  if (!properties_.vary()) return;
  const GasProperties& gas = properties_;
  for (Index c = 0; c < gas_.cell_count(); ++c) {
    local_gas_host_(c) = {gas.density_varies ? density(c) : gas.density,
                          gas.sutherland ? cfd::sutherland_viscosity(temperature(c)) : gas.viscosity};
  }
  Kokkos::deep_copy(local_gas_, local_gas_host_);
}

void MomentumExchange::compute_coefficients(const dem::Particles& particles) {
  allocate_particles(particles.count);
  update_footprints(particles);
  const FootprintView& transfer = transfer_footprint_.view();
  const FootprintView& gas = one_grid_ ? transfer : gas_footprint_.view();
  std::visit(
      [&](const auto& law) {
        compute_coefficients_with(
            ComputeCoefficients<std::decay_t<decltype(law)>>{law,
                                                             particles,
                                                             transfer,
                                                             gas,
                                                             gas_velocity_,
                                                             gas_pressure_gradient_,
                                                             void_fraction_,
                                                             sampled_,
                                                             received_,
                                                             {properties_.density, properties_.viscosity},
                                                             local_gas_,
                                                             sampled_local_,
                                                             options_.pressure_gradient_force});
      },
      options_.drag);
}

FluidForce MomentumExchange::fluid_force(const dem::Particles& particles) const {
  const Vec3 buoyancy =
      options_.pressure_gradient_force ? -properties_.density * properties_.gravity : Vec3{};
  const FixedCoefficientForce fixed{sampled_, received_, particles.position_radius, buoyancy};
  if (options_.coefficients == Coefficients::gas_step) return fixed;
  return FollowingCoefficientForce{fixed,
                                   {properties_.density, properties_.viscosity},
                                   sampled_local_,
                                   static_cast<int>(options_.drag.index())};
}

void MomentumExchange::deposit_loads(const dem::Particles& particles, Real gas_step) {
  update_footprints(particles);
  const auto particle_load = scratch_.take<CellLoad>(particles.count);
  Kokkos::parallel_for("coupling::momentum_exchange::compute_loads", DeviceRange(0, particles.count),
                       ComputeLoads{particles.position_radius, sampled_, received_, particle_load,
                                    options_.exchange, gas_step > 0 ? 1 / gas_step : 0});
  sums_.compute(transfer_footprint_, particle_load, cell_load_);
  bound_report_ = bound_.apply(cell_load_);
  smoothing_.apply(cell_load_);  // raises no solids fraction above the largest: the bound still holds
  const Index cells = transfer_.cell_count();
  if (cut_.is_cut()) {
    Kokkos::parallel_for("coupling::momentum_exchange::compute_open_void_fraction", DeviceRange(0, cells),
                         ComputeOpenVoidFraction{cut_.volume, cell_load_, void_fraction_});
  } else {
    Kokkos::parallel_for("coupling::momentum_exchange::compute_void_fraction", DeviceRange(0, cells),
                         ComputeVoidFraction{transfer_footprint_.grid(), cell_load_, void_fraction_});
  }
  Kokkos::deep_copy(cell_load_host_, cell_load_);
  Kokkos::deep_copy(void_fraction_host_, void_fraction_);
  if (bound_report_.cells_left_over == 0) return;
  Real solids = 0, volume = 0;
  for (Index c = 0; c < cells; ++c) {
    solids += cell_load_host_(c).solids;
    volume += volume_(c);
  }
  if (solids > (1 - options_.minimum_void_fraction) * volume) {
    throw RunError("coupling.minimum_void_fraction: the particles fill " + std::to_string(solids / volume) +
                   " of the gas grid, more than the bound leaves them");
  }
}

void MomentumExchange::add_fixed_impulse(const dem::Particles& particles) {
  const Index blocks = (particles.count + fixed_block - 1) / fixed_block;
  Kokkos::parallel_for("coupling::momentum_exchange::sum_on_fixed", DeviceRange(0, blocks),
                       SumOnFixed{particles, sampled_, received_, fixed_impulse_});
  Kokkos::deep_copy(fixed_impulse_host_, fixed_impulse_);
  for (Index b = 0; b < blocks; ++b) totals_.fixed_received += fixed_impulse_host_(b);
}

const cfd::ParticleExchange& MomentumExchange::deposit(const dem::Particles& particles, Real gas_step) {
  deposit_loads(particles, gas_step);
  add_fixed_impulse(particles);
  const bool two_way = options_.exchange != Exchange::one_way;
  const Real release_rate = two_way ? options_.pending_release / gas_step : 0;
  for (Index c = 0; c < transfer_.cell_count(); ++c) {
    const CellLoad& load = cell_load_host_(c);
    if (!(volume_(c) > 0)) continue;  // no gas, and no particle either: all stays 0
    const Real per_volume = 1 / volume_(c);
    coefficient_(c) = per_volume * load.coefficient;
    target_(c) = per_volume * load.reaction;
    force_(c) = per_volume * load.explicit_force + release_rate * pending_(c);
    totals_.particles_received -= gas_step * load.reaction;
    totals_.gross += gas_step * norm(load.reaction);
  }
  map_to_gas();
  if (two_way) {
    to_gas_.map(coefficient_, exchange_.exchange_coefficient);
    to_gas_.map(force_, exchange_.explicit_force);
  }
  return exchange_;
}

void MomentumExchange::map_to_gas() {
  if (options_.exchange == Exchange::one_way) return;  // the gas never hears of the particles
  for (Index c = 0; c < transfer_.cell_count(); ++c) solids_(c) = 1 - void_fraction_host_(c);
  to_gas_.map(solids_, gas_solids_);
  for (Index c = 0; c < gas_.cell_count(); ++c) exchange_.void_fraction(c) = 1 - gas_solids_(c);
}

void MomentumExchange::close_step(const cfd::GasState& gas, Real gas_step) {
  if (options_.exchange == Exchange::one_way) return;
  const bool pressure = options_.pressure_gradient_force;
  for (Index c = 0; c < gas_.cell_count(); ++c) {
    Vec3 given = exchange_.explicit_force(c) - exchange_.exchange_coefficient(c) * gas.velocity(c);
    if (pressure) given += (1 - exchange_.void_fraction(c)) * gas.pressure_gradient(c);
    given_(c) = given;
  }
  to_transfer_.map(given_, given_transfer_);
  Vec3 pending;
  for (Index c = 0; c < transfer_.cell_count(); ++c) {
    pending_(c) += gas_step * (target_(c) - given_transfer_(c));
    totals_.gas_received += (gas_step * volume_(c)) * given_transfer_(c);
    pending += volume_(c) * pending_(c);
  }
  totals_.pending = pending;
}

void MomentumExchange::save(core::CheckpointWriter& file) const {
  file.write("coupling/void_fraction", void_fraction_host_);
  file.write("coupling/pending", pending_);
  file.write("coupling/particles_received", totals_.particles_received);
  file.write("coupling/fixed_received", totals_.fixed_received);
  file.write("coupling/gas_received", totals_.gas_received);
  file.write("coupling/pending_total", totals_.pending);
  file.write("coupling/gross", totals_.gross);
}

void MomentumExchange::load(core::CheckpointReader& file) {
  file.read_into("coupling/void_fraction", void_fraction_host_);
  file.read_into("coupling/pending", pending_);
  totals_.particles_received = file.read_vec3("coupling/particles_received");
  totals_.fixed_received = file.read_vec3("coupling/fixed_received");
  totals_.gas_received = file.read_vec3("coupling/gas_received");
  totals_.pending = file.read_vec3("coupling/pending_total");
  totals_.gross = file.read_double("coupling/gross");
  Kokkos::deep_copy(void_fraction_, void_fraction_host_);
  map_to_gas();
}

}  // namespace pellicle::coupling
