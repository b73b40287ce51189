// The exchange of momentum, with gases simple enough to follow by hand in place of the gas solver.
#include <gtest/gtest.h>

#include <unistd.h>
#include <atomic>
#include <cstdio>

#include <filesystem>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "coupling/momentum_exchange.hpp"
#include "tests/coupling/helpers.hpp"

namespace pellicle::coupling {
namespace {

using testing::make_particles;
using testing::sphere_volume;
using testing::TestParticle;

constexpr Real density = 1.2, viscosity = 1.8e-5;
const GasProperties air{density, viscosity, {0, 0, -9.81}};
const Box box{{0, 0, 0}, {0.03, 0.02, 0.06}};

template <class Force>
struct Substep {
  Force force;
  dem::Particles particles;
  DeviceArray<Vec3> total;  // impulse of the whole force, buoyancy included
  Real dt;
  bool moving;

  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const {
    dem::VelocitySpin motion = particles.velocity_spin(p);
    const Vec3 f = force(p, motion.velocity(), dt);
    total(p) += dt * f;
    if (!moving) return;
    const Vec3 change = (dt / particles.mass(p)) * f;
    motion.vx += change.x;
    motion.vy += change.y;
    motion.vz += change.z;
    particles.velocity_spin(p) = motion;
    particles.position_radius(p).x += dt * motion.vx;
    particles.position_radius(p).y += dt * motion.vy;
    particles.position_radius(p).z += dt * motion.vz;
  }
};

/// Substeps of all particles; returns the impulse each received, buoyancy included.
std::vector<Vec3> run_substeps(const MomentumExchange& exchange, const dem::Particles& particles, int count,
                               Real dt, bool moving = false) {
  const DeviceArray<Vec3> total("tests::momentum_exchange::total", static_cast<std::size_t>(particles.count));
  std::visit(
      [&](const auto& force) {
        using Force = std::decay_t<decltype(force)>;
        for (int k = 0; k < count; ++k) {
          Kokkos::parallel_for("tests::momentum_exchange::substep", DeviceRange(0, particles.count),
                               Substep<Force>{force, particles, total, dt, moving});
        }
      },
      exchange.fluid_force(particles));
  return testing::to_vector(total, particles.count);
}

/// A gas whose velocity and pressure gradient the tests set.
cfd::GasState make_gas(const CartesianGrid& grid) {
  const auto cells = static_cast<std::size_t>(grid.cell_count());
  cfd::GasState gas;
  gas.velocity = HostArray<Vec3>("tests::momentum_exchange::velocity", cells);
  gas.pressure_gradient = HostArray<Vec3>("tests::momentum_exchange::pressure_gradient", cells);
  return gas;
}

void expect_near(const Vec3& a, const Vec3& b, Real tolerance) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

Real cell_volume(const CartesianGrid& grid, Index c) {
  const Index3 at = grid.coordinates(c);
  return grid.volume(at.x, at.y, at.z);
}

// One particle wholly inside a cell: everything about its force by hand.
TEST(MomentumExchange, ForceOnOneParticleByHand) {
  const CartesianGrid grid(box, {3, 2, 6});  // 10 mm cells
  const Vec3 u{2, 0, 1}, v{1, 0, 0.5}, gradient{100, -50, -300};
  for (const Coefficients coefficients : {Coefficients::gas_step, Coefficients::substep}) {
    for (const bool pressure : {true, false}) {
      CouplingOptions options;
      options.drag = WenYu{};
      options.coefficients = coefficients;
      options.pressure_gradient_force = pressure;
      MomentumExchange exchange(options, grid, grid, air);
      const dem::Particles particles = make_particles({{{0.015, 0.015, 0.025}, 2e-3, v}});
      exchange.initialise(particles);
      const Real volume = sphere_volume(2e-3), eps = 1 - volume / 1e-6;
      EXPECT_NEAR(exchange.exchange().void_fraction(grid.index(1, 1, 2)), eps, 1e-15);
      cfd::GasState gas = make_gas(grid);
      Kokkos::deep_copy(gas.velocity, u);
      Kokkos::deep_copy(gas.pressure_gradient, gradient);
      exchange.sample_gas(gas.velocity, gas.pressure_gradient);
      exchange.compute_coefficients(particles);
      const auto impulse = run_substeps(exchange, particles, 2, 1e-5);
      const Real slip = std::sqrt(1.25), re = density * eps * 4e-3 * slip / viscosity;
      // 3/4 C_D rho eps s eps^-2.65 / d, C_D = 24/Re (1 + 0.15 Re^0.687); Re = 293.
      const Real k =
          0.75 * 24 / re * (1 + 0.15 * std::pow(re, 0.687)) * density * std::pow(eps, -1.65) * slip / 4e-3;
      Vec3 force = volume * k * (u - v);
      if (pressure) force += -volume * gradient + Vec3{0, 0, volume * density * 9.81};
      expect_near(impulse[0], 2e-5 * force, 1e-12 * 2e-5 * norm(force));
    }
  }
}

// Where properties vary, drag is that of the gas in the particle's cells: here thin and hot, elsewhere different. Buoyancy stays that of the reference density.
TEST(MomentumExchange, DragFeelsTheGasOfTheParticlesCells) {
  const CartesianGrid grid(box, {3, 2, 6});
  const Vec3 u{2, 0, 1}, v{1, 0, 0.5};
  for (const Coefficients coefficients : {Coefficients::gas_step, Coefficients::substep}) {
    CouplingOptions options;
    options.drag = WenYu{};
    options.coefficients = coefficients;
    GasProperties varying = air;
    varying.density_varies = varying.sutherland = true;
    MomentumExchange exchange(options, grid, grid, varying);
    const dem::Particles particles = make_particles({{{0.015, 0.015, 0.025}, 2e-3, v}});
    exchange.initialise(particles);
    cfd::GasState gas = make_gas(grid);
    Kokkos::deep_copy(gas.velocity, u);
    const HostArray<Real> gas_density("tests::momentum_exchange::density", 36);
    const HostArray<Real> temperature("tests::momentum_exchange::temperature", 36);
    Kokkos::deep_copy(gas_density, 5);
    Kokkos::deep_copy(temperature, 1000);
    gas_density(grid.index(1, 1, 2)) = 0.5;
    temperature(grid.index(1, 1, 2)) = 500;
    exchange.sample_gas(gas.velocity, gas.pressure_gradient, gas_density, temperature);
    exchange.compute_coefficients(particles);
    const auto impulse = run_substeps(exchange, particles, 2, 1e-5);
    const Real mu = 2.6705333e-5;  // U.S. Standard Atmosphere: 1.458e-6 T^1.5 / (T + 110.4)
    const Real volume = sphere_volume(2e-3), eps = 1 - volume / 1e-6, slip = std::sqrt(1.25);
    const Real re = 0.5 * eps * 4e-3 * slip / mu;
    const Real k =
        0.75 * 24 / re * (1 + 0.15 * std::pow(re, 0.687)) * 0.5 * std::pow(eps, -1.65) * slip / 4e-3;
    const Vec3 force = volume * k * (u - v) + Vec3{0, 0, volume * density * 9.81};
    expect_near(impulse[0], 2e-5 * force, 1e-7 * 2e-5 * norm(force));  // digits of mu
  }
}

// With coefficients `substep`, K follows the particle: its impulse differs from that with a fixed K as the law says.
TEST(MomentumExchange, CoefficientFollowsTheParticleEverySubstep) {
  const CartesianGrid grid(box, {3, 2, 6});
  CouplingOptions options;
  options.drag = Ergun{};
  options.pressure_gradient_force = false;
  for (const Coefficients coefficients : {Coefficients::gas_step, Coefficients::substep}) {
    options.coefficients = coefficients;
    MomentumExchange exchange(options, grid, grid, air);
    const dem::Particles particles = make_particles({{{0.015, 0.015, 0.025}, 2e-3, {}}});
    const Real volume = sphere_volume(2e-3), eps = 1 - volume / 1e-6, mass = 1e-6, dt = 1e-3;
    Kokkos::deep_copy(particles.mass, mass);
    exchange.initialise(particles);
    cfd::GasState gas = make_gas(grid);
    Kokkos::deep_copy(gas.velocity, Vec3{10, 0, 0});
    exchange.sample_gas(gas.velocity, gas.pressure_gradient);
    exchange.compute_coefficients(particles);
    const auto impulse = run_substeps(exchange, particles, 5, dt, true);
    Real speed = 0;
    for (int k = 0; k < 5; ++k) {
      const Real slip = coefficients == Coefficients::substep ? 10 - speed : 10;
      const Real ergun = 150 * (1 - eps) * viscosity / (eps * 16e-6) + 1.75 * density * slip / 4e-3;
      speed += dt / mass * volume * ergun * (10 - speed);
    }
    EXPECT_NEAR(impulse[0].x, mass * speed, 1e-12 * mass * speed);
  }
}

/// Particles on a lattice that fills a periodic cell uniformly.
std::vector<TestParticle> lattice(const Box& in, Index3 count, Real radius, const Vec3& velocity = {}) {
  std::vector<TestParticle> made;
  for (int k = 0; k < count.z; ++k) {
    for (int j = 0; j < count.y; ++j) {
      for (int i = 0; i < count.x; ++i) {
        made.push_back({{in.min.x + (in.max.x - in.min.x) * (i + 0.5) / count.x,
                         in.min.y + (in.max.y - in.min.y) * (j + 0.5) / count.y,
                         in.min.z + (in.max.z - in.min.z) * (k + 0.5) / count.z},
                        radius,
                        velocity});
      }
    }
  }
  return made;
}

// Gas at rest but for the drag of fixed particles, one cell: with r = beta dt / (rho eps) and pending momentum d,
//   u' = (u + a d) / (1 + r),  d' = d + r (u' - u) - a d     (docs/theory/coupling.md),
// here with Ergun without its quadratic part (slow gas, 1e-6 m/s), so that r is constant.
TEST(MomentumExchange, ImplicitDragFollowsItsRecurrenceAndIsStable) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.02, 0.02, 0.02}}, {1, 1, 1}, {true, true, true});
  CouplingOptions options;
  options.drag = Ergun{};
  const Real radius = 0.9e-3;
  const auto from = lattice(grid.box(), {10, 10, 10}, radius);
  const Real eps = 1 - 1000 * sphere_volume(radius) / 8e-6;
  const Real beta = (1 - eps) * 150 * (1 - eps) * viscosity / (eps * 4 * radius * radius);
  for (const Real r : {0.1, 1.0, 10.0}) {
    const Real dt = r * density * eps / beta;
    MomentumExchange exchange(options, grid, grid, air);
    const dem::Particles particles = make_particles(from);
    exchange.initialise(particles);
    cfd::GasState gas = make_gas(grid);
    const Real u0 = 1e-6;
    Kokkos::deep_copy(gas.velocity, Vec3{u0, 0, 0});
    Real u = u0, d = 0, largest = 0;
    const int steps = 200;
    for (int step = 0; step < steps; ++step) {
      exchange.sample_gas(gas.velocity, gas.pressure_gradient);
      exchange.compute_coefficients(particles);
      run_substeps(exchange, particles, 4, dt / 4);
      const auto& on_gas = exchange.deposit(particles, dt);
      EXPECT_NEAR(on_gas.void_fraction(0), eps, 1e-13);
      gas.velocity(0) = 1 / (density * eps / dt + on_gas.exchange_coefficient(0)) *
                        ((density * eps / dt) * gas.velocity(0) + on_gas.explicit_force(0));
      exchange.close_step(gas, dt);
      const Real before = u, a = options.pending_release;
      u = (u + a * d) / (1 + r);
      d += r * (u - before) - a * d;
      // Ergun's quadratic part is 1.75 rho u / d over 150 eps_p mu / (eps d2): 2e-5 at 1e-6 m/s.
      EXPECT_NEAR(gas.velocity(0).x, u, 1e-4 * u0) << "r " << r << " step " << step;
      largest = std::max(largest, std::abs(gas.velocity(0).x));
      const ExchangeTotals& t = exchange.totals();
      const Real scale = density * eps * 8e-6 * u0 * std::max(1.0, r);
      expect_near(t.particles_received + t.gas_received + t.pending, {}, 1e-13 * scale);
      EXPECT_NEAR(t.pending.x, density * eps * 8e-6 * d, 2e-4 * scale);
      EXPECT_NEAR(t.gas_received.x, density * eps * 8e-6 * (gas.velocity(0).x - u0), 1e-12 * scale);
    }
    EXPECT_LE(largest, u0);
    // The slow root is 1 - a r / (r + a) or so: (1 - 0.05)^200 = 3e-5 at r = 0.1.
    EXPECT_LT(std::abs(gas.velocity(0).x), 1e-4 * u0) << "r " << r;
    EXPECT_LT(std::abs(exchange.totals().pending.x), 1e-3 * density * eps * 8e-6 * u0 * std::max(1.0, r));
  }
}

// Explicit exchange gives the gas the opposite of what the particles received: u' = (1 - r) u.
TEST(MomentumExchange, ExplicitDragIsTheExactReaction) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.02, 0.02, 0.02}}, {1, 1, 1}, {true, true, true});
  CouplingOptions options;
  options.drag = Ergun{};
  options.exchange = Exchange::explicit_;
  const Real radius = 0.9e-3;
  const dem::Particles particles = make_particles(lattice(grid.box(), {10, 10, 10}, radius));
  const Real eps = 1 - 1000 * sphere_volume(radius) / 8e-6;
  const Real beta = (1 - eps) * 150 * (1 - eps) * viscosity / (eps * 4 * radius * radius);
  const Real r = 0.3, dt = r * density * eps / beta, u0 = 1e-6;
  MomentumExchange exchange(options, grid, grid, air);
  exchange.initialise(particles);
  cfd::GasState gas = make_gas(grid);
  Kokkos::deep_copy(gas.velocity, Vec3{u0, 0, 0});
  for (int step = 1; step <= 20; ++step) {
    exchange.sample_gas(gas.velocity, gas.pressure_gradient);
    exchange.compute_coefficients(particles);
    run_substeps(exchange, particles, 4, dt / 4);
    const auto& on_gas = exchange.deposit(particles, dt);
    EXPECT_EQ(on_gas.exchange_coefficient(0), 0);
    gas.velocity(0) += (dt / (density * eps)) * on_gas.explicit_force(0);
    exchange.close_step(gas, dt);
    EXPECT_NEAR(gas.velocity(0).x, u0 * std::pow(1 - r, step), 1e-4 * u0);
    expect_near(exchange.totals().pending, {}, 1e-14 * density * 8e-6 * u0);
  }
}

TEST(MomentumExchange, OneWayGasHearsNothing) {
  const CartesianGrid grid(box, {3, 2, 6});
  CouplingOptions options;
  options.exchange = Exchange::one_way;
  const dem::Particles particles = make_particles(testing::random_particles(box, 400, 1.5e-3, 23));
  MomentumExchange exchange(options, grid, grid, air);
  exchange.initialise(particles);
  cfd::GasState gas = make_gas(grid);
  Kokkos::deep_copy(gas.velocity, Vec3{1, 2, 3});
  exchange.sample_gas(gas.velocity, gas.pressure_gradient);
  exchange.compute_coefficients(particles);
  run_substeps(exchange, particles, 2, 1e-5);
  const auto& on_gas = exchange.deposit(particles, 2e-5);
  exchange.close_step(gas, 2e-5);
  for (Index c = 0; c < grid.cell_count(); ++c) {
    EXPECT_EQ(on_gas.void_fraction(c), 1);
    EXPECT_EQ(on_gas.exchange_coefficient(c), 0);
    EXPECT_EQ(on_gas.explicit_force(c), (Vec3{}));
  }
  EXPECT_GT(norm(exchange.totals().particles_received), 0);
  EXPECT_EQ(exchange.totals().pending, (Vec3{}));
}

// Solids and momentum through deposition onto gas grids that are the same, finer, coarser, stretched: what arrives is
// what the particles, one by one, sent.
TEST(MomentumExchange, SolidsAndMomentumArriveOnAnyGasGrid) {
  const CartesianGrid transfer(box, {5, 3, 8});
  const std::vector<CartesianGrid> gases{
      transfer, CartesianGrid(box, {15, 6, 32}), CartesianGrid(box, {2, 1, 3}),
      CartesianGrid({testing::stretched_faces(0, 0.03, 8, 1.15), testing::stretched_faces(0, 0.02, 5, 0.8),
                     testing::stretched_faces(0, 0.06, 10, 1.1)})};
  const auto from = testing::random_particles(box, 1500, 1.5e-3, 23);
  for (const CartesianGrid& grid : gases) {
    for (const Exchange kind : {Exchange::implicit, Exchange::explicit_}) {
      CouplingOptions options;
      options.exchange = kind;
      options.minimum_void_fraction = 0.7;  // so that the bound has work to do
      const dem::Particles particles = make_particles(from);
      Kokkos::deep_copy(particles.mass, 1e-5);
      MomentumExchange exchange(options, transfer, grid, air);
      exchange.initialise(particles);
      EXPECT_GT(exchange.bound_report().cells_over, 0);
      cfd::GasState gas = make_gas(grid);
      for (Index c = 0; c < grid.cell_count(); ++c) {
        gas.velocity(c) = {std::sin(c), 2 * std::cos(c), 3};
        gas.pressure_gradient(c) = {10 * std::cos(c), 5, -100 * std::sin(c)};
      }
      exchange.sample_gas(gas.velocity, gas.pressure_gradient);
      exchange.compute_coefficients(particles);
      const Real dt = 1e-4;
      const auto impulses = run_substeps(exchange, particles, 10, dt / 10, true);
      const auto sampled = testing::to_vector(exchange.sampled_gas(), particles.count);
      const auto& on_gas = exchange.deposit(particles, dt);
      Real solids_sent = 0, solids = 0, coefficient_sent = 0, coefficient = 0;
      Vec3 force_sent, force, received;
      Real gross = 0;
      for (std::size_t p = 0; p < from.size(); ++p) {
        const Real volume = sphere_volume(from[p].radius);
        solids_sent += volume;
        // Without buoyancy, which acts beside the exchange.
        const Vec3 impulse = impulses[p] - Vec3{0, 0, volume * density * 9.81 * dt};
        received += impulse;
        gross += norm(impulse) / dt;
        force_sent -= (1 / dt) * impulse - sampled[p].pressure_force;
        if (kind == Exchange::implicit) {
          coefficient_sent += sampled[p].drag_coefficient;
          force_sent += sampled[p].drag_coefficient * sampled[p].velocity;
        }
      }
      for (Index c = 0; c < grid.cell_count(); ++c) {
        const Real volume = cell_volume(grid, c);
        solids += (1 - on_gas.void_fraction(c)) * volume;
        coefficient += on_gas.exchange_coefficient(c) * volume;
        force += volume * on_gas.explicit_force(c);
        EXPECT_GE(on_gas.void_fraction(c), 0.7 - 1e-9);
      }
      EXPECT_NEAR(solids / solids_sent, 1, 1e-12);
      EXPECT_NEAR(coefficient, coefficient_sent, 1e-12 * coefficient_sent);
      expect_near(force, force_sent, 1e-12 * (gross + 3 * coefficient_sent));
      expect_near(exchange.totals().particles_received, received, 1e-12 * gross * dt);
      exchange.close_step(gas, dt);
      const ExchangeTotals& t = exchange.totals();
      expect_near(t.particles_received + t.gas_received + t.pending, {}, 1e-12 * gross * dt);
      EXPECT_LE(t.gross, gross * dt * (1 + 1e-12));
      EXPECT_GT(t.gross, 0.2 * gross * dt);
    }
  }
}

// A fixed bed in a column through which gas is pressed at a fixed superficial velocity, cell by cell:
//   eps rho (u' - u) / dt = -eps grad p' - beta u' + F,  eps u' = U.
// In the end the pressure drop times the area is the whole force on the particles (drag and pressure gradient), in
// dense and thin layers, however stiff the drag.
TEST(MomentumExchange, PressureDropCarriesTheForceOnTheParticles) {
  const CartesianGrid grid(Box{{0, 0, 0}, {0.02, 0.02, 0.1}}, {1, 1, 20}, {true, true, false});
  auto from = lattice(Box{{0, 0, 0.02}, {0.02, 0.02, 0.06}}, {10, 10, 20}, 0.95e-3);
  for (std::size_t p = 0; p < from.size(); ++p) from[p].position.z += 4e-4 * std::sin(static_cast<Real>(p));
  for (const Real dt : {1e-6, 1e-4, 1e-2}) {  // r up to 0.03, 3, 300
    CouplingOptions options;
    options.drag = Beetstra{};
    MomentumExchange exchange(options, grid, grid, air);
    const dem::Particles particles = make_particles(from);
    exchange.initialise(particles);
    cfd::GasState gas = make_gas(grid);
    const Real superficial = 0.5;
    const int steps = 400;
    Vec3 received_before;
    Real largest_gradient = 0;
    for (int step = 0; step < steps; ++step) {
      received_before = exchange.totals().particles_received;
      exchange.sample_gas(gas.velocity, gas.pressure_gradient);
      exchange.compute_coefficients(particles);
      run_substeps(exchange, particles, 3, dt / 3);
      const auto& on_gas = exchange.deposit(particles, dt);
      for (Index c = 0; c < grid.cell_count(); ++c) {
        const Real eps = on_gas.void_fraction(c), u = superficial / eps;
        const Real inertia = step == 0 ? 0 : density * eps * (u - gas.velocity(c).z) / dt;
        gas.pressure_gradient(c).z =
            (on_gas.explicit_force(c).z - on_gas.exchange_coefficient(c) * u - inertia) / eps;
        gas.velocity(c).z = u;
        if (step > 50) largest_gradient = std::max(largest_gradient, std::abs(gas.pressure_gradient(c).z));
      }
      exchange.close_step(gas, dt);
    }
    Real drop = 0;
    for (Index c = 0; c < grid.cell_count(); ++c) drop -= 0.005 * gas.pressure_gradient(c).z;
    const Real force = (exchange.totals().particles_received - received_before).z / dt;
    // The slowest root is 0.92 a step (void fraction 0.36): 0.92^400 = 3e-15.
    EXPECT_NEAR(drop * 0.02 * 0.02 / force, 1, 1e-9) << "dt " << dt;
    // Void fraction 0.55, 0.5 m/s: Ergun gives 1.2 kPa/m; nothing rings far above it.
    EXPECT_LT(largest_gradient, 2.5e3);
    EXPECT_GT(largest_gradient, 8e2);
    expect_near(
        exchange.totals().particles_received + exchange.totals().gas_received + exchange.totals().pending, {},
        1e-12 * force * dt * steps);
  }
}

// Release beyond the bound of the pressure part is refused: 2 / (1 + 2 x 0.64 / 0.36) = 0.439.
TEST(MomentumExchange, RefusesOptionsOutOfRange) {
  const CartesianGrid grid(box, {3, 2, 6});
  CouplingOptions options;
  options.pending_release = 0.44;
  EXPECT_THROW(MomentumExchange(options, grid, grid, air), InputError);
  options.pending_release = 0.43;
  EXPECT_NO_THROW(MomentumExchange(options, grid, grid, air));
  options.minimum_void_fraction = 0;
  EXPECT_THROW(MomentumExchange(options, grid, grid, air), InputError);
  options = {};
  EXPECT_THROW(MomentumExchange(options, CartesianGrid(Box{{0, 0, 0}, {1, 1, 1}}, {2, 2, 2}), grid, air),
               InputError);
  EXPECT_THROW(MomentumExchange(options, grid, grid, {0, viscosity, {}}), InputError);
  // 4000 spheres of 1.5 mm radius fill more than the box.
  MomentumExchange exchange(options, grid, grid, air);
  EXPECT_THROW(exchange.initialise(make_particles(lattice(box, {20, 20, 10}, 1.5e-3))), RunError);
}

/// Some outer steps with a made-up gas that follows what it is told; returns all there is to compare.
struct Loop {
  MomentumExchange exchange;
  cfd::GasState gas;
  dem::Particles particles;

  explicit Loop(const CartesianGrid& transfer, const CartesianGrid& grid)
      : exchange(CouplingOptions{}, transfer, grid, air),
        gas(make_gas(grid)),
        particles(make_particles(testing::random_particles(box, 1500, 1.2e-3, 29))) {
    Kokkos::deep_copy(particles.mass, 1e-5);
    Kokkos::deep_copy(gas.velocity, Vec3{0.1, 0.2, 1});
  }
  void advance(int steps) {
    const Real dt = 1e-4;
    for (int step = 0; step < steps; ++step) {
      exchange.sample_gas(gas.velocity, gas.pressure_gradient);
      exchange.compute_coefficients(particles);
      run_substeps(exchange, particles, 5, dt / 5, true);
      const auto& on_gas = exchange.deposit(particles, dt);
      for (std::size_t c = 0; c < gas.velocity.extent(0); ++c) {
        const Real inertia = density * on_gas.void_fraction(c) / dt;
        gas.velocity(c) = 1 / (inertia + on_gas.exchange_coefficient(c)) *
                          (inertia * gas.velocity(c) + on_gas.explicit_force(c) + Vec3{0, 0, 500});
        gas.pressure_gradient(c) = 20.0 * gas.velocity(c);
      }
      exchange.close_step(gas, dt);
    }
  }
};

TEST(MomentumExchange, ContinuesBitForBitFromACheckpoint) {
  const CartesianGrid transfer(box, {5, 3, 8}), grid(box, {10, 5, 20});
  const auto path =
      std::filesystem::temp_directory_path() / ("pellicle_coupling_" + std::to_string(::getpid()) + ".h5");
  Loop straight(transfer, grid);
  straight.exchange.initialise(straight.particles);
  straight.advance(4);
  {
    core::CheckpointWriter writer(path);
    straight.exchange.save(writer);
    writer.close();
  }
  Loop resumed(transfer, grid);
  Kokkos::deep_copy(resumed.particles.position_radius, straight.particles.position_radius);
  Kokkos::deep_copy(resumed.particles.velocity_spin, straight.particles.velocity_spin);
  Kokkos::deep_copy(resumed.gas.velocity, straight.gas.velocity);
  Kokkos::deep_copy(resumed.gas.pressure_gradient, straight.gas.pressure_gradient);
  {
    core::CheckpointReader reader(path);
    resumed.exchange.load(reader);
    MomentumExchange other(CouplingOptions{}, grid, grid, air);
    EXPECT_THROW(other.load(reader), RunError);
  }
  std::filesystem::remove(path);
  for (std::size_t c = 0; c < straight.gas.velocity.extent(0); ++c) {
    EXPECT_EQ(resumed.exchange.exchange().void_fraction(c), straight.exchange.exchange().void_fraction(c));
  }
  straight.advance(3);
  resumed.advance(3);
  for (std::size_t c = 0; c < straight.gas.velocity.extent(0); ++c) {
    ASSERT_EQ(resumed.gas.velocity(c), straight.gas.velocity(c));
    ASSERT_EQ(resumed.exchange.exchange().explicit_force(c), straight.exchange.exchange().explicit_force(c));
  }
  EXPECT_EQ(resumed.exchange.totals().pending, straight.exchange.totals().pending);
  EXPECT_EQ(resumed.exchange.totals().particles_received, straight.exchange.totals().particles_received);
  EXPECT_EQ(resumed.exchange.totals().gross, straight.exchange.totals().gross);
}

// The order of the particles in memory decides roundings only.
TEST(MomentumExchange, ParticlesMayBeReorderedBetweenOuterSteps) {
  const CartesianGrid grid(box, {5, 3, 8});
  Loop a(grid, grid), b(grid, grid);
  a.exchange.initialise(a.particles);
  b.exchange.initialise(b.particles);
  a.advance(2);
  b.advance(2);
  const Index last = b.particles.count - 1;
  auto place = testing::to_vector(b.particles.position_radius, b.particles.count);
  auto motion = testing::to_vector(b.particles.velocity_spin, b.particles.count);
  const auto place_host = Kokkos::create_mirror_view(b.particles.position_radius);
  const auto motion_host = Kokkos::create_mirror_view(b.particles.velocity_spin);
  for (Index p = 0; p <= last; ++p) {
    place_host(p) = place[static_cast<std::size_t>(last - p)];
    motion_host(p) = motion[static_cast<std::size_t>(last - p)];
  }
  Kokkos::deep_copy(b.particles.position_radius, place_host);
  Kokkos::deep_copy(b.particles.velocity_spin, motion_host);
  a.advance(2);
  b.advance(2);
  for (std::size_t c = 0; c < a.gas.velocity.extent(0); ++c) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a.gas.velocity(c)[axis], b.gas.velocity(c)[axis], 1e-12);
  }
}

std::atomic<int> allocations{0};
void count_allocation(const Kokkos::Tools::SpaceHandle, const char*, const void*, const std::uint64_t) {
  ++allocations;
}

TEST(MomentumExchange, AllocatesNothingInASteadyStep) {
  const CartesianGrid transfer(box, {5, 3, 8}), grid(box, {10, 5, 20});
  Loop loop(transfer, grid);
  loop.exchange.initialise(loop.particles);
  const Real dt = 1e-4;
  const auto step = [&] {
    loop.exchange.sample_gas(loop.gas.velocity, loop.gas.pressure_gradient);
    loop.exchange.compute_coefficients(loop.particles);
    loop.exchange.deposit(loop.particles, dt);
    loop.exchange.close_step(loop.gas, dt);
  };
  step();
  allocations = 0;
  Kokkos::Tools::Experimental::set_allocate_data_callback(count_allocation);
  step();
  EXPECT_EQ(allocations, 0);
  const DeviceArray<Real> one("tests::momentum_exchange::one", 1);
  EXPECT_EQ(allocations, 1);  // the callback does count
  Kokkos::Tools::Experimental::set_allocate_data_callback(nullptr);
}

}  // namespace
}  // namespace pellicle::coupling
