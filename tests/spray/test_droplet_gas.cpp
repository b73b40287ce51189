// Droplets that push the gas: what one side loses the other gets, to the last bit; the gas that they see; and the gas's own
// density and viscosity where it has them.
#include "spray/droplet_gas.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "cfd/gas_property_laws.hpp"
#include "core/checkpoint.hpp"
#include "tests/core/temporary_folder.hpp"
#include "tests/spray/rig.hpp"

namespace pellicle::spray {
namespace {

using tests::fixed_bead;
using tests::needle;
using tests::Rig;

constexpr Real side = 0.02;

/// Gas in a box of equal cells that moves as it is pushed, each cell by itself.
struct FreeGas {
  CartesianGrid grid;
  cfd::GasState state;
  HostArray<Real> volume;

  explicit FreeGas(const Index3& cells) : grid({{0, 0, 0}, {side, side, side}}, cells) {
    const auto n = static_cast<std::size_t>(grid.cell_count());
    state.velocity = HostArray<Vec3>("test::velocity", n);
    state.density = HostArray<Real>("test::density", n);
    state.void_fraction = HostArray<Real>("test::void_fraction", n);
    volume = HostArray<Real>("test::volume", n);
    Kokkos::deep_copy(state.density, 1.2);
    Kokkos::deep_copy(state.void_fraction, 0.5);
    Kokkos::deep_copy(volume, grid.volume(0, 0, 0));
  }
  Real mass(Index c) const { return state.density(c) * state.void_fraction(c) * volume(c); }
  Vec3 momentum() const {
    Vec3 sum;
    for (Index c = 0; c < grid.cell_count(); ++c) sum += mass(c) * state.velocity(c);
    return sum;
  }
  DropletGas droplets(const DropletGasOptions& options, const Spray& spray, const Vec3& gravity = {}) const {
    ParcelGas around;
    around.drag = {1.2, 1.8e-5};
    around.grid = coupling::GridLocator(grid);
    return {options, around, volume, spray.units(), gravity};
  }
  void push(const DropletGas& droplets, Real step) {
    cfd::ParticleExchange exchange = cfd::make_empty_exchange(grid);
    droplets.add_to(exchange);
    for (Index c = 0; c < grid.cell_count(); ++c)
      state.velocity(c) += step * volume(c) / mass(c) * exchange.explicit_force(c);
  }
};

dem::EngineSetup periodic_box() {
  dem::EngineSetup setup = tests::glass_setup({side, side, side}, 1e-5);
  setup.domain.periodic = {1, 1, 1};
  return setup;
}

/// Twenty heavy parcels at once, then none.
SprayOptions burst(const Vec3& direction, Real speed, Real droplets_per_parcel, const Vec3& gravity = {}) {
  SprayOptions options;
  options.nozzles = {needle({0.003, 0.004, 0.005}, direction, speed)};
  options.nozzles[0].droplets_per_parcel = droplets_per_parcel;
  options.nozzles[0].mass_rate *= 2 * droplets_per_parcel;  // 20 in 0.1 ms
  options.nozzles[0].to = 1e-4;
  options.gravity = gravity;
  options.watch_momentum = true;
  return options;
}

Vec3 droplets_momentum(const Spray& spray) { return spray.momentum().in_flight; }

// 20 parcels of 1e5 droplets of 30 um, 2.83e-5 kg in all, in 4.8e-6 kg of gas: they slow down to the speed of both together,
// and the gas never goes faster than they do. One step is 10 times as long as a droplet's relaxation time of 2.8 ms would
// allow if the gas did not follow within it.
TEST(DropletGas, TotalMomentumIsConstantAndTheGasDoesNotOvershoot) {
  const Vec3 gravity{0, 0, -9.81};
  for (const Vec3& g : {Vec3{0, 0, 0}, gravity}) {
    const SprayOptions options = burst({0.6, 0, 0.8}, 10, 1e5, g);
    Rig rig(periodic_box(), {fixed_bead({0.019, 0.001, 0.019}, 1e-5)}, options);
    FreeGas gas({1, 1, 1});
    DropletGas droplets = gas.droplets({.two_way = true}, rig.spray, g);
    rig.droplets = &droplets;
    Real mass = 0;
    for (int k = 0; k < 300; ++k) {
      droplets.sample(gas.state);
      rig.outer_step();
      gas.push(droplets, 1e-4);
      const ParcelMomentum p = rig.spray.momentum();
      mass = rig.spray.figures()[0].injected;
      const Real scale = mass * 10;
      const Vec3 total =
          gas.momentum() + p.in_flight - droplets.impulses().gravity - p.injected + p.captured + p.overspray;
      ASSERT_LT(norm(total), 1e-13 * scale) << k;
      // What the gas has is what droplets gave.
      ASSERT_LT(norm(gas.momentum() - droplets.impulses().on_gas), 1e-13 * scale);
      const Real slowest = norm(p.in_flight) / (mass - rig.spray.figures()[0].captured);
      if (g.z == 0) {
        ASSERT_LE(norm(gas.state.velocity(0)), slowest * (1 + 1e-9)) << k;
      }
    }
    ASSERT_NEAR(mass, 20 * 1e5 * 1000 * M_PI / 6 * 2.7e-14, 1e-12);
    if (g.z != 0) {
      // Each fell for the time since its birth, evenly spread over the first 0.1 ms.
      EXPECT_NEAR(droplets.impulses().gravity.z, -9.81 * mass * (300e-4 - 0.5e-4), 1e-6 * 9.81 * mass * 0.03);
      continue;
    }
    // 10 m/s M / (M + m), along (0.6, 0, 0.8); 30 ms are many relaxation times of both.
    const Real shared = 10 * mass / (mass + gas.mass(0));
    EXPECT_NEAR(gas.state.velocity(0).x, 0.6 * shared, 1e-3 * shared);
    EXPECT_NEAR(gas.state.velocity(0).z, 0.8 * shared, 1e-3 * shared);
    EXPECT_NEAR(norm(droplets_momentum(rig.spray)), shared * mass, 1e-3 * shared * mass);
  }
}

// A light spray into gas at rest: a droplet of 30 um at 1 m/s gives in each cell what its velocity falls by there. In
// Stokes' drag (Re 2 at first; the law's own factor is used) its speed is 1 - x / (v0 tau) along its way.
TEST(DropletGas, EachCellGetsWhatDropletsLoseThere) {
  SprayOptions options = burst({1, 0, 0}, 1, 1);
  Rig rig(periodic_box(), {fixed_bead({0.019, 0.001, 0.019}, 1e-5)}, options);
  FreeGas gas({20, 1, 1});
  DropletGas droplets = gas.droplets({.two_way = true}, rig.spray);
  rig.droplets = &droplets;
  for (int k = 0; k < 200; ++k) {
    droplets.sample(gas.state);
    rig.outer_step();
    gas.push(droplets, 1e-4);
  }
  // One droplet by itself in gas at rest, in steps of a microsecond.
  const Real volume = M_PI / 6 * 2.7e-14, mass = 1000 * volume;
  std::vector<Real> expected(20);
  Vec3 place{0.003, 0, 0}, velocity{1, 0, 0};
  for (Real t = 0; t < 200e-4 - 0.5e-4; t += 1e-6) {
    const Real rate = relaxation_rate({1.2, 1.8e-5}, 1000, 30e-6, norm(velocity));
    const DropletStep step = move_droplet(velocity, {}, rate, {}, 1e-6);
    expected[static_cast<std::size_t>(place.x / 1e-3)] += 20 * mass * (velocity.x - step.velocity.x);
    place += step.path;
    velocity = step.velocity;
  }
  Real all = 0;
  for (Index c = 3; c < 5; ++c) {
    const Real got = gas.mass(c) * gas.state.velocity(c).x;
    // Drag that begins each move of 0.1 ms as it ends the last: first order in 0.1 ms / 2.3 ms.
    EXPECT_NEAR(got, expected[static_cast<std::size_t>(c)], 0.08 * expected[static_cast<std::size_t>(c)])
        << c;
    all += got;
  }
  EXPECT_GT(all, 0.8 * 20 * mass);
  EXPECT_NEAR(droplets.impulses().on_gas.x + droplets_momentum(rig.spray).x, 20 * mass, 1e-13 * 20 * mass);
  EXPECT_LT(std::abs(droplets.impulses().on_gas.y), 1e-20);
}

// Droplets that bounce off a bead: what the bead gave them is booked beside the gas's part.
TEST(DropletGas, BouncesAreBooked) {
  SprayOptions options = burst({1, 0, 0}, 20, 10);
  options.nozzles[0].position = {0.004, 0.01, 0.01};
  CaptureEfficiency& none = options.nozzles[0].efficiency;
  none.points = 1;
  none.surface_tension = 0.07;
  none.share[0] = 0;
  dem::EngineSetup setup = periodic_box();
  Rig rig(setup, {fixed_bead({0.012, 0.0102, 0.01}, 2e-3)}, options);
  FreeGas gas({2, 2, 2});
  DropletGas droplets = gas.droplets({.two_way = true}, rig.spray);
  rig.droplets = &droplets;
  for (int k = 0; k < 20; ++k) {
    droplets.sample(gas.state);
    rig.outer_step();
    gas.push(droplets, 1e-4);
  }
  const ParcelMomentum p = rig.spray.momentum();
  const DropletImpulses impulses = droplets.impulses();
  EXPECT_LT(impulses.bounced.x, -0.5 * p.injected.x);  // thrown back
  EXPECT_LT(norm(p.in_flight + impulses.on_gas - impulses.bounced - p.injected), 1e-13 * norm(p.injected));
  EXPECT_LT(norm(gas.momentum() - impulses.on_gas), 1e-13 * norm(p.injected));
}

TEST(DropletGas, TotalsGoThroughACheckpoint) {
  const tests::TemporaryFolder folder;
  SprayOptions options = burst({1, 0, 0}, 20, 10, {0, 0, -9.81});
  Rig rig(periodic_box(), {fixed_bead({0.019, 0.001, 0.019}, 1e-5)}, options);
  FreeGas gas({2, 2, 2});
  DropletGas droplets = gas.droplets({.two_way = true}, rig.spray, {0, 0, -9.81});
  rig.droplets = &droplets;
  droplets.sample(gas.state);
  for (int k = 0; k < 3; ++k) rig.outer_step();
  core::CheckpointWriter out(folder / "checkpoint.h5");
  droplets.save(out);
  rig.spray.save(out);
  out.close();
  DropletGas again = gas.droplets({.two_way = true}, rig.spray);
  Spray spray(options, {});
  core::CheckpointReader in(folder / "checkpoint.h5");
  again.load(in);
  spray.load(in);
  EXPECT_NE(droplets.impulses().on_gas.x, 0);
  EXPECT_NE(droplets.impulses().gravity.z, 0);
  EXPECT_EQ(again.impulses().on_gas, droplets.impulses().on_gas);
  EXPECT_EQ(again.impulses().gravity, droplets.impulses().gravity);
  EXPECT_EQ(spray.momentum().injected, rig.spray.momentum().injected);
}

// Warm thin gas in the half that the droplets fly in: drag by its own density and Sutherland's viscosity at 500 K,
// 2.67e-5 Pa s, not by those at the start.
TEST(DropletGas, DragIsThatOfTheGasInTheCell) {
  SprayOptions options = burst({1, 0, 0}, 30, 1);
  options.nozzles[0].to = 1.2e-6;
  options.nozzles[0].mass_rate *= 5;  // one, after 0.5 us
  Rig rig(periodic_box(), {fixed_bead({0.019, 0.001, 0.019}, 1e-5)}, options, 1);
  FreeGas gas({2, 1, 1});
  HostArray<Real>& temperature = gas.state.scalars[index_of(cfd::Scalar::temperature)];
  temperature = HostArray<Real>("test::temperature", 2);
  temperature(0) = 500;
  temperature(1) = 300;
  gas.state.density(0) = 0.7;
  DropletGas droplets = gas.droplets({.density_varies = true, .viscosity_follows = true}, rig.spray);
  rig.droplets = &droplets;
  droplets.sample(gas.state);
  rig.outer_step();
  ASSERT_EQ(rig.spray.parcels().count, 1);
  const Real flown = 1e-5 - 0.5e-6;
  const Real viscosity = 1.458e-6 * std::pow(500.0, 1.5) / (500 + 110.4);  // U.S. Standard Atmosphere 1976
  EXPECT_NEAR(viscosity, 2.67e-5, 0.01e-5);
  const Real reynolds = 0.7 * 30e-6 * 30 / viscosity;
  const Real rate = 18 * viscosity * (1 + 0.15 * std::pow(reynolds, 0.687)) / (1000 * 9e-10);
  EXPECT_NEAR(rig.spray.parcels().state(0).velocity.x, 30 * std::exp(-rate * flown), 30 * 1e-12);
}

}  // namespace
}  // namespace pellicle::spray
