#include "tools/pellicle/gas_boundary_figures.hpp"

#include "cfd/gas_solver.hpp"

namespace pellicle::tools {

std::vector<GasBoundaryFigures> collect_gas_boundaries(const cfd::GasSolver& gas) {
  std::vector<GasBoundaryFigures> all;
  const cfd::ScalarBalance* heat = gas.balance(cfd::Scalar::temperature);
  const cfd::ScalarBalance* vapour = gas.balance(cfd::Scalar::moisture);
  const auto& patches = gas.balance().patches;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    GasBoundaryFigures& figures = all.emplace_back();
    figures = {patches[p].name, patches[p].mass_in, patches[p].mass_out, {}, {}};
    if (heat) figures.heat_in = heat->into[p];
    if (vapour) figures.vapour_in = vapour->into[p];
  }
  return all;
}

}  // namespace pellicle::tools
