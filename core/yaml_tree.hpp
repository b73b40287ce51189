// A YAML document as a tree that knows where each key stands in its file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace pellicle::core {

/// A value of a YAML document. Maps keep the order of the file; keys are scalars and occur once.
struct YamlNode {
  enum class Kind { null, scalar, sequence, map };
  struct Member;

  Kind kind = Kind::null;
  std::string place;            ///< `file:line` of its key or, in a list, of itself; `--set` if overridden
  std::string text;             ///< of a scalar
  std::vector<YamlNode> items;  ///< of a sequence
  std::vector<Member> members;  ///< of a map

  /// The value of a key of this map, or nullptr.
  const YamlNode* find(std::string_view key) const;
  YamlNode* find(std::string_view key);
};

struct YamlNode::Member {
  std::string name;
  YamlNode value;
};

/// Reads the YAML document in `text`; places are `name:line`. Aliases are replaced by what they stand for.
/// Throws InputError if the text is not one YAML document, or a key is given twice or is no scalar.
YamlNode parse_yaml(const std::string& text, const std::string& name);

/// Reads a YAML file. Throws InputError like parse_yaml, or if the file cannot be read.
YamlNode read_yaml_file(const std::string& path);

/// Applies `path=value`, as in `output.lines.z50mm.points=29` or `particles.0.count=100`: the value is YAML, entries of
/// lists are addressed by index or by their `name`, an empty value removes the key.
/// Throws InputError (`--set: ...`) if the assignment is malformed or leads through something that is no section.
void apply_override(YamlNode& root, const std::string& assignment);

}  // namespace pellicle::core
