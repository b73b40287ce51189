// The exchange of heat and vapour between the particles on the device and the gas on the host, once a gas step.
#pragma once

#include "cfd/gas_state.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"
#include "coupling/cell_sums.hpp"
#include "coupling/momentum_exchange.hpp"
#include "dem/particles.hpp"
#include "heat/heat_options.hpp"
#include "heat/surface_state.hpp"

namespace pellicle::core {
class CheckpointReader;
class CheckpointWriter;
}  // namespace pellicle::core

namespace pellicle::heat {

/// Gas of one cell, or as one particle sees it.
struct CellGas {
  Real warmth = 0;   ///< temperature over the reference [K]
  Real vapour = 0;   ///< mass fraction
  Real mass = 0;     ///< of the gas in the cell [kg]
  Real density = 0;  ///< [kg/m3]
  KOKKOS_INLINE_FUNCTION CellGas& operator+=(const CellGas& b) {
    warmth += b.warmth;
    vapour += b.vapour;
    mass += b.mass;
    density += b.density;
    return *this;
  }
  friend KOKKOS_INLINE_FUNCTION CellGas operator*(Real s, const CellGas& a) {
    return {s * a.warmth, s * a.vapour, s * a.mass, s * a.density};
  }
};

/// Gas of a cell at the end of the exchange, before it flows on.
struct CellEnd {
  Real warmth = 0;  ///< [K]
  Real vapour = 0;
};

/// What the gas of a cell gains a second.
struct CellGain {
  Real heat = 0;    ///< with the enthalpy c_p (T - T_ref) of vapour that comes [W]
  Real vapour = 0;  ///< [kg/s]
  Vec3 momentum;    ///< of that vapour [N]
};

/// Running totals since the start of the run.
struct HeatTotals {
  Real heat = 0;        ///< that the gas lost, less c_p (T - T_ref) of the vapour that came [J]
  Real evaporated = 0;  ///< less what has condensed [kg]
};

/// Heat and vapour between gas cells and the particles in them, both ways and implicitly in both: see docs/theory/heat.md.
/// A step is `update` after the particles' momentum was deposited, and the gas step with what `add_to` put in.
class HeatExchange {
 public:
  /// `open_volume`: of the gas grid's cells [m3].
  HeatExchange(const HeatOptions& options, const HostArray<Real>& open_volume);

  /// Advances temperature and film of all particles by `step` [s] in the gas at hand. `exchange`: after its deposit, with
  /// the particles in the same order; from it come footprints, slip and void fraction. Throws RunError if a particle's
  /// temperature is no longer finite.
  void update(const dem::Particles& particles, const coupling::MomentumExchange& exchange,
              const cfd::GasState& gas, const SurfaceState& surface, Real step);

  /// What the gas is to be given in the coming step. Arrays are shared, not copied.
  void add_to(cfd::ParticleExchange& exchange) const;

  const HeatTotals& totals() const { return totals_; }
  const HeatOptions& options() const { return options_; }
  /// Times that cells were solved in the last update: once, and again as long as particles fall dry or warm up by much.
  int rounds() const { return rounds_; }

  void save(core::CheckpointWriter& file) const;
  void load(const core::CheckpointReader& file);

 private:
  void copy_gas(const cfd::GasState& gas);
  coupling::CellRows find_rows(const coupling::MomentumExchange& exchange);
  void book(Real step);

  HeatOptions options_;
  Index cells_ = 0;

  // Device.
  coupling::CellSums sums_;  // in use if the transfer grid is not the gas grid
  DeviceArray<CellGas> gas_;
  DeviceArray<CellEnd> end_;
  DeviceArray<CellGain> gain_;

  // Host.
  HostArray<Real> volume_;
  HostArray<CellGas> gas_host_;
  HostArray<CellGain> gain_host_;
  HostArray<Real> heat_rate_, vapour_rate_, zero_;  // per volume
  HostArray<Vec3> momentum_rate_;
  HeatTotals totals_;
  int rounds_ = 0;
};

}  // namespace pellicle::heat
