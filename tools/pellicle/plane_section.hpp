// A part of a plane across an axis: what flows through it, and means over it.
#pragma once

#include <array>
#include <vector>

#include "core/cartesian_grid.hpp"
#include "core/types.hpp"
#include "tools/pellicle/case_spec.hpp"
#include "tools/pellicle/gas_fields.hpp"

namespace pellicle::tools {

/// The plane cuts one layer of cells. The flow through it is linear between those through the layer's two faces, which
/// satisfy continuity; a quantity is linear between cell centres. Cells cut by the edge of a box or disc count by their
/// share. Areas are those that walls within the gas leave open.
class PlaneSection {
 public:
  PlaneSection(const PlaneProbeSpec& spec, const CartesianGrid& grid);

  /// Value of plane_probe_quantities[quantity]; nan for a mean over nothing.
  Real quantity(const GasFields& gas, int quantity) const;

  Real volume_flow(const GasFields& gas) const;  ///< along +axis [m3/s]
  /// The same times the density, linear between cell centres [kg/s].
  Real mass_flow(const GasFields& gas) const;
  Real open_area(const GasFields& gas) const;  ///< [m2]
  /// Mean of gas_quantities[quantity] by area or by flow.
  Real mean(const GasFields& gas, int quantity) const;

 private:
  /// A column of cells that the plane goes through.
  struct Part {
    Real share = 0;             ///< of the column's cross-section that is in the part
    Index minus = 0, plus = 0;  ///< faces of the cell that the plane is in
    Index cell = 0,
          partner = 0;  ///< that cell, and the one beyond the nearer of these faces; itself at a side
    Index between = 0;  ///< the face between them
  };
  Real at_plane(const std::array<HostArray<const Real>, 3>& faces, const Part& part) const;
  /// value(cell) of the part, linear between cells.
  template <class Value>
  Real between_cells(const GasFields& gas, const Part& part, Value&& value) const;

  int axis_ = 2;
  bool by_flow_ = false;
  Real plus_weight_ = 0;     ///< of the layer's face on the plus side
  Real partner_weight_ = 0;  ///< of the partner's value
  std::vector<Part> parts_;
};

}  // namespace pellicle::tools
