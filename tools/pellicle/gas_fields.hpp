// The gas as outputs see it: views of the solver's fields, and the numbers that can be shown of a cell.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "core/vector.hpp"
#include "core/views.hpp"

namespace pellicle::tools {

/// Fields at cell centres, index i + nx (j + ny k). A field that a run does not have stays empty: it cannot be shown,
/// except the void fraction, which is then 1.
struct GasFields {
  const CartesianGrid* grid = nullptr;
  HostArray<const Vec3> velocity;           ///< interstitial [m/s]
  HostArray<const Real> pressure;           ///< without the hydrostatic part [Pa]
  HostArray<const Real> void_fraction;      ///< [-]
  HostArray<const Vec3> pressure_gradient;  ///< [Pa/m]
  HostArray<const Real> density;            ///< [kg/m3]
  HostArray<const Real> temperature;        ///< [K]
  HostArray<const Real> vapour_mass_fraction;
  Real reference_pressure = 0;                       ///< absolute [Pa]
  HostArray<const Real> turbulent_kinetic_energy{};  ///< [m2/s2]
  HostArray<const Real> turbulent_dissipation{};     ///< [m2/s3]
  HostArray<const Real> eddy_viscosity{};            ///< [Pa s]
  // Of faces, numbered as cfd::FaceField.
  std::array<HostArray<const Real>, 3> volume_flux{};  ///< of gas along +axis [m3/s]
  std::array<HostArray<const Real>, 3> open_area{};    ///< [m2]

  Real void_fraction_of(Index cell) const { return void_fraction.extent(0) > 0 ? void_fraction(cell) : 1; }
};

/// A field of a gas snapshot as the solver holds it: the numbers of a cell one after the other, cell by cell.
struct GasFieldNumbers {
  const Real* numbers = nullptr;  ///< null: 1 everywhere
  bool complement = false;        ///< what is missing to 1 instead
  Real operator()(std::size_t n) const {
    const Real number = numbers != nullptr ? numbers[n] : 1;
    return complement ? 1 - number : number;
  }
};

/// The field of gas_snapshot_fields (output_fields.hpp) of this name; throws std::logic_error if there is none.
GasFieldNumbers gas_field(const GasFields& gas, std::string_view name);
/// Numbers a cell: 3 of a vector, else 1.
std::size_t gas_field_components(std::string_view name);
/// Shape of its array: nz, ny, nx and, of a vector, 3.
std::vector<std::size_t> gas_field_shape(const CartesianGrid& grid, std::string_view name);

/// Value of gas_quantities[quantity] (output_fields.hpp) in a cell.
Real gas_quantity(const GasFields& gas, int quantity, Index cell);

/// Mean pressure of the lowest minus that of the highest layer of cells [Pa], weighted by area.
Real pressure_drop(const GasFields& gas);

/// Sum of 1/2 rho eps |u|^2 V over the cells [J].
Real gas_kinetic_energy(const GasFields& gas);

}  // namespace pellicle::tools
