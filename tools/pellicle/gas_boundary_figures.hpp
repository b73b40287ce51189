// What went through the named boundaries of the gas, for the summary.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pellicle::cfd {
class GasSolver;
}  // namespace pellicle::cfd

namespace pellicle::tools {

/// Since t = 0.
struct GasBoundaryFigures {
  std::string name;
  double mass_in = 0, mass_out = 0;  ///< of gas [kg]
  std::optional<double>
      heat_in;  ///< net, counted from gas.heat.reference_temperature [J]; none without gas.heat
  std::optional<double> vapour_in;  ///< net [kg]; none without gas.moisture
};

/// Of every boundary, in the order of the case file.
std::vector<GasBoundaryFigures> collect_gas_boundaries(const cfd::GasSolver& gas);

}  // namespace pellicle::tools
