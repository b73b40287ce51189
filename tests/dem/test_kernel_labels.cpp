// What the Kokkos tools hooks see of the engine: every kernel and View has a label `dem::file::what`, no two kernels in
// the sources share one, and nothing is allocated within a steady step.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

namespace tools = Kokkos::Tools::Experimental;

// The hooks are plain functions, so what they see is kept here.
std::set<std::string> kernels, views;
std::vector<std::string> allocated;

void see_kernel(const char* name, const std::uint32_t, std::uint64_t*) { kernels.insert(name); }
void see_allocation(const Kokkos::Profiling::SpaceHandle, const char* label, const void* const,
                    const std::uint64_t) {
  views.insert(label);
  allocated.emplace_back(label);
}

class Hooks {
 public:
  Hooks() : before_(tools::get_callbacks()) {
    kernels.clear();
    views.clear();
    allocated.clear();
    tools::set_begin_parallel_for_callback(see_kernel);
    tools::set_begin_parallel_reduce_callback(see_kernel);
    tools::set_begin_parallel_scan_callback(see_kernel);
    tools::set_allocate_data_callback(see_allocation);
  }
  ~Hooks() { tools::set_callbacks(before_); }
  Hooks(const Hooks&) = delete;
  Hooks& operator=(const Hooks&) = delete;

 private:
  tools::EventSet before_;
};

/// A shallow bed that is stirred by its own speed, with rolling resistance; two materials use the general loop.
EngineSetup bed_setup(bool two_materials, bool periodic) {
  auto setup = tests::glass_setup({0.02, 0.02, 0.02}, 1e-5, 0.9, 0.3, 0.01);
  if (two_materials) {
    tests::let_contacts_remember(setup);
    setup.contacts.cohesion = Willett{1e-12, 0.072, 0};
  }
  if (two_materials) {
    setup.materials.push_back({"heavy", 8000, 1e7, 0.3, false});
    setup.pairs.insert(setup.pairs.end(),
                       {{0, 2, 0.9, 0.3, 0.01}, {2, 2, 0.9, 0.3, 0.01}, {2, 1, 0.9, 0.3, 0.01}});
  }
  setup.domain.periodic = {periodic ? 1 : 0, 0, 0};
  setup.gravity = {0, 0, -9.81};
  tests::add_box_walls(setup);
  return setup;
}

std::vector<ParticleSeed> bed_particles(bool two_materials) {
  std::vector<ParticleSeed> seeds;
  const auto centres =
      tests::scatter({{0.001, 0.001, 0.001}, {0.019, 0.019, 0.019}}, std::vector<Real>(200, 0.0009), 0, 61);
  for (std::size_t p = 0; p < centres.size(); ++p) {
    seeds.push_back({centres[p],
                     tests::random_vector(62, static_cast<int>(p)),
                     {},
                     0.0009,
                     two_materials && p % 2 == 0 ? 2 : 0,
                     false});
  }
  return seeds;
}

void run(Engine& engine, int outer_steps) {
  for (int k = 0; k < outer_steps; ++k) {
    engine.prepare_outer_step();
    tests::advance(engine, 5);
  }
}

/// Labels of kernels and Views in the folder's sources -> the files they stand in, one entry a place.
std::map<std::string, std::vector<std::string>> labels_in_sources() {
  std::map<std::string, std::vector<std::string>> labels;
  const std::regex label("\"(dem::[^\" ]*)\"");
  const auto folder = std::filesystem::path(PELLICLE_SOURCE_DIR) / "dem";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    for (auto m = std::sregex_iterator(text.begin(), text.end(), label); m != std::sregex_iterator(); ++m) {
      labels[(*m)[1]].push_back(entry.path().stem().string());
    }
  }
  return labels;
}

TEST(KernelLabels, NameFolderFileAndAreUnique) {
  const auto labels = labels_in_sources();
  EXPECT_GT(labels.size(), 30U);
  const std::regex form("dem::([a-z_]+)::[a-z0-9_]+");
  for (const auto& [label, files] : labels) {
    std::smatch match;
    ASSERT_TRUE(std::regex_match(label, match, form)) << label;
    EXPECT_EQ(files.size(), 1U) << label << " stands in several places";
    EXPECT_EQ(match[1], files.front()) << label << " names another file";
  }
  // Every label that a run shows is one of these: none is put together or left out.
  const Hooks hooks;
  const Kokkos::View<int*> probe("test::kernel_labels::probe", 3);
  ASSERT_EQ(views.count("test::kernel_labels::probe"), 1U) << "the hooks see nothing";
  for (const bool two_materials : {false, true}) {
    for (const bool periodic : {false, true}) {
      auto setup = bed_setup(two_materials, periodic);
      setup.domain.open_max.z = 1;
      setup.walls.pop_back();
      Engine engine(setup);
      auto seeds = bed_particles(two_materials);
      seeds.push_back({{0.01, 0.01, 0.0199}, {0, 0, 5}, {}, 0.0009, 0, false});
      engine.set_particles(seeds);
      run(engine, 70);
      engine.compute_totals();
      engine.collect_report();
      EXPECT_GE(engine.left_through_open_sides(), 1);
    }
  }
  views.erase("test::kernel_labels::probe");
  EXPECT_GT(kernels.size(), 15U);
  EXPECT_GT(views.size(), 20U);
  for (const auto* seen : {&kernels, &views}) {
    for (const std::string& label : *seen) {
      if (label.starts_with("Kokkos::")) continue;  // of Kokkos itself: filling Views with zeros, scratch
      EXPECT_EQ(labels.count(label), 1U) << "\"" << label << "\" is not a label of dem/";
    }
  }
}

TEST(KernelLabels, ASteadyStepAllocatesNothing) {
  for (const bool two_materials : {false, true}) {
    Engine engine(bed_setup(two_materials, false));
    engine.set_particles(bed_particles(two_materials));
    run(engine, 300);  // the bed falls together; the lists grow with it
    const auto builds = engine.list_builds();
    const Hooks hooks;
    run(engine, 130);  // two re-sorts
    engine.collect_report();
    EXPECT_GT(engine.list_builds(), builds + 3) << "no list was built in the time that is watched";
    EXPECT_TRUE(allocated.empty()) << allocated.size() << " allocations, the first of " << allocated.front();
  }
}

}  // namespace
}  // namespace pellicle::dem
