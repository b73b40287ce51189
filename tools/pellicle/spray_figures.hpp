// What a spray has come to, as the summary and the ledger show it.
#pragma once

#include <vector>

#include "core/types.hpp"
#include "spray/droplet_gas.hpp"
#include "spray/spray.hpp"

namespace pellicle::tools {

/// Since the start; injected = captured + wall_loss + overspray + in_flight, of each nozzle and of all.
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

  /// Sum over the nozzles of one of their masses [kg], of its liquid or of its solids.
  Real total(Real spray::NozzleFigures::*mass) const {
    Real sum = 0;
    for (const spray::NozzleFigures& n : nozzles) sum += n.*mass;
    return sum;
  }
  Real solids(Real spray::NozzleFigures::*mass) const {
    Real sum = 0;
    for (const spray::NozzleFigures& n : nozzles) sum += n.solids_fraction * (n.*mass);
    return sum;
  }
  Real liquid(Real spray::NozzleFigures::*mass) const {
    Real sum = 0;
    for (const spray::NozzleFigures& n : nozzles) sum += (1 - n.solids_fraction) * (n.*mass);
    return sum;
  }
  /// What came in and did not go out again, of solids or of liquid [kg].
  Real solids_kept() const {
    return solids(&spray::NozzleFigures::injected) - solids(&spray::NozzleFigures::wall_loss) -
           solids(&spray::NozzleFigures::overspray);
  }
  Real liquid_kept() const {
    return liquid(&spray::NozzleFigures::injected) - liquid(&spray::NozzleFigures::wall_loss) -
           liquid(&spray::NozzleFigures::overspray);
  }
};

}  // namespace pellicle::tools
