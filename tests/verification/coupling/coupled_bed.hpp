// Particles and gas coupled: the outer step as the simulation takes it, without its files.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "cfd/gas_solver.hpp"
#include "core/timers.hpp"
#include "coupling/momentum_exchange.hpp"
#include "dem/engine.hpp"

namespace pellicle::coupling::testing {

constexpr Vec3 gravity{0, 0, -9.81};

/// An engine with one material and restitution 0.8 in a box with walls on all sides that are not periodic.
inline dem::EngineSetup make_engine_setup(const Box& box, std::array<bool, 3> periodic, Real particle_density,
                                          Real time_step) {
  dem::EngineSetup setup;
  setup.domain.box = box;
  setup.materials = {{"particles", particle_density, 1e7, 0.25, false}};
  setup.pairs = {{0, 0, 0.8, 0.3, 0}};
  setup.gravity = gravity;
  setup.time_step = time_step;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    setup.domain.periodic[axis] = periodic[a] ? 1 : 0;
    if (periodic[a]) continue;
    Vec3 normal;
    normal[axis] = 1;
    setup.walls.push_back(dem::PlaneWall{"low", box.min, normal, {}, 0});
    setup.walls.push_back(dem::PlaneWall{"high", box.max, -normal, {}, 0});
  }
  return setup;
}

/// One outer step after the other.
struct CoupledBed {
  dem::Engine engine;
  cfd::GasSolver gas;
  MomentumExchange exchange;
  core::Timers timers;
  Real gas_step;
  int substeps;

  CoupledBed(const dem::EngineSetup& setup, const std::vector<dem::ParticleSeed>& seeds,
             const CartesianGrid& grid, const cfd::GasOptions& gas_options,
             std::vector<cfd::BoundaryPatch> patches, const CouplingOptions& options,
             const CartesianGrid& transfer, int substeps_a_step)
      : engine(setup),
        gas(grid, gas_options, std::move(patches)),
        exchange(options, transfer, grid, {gas_options.density, gas_options.viscosity, gravity}),
        gas_step(setup.time_step * substeps_a_step),
        substeps(substeps_a_step) {
    engine.set_particles(seeds);
    exchange.initialise(engine.particles());
  }

  void start_gas(const Vec3& velocity) { gas.initialise(velocity, exchange.exchange().void_fraction); }

  void advance(int steps) {
    for (int step = 0; step < steps; ++step) {
      engine.prepare_outer_step();
      exchange.sample_gas(gas.state().velocity, gas.state().pressure_gradient);
      exchange.compute_coefficients(engine.particles());
      std::visit([&](const auto& force) { engine.advance(substeps, force, timers); },
                 exchange.fluid_force(engine.particles()));
      gas.update(gas_step, exchange.deposit(engine.particles(), gas_step));
      exchange.close_step(gas.state(), gas_step);
    }
  }

  Vec3 velocity_of_first() const {
    const auto motion =
        Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), engine.particles().velocity_spin);
    return motion(0).velocity();
  }
};

inline cfd::BoundaryPatch inlet(Real velocity) {
  return {"inlet", cfd::Side::z_min, std::nullopt, cfd::Inlet{velocity, std::nullopt}, ""};
}
inline cfd::BoundaryPatch outlet() { return {"outlet", cfd::Side::z_max, std::nullopt, cfd::Outlet{0}, ""}; }
/// Walls without shear on the four sides.
inline std::vector<cfd::BoundaryPatch> add_slip_sides(std::vector<cfd::BoundaryPatch> patches) {
  for (const cfd::Side side : {cfd::Side::x_min, cfd::Side::x_max, cfd::Side::y_min, cfd::Side::y_max}) {
    patches.push_back({"side", side, std::nullopt, cfd::Symmetry{}, ""});
  }
  return patches;
}

}  // namespace pellicle::coupling::testing
