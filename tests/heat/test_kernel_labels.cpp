// What the Kokkos tools hooks see of heat: every kernel and View has a label `heat::file::what`, no two in the sources
// share one, and nothing is allocated within a steady step.
#include <gtest/gtest.h>

#include "tests/core/kernel_labels.hpp"
#include "tests/heat/box_of_gas.hpp"

namespace pellicle::heat {
namespace {

TEST(HeatKernelLabels, NameFolderFileAndAreUniqueAndASteadyStepAllocatesNothing) {
  EXPECT_GT(::pellicle::tests::expect_good_labels("heat").size(), 15U);
  const Box box{{0, 0, 0}, {0.02, 0.02, 0.02}};
  for (const Index3 transfer : {Index3{4, 4, 4}, Index3{2, 2, 2}}) {
    const CartesianGrid gas_grid(box, {4, 4, 4});
    tests::BoxOfGas gas(gas_grid, CartesianGrid(box, transfer), tests::make_options(),
                        {{{0.01, 0.01, 0.01}, 1e-3, 290, {1e-8, 0}}}, 320, 0.005);
    for (int n = 0; n < 3; ++n) gas.step(1e-3);
    const ::pellicle::tests::LabelHooks hooks;
    for (int n = 0; n < 3; ++n) gas.step(1e-3);
    EXPECT_GT(::pellicle::tests::seen().launched.size(), 10U);
    ::pellicle::tests::expect_nothing_allocated();
  }
}

}  // namespace
}  // namespace pellicle::heat
