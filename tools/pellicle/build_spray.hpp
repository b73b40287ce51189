// The spray of a case: from keys to nozzles, and the gas that the parcels fly through.
#pragma once

#include "coupling/momentum_exchange.hpp"
#include "spray/spray.hpp"
#include "tools/pellicle/case_spec.hpp"

namespace pellicle::tools {

spray::SprayOptions make_spray_options(const CaseSpec& spec);

/// Arrays are those of `exchange`, so that parcels see what was sampled last; null without gas.
spray::ParcelGas make_parcel_gas(const CaseSpec& spec, const coupling::MomentumExchange* exchange);

}  // namespace pellicle::tools
