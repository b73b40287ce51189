// What the Kokkos tools hooks see of the spray: every kernel and View has a label `spray::file::what`, no two in the sources
// share one, and nothing is allocated within a steady step.
#include <gtest/gtest.h>

#include "tests/core/kernel_labels.hpp"
#include "tests/spray/rig.hpp"

namespace pellicle::spray {
namespace {

TEST(SprayKernelLabels, NameFolderFileAndAreUniqueAndASteadyStepAllocatesNothing) {
  EXPECT_GT(::pellicle::tests::expect_good_labels("spray").size(), 15U);
  // A bead in a steady spray: as many parcels are born as are caught, or leave.
  dem::EngineSetup setup = tests::glass_setup({0.02, 0.02, 0.02}, 1e-5);
  setup.domain.open_min = setup.domain.open_max = {1, 1, 1};
  Nozzle nozzle = tests::needle({0.01, 0.01, 0.001}, {0, 0, 1}, 50);
  nozzle.cone_angle = 0.5;
  nozzle.mass_rate *= 10;
  SprayOptions options;
  options.nozzles = {nozzle};
  tests::Rig rig(setup, {tests::fixed_bead({0.01, 0.01, 0.012}, 1e-3)}, options);
  rig.blow({0, 0, 20});
  rig.gas_temperature = DeviceArray<Real>("tests::spray::gas_temperature", 8);
  for (int k = 0; k < 20; ++k) rig.outer_step();
  const ::pellicle::tests::LabelHooks hooks;
  for (int k = 0; k < 20; ++k) rig.outer_step();
  EXPECT_GT(rig.records()[0].hits, 100);
  EXPECT_GT(::pellicle::tests::seen().launched.size(), 100U);
  ::pellicle::tests::expect_nothing_allocated();
}

}  // namespace
}  // namespace pellicle::spray
