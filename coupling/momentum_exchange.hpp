// The exchange of momentum between the particles on the device and the gas on the host, one outer step at a time.
#pragma once

#include "cfd/gas_state.hpp"
#include "core/cartesian_grid.hpp"
#include "core/scratch_memory.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"
#include "coupling/cell_sums.hpp"
#include "coupling/coupling_options.hpp"
#include "coupling/cut_grid.hpp"
#include "coupling/fluid_force.hpp"
#include "coupling/footprint.hpp"
#include "coupling/grid_mapping.hpp"
#include "coupling/smoothing.hpp"
#include "coupling/void_fraction_bound.hpp"
#include "dem/particles.hpp"

namespace pellicle::core {
class CheckpointReader;
class CheckpointWriter;
}  // namespace pellicle::core

namespace pellicle::coupling {

/// Running totals of the exchange since the start of the run, without buoyancy (which no gas cell gave).
struct ExchangeTotals {
  Vec3 particles_received;  ///< impulse of drag and pressure gradient on the particles [N s]
  Vec3 fixed_received;      ///< of this, on fixed particles, which pass it on to what holds them [N s]
  Vec3 gas_received;  ///< impulse that the exchange gave to the gas: drag, release and (1 - eps) grad p [N s]
  Vec3 pending;       ///< what the gas is still to be given: particles_received + gas_received + pending = 0
  Real gross = 0;     ///< sum over steps and transfer cells of |impulse on the particles in the cell| [N s]
};

/// Samples the gas for the particles, gives them their fluid force, and deposits what they did onto the gas grid.
///
/// An outer step is sample_gas, compute_coefficients, substeps with fluid_force, deposit, gas step, close_step.
/// Momentum: the gas is given -beta u + explicit_force at its new velocity u, and (1 - eps) grad p by the pressure term
/// of model A. What that differs from the opposite of the particles' impulse is kept per transfer cell as pending
/// momentum, and a share of it, `pending_release`, goes into the explicit force of each later step.
/// docs/theory/coupling.md has the equations and how large the share may be.
class MomentumExchange {
 public:
  /// Both grids cover the same box. `walls`, if any, is the geometry of the gas; where it is cut, the two grids must be
  /// one, and the void fraction is that of the open volume of cells. Throws InputError for options out of range or
  /// grids that do not fit.
  MomentumExchange(const CouplingOptions& options, const CartesianGrid& transfer, const CartesianGrid& gas,
                   const GasProperties& properties, const cfd::FlowGeometry* walls = nullptr);

  /// Void fraction of the particles where they are now, on both grids; totals and pending momentum begin at zero.
  /// Throws RunError if the particles do not fit under the bound of the void fraction.
  void initialise(const dem::Particles& particles);

  /// Copies gas velocity [m/s] and pressure gradient [Pa/m] of the gas grid's cells to the device; density [kg/m3] and
  /// temperature [K] too, where the gas's properties vary with them.
  void sample_gas(const HostArray<Vec3>& velocity, const HostArray<Vec3>& pressure_gradient,
                  const HostArray<Real>& density = {}, const HostArray<Real>& temperature = {});

  /// Per particle: gas velocity, pressure gradient and void fraction where it is, and its drag coefficient; sets what
  /// it has received to zero. The order of particles must not change from here to deposit.
  void compute_coefficients(const dem::Particles& particles);

  /// The force on the particles during the substeps.
  FluidForce fluid_force(const dem::Particles& particles) const;

  /// Void fraction and exchange on the gas grid from the particles' new positions and what they have received;
  /// gas_step is the time they received it in [s].
  const cfd::ParticleExchange& deposit(const dem::Particles& particles, Real gas_step);

  /// After the gas step: books what the gas was given, and what is pending.
  void close_step(const cfd::GasState& gas, Real gas_step);

  /// What the gas was last told.
  const cfd::ParticleExchange& exchange() const { return exchange_; }
  const ExchangeTotals& totals() const { return totals_; }
  /// Of the last deposit: cells over the bound, sweeps it took.
  const BoundReport& bound_report() const { return bound_report_; }
  /// Per particle, in the particles' present order: the gas sampled at the last compute_coefficients.
  const DeviceArray<SampledGas>& sampled_gas() const { return sampled_; }
  /// Which particles lie in each transfer cell, as of the last deposit.
  const CellSums& cell_sums() const { return sums_; }
  /// Which gas cells each particle covers, as of the last deposit; one with the transfer footprint if both grids have
  /// the same cells.
  const Footprint& gas_footprint() const { return one_grid_ ? transfer_footprint_ : gas_footprint_; }
  bool has_one_grid() const { return one_grid_; }
  /// Gas velocity of the gas grid's cells as sampled last [m/s].
  const DeviceArray<Vec3>& gas_velocity() const { return gas_velocity_; }
  /// The gas grid on the device.
  const GridLocator& gas_locator() const {
    return one_grid_ ? transfer_footprint_.grid() : gas_footprint_.grid();
  }
  /// What walls leave of the gas grid's cells; empty if they do not cut it.
  const CutGrid& cut_grid() const { return cut_; }
  /// Memory for a number or a few of each particle, free between deposit and the next one.
  const core::ScratchMemory& scratch() const { return scratch_; }
  const CartesianGrid& transfer_grid() const { return transfer_; }
  /// Void fraction of the transfer grid's cells.
  const HostArray<Real>& transfer_void_fraction() const { return void_fraction_host_; }
  const CouplingOptions& options() const { return options_; }

  void save(core::CheckpointWriter& file) const;
  /// Continues bit for bit as the run that saved. Throws RunError if the checkpoint is of another transfer grid.
  void load(core::CheckpointReader& file);

 private:
  void allocate_particles(Index count);
  void update_footprints(const dem::Particles& particles);
  void deposit_loads(const dem::Particles& particles, Real gas_step);
  void add_fixed_impulse(const dem::Particles& particles);
  void map_to_gas();

  CouplingOptions options_;
  GasProperties properties_;
  CartesianGrid transfer_, gas_;
  bool one_grid_ = true;  // transfer and gas grid have the same cells

  // Device.
  CutGrid cut_;  // empty if walls do not cut the gas grid
  Footprint transfer_footprint_;
  Footprint gas_footprint_;  // in use if not one_grid_
  CellSums sums_;
  VoidFractionBound bound_;
  Smoothing smoothing_;
  DeviceArray<Vec3> gas_velocity_, gas_pressure_gradient_;
  DeviceArray<LocalGas> local_gas_,
      sampled_local_;  // of cells, of particles; empty where they are not needed
  DeviceArray<Real> void_fraction_;
  DeviceArray<SampledGas> sampled_;
  DeviceArray<Received> received_;
  core::ScratchMemory scratch_{"coupling::momentum_exchange::scratch"};  // loads of particles, in deposit
  DeviceArray<CellLoad> cell_load_;
  DeviceArray<Vec3> fixed_impulse_;  // of blocks of particles [N s]

  // Host.
  GridMapping to_gas_, to_transfer_;
  HostArray<CellLoad> cell_load_host_;
  HostArray<Vec3> fixed_impulse_host_;
  HostArray<LocalGas> local_gas_host_;
  HostArray<Real> void_fraction_host_;    // transfer grid
  HostArray<Real> solids_, coefficient_;  // transfer grid, per volume
  HostArray<Vec3> force_;                 // transfer grid, explicit force with release [N/m3]
  HostArray<Vec3> target_;                // transfer grid, what the gas ought to be given [N/m3]
  HostArray<Vec3> pending_;               // transfer grid, momentum per volume [N s/m3]
  HostArray<Real> gas_solids_;            // gas grid
  HostArray<Vec3> given_, given_transfer_;
  HostArray<Real> volume_;  // of transfer cells, open to the gas [m3]
  cfd::ParticleExchange exchange_;
  ExchangeTotals totals_;
  BoundReport bound_report_;
};

}  // namespace pellicle::coupling
