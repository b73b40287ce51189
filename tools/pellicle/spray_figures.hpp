// What a spray has come to, as the summary and the ledger show it.
#pragma once

#include <vector>

#include "core/types.hpp"
#include "spray/droplet_gas.hpp"
#include "spray/spray.hpp"

namespace pellicle::tools {

/// Since the start; injected = captured + wall_loss + overspray + in_flight + evaporated, of each nozzle and of all.
struct SprayFigures {
  std::vector<spray::NozzleFigures> nozzles;
  spray::SprayHeat heat;
  bool two_way = false;  ///< droplets push the gas; only then there is what follows
  spray::ParcelMomentum momentum;
  spray::DropletImpulses impulses;

  /// Momentum of droplets that came in and did not go out again [kg m/s].
  Vec3 momentum_kept() const {
    return momentum.injected - momentum.captured - momentum.wall_loss - momentum.overspray;
  }

  /// Sum over the nozzles of one of their masses [kg].
  Real total(Real spray::NozzleFigures::*mass) const {
    Real sum = 0;
    for (const spray::NozzleFigures& n : nozzles) sum += n.*mass;
    return sum;
  }
  Real solids_injected() const {
    Real sum = 0;
    for (const spray::NozzleFigures& n : nozzles) sum += n.solids_fraction * n.injected;
    return sum;
  }
  Real liquid_injected() const { return total(&spray::NozzleFigures::injected) - solids_injected(); }
  Real liquid_in_flight() const {
    return total(&spray::NozzleFigures::in_flight) - total(&spray::NozzleFigures::in_flight_solids);
  }
  /// What came in and did not go out again, of solids or of liquid [kg].
  Real solids_kept() const {
    return solids_injected() - total(&spray::NozzleFigures::wall_solids) -
           total(&spray::NozzleFigures::overspray_solids);
  }
  Real liquid_kept() const {
    Real sum = liquid_injected();
    for (const spray::NozzleFigures& n : nozzles)
      sum -= (n.wall_loss - n.wall_solids) + (n.overspray - n.overspray_solids);
    return sum;
  }
  /// Heat that came with droplets and did not go out again with them [J]: with all of them if they have a temperature of
  /// their own, else with those that particles captured.
  Real enthalpy_kept(bool of_their_own) const {
    return of_their_own ? heat.injected - heat.wall_loss - heat.overspray : heat.enthalpy;
  }
};

}  // namespace pellicle::tools
