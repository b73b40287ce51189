// A gas whose void fraction and properties stay as they are begins a step with the coefficients of the last one's end.
#include <gtest/gtest.h>

#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include "cfd/fixed_sum.hpp"
#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"

namespace pellicle::cfd {
namespace {

constexpr Real step = 1e-3;
constexpr Real jet_speed = 2;

// A jet from a part of the floor of a closed box with an open top, 10 cells wide; its Courant number is 0.2.
struct Jet {
  Jet() : Jet(make_options()) {}
  explicit Jet(const GasOptions& options)
      : grid(Box{{0, 0, 0}, {0.1, 0.1, 0.2}}, {10, 10, 20}),
        exchange(make_empty_exchange(grid)),
        solver(grid, options,
               {{"jet", Side::z_min, Box{{0.03, 0.03, -1}, {0.07, 0.07, 1}}, Inlet{jet_speed, {}},
                 "case.yaml:2"},
                {"top", Side::z_max, {}, Outlet{0}, "case.yaml:3"}}) {}
  static GasOptions make_options() {
    GasOptions options = make_air(Convection::central);
    options.viscosity = 3e-4;
    return options;
  }

  CartesianGrid grid;
  ParticleExchange exchange;
  GasSolver solver;
};

TEST(KeptCoefficients, ChangeAStepOnlyAsMuchAsItsOwnIterationsWould) {
  Jet kept;
  Jet anew;
  advance(kept.solver, kept.exchange, step, 10);
  for (int i = 0; i < 10; ++i) {
    anew.solver.drop_solver_hierarchies();
    advance(anew.solver, anew.exchange, step, 1);
  }
  const Real difference = largest_difference(kept.solver.state().velocity, anew.solver.state().velocity);
  // The flow before the last momentum solve stands for the one after it, in the part of convection that is explicit and
  // only until the step's own flow is known. Two outer iterations leave 3e-3.
  EXPECT_LT(difference, 3e-3 * jet_speed);
  EXPECT_GT(difference, 0) << "the coefficients were not kept";
}

TEST(KeptCoefficients, AreLeftWhereTheVoidFractionChanges) {
  Jet one;
  Jet other;
  const auto change = [](Jet& jet, int i) {
    Kokkos::deep_copy(jet.exchange.void_fraction, 1 - 1e-3 * (i % 2));
  };
  for (int i = 0; i < 6; ++i) {
    change(one, i);
    change(other, i);
    other.solver.drop_solver_hierarchies();
    advance(one.solver, one.exchange, step, 1);
    advance(other.solver, other.exchange, step, 1);
  }
  EXPECT_EQ(largest_difference(one.solver.state().velocity, other.solver.state().velocity), 0);
}

// In the step after a change the void fraction stays, but the one before the step is another than it was: only the step
// after that begins as the one before it ended.
TEST(KeptCoefficients, AreMadeAnewInTheStepAfterAChange) {
  Jet one;
  Jet other;
  const auto advance_both = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      other.solver.drop_solver_hierarchies();
      advance(one.solver, one.exchange, step, 1);
      advance(other.solver, other.exchange, step, 1);
    }
    return largest_difference(one.solver.state().velocity, other.solver.state().velocity);
  };
  for (Jet* jet : {&one, &other}) Kokkos::deep_copy(jet->exchange.void_fraction, 0.8);
  EXPECT_EQ(advance_both(1), 0) << "the step of the change";
  EXPECT_EQ(advance_both(1), 0) << "the step after it";
  EXPECT_GT(advance_both(1), 0) << "the coefficients were not kept at all";
}

TEST(KeptCoefficients, AreNotMissedByARunThatResumes) {
  const auto path =
      std::filesystem::temp_directory_path() / ("pellicle_jet_" + std::to_string(::getpid()) + ".h5");
  Jet first;
  advance(first.solver, first.exchange, step, 5);
  {
    core::CheckpointWriter writer(path);
    first.solver.save(writer);
    writer.close();
  }
  first.solver.drop_solver_hierarchies();
  advance(first.solver, first.exchange, step, 5);
  Jet second;
  advance(second.solver, second.exchange, step, 3);  // a history that must not matter
  {
    core::CheckpointReader reader(path);
    second.solver.load(reader);
  }
  advance(second.solver, second.exchange, step, 5);
  std::filesystem::remove(path);
  EXPECT_EQ(largest_difference(first.solver.state().velocity, second.solver.state().velocity), 0);
}

TEST(OuterIterations, SayHowMuchTheFaceVelocitiesStillChange) {
  GasOptions options = Jet::make_options();
  options.solver.require_convergence = true;
  options.solver.outer_tolerance = 1e-12;
  Jet jet(options);
  try {
    advance(jet.solver, jet.exchange, step, 1);
    FAIL() << "two iterations cannot reach 1e-12";
  } catch (const RunError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("after 2 outer iterations face velocities still change by"), std::string::npos)
        << message;
    EXPECT_NE(message.find("solver.outer_tolerance 1e-12 is required"), std::string::npos) << message;
    EXPECT_NE(message.find("in cell ("), std::string::npos) << message;
  }
}

TEST(FixedSum, SeveralSumsAndLargestAreThoseOfPlainLoops) {
  for (const Index count : {1, 1024, 1025, 20000}) {
    FixedSum sum;
    const auto term = [](Index e) { return std::sin(Real{0.7} * e); };
    Real plain = 0;
    Real squares = 0;
    Real largest = 0;
    for (Index e = 0; e < count; ++e) {
      plain += term(e);
      squares += term(e) * term(e);
      largest = std::max(largest, std::abs(term(e)));
    }
    const auto found = sum.several<2>("tests::cfd::several", count, [=](Index begin, Index end, auto& sums) {
      for (Index e = begin; e < end; ++e) {
        sums[0] += term(e);
        sums[1] += term(e) * term(e);
      }
    });
    // Round-off of so many additions.
    EXPECT_NEAR(found[0], plain, 1e-11);
    EXPECT_NEAR(found[1], squares, 1e-9);
    const auto both = sum.largest_two("tests::cfd::largest_two", count, [=](Index e) {
      return std::array{std::abs(term(e)), 2 * std::abs(term(e))};
    });
    EXPECT_EQ(both[0], largest);
    EXPECT_EQ(both[1], 2 * largest);
  }
}

}  // namespace
}  // namespace pellicle::cfd
