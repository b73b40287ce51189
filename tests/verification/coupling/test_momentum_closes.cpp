// A small fluidised bed: the momentum that particles, exchange and gas account for, each on its own, agrees.
#include <gtest/gtest.h>

#include <random>

#include "tests/verification/coupling/coupled_bed.hpp"

namespace pellicle::coupling {
namespace {

using testing::CoupledBed;

TEST(MomentumCloses, ParticlesExchangeAndGasAgree) {
  const Real d = 2e-3, density = 1.2;
  const Box box{{0, 0, 0}, {0.02, 0.01, 0.05}};
  std::vector<dem::ParticleSeed> seeds;
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<Real> unit(-1, 1);
  for (int k = 0; k < 9; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 8; ++i) {
        seeds.push_back({{2.5e-3 * (i + 0.5) + 1e-4 * unit(generator),
                          2.5e-3 * (j + 0.5) + 1e-4 * unit(generator), 2.2e-3 * (k + 0.5)},
                         {0.1 * unit(generator), 0.1 * unit(generator), 0},
                         {},
                         d / 2,
                         0,
                         false});
      }
    }
  }
  const CartesianGrid grid(box, {5, 2, 12});
  const std::vector<CartesianGrid> transfers{grid, CartesianGrid(box, {3, 1, 8})};
  for (const Exchange kind : {Exchange::implicit, Exchange::explicit_}) {
    for (const CartesianGrid& transfer : transfers) {
      CouplingOptions options;
      options.exchange = kind;
      cfd::GasOptions gas;
      gas.density = density;
      gas.viscosity = 1.8e-5;
      const auto setup = testing::make_engine_setup(box, {false, false, false}, 1000, 1e-5);
      CoupledBed bed(setup, seeds, grid, gas,
                     testing::add_slip_sides({testing::inlet(1.2), testing::outlet()}), options, transfer,
                     10);
      bed.start_gas({0, 0, 1.2});
      bed.engine.collect_report();
      const Vec3 before = bed.engine.compute_totals().momentum;
      bed.advance(300);
      const dem::ParticleTotals after = bed.engine.compute_totals();
      const Vec3 walls = bed.engine.collect_report().wall_impulse;
      const ExchangeTotals& t = bed.exchange.totals();
      const cfd::GasBalance& balance = bed.gas.balance();
      // Scale: the weight of the bed over 0.03 s.
      const Real scale = after.mass * 9.81 * 0.03;
      // Particles: change = gravity + buoyancy + walls + what the exchange says they received. Contacts cancel.
      const Vec3 buoyancy = -(density * bed.engine.volume_time()) * testing::gravity;
      const Vec3 residual =
          after.momentum - before - bed.engine.gravity_impulse() - buoyancy - walls - t.particles_received;
      EXPECT_NEAR(norm(residual) / scale, 0, 1e-11);
      // Exchange.
      EXPECT_NEAR(norm(t.particles_received + t.gas_received + t.pending) / t.gross, 0, 1e-13);
      // Gas: received what the exchange says it was given.
      EXPECT_NEAR(norm(balance.drag + balance.particle_pressure - t.gas_received) / t.gross, 0, 1e-12);
      // What is pending is that of some ten steps, no more.
      EXPECT_LT(norm(t.pending) / t.gross, 0.05);
      std::printf("pending: %.2e of the gross exchange\n", norm(t.pending) / t.gross);
      // The bed is fluidised: the gas carries about its weight.
      EXPECT_GT(t.particles_received.z, 0.3 * scale);
    }
  }
}

}  // namespace
}  // namespace pellicle::coupling
