// What the tests of labels share: the Kokkos tools hooks, and the labels that stand in a folder's sources.
#pragma once

#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace pellicle::tests {

/// What the hooks have seen; they are plain functions, so it is kept here.
struct SeenByHooks {
  std::set<std::string> kernels, views;
  std::vector<std::string> launched, allocated;  ///< in their order
};
inline SeenByHooks& seen() {
  static SeenByHooks all;
  return all;
}

/// Watches kernels and allocations from nothing on, until it goes.
class LabelHooks {
 public:
  LabelHooks() : before_(Kokkos::Tools::Experimental::get_callbacks()) {
    namespace hooks = Kokkos::Tools::Experimental;
    seen() = {};
    hooks::set_begin_parallel_for_callback(see_kernel);
    hooks::set_begin_parallel_reduce_callback(see_kernel);
    hooks::set_begin_parallel_scan_callback(see_kernel);
    hooks::set_allocate_data_callback(see_allocation);
  }
  ~LabelHooks() { Kokkos::Tools::Experimental::set_callbacks(before_); }
  LabelHooks(const LabelHooks&) = delete;
  LabelHooks& operator=(const LabelHooks&) = delete;

 private:
  static void see_kernel(const char* name, const std::uint32_t, std::uint64_t*) {
    seen().kernels.insert(name);
    seen().launched.emplace_back(name);
  }
  static void see_allocation(const Kokkos::Profiling::SpaceHandle, const char* label, const void* const,
                             const std::uint64_t) {
    seen().views.insert(label);
    seen().allocated.emplace_back(label);
  }
  Kokkos::Tools::Experimental::EventSet before_;
};

inline void expect_nothing_allocated() {
  const auto& allocated = seen().allocated;
  EXPECT_TRUE(allocated.empty()) << allocated.size() << " allocations, the first of " << allocated.front();
}

/// Labels of kernels and Views in a folder's sources -> the files they stand in, one entry a place. Each has the form
/// `folder::file::what` and stands in one place.
inline std::map<std::string, std::vector<std::string>> expect_good_labels(const std::string& folder) {
  std::map<std::string, std::vector<std::string>> labels;
  const std::regex label("\"(" + folder + "::[^\" ]*)\"");
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(PELLICLE_SOURCE_DIR) / folder)) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    for (auto m = std::sregex_iterator(text.begin(), text.end(), label); m != std::sregex_iterator(); ++m) {
      labels[(*m)[1]].push_back(entry.path().stem().string());
    }
  }
  const std::regex form(folder + "::([a-z_]+)::[a-z0-9_]+");
  for (const auto& [name, files] : labels) {
    std::smatch match;
    const bool fits = std::regex_match(name, match, form);
    EXPECT_TRUE(fits) << name;
    EXPECT_EQ(files.size(), 1U) << name << " stands in several places";
    if (fits) {
      EXPECT_EQ(match[1], files.front()) << name << " names another file";
    }
  }
  return labels;
}

}  // namespace pellicle::tests
