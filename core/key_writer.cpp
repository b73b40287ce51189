#include "core/key_writer.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace pellicle::core {

namespace {

bool is_plain(const std::string& text) {
  static const std::vector<std::string> special{"true", "false", "null", "yes", "no", "on", "off", "y", "n"};
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto later = [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == ' ' || c == '-' || c == '.' || c == '/' || c == '(' ||
           c == ')' || c == '+';
  };
  return !text.empty() && letter(text.front()) && text.back() != ' ' &&
         std::all_of(text.begin(), text.end(), later) &&
         std::find(special.begin(), special.end(), text) == special.end();
}

template <class Value, class ToText>
std::string join(const std::vector<Value>& values, const ToText& to_text) {
  std::string joined = "[";
  for (const auto& value : values) joined += (joined.size() > 1 ? ", " : "") + to_text(value);
  return joined + "]";
}

class Writer : public Keys {
 public:
  /// Lines of the section, without indentation of the section itself.
  std::vector<std::string> lines;

  void exactly_one(const std::vector<std::string_view>&) override {}

 private:
  void add(const Key& key, const std::string& value, std::string_view unit = {}) {
    lines.push_back(
        fmt::format("{}: {}{}", key.name, value, unit.empty() ? "" : fmt::format("  # [{}]", unit)));
  }
  void add_indented(const std::vector<std::string>& inner, const std::string& first = "  ") {
    for (std::size_t i = 0; i < inner.size(); ++i) lines.push_back((i == 0 ? first : "  ") + inner[i]);
  }

  void visit_real(const Key& key, const RealRule& rule, std::optional<Real>& value) override {
    if (value) add(key, to_yaml(*value), rule.dimension.unit);
  }
  void visit_whole(const Key& key, const WholeRule&, std::optional<std::int64_t>& value) override {
    if (value) add(key, std::to_string(*value));
  }
  void visit_flag(const Key& key, std::optional<bool>& value) override {
    if (value) add(key, *value ? "true" : "false");
  }
  void visit_text(const Key& key, TextRule, std::optional<std::string>& value) override {
    if (value) add(key, to_yaml(*value));
  }
  void visit_choice(const Key& key, ModelList allowed, std::optional<int>& value) override {
    if (value) add(key, std::string(allowed[static_cast<std::size_t>(*value)].name));
  }
  void visit_mark(const Key& key, bool& present) override {
    if (present) add(key, "{}");
  }
  void visit_reals(const Key& key, const RealRule& rule, Size,
                   std::optional<std::vector<Real>>& value) override {
    if (value) add(key, to_yaml(*value), rule.dimension.unit);
  }
  void visit_wholes(const Key& key, const WholeRule&, Size,
                    std::optional<std::vector<std::int64_t>>& value) override {
    if (value) add(key, to_yaml(*value));
  }
  void visit_texts(const Key& key, TextRule, Size, std::optional<std::vector<std::string>>& value) override {
    if (value) add(key, to_yaml(*value));
  }
  void visit_choices(const Key& key, ModelList allowed, Size,
                     std::optional<std::vector<int>>& value) override {
    if (!value) return;
    add(key, join(*value, [&](int at) { return std::string(allowed[static_cast<std::size_t>(at)].name); }));
  }

  void visit_section(const Key& key, bool, bool& present, const Describe& describe) override {
    if (!present) return;
    Writer inner;
    describe(inner);
    lines.push_back(fmt::format("{}:{}", key.name, inner.lines.empty() ? " {}" : ""));
    add_indented(inner.lines);
  }
  void visit_real_or_section(const Key& key, const RealRule& rule, std::optional<Real>& value, bool& present,
                             const Describe& describe) override {
    if (present) return visit_section(key, false, present, describe);
    visit_real(key, rule, value);
  }
  void visit_list(const Key& key, Size size, const Entries& entries) override {
    if (entries.count() < size.min) return;  // not given
    lines.push_back(fmt::format("{}:{}", key.name, entries.count() == 0 ? " []" : ""));
    for (std::size_t i = 0; i < entries.count(); ++i) {
      Writer inner;
      entries.describe(inner, i);
      if (inner.lines.empty()) inner.lines.emplace_back("{}");
      add_indented(inner.lines, "- ");
    }
  }
  void visit_named(const Key& key, const Entries& entries) override {
    lines.push_back(fmt::format("{}:{}", key.name, entries.count() == 0 ? " {}" : ""));
    for (std::size_t i = 0; i < entries.count(); ++i) {
      Writer entry;
      entries.describe(entry, i);
      Writer inner;
      inner.lines.push_back(fmt::format("{}:{}", entries.name(i), entry.lines.empty() ? " {}" : ""));
      inner.add_indented(entry.lines);
      add_indented(inner.lines);
    }
  }
};

}  // namespace

std::string to_yaml(Real value) { return fmt::format("{}", value); }

std::string to_yaml(const std::string& text) {
  if (is_plain(text)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string to_yaml(const std::vector<Real>& values) {
  return join(values, [](Real value) { return to_yaml(value); });
}
std::string to_yaml(const std::vector<std::int64_t>& values) {
  return join(values, [](std::int64_t value) { return std::to_string(value); });
}
std::string to_yaml(const std::vector<std::string>& texts) {
  return join(texts, [](const std::string& text) { return to_yaml(text); });
}

std::string write_keys(const std::function<void(Keys&)>& describe) {
  Writer writer;
  describe(writer);
  std::string text;
  for (const auto& line : writer.lines) text += line + "\n";
  return text;
}

}  // namespace pellicle::core
