// Nusselt and Sherwood numbers against values computed elsewhere from the closed forms of the papers, and the cooling of
// a lone sphere against its exact solution.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "core/model_variant.hpp"
#include "heat/evaporation_laws.hpp"
#include "heat/transfer_laws.hpp"

namespace pellicle::heat {
namespace {

/// Gunn (1978) at Pr = 0.71 and Sc = 0.6; the numbers are given with 8 digits.
struct GunnRow {
  Real void_fraction, reynolds, nusselt, sherwood;
};
constexpr std::array<GunnRow, 14> gunn_rows{{{0.4, 0, 3.8, 3.8},
                                             {0.4, 1, 6.6743853, 6.51754},
                                             {0.4, 10, 10.073768, 9.7314302},
                                             {0.4, 50, 16.741511, 16.035338},
                                             {0.4, 100, 22.354523, 21.342067},
                                             {0.4, 500, 50.87814, 48.309249},
                                             {0.4, 1000, 76.365525, 72.405875},
                                             {1, 0, 2, 2},
                                             {1, 1, 3.3649316, 3.290452},
                                             {1, 10, 4.5607132, 4.420984},
                                             {1, 50, 6.5243784, 6.2774987},
                                             {1, 100, 8.0503878, 7.7202391},
                                             {1, 500, 15.316101, 14.589487},
                                             {1, 1000, 21.572522, 20.504517}}};
/// Ranz & Marshall (1952), likewise.
constexpr std::array<GunnRow, 7> ranz_marshall_rows{{{1, 0, 2, 2},
                                                     {1, 1, 2.5352673, 2.5060596},
                                                     {1, 10, 3.6926638, 3.600301},
                                                     {1, 50, 5.7849113, 5.5783817},
                                                     {1, 100, 7.3526728, 7.060596},
                                                     {1, 500, 13.96894, 13.315837},
                                                     {1, 1000, 18.926638, 18.00301}}};
constexpr Real printed = 5e-8;  // relative: half a unit of the eighth digit

int law_named(const char* name) { return core::find_model(core::model_list<TransferLaw>(), name); }

Real transfer_number(int law, Real void_fraction, Real reynolds, Real prandtl) {
  const TransferLine line = transfer_line(law, void_fraction, reynolds);
  return line.still + line.stirred * std::cbrt(prandtl);
}

TEST(TransferLaws, GunnAgreesWithPublishedForm) {
  for (const GunnRow& row : gunn_rows) {
    const std::string at = std::to_string(row.void_fraction) + ", Re " + std::to_string(row.reynolds);
    EXPECT_NEAR(transfer_number(law_named("gunn"), row.void_fraction, row.reynolds, 0.71) / row.nusselt, 1,
                printed)
        << at;
    EXPECT_NEAR(transfer_number(law_named("gunn"), row.void_fraction, row.reynolds, 0.6) / row.sherwood, 1,
                printed)
        << at;
  }
}

TEST(TransferLaws, RanzMarshallAgreesWithPublishedForm) {
  for (const GunnRow& row : ranz_marshall_rows) {
    for (const Real eps : {0.4, 1.0}) {  // it knows no neighbours
      EXPECT_NEAR(transfer_number(law_named("ranz_marshall"), eps, row.reynolds, 0.71) / row.nusselt, 1,
                  printed);
      EXPECT_NEAR(transfer_number(law_named("ranz_marshall"), eps, row.reynolds, 0.6) / row.sherwood, 1,
                  printed);
    }
  }
}

/// Powers of single precision: eight roundings of 6e-8 are 5e-7.
TEST(TransferLaws, SinglePrecisionIsEnoughForPowers) {
  constexpr Real single = 5e-7;
  for (const GunnRow& row : gunn_rows) {
    const TransferLine line =
        transfer_line(law_named("gunn"), row.void_fraction, static_cast<float>(row.reynolds));
    EXPECT_NEAR((line.still + line.stirred * cube_root(0.71)) / row.nusselt, 1, single) << row.reynolds;
    EXPECT_NEAR((line.still + line.stirred * cube_root(0.6)) / row.sherwood, 1, single) << row.reynolds;
  }
}

/// A sphere of 3.6 mm, 8850 kg/m3, 55 J/kg/K in air of 298.15 K at 6 m/s cools from 373.15 K (case of Musser 2011 after
/// Zhou et al. 2009, as in CFDEMcoupling's tutorial HeatTransferRanzMarshall). Exact exponentials, printed with 8 digits.
TEST(TransferLaws, LoneSphereCoolsAsItsExactSolution) {
  constexpr Real d = 3.6e-3, density = 8850, capacity = 55, k = 0.026, mu = 1.85e-5, cp = 1007, rho = 1.1854;
  constexpr Real pi = 3.14159265358979323846;
  struct Row {
    Real time, ranz_marshall, gunn;
  };
  constexpr std::array<Row, 6> rows{{{0.5, 355.30603, 352.72696},
                                     {1, 341.70749, 337.86525},
                                     {2, 323.44673, 319.18068},
                                     {5, 303.10529, 301.27278},
                                     {10, 298.4774, 298.28002},
                                     {20, 298.15143, 298.15023}}};
  for (const char* name : {"ranz_marshall", "gunn"}) {
    const Real nusselt = transfer_number(law_named(name), 1, rho * 6 * d / mu, mu * cp / k);
    const Real conductance = nusselt * k / d * pi * d * d;
    const Real reference = 273.15;
    ParticleHeat particle{373.15 - reference, density * pi / 6 * d * d * d * capacity};
    Real time = 0;
    for (const Row& row : rows) {
      constexpr int steps = 7;  // the exponential is exact for any step
      const Real step = (row.time - time) / steps;
      for (int n = 0; n < steps; ++n) {
        const ParticleResponse response = limited_response(particle, conductance, 0, 0, step);
        particle.warmth += step * response.heat(298.15 - reference, 0) / particle.capacity;
      }
      time = row.time;
      const Real expected = std::string(name) == "gunn" ? row.gunn : row.ranz_marshall;
      EXPECT_NEAR(reference + particle.warmth, expected, 1e-5) << name << " at " << time << " s";
    }
  }
}

}  // namespace
}  // namespace pellicle::heat
