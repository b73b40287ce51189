#include "spray/droplet_gas.hpp"

#include <string>
#include <utility>
#include <vector>

namespace pellicle::spray {
namespace {

/// The gas that droplets see gets what they gave, which goes to the sums of the outer step.
struct Settle {
  GasGains gains;
  DeviceArray<CellGains> sum;
  DeviceArray<Real> mass;
  DeviceArray<Vec3> velocity;

  KOKKOS_INLINE_FUNCTION void operator()(const Index c) const {
    const CellGains got = gains.cell(c);
    if (got.mass_time == 0) return;  // no droplet was here
    gains.cell(c) = CellGains{};
    CellGains all = sum(c);
    Vec3 impulse;
    for (int axis = 0; axis < 3; ++axis) {
      impulse[axis] = gains.unit.impulse * static_cast<Real>(got.impulse[axis]);
      all.impulse[axis] += got.impulse[axis];
      all.bounced[axis] += got.bounced[axis];
    }
    all.mass_time += got.mass_time;
    sum(c) = all;
    // Implicit: droplets that would have stopped in gas that stays as it is stop where both have one velocity at most.
    velocity(c) += 1 / (mass(c) + gains.unit.mass * static_cast<Real>(got.dragged)) * impulse;
  }
};

/// The same of heat and vapour; implicit likewise.
struct SettleVapour {
  DeviceArray<VapourGains> gains, sum;
  WholeUnits unit;
  DeviceArray<Real> mass, temperature, vapour;
  DropletHeat heat;

  KOKKOS_INLINE_FUNCTION void operator()(const Index c) const {
    const VapourGains got = gains(c);
    if (got.reach == 0) return;
    gains(c) = VapourGains{};
    VapourGains all = sum(c);
    all.vapour += got.vapour;
    all.heat += got.heat;
    for (int axis = 0; axis < 3; ++axis) all.momentum[axis] += got.momentum[axis];
    all.reach += got.reach;
    sum(c) = all;
    const Real came = unit.water * static_cast<Real>(got.vapour);
    const Real warmth = temperature(c) - heat.water.reference;
    const Real warmed = unit.heat * static_cast<Real>(got.heat) - came * heat.water.vapour_capacity * warmth;
    const Real reached = mass(c) + unit.mass * static_cast<Real>(got.reach);
    const Real w = vapour(c);
    const Real capacity = heat.dry_capacity * (1 - w) + heat.water.vapour_capacity * w;
    temperature(c) += warmed / (reached * capacity);
    vapour(c) = w + (1 - w) * came / reached;
  }
};

template <class T>
HostArray<T> make_host(const char* label, std::size_t size) {
  return HostArray<T>(std::string(label), size);
}

}  // namespace

DropletGas::DropletGas(const DropletGasOptions& options, const ParcelGas& around,
                       const HostArray<Real>& open_volume, const WholeUnits& units, const Vec3& gravity)
    : options_(options), gas_(around), gravity_(gravity), units_(units), volume_(open_volume) {
  const std::size_t cells = open_volume.extent(0);
  gas_.velocity = DeviceArray<Vec3>("spray::droplet_gas::velocity", cells);
  if (options.density_varies) gas_.density = DeviceArray<Real>("spray::droplet_gas::density", cells);
  gas_.sutherland = options.viscosity_follows;
  gas_.heat = options.heat;
  if (options.viscosity_follows || options.heat.on)
    gas_.temperature = DeviceArray<Real>("spray::droplet_gas::temperature", cells);
  if (!options.two_way && !options.heat.on) return;
  mass_ = DeviceArray<Real>("spray::droplet_gas::mass", cells);
  mass_host_ = make_host<Real>("spray::droplet_gas::mass_host", cells);
  if (options.heat.on) {
    gas_.vapour = DeviceArray<Real>("spray::droplet_gas::vapour", cells);
    gas_.vapour_gains = DeviceArray<VapourGains>("spray::droplet_gas::vapour_gains", cells);
    vapour_sum_ = DeviceArray<VapourGains>("spray::droplet_gas::vapour_sum", cells);
    vapour_sum_host_ = make_host<VapourGains>("spray::droplet_gas::vapour_sum_host", cells);
    heat_rate_ = make_host<Real>("spray::droplet_gas::heat_rate", cells);
    vapour_rate_ = make_host<Real>("spray::droplet_gas::vapour_rate", cells);
    vapour_momentum_ = make_host<Vec3>("spray::droplet_gas::vapour_momentum", cells);
    total_heat_ = make_host<Real>("spray::droplet_gas::total_heat", cells);
    total_vapour_ = make_host<Real>("spray::droplet_gas::total_vapour", cells);
    total_vapour_momentum_ = make_host<Vec3>("spray::droplet_gas::total_vapour_momentum", cells);
    zero_ = make_host<Real>("spray::droplet_gas::zero", cells);
  }
  if (!options.two_way) return;
  gas_.gains = {DeviceArray<CellGains>("spray::droplet_gas::gains", cells), units};
  sum_ = DeviceArray<CellGains>("spray::droplet_gas::sum", cells);
  sum_host_ = HostArray<CellGains>("spray::droplet_gas::sum_host", cells);
  force_ = HostArray<Vec3>("spray::droplet_gas::force", cells);
  total_force_ = HostArray<Vec3>("spray::droplet_gas::total_force", cells);
}

void DropletGas::sample(const cfd::GasState& gas) {
  Kokkos::deep_copy(gas_.velocity, gas.velocity);
  if (options_.density_varies) Kokkos::deep_copy(gas_.density, gas.density);
  if (gas_.temperature.extent(0) > 0)
    Kokkos::deep_copy(gas_.temperature, gas.scalars[index_of(cfd::Scalar::temperature)]);
  if (options_.heat.on) Kokkos::deep_copy(gas_.vapour, gas.scalars[index_of(cfd::Scalar::moisture)]);
  for (std::size_t c = 0; c < mass_host_.extent(0); ++c)
    mass_host_(c) = gas.density(c) * gas.void_fraction(c) * volume_(c);
  if (mass_host_.extent(0) > 0) Kokkos::deep_copy(mass_, mass_host_);
}

void DropletGas::settle() {
  const DeviceRange cells(0, static_cast<Index>(mass_.extent(0)));
  if (options_.heat.on) {
    Kokkos::parallel_for("spray::droplet_gas::settle_vapour", cells,
                         SettleVapour{gas_.vapour_gains, vapour_sum_, units_, mass_, gas_.temperature,
                                      gas_.vapour, gas_.heat});
  }
  if (options_.two_way) {
    Kokkos::parallel_for("spray::droplet_gas::settle", cells, Settle{gas_.gains, sum_, mass_, gas_.velocity});
  }
}

void DropletGas::close(Real step) {
  if (options_.two_way) close_momentum(step);
  if (options_.heat.on) close_vapour(step);
}

void DropletGas::close_vapour(Real step) {
  Kokkos::deep_copy(vapour_sum_host_, vapour_sum_);
  Kokkos::deep_copy(vapour_sum_, VapourGains{});
  Vec3 momentum{};
  for (std::size_t c = 0; c < vapour_sum_host_.extent(0); ++c) {
    const VapourGains& sum = vapour_sum_host_(c);
    heat_rate_(c) = vapour_rate_(c) = 0;
    vapour_momentum_(c) = Vec3{};
    if (sum.reach == 0) continue;
    const Real rate = 1 / (volume_(c) * step);
    heat_rate_(c) = rate * units_.heat * static_cast<Real>(sum.heat);
    vapour_rate_(c) = rate * units_.water * static_cast<Real>(sum.vapour);
    for (int axis = 0; axis < 3; ++axis) {
      const Real part = units_.impulse * static_cast<Real>(sum.momentum[axis]);
      momentum[axis] += part;
      vapour_momentum_(c)[axis] = rate * part;
    }
  }
  for (int axis = 0; axis < 3; ++axis) impulse_[9 + static_cast<std::size_t>(axis)].add(momentum[axis]);
}

void DropletGas::close_momentum(Real step) {
  Kokkos::deep_copy(sum_host_, sum_);
  Kokkos::deep_copy(sum_, CellGains{});
  const WholeUnits& unit = units_;
  Vec3 on_gas{}, bounced{};
  Real mass_time = 0;
  for (std::size_t c = 0; c < sum_host_.extent(0); ++c) {
    const CellGains& sum = sum_host_(c);
    force_(c) = Vec3{};
    if (sum.mass_time == 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const Real impulse = unit.impulse * static_cast<Real>(sum.impulse[axis]);
      on_gas[axis] += impulse;
      force_(c)[axis] = impulse / (volume_(c) * step);
      bounced[axis] += unit.impulse * static_cast<Real>(sum.bounced[axis]);
    }
    mass_time += unit.mass_time * static_cast<Real>(sum.mass_time);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    impulse_[a].add(on_gas[axis]);
    impulse_[3 + a].add(bounced[axis]);
    impulse_[6 + a].add(mass_time * gravity_[axis]);
  }
}

void DropletGas::add_to(cfd::ParticleExchange& exchange) const {
  if (options_.heat.on) add_vapour_to(exchange);
  if (!options_.two_way) return;
  for (std::size_t c = 0; c < force_.extent(0); ++c) total_force_(c) = exchange.explicit_force(c) + force_(c);
  exchange.explicit_force = total_force_;
}

void DropletGas::add_vapour_to(cfd::ParticleExchange& exchange) const {
  cfd::ScalarSource& heat = exchange.scalars[index_of(cfd::Scalar::temperature)];
  cfd::ScalarSource& vapour = exchange.scalars[index_of(cfd::Scalar::moisture)];
  for (std::size_t c = 0; c < heat_rate_.extent(0); ++c) {
    total_heat_(c) = heat_rate_(c) + (heat.rate.extent(0) > 0 ? heat.rate(c) : 0);
    total_vapour_(c) = vapour_rate_(c) + (vapour.rate.extent(0) > 0 ? vapour.rate(c) : 0);
    total_vapour_momentum_(c) = vapour_momentum_(c);
    if (exchange.mass_source_momentum.extent(0) > 0)
      total_vapour_momentum_(c) += exchange.mass_source_momentum(c);
  }
  heat = {total_heat_, zero_};
  vapour = {total_vapour_, zero_};
  exchange.mass_source = total_vapour_;
  exchange.mass_source_momentum = total_vapour_momentum_;
}

DropletImpulses DropletGas::impulses() const {
  const auto vector = [&](std::size_t first) {
    return Vec3{impulse_[first].value(), impulse_[first + 1].value(), impulse_[first + 2].value()};
  };
  return {vector(0), vector(3), vector(6), vector(9)};
}

void DropletGas::save(core::CheckpointWriter& file) const {
  std::vector<double> parts;
  for (const core::ExactSum& sum : impulse_) parts.insert(parts.end(), {sum.parts()[0], sum.parts()[1]});
  file.write("spray/impulses", parts);
}

void DropletGas::load(const core::CheckpointReader& file) {
  std::vector<double> parts(2 * impulse_.size());
  file.read_into("spray/impulses", parts);
  for (std::size_t i = 0; i < impulse_.size(); ++i) impulse_[i].set_parts(parts[2 * i], parts[2 * i + 1]);
}

}  // namespace pellicle::spray
