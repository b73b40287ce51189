#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "core/units.hpp"

namespace {

using namespace pellicle::core;

std::string error_of(const std::string& text, const Dimension& dimension) {
  try {
    parse_quantity(text, dimension);
  } catch (const UnitError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Units, BareNumbersAreSi) {
  EXPECT_EQ(parse_quantity("0.003", dimension::length), 0.003);
  EXPECT_EQ(parse_quantity(" +3 ", dimension::length), 3);
  EXPECT_EQ(parse_quantity("-9.81", dimension::acceleration), -9.81);
  EXPECT_EQ(parse_quantity("1e-4", dimension::duration), 1e-4);
}

// Factors that are whole numbers or their inverses give the double nearest to the decimal number.
TEST(Units, DecimalPrefixesAreExact) {
  EXPECT_EQ(parse_quantity("5 mm", dimension::length), 0.005);
  EXPECT_EQ(parse_quantity("5mm", dimension::length), 0.005);
  EXPECT_EQ(parse_quantity("5 um", dimension::length), 5e-6);
  EXPECT_EQ(parse_quantity("5 µm", dimension::length), 5e-6);
  EXPECT_EQ(parse_quantity("0.1 ms", dimension::duration), 1e-4);
  EXPECT_EQ(parse_quantity("2.5 g/cm3", dimension::density), 2500);
  EXPECT_EQ(parse_quantity("1 bar", dimension::pressure), 1e5);
  EXPECT_EQ(parse_quantity("200 g", dimension::mass), 0.2);
  EXPECT_EQ(parse_quantity("45 %", dimension::pure_number), 0.45);
}

TEST(Units, OtherUnits) {
  EXPECT_DOUBLE_EQ(parse_quantity("73.5 m3/h", dimension::flow_rate), 73.5 / 3600);
  EXPECT_DOUBLE_EQ(parse_quantity("6 l/min", dimension::flow_rate), 1e-4);
  EXPECT_DOUBLE_EQ(parse_quantity("80 degC", dimension::temperature), 353.15);
  EXPECT_DOUBLE_EQ(parse_quantity("36 km/h", dimension::velocity), 10);
  EXPECT_DOUBLE_EQ(parse_quantity("18 uPa s", dimension::viscosity), 1.8e-5);
  EXPECT_DOUBLE_EQ(parse_quantity("5 Pa/m", dimension::force_per_volume), 5);
  EXPECT_DOUBLE_EQ(parse_quantity("2 in", dimension::length), 0.0508);
}

// UDUNITS-2 itself refuses "deg" and "1/s".
TEST(Units, DegreesAndRates) {
  EXPECT_DOUBLE_EQ(parse_quantity("180 deg", dimension::angle), std::numbers::pi);
  EXPECT_DOUBLE_EQ(parse_quantity("90 deg/s", dimension::angular_velocity), std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(parse_quantity("5 1/s", dimension::angular_velocity), 5);
  EXPECT_DOUBLE_EQ(parse_quantity("5/s", dimension::angular_velocity), 5);
  EXPECT_DOUBLE_EQ(parse_quantity("60 rpm", dimension::angular_velocity), 2 * std::numbers::pi);
}

TEST(Units, Errors) {
  EXPECT_EQ(error_of("5 kg", dimension::length),
            "\"5 kg\" is not a length; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(error_of("5 mn", dimension::length),
            "unknown unit \"mn\" in \"5 mn\"; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(error_of("1,5 mm", dimension::length),
            "unknown unit \",5 mm\" in \"1,5 mm\"; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(error_of("five", dimension::length),
            "\"five\" is not a length; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(error_of("", dimension::length),
            "\"\" is not a length; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(error_of("5 m", dimension::pure_number), "\"5 m\" is not a pure number; a number");
  EXPECT_EQ(error_of("80 C", dimension::temperature),
            "\"80 C\" is not a temperature (C is coulomb, write degC); a number in K or a string such as "
            "\"80 degC\"");
  EXPECT_EQ(error_of("nan", dimension::length),
            "\"nan\" is not finite; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(error_of("inf mm", dimension::length),
            "\"inf mm\" is not finite; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(error_of("1e400", dimension::length),
            "\"1e400\" is too large or too small for a number; a number in m or a string such as \"5 mm\"");
  EXPECT_EQ(error_of("1e308 km", dimension::length),
            "\"1e308 km\" is not finite; a number in m or a string such as \"5 mm\"");
}

// UDUNITS-2 converts a period into a frequency and reads dates and shifted units; neither is meant.
TEST(Units, NoReciprocalsAndShifts) {
  EXPECT_EQ(error_of("5 s", dimension::angular_velocity).substr(0, 35),
            "\"5 s\" is not an angular velocity; a");
  EXPECT_EQ(error_of("1/2 mm", dimension::length).substr(0, 24), "\"1/2 mm\" is not a length");
  EXPECT_EQ(error_of("5 m @ 3", dimension::length).substr(0, 20), "unknown unit \"m @ 3\"");
  EXPECT_EQ(error_of("3 s since 3", dimension::duration).substr(0, 24), "unknown unit \"s since 3\"");
}

}  // namespace
