// What the Kokkos tools hooks see of the engine: every kernel and View has a label `dem::file::what`, no two kernels in
// the sources share one, and nothing is allocated within a steady step.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/core/kernel_labels.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

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

TEST(KernelLabels, NameFolderFileAndAreUnique) {
  const auto labels = ::pellicle::tests::expect_good_labels("dem");
  EXPECT_GT(labels.size(), 30U);
  // Every label that a run shows is one of these: none is put together or left out.
  const ::pellicle::tests::LabelHooks hooks;
  const Kokkos::View<int*> probe("test::kernel_labels::probe", 3);
  ASSERT_EQ(::pellicle::tests::seen().views.count("test::kernel_labels::probe"), 1U)
      << "the hooks see nothing";
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
  auto& [kernels, views, launched, allocated] = ::pellicle::tests::seen();
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
    const ::pellicle::tests::LabelHooks hooks;
    run(engine, 130);  // two re-sorts
    engine.collect_report();
    EXPECT_GT(engine.list_builds(), builds + 3) << "no list was built in the time that is watched";
    ::pellicle::tests::expect_nothing_allocated();
  }
}

}  // namespace
}  // namespace pellicle::dem
