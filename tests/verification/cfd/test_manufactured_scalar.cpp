// Order of convergence of a scalar by manufactured solutions on a flow that is given: the void fraction varies in space
// and time, the fluxes satisfy continuity to round-off.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "cfd/scalar_transport.hpp"
#include "tests/cfd/prescribed_flow.hpp"
#include "tests/verification/cfd/manufactured_flow.hpp"

namespace pellicle::cfd {
namespace {

constexpr Real density = 1.3;
constexpr Real capacity = 2.0;
constexpr Real conductivity = 0.04;
constexpr Real sink = 0.7;  ///< linear part of the source, taken implicitly [W/m3/K]

struct Carried {
  Setting setting;
  Wave across;  ///< value = across(a) + ripple.f(a) ripple.g(b) (1 + growth t)
  Product ripple;
  std::vector<ScalarBoundary> conditions;  ///< of the setting's patches
  Real growth = 0.5;

  Jet at(Real a, Real b, Real t) const {
    const Product mean{across, Wave{{{1, 0, 0}}}};
    return mean.jet(a, b) + (1 + growth * t) * ripple.jet(a, b);
  }
};

struct March {
  Convection scheme = Convection::central;
  bool stretched = false;
  Index cells = 16;
  Real dt = 0.02;
  int steps = 4;
  bool exact_in_time = true;  ///< see test_manufactured_flow.cpp
};

class Marcher {
 public:
  Marcher(const Carried& carried, const March& march)
      : carried_(carried),
        flow_(carried.setting.flow),
        march_(march),
        a_(carried.setting.plane[0]),
        b_(carried.setting.plane[1]),
        gas_(make_square(march.cells, carried.setting.plane, march.stretched, carried.setting.periodic),
             carried.setting.patches, density),
        scalar_("temperature", gas_.geometry, gas_.boundaries, carried.conditions, make_options(),
                march.scheme) {
    const std::size_t n = static_cast<std::size_t>(gas_.fields.cells);
    source_ = {HostArray<Real>("tests::manufactured::rate", n),
               HostArray<Real>("tests::manufactured::coefficient", n)};
    Kokkos::deep_copy(source_.coefficient, sink);
    HostArray<Real> initial("tests::manufactured::initial", n);
    set_void_fraction(gas_.fields.void_fraction, 0);
    for_cells([&](Index c, Real a, Real b) { initial(c) = carried_.at(a, b, 0).v; });
    scalar_.set_values(initial);
    scalar_.initialise(gas_.fields);
    for (int step = 0; step < march.steps; ++step) advance(step * march.dt);
  }

  Real error() const {
    const Real t = march_.steps * march_.dt;
    return deviation([&](Index, Real a, Real b) { return carried_.at(a, b, t).v; });
  }
  Real difference(const Marcher& other) const {
    return deviation([&](Index c, Real, Real) { return other.scalar_.value()(c); });
  }

 private:
  static ScalarOptions make_options() {
    ScalarOptions options;
    options.capacity = capacity;
    options.conductivity = conductivity;
    options.reference = 0.5;
    options.correction_tolerance = 1e-9;
    options.max_corrections = 100;
    return options;
  }

  template <class Visit>
  void for_cells(Visit&& visit) const {
    const CartesianGrid& grid = gas_.geometry.grid;
    for (Index c = 0; c < grid.cell_count(); ++c) {
      const Index3 at = grid.coordinates(c);
      visit(c, grid.center(a_, at[a_]), grid.center(b_, at[b_]));
    }
  }

  Real corner(int axis, Index i) const { return gas_.geometry.grid.faces(axis)[static_cast<std::size_t>(i)]; }

  void set_void_fraction(const HostArray<Real>& eps, Real t) const {
    for (Index c = 0; c < gas_.fields.cells; ++c) {
      const Index3 at = gas_.geometry.grid.coordinates(c);
      eps(c) = flow_.mean_void_fraction_of({corner(a_, at[a_]), corner(b_, at[b_])},
                                           {corner(a_, at[a_] + 1), corner(b_, at[b_] + 1)}, t);
    }
  }

  // Exact flows through the faces: differences of the stream function, and the swelling integrated along the face.
  void set_flow(Real t, Real rate) {
    const Real strength = 1 + flow_.growth * t;
    const auto stream = [&](Real a, Real b) { return strength * flow_.stream.jet(a, b).v; };
    gas_.set_flow([&](int axis, Index i, Index j, Index k) {
      if (axis != a_ && axis != b_) return 0.0;
      const Index3 at{i, j, k};
      const Real a0 = corner(a_, at[a_]);
      const Real b0 = corner(b_, at[b_]);
      if (axis == a_) {
        const Real b1 = corner(b_, at[b_] + 1);
        return stream(a0, b1) - stream(a0, b0) +
               rate * flow_.swell.f.derivative(1, a0) * flow_.swell.g.mean(0, b0, b1) * (b1 - b0);
      }
      const Real a1 = corner(a_, at[a_] + 1);
      return flow_.through * (a1 - a0) - (stream(a1, b0) - stream(a0, b0)) +
             rate * flow_.swell.g.derivative(1, b0) * flow_.swell.f.mean(0, a0, a1) * (a1 - a0);
    });
  }

  void advance(Real t_old) {
    const Real t = t_old + march_.dt;
    const Real rate = (flow_.s(t) - flow_.s(t_old)) / march_.dt;
    set_void_fraction(gas_.fields.void_fraction_old, t_old);
    set_void_fraction(gas_.fields.void_fraction, t);
    set_flow(t, rate);
    for_cells([&](Index c, Real a, Real b) {
      const auto now = flow_.at(a, b, t, rate);
      const auto old = flow_.at(a, b, t_old, rate);
      const Jet v = carried_.at(a, b, t);
      // eps dv/dt + U grad v: what is left when v times continuity is taken away.
      const Real slope = march_.exact_in_time ? (v.v - carried_.at(a, b, t_old).v) / march_.dt
                                              : carried_.growth * carried_.ripple.jet(a, b).v;
      const Real eps = march_.exact_in_time ? old.eps.v : now.eps.v;
      const auto [flow_a, flow_b] = march_.exact_in_time ? std::pair{now.a.v, now.b.v}
                                                         : std::pair{flow_.at(a, b, t, flow_.s_rate(t)).a.v,
                                                                     flow_.at(a, b, t, flow_.s_rate(t)).b.v};
      const Real convection = density * capacity * (eps * slope + flow_a * v.a + flow_b * v.b);
      const Real conduction = conductivity * (now.eps.a * v.a + now.eps.b * v.b + now.eps.v * (v.aa + v.bb));
      source_.rate(c) = convection - conduction + sink * v.v;
    });
    scalar_.update(gas_.fields, march_.dt, source_);
  }

  template <class Reference>
  Real deviation(Reference&& reference) const {
    Real volume = 0, square = 0;
    for_cells([&](Index c, Real a, Real b) {
      const Real d = scalar_.value()(c) - reference(c, a, b);
      volume += gas_.geometry.volume(c);
      square += gas_.geometry.volume(c) * d * d;
    });
    return std::sqrt(square / volume);
  }

  const Carried& carried_;
  const Flow& flow_;
  March march_;
  int a_, b_;
  PrescribedFlow gas_;
  ScalarTransport scalar_;
  ScalarSource source_;
};

Carried in_periodic() { return {make_periodic(), {{{1, 0, 0}}}, {{{{0.4, 2, 0.7}}}, {{{1, 2, -0.5}}}}, {}}; }

// Walls across a: one of a given value, one with surroundings; walls across b and along the third axis are insulated.
Carried in_box() {
  Carried c{make_box(), {{{1, 0, 0}, {0.6, 0.6, -0.4}}}, {bump, {{{0.5, 1, 0}}}}, {}};
  const int a = c.setting.plane[0];
  // The void fraction does not vary along the wall with surroundings, at a = 1.
  c.setting.flow.shape = {{{{0.15, 0.5, 0}}}, {{{1, 1.5, -0.3}}}};
  const Wave flat{{{0.375, 0, 0}, {-0.5, 2, 0}, {0.125, 4, 0}}};  // sin^4
  c.setting.flow.swell = {scaled(flat, 0.01), bump};
  c.setting.patches = {{"given", low(a), {}, NoSlip{}, "case.yaml:1"},
                       {"surroundings", high(a), {}, NoSlip{}, "case.yaml:2"}};
  constexpr Real h = 0.3;
  const Real flux = conductivity * c.setting.flow.mean_void_fraction * c.across.derivative(1, 1);
  c.conditions = {GivenValue{c.across.derivative(0, 0)},
                  Surroundings{c.across.derivative(0, 1) + flux / h, h}};
  return c;
}

Carried in_duct() {
  Carried c{make_duct(), {{{1, 0, 0}}}, {{{{0.3, 1, 0}}}, {{{1, 0.5, -M_PI / 2}}}}, {}};
  for (const auto& patch : c.setting.patches) {
    c.conditions.push_back(patch.name == "inlet" ? ScalarBoundary{GivenValue{1}}
                                                 : ScalarBoundary{Insulated{}});
  }
  return c;
}

struct Kind {
  const char* name;
  Carried (*make)();
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

class ManufacturedScalar : public testing::TestWithParam<Kind> {};

TEST_P(ManufacturedScalar, OrderInSpace) {
  const Carried carried = GetParam().make();
  for (const auto& [scheme, name] :
       {std::pair{Convection::central, "central"}, std::pair{Convection::quick, "quick"}}) {
    for (const bool stretched : {false, true}) {
      std::vector<Real> errors;
      for (const Index cells : {16, 32, 64}) {
        errors.push_back(Marcher(carried, {scheme, stretched, cells}).error());
      }
      expect_order(carried.setting.name + ", " + name + (stretched ? ", stretched" : ", equal cells"), errors,
                   1.9, "16, 32, 64 cells");
    }
  }
}

TEST_P(ManufacturedScalar, OrderInTime) {
  const Carried carried = GetParam().make();
  std::vector<std::unique_ptr<Marcher>> runs;
  for (const int steps : {16, 32, 64, 128}) {
    runs.push_back(
        std::make_unique<Marcher>(carried, March{Convection::central, true, 12, 0.08 / steps, steps, false}));
  }
  std::vector<Real> differences;
  for (std::size_t l = 1; l < runs.size(); ++l) differences.push_back(runs[l]->difference(*runs[l - 1]));
  expect_order(carried.setting.name + ", in time", differences, 0.95,
               "differences between steps of 5, 2.5, 1.25, 0.625 ms");
}

INSTANTIATE_TEST_SUITE_P(Boundaries, ManufacturedScalar,
                         testing::ValuesIn(std::vector<Kind>{
                             {"periodic", in_periodic}, {"walls", in_box}, {"duct", in_duct}}));

}  // namespace
}  // namespace pellicle::cfd
