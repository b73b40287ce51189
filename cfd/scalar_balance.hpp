// Running totals of a scalar: what its entry in the ledger is made of.
#pragma once

#include <vector>

#include "core/types.hpp"

namespace pellicle::cfd {

/// Amounts since initialise, counted from the reference: heat [J], vapour [kg].
struct ScalarBalance {
  Real stock = 0;          ///< in the gas of the domain, from the stored fields
  Real initial = 0;        ///< the same at the beginning
  std::vector<Real> into;  ///< what came in through each patch, net
  Real sources = 0;        ///< from the particles
  Real leftover =
      0;           ///< what the gas flow's own residue of continuity made, with the value where it was made
  Real gross = 0;  ///< sum of the sizes of all that was exchanged, per step and boundary face

  Real through_boundaries() const;
  /// |stock - initial - through boundaries - sources| / max(gross, |initial|); the leftover is part of it.
  Real defect() const;
};

}  // namespace pellicle::cfd
