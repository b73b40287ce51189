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

}  // namespace

DropletGas::DropletGas(const DropletGasOptions& options, const ParcelGas& around,
                       const HostArray<Real>& open_volume, Real largest_parcel_mass, const Vec3& gravity)
    : options_(options), gas_(around), gravity_(gravity), volume_(open_volume) {
  const std::size_t cells = open_volume.extent(0);
  gas_.velocity = DeviceArray<Vec3>("spray::droplet_gas::velocity", cells);
  if (options.density_varies) gas_.density = DeviceArray<Real>("spray::droplet_gas::density", cells);
  if (options.viscosity_follows) {
    gas_.temperature = DeviceArray<Real>("spray::droplet_gas::temperature", cells);
    gas_.sutherland = true;
  }
  if (!options.two_way) return;
  gas_.gains = {DeviceArray<CellGains>("spray::droplet_gas::gains", cells), make_units(largest_parcel_mass)};
  sum_ = DeviceArray<CellGains>("spray::droplet_gas::sum", cells);
  mass_ = DeviceArray<Real>("spray::droplet_gas::mass", cells);
  sum_host_ = HostArray<CellGains>("spray::droplet_gas::sum_host", cells);
  mass_host_ = HostArray<Real>("spray::droplet_gas::mass_host", cells);
  force_ = HostArray<Vec3>("spray::droplet_gas::force", cells);
  total_force_ = HostArray<Vec3>("spray::droplet_gas::total_force", cells);
}

void DropletGas::sample(const cfd::GasState& gas) {
  Kokkos::deep_copy(gas_.velocity, gas.velocity);
  if (options_.density_varies) Kokkos::deep_copy(gas_.density, gas.density);
  if (gas_.temperature.extent(0) > 0)
    Kokkos::deep_copy(gas_.temperature, gas.scalars[index_of(cfd::Scalar::temperature)]);
  if (!options_.two_way) return;
  for (std::size_t c = 0; c < mass_host_.extent(0); ++c)
    mass_host_(c) = gas.density(c) * gas.void_fraction(c) * volume_(c);
  Kokkos::deep_copy(mass_, mass_host_);
}

void DropletGas::settle() {
  if (!options_.two_way) return;
  Kokkos::parallel_for("spray::droplet_gas::settle", DeviceRange(0, static_cast<Index>(mass_.extent(0))),
                       Settle{gas_.gains, sum_, mass_, gas_.velocity});
}

void DropletGas::close(Real step) {
  if (!options_.two_way) return;
  Kokkos::deep_copy(sum_host_, sum_);
  Kokkos::deep_copy(sum_, CellGains{});
  const GainUnits& unit = gas_.gains.unit;
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
  if (!options_.two_way) return;
  for (std::size_t c = 0; c < force_.extent(0); ++c) total_force_(c) = exchange.explicit_force(c) + force_(c);
  exchange.explicit_force = total_force_;
}

DropletImpulses DropletGas::impulses() const {
  const auto vector = [&](std::size_t first) {
    return Vec3{impulse_[first].value(), impulse_[first + 1].value(), impulse_[first + 2].value()};
  };
  return {vector(0), vector(3), vector(6)};
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
