#include "core/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <charconv>
#include <cmath>
#include <memory>

#include "core/error.hpp"

namespace pellicle::core {

namespace {

struct FreeUnit {
  void operator()(ut_unit* unit) const { ut_free(unit); }
};
using Unit = std::unique_ptr<ut_unit, FreeUnit>;

struct FreeConverter {
  void operator()(cv_converter* converter) const { cv_free(converter); }
};

struct FreeSystem {
  void operator()(ut_system* system) const { ut_free_system(system); }
};

ut_system* unit_system() {
  static const std::unique_ptr<ut_system, FreeSystem> system = [] {
    ut_set_error_message_handler(ut_ignore);
    std::unique_ptr<ut_system, FreeSystem> read(ut_read_xml(nullptr));
    if (!read) {
      throw RunError(
          "the unit database of UDUNITS-2 cannot be read: is UDUNITS2_XML_PATH set to a wrong place?");
    }
    return read;
  }();
  return system.get();
}

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

bool is_word_character(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// UDUNITS-2 refuses "1/s" and "deg", both of which people write.
std::string translate(std::string_view unit) {
  std::string text(unit);
  for (auto at = text.find("deg"); at != std::string::npos; at = text.find("deg", at + 3)) {
    const bool starts = at == 0 || !is_word_character(text[at - 1]);
    const bool ends = at + 3 == text.size() || !is_word_character(text[at + 3]);
    if (starts && ends) text.replace(at, 3, "degree");
  }
  std::string_view rest = text;
  if (rest.starts_with("1")) rest = trim(rest.substr(1));
  if (rest.starts_with("/")) return fmt::format("({})-1", trim(rest.substr(1)));
  return text;
}

Unit parse_unit(std::string_view text) {
  return Unit(ut_parse(unit_system(), translate(text).c_str(), UT_UTF8));
}

/// UDUNITS-2 also reads shifted units and dates ("m @ 3", "s since 2000-01-01"), which nobody means here.
bool has_shift(std::string_view unit) {
  if (unit.find('@') != std::string_view::npos) return true;
  for (const std::string_view word : {" since ", " after ", " from ", " ref "}) {
    if (unit.find(word) != std::string_view::npos) return true;
  }
  return false;
}

/// Same dimension; ut_are_convertible would also accept the reciprocal, a period for a frequency.
bool same_dimension(const ut_unit* a, const ut_unit* b) {
  const Unit ratio(ut_divide(a, b));
  return ratio && ut_is_dimensionless(ratio.get()) != 0;
}

/// Factors of the SI prefixes come out of UDUNITS-2 off by an ulp; with whole ones, "5 um" is the double 5e-6.
Real convert(cv_converter* converter, Real value) {
  constexpr Real ulps = 1e-15;
  const Real factor = cv_convert_double(converter, 1.0);
  if (cv_convert_double(converter, 0.0) == 0 && factor > 0) {
    if (const Real whole = std::round(factor); std::abs(factor - whole) <= ulps * whole) return value * whole;
    if (const Real whole = std::round(1 / factor); std::abs(1 / factor - whole) <= ulps * whole)
      return value / whole;
  }
  return cv_convert_double(converter, value);
}

}  // namespace

std::string allowed_quantity(const Dimension& dimension) {
  if (dimension.unit.empty()) return "a number";
  return fmt::format("a number in {} or a string such as \"{}\"", dimension.unit, dimension.example);
}

Real parse_quantity(std::string_view text, const Dimension& dimension) {
  const std::string_view whole = trim(text);
  const auto fail = [&](const std::string& what) {
    throw UnitError(fmt::format("{}; {}", what, allowed_quantity(dimension)));
  };

  std::string_view number = whole;
  if (number.starts_with('+')) number.remove_prefix(1);
  Real value = 0;
  const auto [end, status] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (status == std::errc::invalid_argument || (number.size() < whole.size() && number.starts_with('-'))) {
    fail(fmt::format("\"{}\" is not {}", whole, dimension.unit.empty() ? "a number" : dimension.name));
  }
  if (status == std::errc::result_out_of_range) {
    fail(fmt::format("\"{}\" is too large or too small for a number", whole));
  }
  if (!std::isfinite(value)) fail(fmt::format("\"{}\" is not finite", whole));

  const std::string_view unit_text = trim(number.substr(static_cast<std::size_t>(end - number.data())));
  if (unit_text.empty()) return value;

  const Unit unit = has_shift(unit_text) ? nullptr : parse_unit(unit_text);
  if (!unit) fail(fmt::format("unknown unit \"{}\" in \"{}\"", unit_text, whole));
  const Unit target = parse_unit(dimension.unit.empty() ? "1" : dimension.unit);
  if (!target) throw RunError(fmt::format("the unit {} is not in the unit database", dimension.unit));
  const std::unique_ptr<cv_converter, FreeConverter> converter(ut_get_converter(unit.get(), target.get()));
  if (!converter || !same_dimension(unit.get(), target.get())) {
    const bool celsius = unit_text == "C" && dimension.unit == "K";
    fail(fmt::format("\"{}\" is not {}{}", whole, dimension.name,
                     celsius ? " (C is coulomb, write degC)" : ""));
  }
  const Real converted = convert(converter.get(), value);
  if (!std::isfinite(converted)) fail(fmt::format("\"{}\" is not finite", whole));
  return converted;
}

}  // namespace pellicle::core
