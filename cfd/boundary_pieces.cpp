#include "cfd/boundary_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "cfd/plane_region.hpp"
#include "core/error.hpp"

namespace pellicle::cfd {

std::string_view name_of(Side side) {
  constexpr std::array<std::string_view, 6> names{"left", "right", "front", "back", "bottom", "top"};
  return names[static_cast<std::size_t>(side)];
}

namespace {

// The two axes that span a side, the faster-running first.
std::array<int, 2> plane_axes(int axis) {
  return axis == 0 ? std::array<int, 2>{1, 2}
                   : (axis == 1 ? std::array<int, 2>{0, 2} : std::array<int, 2>{0, 1});
}

[[noreturn]] void refuse(const BoundaryPatch& patch, const std::string& what) {
  throw InputError(fmt::format("{}: boundary '{}' {}", patch.where, patch.name, what));
}

void check_values(const BoundaryPatch& patch) {
  if (const auto* inlet = std::get_if<Inlet>(&patch.kind)) {
    if (int{inlet->velocity.has_value()} + int{inlet->flow_rate.has_value()} +
            int{inlet->mass_flow.has_value()} !=
        1) {
      refuse(patch, "is an inlet; allowed: exactly one of velocity, flow_rate and mass_flow");
    }
    if (!std::isfinite(inlet->velocity.value_or(0)) || !std::isfinite(inlet->flow_rate.value_or(0)) ||
        !std::isfinite(inlet->mass_flow.value_or(0))) {
      refuse(patch, "has an inflow that is no finite number; allowed: a number");
    }
  }
  const bool slips =
      std::holds_alternative<FreeSlip>(patch.kind) || std::holds_alternative<Symmetry>(patch.kind);
  if (patch.wall && (slips || patch.region || patch.disc)) {
    refuse(patch,
           fmt::format("is the whole of wall '{}'; allowed: an inlet, an outlet or, with a temperature, a "
                       "wall, without region",
                       *patch.wall));
  }
  if (const auto* wall = std::get_if<NoSlip>(&patch.kind)) {
    if (!std::isfinite(norm(wall->velocity))) refuse(patch, "has a velocity that is no finite number");
    if (patch.wall && norm(wall->velocity) != 0) {
      refuse(patch, fmt::format("has a velocity, which wall '{}' itself has; allowed: none", *patch.wall));
    }
    if (wall->velocity[axis_of(patch.on)] != 0) {
      refuse(patch, "moves at right angles to itself; allowed: a velocity in the plane of the wall");
    }
  }
}

// "wall 'a'" or "walls 'a', 'b'": the surfaces that come next to these points. A hundred points will tell.
std::string walls_at(const FlowGeometry& geometry, const std::vector<Vec3>& points) {
  std::set<std::int32_t> found;
  const std::size_t stride = 1 + points.size() / 100;
  for (std::size_t i = 0; i < points.size(); i += stride) {
    Real least = std::numeric_limits<Real>::infinity();
    std::int32_t nearest = -1;
    for (const SurfacePiece& piece : geometry.pieces) {
      const Real distance = norm_squared(piece.point - points[i]);
      if (distance < least) least = distance, nearest = piece.surface;
    }
    if (nearest >= 0) found.insert(nearest);
  }
  std::string names;
  for (const std::int32_t surface : found) {
    names += fmt::format("{}'{}'", names.empty() ? "" : ", ",
                         geometry.surfaces[static_cast<std::size_t>(surface)].name);
  }
  return (found.size() == 1 ? "wall " : "walls ") + names;
}

// Cuts one side and adds its pieces.
class SideCutter {
 public:
  SideCutter(const FlowGeometry& geometry, const std::vector<BoundaryPatch>& patches, Side side)
      : geometry_(geometry),
        patches_(patches),
        side_(side),
        axis_(axis_of(side)),
        across_(plane_axes(axis_)) {
    const Box& box = geometry.grid.box();
    for (std::size_t d = 0; d < 2; ++d)
      whole_.min[d] = box.min[across_[d]], whole_.max[d] = box.max[across_[d]];
    collect_regions();
    check_overlaps();
  }

  void cut(Boundaries& result) const {
    const CartesianGrid& grid = geometry_.grid;
    const Index3 n = geometry_.stencil.n;
    const Index along = is_max(side_) ? n[axis_] - 1 : 0;
    std::vector<Covered> covered(patches_.size());
    for (Index b = 0; b < n[across_[1]]; ++b) {
      for (Index a = 0; a < n[across_[0]]; ++a) {
        Index3 at{0, 0, 0};
        at[axis_] = along;
        at[across_[0]] = a;
        at[across_[1]] = b;
        const auto corner = [&](int d, Index i) {
          return grid.faces(across_[static_cast<std::size_t>(d)])[static_cast<std::size_t>(i)];
        };
        const Rectangle face{{corner(0, a), corner(1, b)}, {corner(0, a + 1), corner(1, b + 1)}};
        cut_face(result, at, face, covered);
      }
    }
    check_covered(covered);
  }

  // Area of each patch's region on this side, walls or not [m2].
  void add_region_areas(std::vector<Real>& areas) const {
    for (const auto& [patch, region] : regions_)
      areas[static_cast<std::size_t>(patch)] = region.area_within(whole_);
  }

 private:
  // What a patch got of the side.
  struct Covered {
    Real area = 0;           // [m2]
    std::vector<Vec3> shut;  // middles of its faces that surfaces close, in whole or in part [m]
  };

  // Of a face that surfaces within the domain close in part, the regions take what they cover of the open part.
  void cut_face(Boundaries& result, const Index3& at, const Rectangle& face,
                std::vector<Covered>& covered) const {
    const Stencil& s = geometry_.stencil;
    const Index f = s.face(axis_, at.x, at.y, at.z) + (is_max(side_) ? s.face_step(axis_) : 0);
    const Real open = geometry_.area[static_cast<std::size_t>(axis_)](f);
    const Real whole = face.area();
    if (open < (1 - 1e-9) * whole) note_shut(face, covered);
    if (open == 0) return;
    std::vector<std::pair<int, Real>> shares;
    Real taken = 0;
    for (const auto& [patch, region] : regions_) {
      const Real area = region.area_within(face);
      if (area <= 1e-12 * whole) continue;
      shares.emplace_back(patch, area);
      taken += area;
    }
    const Real scale = taken > open ? open / taken : 1;
    for (const auto& [patch, area] : shares) {
      add(result, at, patch, scale * area);
      covered[static_cast<std::size_t>(patch)].area += scale * area;
    }
    const Real left = open - scale * taken;
    if (left > 1e-12 * whole) {
      add(result, at, rest_, left);
      if (rest_ >= 0) covered[static_cast<std::size_t>(rest_)].area += left;
    }
  }

  void note_shut(const Rectangle& face, std::vector<Covered>& covered) const {
    const Box& box = geometry_.grid.box();
    Vec3 middle;
    middle[axis_] = is_max(side_) ? box.max[axis_] : box.min[axis_];
    for (std::size_t d = 0; d < 2; ++d) middle[across_[d]] = 0.5 * (face.min[d] + face.max[d]);
    const auto note = [&](int patch) { covered[static_cast<std::size_t>(patch)].shut.push_back(middle); };
    for (const auto& [patch, region] : regions_) {
      if (region.area_within(face) > 0) note(patch);
    }
    if (rest_ >= 0) note(rest_);
  }

  void collect_regions() {
    const Box& box = geometry_.grid.box();
    const Real plane = is_max(side_) ? box.max[axis_] : box.min[axis_];
    const Real slack = 1e-9 * (box.max[axis_] - box.min[axis_]);
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      const BoundaryPatch& patch = patches_[p];
      if (patch.wall || patch.on != side_) continue;
      if (!patch.region && !patch.disc) {
        if (rest_ >= 0) {
          refuse(patch,
                 fmt::format("takes the rest of the {} side, as '{}' does; allowed: one boundary a side "
                             "without region",
                             name_of(side_), patches_[static_cast<std::size_t>(rest_)].name));
        }
        rest_ = static_cast<int>(p);
        continue;
      }
      const PlaneRegion region = patch.disc ? make_round(patch) : PlaneRegion(make_rectangle(patch));
      const bool reaches = patch.disc || (patch.region->min[axis_] <= plane + slack &&
                                          patch.region->max[axis_] >= plane - slack);
      if (!reaches || region.area_within(whole_) <= 0) {
        refuse(patch,
               fmt::format("has a region that covers no face of the {} side; allowed: a {} that reaches it",
                           name_of(side_), patch.disc ? "disc" : "box"));
      }
      regions_.emplace_back(static_cast<int>(p), region);
    }
  }

  Rectangle make_rectangle(const BoundaryPatch& patch) const {
    const Rectangle region{{patch.region->min[across_[0]], patch.region->min[across_[1]]},
                           {patch.region->max[across_[0]], patch.region->max[across_[1]]}};
    return region.intersect(whole_);
  }

  PlaneRegion make_round(const BoundaryPatch& patch) const {
    const DiscRegion& disc = *patch.disc;
    if (!(disc.radius > disc.inner_radius && disc.inner_radius >= 0 && std::isfinite(disc.radius))) {
      refuse(patch,
             fmt::format("has a disc of radius {} and inner radius {} m; allowed: 0 <= inner_radius < radius",
                         disc.radius, disc.inner_radius));
    }
    return {{disc.centre[across_[0]], disc.centre[across_[1]]}, disc.radius, disc.inner_radius};
  }

  void check_overlaps() const {
    for (std::size_t a = 0; a < regions_.size(); ++a) {
      for (std::size_t b = a + 1; b < regions_.size(); ++b) {
        if (regions_[a].second.area_within(regions_[b].second) <= 1e-9 * whole_.area()) continue;
        refuse(patches_[static_cast<std::size_t>(regions_[b].first)],
               fmt::format("overlaps boundary '{}' on the {} side; allowed: regions apart from each other",
                           patches_[static_cast<std::size_t>(regions_[a].first)].name, name_of(side_)));
      }
    }
  }

  void check_covered(const std::vector<Covered>& covered) const {
    for (std::size_t p = 0; p < patches_.size(); ++p) {
      if (patches_[p].wall || patches_[p].on != side_ || covered[p].area > 0) continue;
      refuse(patches_[p],
             geometry_.is_cut
                 ? fmt::format("is outside of the gas: all that it covers of the {} side is behind {}; "
                               "allowed: a part of the side that the gas reaches",
                               name_of(side_), walls_at(geometry_, covered[p].shut))
                 : fmt::format("covers no face of the {} side; allowed: a part that no other boundary takes",
                               name_of(side_)));
    }
    constexpr Real mostly = 0.9;
    for (const auto& [patch, region] : regions_) {
      const auto p = static_cast<std::size_t>(patch);
      const Real area = region.area_within(whole_);
      if (!geometry_.is_cut || !std::holds_alternative<Inlet>(patches_[p].kind) ||
          covered[p].area >= mostly * area)
        continue;
      refuse(
          patches_[p],
          fmt::format("is an inlet of {:.4g} m2 of which only {:.4g} m2 is open, the rest being behind {}; "
                      "allowed: an inlet within the gas",
                      area, covered[p].area, walls_at(geometry_, covered[p].shut)));
    }
  }

  void add(Boundaries& result, const Index3& at, int patch, Real area) const {
    const Stencil& s = geometry_.stencil;
    BoundaryPiece piece;
    piece.patch = patch;
    piece.axis = axis_;
    piece.outward = is_max(side_) ? 1 : -1;
    piece.cell = s.cell(at.x, at.y, at.z);
    piece.face = s.face(axis_, at.x, at.y, at.z) + (is_max(side_) ? s.face_step(axis_) : 0);
    piece.place = s.plane_index(axis_, at.x, at.y, at.z);
    piece.area = area;
    piece.half_width = 0.5 * geometry_.grid.width(axis_, at[axis_]);
    if (patch >= 0) {
      const auto& kind = patches_[static_cast<std::size_t>(patch)].kind;
      if (std::holds_alternative<Inlet>(kind)) piece.kind = PieceKind::inlet;
      if (std::holds_alternative<Outlet>(kind)) piece.kind = PieceKind::outlet;
      if (std::holds_alternative<FreeSlip>(kind) || std::holds_alternative<Symmetry>(kind)) {
        piece.kind = PieceKind::slip;
      }
      if (const auto* wall = std::get_if<NoSlip>(&kind)) piece.velocity = wall->velocity;
      if (const auto* outlet = std::get_if<Outlet>(&kind)) piece.pressure = outlet->pressure;
    }
    result.pieces.push_back(piece);
  }

  const FlowGeometry& geometry_;
  const std::vector<BoundaryPatch>& patches_;
  Side side_;
  int axis_;
  std::array<int, 2> across_;
  Rectangle whole_{};
  std::vector<std::pair<int, PlaneRegion>> regions_;
  int rest_ = -1;
};

// A surface within the domain through which gas comes in or leaves, or that has a temperature: all its pieces.
void add_wall(Boundaries& result, const FlowGeometry& geometry, const std::vector<BoundaryPatch>& patches,
              std::size_t p) {
  const BoundaryPatch& patch = patches[p];
  for (std::size_t other = 0; other < p; ++other) {
    if (patches[other].wall == patch.wall) {
      refuse(patch, fmt::format("is wall '{}', as boundary '{}' is; allowed: one boundary a wall",
                                *patch.wall, patches[other].name));
    }
  }
  const auto named = std::find_if(geometry.surfaces.begin(), geometry.surfaces.end(),
                                  [&](const ImmersedSurface& s) { return s.name == *patch.wall; });
  if (named == geometry.surfaces.end()) {
    refuse(patch, fmt::format("is wall '{}', which the gas does not see; allowed: the name of a wall within "
                              "the domain that is not `gas: open`",
                              *patch.wall));
  }
  const auto surface = static_cast<std::int32_t>(named - geometry.surfaces.begin());
  const bool opens = !std::holds_alternative<NoSlip>(patch.kind);
  Real open_area = 0, thin_area = 0;
  for (std::size_t s = 0; s < geometry.pieces.size(); ++s) {
    const SurfacePiece& part = geometry.pieces[s];
    if (part.surface != surface) continue;
    // An edge of a solid can lie between two cells of gas like a thin wall: nothing comes through there.
    if (part.beyond >= 0 && opens) {
      thin_area += part.area;
      continue;
    }
    if (opens && norm(part.normal) == 0) continue;
    open_area += part.area;
    BoundaryPiece piece;
    if (std::holds_alternative<Inlet>(patch.kind)) piece.kind = PieceKind::inlet;
    if (std::holds_alternative<Outlet>(patch.kind)) piece.kind = PieceKind::outlet;
    piece.patch = static_cast<int>(p);
    piece.cell = part.cell;
    piece.area = part.area;
    piece.half_width = part.distance;
    piece.surface_piece = static_cast<std::int32_t>(s);
    piece.normal = part.normal;
    if (const auto* outlet = std::get_if<Outlet>(&patch.kind)) piece.pressure = outlet->pressure;
    result.pieces.push_back(piece);
    if (!opens) continue;
    result.open_pieces.resize(geometry.pieces.size(), 0);
    result.open_pieces[s] = 1;
  }
  if (thin_area > open_area) {
    refuse(patch,
           fmt::format("is wall '{}', which has gas on both sides; allowed: a wall with gas on one side, "
                       "such as a block",
                       *patch.wall));
  }
  if (!(open_area > 0)) {
    refuse(patch, fmt::format("is wall '{}', which the gas does not touch; allowed: a wall at the gas",
                              *patch.wall));
  }
}

// A flow rate becomes a velocity over the area that the inlet was found to have. Where walls cut cells that area differs a
// little from the region's own: the flow of a given velocity is that through the region.
void set_inlet_velocities(Boundaries& result, const std::vector<BoundaryPatch>& patches, bool is_cut,
                          const std::vector<Real>& region_areas) {
  std::vector<Real> area(patches.size(), 0);
  for (const BoundaryPiece& piece : result.pieces) {
    if (piece.patch >= 0) area[static_cast<std::size_t>(piece.patch)] += piece.area;
  }
  Real net_inflow = 0;
  Real gross = 0;
  const BoundaryPatch* an_inlet = nullptr;
  for (BoundaryPiece& piece : result.pieces) {
    result.has_outlet = result.has_outlet || piece.kind == PieceKind::outlet;
    if (piece.kind != PieceKind::inlet) continue;
    const auto p = static_cast<std::size_t>(piece.patch);
    const auto& inlet = std::get<Inlet>(patches[p].kind);
    Real inward = inlet.velocity ? *inlet.velocity : inlet.share * inlet.flow_rate.value_or(0) / area[p];
    if (inlet.velocity && is_cut && region_areas[p] > 0) inward *= region_areas[p] / area[p];
    if (piece.is_immersed()) {
      piece.velocity = inward * piece.normal;
    } else {
      piece.velocity[piece.axis] = -piece.outward * inward;
    }
    net_inflow += inward * piece.area;
    gross += std::abs(inward) * piece.area;
    if (!an_inlet) an_inlet = &patches[p];
  }
  if (!result.has_outlet && std::abs(net_inflow) > 1e-12 * gross) {
    refuse(*an_inlet, fmt::format("lets {:.6g} m3/s of gas in, which has no way out; allowed: add an outlet",
                                  net_inflow));
  }
}

void set_boundary_values(Boundaries& result, const FlowGeometry& geometry) {
  const Stencil& s = geometry.stencil;
  for (int axis = 0; axis < 3; ++axis) {
    if (s.periodic[static_cast<std::size_t>(axis)]) continue;
    for (int side = 0; side < 2; ++side) {
      result.values[side_number(axis, 2 * side - 1)].resize(static_cast<std::size_t>(s.plane_size(axis)));
    }
  }
  for (const BoundaryPiece& piece : result.pieces) {
    if (piece.is_immersed()) continue;
    const auto side = side_number(piece.axis, piece.outward);
    BoundaryValue& value = result.values[side][static_cast<std::size_t>(piece.place)];
    const Real share = piece.area / geometry.area[static_cast<std::size_t>(piece.axis)](piece.face);
    for (int a = 0; a < 3; ++a) {
      const bool normal = a == piece.axis;
      const bool free = piece.kind == PieceKind::outlet || (piece.kind == PieceKind::slip && !normal);
      if (free) {
        value.free[a] += share;
      } else {
        value.fixed[a] += share * piece.velocity[a];
      }
    }
  }
}

void find_groups(Boundaries& result) {
  const std::vector<BoundaryPiece>& pieces = result.pieces;
  PieceGroups& groups = result.groups;
  for (std::size_t b = 0; b < pieces.size(); ++b) {
    groups.pieces.push_back(static_cast<Index>(b));
    if (pieces[b].kind == PieceKind::inlet || pieces[b].kind == PieceKind::outlet)
      result.passable.push_back(b);
  }
  const auto cell_of = [&](Index b) { return pieces[static_cast<std::size_t>(b)].cell; };
  std::stable_sort(groups.pieces.begin(), groups.pieces.end(),
                   [&](Index b, Index c) { return cell_of(b) < cell_of(c); });
  for (std::size_t i = 1; i <= pieces.size(); ++i) {
    if (i < pieces.size() && cell_of(groups.pieces[i]) == cell_of(groups.pieces[i - 1])) continue;
    groups.begin.push_back(static_cast<Index>(i));
  }
}

}  // namespace

Boundaries cut_boundaries(const FlowGeometry& geometry, const std::vector<BoundaryPatch>& patches) {
  Boundaries result;
  for (const BoundaryPatch& patch : patches) {
    check_values(patch);
    if (!patch.wall && geometry.stencil.periodic[static_cast<std::size_t>(axis_of(patch.on))]) {
      refuse(patch,
             fmt::format("is on the {} side, where the domain is periodic; allowed: sides that are not",
                         name_of(patch.on)));
    }
    result.patch_names.push_back(patch.name);
  }
  std::vector<Real> region_areas(patches.size(), 0);
  for (const Side side : {Side::x_min, Side::x_max, Side::y_min, Side::y_max, Side::z_min, Side::z_max}) {
    if (geometry.stencil.periodic[static_cast<std::size_t>(axis_of(side))]) continue;
    const SideCutter cutter(geometry, patches, side);
    cutter.cut(result);
    cutter.add_region_areas(region_areas);
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (patches[p].wall) add_wall(result, geometry, patches, p);
  }
  set_inlet_velocities(result, patches, geometry.is_cut, region_areas);
  set_boundary_values(result, geometry);
  find_groups(result);
  return result;
}

}  // namespace pellicle::cfd
