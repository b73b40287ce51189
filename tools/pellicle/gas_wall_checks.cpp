#include "tools/pellicle/gas_wall_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "core/log.hpp"

namespace pellicle::tools {

namespace {

std::string key_of(const CaseSpec& spec, const WallSpec& wall, const char* key) {
  return spec.where(wall.where.substr(wall.where.rfind(": ") + 2) + "." + key);
}

Real smallest_width(const CartesianGrid& grid, int axis) {
  Real least = std::numeric_limits<Real>::max();
  for (Index i = 0; i < grid.cells()[axis]; ++i) least = std::min(least, grid.width(axis, i));
  return least;
}

void check_swing(const CaseSpec& spec, const CartesianGrid& grid, const WallSpec& wall) {
  const Vec3& amplitude = wall.vibration->amplitude;
  for (int axis = 0; axis < 3; ++axis) {
    const Real half = 0.5 * smallest_width(grid, axis);
    // Along an axis of one cell the gas is that of a plane: nothing is resolved there.
    if (grid.cells()[axis] == 1 || std::abs(amplitude[axis]) <= half) continue;
    throw InputError(fmt::format(
        "{}: wall '{}' swings by {:g} m along {}, and the gas, which takes it as standing still, has cells "
        "of "
        "{:g} m there; allowed: at most half a cell, or `gas: open` at a wall that the gas passes",
        key_of(spec, wall, "vibration"), wall.name, std::abs(amplitude[axis]), "xyz"[axis], 2 * half));
  }
  core::log().warn("{}: the gas takes wall '{}' as standing still in the middle of its swing",
                   key_of(spec, wall, "vibration"), wall.name);
}

void check_turn(const CaseSpec& spec, const WallSpec& wall) {
  if (wall.stl) {
    core::log().warn(
        "{}: the gas takes wall '{}' as standing still and its surface as moving along itself, which is "
        "right for a "
        "mesh that is round about the axis alone",
        key_of(spec, wall, "spin"), wall.name);
    return;
  }
  throw InputError(
      fmt::format("{}: wall '{}' is not the same at every angle about the axis, and the gas cannot follow "
                  "it; allowed: a shape "
                  "that is round about the axis, or `gas: open` at a wall that the gas passes",
                  key_of(spec, wall, "spin"), wall.name));
}

struct Tube {
  const char* key;
  Vec3 from, to;
  Real radius;
};

// Widths of the cells across the tube that it lies in, the two largest of the axes that it does not run along.
void check_tube(const CaseSpec& spec, const CartesianGrid& grid, const WallSpec& wall, const Tube& tube) {
  const Vec3 along = (1 / norm(tube.to - tube.from)) * (tube.to - tube.from);
  int main = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(along[axis]) > std::abs(along[main])) main = axis;
  }
  Real square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Real low = std::min(tube.from[axis], tube.to[axis]) - tube.radius;
    const Real high = std::max(tube.from[axis], tube.to[axis]) + tube.radius;
    const Box& box = spec.domain.box;
    if (high < box.min[axis] || low > box.max[axis]) return;  // beside the domain
    if (axis == main || grid.cells()[axis] == 1) continue;
    Real widest = 0;
    const Index first = grid.locate(axis, std::max(low, box.min[axis]));
    const Index last = grid.locate(axis, std::min(high, box.max[axis]));
    for (Index i = first; i <= last; ++i) widest = std::max(widest, grid.width(axis, i));
    square += widest * widest;
  }
  const Real least = 0.5 * std::sqrt(square);
  if (tube.radius >= least) return;
  throw InputError(
      fmt::format("{}: wall '{}' is {:g} m wide, so thin that no cell of the gas may have its middle within "
                  "it; allowed: a radius of "
                  "at least {:.4g} m, smaller cells (gas.grid), or `gas: open` at a wall that the gas passes",
                  key_of(spec, wall, tube.key), wall.name, 2 * tube.radius, least));
}

}  // namespace

void check_wall_motion(const CaseSpec& spec, const std::vector<dem::Wall>& walls) {
  if (!spec.gas) return;
  const CartesianGrid grid = make_grid(spec.gas->grid, spec.domain);
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const WallSpec& wall = spec.walls[w];
    if (wall.gas == GasWall::open) continue;
    if (wall.vibration && norm(wall.vibration->amplitude) > 0) check_swing(spec, grid, wall);
    if (wall.spin && dem::has_to_turn(walls[w])) check_turn(spec, wall);
  }
}

void check_tubes(const CaseSpec& spec) {
  if (!spec.gas) return;
  const CartesianGrid grid = make_grid(spec.gas->grid, spec.domain);
  for (const WallSpec& wall : spec.walls) {
    if (wall.gas == GasWall::open) continue;
    if (wall.cylinder) {
      check_tube(spec, grid, wall,
                 {"cylinder.radius", wall.cylinder->from, wall.cylinder->to, wall.cylinder->radius});
    }
    if (wall.cone) {
      check_tube(
          spec, grid, wall,
          {"cone", wall.cone->from, wall.cone->to, std::max(wall.cone->from_radius, wall.cone->to_radius)});
    }
  }
}

}  // namespace pellicle::tools
