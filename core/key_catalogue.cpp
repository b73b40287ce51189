#include "core/key_catalogue.hpp"

#include "core/key_writer.hpp"

namespace pellicle::core {

namespace {

class Catalogue : public Keys {
 public:
  explicit Catalogue(KeyInfo& section) : section_(section) {}

  void exactly_one(const std::vector<std::string_view>& names) override {
    section_.exactly_one.emplace_back(names.begin(), names.end());
  }

 private:
  KeyInfo& add(const Key& key, KeyType type, const std::string& default_text) {
    KeyInfo info;
    info.name = key.name;
    info.text = key.text;
    info.need = key.need;
    info.type = type;
    if (key.need == Need::has_default) {
      info.default_in_words = !key.otherwise.empty();
      info.default_text = info.default_in_words ? std::string(key.otherwise) : default_text;
    }
    section_.children.push_back(std::move(info));
    return section_.children.back();
  }

  void visit_real(const Key& key, const RealRule& rule, std::optional<Real>& value) override {
    add(key, KeyType::real, value ? to_yaml(*value) : "").real_rule = rule;
  }
  void visit_whole(const Key& key, const WholeRule& rule, std::optional<std::int64_t>& value) override {
    add(key, KeyType::whole, value ? std::to_string(*value) : "").whole_rule = rule;
  }
  void visit_flag(const Key& key, std::optional<bool>& value) override {
    add(key, KeyType::flag, value ? (*value ? "true" : "false") : "");
  }
  void visit_text(const Key& key, TextRule rule, std::optional<std::string>& value) override {
    add(key, KeyType::text, value ? to_yaml(*value) : "").text_rule = rule;
  }
  void visit_choice(const Key& key, ModelList allowed, std::optional<int>& value) override {
    add(key, KeyType::choice, value ? std::string(allowed[static_cast<std::size_t>(*value)].name) : "")
        .allowed = {allowed.begin(), allowed.end()};
  }
  void visit_mark(const Key& key, bool&) override { add(key, KeyType::mark, ""); }

  void visit_reals(const Key& key, const RealRule& rule, Size size,
                   std::optional<std::vector<Real>>& value) override {
    KeyInfo& info = add(key, KeyType::real, value ? to_yaml(*value) : "");
    info.real_rule = rule;
    info.is_list = true;
    info.size = size;
  }
  void visit_wholes(const Key& key, const WholeRule& rule, Size size,
                    std::optional<std::vector<std::int64_t>>& value) override {
    KeyInfo& info = add(key, KeyType::whole, value ? to_yaml(*value) : "");
    info.whole_rule = rule;
    info.is_list = true;
    info.size = size;
  }
  void visit_texts(const Key& key, TextRule rule, Size size,
                   std::optional<std::vector<std::string>>& value) override {
    KeyInfo& info = add(key, KeyType::text, value ? to_yaml(*value) : "");
    info.text_rule = rule;
    info.is_list = true;
    info.size = size;
  }
  void visit_choices(const Key& key, ModelList allowed, Size size,
                     std::optional<std::vector<int>>& value) override {
    std::vector<std::string> names;
    if (value) {
      for (const int position : *value) names.emplace_back(allowed[static_cast<std::size_t>(position)].name);
    }
    KeyInfo& info = add(key, KeyType::choice, value ? to_yaml(names) : "");
    info.allowed = {allowed.begin(), allowed.end()};
    info.is_list = true;
    info.size = size;
  }

  void visit_section(const Key& key, bool, bool&, const Describe& describe) override {
    KeyInfo& info = add(key, KeyType::section, "");
    Catalogue inner(info);
    describe(inner);
  }
  void visit_real_or_section(const Key& key, const RealRule& rule, std::optional<Real>& value, bool&,
                             const Describe& describe) override {
    KeyInfo& info = add(key, KeyType::real, value ? to_yaml(*value) : "");
    info.real_rule = rule;
    info.or_section = true;
    Catalogue inner(info);
    describe(inner);
  }
  void visit_list(const Key& key, Size size, const Entries& entries) override {
    KeyInfo& info = add(key, KeyType::section, "[]");
    info.is_list = true;
    info.size = size;
    Catalogue inner(info);
    entries.describe(inner, entries.count());
  }
  void visit_named(const Key& key, const Entries& entries) override {
    KeyInfo& info = add(key, KeyType::section, "{}");
    info.is_named = true;
    Catalogue inner(info);
    entries.describe(inner, entries.count());
  }

  KeyInfo& section_;
};

}  // namespace

KeyInfo catalogue_keys(const std::function<void(Keys&)>& describe) {
  KeyInfo root;
  Catalogue catalogue(root);
  describe(catalogue);
  return root;
}

}  // namespace pellicle::core
