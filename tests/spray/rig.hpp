// What the tests of the spray share: an engine, what its particles carry, a spray and the gas around it.
#pragma once

#include <vector>

#include "spray/droplet_gas.hpp"
#include "spray/spray.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::tests {

/// A nozzle that shoots straight, one droplet a parcel; 0.1 parcel a microsecond.
inline spray::Nozzle needle(const Vec3& position, const Vec3& axis, Real speed, Real diameter = 30e-6) {
  spray::Nozzle nozzle;
  nozzle.name = "needle";
  nozzle.position = position;
  nozzle.axis = axis;
  nozzle.speed = speed;
  nozzle.diameter = diameter;
  nozzle.mass_rate = 1e5 * 1000 * M_PI / 6 * diameter * diameter * diameter;
  nozzle.solids_fraction = 0.2;
  return nozzle;
}

struct Rig {
  dem::Engine engine;
  heat::SurfaceState surface;
  spray::Spray spray;
  spray::ParcelGas gas;
  spray::DropletGas* droplets = nullptr;  // in the place of gas, if set
  DeviceArray<Real> gas_temperature;
  int substeps;
  std::int64_t steps = 0;

  Rig(const dem::EngineSetup& setup, const std::vector<dem::ParticleSeed>& seeds,
      const spray::SprayOptions& options, int substeps_in = 10,
      heat::FilmGrowth growth = heat::FilmGrowth::none)
      : engine(setup),
        surface(engine.particles(), std::vector<Real>(setup.materials.size(), 840), {}, 300, growth, 1250),
        spray(options, setup.walls),
        substeps(substeps_in) {
    engine.attach(surface);
    engine.attach(spray.hit_records());
    engine.set_particles(seeds);
    surface.note_bare_particles();
  }

  Real time() const { return static_cast<Real>(steps) * substeps * engine.setup().time_step; }

  void outer_step() {
    core::Timers timers;
    engine.prepare_outer_step();
    spray.inject(time(), substeps, engine);
    engine.advance(substeps, timers, [this](int k) {
      if (spray.move(k, engine, droplets != nullptr ? droplets->gas() : gas) && droplets != nullptr)
        droplets->settle();
    });
    spray.collect(engine.particles(), surface, droplets != nullptr ? droplets->gas() : gas, gas_temperature);
    surface.grow(engine);
    if (droplets != nullptr) droplets->close(substeps * engine.setup().time_step);
    ++steps;
  }

  /// The hits of every particle, by id.
  std::vector<spray::HitRecord> records() const {
    std::vector<spray::HitRecord> all(static_cast<std::size_t>(engine.particles().count));
    for (Index p = 0; p < engine.particles().count; ++p) {
      all[static_cast<std::size_t>(engine.particles().velocity_spin(p).id)] = spray.hit_record()(p);
    }
    return all;
  }

  /// Gas of one velocity [m/s] everywhere.
  void blow(const Vec3& velocity) {
    gas.drag = {1.2, 1.8e-5};
    gas.grid = coupling::GridLocator(CartesianGrid(engine.setup().domain.box, {2, 2, 2}));
    gas.velocity = DeviceArray<Vec3>("tests::spray::gas_velocity", 8);
    Kokkos::deep_copy(gas.velocity, velocity);
  }
};

inline dem::ParticleSeed fixed_bead(const Vec3& position, Real radius) {
  dem::ParticleSeed seed;
  seed.position = position;
  seed.radius = radius;
  seed.fixed = true;
  return seed;
}

}  // namespace pellicle::tests
