// What the Kokkos tools hooks see of heat: every kernel and View has a label `heat::file::what`, no two in the sources
// share one, and nothing is allocated within a steady step.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "tests/heat/box_of_gas.hpp"

namespace pellicle::heat {
namespace {

namespace tools = Kokkos::Tools::Experimental;

// The hooks are plain functions, so what they see is kept here.
std::vector<std::string> allocated, kernels;

void see_allocation(const Kokkos::Profiling::SpaceHandle, const char* label, const void* const,
                    const std::uint64_t) {
  allocated.emplace_back(label);
}
void see_kernel(const char* name, const std::uint32_t, std::uint64_t*) { kernels.emplace_back(name); }

std::map<std::string, std::vector<std::string>> labels_in_sources() {
  std::map<std::string, std::vector<std::string>> labels;
  const std::regex label("\"(heat::[^\" ]*)\"");
  const auto folder = std::filesystem::path(PELLICLE_SOURCE_DIR) / "heat";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    for (auto m = std::sregex_iterator(text.begin(), text.end(), label); m != std::sregex_iterator(); ++m) {
      labels[(*m)[1]].push_back(entry.path().stem().string());
    }
  }
  return labels;
}

TEST(HeatKernelLabels, NameFolderFileAndAreUniqueAndASteadyStepAllocatesNothing) {
  const auto labels = labels_in_sources();
  EXPECT_GT(labels.size(), 15U);
  const std::regex form("heat::([a-z_]+)::[a-z0-9_]+");
  for (const auto& [label, files] : labels) {
    std::smatch match;
    ASSERT_TRUE(std::regex_match(label, match, form)) << label;
    EXPECT_EQ(files.size(), 1U) << label << " stands in several places";
    EXPECT_EQ(match[1], files.front()) << label << " names another file";
  }
  const Box box{{0, 0, 0}, {0.02, 0.02, 0.02}};
  for (const Index3 transfer : {Index3{4, 4, 4}, Index3{2, 2, 2}}) {
    const CartesianGrid gas_grid(box, {4, 4, 4});
    tests::BoxOfGas gas(gas_grid, CartesianGrid(box, transfer), tests::make_options(),
                        {{{0.01, 0.01, 0.01}, 1e-3, 290, {1e-8, 0}}}, 320, 0.005);
    for (int n = 0; n < 3; ++n) gas.step(1e-3);
    allocated.clear();
    kernels.clear();
    const auto before = tools::get_callbacks();
    tools::set_allocate_data_callback(see_allocation);
    tools::set_begin_parallel_for_callback(see_kernel);
    for (int n = 0; n < 3; ++n) gas.step(1e-3);
    tools::set_callbacks(before);
    EXPECT_GT(kernels.size(), 10U);
    EXPECT_TRUE(allocated.empty()) << allocated.size() << " allocations, the first of " << allocated.front();
  }
}

}  // namespace
}  // namespace pellicle::heat
