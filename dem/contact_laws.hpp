// The contact laws of a run: one of each family, chosen by name.
#pragma once

#include <optional>
#include <variant>

#include "dem/cohesion_laws.hpp"
#include "dem/friction_laws.hpp"
#include "dem/normal_laws.hpp"
#include "dem/rolling_laws.hpp"

namespace pellicle::dem {

using NormalLaw = std::variant<Hertz, Linear>;
using TangentialLaw = std::variant<ViscousCoulomb, Mindlin, MindlinDeresiewicz>;
using RollingLaw = std::variant<ConstantTorque, NoRolling, Epsd2>;
using CohesionLaw = std::variant<Willett>;

/// The contact models of a case, chosen by name.
struct ContactOptions {
  NormalLaw normal = Hertz{};
  TangentialLaw tangential = ViscousCoulomb{};
  RollingLaw rolling = ConstantTorque{};
  std::optional<Willett> cohesion;
  bool clip = true;  ///< no attraction at the end of a contact
  Real overlap_limit =
      0.5;  ///< largest overlap, as a fraction of the smaller radius; beyond it the run stops

  /// Springs that the laws keep for each contact.
  int springs() const {
    const auto count = [](const auto& law) { return law.has_spring ? 1 : 0; };
    return std::visit(count, tangential) + std::visit(count, rolling);
  }
};

}  // namespace pellicle::dem
