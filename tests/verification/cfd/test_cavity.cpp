// Lid-driven cavity at Reynolds numbers 100, 400 and 1000.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/cfd/gas_for_tests.hpp"
#include "tests/verification/dem/verification_table.hpp"

namespace pellicle::cfd {
namespace {

// Ghia, Ghia & Shin, J. Comput. Phys. 48 (1982) 387, Tables I and II: place on the centre line, and the velocity across it
// at Re 100 and 400.
struct GhiaRow {
  Real place, at_100, at_400;
};
// Horizontal velocity over the height.
constexpr std::array<GhiaRow, 15> ghia_horizontal{{{0.0547, -0.03717, -0.08186},
                                                   {0.0625, -0.04192, -0.09266},
                                                   {0.0703, -0.04775, -0.10338},
                                                   {0.1016, -0.06434, -0.14612},
                                                   {0.1719, -0.10150, -0.24299},
                                                   {0.2813, -0.15662, -0.32726},
                                                   {0.4531, -0.21090, -0.17119},
                                                   {0.5, -0.20581, -0.11477},
                                                   {0.6172, -0.13641, 0.02135},
                                                   {0.7344, 0.00332, 0.16256},
                                                   {0.8516, 0.23151, 0.29093},
                                                   {0.9531, 0.68717, 0.55892},
                                                   {0.9609, 0.73722, 0.61756},
                                                   {0.9688, 0.78871, 0.68439},
                                                   {0.9766, 0.84123, 0.75837}}};
// Vertical velocity over the width. -0.23827 at 0.9063, Re 400, is a misprint: its neighbours make it impossible.
constexpr std::array<GhiaRow, 15> ghia_vertical{{{0.0625, 0.09233, 0.18360},
                                                 {0.0703, 0.10091, 0.19713},
                                                 {0.0781, 0.10890, 0.20920},
                                                 {0.0938, 0.12317, 0.22965},
                                                 {0.1563, 0.16077, 0.28124},
                                                 {0.2266, 0.17507, 0.30203},
                                                 {0.2344, 0.17527, 0.30174},
                                                 {0.5, 0.05454, 0.05186},
                                                 {0.8047, -0.24533, -0.38598},
                                                 {0.8594, -0.22445, -0.44993},
                                                 {0.9063, -0.16914, -0.23827},
                                                 {0.9453, -0.10313, -0.22847},
                                                 {0.9531, -0.08864, -0.19254},
                                                 {0.9609, -0.07391, -0.15663},
                                                 {0.9688, -0.05906, -0.12146}}};
constexpr Real misprint = -0.23827;

/// A profile: values at cell centres, with those on both walls.
struct Profile {
  std::vector<Real> place, value;

  /// Cubic through the four nearest points, so that what is compared is the solution and not the interpolation.
  Real at(Real where) const {
    const auto next =
        static_cast<std::size_t>(std::upper_bound(place.begin(), place.end(), where) - place.begin());
    const std::size_t first = std::clamp(next, std::size_t{2}, place.size() - 2) - 2;
    Real sum = 0;
    for (std::size_t i = first; i < first + 4; ++i) {
      Real weight = 1;
      for (std::size_t j = first; j < first + 4; ++j) {
        if (j != i) weight *= (where - place[j]) / (place[i] - place[j]);
      }
      sum += weight * value[i];
    }
    return sum;
  }
  std::pair<Real, Real> range() const {
    Real least = 0, most = 0;
    for (Real x = 0; x <= 1; x += 1e-4) {
      least = std::min(least, at(x));
      if (x < 0.9) most = std::max(most, at(x));  // not the lid
    }
    return {least, most};
  }
};

struct Cavity {
  Profile horizontal, vertical;
  Real steps = 0;
};

// Cells half as wide at the walls as on average. The cavity lies in the plane of x and z; the lid is the top. Steps until
// nothing changes by more than 1e-6 of the lid's speed in 1 s.
Cavity run_cavity(Real reynolds, Index n, Real dt) {
  GasOptions options = make_air();
  options.density = 1;
  options.viscosity = 1 / reynolds;
  std::vector<Real> faces;
  for (Index i = 0; i <= n; ++i) {
    const Real s = static_cast<Real>(i) / n;
    faces.push_back(s - 0.08 * std::sin(2 * M_PI * s));
  }
  faces.back() = 1;
  const CartesianGrid grid({{faces, {0, 1}, faces}}, {false, true, false});
  GasSolver solver(grid, options, {{"lid", Side::z_max, {}, NoSlip{{1, 0, 0}}, "case.yaml:1"}});
  const auto exchange = make_empty_exchange(grid);
  Cavity cavity;
  for (Real change = 1; change > 1e-6 * dt && cavity.steps * dt < 120;) {
    const auto before = copy_of(solver.state().velocity);
    solver.update(dt, exchange);
    change = largest_difference(before, solver.state().velocity);
    ++cavity.steps;
  }
  const auto& u = solver.state().velocity;
  cavity.horizontal = {{0}, {0}};
  cavity.vertical = {{0}, {0}};
  for (Index i = 0; i < n; ++i) {
    cavity.horizontal.place.push_back(grid.center(2, i));
    cavity.horizontal.value.push_back(0.5 *
                                      (u(grid.index(n / 2 - 1, 0, i)).x + u(grid.index(n / 2, 0, i)).x));
    cavity.vertical.place.push_back(grid.center(0, i));
    cavity.vertical.value.push_back(0.5 * (u(grid.index(i, 0, n / 2 - 1)).z + u(grid.index(i, 0, n / 2)).z));
  }
  for (Profile* profile : {&cavity.horizontal, &cavity.vertical}) profile->place.push_back(1);
  cavity.horizontal.value.push_back(1);
  cavity.vertical.value.push_back(0);
  std::printf("Re %g, %d x %d cells: %g steps of %g s\n", reynolds, n, n, cavity.steps, dt);
  return cavity;
}

void keep_profiles(const Cavity& cavity, const std::string& name) {
  const auto keep = [&](const Profile& profile, const std::string& which) {
    tests::keep_curve("cavity_" + which + "_" + name,
                      {{"place", "velocity"}, {profile.place, profile.value}});
  };
  keep(cavity.horizontal, "u");
  keep(cavity.vertical, "w");
}

/// Compares with Ghia's tables: `which` is GhiaRow's column. The printed values themselves are off by up to 0.009 at Re 100
/// and 0.006 at Re 400; 64 cells leave 0.001.
void compare(const Cavity& cavity, Real GhiaRow::*which, const std::string& name, Real allowed) {
  const auto deviation = [&](const Profile& profile, const auto& rows, const std::string& file) {
    Real worst = 0;
    std::vector<Real> place, value;
    for (const GhiaRow& row : rows) {
      place.push_back(row.place);
      value.push_back(row.*which);
      if (row.*which == misprint) continue;
      worst = std::max(worst, std::abs(profile.at(row.place) - row.*which));
    }
    tests::keep_curve(file, {{"place", "velocity"}, {place, value}});
    return worst;
  };
  const std::string why =
      "of the lid's speed; printed values are off by up to " + tests::show(allowed - 0.001);
  tests::expect_small(
      "cavity, " + name + ": u on the vertical centre line, largest deviation from Ghia et al.",
      deviation(cavity.horizontal, ghia_horizontal, "ghia_u_" + name), allowed, why);
  tests::expect_small("cavity, " + name + ": w on the horizontal centre line, the same",
                      deviation(cavity.vertical, ghia_vertical, "ghia_w_" + name), allowed, why);
}

TEST(Cavity, MatchesGhiaAtRe100) {
  const Cavity cavity = run_cavity(100, 64, 0.05);
  keep_profiles(cavity, "Re_100");
  compare(cavity, &GhiaRow::at_100, "Re_100", 0.010);
  // Botella & Peyret, Comput. Fluids 27 (1998) 421, spectral. Second order on 64 cells: (0.02)2 times a curvature of 10.
  const auto [least, ignored] = cavity.horizontal.range();
  const auto [down, up] = cavity.vertical.range();
  (void)ignored;
  const std::string why = "Botella & Peyret 1998, spectral; 64 cells leave 0.5 %";
  tests::expect_line("cavity, Re_100: least u on the vertical centre line", -0.2140424, least, 0.001, why);
  tests::expect_line("cavity, Re_100: largest w on the horizontal one", 0.1795728, up, 0.001, why);
  tests::expect_line("cavity, Re_100: least w", -0.2538030, down, 0.0013, why);
}

TEST(Cavity, MatchesGhiaAtRe400) {
  const Cavity cavity = run_cavity(400, 64, 0.05);
  keep_profiles(cavity, "Re_400");
  compare(cavity, &GhiaRow::at_400, "Re_400", 0.007);
}

TEST(Cavity, ReportsRe1000) {
  const Cavity cavity = run_cavity(1000, 64, 0.05);
  keep_profiles(cavity, "Re_1000");
  const auto [least, ignored] = cavity.horizontal.range();
  const auto [down, up] = cavity.vertical.range();
  (void)ignored;
  const std::string why = "Botella & Peyret 1998, spectral; 64 cells";
  tests::record_line("cavity, Re_1000: least u on the vertical centre line", "-0.3885698", least, why);
  tests::record_line("cavity, Re_1000: largest w on the horizontal one", "0.3769447", up, why);
  tests::record_line("cavity, Re_1000: least w", "-0.5270771", down, why);
  // Three times what 64 cells leave at Re 100, since the layers are thinner by the root of ten.
  EXPECT_NEAR(least, -0.3885698, 0.012);
  EXPECT_NEAR(down, -0.5270771, 0.016);
}

}  // namespace
}  // namespace pellicle::cfd
