#include "core/key_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.hpp"

namespace pellicle::core {

namespace {

using Kind = YamlNode::Kind;

std::string_view kind_name(Kind kind) {
  switch (kind) {
    case Kind::null:
      return "nothing";
    case Kind::scalar:
      return "a single value";
    case Kind::sequence:
      return "a list";
    case Kind::map:
      return "a section";
  }
  return {};
}

bool is_name(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

/// What the readers of all sections share.
struct Document {
  InputProblems& problems;
  std::map<std::string, std::string>& places;
};

class Reader : public Keys {
 public:
  /// A section that is not there is read as if it were empty, so that keys which must be given are missed.
  Reader(Document& document, const YamlNode* section, std::string path, std::string place)
      : document_(document), section_(section), path_(std::move(path)), place_(std::move(place)) {}

  bool reading() const override { return true; }
  bool given(std::string_view name) const override { return find(name) != nullptr; }

  std::string where(std::string_view name) const override {
    const YamlNode* node = name.empty() ? nullptr : find(name);
    const std::string path = name.empty() ? path_ : path_of(name);
    return (node != nullptr ? node->place : place_) + (path.empty() ? "" : ": " + path);
  }

  void problem(std::string_view name, const std::string& what) override {
    document_.problems.add(where(name), what);
  }

  void exactly_one(const std::vector<std::string_view>& names) override {
    const auto there = given_of(names);
    if (there.size() == 1) return;
    // What is wrong with each of several may not matter once one of them is left.
    for (const auto& name : there) document_.problems.forget(path_of(name));
    report_alternatives(names, there);
  }
  /// To be called when all keys of the section have been described.
  void report_unknown_keys() const {
    if (section_ == nullptr) return;
    for (const auto& [name, node] : section_->members) {
      if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
      std::string known;
      for (const auto& key : known_) known += (known.empty() ? "" : ", ") + key;
      document_.problems.add(node.place + ": " + path_of(name),
                             known_.empty() ? std::string("unknown key; no keys are known here")
                                            : fmt::format("unknown key, the nearest is {}; known here: {}",
                                                          nearest_name(name, known_), known));
    }
  }

 private:
  std::string path_of(std::string_view name) const {
    return path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name);
  }

  const YamlNode* find(std::string_view name) const {
    return section_ == nullptr ? nullptr : section_->find(name);
  }

  /// The node of a key, if it is given; one that must be given is missed here.
  const YamlNode* take(const Key& key, const std::string& allowed) {
    known_.emplace_back(key.name);
    const YamlNode* node = find(key.name);
    if (node != nullptr) {
      document_.places[path_of(key.name)] = node->place;
    } else if (key.need == Need::required) {
      problem(key.name, fmt::format("missing; {}", allowed));
    }
    return node;
  }

  /// Whether the node is of the kind; if not, that is reported. Nothing at all is an empty section or list.
  bool expect(const YamlNode& node, const std::string& path, Kind kind, const std::string& allowed) {
    if (node.kind == kind || (node.kind == Kind::null && kind != Kind::scalar)) return true;
    document_.problems.add(
        node.place + ": " + path,
        fmt::format("{} is given where {} is expected; {}", kind_name(node.kind), kind_name(kind), allowed));
    return false;
  }

  std::vector<std::string> given_of(const std::vector<std::string_view>& names) const {
    std::vector<std::string> there;
    for (const auto name : names) {
      if (given(name)) there.emplace_back(name);
    }
    return there;
  }

  void report_alternatives(const std::vector<std::string_view>& names,
                           const std::vector<std::string>& there) {
    std::string found;
    for (const auto& name : there) found += (found.empty() ? "" : " and ") + name;
    std::string all;
    for (const auto name : names) all += (all.empty() ? "" : ", ") + std::string(name);
    problem({}, fmt::format("{} {} given; exactly one of {}", there.empty() ? "none" : found,
                            there.size() > 1 ? "are" : "is", all));
  }

  // Single values. Each reads one node and says whether it could.

  bool read_real(const YamlNode& node, const std::string& path, const RealRule& rule, Real& value) {
    if (!expect(node, path, Kind::scalar, allowed_quantity(rule.dimension))) return false;
    try {
      const Real read = parse_quantity(node.text, rule.dimension);
      if (rule.range.contains(read)) {
        value = read;
        return true;
      }
      document_.problems.add(node.place + ": " + path,
                             fmt::format("\"{}\" is out of range; {}", node.text, allowed_reals(rule)));
    } catch (const UnitError& error) {
      document_.problems.add(node.place + ": " + path, error.what());
    }
    return false;
  }

  bool read_whole(const YamlNode& node, const std::string& path, const WholeRule& rule, std::int64_t& value) {
    if (!expect(node, path, Kind::scalar, allowed_wholes(rule))) return false;
    std::int64_t read = 0;
    const char* const last = node.text.data() + node.text.size();
    const auto [end, status] = std::from_chars(node.text.data(), last, read);
    bool whole = status == std::errc{} && end == last;
    if (!whole) {  // 1e6 is a whole number too
      Real real = 0;
      const auto [real_end, real_status] = std::from_chars(node.text.data(), last, real);
      whole =
          real_status == std::errc{} && real_end == last && std::abs(real) < 1e15 && std::floor(real) == real;
      if (whole) read = static_cast<std::int64_t>(real);
    }
    if (!whole) {
      document_.problems.add(node.place + ": " + path, fmt::format("\"{}\" is not a whole number; {}",
                                                                   node.text, allowed_wholes(rule)));
    } else if (read < rule.min || read > rule.max) {
      document_.problems.add(node.place + ": " + path,
                             fmt::format("\"{}\" is out of range; {}", node.text, allowed_wholes(rule)));
    } else {
      value = read;
      return true;
    }
    return false;
  }

  bool read_text(const YamlNode& node, const std::string& path, TextRule rule, std::string& value) {
    const std::string allowed = rule == TextRule::name ? "a name of letters, digits, _ and -" : "a text";
    if (!expect(node, path, Kind::scalar, allowed)) return false;
    if (rule == TextRule::name && !is_name(node.text)) {
      document_.problems.add(node.place + ": " + path,
                             fmt::format("\"{}\" is no name; {}", node.text, allowed));
      return false;
    }
    value = node.text;
    return true;
  }

  bool read_choice(const YamlNode& node, const std::string& path, ModelList allowed, int& value) {
    if (!expect(node, path, Kind::scalar, allowed_names(allowed))) return false;
    const int found = find_model(allowed, node.text);
    if (found < 0) {
      std::vector<std::string> names;
      for (const auto& model : allowed) names.emplace_back(model.name);
      document_.problems.add(node.place + ": " + path,
                             fmt::format("\"{}\" is unknown, the nearest is {}; {}", node.text,
                                         nearest_name(node.text, names), allowed_names(allowed)));
      return false;
    }
    value = found;
    return true;
  }

  /// Reads a list entry by entry with `read(node, path, value)`.
  template <class Value, class Read>
  void read_list(const Key& key, Size size, const std::string& allowed,
                 std::optional<std::vector<Value>>& value, const Read& read) {
    const std::string what = fmt::format("a list of {}, each {}", allowed_size(size), allowed);
    const YamlNode* node = take(key, what);
    const std::string path = path_of(key.name);
    if (node == nullptr || !expect(*node, path, Kind::sequence, what)) return;
    const std::size_t count = node->items.size();
    if (count < size.min || count > size.max) {
      document_.problems.add(node->place + ": " + path, fmt::format("the list has {} {}; {}", count,
                                                                    count == 1 ? "entry" : "entries", what));
      return;
    }
    std::vector<Value> values(count);
    bool good = true;
    for (std::size_t i = 0; i < count; ++i) {
      good = read(node->items[i], fmt::format("{}.{}", path, i), values[i]) && good;
    }
    if (good) value = std::move(values);
  }

  void visit_real(const Key& key, const RealRule& rule, std::optional<Real>& value) override {
    Real read = 0;
    const YamlNode* node = take(key, allowed_reals(rule));
    if (node != nullptr && read_real(*node, path_of(key.name), rule, read)) value = read;
  }
  void visit_whole(const Key& key, const WholeRule& rule, std::optional<std::int64_t>& value) override {
    std::int64_t read = 0;
    const YamlNode* node = take(key, allowed_wholes(rule));
    if (node != nullptr && read_whole(*node, path_of(key.name), rule, read)) value = read;
  }
  void visit_flag(const Key& key, std::optional<bool>& value) override {
    const YamlNode* node = take(key, "true or false");
    const std::string path = path_of(key.name);
    if (node == nullptr || !expect(*node, path, Kind::scalar, "true or false")) return;
    if (node->text != "true" && node->text != "false") {
      problem(key.name, fmt::format("\"{}\" is neither true nor false; true or false", node->text));
      return;
    }
    value = node->text == "true";
  }
  void visit_text(const Key& key, TextRule rule, std::optional<std::string>& value) override {
    std::string read;
    const YamlNode* node =
        take(key, rule == TextRule::name ? "a name of letters, digits, _ and -" : "a text");
    if (node != nullptr && read_text(*node, path_of(key.name), rule, read)) value = read;
  }
  void visit_choice(const Key& key, ModelList allowed, std::optional<int>& value) override {
    int read = 0;
    const YamlNode* node = take(key, allowed_names(allowed));
    if (node != nullptr && read_choice(*node, path_of(key.name), allowed, read)) value = read;
  }
  void visit_mark(const Key& key, bool& present) override {
    known_.emplace_back(key.name);
    const YamlNode* node = find(key.name);
    if (node == nullptr) return;
    document_.places[path_of(key.name)] = node->place;
    present = node->kind == Kind::null || (node->kind == Kind::map && node->members.empty());
    if (!present) problem(key.name, fmt::format("it takes no values; {}: {{}}", key.name));
  }

  void visit_reals(const Key& key, const RealRule& rule, Size size,
                   std::optional<std::vector<Real>>& value) override {
    read_list(key, size, allowed_reals(rule), value,
              [&](const YamlNode& node, const std::string& path, Real& v) {
                return read_real(node, path, rule, v);
              });
  }
  void visit_wholes(const Key& key, const WholeRule& rule, Size size,
                    std::optional<std::vector<std::int64_t>>& value) override {
    read_list(key, size, allowed_wholes(rule), value,
              [&](const YamlNode& node, const std::string& path, std::int64_t& v) {
                return read_whole(node, path, rule, v);
              });
  }
  void visit_texts(const Key& key, TextRule rule, Size size,
                   std::optional<std::vector<std::string>>& value) override {
    read_list(key, size, rule == TextRule::name ? "a name of letters, digits, _ and -" : "a text", value,
              [&](const YamlNode& node, const std::string& path, std::string& v) {
                return read_text(node, path, rule, v);
              });
  }
  void visit_choices(const Key& key, ModelList allowed, Size size,
                     std::optional<std::vector<int>>& value) override {
    read_list(key, size, "one of " + allowed_names(allowed), value,
              [&](const YamlNode& node, const std::string& path, int& v) {
                return read_choice(node, path, allowed, v);
              });
  }

  /// Reads one section; `node` is nullptr if it is not there.
  void read_section(const YamlNode* node, const std::string& path, const std::string& place,
                    const Describe& describe) {
    Reader inner(document_, node, path, place);
    describe(inner);
    inner.report_unknown_keys();
  }

  void visit_section(const Key& key, bool always, bool& present, const Describe& describe) override {
    const YamlNode* node = take(key, "a section");
    const std::string path = path_of(key.name);
    if (node != nullptr) {
      present = true;
      if (expect(*node, path, Kind::map, "keys with values")) read_section(node, path, node->place, describe);
    } else if (always && key.need != Need::required) {
      read_section(nullptr, path, place_, describe);
    }
  }

  void visit_real_or_section(const Key& key, const RealRule& rule, std::optional<Real>& value, bool& present,
                             const Describe& describe) override {
    const YamlNode* node = find(key.name);
    if (node == nullptr || node->kind != Kind::map) return visit_real(key, rule, value);
    take(key, "");
    present = true;
    value.reset();
    read_section(node, path_of(key.name), node->place, describe);
  }

  void visit_list(const Key& key, Size size, const Entries& entries) override {
    const YamlNode* node = take(key, fmt::format("a list of {}", allowed_size(size)));
    const std::string path = path_of(key.name);
    if (node == nullptr || !expect(*node, path, Kind::sequence, "a list of sections, each starting with -"))
      return;
    if (node->items.size() < size.min || node->items.size() > size.max) {
      problem(key.name,
              fmt::format("the list has {} entries; a list of {}", node->items.size(), allowed_size(size)));
      return;
    }
    for (std::size_t i = 0; i < node->items.size(); ++i) {
      const YamlNode& item = node->items[i];
      const YamlNode* name = item.find("name");
      const bool named = name != nullptr && name->kind == Kind::scalar && is_name(name->text);
      const std::string item_path = path + "." + (named ? name->text : std::to_string(i));
      if (!expect(item, item_path, Kind::map, "keys with values")) continue;
      document_.places[item_path] = item.place;
      entries.append();
      const std::size_t last = entries.count() - 1;
      read_section(&item, item_path, item.place, [&](Keys& keys) { entries.describe(keys, last); });
    }
  }

  void visit_named(const Key& key, const Entries& entries) override {
    const YamlNode* node = take(key, "a section of names, each with a section of its own");
    const std::string path = path_of(key.name);
    if (node == nullptr || !expect(*node, path, Kind::map, "names, each with a section of its own")) return;
    for (const auto& [name, member] : node->members) {
      const std::string member_path = path + "." + name;
      if (!is_name(name)) {
        document_.problems.add(member.place + ": " + member_path,
                               fmt::format("\"{}\" is no name; a name of letters, digits, _ and -", name));
        continue;
      }
      if (!expect(member, member_path, Kind::map, "keys with values")) continue;
      document_.places[member_path] = member.place;
      entries.append();
      const std::size_t i = entries.count() - 1;
      entries.name(i) = name;
      read_section(&member, member_path, member.place, [&](Keys& keys) { entries.describe(keys, i); });
    }
  }

  Document& document_;
  const YamlNode* section_;
  std::string path_;
  std::string place_;
  std::vector<std::string> known_;
};

}  // namespace

void InputProblems::add(const std::string& where, const std::string& what) {
  messages_.push_back(where + ": " + what);
}

void InputProblems::forget(const std::string& path) {
  std::erase_if(messages_, [&](const std::string& message) {
    const auto begin = message.find(": ") + 2;  // after the place
    if (message.compare(begin, path.size(), path) != 0) return false;
    const char next = message[begin + path.size()];
    return next == ':' || next == '.';
  });
}

void InputProblems::throw_if_any() const {
  if (messages_.empty()) return;
  std::string all;
  for (const auto& message : messages_) all += (all.empty() ? "" : "\n") + message;
  throw InputError(all);
}

void read_keys(const YamlNode& root, const std::function<void(Keys&)>& describe, InputProblems& problems,
               std::map<std::string, std::string>& places) {
  Document document{problems, places};
  if (root.kind != Kind::map) {
    problems.add(root.place, fmt::format("{} is given where a section is expected; keys with values",
                                         kind_name(root.kind)));
    return;
  }
  Reader reader(document, &root, {}, root.place);
  describe(reader);
  reader.report_unknown_keys();
}

}  // namespace pellicle::core
