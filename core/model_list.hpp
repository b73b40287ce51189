// A family of models as the user meets it: one list feeds the reader, its messages, `pellicle models`, the JSON schema
// and the docs, so that what is documented is what is accepted.
#pragma once

#include <span>
#include <string_view>

namespace pellicle::core {

/// One member of a family: its name in the case file, one line that says what it is, and where it comes from.
struct ModelInfo {
  std::string_view name;
  std::string_view description;
  std::string_view source{};
};

using ModelList = std::span<const ModelInfo>;

/// Position of `name` in the list, or -1.
constexpr int find_model(ModelList list, std::string_view name) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace pellicle::core
