// Order of convergence of velocity and pressure by manufactured solutions with a void fraction that varies in space and
// time. The solver has no inlet of its own for sources: they come in as the force of the particles.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/cfd/gas_for_tests.hpp"
#include "tests/verification/cfd/manufactured_flow.hpp"

namespace pellicle::cfd {
namespace {

constexpr Real density = 1.3;
constexpr Real viscosity = 0.05;

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

struct Kind {
  const char* name;
  Setting (*make)();
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

class ManufacturedFlow : public testing::TestWithParam<Kind> {};

// Second order; 1.9 leaves room for cells that are not yet fine.
TEST_P(ManufacturedFlow, OrderInSpace) {
  const Setting setting = GetParam().make();
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
  const Setting setting = GetParam().make();
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
                         testing::ValuesIn(std::vector<Kind>{{"periodic", make_periodic},
                                                             {"no_slip_walls", make_box},
                                                             {"slip_walls", make_slip_box},
                                                             {"duct", make_duct}}));

}  // namespace
}  // namespace pellicle::cfd
