// The whole gas solver: balances, restart, threads, failures.
#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

// A small spouted bed whose particles are prescribed: void fraction and drag move with time. Hot moist air comes in
// through the spout, warm dry air through the floor; the particles give off heat and vapour. Density and viscosity follow
// the temperature.
struct MovingBed {
  explicit MovingBed(PressureSolver kind = PressureSolver::multigrid, Index3 cells = {13, 2, 24})
      : grid(Box{{0, 0, 0}, {0.065, 0.02, 0.19}}, cells), exchange(make_empty_exchange(grid)) {
    GasOptions options = make_air();
    options.solver.pressure_solver = kind;
    ScalarOptions& temperature = options.scalars[index_of(Scalar::temperature)].emplace();
    temperature.capacity = 1005;
    temperature.conductivity = 0.026;
    temperature.initial = temperature.reference = 293.15;
    temperature.vapour_capacity = 1872;
    ScalarOptions& moisture = options.scalars[index_of(Scalar::moisture)].emplace();
    moisture.diffusivity = 2.5e-5;
    moisture.initial = 0.005;
    options.density_law = DensityLaw::ideal_gas;
    options.viscosity_law = ViscosityLaw::sutherland;
    solver = std::make_unique<GasSolver>(
        grid, options,
        std::vector<BoundaryPatch>{
            {"spout",
             Side::z_min,
             Box{{0.031, -1, -1}, {0.0355, 1, 1}},
             Inlet{30.0, {}},
             "case.yaml:2",
             {GivenValue{353.15}, GivenValue{0.02}}},
            {"floor", Side::z_min, {}, Inlet{1.5, {}}, "case.yaml:3", {GivenValue{313.15}, GivenValue{0.0}}},
            {"left", Side::x_min, {}, NoSlip{}, "case.yaml:4", {Surroundings{283.15, 20.0}, Insulated{}}},
            {"top", Side::z_max, {}, Outlet{0}, "case.yaml:5"}});
    exchange.scalars[index_of(Scalar::temperature)] = {
        HostArray<Real>("tests::heat", exchange.void_fraction.extent(0)),
        HostArray<Real>("tests::heat_transfer", exchange.void_fraction.extent(0))};
    exchange.scalars[index_of(Scalar::moisture)] = {
        HostArray<Real>("tests::vapour", exchange.void_fraction.extent(0)),
        HostArray<Real>("tests::vapour_taken", exchange.void_fraction.extent(0))};
    exchange.mass_source = exchange.scalars[index_of(Scalar::moisture)].rate;
    exchange.mass_source_momentum =
        HostArray<Vec3>("tests::vapour_momentum", exchange.void_fraction.extent(0));
    set_particles(0);
    solver->initialise(Vec3{0, 0, 1.5}, exchange.void_fraction);
  }
  void set_particles(Real time) {
    set_moving_bed(grid, time, exchange);
    const ScalarSource& heat = exchange.scalars[index_of(Scalar::temperature)];
    for (std::size_t c = 0; c < heat.rate.extent(0); ++c) {
      heat.coefficient(c) = 2e4 * (1 - exchange.void_fraction(c));
      const Real vapour = 0.5 * (1 - exchange.void_fraction(c));  // at 330 K and 2 m/s
      heat.rate(c) = 330 * heat.coefficient(c) + vapour * 1872 * (330 - 293.15);
      exchange.mass_source(c) = vapour;
      exchange.mass_source_momentum(c) = {0, 0, 2 * vapour};
    }
  }
  void advance_to_step(int end) {
    for (; step < end; ++step) {
      set_particles(1e-4 * (step + 1));
      report = solver->update(1e-4, exchange);
    }
  }
  std::uint64_t hash() const {
    std::uint64_t h = 14695981039346656037u;
    const auto mix = [&](Real v) { h = (h ^ std::bit_cast<std::uint64_t>(v)) * 1099511628211u; };
    const GasState& s = solver->state();
    for (Index c = 0; c < grid.cell_count(); ++c) {
      mix(s.pressure(c));
      for (int a = 0; a < 3; ++a) mix(s.velocity(c)[a]), mix(s.pressure_gradient(c)[a]);
    }
    for (const auto& faces : s.volume_flux) {
      for (std::size_t f = 0; f < faces.extent(0); ++f) mix(faces(f));
    }
    for (const auto& scalar : s.scalars) {
      for (std::size_t c = 0; c < scalar.extent(0); ++c) mix(scalar(c));
    }
    for (Index c = 0; c < grid.cell_count(); ++c) mix(s.density(c));
    for (const Scalar scalar : {Scalar::temperature, Scalar::moisture}) {
      const ScalarBalance& b = *solver->balance(scalar);
      mix(b.stock), mix(b.gross), mix(b.through_boundaries()), mix(b.sources), mix(b.leftover);
    }
    const GasBalance& b = solver->balance();
    mix(b.mass), mix(b.mass_given), mix(b.vapour.z), mix(b.mass_in()), mix(b.drag.z),
        mix(b.particle_pressure.z), mix(b.convected.z), mix(b.gross.x);
    return h;
  }
  CartesianGrid grid;
  ParticleExchange exchange;
  std::unique_ptr<GasSolver> solver;
  StepReport report;
  int step = 0;
};

TEST(GasSolver, BalancesCloseWhileParticlesMove) {
  MovingBed bed;
  bed.advance_to_step(200);
  const GasBalance& balance = bed.solver->balance();
  EXPECT_LT(balance.mass_defect(), 1e-10);
  // The moving void fraction really moves gas: the stock changed by far more than the defect.
  EXPECT_GT(std::abs(balance.mass - balance.mass_initial) / balance.mass_initial, 1e-3);
  EXPECT_LT(bed.report.continuity_residual, 1e-10);
  // Two outer iterations: the pressure steps where the void fraction jumps lag by one (see below for more iterations).
  EXPECT_LT(balance.momentum_defect(), 2e-4);
  EXPECT_GT(balance.mass_in(), 0);
  EXPECT_LE(bed.report.pressure_iterations, 40);
  // Bars of DESIGN.md; heat came from the particles, went to the wall, and there was much of it.
  const ScalarBalance& heat = *bed.solver->balance(Scalar::temperature);
  EXPECT_LT(heat.defect(), 1e-8);
  EXPECT_LT(bed.solver->balance(Scalar::moisture)->defect(), 1e-12);
  EXPECT_GT(balance.mass_given, 1e-3 * balance.mass_in());
  EXPECT_GT(heat.sources, 0.01 * heat.gross);
  EXPECT_LT(heat.into[2], 0);
}

// With more outer iterations the momentum balance closes to the linear solvers' tolerance.
TEST(GasSolver, MomentumClosesWhenIterated) {
  MovingBed bed;
  GasOptions options = make_air();
  make_tight(options);
  options.solver.max_outer_iterations = 40;
  options.solver.outer_tolerance = 1e-12;
  GasSolver solver(bed.grid, options,
                   {{"floor", Side::z_min, {}, Inlet{2, {}}, "case.yaml:3"},
                    {"top", Side::z_max, {}, Outlet{0}, "case.yaml:4"}});
  solver.initialise(Vec3{0, 0, 2}, bed.exchange.void_fraction);
  for (int i = 0; i < 20; ++i) {
    bed.set_particles(1e-4 * (i + 1));
    solver.update(1e-4, bed.exchange);
  }
  EXPECT_LT(solver.balance().momentum_defect(), 1e-11);
}

// In a closed box gas only moves around particles: its mass stays to round-off.
TEST(GasSolver, ClosedBoxKeepsItsGas) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.1, 0.1}}, {4, 5, 6}, {true, false, false});
  GasSolver solver(grid, make_air(), {});
  auto exchange = make_empty_exchange(grid);
  const auto place = [&](int step) {
    for (Index c = 0; c < grid.cell_count(); ++c) {
      const Index k = grid.coordinates(c).z;
      exchange.void_fraction(c) = 1 - (k == 2 ? 0.5 - 0.004 * step : (k == 3 ? 0.1 + 0.004 * step : 0));
      exchange.exchange_coefficient(c) = k == 2 || k == 3 ? 1000 : 0;
      exchange.explicit_force(c) = {0, 0, k == 2 || k == 3 ? 500.0 : 0};
    }
  };
  place(0);
  solver.initialise(Vec3{}, exchange.void_fraction);
  for (int step = 1; step <= 50; ++step) {
    place(step);
    solver.update(1e-4, exchange);
  }
  EXPECT_LT(solver.balance().mass_defect(), 1e-13);
  // 0.004 of the layer's volume a step moves up through its top: as much gas moves down.
  Real flow = 0;
  for (Index j = 0; j < 5; ++j) {
    for (Index i = 0; i < 4; ++i) flow += solver.state().volume_flux[2](grid.index(i, j, 3));
  }
  const Real expected = -0.004 * grid.width(2, 2) * 0.1 * 0.1 / 1e-4;
  EXPECT_NEAR(flow, expected, 1e-9 * std::abs(expected));
}

TEST(GasSolver, ThinGridsWork) {
  for (const Index3 cells :
       {Index3{6, 1, 8}, Index3{6, 2, 8}, Index3{1, 1, 8}, Index3{2, 2, 2}, Index3{1, 6, 1}}) {
    const CartesianGrid grid(Box{{0, 0, 0}, {0.06, 0.02, 0.08}}, cells);
    GasSolver solver(grid, make_air(),
                     {{"in", Side::z_min, {}, Inlet{1, {}}, "case.yaml:3"},
                      {"out", Side::z_max, {}, Outlet{0}, "case.yaml:4"}});
    const auto exchange = make_empty_exchange(grid);
    advance(solver, exchange, 1e-3, 50);
    EXPECT_LT(solver.balance().mass_defect(), 1e-10);
    EXPECT_NEAR(solver.balance().patches[1].mass_out, 1.2 * 0.05 * 0.06 * 0.02, 1e-10);
    EXPECT_TRUE(std::isfinite(solver.pressure_drop("in", "out")));
  }
}

// Gas drawn in through the outlet: a fan in the bottom sucks; the outlet's gas starts from rest at its pressure.
TEST(GasSolver, BackflowIsStable) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.01, 0.1}}, {10, 1, 10});
  auto patches = symmetry_on({Side::x_min, Side::x_max, Side::y_min, Side::y_max});
  patches.push_back({"fan", Side::z_min, {}, Inlet{-5.0, {}}, "case.yaml:3"});
  patches.push_back({"top", Side::z_max, {}, Outlet{0}, "case.yaml:4"});
  GasSolver solver(grid, make_air(), patches);
  advance(solver, make_empty_exchange(grid), 1e-3, 300);
  for (Index c = 0; c < grid.cell_count(); ++c) {
    EXPECT_NEAR(solver.state().velocity(c).z, -5, 1e-6);
    // Bernoulli from rest: -1/2 rho u^2.
    EXPECT_NEAR(solver.state().pressure(c), -0.5 * 1.2 * 25, 1e-4);
  }
}

class Restart : public testing::TestWithParam<PressureSolver> {};

// Writing the checkpoint drops what the resumed run does not have; from there on both must agree in every bit.
TEST_P(Restart, GoesOnBitForBit) {
  const auto path =
      std::filesystem::temp_directory_path() / ("pellicle_gas_" + std::to_string(::getpid()) + ".h5");
  MovingBed first(GetParam());
  first.advance_to_step(30);
  {
    core::CheckpointWriter writer(path);
    first.solver->save(writer);
    writer.close();
  }
  first.solver->drop_solver_hierarchies();
  first.advance_to_step(60);

  MovingBed second(GetParam());
  second.advance_to_step(3);  // a history that must not matter
  {
    core::CheckpointReader reader(path);
    second.solver->load(reader);
  }
  second.step = 30;
  second.advance_to_step(60);
  EXPECT_EQ(first.hash(), second.hash());
  EXPECT_EQ(first.solver->state().time, second.solver->state().time);
  std::filesystem::remove(path);
}
INSTANTIATE_TEST_SUITE_P(Both, Restart, testing::Values(PressureSolver::multigrid, PressureSolver::amgcl));

// Run by the test below in processes with one and with two threads.
TEST(GasThreads, PrintHash) {
  if (std::getenv("PELLICLE_PRINT_GAS_HASH") == nullptr) GTEST_SKIP() << "prints a hash for another test";
  for (const PressureSolver kind : {PressureSolver::multigrid, PressureSolver::amgcl}) {
    MovingBed bed(kind, {23, 8, 40});  // large enough for loops to use threads
    bed.advance_to_step(20);
    std::printf("hash %016llx\n", static_cast<unsigned long long>(bed.hash()));
  }
}

TEST(GasThreads, SameBitsWithOneAndTwoThreads) {
  std::array<std::string, 2> output;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  for (std::size_t t = 0; t < 2; ++t) {
    std::string command = "PELLICLE_PRINT_GAS_HASH=1 OMP_PROC_BIND=false OMP_NUM_THREADS=";
    command += t == 0 ? "1 " : "2 ";
    command += self + " --gtest_filter=GasThreads.PrintHash | grep hash";
    FILE* pipe = ::popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::array<char, 200> line{};
    while (std::fgets(line.data(), static_cast<int>(line.size()), pipe)) output[t] += line.data();
    ::pclose(pipe);
  }
  EXPECT_EQ(output[0].size(), 2 * std::string("hash 0123456789abcdef\n").size()) << output[0];
  EXPECT_EQ(output[0], output[1]);
}

TEST(GasFailure, SaysWhereAndWhen) {
  MovingBed bed;
  bed.advance_to_step(2);
  const auto message_with = [&](auto&& spoil) {
    bed.set_particles(0);
    spoil();
    try {
      bed.solver->update(1e-4, bed.exchange);
    } catch (const RunError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  const Index bad = bed.grid.index(3, 1, 5);
  std::string message = message_with([&] { bed.exchange.void_fraction(bad) = -0.1; });
  EXPECT_NE(message.find("void fraction"), std::string::npos) << message;
  EXPECT_NE(message.find("cell (3, 1, 5)"), std::string::npos) << message;
  EXPECT_NE(message.find("t = 0.0002 s"), std::string::npos) << message;
  message = message_with([&] { bed.exchange.exchange_coefficient(bad) = std::nan(""); });
  EXPECT_NE(message.find("exchange coefficient"), std::string::npos) << message;
  message = message_with([&] { bed.exchange.explicit_force(bad).x = std::numeric_limits<Real>::infinity(); });
  EXPECT_NE(message.find("gas: "), std::string::npos) << message;
  EXPECT_NE(message.find("cell ("), std::string::npos) << message;
}

TEST(GasFailure, ClosedDomainCannotLoseGas) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.1, 0.1}}, {3, 3, 3});
  GasSolver solver(grid, make_air(), {});
  auto exchange = make_empty_exchange(grid);
  exchange.void_fraction(13) = 0.5;
  EXPECT_THROW(solver.update(1e-4, exchange), RunError);
}

TEST(GasFailure, BadOptionsAreRefused) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.1, 0.1, 0.1}}, {3, 3, 3});
  GasOptions options = make_air();
  options.density = 0;
  EXPECT_THROW(GasSolver(grid, options, {}), InputError);
  options = make_air();
  options.viscosity = -1;
  EXPECT_THROW(GasSolver(grid, options, {}), InputError);
}

}  // namespace
}  // namespace pellicle::cfd
