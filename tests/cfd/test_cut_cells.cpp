// Open volumes and areas of cut cells against the bodies' closed forms, and the closure of every cut cell.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "cfd/cut_cells.hpp"
#include "cfd/stencil.hpp"

namespace pellicle::cfd {
namespace {

constexpr Real pi = std::numbers::pi;

ImmersedSurface make_surface(SurfaceShape shape, std::string name = "wall") {
  return {std::move(name), {std::move(shape)}, {}, {}, {}};
}

Stencil stencil_of(const CartesianGrid& grid) {
  Stencil s;
  s.n = grid.cells();
  for (int a = 0; a < 3; ++a) s.periodic[static_cast<std::size_t>(a)] = grid.periodic(a);
  return s;
}

Real open_volume(const CartesianGrid& grid, const CutCells& cut) {
  Real total = 0;
  std::vector<Real> share(cut.open.begin(), cut.open.end());
  for (const PartCell& part : cut.parts) share[static_cast<std::size_t>(part.cell)] = part.open_share;
  for (std::size_t c = 0; c < share.size(); ++c) {
    const Index3 at = grid.coordinates(static_cast<Index>(c));
    total += share[c] * grid.volume(at.x, at.y, at.z);
  }
  return total;
}

Real surface_area(const CutCells& cut) {
  Real total = 0;
  for (const SurfacePiece& piece : cut.pieces) total += piece.area;
  return total;
}

// Open area of all faces across an axis at one position.
Real section(const CartesianGrid& grid, const CutCells& cut, int axis, Index position) {
  const Stencil s = stencil_of(grid);
  const int b = (axis + 1) % 3;
  const int c = (axis + 2) % 3;
  Real total = 0;
  for (Index j = 0; j < s.n[b]; ++j) {
    for (Index k = 0; k < s.n[c]; ++k) {
      Index3 at{};
      at[axis] = position;
      at[b] = j;
      at[c] = k;
      total += cut.open_share[static_cast<std::size_t>(axis)]
                             [static_cast<std::size_t>(s.face(axis, at.x, at.y, at.z))] *
               grid.width(b, j) * grid.width(c, k);
    }
  }
  return total;
}

// The surface's area vector in each cell from the open areas of its faces, less the pieces' own: where one surface cuts
// a cell, and the cell has one piece, they must agree.
void expect_closed_cells(const CartesianGrid& grid, const CutCells& cut) {
  const Stencil s = stencil_of(grid);
  for (const SurfacePiece& piece : cut.pieces) {
    const Index3 at = grid.coordinates(piece.cell);
    Vec3 total{};
    Real largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& share = cut.open_share[static_cast<std::size_t>(axis)];
      const Index minus = s.face(axis, at.x, at.y, at.z);
      const Real full = grid.volume(at.x, at.y, at.z) / grid.width(axis, at[axis]);
      const Index plus = minus + s.face_step(axis);
      total[axis] = full * (share[static_cast<std::size_t>(plus)] - share[static_cast<std::size_t>(minus)]);
      largest = std::max(largest, full);
    }
    // A neighbour that was left out as too small closes what it shared: of a corner of 1e-3 of the volume about
    // (6e-3)^(2/3) / 2 = 1.7 % of a face, of a wedge (2e-3)^(1/2) = 4.5 %, and there may be two. A curved piece is larger than its vector.
    EXPECT_LE(norm(total), piece.area + 0.08 * largest);
    EXPECT_NEAR(norm(total - piece.area * piece.normal), 0, 0.2 * piece.area + 0.08 * largest)
        << at.x << ' ' << at.y << ' ' << at.z;
  }
}

// A plane is straight already: shares are exact but for the trifle that crossings are looked for beside the points, and
// for the cells left out, of which each has less than 1e-3 of a cell's volume and a few per cent of a face's area.
TEST(CutCells, TiltedPlaneIsExact) {
  const CartesianGrid grid(Box{{0, 0, 0}, {1, 1, 1}}, {7, 6, 5});
  const Vec3 normal = (1 / std::sqrt(14.0)) * Vec3{1, 2, 3};
  const Real offset = dot(normal, Vec3{0.5, 0.5, 0.5});
  const CutCells cut = cut_cells(grid, {make_surface(PlaneSurface{normal, offset})}, {0.9, 0.9, 0.9});
  EXPECT_NEAR(open_volume(grid, cut), 0.5, 2e-5);  // by symmetry about the middle
  // The plane x + 2 y + 3 z = 3 within the unit cube: its shadow along z, where 0 <= 3 - x - 2 y <= 3, is all but the
  // triangle x + 2 y < 0 and x + 2 y > 3, which do not reach into the square: 1. Times |n| / n_z.
  EXPECT_NEAR(surface_area(cut), std::sqrt(14.0) / 3, 2e-3);
  expect_closed_cells(grid, cut);
  for (const SurfacePiece& piece : cut.pieces) {
    EXPECT_NEAR(norm(piece.normal - normal), 0, 1e-5);
    EXPECT_NEAR(dot(normal, piece.point), offset, 1e-6);
    EXPECT_GT(piece.distance, 0);
  }
  // The other seed, the other side.
  const CutCells other = cut_cells(grid, {make_surface(PlaneSurface{normal, offset})}, {0.1, 0.1, 0.1});
  EXPECT_NEAR(open_volume(grid, other), 0.5, 2e-5);
  EXPECT_NEAR(norm(other.pieces.front().normal + normal), 0, 1e-5);
}

// Outside a cylinder across the domain: chords between lattice points half a cell apart take h^2 / 12 R of its radius on
// average, h = 1/24 here: 0.3 % of what is cut off.
TEST(CutCells, CylinderConvergesInSecondOrder) {
  const Real radius = 0.3;
  Real before = 0;
  for (const Index n : {8, 16, 32}) {
    const CartesianGrid grid(Box{{0, 0, 0}, {1, 1, 0.25}}, {n, n, 2});
    const RevolvedSurface cylinder{{0.51, 0.48, -1}, {0, 0, 1}, radius, 0, radius, 3};
    const CutCells cut = cut_cells(grid, {make_surface(cylinder)}, {0.01, 0.01, 0.1});
    const Real volume_error = std::abs(open_volume(grid, cut) - 0.25 * (1 - pi * radius * radius));
    const Real area_error = std::abs(surface_area(cut) - 0.25 * 2 * pi * radius);
    const Real h = 0.5 / n;
    // Between points of a circle the chord is short by s^2 / 12 R on average over s, and s <= sqrt(2) h.
    EXPECT_LT(volume_error, 0.25 * 2 * pi * radius * h * h / (6 * radius));
    // 0.5 % beside that for cells left out.
    EXPECT_LT(area_error, 0.25 * 2 * pi * radius * (h * h / (12 * radius * radius) + 0.005));
    if (before > 0) {
      EXPECT_GT(before / volume_error, 3.0);
    }
    before = volume_error;
    EXPECT_NEAR(section(grid, cut, 2, 0), 1 - pi * radius * radius, 2 * pi * h * h);
    expect_closed_cells(grid, cut);
  }
}

// Inside a cone frustum: the section at each height is that of a circle.
TEST(CutCells, InsideOfACone) {
  const CartesianGrid grid(Box{{-1, -1, 0}, {1, 1, 1}}, {20, 20, 8});
  const RevolvedSurface cone{{0, 0, 0}, {0, 0, 1}, 0.4, -0.1, 0.9, 1.1};
  const CutCells cut = cut_cells(grid, {make_surface(cone)}, {0, 0, 0.01});
  for (Index k = 0; k <= 8; ++k) {
    const Real r = 0.4 + 0.5 * (k / 8.0 + 0.1) / 1.2;
    EXPECT_NEAR(section(grid, cut, 2, k), pi * r * r, 0.003 * pi * r * r) << k;
  }
  EXPECT_EQ(cut.closed_faces, 0);
  expect_closed_cells(grid, cut);
  for (const SurfacePiece& piece : cut.pieces) {
    const Vec3 inward = (1 / std::hypot(1.0, 0.5 / 1.2)) *
                        Vec3{-piece.point.x / std::hypot(piece.point.x, piece.point.y),
                             -piece.point.y / std::hypot(piece.point.x, piece.point.y), 0.5 / 1.2};
    EXPECT_GT(dot(piece.normal, inward), 0.97);
  }
}

// A thin tube with gas on both sides closes faces and leaves every cell whole; nothing leads from inside to outside.
TEST(CutCells, ThinTubeClosesFaces) {
  const CartesianGrid grid(Box{{-1, -1, 0}, {1, 1, 1}}, {20, 20, 10});
  const RevolvedSurface tube{{0, 0, 0}, {0, 0, 1}, 0.5, 0.2, 0.5, 0.8};
  const CutCells cut = cut_cells(grid, {make_surface(tube)}, {0, 0, 0.01});
  EXPECT_EQ(cut.open_cells, 20 * 20 * 10);
  EXPECT_TRUE(cut.parts.empty());
  EXPECT_NEAR(open_volume(grid, cut), 4, 1e-12);
  // Both sides of the tube. Areas times |n| sum to its own: over rows at y = 0.05 ... 0.45 of h sqrt(1 - 4 y^2), which is
  // 1 % more than the integral.
  EXPECT_NEAR(surface_area(cut), 2 * 2 * pi * 0.5 * 0.6, 0.02 * 2 * pi * 0.6);
  for (const SurfacePiece& piece : cut.pieces) {
    const Index3 at = grid.coordinates(piece.cell);
    const Index3 beyond = grid.coordinates(piece.beyond);
    EXPECT_EQ(std::abs(at.x - beyond.x) + std::abs(at.y - beyond.y) + std::abs(at.z - beyond.z), 1);
    const bool inside = std::hypot(grid.center(0, at.x), grid.center(1, at.y)) < 0.5;
    EXPECT_EQ(dot(piece.normal, piece.point) < 0, inside);
    EXPECT_NEAR(std::hypot(piece.point.x, piece.point.y), 0.5,
                1e-6);  // crossings are found 1e-7 of a cell aside
  }
  const Stencil s = stencil_of(grid);
  for (Index j = 0; j < 20; ++j) {
    for (Index i = 1; i < 20; ++i) {
      const auto inside = [&](Index at) { return std::hypot(grid.center(0, at), grid.center(1, j)) < 0.5; };
      const Real share = cut.open_share[0][static_cast<std::size_t>(s.face(0, i, j, 5))];
      EXPECT_EQ(share, inside(i - 1) == inside(i) ? 1 : 0) << i << ' ' << j;
      EXPECT_EQ(cut.open_share[0][static_cast<std::size_t>(s.face(0, i, j, 1))], 1);
    }
  }
}

// Walls that lie on grid planes, and a seed beside them.
TEST(CutCells, SurfacesOnGridPlanes) {
  const CartesianGrid grid(Box{{0, 0, 0}, {1, 1, 1}}, {4, 4, 4});
  const CutCells cut =
      cut_cells(grid, {make_surface(BoxSurface{{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}})}, {0.1, 0.1, 0.1});
  EXPECT_NEAR(open_volume(grid, cut), 1 - 0.125, 1e-5);
  EXPECT_EQ(cut.open_cells, 64 - 8);
  // A box as large as the domain closes none of its sides.
  const CutCells whole = cut_cells(grid, {make_surface(BoxSurface{{0, 0, 0}, {1, 1, 1}})}, {0.5, 0.5, 0.5});
  EXPECT_NEAR(open_volume(grid, whole), 1, 1e-5);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(section(grid, whole, axis, 0), 1, 1e-5);
    EXPECT_NEAR(section(grid, whole, axis, 4), 1, 1e-5);
  }
}

// The sides of a block on grid planes, wherever these are: every cell beside it has the wall at half a cell's distance, with
// the normal into the gas, and the areas add up to the block's.
TEST(CutCells, BlockOnGridPlanesIsAWall) {
  const CartesianGrid grid(Box{{0, 0, 0}, {1, 1, 1}}, {8, 8, 8});
  constexpr Real h = 0.125;
  for (Index low = 1; low < 7; ++low) {
    const Real from = h * low, to = from + h;
    const CutCells cut = cut_cells(grid, {make_surface(BoxSurface{{-1, -1, from}, {2, 2, to}})},
                                   {0.4, 0.4, low > 3 ? 0.01 : 0.99});
    const bool above = low <= 3;
    Real area = 0;
    for (const SurfacePiece& piece : cut.pieces) {
      EXPECT_EQ(piece.cell / 64, above ? low + 1 : low - 1);
      EXPECT_NEAR(piece.normal.z, above ? 1 : -1, 1e-6);
      EXPECT_NEAR(piece.distance, 0.5 * h, 1e-6);
      EXPECT_NEAR(piece.point.z, above ? to : from, 1e-6);
      area += piece.area;
    }
    EXPECT_NEAR(area, 1, 1e-5) << "block from " << from;
    EXPECT_EQ(cut.pieces.size(), 64u);
    EXPECT_NEAR(open_volume(grid, cut), above ? 1 - to : from, 1e-5);
  }
}

// A mesh is cut as the shape it approximates.
TEST(CutCells, MeshOfABoxIsTheBox) {
  const Vec3 lo{0.13, 0.21, 0.17};
  const Vec3 hi{0.71, 0.83, 0.69};
  auto corners = std::make_shared<std::vector<Vec3>>();
  for (int i = 0; i < 8; ++i) {
    corners->push_back({(i & 1) ? hi.x : lo.x, (i & 2) ? hi.y : lo.y, (i & 4) ? hi.z : lo.z});
  }
  auto triangles = std::make_shared<std::vector<std::array<std::int32_t, 3>>>();
  for (const std::array<std::int32_t, 4>& q : std::vector<std::array<std::int32_t, 4>>{
           {0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}) {
    triangles->push_back({q[0], q[1], q[2]});
    triangles->push_back({q[0], q[2], q[3]});
  }
  const CartesianGrid grid(Box{{0, 0, 0}, {1, 1, 1}}, {6, 5, 7});
  const CutCells mesh = cut_cells(grid, {make_surface(MeshSurface{corners, triangles})}, {0.5, 0.5, 0.5});
  const CutCells box = cut_cells(grid, {make_surface(BoxSurface{lo, hi})}, {0.5, 0.5, 0.5});
  ASSERT_EQ(mesh.parts.size(), box.parts.size());
  EXPECT_NEAR(open_volume(grid, mesh), open_volume(grid, box), 1e-7);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t f = 0; f < mesh.open_share[a].size(); ++f)
      EXPECT_NEAR(mesh.open_share[a][f], box.open_share[a][f], 1e-6);
  }
}

TEST(CutCells, SeedOnAWallIsRefused) {
  const CartesianGrid grid(Box{{0, 0, 0}, {1, 1, 1}}, {4, 4, 4});
  std::vector<SurfaceShape> shapes;
  // A box far smaller than a cell around the seed.
  const ImmersedSurface surface = make_surface(BoxSurface{{0.09, 0.09, 0.09}, {0.11, 0.11, 0.11}});
  EXPECT_THROW(cut_cells(grid, {surface}, {0.1, 0.1, 0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace pellicle::cfd
