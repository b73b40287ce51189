// What the Kokkos tools hooks see of the spray: every kernel and View has a label `spray::file::what`, no two in the sources
// share one, and nothing is allocated within a steady step.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "tests/spray/rig.hpp"

namespace pellicle::spray {
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
  const std::regex label("\"(spray::[^\" ]*)\"");
  const auto folder = std::filesystem::path(PELLICLE_SOURCE_DIR) / "spray";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    for (auto m = std::sregex_iterator(text.begin(), text.end(), label); m != std::sregex_iterator(); ++m) {
      labels[(*m)[1]].push_back(entry.path().stem().string());
    }
  }
  return labels;
}

TEST(SprayKernelLabels, NameFolderFileAndAreUniqueAndASteadyStepAllocatesNothing) {
  const auto labels = labels_in_sources();
  EXPECT_GT(labels.size(), 15U);
  const std::regex form("spray::([a-z_]+)::[a-z0-9_]+");
  for (const auto& [label, files] : labels) {
    std::smatch match;
    ASSERT_TRUE(std::regex_match(label, match, form)) << label;
    EXPECT_EQ(files.size(), 1U) << label << " stands in several places";
    EXPECT_EQ(match[1], files.front()) << label << " names another file";
  }
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
  const auto before = tools::get_callbacks();
  tools::set_allocate_data_callback(see_allocation);
  tools::set_begin_parallel_for_callback(see_kernel);
  for (int k = 0; k < 20; ++k) rig.outer_step();
  tools::set_callbacks(before);
  EXPECT_GT(rig.records()[0].hits, 100);
  EXPECT_GT(kernels.size(), 100U);
  EXPECT_TRUE(allocated.empty()) << allocated.size() << " allocations, the first of " << allocated.front();
}

}  // namespace
}  // namespace pellicle::spray
