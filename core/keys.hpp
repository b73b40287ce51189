// The keys of a file, declared once. A function that describes a section calls, for each of its keys, the member of
// `Keys` that fits the key's type, with a reference to where the value lives:
//
//   void describe(Keys& keys, MaterialSpec& material) {
//     keys.real({"density", "of the solid", Need::required}, {dimension::density, range::positive}, material.density);
//   }
//
// The same declaration reads a file (KeyReader), writes the file that says the same (KeyWriter), and lists all keys for
// the schema and the docs (KeyCatalogue). The value that a key without `Need::required` has before reading is its
// default.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/model_list.hpp"
#include "core/types.hpp"
#include "core/units.hpp"
#include "core/vector.hpp"

namespace pellicle::core {

enum class Need { has_default, required };

/// What every key has.
struct Key {
  std::string_view name;
  std::string_view text;  ///< what it means, one line
  Need need = Need::has_default;
  std::string_view otherwise{};  ///< the default in words, where it is no constant
};

/// Allowed values of a number, in SI.
struct Range {
  Real min = -std::numeric_limits<Real>::infinity();
  Real max = std::numeric_limits<Real>::infinity();
  bool min_excluded = false;
  bool max_excluded = false;

  bool contains(Real value) const {
    return (min_excluded ? value > min : value >= min) && (max_excluded ? value < max : value <= max);
  }
};

namespace range {
inline constexpr Range any{};
inline constexpr Range positive{.min = 0, .min_excluded = true};
inline constexpr Range non_negative{.min = 0};
inline constexpr Range from_0_to_1{.min = 0, .max = 1};
}  // namespace range

struct RealRule {
  Dimension dimension = dimension::pure_number;
  Range range = range::any;
};

struct WholeRule {
  std::int64_t min = 1;
  std::int64_t max = std::numeric_limits<Index>::max();
};

enum class TextRule {
  any,
  name,  ///< letters, digits, _ and -: used in file names and in the paths of `--set`
};

/// How many entries a list may have.
struct Size {
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();
  static constexpr Size exactly(std::size_t n) { return {n, n}; }
};

template <class T>
concept Enumeration = std::is_enum_v<T>;

class Keys;
/// Describes the keys of a section that is held as an `Entry`; a lambda will do.
template <class Entry>
using DescribeEntry = std::type_identity_t<std::function<void(Keys&, Entry&)>>;

/// Visits the keys of one section.
class Keys {
 public:
  virtual ~Keys() = default;

  using Describe = std::function<void(Keys&)>;
  /// Access to the entries of a list of sections, or of a section whose keys are names that the user chooses.
  struct Entries {
    std::function<std::size_t()> count;
    std::function<void()> append;
    std::function<void(Keys&, std::size_t)> describe;
    std::function<std::string&(std::size_t)> name{};  ///< only for named entries
  };
  // Rules across the keys of the section.
  virtual void exactly_one(const std::vector<std::string_view>& names) = 0;

  /// Whether a file is being read, so that values are the user's and may be checked.
  virtual bool reading() const { return false; }
  /// Whether a file is being read in which the key is given.
  virtual bool given(std::string_view /*name*/) const { return false; }
  /// `file:line: path` of a key of this section, or of the section itself. Empty unless reading.
  virtual std::string where(std::string_view /*name*/ = {}) const { return {}; }
  /// Reports what is wrong with a key, `what is wrong; what is allowed`. Only while reading.
  virtual void problem(std::string_view /*name*/, const std::string& /*what*/) {}

  // One number, text or choice, or a list of them; an empty optional stands for a key that is not there.
  void real(const Key& key, const RealRule& rule, std::optional<Real>& value) {
    visit_real(key, rule, value);
  }
  void real(const Key& key, const RealRule& rule, Real& value) {
    pass(value, [&](auto& v) { visit_real(key, rule, v); });
  }
  void flag(const Key& key, bool& value) {
    pass(value, [&](auto& v) { visit_flag(key, v); });
  }
  void flag(const Key& key, std::optional<bool>& value) { visit_flag(key, value); }
  void text(const Key& key, TextRule rule, std::optional<std::string>& value) {
    visit_text(key, rule, value);
  }
  void text(const Key& key, TextRule rule, std::string& value) {
    pass(value, [&](auto& v) { visit_text(key, rule, v); });
  }
  void reals(const Key& key, const RealRule& rule, Size size, std::optional<std::vector<Real>>& value) {
    visit_reals(key, rule, size, value);
  }
  void reals(const Key& key, const RealRule& rule, Size size, std::vector<Real>& value) {
    pass(value, [&](auto& v) { visit_reals(key, rule, size, v); });
  }
  void texts(const Key& key, TextRule rule, Size size, std::optional<std::vector<std::string>>& value) {
    visit_texts(key, rule, size, value);
  }
  void texts(const Key& key, TextRule rule, Size size, std::vector<std::string>& value) {
    pass(value, [&](auto& v) { visit_texts(key, rule, size, v); });
  }

  template <std::integral Integer>
  void whole(const Key& key, const WholeRule& rule, Integer& value) {
    auto wide = std::optional(static_cast<std::int64_t>(value));
    visit_whole(key, rule, wide);
    value = static_cast<Integer>(*wide);
  }
  void whole(const Key& key, const WholeRule& rule, std::optional<Index>& value) {
    std::optional<std::int64_t> wide = value;
    visit_whole(key, rule, wide);
    if (wide) value = static_cast<Index>(*wide);
  }

  void vector(const Key& key, const RealRule& rule, std::optional<Vec3>& value) {
    std::optional<std::vector<Real>> list;
    if (value) list = std::vector<Real>{value->x, value->y, value->z};
    visit_reals(key, rule, Size::exactly(3), list);
    if (list) value = Vec3{(*list)[0], (*list)[1], (*list)[2]};
  }
  void vector(const Key& key, const RealRule& rule, Vec3& value) {
    pass(value, [&](auto& v) { vector(key, rule, v); });
  }
  void wholes(const Key& key, const WholeRule& rule, Size size,
              std::optional<std::vector<std::int64_t>>& value) {
    visit_wholes(key, rule, size, value);
  }
  void counts(const Key& key, const WholeRule& rule, Index3& value) {
    std::optional<std::vector<std::int64_t>> list = std::vector<std::int64_t>{value.x, value.y, value.z};
    visit_wholes(key, rule, Size::exactly(3), list);
    value = {static_cast<Index>((*list)[0]), static_cast<Index>((*list)[1]), static_cast<Index>((*list)[2])};
  }

  /// A key that says all by being there: `free_slip: {}`.
  void mark(const Key& key, bool& present) { visit_mark(key, present); }
  /// The value is a position in `allowed`.
  void choice(const Key& key, ModelList allowed, std::optional<int>& value) {
    visit_choice(key, allowed, value);
  }
  /// A choice held as an enumeration whose values are the positions in `allowed`.
  template <Enumeration Enum>
  void choice(const Key& key, ModelList allowed, Enum& value) {
    auto position = std::optional(static_cast<int>(value));
    visit_choice(key, allowed, position);
    value = static_cast<Enum>(*position);
  }
  /// A choice held as the name.
  void choice(const Key& key, ModelList allowed, std::string& value) {
    std::optional<int> position = find_model(allowed, value);
    if (*position < 0) position.reset();
    visit_choice(key, allowed, position);
    if (position) value = allowed[static_cast<std::size_t>(*position)].name;
  }
  void choices(const Key& key, ModelList allowed, Size size, std::optional<std::vector<int>>& values) {
    visit_choices(key, allowed, size, values);
  }
  template <Enumeration Enum>
  void choices(const Key& key, ModelList allowed, Size size, std::vector<Enum>& values) {
    std::optional<std::vector<int>> positions = std::vector<int>{};
    for (const Enum value : values) positions->push_back(static_cast<int>(value));
    visit_choices(key, allowed, size, positions);
    values.clear();
    for (const int position : *positions) values.push_back(static_cast<Enum>(position));
  }
  void choices(const Key& key, ModelList allowed, Size size, std::vector<std::string>& values) {
    std::optional<std::vector<int>> positions = std::vector<int>{};
    for (const auto& value : values) positions->push_back(find_model(allowed, value));
    visit_choices(key, allowed, size, positions);
    values.clear();
    for (const int position : *positions)
      values.emplace_back(allowed[static_cast<std::size_t>(position)].name);
  }

  template <class Section>
  void section(const Key& key, Section& value, const DescribeEntry<Section>& describe) {
    bool present = true;
    visit_section(key, true, present, [&](Keys& keys) { describe(keys, value); });
  }
  template <class Section>
  void section(const Key& key, std::optional<Section>& value, const DescribeEntry<Section>& describe) {
    bool present = value.has_value();
    Section held = present ? *value : Section{};
    visit_section(key, false, present, [&](Keys& keys) { describe(keys, held); });
    if (present) value = std::move(held);
  }
  /// A number, or a section that says more: `diameter: 3 mm` or `diameter: {uniform: ...}`. A file has one of the two.
  template <class Section>
  void real_or_section(const Key& key, const RealRule& rule, std::optional<Real>& value,
                       std::optional<Section>& section, const DescribeEntry<Section>& describe) {
    bool present = section.has_value();
    Section held = present ? *section : Section{};
    visit_real_or_section(key, rule, value, present, [&](Keys& keys) { describe(keys, held); });
    if (present) section = std::move(held);
  }
  template <class Entry>
  void list(const Key& key, Size size, std::vector<Entry>& values, const DescribeEntry<Entry>& describe) {
    visit_list(key, size,
               {.count = [&] { return values.size(); },
                .append = [&] { values.emplace_back(); },
                .describe =
                    [&](Keys& keys, std::size_t i) {
                      if (i < values.size()) return describe(keys, values[i]);
                      Entry sample{};
                      describe(keys, sample);
                    }});
  }
  /// A section whose keys are names that the user chooses; `Entry` has a member `name`.
  template <class Entry>
  void named(const Key& key, std::vector<Entry>& values, const DescribeEntry<Entry>& describe) {
    visit_named(key, {.count = [&] { return values.size(); },
                      .append = [&] { values.emplace_back(); },
                      .describe =
                          [&](Keys& keys, std::size_t i) {
                            if (i < values.size()) return describe(keys, values[i]);
                            Entry sample{};
                            describe(keys, sample);
                          },
                      .name = [&](std::size_t i) -> std::string& { return values[i].name; }});
  }

 private:
  virtual void visit_real(const Key& key, const RealRule& rule, std::optional<Real>& value) = 0;
  virtual void visit_whole(const Key& key, const WholeRule& rule, std::optional<std::int64_t>& value) = 0;
  virtual void visit_flag(const Key& key, std::optional<bool>& value) = 0;
  virtual void visit_text(const Key& key, TextRule rule, std::optional<std::string>& value) = 0;
  virtual void visit_choice(const Key& key, ModelList allowed, std::optional<int>& value) = 0;
  virtual void visit_mark(const Key& key, bool& present) = 0;
  virtual void visit_reals(const Key& key, const RealRule& rule, Size size,
                           std::optional<std::vector<Real>>& value) = 0;
  virtual void visit_wholes(const Key& key, const WholeRule& rule, Size size,
                            std::optional<std::vector<std::int64_t>>& value) = 0;
  virtual void visit_texts(const Key& key, TextRule rule, Size size,
                           std::optional<std::vector<std::string>>& value) = 0;
  virtual void visit_choices(const Key& key, ModelList allowed, Size size,
                             std::optional<std::vector<int>>& value) = 0;
  /// `present` is whether the section is there; with `always` it is, though perhaps with nothing but defaults.
  virtual void visit_section(const Key& key, bool always, bool& present, const Describe& describe) = 0;
  virtual void visit_real_or_section(const Key& key, const RealRule& rule, std::optional<Real>& value,
                                     bool& present, const Describe& describe) = 0;
  virtual void visit_list(const Key& key, Size size, const Entries& entries) = 0;
  virtual void visit_named(const Key& key, const Entries& entries) = 0;

  template <class Value, class Visit>
  static void pass(Value& value, const Visit& visit) {
    std::optional<Value> held = value;
    visit(held);
    value = std::move(*held);
  }
};

/// `a length greater than 0`, `a whole number from 1 to 5`: what a message says is allowed.
std::string allowed_reals(const RealRule& rule);
std::string allowed_wholes(const WholeRule& rule);
/// `a, b, c`
std::string allowed_names(ModelList allowed);
std::string allowed_size(Size size);

/// The name in `known` that has the fewest letters to change, insert, leave out or swap; empty if `known` is.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);

}  // namespace pellicle::core
