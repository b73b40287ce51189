// Flow through planes and means over them.
#include "tools/pellicle/plane_section.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

using namespace pellicle;
using namespace pellicle::tools;

namespace {

PlaneProbeSpec across(int axis, Real at) {
  PlaneProbeSpec spec;
  spec.axis = axis;
  spec.at = at;
  return spec;
}

const Box box{{0, 0, 0}, {1, 2, 3}};

/// A gas whose flux per area and whose fields are functions of the place, linear along the axis.
struct Gas {
  CartesianGrid grid;
  HostArray<Vec3> velocity;
  HostArray<Real> pressure, void_fraction, density;
  std::array<HostArray<Real>, 3> flux, area;
  GasFields fields;

  explicit Gas(const CartesianGrid& g) : grid(g) {
    const auto n = static_cast<std::size_t>(grid.cell_count());
    velocity = HostArray<Vec3>("test::velocity", n);
    pressure = HostArray<Real>("test::pressure", n);
    void_fraction = HostArray<Real>("test::void_fraction", n);
    density = HostArray<Real>("test::density", n);
    Kokkos::deep_copy(void_fraction, 1.0);
    Kokkos::deep_copy(density, 1.2);
    for (int a = 0; a < 3; ++a) {
      const Index3 c = grid.cells();
      const auto faces = std::size_t(grid.cell_count()) / std::size_t(c[a]) * std::size_t(c[a] + 1);
      flux[static_cast<std::size_t>(a)] = HostArray<Real>("test::flux", faces);
      area[static_cast<std::size_t>(a)] = HostArray<Real>("test::area", faces);
    }
    fields.grid = &grid;
  }

  /// per_area(place of the face), p(place of the cell).
  template <class PerArea, class Pressure>
  void set(int axis, PerArea&& per_area, Pressure&& p) {
    const auto a = static_cast<std::size_t>(axis);
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    Index3 size = grid.cells();
    ++size[axis];
    for (Index k = 0; k < size.z; ++k) {
      for (Index j = 0; j < size.y; ++j) {
        for (Index i = 0; i < size.x; ++i) {
          const Index3 at{i, j, k};
          const auto f = i + size.x * (j + size.y * k);
          Vec3 place;
          place[axis] = grid.faces(axis)[static_cast<std::size_t>(at[axis])];
          place[b] = grid.center(b, at[b]);
          place[c] = grid.center(c, at[c]);
          area[a](f) = grid.width(b, at[b]) * grid.width(c, at[c]);
          flux[a](f) = area[a](f) * per_area(place);
        }
      }
    }
    for (Index cell = 0; cell < grid.cell_count(); ++cell) {
      const Index3 at = grid.coordinates(cell);
      pressure(cell) = p(Vec3{grid.center(0, at.x), grid.center(1, at.y), grid.center(2, at.z)});
    }
    fields.velocity = velocity;
    fields.pressure = pressure;
    fields.void_fraction = void_fraction;
    fields.density = density;
    for (std::size_t d = 0; d < 3; ++d) {
      fields.volume_flux[d] = flux[d];
      fields.open_area[d] = area[d];
    }
  }
};

constexpr int pressure_quantity = 7;  // of gas_quantities

CartesianGrid stretched() {
  return CartesianGrid({{{0, 0.2, 0.5, 1}, {0, 0.3, 1, 1.2, 2}, {0, 0.5, 0.7, 1.9, 3}}},
                       {false, false, false});
}

}  // namespace

// A flux that grows linearly along the axis and a pressure linear in all directions: exact at any plane, on any grid, for
// each axis.
TEST(PlaneSection, LinearFieldsAreExact) {
  for (int axis = 0; axis < 3; ++axis) {
    Gas gas(stretched());
    const auto per_area = [&](const Vec3& x) { return 2 + 3 * x[axis]; };
    gas.set(axis, per_area, [](const Vec3& x) { return 100 + 5 * x.x - 7 * x.y + 11 * x.z; });
    const Vec3 size = box.max;
    const Real area = size.x * size.y * size.z / size[axis];
    const Real first = gas.grid.center(axis, 0);
    const Real last = gas.grid.center(axis, gas.grid.cells()[axis] - 1);
    for (const Real at : {first, 0.31 * size[axis], 0.5 * size[axis], last}) {
      const PlaneSection plane(across(axis, at), gas.grid);
      EXPECT_NEAR(plane.open_area(gas.fields), area, 1e-12);
      EXPECT_NEAR(plane.volume_flow(gas.fields), area * (2 + 3 * at), 1e-12);
      EXPECT_NEAR(plane.quantity(gas.fields, 1), 1.2 * area * (2 + 3 * at), 1e-12);
      Vec3 middle = 0.5 * size;
      middle[axis] = at;
      EXPECT_NEAR(plane.mean(gas.fields, pressure_quantity),
                  100 + 5 * middle.x - 7 * middle.y + 11 * middle.z, 1e-10);
    }
    // On the sides the pressure is that of the cell.
    const PlaneSection side(across(axis, size[axis]), gas.grid);
    EXPECT_NEAR(side.volume_flow(gas.fields), area * (2 + 3 * size[axis]), 1e-12);
    Vec3 middle = 0.5 * size;
    middle[axis] = last;
    EXPECT_NEAR(side.mean(gas.fields, pressure_quantity), 100 + 5 * middle.x - 7 * middle.y + 11 * middle.z,
                1e-10);
  }
}

TEST(PlaneSection, PartsOfAPlane) {
  Gas gas(stretched());
  gas.set(
      2, [](const Vec3&) { return 2.0; }, [](const Vec3&) { return 9.0; });
  PlaneProbeSpec spec = across(2, 1);
  spec.box = Box{{0.1, 0.25, 0}, {0.6, 5, 0}};  // cuts cells, and reaches beyond the domain
  const PlaneSection part(spec, gas.grid);
  EXPECT_NEAR(part.open_area(gas.fields), 0.5 * 1.75, 1e-14);
  EXPECT_NEAR(part.volume_flow(gas.fields), 2 * 0.5 * 1.75, 1e-14);
  spec.box.reset();
  spec.disc = PlaneProbeSpec::Disc{{0.5, 1, 77}, 0.4};
  EXPECT_NEAR(PlaneSection(spec, gas.grid).open_area(gas.fields), M_PI * 0.16, 1e-14);
  spec.disc->centre = {0, 0, 0};  // a quarter is in the domain
  EXPECT_NEAR(PlaneSection(spec, gas.grid).volume_flow(gas.fields), 2 * M_PI * 0.04, 1e-14);
}

// Two streams past each other, 3 m/s up over a quarter of the area with 10 Pa, 1 m/s down over the rest with 2 Pa.
TEST(PlaneSection, MeansByAreaAndByFlow) {
  Gas gas(CartesianGrid(Box{{0, 0, 0}, {1, 1, 1}}, {4, 1, 3}));
  const auto up = [](const Vec3& x) { return x.x < 0.25; };
  gas.set(
      2, [&](const Vec3& x) { return up(x) ? 3.0 : -1.0; },
      [&](const Vec3& x) { return up(x) ? 10.0 : 2.0; });
  PlaneProbeSpec spec = across(2, 0.4);
  EXPECT_NEAR(PlaneSection(spec, gas.grid).mean(gas.fields, pressure_quantity), 0.25 * 10 + 0.75 * 2, 1e-14);
  spec.by_flow = true;
  EXPECT_NEAR(PlaneSection(spec, gas.grid).volume_flow(gas.fields), 0, 1e-14);
  spec.box = Box{{0, 0, 0}, {0.5, 1, 0}};  // (3 x 10 - 1 x 2) / (3 - 1)
  EXPECT_NEAR(PlaneSection(spec, gas.grid).mean(gas.fields, pressure_quantity), 14, 1e-13);
}

// A wall closes half of the faces above the plane: it counts neither as area, nor does the gas beyond it.
TEST(PlaneSection, ClosedFacesAreLeftOut) {
  Gas gas(CartesianGrid(Box{{0, 0, 0}, {1, 1, 1}}, {2, 1, 2}));
  gas.set(
      2, [](const Vec3&) { return 1.0; }, [](const Vec3& x) { return x.z < 0.5 ? 4.0 : 8.0; });
  gas.area[2](2) = 0;  // between the cells with x < 0.5
  gas.flux[2](2) = 0;
  const PlaneSection between(across(2, 0.5), gas.grid);
  EXPECT_NEAR(between.open_area(gas.fields), 0.5, 1e-14);
  EXPECT_NEAR(between.mean(gas.fields, pressure_quantity), 6, 1e-14);
  // Just below, the closed column is half open and has its own pressure, the other one nearly the middle of both.
  const PlaneSection below(across(2, 0.25 + 0.125), gas.grid);
  const Real closed = 0.5 * 0.25;  // a quarter of the area below is left
  EXPECT_NEAR(below.open_area(gas.fields), 0.5 + closed, 1e-14);
  EXPECT_NEAR(below.mean(gas.fields, pressure_quantity), (0.5 * 5 + closed * 4) / (0.5 + closed), 1e-14);
}
