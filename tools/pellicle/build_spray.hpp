// The spray of a case: from keys to nozzles, and the gas that the parcels fly through.
#pragma once

#include "coupling/momentum_exchange.hpp"
#include "spray/droplet_gas.hpp"
#include "spray/spray.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

spray::SprayOptions make_spray_options(const CaseSpec& spec);

/// The gas that parcels fly through; `open_volume` of its cells [m3].
spray::DropletGas make_droplet_gas(const CaseSpec& spec, const coupling::MomentumExchange& exchange,
                                   const HostArray<Real>& open_volume, const spray::WholeUnits& units);

}  // namespace pellicle::tools
