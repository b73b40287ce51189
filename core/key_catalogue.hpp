// A list of all keys that a description declares, for the schema and the docs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/keys.hpp"

namespace pellicle::core {

enum class KeyType { real, whole, flag, text, choice, mark, section };

/// One key as declared.
struct KeyInfo {
  std::string name;
  std::string text;
  Need need = Need::has_default;
  std::string default_text;  ///< as it would stand in the file, or in words; empty if there is none
  bool default_in_words = false;
  KeyType type = KeyType::section;
  bool or_section = false;  ///< of a number: a section with `children` may stand in its place
  bool is_list = false;     ///< of what `type` says
  bool is_named = false;  ///< a section whose keys are names that the user chooses, each a section like this
  Size size;              ///< of a list
  RealRule real_rule;
  WholeRule whole_rule;
  TextRule text_rule = TextRule::any;
  std::vector<ModelInfo> allowed;  ///< of a choice
  std::vector<KeyInfo> children;   ///< of a section
  std::vector<std::vector<std::string>>
      exactly_one;  ///< of a section: groups of children of which one is given
};

/// Runs `describe` and returns the keys it declares, as the children of a section without name.
KeyInfo catalogue_keys(const std::function<void(Keys&)>& describe);

}  // namespace pellicle::core
