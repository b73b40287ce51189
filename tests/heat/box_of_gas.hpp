// A box of gas cells with particles at rest in it, whose gas changes by nothing but what it exchanges with them.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "core/cartesian_grid.hpp"
#include "coupling/momentum_exchange.hpp"
#include "heat/heat_exchange.hpp"

namespace pellicle::heat::tests {

constexpr Real reference = 298.15;  // [K]
constexpr Real atmosphere = 101325;
constexpr Real particle_density = 1500, particle_capacity = 900;
constexpr Real solids_capacity = 1300;
constexpr WaterEnthalpy water{reference, 2.4417e6, 1872, 4181};

struct Grain {
  Vec3 position;
  Real radius = 1e-3;
  Real temperature = reference;
  Film film{};
  Vec3 velocity{};
};

inline HeatOptions make_options() {
  HeatOptions options;
  options.nusselt = RanzMarshall{};
  options.sherwood = RanzMarshall{};
  options.water = water;
  return options;
}

template <class T>
HostArray<T> filled(const char* label, Index size, const T& value) {
  HostArray<T> made(label, static_cast<std::size_t>(size));
  Kokkos::deep_copy(made, value);
  return made;
}

/// Gas of `temperature` [K] and vapour mass fraction `vapour`, 1.2 kg/m3; `velocity` of the gas [m/s].
class BoxOfGas {
 public:
  BoxOfGas(const CartesianGrid& gas_grid, const CartesianGrid& transfer_grid, const HeatOptions& options,
           const std::vector<Grain>& grains, Real temperature, Real vapour, const Vec3& velocity = {})
      : grid_(gas_grid),
        options_(options),
        particles_(make_particles(grains)),
        exchange_(coupling::CouplingOptions{}, transfer_grid, gas_grid, {1.2, options.gas.viscosity, {}}),
        surface_(particles_, {particle_capacity}, {reference, water.liquid_capacity, solids_capacity},
                 reference) {
    const Index cells = grid_.cell_count();
    volume_ = HostArray<Real>("tests::heat::volume", static_cast<std::size_t>(cells));
    for (Index c = 0; c < cells; ++c) {
      const Index3 at = grid_.coordinates(c);
      volume_(c) = grid_.volume(at.x, at.y, at.z);
    }
    heat_.emplace(options, volume_);
    surface_.reset(particles_.count);
    const auto temperatures = Kokkos::create_mirror_view(surface_.temperature());
    const auto films = Kokkos::create_mirror_view(surface_.film());
    for (std::size_t p = 0; p < grains.size(); ++p) {
      temperatures(p) = grains[p].temperature;
      films(p) = grains[p].film;
    }
    Kokkos::deep_copy(surface_.temperature(), temperatures);
    Kokkos::deep_copy(surface_.film(), films);
    exchange_.initialise(particles_);
    gas_.void_fraction = HostArray<Real>("tests::heat::void_fraction", static_cast<std::size_t>(cells));
    Kokkos::deep_copy(gas_.void_fraction, exchange_.exchange().void_fraction);
    gas_.density = filled<Real>("tests::heat::density", cells, 1.2);
    gas_.scalars[0] = filled("tests::heat::temperature", cells, temperature);
    gas_.scalars[1] = filled("tests::heat::moisture", cells, vapour);
    gas_.velocity = filled("tests::heat::velocity", cells, velocity);
    gas_.pressure_gradient = filled("tests::heat::pressure_gradient", cells, Vec3{});
  }

  /// One gas step: the exchange, then the gas takes what it was given; cells do not mix.
  void step(Real dt) {
    exchange_.sample_gas(gas_.velocity, gas_.pressure_gradient);
    exchange_.compute_coefficients(particles_);
    (void)exchange_.deposit(particles_, dt);
    heat_->update(particles_, exchange_, gas_, surface_, dt);
    cfd::ParticleExchange given;
    heat_->add_to(given);
    if (given.scalars[0].rate.extent(0) == 0) return;
    const bool moist = given.mass_source.extent(0) > 0;
    for (Index c = 0; c < grid_.cell_count(); ++c) {
      const Real volume = volume_(c) * gas_.void_fraction(c);
      const Real mass = gas_.density(c) * volume;
      Real& t = gas_.scalars[0](c);
      Real& w = gas_.scalars[1](c);
      const Real enthalpy = mass * capacity(w) * (t - reference) + dt * volume_(c) * given.scalars[0].rate(c);
      const Real gained = moist ? dt * volume_(c) * given.mass_source(c) : 0;
      w = (mass * w + (moist ? dt * volume_(c) * given.scalars[1].rate(c) : 0)) / (mass + gained);
      gas_.density(c) = (mass + gained) / volume;
      t = reference + enthalpy / ((mass + gained) * capacity(w));
    }
  }

  Real capacity(Real w) const { return options_.gas.capacity * (1 - w) + options_.water.vapour_capacity * w; }
  Real gas_mass(Index c) const { return gas_.density(c) * gas_.void_fraction(c) * volume_(c); }
  Real water_mass() const {
    Real sum = surface_.compute_totals().film.liquid;
    for (Index c = 0; c < grid_.cell_count(); ++c) sum += gas_mass(c) * gas_.scalars[1](c);
    return sum;
  }
  Real energy() const {
    Real sum = surface_.compute_totals().enthalpy;
    for (Index c = 0; c < grid_.cell_count(); ++c) {
      const Real w = gas_.scalars[1](c);
      sum += gas_mass(c) * (capacity(w) * (gas_.scalars[0](c) - reference) + w * options_.water.latent);
    }
    return sum;
  }
  std::vector<Real> temperatures() const { return coupling_vector(surface_.temperature()); }
  std::vector<Film> films() const { return coupling_vector(surface_.film()); }
  Real temperature(std::size_t p = 0) const { return temperatures()[p]; }
  Film film(std::size_t p = 0) const { return films()[p]; }

  cfd::GasState& gas() { return gas_; }
  const cfd::GasState& gas() const { return gas_; }
  const HeatExchange& heat() const { return *heat_; }

 private:
  template <class T>
  std::vector<T> coupling_vector(const DeviceArray<T>& view) const {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
    return std::vector<T>(host.data(), host.data() + particles_.count);
  }

  static dem::Particles make_particles(const std::vector<Grain>& grains) {
    dem::Particles made;
    made.count = static_cast<Index>(grains.size());
    made.position_radius = DeviceArray<dem::PositionRadius>("tests::heat::position_radius", grains.size());
    made.velocity_spin = DeviceArray<dem::VelocitySpin>("tests::heat::velocity_spin", grains.size());
    made.mass = DeviceArray<Real>("tests::heat::mass", grains.size());
    const auto place = Kokkos::create_mirror_view(made.position_radius);
    const auto motion = Kokkos::create_mirror_view(made.velocity_spin);
    const auto mass = Kokkos::create_mirror_view(made.mass);
    for (std::size_t p = 0; p < grains.size(); ++p) {
      const Grain& g = grains[p];
      place(p) = {g.position.x, g.position.y, g.position.z, g.radius};
      motion(p) = {};
      motion(p).vx = g.velocity.x;
      motion(p).vy = g.velocity.y;
      motion(p).vz = g.velocity.z;
      mass(p) = particle_density * dem::sphere_volume(g.radius);
    }
    Kokkos::deep_copy(made.position_radius, place);
    Kokkos::deep_copy(made.velocity_spin, motion);
    Kokkos::deep_copy(made.mass, mass);
    return made;
  }

  CartesianGrid grid_;
  HeatOptions options_;
  dem::Particles particles_;
  coupling::MomentumExchange exchange_;
  SurfaceState surface_;
  cfd::GasState gas_;
  HostArray<Real> volume_;
  std::optional<HeatExchange> heat_;
};

}  // namespace pellicle::heat::tests
