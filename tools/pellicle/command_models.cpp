#include <fmt/format.h>

#include "core/error.hpp"
#include "tools/pellicle/commands.hpp"
#include "tools/pellicle/model_families.hpp"
#include "tools/pellicle/schema.hpp"

namespace pellicle::tools {

int models_command(const std::string& wanted) {
  std::vector<ModelFamily> families = model_families();
  families.insert(families.end(), quantity_families().begin(), quantity_families().end());
  bool found = false;
  for (const auto& family : families) {
    const bool matches = family.key == wanted || family.key.ends_with(fmt::format(".{}", wanted));
    if (!wanted.empty() && !matches) continue;
    fmt::print("{}{}: {}\n", found ? "\n" : "", family.key, family.title);
    found = true;
    for (const auto& model : family.models) {
      fmt::print("  {:<24} {}\n", model.name, model.description);
      if (!model.source.empty() && model.source != "-") fmt::print("  {:<24}   [{}]\n", "", model.source);
    }
  }
  if (found) return 0;
  std::string keys;
  for (const auto& family : families) keys += (keys.empty() ? "" : ", ") + std::string(family.key);
  throw InputError(fmt::format("models: there is no family {}; {}", wanted, keys));
}

int schema_command(bool markdown) {
  fmt::print("{}", markdown ? case_schema_markdown() : case_schema_json());
  return 0;
}

}  // namespace pellicle::tools
