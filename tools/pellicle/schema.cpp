#include "tools/pellicle/schema.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/key_catalogue.hpp"
#include "tools/pellicle/case_keys.hpp"
#include "tools/pellicle/model_families.hpp"

namespace pellicle::tools {

namespace {

using core::KeyInfo;
using core::KeyType;
using Json = nlohmann::ordered_json;

KeyInfo all_keys() {
  return core::catalogue_keys([](core::Keys& keys) {
    CaseSpec spec;
    describe_case(keys, spec);
  });
}

Json number_schema(const core::RealRule& rule) {
  Json number{{"type", "number"}};
  const core::Range& range = rule.range;
  if (std::isfinite(range.min)) number[range.min_excluded ? "exclusiveMinimum" : "minimum"] = range.min;
  if (std::isfinite(range.max)) number[range.max_excluded ? "exclusiveMaximum" : "maximum"] = range.max;
  const Json text{{"type", "string"}, {"pattern", "^ *[-+]?[0-9.]"}};
  return Json{{"anyOf", {number, text}}};
}

Json section_schema(const KeyInfo& section);

/// Schema of one value, without the list or the name around it.
Json value_schema(const KeyInfo& key) {
  switch (key.type) {
    case KeyType::real:
      if (key.or_section) return {{"anyOf", {number_schema(key.real_rule), section_schema(key)}}};
      return number_schema(key.real_rule);
    case KeyType::whole:
      return {{"type", "integer"}, {"minimum", key.whole_rule.min}, {"maximum", key.whole_rule.max}};
    case KeyType::flag:
      return {{"type", "boolean"}};
    case KeyType::text:
      if (key.text_rule == core::TextRule::name) return {{"type", "string"}, {"pattern", "^[A-Za-z0-9_-]+$"}};
      return {{"type", {"string", "number", "boolean"}}};
    case KeyType::choice: {
      Json names = Json::array();
      for (const auto& model : key.allowed) names.push_back(model.name);
      return {{"enum", names}};
    }
    case KeyType::mark:
      return {{"type", {"object", "null"}}, {"maxProperties", 0}};
    case KeyType::section:
      return section_schema(key);
  }
  return {};
}

Json key_schema(const KeyInfo& key) {
  Json schema = value_schema(key);
  if (key.is_list) {
    schema = Json{{"type", "array"}, {"items", schema}};
    if (key.size.min > 0) schema["minItems"] = key.size.min;
    if (key.size.max != core::Size{}.max) schema["maxItems"] = key.size.max;
  } else if (key.is_named) {
    schema = Json{{"type", "object"},
                  {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}},
                  {"additionalProperties", schema}};
  }
  std::string text = key.text;
  if (key.type == KeyType::real && !key.real_rule.dimension.unit.empty()) {
    text += fmt::format(" [{}]", key.real_rule.dimension.unit);
  }
  if (key.default_in_words) {
    text += fmt::format(" (default: {})", key.default_text);
  } else if (!key.default_text.empty()) {
    const Json parsed = Json::parse(key.default_text, nullptr, false);
    schema["default"] = parsed.is_discarded() ? Json(key.default_text) : parsed;
  }
  schema["description"] = text;
  return schema;
}

Json alternatives(const std::vector<std::string>& names) {
  Json each = Json::array();
  for (const auto& name : names) each.push_back({{"required", {name}}});
  return each;
}

Json section_schema(const KeyInfo& section) {
  Json schema{{"type", "object"}, {"additionalProperties", false}};
  Json required = Json::array();
  schema["properties"] = Json::object();
  for (const auto& key : section.children) {
    schema["properties"][key.name] = key_schema(key);
    if (key.need == core::Need::required) required.push_back(key.name);
  }
  if (!required.empty()) schema["required"] = required;
  Json rules = Json::array();
  for (const auto& names : section.exactly_one) rules.push_back({{"oneOf", alternatives(names)}});
  if (!rules.empty()) schema["allOf"] = rules;
  return schema;
}

/// Longer lists of choices are those of quantities, which have a table of their own.
constexpr std::size_t longest_list_in_a_table = 12;

/// What may be written for a key, for the docs.
std::string allowed_text(const KeyInfo& key) {
  std::string one;
  switch (key.type) {
    case KeyType::real:
      one = core::allowed_reals(key.real_rule);
      break;
    case KeyType::whole:
      one = core::allowed_wholes(key.whole_rule);
      break;
    case KeyType::flag:
      one = "`true` or `false`";
      break;
    case KeyType::text:
      one = key.text_rule == core::TextRule::name ? "a name of letters, digits, _ and -" : "a text";
      break;
    case KeyType::choice:
      if (key.allowed.size() > longest_list_in_a_table) {
        one = "a [quantity](#quantities)";
        break;
      }
      for (const auto& model : key.allowed) one += fmt::format("{}`{}`", one.empty() ? "" : ", ", model.name);
      break;
    case KeyType::mark:
      return "`{}`";
    case KeyType::section:
      if (key.is_list) return "a list of sections, see below";
      return key.is_named ? "names, each with a section, see below" : "a section, see below";
  }
  // A number without bounds says its unit already.
  if (key.type == KeyType::real && std::isinf(key.real_rule.range.min) &&
      std::isinf(key.real_rule.range.max)) {
    one = key.real_rule.dimension.unit.empty() ? "a number" : std::string(key.real_rule.dimension.name);
  }
  if (key.or_section) one += ", or a section, see below";
  if (!key.is_list) return one;
  return fmt::format("a list of {}, each {}{}", core::allowed_size(key.size),
                     key.type == KeyType::choice && !one.starts_with("a ") ? "one of " : "", one);
}

std::string sentence(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

void add_section(const KeyInfo& section, const std::string& path, std::string& markdown) {
  if (!path.empty()) markdown += fmt::format("\n### `{}`\n\n{}.\n", path, sentence(section.text));
  const auto rule = [&](std::string_view words, const std::vector<std::string>& names) {
    std::string all;
    for (const auto& name : names) all += (all.empty() ? "" : ", ") + code(name);
    markdown += fmt::format("\n{} of {}.\n", words, all);
  };
  for (const auto& names : section.exactly_one) {
    if (names.size() > 1) rule("Exactly one", names);
  }
  markdown += "\n| key | value | unit | default | meaning |\n|---|---|---|---|---|\n";
  for (const auto& key : section.children) {
    std::string otherwise = key.default_in_words ? key.default_text : code(key.default_text);
    if (key.need == core::Need::required) otherwise = "**required**";
    markdown += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name, allowed_text(key),
                            code(key.type == KeyType::real ? std::string(key.real_rule.dimension.unit) : ""),
                            otherwise, key.text);
  }
  for (const auto& key : section.children) {
    if (key.type != KeyType::section && !key.or_section) continue;
    const std::string ending = key.is_list ? "[]" : (key.is_named ? ".NAME" : "");
    add_section(key, (path.empty() ? "" : path + ".") + key.name + ending, markdown);
  }
}

}  // namespace

std::string case_schema_json() {
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "pellicle case file"}};
  schema.update(section_schema(all_keys()));
  return schema.dump(2) + "\n";
}

std::string case_schema_markdown() {
  std::string markdown = "## Keys\n";
  add_section(all_keys(), "", markdown);
  markdown += "\n## Models\n";
  for (const auto& family : model_families()) {
    markdown += fmt::format("\n### `{}`\n\n{}.\n\n| name | what it is | source |\n|---|---|---|\n",
                            family.key, family.title);
    for (const auto& model : family.models) {
      markdown += fmt::format("| `{}` | {} | {} |\n", model.name, model.description, model.source);
    }
  }
  markdown += "\n## Quantities\n";
  for (const auto& family : quantity_families()) {
    markdown += fmt::format("\n{}:\n\n| name | what it is |\n|---|---|\n", family.title);
    for (const auto& quantity : family.models) {
      markdown += fmt::format("| `{}` | {} |\n", quantity.name, quantity.description);
    }
  }
  return markdown;
}

}  // namespace pellicle::tools
