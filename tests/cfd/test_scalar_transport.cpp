// Transport of scalars: what stays uniform, what is kept, bounds, restart, and refused input.
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "tests/cfd/gas_for_tests.hpp"
#include "tests/cfd/prescribed_flow.hpp"

namespace pellicle::cfd {
namespace {

// A bed whose particles move by hand, as in test_gas_solver.cpp; heat and vapour go with the gas solver's own fluxes.
class CarryingBed {
 public:
  CarryingBed(Convection scheme, Real initial, Real inlet_value, Real reference = 0)
      : solver_(make_grid(), make_air(scheme), make_patches()),
        exchange_(make_empty_exchange(solver_.grid())),
        gas_(solver_.grid(), make_patches(), density),
        temperature("temperature", gas_.geometry, gas_.boundaries,
                    {GivenValue{inlet_value}, GivenValue{inlet_value}, Insulated{}},
                    make_options(1005, 0.026, initial, reference), scheme),
        moisture("moisture", gas_.geometry, gas_.boundaries, {GivenValue{0.9}, GivenValue{0.0}, Insulated{}},
                 make_options(1, density * 2.5e-5, 0.01, 0), scheme) {
    set_particles(0);
    solver_.initialise(Vec3{0, 0, 1.5}, exchange_.void_fraction);
    take_fields();
    temperature.initialise(gas_.fields);
    moisture.initialise(gas_.fields);
  }

  void advance_to_step(int end) {
    for (; step < end; ++step) {
      set_particles(1e-4 * (step + 1));
      solver_.update(1e-4, exchange_);
      take_fields();
      temperature.update(gas_.fields, 1e-4, {});
      moisture.update(gas_.fields, 1e-4, {});
    }
  }
  void save(core::CheckpointWriter& writer) const {
    solver_.save(writer);
    temperature.save(writer);
    moisture.save(writer);
  }
  void load(core::CheckpointReader& reader) {
    solver_.load(reader);
    take_fields();
    temperature.load(reader, gas_.fields);
    moisture.load(reader, gas_.fields);
  }
  void drop_solver_hierarchies() { solver_.drop_solver_hierarchies(); }

  static constexpr Real density = 1.2;
  int step = 0;

 private:
  static CartesianGrid make_grid() { return {Box{{0, 0, 0}, {0.065, 0.02, 0.19}}, {13, 2, 24}}; }
  static std::vector<BoundaryPatch> make_patches() {
    return {{"spout", Side::z_min, Box{{0.03, -1, -1}, {0.035, 1, 1}}, Inlet{30.0, {}}, "case.yaml:2"},
            {"floor", Side::z_min, {}, Inlet{1.5, {}}, "case.yaml:3"},
            {"top", Side::z_max, {}, Outlet{0}, "case.yaml:4"}};
  }
  static ScalarOptions make_options(Real capacity, Real conductivity, Real initial, Real reference) {
    ScalarOptions options;
    options.capacity = capacity;
    options.conductivity = conductivity;
    options.initial = initial;
    options.reference = reference;
    return options;
  }
  void set_particles(Real time) { set_moving_bed(solver_.grid(), time, exchange_); }
  // No patch's edge cuts a face here, so a face's flow is that of its piece.
  void take_fields() {
    Kokkos::deep_copy(gas_.fields.void_fraction, solver_.state().void_fraction);
    Kokkos::deep_copy(gas_.fields.void_fraction_old, solver_.state().void_fraction_old);
    gas_.set_flow([&](int axis, Index i, Index j, Index k) {
      return solver_.state().volume_flux[static_cast<std::size_t>(axis)](
          gas_.geometry.stencil.face(axis, i, j, k));
    });
  }

  GasSolver solver_;
  ParticleExchange exchange_;
  PrescribedFlow gas_;

 public:
  ScalarTransport temperature, moisture;
};

Real largest(const HostArray<Real>& v) { return *std::max_element(v.data(), v.data() + v.extent(0)); }
Real smallest(const HostArray<Real>& v) { return *std::min_element(v.data(), v.data() + v.extent(0)); }

class Schemes : public testing::TestWithParam<Convection> {};

// Whatever the void fraction does and continuity leaves: round-off of some hundred operations on 300.
TEST_P(Schemes, UniformStaysUniform) {
  CarryingBed bed(GetParam(), 313.15, 313.15);
  bed.advance_to_step(100);
  EXPECT_NEAR(largest(bed.temperature.value()) / 313.15, 1, 1e-13);
  EXPECT_NEAR(smallest(bed.temperature.value()) / 313.15, 1, 1e-13);
}
INSTANTIATE_TEST_SUITE_P(All, Schemes,
                         testing::Values(Convection::upwind, Convection::ultimate_quickest,
                                         Convection::central, Convection::quick));

// Bars of DESIGN.md: water 1e-12, energy 1e-8. Vapour stays between nothing and all, heat between its inlet and what was there.
TEST(Scalars, BalanceClosesWithinBounds) {
  CarryingBed bed(Convection::ultimate_quickest, 293.15, 353.15, 293.15);
  Real low = 1, high = 0, cold = 400, hot = 0;
  for (int step = 20; step <= 200; step += 20) {
    bed.advance_to_step(step);
    low = std::min(low, smallest(bed.moisture.value()));
    high = std::max(high, largest(bed.moisture.value()));
    cold = std::min(cold, smallest(bed.temperature.value()));
    hot = std::max(hot, largest(bed.temperature.value()));
  }
  EXPECT_GE(low, -1e-10);
  EXPECT_LE(high, 0.9 + 1e-10);
  EXPECT_GT(high, 0.85);
  // The linear solves' tolerance is relative to the whole field: 1e-12 * 60 K * sqrt(624 cells), a few times over.
  EXPECT_GE(cold, 293.15 - 1e-7);
  EXPECT_LE(hot, 353.15 + 1e-7);
  for (const ScalarTransport* scalar : {&bed.temperature, &bed.moisture}) {
    const ScalarBalance& b = scalar->balance();
    EXPECT_LT(b.defect(), 1e-12);
    // With what continuity left the sums close to round-off.
    EXPECT_LT(std::abs(b.stock - b.initial - b.through_boundaries() - b.leftover) / b.gross, 2e-14);
    EXPECT_GT(b.into[0], 0);
    EXPECT_LT(b.into[2], 0);
  }
  // What came in: 30 and 1.5 m/s over their areas, for 20 ms.
  const Real spout = 0.005 * 0.02, rest = 0.065 * 0.02 - spout;
  EXPECT_NEAR(bed.temperature.balance().into[0] / (1.2 * 1005 * 60 * 30 * spout * 0.02), 1, 1e-2);
  EXPECT_NEAR(bed.temperature.balance().into[1] / (1.2 * 1005 * 60 * 1.5 * rest * 0.02), 1, 5e-2);
}

// One cell column of gas at rest, heated by rate - coefficient value: the closed form of implicit Euler.
TEST(Scalars, SourcesHeatTheirCell) {
  PrescribedFlow gas(CartesianGrid(Box{{0, 0, 0}, {0.03, 0.02, 0.01}}, {3, 1, 1}), {}, 1.2);
  Kokkos::deep_copy(gas.fields.void_fraction, 0.5);
  Kokkos::deep_copy(gas.fields.void_fraction_old, 0.5);
  ScalarOptions options;
  options.capacity = 1000;
  options.initial = 300;
  options.reference = 280;
  ScalarTransport scalar("temperature", gas.geometry, gas.boundaries, {}, options,
                         Convection::ultimate_quickest);
  scalar.initialise(gas.fields);
  ScalarSource source{HostArray<Real>("tests::rate", 3), HostArray<Real>("tests::coefficient", 3)};
  source.rate(0) = 6000;
  source.coefficient(1) = 50;
  source.rate(1) = 50 * 350;
  Real relaxed = 300;
  for (int step = 0; step < 10; ++step) {
    scalar.update(gas.fields, 0.5, source);
    relaxed = (600 * relaxed / 0.5 + 50 * 350) / (600 / 0.5 + 50);
  }
  EXPECT_NEAR(scalar.value()(0), 300 + 6000 * 5.0 / 600, 1e-9);
  EXPECT_NEAR(scalar.value()(1), relaxed, 1e-9);
  EXPECT_NEAR(scalar.value()(2), 300, 1e-11);
  const Real cell = 0.01 * 0.02 * 0.01;
  EXPECT_NEAR(scalar.balance().sources / (cell * (30000 + 600 * (relaxed - 300))), 1, 1e-12);
  EXPECT_LT(scalar.balance().defect(), 1e-13);
}

// Gas that comes back in through an outlet brings the given value, or else the cell's own.
TEST(Scalars, BackflowBringsWhatIsGiven) {
  for (const bool given : {false, true}) {
    PrescribedFlow gas = make_plug_flow(4, 4, -1, 1.2);
    ScalarOptions options;
    options.initial = 0.5;
    const ScalarBoundary outlet = given ? ScalarBoundary{GivenValue{0.2}} : ScalarBoundary{Insulated{}};
    ScalarTransport scalar("moisture", gas.geometry, gas.boundaries, {Insulated{}, outlet}, options,
                           Convection::upwind);
    scalar.initialise(gas.fields);
    for (int step = 0; step < 100; ++step) scalar.update(gas.fields, 1, {});
    for (Index c = 0; c < 4; ++c) EXPECT_NEAR(scalar.value()(c), given ? 0.2 : 0.5, 1e-9);
    EXPECT_LT(scalar.balance().defect(), 1e-13);
  }
}

TEST(Scalars, GoOnBitForBit) {
  const auto path =
      std::filesystem::temp_directory_path() / ("pellicle_scalars_" + std::to_string(::getpid()) + ".h5");
  CarryingBed first(Convection::ultimate_quickest, 293.15, 353.15);
  first.advance_to_step(10);
  {
    core::CheckpointWriter writer(path);
    first.save(writer);
    writer.close();
  }
  first.drop_solver_hierarchies();
  first.advance_to_step(20);
  CarryingBed second(Convection::ultimate_quickest, 293.15, 353.15);
  second.advance_to_step(3);
  {
    core::CheckpointReader reader(path);
    second.load(reader);
  }
  std::filesystem::remove(path);
  second.step = 10;
  second.advance_to_step(20);
  for (const auto scalar : {&CarryingBed::temperature, &CarryingBed::moisture}) {
    const ScalarTransport& a = first.*scalar;
    const ScalarTransport& b = second.*scalar;
    for (std::size_t c = 0; c < a.value().extent(0); ++c) EXPECT_EQ(a.value()(c), b.value()(c));
    EXPECT_EQ(a.balance().stock, b.balance().stock);
    EXPECT_EQ(a.balance().gross, b.balance().gross);
    EXPECT_EQ(a.balance().defect(), b.balance().defect());
  }
}

TEST(Scalars, BadOptionsAreRefused) {
  const PrescribedFlow gas = make_plug_flow(4, 4, 1, 1.2);
  const auto refused = [&](const ScalarOptions& options, const std::vector<ScalarBoundary>& conditions) {
    try {
      ScalarTransport("temperature", gas.geometry, gas.boundaries, conditions, options, Convection::upwind);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::vector<ScalarBoundary> good{GivenValue{1}, Insulated{}};
  EXPECT_EQ(refused({}, good), "accepted");
  EXPECT_NE(refused({}, {Insulated{}, Insulated{}}).find("inlet 'inlet' brings gas of no given value"),
            std::string::npos);
  ScalarOptions options;
  options.capacity = 0;
  EXPECT_NE(refused(options, good).find("capacity"), std::string::npos);
  options = {};
  options.conductivity = -1;
  EXPECT_NE(refused(options, good).find("conductivity"), std::string::npos);
  EXPECT_NE(refused({}, {GivenValue{1}, Surroundings{0, -1}}).find("transfer coefficient"),
            std::string::npos);
}

}  // namespace
}  // namespace pellicle::cfd
