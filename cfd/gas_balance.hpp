// Running totals of the gas's mass and momentum: what the ledger is made of.
#pragma once

#include <string>
#include <vector>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::cfd {

struct PatchBalance {
  std::string name;
  Real mass_in = 0;   ///< gas that came in through the patch so far [kg], >= 0
  Real mass_out = 0;  ///< gas that left through it so far [kg], >= 0
};

/// Totals since initialise, from the stored fields.
struct GasBalance {
  Real mass = 0;          ///< of the gas in the domain [kg]
  Real mass_initial = 0;  ///< [kg]
  Real mass_given = 0;    ///< by the source of mass: vapour from particles [kg]
  std::vector<PatchBalance> patches;

  Vec3 momentum;           ///< of the gas in the domain [kg m/s]
  Vec3 momentum_initial;   ///< [kg m/s]
  Vec3 convected;          ///< momentum carried in through boundaries, net [N s]
  Vec3 boundary_pressure;  ///< impulse of the pressure on the boundaries, onto the gas [N s]
  Vec3 boundary_shear;     ///< impulse of viscous stress at the boundaries, onto the gas [N s]
  Vec3 body_force;         ///< impulse of the body force and of buoyancy [N s]
  Vec3 drag;               ///< impulse that the exchange term gave to the gas [N s]
  Vec3
      particle_pressure;  ///< impulse of (1 - void fraction) grad p onto the gas: what -V grad p took from particles
  Vec3 vapour;            ///< momentum that the source of mass brought along [N s]
  Vec3 gross;  ///< sum of the magnitudes of the above, per axis and step, of buoyancy also per cell [N s]

  Real mass_in() const;
  Real mass_out() const;
  /// |stock - initial - in + out - given| / max(in + out + |given|, initial).
  Real mass_defect() const;
  /// Stock less initial less all impulses, per axis [N s].
  Vec3 momentum_residual() const;
  /// Largest |residual| of an axis over the largest gross amount exchanged; 0 if nothing moved.
  Real momentum_defect() const;
};

}  // namespace pellicle::cfd
