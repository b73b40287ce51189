// Reads the values that a description refers to from a YAML document.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/keys.hpp"
#include "core/yaml_tree.hpp"

namespace pellicle::core {

/// What is wrong with an input, in the order found; each is `file:line: key.path: what is wrong; what is allowed`.
class InputProblems {
 public:
  /// `where` is the place, then the path of the key.
  void add(const std::string& where, const std::string& what);
  /// Drops what was said of the key of a path and of the keys below it.
  void forget(const std::string& path);
  const std::vector<std::string>& messages() const { return messages_; }
  bool empty() const { return messages_.empty(); }
  /// Throws InputError with all messages, one a line, if there are any.
  void throw_if_any() const;

 private:
  std::vector<std::string> messages_;
};

/// Fills in the values of all keys that `root` gives. Every key that is unknown, missing, of the wrong type, unit or
/// range becomes a problem; values of such keys are left as they were.
/// `places` receives the place (`file:line` or `--set`) of each key that is given, by its path.
void read_keys(const YamlNode& root, const std::function<void(Keys&)>& describe, InputProblems& problems,
               std::map<std::string, std::string>& places);

}  // namespace pellicle::core
