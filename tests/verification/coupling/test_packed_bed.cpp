// A fixed lattice with gas pressed through it: the pressure drop is Ergun's.
#include <gtest/gtest.h>

#include "tests/verification/coupling/coupled_bed.hpp"

namespace pellicle::coupling {
namespace {

using testing::CoupledBed;

constexpr Real density = 1.2, viscosity = 1.8e-5;

// Simple cubic lattice of 2 mm spheres, 2.1 mm apart, in cells of 4 x 4 x 4 spheres: every sphere lies within one cell,
// so the void fraction is the same everywhere. Walls without shear. Ergun in superficial velocity U:
// -dp/dz = 150 (1-eps)2 mu U / (eps3 d2) + 1.75 (1-eps) rho U2 / (eps3 d).
TEST(PackedBed, PressureDropIsErguns) {
  const Real d = 2e-3, spacing = 2.1e-3, h = 4 * spacing;
  const Box box{{0, 0, 0}, {3 * h, 3 * h, 10 * h}};
  const CartesianGrid grid(box, {3, 3, 10});
  std::vector<dem::ParticleSeed> seeds;
  for (int k = 0; k < 40; ++k) {
    for (int j = 0; j < 12; ++j) {
      for (int i = 0; i < 12; ++i) {
        seeds.push_back(
            {{spacing * (i + 0.5), spacing * (j + 0.5), spacing * (k + 0.5)}, {}, {}, d / 2, 0, true});
      }
    }
  }
  const Real eps = 1 - std::numbers::pi / 6 * std::pow(d / spacing, 3);
  const std::vector<CartesianGrid> transfers{grid, CartesianGrid(box, {1, 3, 5})};
  for (const Exchange kind : {Exchange::implicit, Exchange::explicit_}) {
    for (const CartesianGrid& transfer : transfers) {
      for (const Real superficial : {0.1, 1.0}) {
        CouplingOptions options;
        options.drag = Ergun{};
        options.exchange = kind;
        cfd::GasOptions gas;
        gas.density = density;
        gas.viscosity = viscosity;
        // Explicit exchange is stable for beta dt / (rho eps) < 2: 2e-5 s here.
        const Real particle_step = kind == Exchange::implicit ? 5e-5 : 1e-5;
        const auto setup = testing::make_engine_setup(box, {false, false, false}, 2500, particle_step);
        CoupledBed bed(setup, seeds, grid, gas,
                       testing::add_slip_sides({testing::inlet(superficial), testing::outlet()}), options,
                       transfer, 2);
        bed.start_gas({0, 0, superficial / eps});
        bed.advance(150);
        EXPECT_NEAR(bed.gas.state().void_fraction(grid.index(1, 1, 5)), eps, 1e-12);
        const Real ergun = 150 * (1 - eps) * (1 - eps) * viscosity * superficial / (eps * eps * eps * d * d) +
                           1.75 * (1 - eps) * density * superficial * superficial / (eps * eps * eps * d);
        const Real gradient = (bed.gas.plane_pressure(2, 2 * h) - bed.gas.plane_pressure(2, 8 * h)) / (6 * h);
        std::printf("U %.1f m/s: %.6f of Ergun's pressure drop\n", superficial, gradient / ergun);
        // The requirement is 2 %; a uniform bed has no error of discretisation, and pending momentum is down to
        // 0.92^150 = 4e-6.
        EXPECT_NEAR(gradient / ergun, 1, 1e-4);
        // The bed carries the gas's pressure: drop over the whole bed x area = force on the particles, which are fixed
        // and so pass all of it on.
        const Vec3 received = bed.exchange.totals().particles_received;
        bed.advance(1);
        const ExchangeTotals& t = bed.exchange.totals();
        const Real force = (t.particles_received - received).z / bed.gas_step;
        EXPECT_NEAR(bed.gas.pressure_drop("inlet", "outlet") * 9 * h * h / force, 1, 1e-4);
        EXPECT_NEAR(norm(t.fixed_received - t.particles_received), 0, 1e-12 * t.gross);
      }
    }
  }
}

}  // namespace
}  // namespace pellicle::coupling
