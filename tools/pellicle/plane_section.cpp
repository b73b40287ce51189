#include "tools/pellicle/plane_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cfd/plane_region.hpp"
#include "tools/pellicle/output_fields.hpp"

namespace pellicle::tools {

namespace {

/// The part of the plane that counts, in the coordinates across its axis.
cfd::PlaneRegion make_region(const PlaneProbeSpec& spec, const Box& domain,
                             const std::array<int, 2>& across) {
  if (spec.disc) {
    return {{spec.disc->centre[across[0]], spec.disc->centre[across[1]]}, spec.disc->radius, 0};
  }
  const Box& box = spec.box ? *spec.box : domain;
  return cfd::PlaneRegion(
      {{box.min[across[0]], box.min[across[1]]}, {box.max[across[0]], box.max[across[1]]}});
}

cfd::Rectangle cell_section(const CartesianGrid& grid, const std::array<int, 2>& across,
                            const std::array<Index, 2>& place) {
  cfd::Rectangle cell;
  for (std::size_t d = 0; d < 2; ++d) {
    const auto& faces = grid.faces(across[d]);
    cell.min[d] = faces[static_cast<std::size_t>(place[d])];
    cell.max[d] = faces[static_cast<std::size_t>(place[d]) + 1];
  }
  return cell;
}

}  // namespace

PlaneSection::PlaneSection(const PlaneProbeSpec& spec, const CartesianGrid& grid)
    : axis_(spec.axis), by_flow_(spec.by_flow) {
  const std::array<int, 2> across{(axis_ + 1) % 3, (axis_ + 2) % 3};
  const Index n = grid.cells()[axis_];
  const auto& faces = grid.faces(axis_);
  // Not CartesianGrid::locate: the upper side of a periodic domain is a plane of its last cells.
  const auto next = std::upper_bound(faces.begin(), faces.end(), spec.at);
  const Index layer = std::clamp(static_cast<Index>(next - faces.begin()) - 1, Index{0}, n - 1);
  plus_weight_ = std::clamp((spec.at - faces[static_cast<std::size_t>(layer)]) / grid.width(axis_, layer),
                            Real{0}, Real{1});
  const bool upwards = plus_weight_ > 0.5;
  Index other = layer + (upwards ? 1 : -1);
  if (grid.periodic(axis_)) other = (other + n) % n;
  const bool at_side = other < 0 || other >= n || other == layer;
  if (!at_side) {
    const Real distance = 0.5 * (grid.width(axis_, layer) + grid.width(axis_, other));
    partner_weight_ = std::abs(plus_weight_ - 0.5) * grid.width(axis_, layer) / distance;
  }

  const cfd::PlaneRegion region = make_region(spec, grid.box(), across);
  const Index3 cells = grid.cells();
  const auto face = [&](const Index3& at, Index position) {
    Index3 size = cells;
    ++size[axis_];
    Index3 place = at;
    place[axis_] = position;
    return place.x + size.x * (place.y + size.y * place.z);
  };
  for (Index q = 0; q < cells[across[1]]; ++q) {
    for (Index p = 0; p < cells[across[0]]; ++p) {
      Part part;
      const cfd::Rectangle cell = cell_section(grid, across, {p, q});
      part.share = region.area_within(cell) / cell.area();
      if (!(part.share > 0)) continue;
      Index3 at;
      at[axis_] = layer;
      at[across[0]] = p;
      at[across[1]] = q;
      part.minus = face(at, layer);
      part.plus = face(at, layer + 1);
      part.between = upwards ? part.plus : part.minus;
      part.cell = part.partner = grid.index(at.x, at.y, at.z);
      if (!at_side) {
        at[axis_] = other;
        part.partner = grid.index(at.x, at.y, at.z);
      }
      parts_.push_back(part);
    }
  }
}

Real PlaneSection::at_plane(const std::array<HostArray<const Real>, 3>& faces, const Part& part) const {
  const auto& values = faces[static_cast<std::size_t>(axis_)];
  return part.share * ((1 - plus_weight_) * values(part.minus) + plus_weight_ * values(part.plus));
}

template <class Value>
Real PlaneSection::between_cells(const GasFields& gas, const Part& part, Value&& value) const {
  const Real own = value(part.cell);
  // Beyond a face that nothing passes the gas is another one.
  const bool alone =
      partner_weight_ == 0 || !(gas.open_area[static_cast<std::size_t>(axis_)](part.between) > 0);
  return alone ? own : own + partner_weight_ * (value(part.partner) - own);
}

Real PlaneSection::volume_flow(const GasFields& gas) const {
  Real sum = 0;
  for (const Part& part : parts_) sum += at_plane(gas.volume_flux, part);
  return sum;
}

Real PlaneSection::mass_flow(const GasFields& gas) const {
  Real sum = 0;
  for (const Part& part : parts_) {
    const Real flow = at_plane(gas.volume_flux, part);
    if (flow != 0) sum += flow * between_cells(gas, part, [&](Index cell) { return gas.density(cell); });
  }
  return sum;
}

Real PlaneSection::open_area(const GasFields& gas) const {
  Real sum = 0;
  for (const Part& part : parts_) sum += at_plane(gas.open_area, part);
  return sum;
}

Real PlaneSection::mean(const GasFields& gas, int quantity) const {
  Real sum = 0;
  Real total = 0;
  for (const Part& part : parts_) {
    const Real weight = at_plane(by_flow_ ? gas.volume_flux : gas.open_area, part);
    if (weight == 0) continue;
    sum += weight * between_cells(gas, part, [&](Index cell) { return gas_quantity(gas, quantity, cell); });
    total += weight;
  }
  return total != 0 ? sum / total : std::numeric_limits<Real>::quiet_NaN();
}

Real PlaneSection::quantity(const GasFields& gas, int quantity) const {
  switch (quantity) {
    case 0:
      return volume_flow(gas);
    case 1:
      return mass_flow(gas);
    case 2:
      return open_area(gas);
    default:
      return mean(gas, quantity - static_cast<int>(plane_quantities.size()));
  }
}
static_assert(plane_quantities.size() == 3 && plane_quantities[0].name == "volume_flow" &&
                  plane_quantities[1].name == "mass_flow" && plane_quantities[2].name == "open_area",
              "the codes above are positions in plane_quantities");

}  // namespace pellicle::tools
