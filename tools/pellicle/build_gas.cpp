#include "tools/pellicle/build_gas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

#include "core/error.hpp"
#include "core/log.hpp"
#include "tools/pellicle/build_case.hpp"
#include "tools/pellicle/build_walls.hpp"
#include "tools/pellicle/case_checks.hpp"
#include "tools/pellicle/gas_wall_checks.hpp"

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
    if (!std::holds_alternative<cfd::Inlet>(patch.kind) || patch.wall) continue;
    const bool bounded = patch.region || patch.disc;
    if (!inlet || (bounded && !inlet->region && !inlet->disc)) inlet = &patch;
  }
  if (inlet) return point_within(spec, *inlet);
  throw InputError(fmt::format(
      "{}: wall '{}' divides the domain, and nothing says on which side the gas is; allowed: a point in "
      "the gas as gas.inside, an inlet, or `gas: open` at walls that the gas passes",
      spec.where("gas"), a_wall));
}

// Walls between the inlets: which one lies apart from the others, if the inlets alone say where the gas is.
std::string describe_parted_inlets(const CaseSpec& spec, const cfd::ImmersedGeometry& immersed) {
  if (spec.gas->inside || immersed.surfaces.empty()) return {};
  std::vector<const cfd::BoundaryPatch*> inlets;
  std::vector<Vec3> points;
  for (const cfd::BoundaryPatch& patch : spec.gas->boundaries) {
    if (!std::holds_alternative<cfd::Inlet>(patch.kind) || patch.wall) continue;
    inlets.push_back(&patch);
    points.push_back(point_within(spec, patch));
  }
  const std::vector<int> groups =
      cfd::group_points(make_grid(spec.gas->grid, spec.domain), immersed.surfaces, points);
  const auto joined = [&](std::size_t i) { return std::count(groups.begin(), groups.end(), groups[i]); };
  std::size_t most = 0, least = 0;
  for (std::size_t i = 1; i < groups.size(); ++i) {
    if (joined(i) > joined(most)) most = i;
    if (joined(i) < joined(least)) least = i;
  }
  if (inlets.size() < 2 || groups[most] == groups[least]) {
    for (std::size_t i = 1; i < groups.size(); ++i) {
      if (groups[i] != groups[0]) least = i, most = 0;
    }
    if (inlets.size() < 2 || groups[most] == groups[least]) return {};
    return fmt::format(
        "{}: walls part inlet '{}' from inlet '{}', and nothing says on which side the gas is; allowed: a "
        "point "
        "in the gas as gas.inside, or inlets within one vessel",
        inlets[least]->where, inlets[least]->name, inlets[most]->name);
  }
  std::string others;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (groups[i] == groups[most])
      others += fmt::format("{}'{}'", others.empty() ? "" : ", ", inlets[i]->name);
  }
  return fmt::format(
      "{}: inlet '{}' lies apart from {}: walls are between them; allowed: inlets within one vessel, or a "
      "point in "
      "the gas as gas.inside",
      inlets[least]->where, inlets[least]->name, others);
}

// Sides where the gas stops though neither a boundary nor a wall of the case says so: where a vessel leaks.
std::string list_unnamed_sides(const CaseSpec& spec, const cfd::FlowGeometry& geometry) {
  std::string sides;
  if (!geometry.is_cut) return sides;
  for (std::size_t s = 0; s < 6; ++s) {
    const auto side = static_cast<cfd::Side>(s);
    const int axis = cfd::axis_of(side);
    if (spec.domain.periodic[static_cast<std::size_t>(axis)]) continue;
    const bool named =
        std::any_of(spec.gas->boundaries.begin(), spec.gas->boundaries.end(),
                    [&](const auto& patch) { return !patch.wall && patch.on == side; }) ||
        std::any_of(spec.walls.begin(), spec.walls.end(), [](const WallSpec& wall) { return wall.box; });
    if (named) continue;
    Real open = 0;
    const cfd::Stencil& stencil = geometry.stencil;
    for (Index c = 0; c < stencil.cells(); ++c) {
      const Index3 at = geometry.grid.coordinates(c);
      if (at[axis] != (cfd::is_max(side) ? stencil.n[axis] - 1 : 0)) continue;
      const Index face =
          stencil.face(axis, at.x, at.y, at.z) + (cfd::is_max(side) ? stencil.face_step(axis) : 0);
      open += geometry.area[static_cast<std::size_t>(axis)](face);
    }
    if (open > 0) sides += fmt::format("{}{}", sides.empty() ? "" : ", ", name_of(side));
  }
  return sides;
}

// Names of the walls that have gas on both sides, or of all.
std::string list_surfaces(const cfd::FlowGeometry& geometry, bool between_gas) {
  std::string names;
  for (std::size_t s = 0; s < geometry.surfaces.size(); ++s) {
    const bool is_thin =
        std::any_of(geometry.pieces.begin(), geometry.pieces.end(), [&](const cfd::SurfacePiece& piece) {
          return piece.beyond >= 0 && static_cast<std::size_t>(piece.surface) == s;
        });
    if (between_gas && !is_thin) continue;
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ", geometry.surfaces[s].name);
  }
  return names;
}

}  // namespace

Leaks find_leaks(const CaseSpec& spec, const cfd::FlowGeometry& geometry) {
  const std::string sides = list_unnamed_sides(spec, geometry);
  if (sides.empty()) return {};
  // A body within the gas is none that keeps it in; what has gas on both sides may be.
  const std::string open_walls = list_surfaces(geometry, true);
  if (open_walls.empty()) {
    return {
        false,
        fmt::format("{}: the gas around {} reaches the sides {} of the domain, which no boundary and no wall "
                    "names: it stops there as at a wall",
                    spec.where("gas"), list_surfaces(geometry, false), sides)};
  }
  return {
      true,
      fmt::format(
          "{}: the vessel is open: {} has gas on both sides, and the gas reaches the sides {} of the domain, "
          "which no boundary and no wall names; allowed: walls without a gap between them and gas.inside "
          "within, or, where the gas shall stop at these sides, a wall `box: domain` or boundaries `wall: "
          "{{}}`",
          spec.where("gas"), open_walls, sides)};
}

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
  check_wall_motion(spec, walls);
  check_tubes(spec);
  const cfd::ImmersedGeometry immersed = make_immersed(spec, walls);
  try {
    cfd::GasSolver gas(make_grid(spec.gas->grid, spec.domain), spec.gas->options, spec.gas->boundaries,
                       immersed);
    const std::string cut = describe_cut(gas.geometry());
    if (!cut.empty()) core::log().info("gas: {}", cut);
    const Leaks leaks = find_leaks(spec, gas.geometry());
    if (leaks.is_open) throw InputError(leaks.message);
    if (!leaks.message.empty()) core::log().warn("{}", leaks.message);
    return gas;
  } catch (const InputError&) {
    const std::string parted = describe_parted_inlets(spec, immersed);
    if (parted.empty()) throw;
    throw InputError(parted);
  } catch (const std::invalid_argument& error) {
    const Vec3& p = immersed.inside;
    throw InputError(fmt::format("{}: {}: [{:g}, {:g}, {:g}] m; allowed: a point in the gas as gas.inside",
                                 spec.where(spec.gas->inside ? "gas.inside" : "gas"), error.what(), p.x, p.y,
                                 p.z));
  }
}

coupling::MomentumExchange make_exchange(const CaseSpec& spec, const cfd::GasSolver& gas) {
  const cfd::GasOptions& options = spec.gas->options;
  const coupling::GasProperties properties{options.density, options.viscosity, spec.gravity,
                                           options.density_law != cfd::DensityLaw::constant,
                                           options.viscosity_law == cfd::ViscosityLaw::sutherland};
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
