#include "tools/pellicle/gas_fields.hpp"

#include <stdexcept>
#include <string>

#include "cfd/gas_property_laws.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

GasFieldNumbers gas_field(const GasFields& gas, std::string_view name) {
  if (name == "velocity") return {&gas.velocity.data()->x};
  if (name == "pressure_gradient") return {&gas.pressure_gradient.data()->x};
  if (name == "pressure") return {gas.pressure.data()};
  if (name == "void_fraction") return {gas.void_fraction.data()};
  if (name == "solids_fraction") return {gas.void_fraction.data(), true};
  if (name == "temperature") return {gas.temperature.data()};
  if (name == "vapour_mass_fraction") return {gas.vapour_mass_fraction.data()};
  if (name == "density") return {gas.density.data()};
  if (name == "turbulent_kinetic_energy") return {gas.turbulent_kinetic_energy.data()};
  if (name == "turbulent_dissipation") return {gas.turbulent_dissipation.data()};
  if (name == "eddy_viscosity") return {gas.eddy_viscosity.data()};
  throw std::logic_error("no gas field " + std::string(name));
}

std::size_t gas_field_components(std::string_view name) {
  return name == "velocity" || name == "pressure_gradient" ? 3 : 1;
}

std::vector<std::size_t> gas_field_shape(const CartesianGrid& grid, std::string_view name) {
  const Index3 n = grid.cells();
  std::vector<std::size_t> shape{static_cast<std::size_t>(n.z), static_cast<std::size_t>(n.y),
                                 static_cast<std::size_t>(n.x)};
  if (gas_field_components(name) == 3) shape.push_back(3);
  return shape;
}

Real gas_quantity(const GasFields& gas, int quantity, Index cell) {
  switch (quantity) {
    case 0:
    case 1:
    case 2:
      return gas.velocity(cell)[quantity];
    case 3:
      return norm(gas.velocity(cell));
    case 4:
    case 5:
    case 6:
      return gas.void_fraction_of(cell) * gas.velocity(cell)[quantity - 4];
    case 7:
      return gas.pressure(cell);
    case 8:
      return gas.void_fraction_of(cell);
    case 9:
      return 1 - gas.void_fraction_of(cell);
    case 10:
      return gas.temperature(cell);
    case 11:
      return gas.vapour_mass_fraction(cell);
    case 12:
      return cfd::relative_humidity_of(gas.vapour_mass_fraction(cell), gas.temperature(cell),
                                       gas.reference_pressure);
    case 13:
      return gas.density(cell);
    case 14:
      return gas.turbulent_kinetic_energy(cell);
    case 15:
      return gas.turbulent_dissipation(cell);
    case 16:
      return gas.eddy_viscosity(cell);
    default:
      break;
  }
  throw std::logic_error("a gas quantity without a value");
}
static_assert(gas_quantities.size() == 17 && gas_quantities[3].name == "gas_speed" &&
                  gas_quantities[4].name == "superficial_velocity_x" &&
                  gas_quantities[9].name == "solids_fraction" &&
                  gas_quantities[10].name == "gas_temperature" &&
                  gas_quantities[12].name == "relative_humidity" &&
                  gas_quantities[16].name == "eddy_viscosity",
              "the codes above are positions in gas_quantities");

Real pressure_drop(const GasFields& gas) {
  const CartesianGrid& grid = *gas.grid;
  const Index3 n = grid.cells();
  Real area = 0, bottom = 0, top = 0;
  for (Index j = 0; j < n.y; ++j) {
    for (Index i = 0; i < n.x; ++i) {
      const Real a = grid.width(0, i) * grid.width(1, j);
      area += a;
      bottom += a * gas.pressure(grid.index(i, j, 0));
      top += a * gas.pressure(grid.index(i, j, n.z - 1));
    }
  }
  return (bottom - top) / area;
}

Real gas_kinetic_energy(const GasFields& gas) {
  const CartesianGrid& grid = *gas.grid;
  const Index3 n = grid.cells();
  Real energy = 0;
  for (Index k = 0; k < n.z; ++k) {
    for (Index j = 0; j < n.y; ++j) {
      for (Index i = 0; i < n.x; ++i) {
        const Index cell = grid.index(i, j, k);
        energy += 0.5 * gas.density(cell) * gas.void_fraction_of(cell) * norm_squared(gas.velocity(cell)) *
                  grid.volume(i, j, k);
      }
    }
  }
  return energy;
}

}  // namespace pellicle::tools
