#include "cfd/cut_cells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "cfd/stencil.hpp"
#include "cfd/surface_lattice.hpp"

namespace pellicle::cfd {

namespace {

// Shares of faces closer than this to 0 or 1 are 0 or 1.
constexpr Real negligible = 1e-6;

// The wet part of a rectangle between four lattice points: at most six corners, counter-clockwise as seen from +axis.
struct Polygon {
  std::array<Vec3, 8> corner;
  std::array<bool, 8> along_surface{};  // of the side from a corner to the next
  int count = 0;

  void add(const Vec3& p) { corner[static_cast<std::size_t>(count++)] = p; }
  const Vec3& operator[](int i) const { return corner[static_cast<std::size_t>(i % count)]; }
};

using Place = std::array<std::size_t, 3>;

std::size_t entry(Index i) { return static_cast<std::size_t>(i); }

// Sums over the oriented triangles that bound a body.
struct Body {
  Vec3 apex;
  Real volume = 0;  // [m3]
  Vec3 moment;      // volume times centroid [m4]

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Real v = dot(a - apex, cross(b - apex, c - apex)) / 6;
    volume += v;
    moment += (0.25 * v) * (apex + a + b + c);
  }
};

// The surface within a cell.
struct CutSurface {
  Vec3 area_vector;  // out of the gas [m2]
  Real area = 0;
  Vec3 moment;  // area times middle
  std::map<std::int32_t, int> votes;
};

class Cutter {
 public:
  Cutter(const CartesianGrid& grid, const std::vector<ImmersedSurface>& surfaces, const Vec3& seed)
      : grid_(grid), lattice_(grid, surfaces) {
    if (!lattice_.wet_from(seed)) {
      throw std::invalid_argument("the point from which the gas spreads lies on a wall");
    }
    stencil_.n = grid.cells();
    for (int a = 0; a < 3; ++a) stencil_.periodic[static_cast<std::size_t>(a)] = grid.periodic(a);
  }

  CutCells cut() {
    find_open_shares();
    cut_all_cells();
    close_thin_surfaces();
    leave_out_small_cells();
    keep_connected();
    hand_over_pieces_of_closed_cells();
    close_faces_of_closed_cells();
    collect();
    return std::move(result_);
  }

 private:
  Vec3 position(const Place& p) const {
    return {lattice_.at(0)[p[0]], lattice_.at(1)[p[1]], lattice_.at(2)[p[2]]};
  }
  std::size_t number(const Place& p) const { return lattice_.point(p[0], p[1], p[2]); }
  bool wet(const Place& p) const { return lattice_.wet(number(p)); }

  // Where the surface crosses the edge from p along the axis, one end of which is wet.
  Vec3 crossing_on(const Place& p, int axis) const {
    Place q = p;
    ++q[static_cast<std::size_t>(axis)];
    const SurfaceLattice::Crossing* crossing = lattice_.crossing(axis, number(p));
    const Real share = crossing == nullptr ? 0.5 : (wet(p) ? crossing->first : crossing->last);
    const Vec3 from = position(p);
    return from + share * (position(q) - from);
  }

  // The wet part of the rectangle across an axis whose lowest corner is p.
  Polygon wet_polygon(int axis, const Place& p) const {
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    std::array<Place, 4> corner{p, p, p, p};
    ++corner[1][static_cast<std::size_t>(b)];
    ++corner[2][static_cast<std::size_t>(b)];
    ++corner[2][static_cast<std::size_t>(c)];
    ++corner[3][static_cast<std::size_t>(c)];
    Polygon polygon;
    for (std::size_t i = 0; i < 4; ++i) {
      const Place& from = corner[i];
      const Place& to = corner[(i + 1) % 4];
      if (wet(from)) polygon.add(position(from));
      if (wet(from) == wet(to)) continue;
      // Where the way leaves the gas, the polygon goes on along the surface to where it comes back.
      if (wet(from)) polygon.along_surface[static_cast<std::size_t>(polygon.count)] = true;
      polygon.add(crossing_on(i < 2 ? from : to, i % 2 == 0 ? b : c));
    }
    return polygon;
  }

  static Real area_along(const Polygon& polygon, int axis) {
    Real twice = 0;
    for (int i = 1; i + 1 < polygon.count; ++i) {
      twice += cross(polygon[i] - polygon[0], polygon[i + 1] - polygon[0])[axis];
    }
    return 0.5 * twice;
  }

  void find_open_shares() {
    for (int axis = 0; axis < 3; ++axis) {
      auto& shares = result_.open_share[static_cast<std::size_t>(axis)];
      shares.assign(static_cast<std::size_t>(stencil_.faces(axis)), 0);
      const int b = (axis + 1) % 3;
      const int c = (axis + 2) % 3;
      Index3 n = stencil_.n;
      ++n[axis];
      for (Index k = 0; k < n.z; ++k) {
        for (Index j = 0; j < n.y; ++j) {
          for (Index i = 0; i < n.x; ++i) {
            const Index3 at{i, j, k};
            const Real full = grid_.width(b, at[b]) * grid_.width(c, at[c]);
            Real share = 0;
            for (std::size_t quarter = 0; quarter < 4; ++quarter) {
              Place p{static_cast<std::size_t>(2 * i), static_cast<std::size_t>(2 * j),
                      static_cast<std::size_t>(2 * k)};
              p[static_cast<std::size_t>(b)] += quarter % 2;
              p[static_cast<std::size_t>(c)] += quarter / 2;
              share += area_along(wet_polygon(axis, p), axis) / full;
            }
            if (share < negligible) share = 0;
            if (share > 1 - negligible) share = 1;
            shares[static_cast<std::size_t>(stencil_.face(axis, i, j, k))] = share;
          }
        }
      }
    }
  }

  // One eighth of a cell, between eight lattice points.
  void cut_part(const Place& low, Body& body, CutSurface& surface) const {
    Place high = low;
    for (std::size_t& h : high) ++h;
    body.apex = 0.5 * (position(low) + position(high));
    std::array<std::pair<Vec3, Vec3>, 24> segments;
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool upper : {false, true}) {
        Place p = low;
        if (upper) ++p[static_cast<std::size_t>(axis)];
        const Polygon polygon = wet_polygon(axis, p);
        // Outwards is along the axis on the upper side, against it on the lower one.
        for (int i = 1; i + 1 < polygon.count; ++i) {
          body.add(polygon[0], polygon[upper ? i : i + 1], polygon[upper ? i + 1 : i]);
        }
        // The surface's triangles run against the faces' sides.
        for (int i = 0; i < polygon.count; ++i) {
          if (!polygon.along_surface[static_cast<std::size_t>(i)]) continue;
          auto& segment = segments[count++];
          segment = {polygon[i + 1], polygon[i]};
          if (!upper) std::swap(segment.first, segment.second);
        }
      }
    }
    if (count == 0) return;
    Vec3 middle{};
    for (std::size_t s = 0; s < count; ++s) middle += segments[s].first + segments[s].second;
    middle = (0.5 / static_cast<Real>(count)) * middle;
    Vec3 total{};
    for (std::size_t s = 0; s < count; ++s) {
      const auto& [from, to] = segments[s];
      body.add(middle, from, to);
      const Vec3 area = 0.5 * cross(from - middle, to - middle);
      total += area;
      surface.moment += (norm(area) / 3) * (middle + from + to);
    }
    surface.area_vector += total;
    surface.area += norm(total);
  }

  bool is_whole(const Place& low) const {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i) {
          if (!wet({low[0] + i, low[1] + j, low[2] + k})) return false;
        }
      }
    }
    return true;
  }

  bool is_dry(const Place& low) const {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i) {
          if (wet({low[0] + i, low[1] + j, low[2] + k})) return false;
        }
      }
    }
    return true;
  }

  // Which surface the edges between wet and dry points within a cell belong to.
  void vote(const Place& low, CutSurface& surface) const {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t i = 0; i < 3; ++i) {
          const Place p{low[0] + i, low[1] + j, low[2] + k};
          for (int axis = 0; axis < 3; ++axis) {
            Place q = p;
            ++q[static_cast<std::size_t>(axis)];
            if (q[static_cast<std::size_t>(axis)] > low[static_cast<std::size_t>(axis)] + 2 ||
                wet(p) == wet(q))
              continue;
            const SurfaceLattice::Crossing* crossing = lattice_.crossing(axis, number(p));
            if (crossing != nullptr) ++surface.votes[crossing->surface];
          }
        }
      }
    }
  }

  void cut_all_cells() {
    const Index3 n = stencil_.n;
    result_.open.assign(static_cast<std::size_t>(stencil_.cells()), 0);
    for (Index k = 0; k < n.z; ++k) {
      for (Index j = 0; j < n.y; ++j) {
        for (Index i = 0; i < n.x; ++i) {
          const Index c = stencil_.cell(i, j, k);
          const Place low{static_cast<std::size_t>(2 * i), static_cast<std::size_t>(2 * j),
                          static_cast<std::size_t>(2 * k)};
          if (is_dry(low)) continue;
          result_.open[static_cast<std::size_t>(c)] = 1;
          if (!is_whole(low)) cut_cell(c, {i, j, k}, low);
        }
      }
    }
  }

  void cut_cell(Index c, const Index3& at, const Place& low) {
    CutSurface surface;
    Real volume = 0;
    Vec3 moment{};
    for (std::size_t part = 0; part < 8; ++part) {
      Body body;
      cut_part({low[0] + (part & 1), low[1] + ((part >> 1) & 1), low[2] + (part >> 2)}, body, surface);
      volume += body.volume;
      moment += body.moment;
    }
    vote(low, surface);
    PartCell cell;
    cell.cell = c;
    cell.open_share = volume / grid_.volume(at.x, at.y, at.z);
    const Vec3 centre{grid_.center(0, at.x), grid_.center(1, at.y), grid_.center(2, at.z)};
    cell.centroid = volume > 0 ? (1 / volume) * moment : centre;
    result_.parts.push_back(cell);
    if (!(surface.area > 0)) return;
    SurfacePiece piece;
    piece.cell = c;
    piece.area = surface.area;
    piece.point = (1 / surface.area) * surface.moment;
    const Real length = norm(surface.area_vector);
    const Real width = smallest_width(at);
    // Where a cell's surfaces face each other their normals cancel; the distance is then that of a quarter cell.
    const bool one_sided = length > 0.1 * surface.area;
    if (length > 0) piece.normal = (-1 / length) * surface.area_vector;
    piece.distance = one_sided ? std::abs(dot(cell.centroid - piece.point, piece.normal)) : 0.25 * width;
    piece.distance = std::max(piece.distance, 1e-3 * width);
    int most = 0;
    for (const auto& [number, count] : surface.votes) {
      if (count > most) most = count, piece.surface = number;
    }
    result_.pieces.push_back(piece);
  }

  Real smallest_width(const Index3& at) const {
    return std::min({grid_.width(0, at.x), grid_.width(1, at.y), grid_.width(2, at.z)});
  }

  // Faces between two cells whose centres the gas reaches, but not from one to the other. One after the other: each adds
  // to the list of pieces.
  void close_thin_surfaces() {
    for (int axis = 0; axis < 3; ++axis) {
      for (Index p = 0; p < stencil_.cells(); ++p) close_thin_surface(axis, p);
      copy_first_shares(axis);
    }
  }

  // The face on the minus side of cell p, if it has a cell on both sides.
  void close_thin_surface(int axis, Index p) {
    const auto a = static_cast<std::size_t>(axis);
    const Index3 beyond = grid_.coordinates(p);
    if (beyond[axis] == 0 && !stencil_.periodic[a]) return;
    Index3 at = beyond;
    at[axis] = (beyond[axis] == 0 ? stencil_.n[axis] : beyond[axis]) - 1;
    Place from{}, to{};
    for (std::size_t d = 0; d < 3; ++d) {
      from[d] = entry(2 * at[static_cast<int>(d)] + 1);
      to[d] = entry(2 * beyond[static_cast<int>(d)] + 1);
    }
    Place face = to;
    --face[a];
    const SurfaceLattice::Crossing* near = lattice_.crossing(axis, number(from));
    const SurfaceLattice::Crossing* far = lattice_.crossing(axis, number(face));
    if ((near == nullptr && far == nullptr) || !wet(from) || !wet(to)) return;
    const Index f = stencil_.face(axis, beyond.x, beyond.y, beyond.z);
    auto& share = result_.open_share[a][static_cast<std::size_t>(f)];
    if (share == 0) return;
    share = 0;
    const Index m = stencil_.cell(at.x, at.y, at.z);
    add_thin_piece(axis, m, at, near, far, 1, p);
    add_thin_piece(axis, p, beyond, near, far, -1, m);
  }

  // The side of a thin surface that a cell sees: towards +axis (sense 1) or -axis.
  void add_thin_piece(int axis, Index c, const Index3& at, const SurfaceLattice::Crossing* near,
                      const SurfaceLattice::Crossing* far, Real sense, Index other) {
    const Real half = 0.5 * grid_.width(axis, at[axis]);
    const SurfaceLattice::Crossing* seen =
        sense > 0 ? (near != nullptr ? near : far) : (far != nullptr ? far : near);
    // From the centre; beyond the face the other cell's half begins.
    const Real other_half = 0.5 * grid_.width(axis, grid_.coordinates(other)[axis]);
    Real away = 0;
    if (sense > 0) {
      away = near != nullptr ? near->first * half : half + far->first * other_half;
    } else {
      away = far != nullptr ? (1 - far->last) * half : half + (1 - near->last) * other_half;
    }
    SurfacePiece piece;
    piece.cell = c;
    piece.surface = seen->surface;
    piece.beyond = other;
    const Real along = seen->normal[axis];
    piece.normal = along * sense > 0 ? -seen->normal : seen->normal;
    piece.point = {grid_.center(0, at.x), grid_.center(1, at.y), grid_.center(2, at.z)};
    piece.point[axis] += sense * away;
    const int b = (axis + 1) % 3;
    const int c2 = (axis + 2) % 3;
    // A tilted surface closes faces across several axes; their areas times |n| add up to its own.
    piece.area = grid_.width(b, at[b]) * grid_.width(c2, at[c2]) * std::abs(along);
    // The gas of the cell reaches from the surface to the centre and beyond: in the middle, no nearer than a quarter.
    piece.distance = std::max(std::min(away, half) * std::abs(along), 0.5 * half);
    result_.pieces.push_back(piece);
    ++result_.closed_faces;
  }

  // Gives the last face of a periodic axis the share of the first.
  void copy_first_shares(int axis) {
    const auto a = static_cast<std::size_t>(axis);
    if (!stencil_.periodic[a]) return;
    auto& share = result_.open_share[a];
    Index3 n = stencil_.n;
    n[axis] = 1;
    for (Index k = 0; k < n.z; ++k) {
      for (Index j = 0; j < n.y; ++j) {
        for (Index i = 0; i < n.x; ++i) {
          const Index first = stencil_.face(axis, i, j, k);
          const Index last = first + stencil_.n[axis] * stencil_.face_step(axis);
          share[static_cast<std::size_t>(last)] = share[static_cast<std::size_t>(first)];
        }
      }
    }
  }

  void leave_out_small_cells() {
    for (const PartCell& part : result_.parts) {
      if (part.open_share < smallest_open_share) result_.open[static_cast<std::size_t>(part.cell)] = 0;
    }
  }

  // Calls f(cell beyond, open area [m2]) for the open faces of a cell that lead to another cell.
  template <class F>
  void for_open_faces(Index c, F&& f) const {
    const Index3 at = grid_.coordinates(c);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const Index minus = stencil_.face(axis, at.x, at.y, at.z);
      for (const bool upper : {false, true}) {
        const Index face = minus + (upper ? stencil_.face_step(axis) : 0);
        const Real share = result_.open_share[a][entry(face)];
        if (share == 0) continue;
        Index3 to = at;
        to[axis] += upper ? 1 : -1;
        if (to[axis] < 0 || to[axis] >= stencil_.n[axis]) {
          if (!stencil_.periodic[a]) continue;
          to[axis] = upper ? 0 : stencil_.n[axis] - 1;
        }
        f(stencil_.cell(to.x, to.y, to.z),
          share * grid_.volume(at.x, at.y, at.z) / grid_.width(axis, at[axis]));
      }
    }
  }

  // Of cells that no open face joins to the rest, only the largest group stays.
  void keep_connected() {
    const auto n = static_cast<std::size_t>(stencil_.cells());
    std::vector<std::int32_t> group(n, -1);
    std::vector<Index> sizes;
    std::vector<Index> stack;
    for (std::size_t start = 0; start < n; ++start) {
      if (result_.open[start] == 0 || group[start] >= 0) continue;
      const auto own = static_cast<std::int32_t>(sizes.size());
      sizes.push_back(0);
      group[start] = own;
      stack.push_back(static_cast<Index>(start));
      while (!stack.empty()) {
        const Index c = stack.back();
        stack.pop_back();
        ++sizes.back();
        for_open_faces(c, [&](Index to, Real) {
          const auto t = static_cast<std::size_t>(to);
          if (result_.open[t] == 0 || group[t] >= 0) return;
          group[t] = own;
          stack.push_back(to);
        });
      }
    }
    const auto largest = std::max_element(sizes.begin(), sizes.end());
    for (std::size_t c = 0; c < n; ++c) {
      if (group[c] != static_cast<std::int32_t>(largest - sizes.begin())) result_.open[c] = 0;
      result_.open_cells += result_.open[c];
    }
  }

  // A cell left out is a sliver of gas at a wall, most of all at one that lies on a plane of the grid. Its wall then is
  // that of the cells that its open faces led to.
  void hand_over_pieces_of_closed_cells() {
    std::map<Index, std::size_t> piece_in;  // of an open cell, not of a thin surface
    std::vector<SurfacePiece> left_over;
    for (std::size_t s = 0; s < result_.pieces.size(); ++s) {
      const SurfacePiece& piece = result_.pieces[s];
      if (piece.beyond >= 0) continue;
      if (result_.open[entry(piece.cell)] == 0) {
        left_over.push_back(piece);
      } else {
        piece_in.emplace(piece.cell, s);
      }
    }
    std::map<Index, Vec3> centroid_of;
    for (const PartCell& part : result_.parts) centroid_of.emplace(part.cell, part.centroid);
    for (const SurfacePiece& piece : left_over) {
      Real all = 0;
      for_open_faces(piece.cell, [&](Index to, Real area) { all += is_open(to) ? area : 0; });
      for_open_faces(piece.cell, [&](Index to, Real area) {
        if (!is_open(to)) return;
        SurfacePiece given = piece;
        given.cell = to;
        given.area *= area / all;
        const auto held = piece_in.find(to);
        if (held != piece_in.end() && result_.pieces[held->second].surface == given.surface) {
          join(result_.pieces[held->second], given);
          return;
        }
        const Index3 at = grid_.coordinates(to);
        const auto part = centroid_of.find(to);
        const Vec3 gas = part != centroid_of.end()
                             ? part->second
                             : Vec3{grid_.center(0, at.x), grid_.center(1, at.y), grid_.center(2, at.z)};
        given.distance = std::max(std::abs(dot(gas - given.point, given.normal)), 1e-3 * smallest_width(at));
        piece_in.emplace(to, result_.pieces.size());
        result_.pieces.push_back(given);
      });
    }
  }

  bool is_open(Index c) const { return result_.open[entry(c)] != 0; }

  // One piece of both, as far from the gas as the first.
  static void join(SurfacePiece& held, const SurfacePiece& added) {
    const Vec3 vector = held.area * held.normal + added.area * added.normal;
    const Real area = held.area + added.area;
    held.point = (1 / area) * (held.area * held.point + added.area * added.point);
    if (norm(vector) > 0) held.normal = (1 / norm(vector)) * vector;
    held.area = area;
  }

  void close_faces_of_closed_cells() {
    for (Index c = 0; c < stencil_.cells(); ++c) {
      if (result_.open[static_cast<std::size_t>(c)] != 0) continue;
      const Index3 at = grid_.coordinates(c);
      for (int axis = 0; axis < 3; ++axis) {
        auto& share = result_.open_share[static_cast<std::size_t>(axis)];
        const Index minus = stencil_.face(axis, at.x, at.y, at.z);
        share[entry(minus)] = 0;
        share[entry(minus + stencil_.face_step(axis))] = 0;
        if (!stencil_.periodic[static_cast<std::size_t>(axis)]) continue;
        const Index around = (stencil_.n[axis] - at[axis]) * stencil_.face_step(axis);
        if (at[axis] == 0) share[entry(minus + around)] = 0;
        if (at[axis] == stencil_.n[axis] - 1) {
          share[entry(minus - at[axis] * stencil_.face_step(axis))] = 0;
        }
      }
    }
  }

  void collect() {
    const auto closed = [&](const auto& part) {
      return result_.open[static_cast<std::size_t>(part.cell)] == 0;
    };
    std::erase_if(result_.parts, closed);
    std::erase_if(result_.pieces, closed);
    std::stable_sort(result_.pieces.begin(), result_.pieces.end(),
                     [](const SurfacePiece& a, const SurfacePiece& b) { return a.cell < b.cell; });
    result_.closed_faces /= 2;
  }

  const CartesianGrid& grid_;
  SurfaceLattice lattice_;
  Stencil stencil_;
  CutCells result_;
};

}  // namespace

CutCells cut_cells(const CartesianGrid& grid, const std::vector<ImmersedSurface>& surfaces,
                   const Vec3& seed) {
  return Cutter(grid, surfaces, seed).cut();
}

std::vector<int> group_points(const CartesianGrid& grid, const std::vector<ImmersedSurface>& surfaces,
                              const std::vector<Vec3>& points) {
  constexpr int unknown = -2;
  std::vector<int> groups(points.size(), unknown);
  const SurfaceLattice dry(grid, surfaces);
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (groups[i] != unknown) continue;
    SurfaceLattice lattice = dry;
    if (!lattice.wet_from(points[i])) {
      groups[i] = -1;
      continue;
    }
    for (std::size_t j = i; j < points.size(); ++j) {
      if (groups[j] == unknown && (j == i || lattice.gas_reaches(points[j]))) groups[j] = count;
    }
    ++count;
  }
  return groups;
}

}  // namespace pellicle::cfd
