#include "tools/pellicle/line_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.hpp"

namespace pellicle::tools {

namespace {

Vec3 axis_vector(int axis) {
  Vec3 v{};
  v[axis] = 1;
  return v;
}

/// Axis that the direction runs along, or -1.
int axis_of(const Vec3& direction) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(direction[axis]) > 1 - 1e-12) return axis;
  }
  return -1;
}

std::vector<CellShare> normalised(const std::map<Index, Real>& weights) {
  Real total = 0;
  for (const auto& [cell, weight] : weights) total += weight;
  std::vector<CellShare> shares;
  shares.reserve(weights.size());
  for (const auto& [cell, weight] : weights) shares.push_back({cell, weight / total});
  return shares;
}

/// Cells along an axis that overlap [low, high], with the overlapping lengths.
std::vector<std::pair<Index, Real>> overlaps(const CartesianGrid& grid, int axis, Real low, Real high) {
  const auto& faces = grid.faces(axis);
  std::vector<std::pair<Index, Real>> found;
  for (Index i = 0; i < grid.cells()[axis]; ++i) {
    const auto n = static_cast<std::size_t>(i);
    const Real overlap = std::min(high, faces[n + 1]) - std::max(low, faces[n]);
    // Bins and cells that meet at a face to round-off do not overlap.
    if (overlap > 1e-9 * (faces[n + 1] - faces[n])) found.emplace_back(i, overlap);
  }
  return found;
}

std::vector<CellShare> box_cells(const Box& box, const CartesianGrid& grid) {
  std::map<Index, Real> weights;
  for (const auto& [k, z] : overlaps(grid, 2, box.min.z, box.max.z)) {
    for (const auto& [j, y] : overlaps(grid, 1, box.min.y, box.max.y)) {
      for (const auto& [i, x] : overlaps(grid, 0, box.min.x, box.max.x))
        weights[grid.index(i, j, k)] += x * y * z;
    }
  }
  return normalised(weights);
}

Box bin_box(const LineGeometry& line, Index bin, const CartesianGrid& grid) {
  Box box = grid.box();
  const auto narrow = [&](const Vec3& direction, Real low, Real high) {
    const int axis = axis_of(direction);
    const Real a = line.from[axis] + direction[axis] * low, b = line.from[axis] + direction[axis] * high;
    box.min[axis] = std::min(a, b);
    box.max[axis] = std::max(a, b);
  };
  narrow(line.direction, line.length * bin / line.points, line.length * (bin + 1) / line.points);
  for (int n = 0; n < line.across_count; ++n)
    narrow(line.across[n], -line.half_thickness, line.half_thickness);
  return box;
}

std::vector<CellShare> sampled_cells(const LineSpec& spec, const LineGeometry& line, Index bin,
                                     const CartesianGrid& grid) {
  constexpr int along_samples = 8, across_samples = 8;
  const bool deep = spec.depth_average.has_value();
  const int depth_axis = spec.depth_average.value_or(0);
  const int last_samples = deep ? 2 * grid.cells()[depth_axis] : across_samples;
  std::map<Index, Real> weights;
  for (int a = 0; a < along_samples; ++a) {
    const Vec3 on_line =
        line.from + line.direction * (line.length * (bin + (a + 0.5) / along_samples) / line.points);
    for (int b = 0; b < across_samples; ++b) {
      const Vec3 beside =
          on_line + line.across[0] * (line.half_thickness * ((2 * b + 1.0) / across_samples - 1));
      for (int c = 0; c < last_samples; ++c) {
        Vec3 at = beside;
        if (deep) {
          const Box& box = grid.box();
          at[depth_axis] =
              box.min[depth_axis] + (box.max[depth_axis] - box.min[depth_axis]) * (c + 0.5) / last_samples;
        } else {
          at += line.across[1] * (line.half_thickness * ((2 * c + 1.0) / last_samples - 1));
        }
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) {
          inside = inside && at[axis] >= grid.box().min[axis] && at[axis] <= grid.box().max[axis];
        }
        if (inside)
          weights[grid.index(grid.locate(0, at.x), grid.locate(1, at.y), grid.locate(2, at.z))] += 1;
      }
    }
  }
  return normalised(weights);
}

}  // namespace

LineGeometry make_line_geometry(const LineSpec& spec) {
  LineGeometry line;
  line.from = spec.from;
  line.points = spec.points;
  line.half_thickness = 0.5 * spec.thickness;
  Vec3 direction = spec.to - spec.from;
  if (spec.depth_average) {
    // What is averaged over has no place along the line.
    direction[*spec.depth_average] = 0;
    line.from[*spec.depth_average] = 0;
  }
  line.length = norm(direction);
  if (!(line.length > 0)) {
    throw InputError(spec.where + ": the line has no length" +
                     (spec.depth_average ? " across the direction that is averaged over" : "") +
                     "; from and to must differ");
  }
  if (spec.points < 1) throw InputError(spec.where + ": points must be at least 1");
  if (!(spec.thickness > 0)) throw InputError(spec.where + ": thickness must be positive");
  line.direction = direction * (1 / line.length);
  if (spec.depth_average) {
    line.across[0] = cross(line.direction, axis_vector(*spec.depth_average));
    line.across_count = 1;
  } else {
    int least = 0;
    for (int axis = 1; axis < 3; ++axis) {
      if (std::abs(line.direction[axis]) < std::abs(line.direction[least])) least = axis;
    }
    const Vec3 first = cross(line.direction, axis_vector(least));
    line.across[0] = first * (1 / norm(first));
    line.across[1] = cross(line.direction, line.across[0]);
    line.across_count = 2;
  }
  return line;
}

std::vector<double> line_positions(const LineSpec& spec, const LineGeometry& line) {
  const int axis = axis_of(line.direction);
  std::vector<double> positions;
  positions.reserve(static_cast<std::size_t>(line.points));
  for (Index b = 0; b < line.points; ++b) {
    const Real along = line.center_along(b);
    positions.push_back(axis < 0 ? along : spec.from[axis] + line.direction[axis] * along);
  }
  return positions;
}

std::vector<std::vector<CellShare>> bin_cells(const LineSpec& spec, const LineGeometry& line,
                                              const CartesianGrid& grid) {
  std::vector<std::vector<CellShare>> cells;
  cells.reserve(static_cast<std::size_t>(line.points));
  for (Index b = 0; b < line.points; ++b) {
    cells.push_back(axis_of(line.direction) >= 0 ? box_cells(bin_box(line, b, grid), grid)
                                                 : sampled_cells(spec, line, b, grid));
  }
  return cells;
}

}  // namespace pellicle::tools
