// Order of convergence of velocity and pressure by manufactured solutions with a void fraction that varies in space and
// time. The solver has no inlet of its own for sources: they come in as the force of the particles.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/cfd/gas_for_tests.hpp"
#include "tests/verification/cfd/manufactured.hpp"

namespace pellicle::cfd {
namespace {

constexpr Real density = 1.3;
constexpr Real viscosity = 0.05;

// Superficial velocity U = rot(stream) + s' grad(swell), void fraction eps = mean + shape - s lap(swell): continuity
// d eps/dt + div U = 0 holds whatever the functions are. s(t) = sin(pulse t).
struct Flow {
  Product stream, swell, shape, pressure;
  Real through = 0;  ///< uniform superficial velocity along the second axis [m/s]
  Real mean_void_fraction = 0.6;
  Real pulse = 2;
  Real growth = 0.3;  ///< of the stream function per second, relative

  struct Point {
    Jet eps, a, b;  ///< void fraction, superficial velocity
  };
  Real s(Real t) const { return std::sin(pulse * t); }
  Real s_rate(Real t) const { return pulse * std::cos(pulse * t); }
  Point at(Real a, Real b, Real t, Real rate) const {
    const Jet eps =
        Jet{mean_void_fraction} + shape.jet(a, b) - s(t) * (swell.jet(a, b, 2, 0) + swell.jet(a, b, 0, 2));
    const Real strength = 1 + growth * t;
    return {eps, strength * stream.jet(a, b, 0, 1) + rate * swell.jet(a, b, 1, 0),
            Jet{through} - strength * stream.jet(a, b, 1, 0) + rate * swell.jet(a, b, 0, 1)};
  }
  // Of a cell: a closed domain keeps its gas to round-off only if cells hold exact means.
  Real mean_void_fraction_of(const std::array<Real, 2>& from, const std::array<Real, 2>& to, Real t) const {
    return mean_void_fraction + shape.mean(from, to) -
           s(t) * (swell.mean(from, to, 2, 0) + swell.mean(from, to, 0, 2));
  }
};

Real exchange_coefficient(const Jet& eps) { return 4 * (1 - eps.v); }

// Force per volume without the part of the time derivative: div(rho U u) + eps grad p - viscous stress + beta u. The
// viscous stress is that of docs/theory/gas.md: eps grad u across, grad(eps u) along the normal of a face.
std::array<Real, 2> steady_force(const Flow::Point& q, const Jet& p) {
  const Jet ua = q.a / q.eps;
  const Jet ub = q.b / q.eps;
  const auto convection = [&](const Jet& u) { return density * ((q.a * u).a + (q.b * u).b); };
  const auto across_a = [&](const Jet& u) { return q.eps.a * u.a + q.eps.v * u.aa; };
  const auto across_b = [&](const Jet& u) { return q.eps.b * u.b + q.eps.v * u.bb; };
  const Real beta = exchange_coefficient(q.eps);
  return {convection(ua) + q.eps.v * p.a - viscosity * (q.a.aa + across_b(ua)) + beta * ua.v,
          convection(ub) + q.eps.v * p.b - viscosity * (q.b.bb + across_a(ub)) + beta * ub.v};
}

struct Setting {
  std::string name;
  Flow flow;
  std::array<int, 2> plane{0, 2};  ///< axes of the flow; along the third one the domain is one cell deep
  bool periodic = false;
  std::vector<BoundaryPatch> patches;
  Real dt = 0.02;  ///< [s]
};

struct March {
  Convection scheme = Convection::central;
  bool stretched = false;
  Index cells = 16;
  Real dt = 0;
  int steps = 4;
  // The source is that of the equations discretised in time alone, so that all that is left is the error in space,
  // whatever the step is.
  bool exact_in_time = true;
  Real outer_tolerance = 1e-6;
};

// A solver that marches along a manufactured flow.
class Marcher {
 public:
  Marcher(const Setting& setting, const March& march)
      : flow_(setting.flow),
        march_(march),
        a_(setting.plane[0]),
        b_(setting.plane[1]),
        grid_(make_square(march.cells, setting.plane, march.stretched, setting.periodic)),
        solver_(grid_, make_options(march), setting.patches),
        exchange_(make_empty_exchange(grid_)) {
    HostArray<Vec3> initial("tests::manufactured::initial", static_cast<std::size_t>(grid_.cell_count()));
    rate_ = flow_.s_rate(0);
    for_cells([&](Index c, Real a, Real b) {
      const auto q = flow_.at(a, b, 0, rate_);
      initial(c)[a_] = q.a.v / q.eps.v;
      initial(c)[b_] = q.b.v / q.eps.v;
    });
    set_void_fraction(0);
    solver_.initialise(initial, exchange_.void_fraction);
    for (int step = 0; step < march.steps; ++step) advance(step * march.dt);
  }

  /// Root mean square over the volume of velocity and pressure less those of another flow on the same cells.
  std::array<Real, 2> difference(const Marcher& other) const {
    return deviation([&](Index c, Real, Real) { return other.solver_.state().velocity(c); },
                     [&](Index c, Real, Real) { return other.solver_.state().pressure(c); });
  }
  /// The same against the manufactured solution.
  std::array<Real, 2> error() const {
    const Real t = march_.steps * march_.dt;
    return deviation(
        [&](Index, Real a, Real b) {
          const auto q = flow_.at(a, b, t, rate_);
          Vec3 u;
          u[a_] = q.a.v / q.eps.v;
          u[b_] = q.b.v / q.eps.v;
          return u;
        },
        [&](Index, Real a, Real b) { return flow_.pressure.jet(a, b).v; });
  }

 private:
  static GasOptions make_options(const March& march) {
    GasOptions options = make_air(march.scheme);
    options.density = density;
    options.viscosity = viscosity;
    options.solver.max_outer_iterations = 60;
    options.solver.outer_tolerance = march.outer_tolerance;
    return options;
  }

  template <class Visit>
  void for_cells(Visit&& visit) const {
    for (Index c = 0; c < grid_.cell_count(); ++c) {
      const Index3 at = grid_.coordinates(c);
      visit(c, grid_.center(a_, at[a_]), grid_.center(b_, at[b_]));
    }
  }

  void set_void_fraction(Real t) {
    for (Index c = 0; c < grid_.cell_count(); ++c) {
      const Index3 at = grid_.coordinates(c);
      const auto corner = [&](int axis, Index shift) {
        return grid_.faces(axis)[static_cast<std::size_t>(at[axis] + shift)];
      };
      exchange_.void_fraction(c) =
          flow_.mean_void_fraction_of({corner(a_, 0), corner(b_, 0)}, {corner(a_, 1), corner(b_, 1)}, t);
    }
  }

  // Change of the superficial velocity per second at the end of a step.
  std::array<Real, 2> acceleration(Real a, Real b, Real t_old, const Flow::Point& now, Real rate_old) const {
    if (march_.exact_in_time) {
      const auto old = flow_.at(a, b, t_old, rate_old);
      return {(now.a.v - old.a.v) / march_.dt, (now.b.v - old.b.v) / march_.dt};
    }
    // Differences of fourth order, off by 1e-12.
    constexpr Real h = 1e-3;
    const Real t = t_old + march_.dt;
    const auto at = [&](int i) { return flow_.at(a, b, t + i * h, flow_.s_rate(t + i * h)); };
    const auto p1 = at(1), p2 = at(2), m1 = at(-1), m2 = at(-2);
    return {(8 * (p1.a.v - m1.a.v) - (p2.a.v - m2.a.v)) / (12 * h),
            (8 * (p1.b.v - m1.b.v) - (p2.b.v - m2.b.v)) / (12 * h)};
  }

  void advance(Real t_old) {
    const Real t = t_old + march_.dt;
    const Real rate_old = rate_;
    rate_ = march_.exact_in_time ? (flow_.s(t) - flow_.s(t_old)) / march_.dt : flow_.s_rate(t);
    set_void_fraction(t);
    for_cells([&](Index c, Real a, Real b) {
      const auto q = flow_.at(a, b, t, rate_);
      const auto force = steady_force(q, flow_.pressure.jet(a, b));
      const auto change = acceleration(a, b, t_old, q, rate_old);
      exchange_.exchange_coefficient(c) = exchange_coefficient(q.eps);
      exchange_.explicit_force(c)[a_] = force[0] + density * change[0];
      exchange_.explicit_force(c)[b_] = force[1] + density * change[1];
    });
    const StepReport report = solver_.update(march_.dt, exchange_);
    EXPECT_LT(report.outer_iterations, solver_.options().solver.max_outer_iterations) << "not converged";
  }

  template <class Velocity, class Pressure>
  std::array<Real, 2> deviation(Velocity&& velocity, Pressure&& pressure) const {
    Real volume = 0, du = 0, dp = 0, dp2 = 0;
    for_cells([&](Index c, Real a, Real b) {
      const Index3 at = grid_.coordinates(c);
      const Real own = grid_.volume(at.x, at.y, at.z);
      const Real p = solver_.state().pressure(c) - pressure(c, a, b);
      volume += own;
      du += own * norm_squared(solver_.state().velocity(c) - velocity(c, a, b));
      dp += own * p;
      dp2 += own * p * p;
    });
    // Without outlet the pressure is known up to a constant.
    const Real shift = flow_.through != 0 ? 0 : dp / volume;
    return {std::sqrt(du / volume), std::sqrt(dp2 / volume - shift * shift)};
  }

  const Flow& flow_;
  March march_;
  int a_, b_;
  CartesianGrid grid_;
  GasSolver solver_;
  ParticleExchange exchange_;
  Real rate_ = 0;  ///< s' that belongs to the present state
};

// sin^2(pi x): it and its slope vanish on walls at 0 and 1.
const Wave bump{{{0.5, 0, 0}, {-0.5, 2, 0}}};
// sin^2(pi x) (1 + 1/5 sin 2 pi x).
const Wave lopsided{{{0.5, 0, 0}, {-0.5, 2, 0}, {0.1, 2, -M_PI / 2}, {-0.05, 4, -M_PI / 2}}};

Wave scaled(Wave wave, Real factor) {
  for (auto& term : wave.terms) term.amplitude *= factor;
  return wave;
}

Side low(int axis) { return static_cast<Side>(2 * axis); }
Side high(int axis) { return static_cast<Side>(2 * axis + 1); }

Setting make_periodic() {
  Flow f;
  f.stream = {scaled(bump, 0.3), lopsided};
  f.swell = {scaled(lopsided, 0.005), bump};
  f.shape = {{{{0.1, 2, 0.4}}}, {{{1, 2, -0.3}}}};
  f.pressure = {{{{0.5, 2, 0.2}}}, {{{1, 2, 0.9}}}};
  return {"periodic", f, {0, 2}, true, {}, 0.1};
}

// The void fraction changes on the walls too, and the pressure has a gradient there.
Setting make_box() {
  Setting s{"no-slip walls", make_periodic().flow, {2, 1}, false, symmetry_on({low(0), high(0)}), 0.02};
  s.flow.shape = {{{{0.15, 1.3, 0.4}}}, {{{1, 1.5, -0.3}}}};
  s.flow.pressure = {{{{0.5, 1, 0.4}}}, {{{1, 1.2, 0.9}}}};
  return s;
}

// Mirrored at every wall: U_a = sin(pi a) cos(pi b), and so on.
Setting make_slip_box() {
  Flow f;
  f.stream = {{{{0.2, 1, -M_PI / 2}}}, {{{1, 1, -M_PI / 2}, {0.3, 2, -M_PI / 2}}}};
  f.swell = {{{{0.02, 1, 0}}}, {{{1, 1, 0}}}};
  f.shape = {{{{0.15, 1, 0}}}, {{{1, 1, 0}}}};
  f.pressure = {{{{0.5, 1, 0}}}, {{{1, 2, 0}}}};
  return {"slip walls", f, {0, 1}, false, symmetry_on({low(0), high(0), low(1), high(1), low(2), high(2)})};
}

// Uniform inflow at b = 0; no pressure and no gradient of the velocity at b = 1.
Setting make_duct() {
  Flow f;
  f.through = 0.8;
  f.stream = {{{{0.1, 1, -M_PI / 2}}}, {{{8.0 / 9, 0, 0}, {-1, 1, 0}, {1.0 / 9, 3, 0}}}};
  f.shape = {{{{0.15, 1, 0}}}, {{{1, 0.5, -M_PI / 2}}}};
  f.pressure = {{{{0.5, 0, 0}, {0.3, 1, 0}}}, {{{1, 0.5, 0}}}};
  auto patches = symmetry_on({low(1), high(1), low(2), high(2)});
  patches.push_back({"inlet", low(0), {}, Inlet{0.8, {}}, "case.yaml:2"});
  patches.push_back({"outlet", high(0), {}, Outlet{0}, "case.yaml:3"});
  return {"inlet and outlet", f, {2, 0}, false, patches};
}

class ManufacturedFlow : public testing::TestWithParam<Setting (*)()> {};

// Second order; 1.9 leaves room for cells that are not yet fine.
TEST_P(ManufacturedFlow, OrderInSpace) {
  const Setting setting = GetParam()();
  for (const auto& [scheme, name] :
       {std::pair{Convection::central, "central"}, std::pair{Convection::quick, "quick"}}) {
    for (const bool stretched : {false, true}) {
      std::array<std::vector<Real>, 2> errors;
      for (const Index cells : {16, 32, 64}) {
        const auto error = Marcher(setting, {scheme, stretched, cells, setting.dt}).error();
        for (std::size_t i = 0; i < 2; ++i) errors[i].push_back(error[i]);
      }
      const std::string what = setting.name + ", " + name + (stretched ? ", stretched" : ", equal cells");
      expect_order(what + ": velocity", errors[0], 1.9, "16, 32, 64 cells");
      expect_order(what + ": pressure", errors[1], 1.9, "16, 32, 64 cells");
    }
  }
}

// Implicit Euler. The error in space is the same at all steps and leaves the differences between them.
TEST_P(ManufacturedFlow, OrderInTime) {
  const Setting setting = GetParam()();
  std::vector<std::unique_ptr<Marcher>> runs;
  for (const int steps : {16, 32, 64, 128}) {
    runs.push_back(std::make_unique<Marcher>(
        setting, March{Convection::central, true, 12, 0.08 / steps, steps, false, 1e-8}));
  }
  std::array<std::vector<Real>, 2> differences;
  for (std::size_t l = 1; l < runs.size(); ++l) {
    const auto difference = runs[l]->difference(*runs[l - 1]);
    for (std::size_t i = 0; i < 2; ++i) differences[i].push_back(difference[i]);
  }
  const std::string steps = "differences between steps of 5, 2.5, 1.25, 0.625 ms";
  expect_order(setting.name + ", in time: velocity", differences[0], 0.95, steps);
  expect_order(setting.name + ", in time: pressure", differences[1], 0.95, steps);
}

INSTANTIATE_TEST_SUITE_P(Boundaries, ManufacturedFlow,
                         testing::Values(&make_periodic, &make_box, &make_slip_box, &make_duct));

}  // namespace
}  // namespace pellicle::cfd
