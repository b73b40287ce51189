// Keys of the grids.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

using core::Keys;
using core::Need;
using core::Size;
namespace dimension = core::dimension;
namespace range = core::range;

constexpr core::WholeRule cells_rule{1, 100'000};

void describe_faces(Keys& keys, std::array<std::vector<Real>, 3>& faces, const DomainSpec& domain) {
  static constexpr std::string_view names[] = {"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) {
    keys.reals(
        {names[a], "coordinates of the cell faces, from one side of the domain to the other", Need::required},
        {dimension::length}, Size{2}, faces[a]);
    const auto& f = faces[a];
    if (!keys.reading() || f.size() < 2) continue;
    const int axis = static_cast<int>(a);
    if (std::adjacent_find(f.begin(), f.end(), [](Real p, Real q) { return !(p < q); }) != f.end()) {
      keys.problem(names[a], "the coordinates do not increase; each larger than the one before");
    }
    const Real tolerance = 1e-9 * (domain.box.max[axis] - domain.box.min[axis]);
    if (std::abs(f.front() - domain.box.min[axis]) > tolerance ||
        std::abs(f.back() - domain.box.max[axis]) > tolerance) {
      keys.problem(names[a], fmt::format("from {} to {} m it is not the domain; from {} to {} m", f.front(),
                                         f.back(), domain.box.min[axis], domain.box.max[axis]));
    }
  }
}

/// `cells` or `faces`, with `growth` for stretched cells.
void describe_grid(Keys& keys, GridSpec& grid, const DomainSpec& domain) {
  const bool by_faces = !grid.faces[0].empty() || grid.refinement;
  std::optional<std::vector<std::int64_t>> cells;
  if (grid.cells.x > 0 && !by_faces)
    cells = std::vector<std::int64_t>{grid.cells.x, grid.cells.y, grid.cells.z};
  keys.wholes({"cells", "number of cells along x, y, z"}, cells_rule, Size::exactly(3), cells);
  std::optional<std::vector<Real>> growth;
  if (!by_faces) growth = std::vector<Real>{grid.growth.x, grid.growth.y, grid.growth.z};
  keys.reals({"growth", "size of a cell over that of the one before it, along x, y, z; 1 is uniform"},
             {dimension::pure_number, {.min = 0.5, .max = 2}}, Size::exactly(3), growth);
  std::optional<std::array<std::vector<Real>, 3>> faces;
  if (by_faces && !grid.refinement) faces = grid.faces;
  keys.section<std::array<std::vector<Real>, 3>>(
      {"faces", "coordinates of all cell faces, in place of cells"}, faces,
      [&](Keys& inner, std::array<std::vector<Real>, 3>& f) { describe_faces(inner, f, domain); });
  if (!keys.reading()) return;
  if (cells) {
    grid.cells = {static_cast<Index>((*cells)[0]), static_cast<Index>((*cells)[1]),
                  static_cast<Index>((*cells)[2])};
  }
  if (growth) grid.growth = {(*growth)[0], (*growth)[1], (*growth)[2]};
  if (faces) {
    if (keys.given("growth")) keys.problem("growth", "faces say all about the cells; only with cells");
    grid.faces = *faces;
    for (int axis = 0; axis < 3; ++axis) {
      grid.cells[axis] = static_cast<Index>((*faces)[static_cast<std::size_t>(axis)].size()) - 1;
    }
  }
}

void describe_zone(Keys& keys, GridZoneSpec& zone, const DomainSpec& domain) {
  keys.section<Box>({"box", "where the zone is; its sides become faces of cells", Need::required}, zone.box,
                    describe_box);
  keys.real({"cell_size", "largest size of the cells in it", Need::required},
            {dimension::length, range::positive}, zone.cell_size);
  if (!keys.reading() || !keys.given("box")) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (zone.box.max[axis] > domain.box.min[axis] && zone.box.min[axis] < domain.box.max[axis]) continue;
    keys.problem("box", fmt::format("it lies outside the domain along {}; within {} to {} m", "xyz"[axis],
                                    domain.box.min[axis], domain.box.max[axis]));
  }
}

/// `cell_size` with `zones` of smaller cells, in place of `cells`. The cells are made when all has been read.
void describe_refinement(Keys& keys, GridSpec& grid, const DomainSpec& domain) {
  RefinementSpec held = grid.refinement.value_or(RefinementSpec{});
  std::optional<Real> cell_size, max_growth;
  std::optional<std::vector<int>> single;
  if (grid.refinement) {
    cell_size = held.cell_size;
    max_growth = held.max_growth;
    single = std::vector<int>{};
    for (int axis = 0; axis < 3; ++axis) {
      if (held.single_cell[static_cast<std::size_t>(axis)]) single->push_back(axis);
    }
  }
  keys.real({"cell_size", "largest size of cells, in place of cells"}, {dimension::length, range::positive},
            cell_size);
  keys.real({"max_growth", "with cell_size: largest ratio of the sizes of neighbouring cells",
             Need::has_default, fmt::format("{}", RefinementSpec{}.max_growth)},
            {dimension::pure_number, {.min = 1.01, .max = 2}}, max_growth);
  keys.list<GridZoneSpec>({"zones", "with cell_size: boxes in which cells are smaller"}, Size{1}, held.zones,
                          [&](Keys& inner, GridZoneSpec& zone) { describe_zone(inner, zone, domain); });
  keys.choices({"single_cell", "with cell_size: directions along which the domain is one cell",
                Need::has_default, "none"},
               axes, Size{0, 3}, single);
  if (!keys.reading()) return;
  if (!cell_size) {
    for (const auto* key : {"max_growth", "zones", "single_cell"}) {
      if (keys.given(key)) keys.problem(key, "there is no cell_size; only with cell_size");
    }
    return;
  }
  if (keys.given("growth")) keys.problem("growth", "cell_size says all about the cells; only with cells");
  held.cell_size = *cell_size;
  if (max_growth) held.max_growth = *max_growth;
  if (single) {
    for (const int axis : *single) held.single_cell[static_cast<std::size_t>(axis)] = true;
  }
  grid.refinement = held;
}

}  // namespace

void describe_gas_grid(Keys& keys, GridSpec& grid, const DomainSpec& domain) {
  describe_grid(keys, grid, domain);
  describe_refinement(keys, grid, domain);
  keys.exactly_one({"cells", "faces", "cell_size"});
}

void describe_transfer_grid(Keys& keys, GridSpec& transfer, const DomainSpec& domain) {
  describe_grid(keys, transfer, domain);
  std::optional<Real> cell_size;
  keys.real({"cell_size", "of about cubic cells, in place of cells"}, {dimension::length, range::positive},
            cell_size);
  keys.exactly_one({"cells", "faces", "cell_size"});
  if (!cell_size) return;
  for (int axis = 0; axis < 3; ++axis) {
    const Real cells = std::round((domain.box.max[axis] - domain.box.min[axis]) / *cell_size);
    if (cells > static_cast<Real>(cells_rule.max)) {
      keys.problem("cell_size",
                   fmt::format("it gives {} cells along {}; at most {}", cells, "xyz"[axis], cells_rule.max));
      return;
    }
    transfer.cells[axis] = std::max(Index{1}, static_cast<Index>(cells));
  }
}

}  // namespace pellicle::tools
