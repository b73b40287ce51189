// Saturation against ASHRAE's table (Hyland & Wexler) and against the thesis's law evaluated by hand.
#include <gtest/gtest.h>

#include <array>

#include "core/model_variant.hpp"
#include "heat/saturation_laws.hpp"

namespace pellicle::heat {
namespace {

/// Pressures [Pa] and the mass fraction of vapour in saturated air at 101325 Pa. ASHRAE: values that psychrolib tests
/// against, where its table has them. Thesis: its eqs. 2.19 and 2.20 with 2260 kJ/kg and 373 K, evaluated by a script.
struct Row {
  Real temperature, ashrae_pressure, thesis_pressure, thesis_fraction, ashrae_fraction;
};
constexpr std::array<Row, 11> rows{{{283.15, 1227.9953, 1572.1462, 0.0097074041, 0.0075726229},
                                    {293.15, 2338.8037, 2835.967, 0.017594466, 0.014482892},
                                    {298.15, 3169.2165, 3752.8426, 0.023363578, 0.019686698},
                                    {303.15, 4246.0302, 4920.4675, 0.030768643, 0.026483372},
                                    {313.15, 7383.46, 8241.9089, 0.052197174, 0.046606493},
                                    {323.15, 12349.856, 13371.631, 0.086390231, 0.079469988},
                                    {333.15, 19943.761, 21072.917, 0.14039156, 0.13226418},
                                    {343.15, 31197.895, 32340.859, 0.22576116, 0.2167315},
                                    {353.15, 47411.611, 48444.354, 0.36297402, 0.35357324},
                                    {363.15, 70180.013, 70969.184, 0.59252176, 0.58359592},
                                    {373.15, 101418.72, 101861.14, 1, 1}}};
constexpr Real pressure = 101325;

TEST(SaturationLaws, BuckIsWithinHalfAPercentOfTables) {
  for (const Row& row : rows) {
    EXPECT_NEAR(Buck{}(row.temperature).value / row.ashrae_pressure, 1, 0.005) << row.temperature << " K";
    EXPECT_NEAR(saturated_fraction(Buck{}, row.temperature, pressure).value / row.ashrae_fraction, 1, 0.005)
        << row.temperature << " K";
  }
}

/// The reference used R = 8.314462618 and M = 18.01528 as we do, and 28.966 for air: 5e-5 in the fraction.
TEST(SaturationLaws, ClausiusClapeyronIsTheThesiss) {
  for (const Row& row : rows) {
    EXPECT_NEAR(ClausiusClapeyron{}(row.temperature).value / row.thesis_pressure, 1, 1e-7)
        << row.temperature << " K";
    EXPECT_NEAR(
        saturated_fraction(ClausiusClapeyron{}, row.temperature, pressure).value / row.thesis_fraction, 1,
        1e-4)
        << row.temperature << " K";
  }
}

/// Central differences over 2 mK: their own error is 1e-8, that of rounding 1e-9.
TEST(SaturationLaws, SlopesAreDerivatives) {
  constexpr Real h = 1e-3;
  for (int law = 0; law < 2; ++law) {
    for (const Real t : {275.0, 300.0, 330.0, 365.0}) {
      const auto at = [&](Real x) { return saturated_fraction_by(law, x, pressure); };
      EXPECT_NEAR(at(t).slope / ((at(t + h).value - at(t - h).value) / (2 * h)), 1, 1e-7)
          << "law " << law << ", " << t << " K";
    }
  }
}

TEST(SaturationLaws, NothingButVapourFromTheBoilingPointOn) {
  for (int law = 0; law < 2; ++law) {
    EXPECT_EQ(saturated_fraction_by(law, 390, pressure).value, 1);
    EXPECT_EQ(saturated_fraction_by(law, 390, pressure).slope, 0);
    EXPECT_LT(saturated_fraction_by(law, 371, pressure).value, 1);
    EXPECT_EQ(saturated_fraction_by(law, 371, 50000).value, 1);  // boils at less under less pressure
  }
}

}  // namespace
}  // namespace pellicle::heat
