#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

std::string line_quantity_names() {
  std::string names;
  for (const core::ModelList list : {core::ModelList(particle_quantities), core::ModelList(gas_quantities)}) {
    for (const auto& info : list) {
      if (!names.empty()) names += ", ";
      names += info.name;
    }
  }
  return names;
}

bool is_turbulent_quantity(std::string_view name) {
  return name == "turbulent_kinetic_energy" || name == "turbulent_dissipation" || name == "eddy_viscosity";
}

std::string_view unit_of(const core::ModelInfo& info) {
  const auto begin = info.description.rfind('[');
  if (begin == std::string_view::npos) return "-";
  return info.description.substr(begin + 1, info.description.size() - begin - 2);
}

std::string column_header(std::string_view quantity) {
  for (const core::ModelList list : {core::ModelList(particle_quantities), core::ModelList(gas_quantities),
                                     core::ModelList(bed_quantities), core::ModelList(coating_quantities),
                                     core::ModelList(wall_quantities), core::ModelList(side_quantities),
                                     core::ModelList(plane_quantities)}) {
    const int found = core::find_model(list, quantity);
    if (found >= 0) {
      const auto& info = list[static_cast<std::size_t>(found)];
      return std::string(info.name) + " [" + std::string(unit_of(info)) + "]";
    }
  }
  return std::string(quantity);
}

}  // namespace pellicle::tools
