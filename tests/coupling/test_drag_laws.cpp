// Drag laws against numbers computed elsewhere: the laws in the form their papers give (beta, not K), evaluated with
// 40 digits by a script of its own, divided by eps_p. Relative tolerance 1e-11: a dozen roundings and library
// functions good to an ulp.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "coupling/drag_laws.hpp"

namespace pellicle::coupling {
namespace {

struct Point {
  Real void_fraction, reynolds;
};
constexpr std::array<Point, 6> points{
    {{0.4, 500}, {0.45, 10}, {0.62, 300}, {0.78, 800}, {0.9, 200}, {0.97, 1500}}};

/// 2 mm sphere, rho 1.2, mu 1.8e-5, at a superficial Reynolds number.
ParticleFlow flow_at(Real eps, Real reynolds) {
  return {eps, reynolds * 1.8e-5 / (1.2 * eps * 2e-3), 2e-3, 1.2, 1.8e-5};
}

struct Row {
  const char* name;
  std::array<Real, 6> k;  // kg m-3 s-1
};
constexpr std::array<Row, 10> expected{{
    {"ergun_wen_yu", {10856.25, 1000.0, 4224.193548387, 8267.307692308, 718.9331308241, 2414.752458507}},
    {"gidaspow", {10856.25, 1000.0, 4224.193548387, 8267.307692308, 718.9331308241, 2414.752458507}},
    {"gidaspow_blend",
     {10855.97495272, 1000.563227895, 4212.295699862, 7920.190070643, 732.3389156957, 2484.529706594}},
    {"koch_hill", {9185.805, 1108.193209861, 2368.454859047, 4118.834113024, 1023.658347414, 5877.246657345}},
    {"beetstra",
     {8561.076843304, 1104.527788831, 2874.599530562, 4043.415576828, 987.9143653298, 3924.287692596}},
    {"di_felice",
     {10690.27271913, 850.5505184333, 2497.778667444, 3179.498583509, 802.2052878538, 3109.132188038}},
    {"rong",
     {10914.66884668, 885.5103659525, 2814.598535098, 3760.622483484, 849.4438082249, 3228.816816899}},
    {"wen_yu",
     {10765.51817393, 1162.573041269, 2457.810245045, 2473.590505811, 718.9331308241, 2414.752458507}},
    {"ergun", {10856.25, 1000.0, 4224.193548387, 8267.307692308, 1825.0, 12198.71134021}},
    {"schiller_naumann",
     {1856.25, 183.2867267219, 930.1521024746, 1523.076923077, 578.5300092411, 2296.391752577}},
}};
constexpr Real tolerance = 1e-11;

TEST(DragLaws, AgreeWithHandComputedValues) {
  EXPECT_EQ(expected.size(), std::variant_size_v<DragLaw>);
  for (const Row& row : expected) {
    const int law = core::find_model(core::model_list<DragLaw>(), row.name);
    ASSERT_GE(law, 0) << row.name;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const ParticleFlow flow = flow_at(points[i].void_fraction, points[i].reynolds);
      EXPECT_NEAR(momentum_exchange_coefficient(law, flow) / row.k[i], 1, tolerance)
          << row.name << " at void fraction " << points[i].void_fraction << ", Re " << points[i].reynolds;
    }
  }
}

TEST(DragLaws, VariantAndPositionChooseTheSameLaw) {
  const auto list = core::model_list<DragLaw>();
  const ParticleFlow flow = flow_at(0.7, 250);
  for (int i = 0; i < static_cast<int>(list.size()); ++i) {
    const DragLaw law = core::make_model<DragLaw>(i);
    EXPECT_EQ(core::model_info(law).name, list[static_cast<std::size_t>(i)].name);
    EXPECT_EQ(std::visit([&](auto l) { return l(flow); }, law), momentum_exchange_coefficient(i, flow));
    EXPECT_FALSE(list[static_cast<std::size_t>(i)].description.empty());
    EXPECT_FALSE(list[static_cast<std::size_t>(i)].source.empty());
  }
}

// The thesis's print of Beetstra (eqs. 2.31-2.33) lacks 1/eps in the inertial term. These are its values at the same
// six points, from the printed formula: 51, 5, 31, 20, 8 and 3 % below the paper's.
TEST(DragLaws, BeetstraHasTheFactorThatTheThesisLost) {
  constexpr std::array<Real, 6> printed{4162.5231, 1050.1491, 1986.1936, 3220.8923, 907.41777, 3813.0844};
  constexpr std::array<Real, 6> ratio{0.48621, 0.95077, 0.69095, 0.79658, 0.91852, 0.97166};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Real k = Beetstra{}(flow_at(points[i].void_fraction, points[i].reynolds));
    EXPECT_NEAR(printed[i] / k, ratio[i], 1e-5);  // ratio printed with five digits
    EXPECT_GT(k, 1.02 * printed[i]);
  }
}

// Void fraction 1 - 1e-9, Re 1e-6: K d2 / (18 mu) -> 1, or 4.8^2/24 = 0.96 for the laws on Dallavalle's drag.
TEST(DragLaws, StokesLimits) {
  const ParticleFlow dilute = flow_at(1 - 1e-9, 1e-6);
  const auto over_stokes = [&](auto law) { return law(dilute) / dilute.stokes(); };
  EXPECT_NEAR(over_stokes(WenYu{}), 1, 2e-5);  // 0.15 Re^0.687 = 1.1e-5
  EXPECT_NEAR(over_stokes(ErgunWenYu{}), 1, 2e-5);
  EXPECT_NEAR(over_stokes(SchillerNaumann{}), 1, 2e-5);
  EXPECT_NEAR(over_stokes(KochHill{}), 1, 1e-4);     // 3 sqrt(eps_p / 2) = 6.7e-5
  EXPECT_NEAR(over_stokes(Beetstra{}), 1, 1e-4);     // 1.5 sqrt(eps_p) = 4.7e-5
  EXPECT_NEAR(over_stokes(DiFelice{}), 0.96, 3e-4);  // 2 (0.63 / 4.8) sqrt(Re) = 2.6e-4
  EXPECT_NEAR(over_stokes(Rong{}), 0.96, 3e-4);
  EXPECT_NEAR(over_stokes(Ergun{}), 0, 1.1e-7);  // 150 / 18 eps_p + 1.75 / 18 Re = 1.06e-7
}

TEST(DragLaws, FiniteAtZeroSlipAndWithoutNeighbours) {
  for (int law = 0; law < static_cast<int>(std::variant_size_v<DragLaw>); ++law) {
    for (const Real eps : {0.36, 0.6, 0.8, 1.0, 1.0 + 1e-15}) {
      const ParticleFlow still{eps, 0, 2e-3, 1.2, 1.8e-5};
      const ParticleFlow slow{eps, 1e-12, 2e-3, 1.2, 1.8e-5};
      const Real k = momentum_exchange_coefficient(law, still);
      ASSERT_TRUE(std::isfinite(k)) << law << ' ' << eps;
      // Continuous at zero slip: the largest departure is Di Felice's, 2 (0.63/4.8) sqrt(Re), Re = 1.3e-10.
      EXPECT_NEAR(momentum_exchange_coefficient(law, slow), k, 1e-5 * k + 1e-8) << law << ' ' << eps;
    }
  }
  const ParticleFlow lone{1, 0, 2e-3, 1.2, 1.8e-5};
  EXPECT_DOUBLE_EQ(KochHill{}(lone), 81);  // 18 x 1.8e-5 / 4e-6
  EXPECT_DOUBLE_EQ(Beetstra{}(lone), 81);
  EXPECT_DOUBLE_EQ(WenYu{}(lone), 81);
  EXPECT_DOUBLE_EQ(SchillerNaumann{}(lone), 81);
}

// Checked values of the project's physics reference: d 1 mm, rho 1.2, mu 1.8e-5, slip 1 m/s; beta, six digits.
TEST(DragLaws, DiFeliceAndRongAgainstCheckedValues) {
  struct Checked {
    Real eps, di_felice, rong;
  };
  for (const Checked c :
       {Checked{0.45, 2598.04, 2678.54}, {0.70, 699.632, 717.086}, {0.95, 72.3233, 73.7673}}) {
    const ParticleFlow flow{c.eps, 1, 1e-3, 1.2, 1.8e-5};
    EXPECT_NEAR((1 - c.eps) * DiFelice{}(flow) / c.di_felice, 1, 2e-6);
    EXPECT_NEAR((1 - c.eps) * Rong{}(flow) / c.rong, 1, 2e-6);
  }
}

// Wen-Yu over Ergun at void fraction 0.8 is a closed form: (18 + 2.7 Re^0.687) 0.8^-2.65 / (37.5 + 2.1875 Re).
TEST(DragLaws, JumpAtVoidFractionPointEight) {
  struct Jump {
    Real reynolds, ratio;
  };
  for (const Jump j : {Jump{10, 0.947172}, {100, 0.577198}, {500, 0.336926}, {999, 0.266961}}) {
    const ParticleFlow at = flow_at(0.8, j.reynolds);
    ParticleFlow above = at;
    above.void_fraction = 0.8 + 1e-12;
    EXPECT_NEAR(ErgunWenYu{}(above) / ErgunWenYu{}(at), j.ratio, 1e-6);
    EXPECT_DOUBLE_EQ(ErgunWenYu{}(at), Ergun{}(at));
    // The blend is half of each there.
    EXPECT_NEAR(GidaspowBlend{}(at), 0.5 * (Ergun{}(at) + WenYu{}(at)), 1e-12 * Ergun{}(at));
  }
}

// Published closed forms tabulated by others (beta): Lundberg's parameters, d 154 um, rho 1.225, mu 1.7894e-5,
// slip 0.133 / eps; eight digits.
TEST(DragLaws, LundbergTable) {
  struct Line {
    Real eps_p, gidaspow, koch_hill, beetstra;
  };
  for (const Line l : {Line{0.1, 2135.2775, 3204.3301, 3094.1385},
                       {0.3, 15344.763, 19217.37, 20214.247},
                       {0.5, 58439.8, 68995.92, 69822.575},
                       {0.6, 104636.21, 124479.63, 123502.52}}) {
    const Real eps = 1 - l.eps_p;
    const ParticleFlow flow{eps, 0.133 / eps, 154e-6, 1.225, 1.7894e-5};
    EXPECT_NEAR(l.eps_p * ErgunWenYu{}(flow) / l.gidaspow, 1, 1e-7);
    EXPECT_NEAR(l.eps_p * KochHill{}(flow) / l.koch_hill, 1, 1e-7);
    // The table takes 0.31/18 for 0.413/24 in the inertial term: 3e-5 of the whole at Re 1.4.
    EXPECT_NEAR(l.eps_p * Beetstra{}(flow) / l.beetstra, 1, 1e-4);
  }
}

}  // namespace
}  // namespace pellicle::coupling
