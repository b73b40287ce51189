// The response of one particle to the gas over a step, against the differential equation integrated otherwise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "heat/evaporation_laws.hpp"
#include "heat/transfer_laws.hpp"

namespace pellicle::heat {
namespace {

constexpr Real reference = 298.15;
constexpr Real atmosphere = 101325;
/// 2441.7 kJ/kg at 25 degC, c_p of vapour and of water there.
constexpr WaterEnthalpy water{reference, 2.4417e6, 1872, 4181};

ValueAndSlope buck(Real temperature) { return saturated_fraction(Buck{}, temperature, atmosphere); }

/// C dy/dt = H (T - y) - L e with e = G (line(y) - w), by RK4 with many small steps: y at the end, means of heat and e.
struct Means {
  Real warmth, heat, evaporation;
};
Means integrate(const ParticleHeat& p, const Conductances& k, const ValueAndSlope& line, Real latent,
                Real gas_warmth, Real gas_vapour, Real step) {
  const auto evaporation = [&](Real y) {
    return k.vapour * (line.value + line.slope * (y - p.warmth) - gas_vapour);
  };
  const auto rate = [&](Real y) {
    return (k.heat * (gas_warmth - y) - latent * evaporation(y)) / p.capacity;
  };
  constexpr int steps = 2000;
  const Real h = step / steps;
  Means m{p.warmth, 0, 0};
  for (int n = 0; n < steps; ++n) {
    const Real y = m.warmth;
    const Real k1 = rate(y), k2 = rate(y + h / 2 * k1), k3 = rate(y + h / 2 * k2), k4 = rate(y + h * k3);
    // Simpson's rule along the same step, with the middle from k1 and k2.
    const Real end = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    const Real middle = (y + end) / 2 + h / 8 * (k1 - k4);
    m.heat += k.heat * (gas_warmth - (y + 4 * middle + end) / 6) / steps;
    m.evaporation += (evaporation(y) + 4 * evaporation(middle) + evaporation(end)) / 6 / steps;
    m.warmth = end;
  }
  return m;
}

const Conductances conductances{2e-4, 1.8e-7};
const ParticleHeat particle{-5, 2e-3};

TEST(ParticleResponse, IsTheMeanOfTheExactSolutionWhenWet) {
  const Real latent = water.evaporation(reference + particle.warmth);
  const ValueAndSlope line = buck(reference + particle.warmth);
  for (const Real step : {1e-4, 0.3, 4.0, 60.0}) {
    const ParticleResponse r = wet_response(particle, conductances, line, latent, step);
    for (const Real gas_warmth : {10.0, -8.0}) {
      for (const Real vapour : {0.001, 0.03}) {
        const Means exact = integrate(particle, conductances, line, latent, gas_warmth, vapour, step);
        // RK4's error is (step / tau / 2000)^4 < 1e-10.
        EXPECT_NEAR(r.heat(gas_warmth, vapour), exact.heat, 1e-9 * std::abs(exact.heat) + 1e-13) << step;
        EXPECT_NEAR(r.evaporation(gas_warmth, vapour), exact.evaporation, 1e-9 * std::abs(exact.evaporation))
            << step;
        // And heat less latent heat is what changes the temperature.
        EXPECT_NEAR(
            particle.warmth + step / particle.capacity *
                                  (r.heat(gas_warmth, vapour) - latent * r.evaporation(gas_warmth, vapour)),
            exact.warmth, 1e-8)
            << step;
      }
    }
  }
}

TEST(ParticleResponse, IsTheMeanOfTheExactSolutionWhenEvaporationIsGiven) {
  const Real latent = 2.4e6, given = 3e-10;
  for (const Real step : {1e-4, 0.3, 4.0, 60.0}) {
    const ParticleResponse r = limited_response(particle, conductances.heat, given, latent, step);
    const Means exact = integrate(particle, {conductances.heat, 1}, {given, 0}, latent, 20, 0, step);
    EXPECT_NEAR(r.heat(20, 0.7), exact.heat, 1e-9 * std::abs(exact.heat)) << step;
    EXPECT_EQ(r.evaporation(20, 0.7), given);
  }
}

/// Whatever the step and wherever it starts: the end lies between start and the true equilibrium, or on it, but for the
/// 0.01 K at which the search for the chord ends; and so never beyond the gas unless vapour condenses.
TEST(ParticleResponse, NeverOvershootsTheEquilibrium) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<Real> unit(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const ParticleHeat p{-25 + 95 * unit(generator), 2e-3};
    const Real gas_warmth = -25 + 95 * unit(generator);
    const Real vapour = 0.3 * unit(generator) * unit(generator);
    const Real step = std::pow(10, -4 + 9 * unit(generator));
    const ValueAndSlope line =
        find_chord(buck, buck(water.reference + p.warmth), p, conductances, water, gas_warmth, vapour, step);
    const Real latent = water.evaporation(reference + p.warmth);
    const ParticleResponse r = wet_response(p, conductances, line, latent, step);
    const Real end = p.warmth + step / p.capacity *
                                    (r.heat(gas_warmth, vapour) - latent * r.evaporation(gas_warmth, vapour));
    // Bisection of H (T - y) = L G (w*(y) - w).
    Real low = -120, high = 120;
    for (int n = 0; n < 100; ++n) {
      const Real y = (low + high) / 2;
      const Real surplus = conductances.heat * (gas_warmth - y) -
                           latent * conductances.vapour * (buck(reference + y).value - vapour);
      (surplus > 0 ? low : high) = y;
    }
    EXPECT_GE(end, std::min(p.warmth, low) - 0.011) << trial;
    EXPECT_LE(end, std::max(p.warmth, low) + 0.011) << trial;
  }
}

/// One step from far off the equilibrium against the nonlinear equation: the error falls with the cube of the step.
TEST(ParticleResponse, ChordIsOfSecondOrder) {
  Real before = 0;
  for (const Real step : {0.4, 0.2, 0.1}) {
    ParticleHeat p{20, 2e-3};
    Real y = p.warmth;
    constexpr int steps = 20000;
    for (int n = 0; n < steps; ++n) {  // Heun; latent heat fixed as in the response
      const Real latent = water.evaporation(reference + p.warmth);
      const auto rate = [&](Real x) {
        return (conductances.heat * (10 - x) -
                latent * conductances.vapour * (buck(reference + x).value - 0.005)) /
               p.capacity;
      };
      const Real h = step / steps;
      const Real first = rate(y);
      y += h / 2 * (first + rate(y + h * first));
    }
    const ValueAndSlope line =
        find_chord(buck, buck(water.reference + p.warmth), p, conductances, water, 10, 0.005, step);
    const Real latent = water.evaporation(reference + p.warmth);
    const ParticleResponse r = wet_response(p, conductances, line, latent, step);
    const Real end = p.warmth + step / p.capacity * (r.heat(10, 0.005) - latent * r.evaporation(10, 0.005));
    const Real error = std::abs(end - y);
    if (before > 0) {
      EXPECT_GT(before / error, 5.5) << step;
    }
    before = error;
  }
}

/// A drop of 1 mm in air of 25 degC and half saturated at 3 m/s, by Ranz and Marshall with properties at the mean of drop
/// and air: 17.60 degC with Stefan's flow (a steady balance computed elsewhere). Conductivity 0.0263 (T/300)^0.8 W/m/K and
/// diffusivity 2.6e-5 (T/298)^1.81 m2/s are our choices: 0.05 K. The same source has 17.41 degC without Stefan's flow, but
/// there drives evaporation by the difference of concentrations [kg/m3]; ours, by that of mass fractions, is within 0.3 K.
TEST(ParticleResponse, FallsToTheWetBulbTemperature) {
  constexpr Real air = 298.15, d = 1e-3, speed = 3, pi = 3.14159265358979323846;
  const Real gas_vapour = cfd::humid_vapour_mass_fraction(0.5, air, atmosphere);
  const auto wet_bulb = [&](bool stefan) {
    ParticleHeat p{air - reference, pi / 6 * d * d * d * 997 * 4181};
    for (int n = 0; n < 200; ++n) {
      const Real film = (air + reference + p.warmth) / 2;
      const Real mu = cfd::sutherland_viscosity(film), rho = cfd::ideal_gas_density(atmosphere, film, 0);
      const Real k = 0.0263 * std::pow(film / 300, 0.8), diffusivity = 2.6e-5 * std::pow(film / 298.15, 1.81);
      const Real re = rho * speed * d / mu;
      const TransferLine line_of_transfer = RanzMarshall{}(1, re);
      const auto number = [&](Real ratio) {
        return line_of_transfer.still + line_of_transfer.stirred * std::cbrt(ratio);
      };
      const Real nu = number(mu * 1007 / k), sh = number(mu / (rho * diffusivity));
      Conductances c{nu * k * pi * d, rho * sh * diffusivity * pi * d};
      if (stefan) c.vapour *= stefan_factor(buck(reference + p.warmth).value, gas_vapour);
      const ValueAndSlope line =
          find_chord(buck, buck(water.reference + p.warmth), p, c, water, air - reference, gas_vapour, 1);
      const Real latent = water.evaporation(reference + p.warmth);
      const ParticleResponse r = wet_response(p, c, line, latent, 1);
      p.warmth +=
          (r.heat(air - reference, gas_vapour) - latent * r.evaporation(air - reference, gas_vapour)) /
          p.capacity;
    }
    return reference + p.warmth - 273.15;
  };
  EXPECT_NEAR(wet_bulb(true), 17.60, 0.05);
  EXPECT_NEAR(wet_bulb(false), 17.41, 0.3);
  EXPECT_GT(wet_bulb(false), wet_bulb(true));  // Stefan's flow carries more vapour away
}

/// ln(1 + B) (1 - w*) / (w* - w), worked out by hand for w* = 0.2, w = 0.04: B = 0.2, ln 1.2 = 0.1823215567939546.
TEST(StefanFactor, IsSpaldings) {
  EXPECT_NEAR(stefan_factor(0.2, 0.04) * (0.2 - 0.04), 0.1823215567939546, 1e-15);
  EXPECT_NEAR(stefan_factor(0.1, 0.1), 1 / 0.9, 1e-15);
  EXPECT_NEAR(stefan_factor(0.1, 0.1 - 1e-7), 1 / 0.9, 1e-6);
  EXPECT_LT(stefan_factor(0.1, 0.5) * (0.1 - 0.5), 0);  // condensation
  EXPECT_TRUE(std::isfinite(stefan_factor(1, 0.1)));
}

TEST(WaterEnthalpy, EvaporationIsVapourLessLiquid) {
  // 2256 kJ/kg at 100 degC in steam tables (2256.4): constant heat capacities are within 0.6 %.
  EXPECT_NEAR(water.evaporation(373.15), 2.2564e6, 0.006 * 2.2564e6);
  EXPECT_NEAR(water.evaporation(350), water.vapour(350) - 4181 * (350 - reference), 1e-6);
}

}  // namespace
}  // namespace pellicle::heat
