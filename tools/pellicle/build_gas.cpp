#include "tools/pellicle/build_gas.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <stdexcept>

#include "core/error.hpp"
#include "core/log.hpp"
#include "tools/pellicle/build_case.hpp"
#include "tools/pellicle/build_walls.hpp"
#include "tools/pellicle/case_checks.hpp"

namespace pellicle::tools {

namespace {

cfd::ImmersedSurface make_surface(const dem::Wall& wall, GasWall kind) {
  cfd::ImmersedSurface surface;
  surface.name = wall.name;
  surface.velocity = wall.motion.surface_velocity;
  surface.spin = wall.motion.spin;
  surface.through = wall.motion.through;
  surface.sticks = kind == GasWall::no_slip;
  for (const dem::PlaneShape& plane : wall.planes) {
    surface.shapes.emplace_back(cfd::PlaneSurface{plane.normal, plane.offset});
  }
  for (const dem::RevolvedShape& r : wall.revolved) {
    surface.shapes.emplace_back(cfd::RevolvedSurface{r.origin, r.axis, r.r0, r.z0, r.r1, r.z1});
  }
  for (const dem::BoxShape& box : wall.boxes) surface.shapes.emplace_back(cfd::BoxSurface{box.min, box.max});
  if (wall.mesh) {
    // The mesh lives as long as one of the two that share it.
    surface.shapes.emplace_back(cfd::MeshSurface{
        std::shared_ptr<const std::vector<Vec3>>(wall.mesh, &wall.mesh->corners),
        std::shared_ptr<const std::vector<std::array<std::int32_t, 3>>>(wall.mesh, &wall.mesh->triangles)});
  }
  return surface;
}

// A point of the inlet's region, a trifle within the domain.
Vec3 point_within(const CaseSpec& spec, const cfd::BoundaryPatch& patch) {
  const Box& box = patch.region ? *patch.region : spec.domain.box;
  Vec3 point = 0.5 * (box.min + box.max);
  const int axis = cfd::axis_of(patch.on);
  if (patch.disc) {
    point = patch.disc->centre;
    if (patch.disc->inner_radius > 0) {
      point[axis == 0 ? 1 : 0] += 0.5 * (patch.disc->inner_radius + patch.disc->radius);
    }
  }
  const CartesianGrid grid = make_grid(spec.gas->grid, spec.domain);
  const Index side = cfd::is_max(patch.on) ? grid.cells()[axis] - 1 : 0;
  const Real inset = 1e-3 * grid.width(axis, side);
  point[axis] = cfd::is_max(patch.on) ? spec.domain.box.max[axis] - inset : spec.domain.box.min[axis] + inset;
  return point;
}

Vec3 find_inside(const CaseSpec& spec, const std::string& a_wall) {
  if (spec.gas->inside) return *spec.gas->inside;
  const cfd::BoundaryPatch* inlet = nullptr;
  for (const cfd::BoundaryPatch& patch : spec.gas->boundaries) {
    if (!std::holds_alternative<cfd::Inlet>(patch.kind)) continue;
    const bool bounded = patch.region || patch.disc;
    if (!inlet || (bounded && !inlet->region && !inlet->disc)) inlet = &patch;
  }
  if (inlet) return point_within(spec, *inlet);
  throw InputError(fmt::format(
      "{}: wall '{}' divides the domain, and nothing says on which side the gas is; allowed: a point in "
      "the gas as gas.inside, an inlet, or `gas: open` at walls that the gas passes",
      spec.where("gas"), a_wall));
}

}  // namespace

std::vector<dem::Wall> make_walls(const CaseSpec& spec) {
  std::vector<dem::Wall> walls;
  walls.reserve(spec.walls.size());
  for (const WallSpec& wall : spec.walls) walls.push_back(make_wall(spec, wall));
  return walls;
}

cfd::ImmersedGeometry make_immersed(const CaseSpec& spec, const std::vector<dem::Wall>& walls) {
  cfd::ImmersedGeometry immersed;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const WallSpec& wall = spec.walls[w];
    if (wall.box || wall.gas == GasWall::open) continue;
    immersed.surfaces.push_back(make_surface(walls[w], wall.gas));
  }
  if (!immersed.surfaces.empty()) immersed.inside = find_inside(spec, immersed.surfaces.front().name);
  return immersed;
}

cfd::GasSolver make_gas_solver(const CaseSpec& spec, const std::vector<dem::Wall>& walls) {
  const cfd::ImmersedGeometry immersed = make_immersed(spec, walls);
  try {
    cfd::GasSolver gas(make_grid(spec.gas->grid, spec.domain), spec.gas->options, spec.gas->boundaries,
                       immersed);
    const std::string cut = describe_cut(gas.geometry());
    if (!cut.empty()) core::log().info("gas: {}", cut);
    return gas;
  } catch (const std::invalid_argument& error) {
    const Vec3& p = immersed.inside;
    throw InputError(fmt::format("{}: {}: [{:g}, {:g}, {:g}] m; allowed: a point in the gas as gas.inside",
                                 spec.where(spec.gas->inside ? "gas.inside" : "gas"), error.what(), p.x, p.y,
                                 p.z));
  }
}

coupling::MomentumExchange make_exchange(const CaseSpec& spec, const cfd::GasSolver& gas) {
  const coupling::GasProperties properties{spec.gas->options.density, spec.gas->options.viscosity,
                                           spec.gravity};
  try {
    return {make_coupling_options(spec), make_grid(spec.coupling.transfer_grid, spec.domain), gas.grid(),
            properties, &gas.geometry()};
  } catch (const InputError& error) {
    const std::string what = error.what();  // key: what is wrong
    const std::size_t colon = what.find(": ");
    if (colon == std::string::npos) throw;
    throw InputError(spec.where(what.substr(0, colon)) + what.substr(colon));
  }
}

std::string describe_cut(const cfd::FlowGeometry& geometry) {
  if (geometry.surfaces.empty()) return {};
  if (!geometry.is_cut) return "no wall cuts the grid";
  const Index cells = geometry.stencil.cells();
  return fmt::format(
      "{} of {} cells hold gas, {} of them in part (the smallest {:.2g} of its cell); {} faces closed by "
      "thin walls",
      geometry.open_cells, cells, geometry.part_cells, geometry.smallest_part, geometry.thin_faces);
}

}  // namespace pellicle::tools
