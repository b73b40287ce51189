// The gas as the droplets of an outer step see it, and what they give to it: the bridge between parcels on the device and
// the gas on the host.
#pragma once

#include <array>

#include "cfd/gas_state.hpp"
#include "core/checkpoint.hpp"
#include "core/ledger.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"
#include "spray/parcel_gas.hpp"

namespace pellicle::spray {

struct DropletGasOptions {
  bool two_way = false;            ///< droplets push the gas as it pushes them
  bool density_varies = false;     ///< the drag is that of the gas's density in the cell
  bool viscosity_follows = false;  ///< and of the viscosity of air at its temperature (Sutherland)
  DropletHeat heat{};              ///< whether droplets evaporate, and by what; needs the gas's moisture
};

/// Impulses since the start of the run [N s].
struct DropletImpulses {
  Vec3 on_gas;   ///< of droplets' drag
  Vec3 bounced;  ///< on droplets, of bouncing off particles
  Vec3 gravity;  ///< on droplets
  Vec3 vapour;   ///< that vapour took along from droplets to the gas
};

/// An outer step is sample, then the moves of the parcels with gas() (settle after each), close, and the gas step with what
/// add_to put in. Droplets are dragged by the gas's velocity at the beginning of the outer step as they themselves have
/// changed it since, cell by cell; so droplets that could stop many times their mass of gas do not overshoot its velocity. Likewise its temperature and
/// moisture, where they evaporate.
class DropletGas {
 public:
  /// `around` has grid, cut and drag, and is empty without gas; `open_volume` of its cells [m3]. `gravity` [m/s2].
  DropletGas(const DropletGasOptions& options, const ParcelGas& around, const HostArray<Real>& open_volume,
             const WholeUnits& units, const Vec3& gravity);

  /// Takes the gas as it is now.
  void sample(const cfd::GasState& gas);
  const ParcelGas& gas() const { return gas_; }
  /// After a move of the parcels: the gas that they see gets what they gave.
  void settle();
  /// After the last move of an outer step of `step` [s]: what droplets gave becomes a force on the gas.
  void close(Real step);
  /// Adds it to what the gas is told. The arrays of `exchange` are left as they are, others take their place.
  void add_to(cfd::ParticleExchange& exchange) const;

  const DropletGasOptions& options() const { return options_; }
  DropletImpulses impulses() const;
  void save(core::CheckpointWriter& file) const;
  void load(const core::CheckpointReader& file);

 private:
  DropletGasOptions options_;
  ParcelGas gas_;
  Vec3 gravity_;
  void add_vapour_to(cfd::ParticleExchange& exchange) const;
  void close_momentum(Real step);
  void close_vapour(Real step);

  WholeUnits units_;
  DeviceArray<CellGains> sum_;  // of the outer step
  DeviceArray<VapourGains> vapour_sum_;
  DeviceArray<Real> mass_;  // of the gas in a cell [kg]
  HostArray<CellGains> sum_host_;
  HostArray<VapourGains> vapour_sum_host_;
  HostArray<Real> volume_, mass_host_;
  HostArray<Vec3> force_, total_force_;                                         // per volume [N/m3]
  HostArray<Real> heat_rate_, vapour_rate_, total_heat_, total_vapour_, zero_;  // per volume
  HostArray<Vec3> vapour_momentum_, total_vapour_momentum_;
  std::array<core::ExactSum, 12> impulse_;  // on_gas, bounced, gravity, vapour
};

}  // namespace pellicle::spray
