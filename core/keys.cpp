#include "core/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace pellicle::core {

namespace {

/// Damerau-Levenshtein distance (optimal string alignment), capitals taken as small letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto same = [](char p, char q) {
    return std::tolower(static_cast<unsigned char>(p)) == std::tolower(static_cast<unsigned char>(q));
  };
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = same(a[i - 1], b[j - 1]) ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1])) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string allowed_reals(const RealRule& rule) {
  const Range& range = rule.range;
  if (std::isinf(range.min) && std::isinf(range.max)) return allowed_quantity(rule.dimension);
  const std::string unit = rule.dimension.unit.empty() ? "" : fmt::format(" {}", rule.dimension.unit);
  const auto bound = [&](Real value) {
    return value == 0 ? std::string("0") : fmt::format("{}{}", value, unit);
  };
  const std::string low =
      fmt::format("{} {}", range.min_excluded ? "greater than" : "at least", bound(range.min));
  const std::string high =
      fmt::format("{} {}", range.max_excluded ? "less than" : "at most", bound(range.max));
  const std::string_view what = rule.dimension.unit.empty() ? "a number" : rule.dimension.name;
  if (std::isinf(range.max)) return fmt::format("{} {}", what, low);
  if (std::isinf(range.min)) return fmt::format("{} {}", what, high);
  if (!range.min_excluded && !range.max_excluded) {
    return fmt::format("{} from {} to {}", what, bound(range.min), bound(range.max));
  }
  return fmt::format("{} {} and {}", what, low, high);
}

std::string allowed_wholes(const WholeRule& rule) {
  if (rule.max >= std::numeric_limits<Index>::max())
    return fmt::format("a whole number, at least {}", rule.min);
  return fmt::format("a whole number from {} to {}", rule.min, rule.max);
}

std::string allowed_names(ModelList allowed) {
  std::string names;
  for (const auto& model : allowed) names += (names.empty() ? "" : ", ") + std::string(model.name);
  return names;
}

std::string allowed_size(Size size) {
  if (size.min == size.max) return fmt::format("{} entries", size.min);
  if (size.max == Size{}.max)
    return fmt::format("at least {} {}", size.min, size.min == 1 ? "entry" : "entries");
  return fmt::format("{} to {} entries", size.min, size.max);
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  std::string nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const auto& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace pellicle::core
