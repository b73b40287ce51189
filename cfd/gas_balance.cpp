#include "cfd/gas_balance.hpp"

#include <algorithm>
#include <cmath>

namespace pellicle::cfd {

Real GasBalance::mass_in() const {
  Real sum = 0;
  for (const PatchBalance& patch : patches) sum += patch.mass_in;
  return sum;
}

Real GasBalance::mass_out() const {
  Real sum = 0;
  for (const PatchBalance& patch : patches) sum += patch.mass_out;
  return sum;
}

Real GasBalance::mass_defect() const {
  const Real largest = std::max(mass_in() + mass_out() + std::abs(mass_given), mass_initial);
  return largest > 0 ? std::abs(mass - mass_initial - mass_in() + mass_out() - mass_given) / largest : 0;
}

Vec3 GasBalance::momentum_residual() const {
  return momentum - momentum_initial - convected - boundary_pressure - boundary_shear - body_force - drag -
         particle_pressure - vapour;
}

Real GasBalance::momentum_defect() const {
  const Vec3 residual = momentum_residual();
  const Real largest = std::max({gross.x, gross.y, gross.z, norm(momentum_initial)});
  const Real worst = std::max({std::abs(residual.x), std::abs(residual.y), std::abs(residual.z)});
  return largest > 0 ? worst / largest : 0;
}

}  // namespace pellicle::cfd
