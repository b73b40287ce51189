#include "core/yaml_tree.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "core/error.hpp"

namespace pellicle::core {

namespace {

constexpr std::string_view override_place = "--set";
/// Aliases of aliases can blow up a short text; no case file comes near this.
constexpr std::size_t most_nodes_by_alias = 100'000;

std::size_t count_nodes(const YamlNode& node) {
  std::size_t count = 1;
  for (const auto& item : node.items) count += count_nodes(item);
  for (const auto& member : node.members) count += count_nodes(member.value);
  return count;
}

/// Builds the tree from the parser's events; yaml-cpp's own tree keeps only the first of two equal keys.
class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::string name) : name_(std::move(name)) {}

  YamlNode take_root() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (at_key()) fail(mark, "a key without a name; a name is needed before the colon");
    add_leaf(YamlNode{YamlNode::Kind::null, place(mark), {}, {}, {}}, anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    if (at_key()) fail(mark, "an alias as a key; keys are plain names");
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end())
      fail(mark, "an alias inside what it stands for; aliases may not be recursive");
    nodes_by_alias_ += count_nodes(found->second);
    if (nodes_by_alias_ > most_nodes_by_alias) fail(mark, "aliases that grow without bounds; fewer aliases");
    add_leaf(found->second, 0);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    if (at_key()) {
      start_member(mark, value);
      return;
    }
    // "!" marks a quoted scalar, "?" a plain one.
    const bool null = tag == "?" && (value == "~" || value == "null");
    add_leaf(YamlNode{null ? YamlNode::Kind::null : YamlNode::Kind::scalar, place(mark), value, {}, {}},
             anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open(mark, YamlNode::Kind::sequence, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(mark, YamlNode::Kind::map, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Level {
    YamlNode node;
    YAML::anchor_t anchor = 0;
    bool key_pending = false;  ///< a map's key was read, its value comes next
  };

  std::string place(const YAML::Mark& mark) const { return fmt::format("{}:{}", name_, mark.line + 1); }

  /// Dotted path of the value that comes next.
  std::string path() const {
    std::string path;
    for (const auto& level : levels_) {
      std::string step;
      if (level.node.kind == YamlNode::Kind::sequence) {
        step = std::to_string(level.node.items.size());
      } else if (level.key_pending) {
        step = level.node.members.back().name;
      }
      if (!step.empty()) path += (path.empty() ? "" : ".") + step;
    }
    return path;
  }

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& what) const {
    const std::string key = path();
    throw InputError(fmt::format("{}: {}{}{}", place(mark), key, key.empty() ? "" : ": ", what));
  }

  bool at_key() const {
    return !levels_.empty() && levels_.back().node.kind == YamlNode::Kind::map && !levels_.back().key_pending;
  }

  void start_member(const YAML::Mark& mark, const std::string& key) {
    auto& level = levels_.back();
    if (const YamlNode* first = level.node.find(key)) {
      const std::string parent = path();
      throw InputError(fmt::format("{}: {}{}{}: given twice, first at {}; each key may be given once",
                                   place(mark), parent, parent.empty() ? "" : ".", key, first->place));
    }
    YamlNode value;
    value.place = place(mark);
    level.node.members.push_back({key, std::move(value)});
    level.key_pending = true;
  }

  void open(const YAML::Mark& mark, YamlNode::Kind kind, YAML::anchor_t anchor) {
    if (at_key()) fail(mark, "a list or section as a key; keys are plain names");
    Level level;
    level.node.kind = kind;
    level.node.place = place(mark);
    level.anchor = anchor;
    levels_.push_back(std::move(level));
  }

  void close() {
    Level level = std::move(levels_.back());
    levels_.pop_back();
    add_leaf(std::move(level.node), level.anchor);
  }

  void add_leaf(YamlNode node, YAML::anchor_t anchor) {
    if (anchor != 0) anchors_[anchor] = node;
    if (levels_.empty()) {
      root_ = std::move(node);
      return;
    }
    auto& level = levels_.back();
    if (level.node.kind == YamlNode::Kind::sequence) {
      level.node.items.push_back(std::move(node));
    } else {
      YamlNode& slot = level.node.members.back().value;
      node.place = slot.place;
      slot = std::move(node);
      level.key_pending = false;
    }
  }

  std::string name_;
  YamlNode root_;
  std::vector<Level> levels_;
  std::map<YAML::anchor_t, YamlNode> anchors_;
  std::size_t nodes_by_alias_ = 0;
};

void set_place(YamlNode& node, const std::string& place) {
  node.place = place;
  for (auto& item : node.items) set_place(item, place);
  for (auto& member : node.members) set_place(member.value, place);
}

/// The entry of a list that a step of an override's path names, by index or by its `name`; nullptr if there is none.
YamlNode* find_item(YamlNode& list, const std::string& step) {
  std::size_t index = 0;
  const auto [end, status] = std::from_chars(step.data(), step.data() + step.size(), index);
  if (status == std::errc{} && end == step.data() + step.size()) {
    return index < list.items.size() ? &list.items[index] : nullptr;
  }
  for (auto& item : list.items) {
    const YamlNode* name = item.find("name");
    if (name != nullptr && name->kind == YamlNode::Kind::scalar && name->text == step) return &item;
  }
  return nullptr;
}

void remove_child(YamlNode& parent, const YamlNode* child) {
  std::erase_if(parent.items, [&](const YamlNode& item) { return &item == child; });
  std::erase_if(parent.members, [&](const auto& member) { return &member.value == child; });
}

std::string name_items(const YamlNode& list) {
  if (list.items.empty()) return "the list is empty";
  std::string names = list.items.size() == 1 ? "0" : fmt::format("0 to {}", list.items.size() - 1);
  for (const auto& item : list.items) {
    const YamlNode* name = item.find("name");
    if (name != nullptr && name->kind == YamlNode::Kind::scalar) names += ", " + name->text;
  }
  return names;
}

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  const auto found =
      std::find_if(members.begin(), members.end(), [&](const auto& m) { return m.name == key; });
  return found == members.end() ? nullptr : &found->value;
}

YamlNode* YamlNode::find(std::string_view key) {
  return const_cast<YamlNode*>(std::as_const(*this).find(key));
}

YamlNode parse_yaml(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  TreeBuilder builder(name);
  try {
    YAML::Parser parser(stream);
    parser.HandleNextDocument(builder);
    YamlNode root = builder.take_root();
    if (root.place.empty()) root.place = name + ":1";
    TreeBuilder second(name);
    if (parser.HandleNextDocument(second)) {
      throw InputError(
          fmt::format("{}: more than one YAML document; one document", second.take_root().place));
    }
    return root;
  } catch (const YAML::Exception& error) {
    throw InputError(
        fmt::format("{}:{}: not valid YAML: {}; a YAML document", name, error.mark.line + 1, error.msg));
  }
}

YamlNode read_yaml_file(const std::string& path) {
  const auto fail = [&](const std::string& why) {
    throw InputError(fmt::format("{}: cannot be read: {}; a readable YAML file", path, why));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) fail("it is a folder");
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(std::strerror(errno));
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) fail(std::strerror(errno));
  if (text.str().find('\0') != std::string::npos) fail("it is no text");
  return parse_yaml(text.str(), path);
}

void apply_override(YamlNode& root, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const std::string path = assignment.substr(0, equals);
  if (equals == std::string::npos || path.empty() || path.front() == '.' || path.back() == '.' ||
      path.find("..") != std::string::npos) {
    throw InputError(
        fmt::format("--set: \"{}\" is not an assignment; path=value, such as time.end=\"2 s\"", assignment));
  }
  const auto fail = [](const std::string& where, const std::string& what) {
    throw InputError(fmt::format("--set: {}: {}", where, what));
  };

  YamlNode* parent = &root;
  std::string walked;
  std::string rest = path;
  for (;;) {
    const auto dot = rest.find('.');
    const std::string step = rest.substr(0, dot);
    const std::string here = walked.empty() ? step : walked + "." + step;
    const bool last = dot == std::string::npos;
    YamlNode* child = nullptr;
    if (parent->kind == YamlNode::Kind::sequence) {
      child = find_item(*parent, step);
      if (child == nullptr) fail(here, "no such entry; " + name_items(*parent));
    } else if (parent->kind == YamlNode::Kind::scalar) {
      fail(here, fmt::format("{} is a value, not a section; the path of a key", walked));
    } else {
      parent->kind = YamlNode::Kind::map;
      child = parent->find(step);
      if (child == nullptr) {
        parent->members.push_back({step, YamlNode{}});
        child = &parent->members.back().value;
        child->place = override_place;
      }
    }
    if (last) {
      const std::string text = assignment.substr(equals + 1);
      if (text.empty()) {
        remove_child(*parent, child);
        return;
      }
      YamlNode value;
      try {
        value = parse_yaml(text, std::string(override_place));
      } catch (const InputError&) {
        fail(path, fmt::format("\"{}\" is not valid YAML; a value such as 0.5, \"5 mm\" or [1, 2, 3]", text));
      }
      set_place(value, std::string(override_place));
      *child = std::move(value);
      return;
    }
    parent = child;
    walked = here;
    rest = rest.substr(dot + 1);
  }
}

}  // namespace pellicle::core
