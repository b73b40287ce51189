// The spray's part of an outer step, and of the ledger.
#include "tools/pellicle/build_spray.hpp"
#include "tools/pellicle/simulation.hpp"

namespace pellicle::tools {

using core::Conserved;
using core::Part;

/// Of one part of an outer step: adds the parcels that leave the nozzles in it.
void Simulation::inject_spray(int part, int parts) {
  if (!spray_ || time_.settling()) return;
  const core::Timers::Scope scope(timers_, Part::spray);
  if (droplet_gas_) droplet_gas_->sample(gas_->state());
  spray_->inject(time_.time() + part * (time_.gas_step() / parts), time_.substeps() / parts, *particles_);
  Kokkos::fence("tools::simulation_spray::injected");
}

/// What the engine calls in each of `substeps` before the particles move: parcels go, contacts are counted. Empty if there
/// is neither.
dem::SubstepHook Simulation::substep_hook(int substeps) {
  if ((!spray_ && wetness_.empty()) || time_.settling()) return {};
  return [this, substeps](int substep) {
    if (!wetness_.empty()) {
      const core::Timers::Scope scope(timers_, Part::output);
      for (spray::ContactWetness& region : wetness_)
        region.count(substep, substeps, *particles_, surface_->film());
      Kokkos::fence("tools::simulation_spray::counted");
    }
    if (!spray_) return;
    const core::Timers::Scope scope(timers_, Part::spray);
    if (spray_->move(substep, *particles_, parcel_gas()) && droplet_gas_) droplet_gas_->settle();
    Kokkos::fence("tools::simulation_spray::moved");
  };
}

/// Hands what was captured to the films.
void Simulation::collect_spray(int parts) {
  if (!spray_ || time_.settling()) return;
  const core::Timers::Scope scope(timers_, Part::spray);
  if (heat_) {
    const HostArray<Real>& temperature = gas_->state().scalars[index_of(cfd::Scalar::temperature)];
    if (parcel_gas_temperature_.extent(0) == 0) {
      parcel_gas_temperature_ = DeviceArray<Real>(
          Kokkos::view_alloc(Kokkos::WithoutInitializing, "tools::simulation_spray::gas_temperature"),
          temperature.extent(0));
    }
    Kokkos::deep_copy(parcel_gas_temperature_, temperature);
  }
  spray_->collect(particles_->particles(), *surface_, parcel_gas(), parcel_gas_temperature_);
  if (droplet_gas_) droplet_gas_->close(time_.gas_step() / parts);
  Kokkos::fence("tools::simulation_spray::collected");
}

SprayFigures Simulation::spray_figures() const {
  SprayFigures figures;
  figures.nozzles = spray_->figures();
  figures.heat = spray_->heat();
  figures.two_way = spec_.droplets.two_way;
  figures.momentum = spray_->momentum();
  if (droplet_gas_) figures.impulses = droplet_gas_->impulses();
  return figures;
}

void Simulation::open_spray_ledger() {
  if (!spray_) return;
  summary_.spray = spray_figures();
  ledger_.open(Conserved::solids, surface_->compute_totals().film.solids);
  if (!has_vapour()) ledger_.open(Conserved::water, water_stock());
}

/// Liquid and solids of films and of parcels in flight, against what the nozzles gave less what walls and open sides took.
/// Water is that of the gas too where it carries any: see update_heat_ledger.
void Simulation::update_spray_ledger() {
  if (!spray_) return;
  summary_.spray = spray_figures();
  const SprayFigures& spray = summary_.spray;
  const heat::Film came = films_that_came();
  const heat::Film film = surface_->compute_totals().film;
  ledger_.set_stock(Conserved::solids, film.solids + spray.total(&spray::NozzleFigures::in_flight_solids));
  ledger_.set_totals(Conserved::solids, Vec3{came.solids + spray.solids_kept(), 0, 0}, Vec3{},
                     spray.solids_injected());
  if (has_vapour()) return;
  ledger_.set_stock(Conserved::water, water_stock());
  ledger_.set_totals(Conserved::water, Vec3{came.liquid + spray.liquid_kept(), 0, 0}, Vec3{},
                     spray.liquid_injected());
}

/// Films that fed particles brought, less those that left with particles, since t = 0 [kg].
heat::Film Simulation::films_that_came() const {
  if (!surface_) return {};
  const heat::Film left = surface_->left().film - settled_left_surface_.film;
  return surface_->entered().film - left;
}

}  // namespace pellicle::tools
