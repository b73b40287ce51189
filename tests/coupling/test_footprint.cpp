// Deposition kernels and footprints against pieces that the test cuts and places by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "coupling/footprint.hpp"
#include "tests/coupling/helpers.hpp"

namespace pellicle::coupling {
namespace {

using testing::make_particles;
using testing::TestParticle;

/// Volume centroid of a piece of the unit sphere, by the midpoint rule in spherical coordinates.
Vec3 integrate_centroid(Real r1, Real r2, Real polar1, Real polar2, Real azimuth1, Real azimuth2) {
  constexpr int n = 60;
  Vec3 sum;
  Real volume = 0;
  for (int a = 0; a < n; ++a) {
    const Real r = r1 + (r2 - r1) * (a + 0.5) / n;
    for (int b = 0; b < n; ++b) {
      const Real t = polar1 + (polar2 - polar1) * (b + 0.5) / n;
      for (int c = 0; c < n; ++c) {
        const Real f = azimuth1 + (azimuth2 - azimuth1) * (c + 0.5) / n;
        const Real weight = r * r * std::sin(t);
        sum += weight * r * Vec3{std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)};
        volume += weight;
      }
    }
  }
  return (1 / volume) * sum;
}

/// The 33 centres in particle radii. PHYSICS: core radius 0.3118 R, shells divided at 0.8016 R. In closed form: the mean
/// of r over a shell is 3/4 (r2^4 - r1^4) / (r2^3 - r1^3), of cos(polar) over a half 1/2, of sin(polar) pi/4, and of
/// the azimuthal direction over 45 degrees sin(pi/8) / (pi/8) towards its middle. Checked against the midpoint rule.
const std::vector<Vec3>& piece_centres() {
  static const std::vector<Vec3> centres = [] {
    const Real pi = std::numbers::pi, core = std::cbrt(1. / 33), middle = std::cbrt(17. / 33);
    EXPECT_NEAR(core, 0.3118, 5e-5);
    EXPECT_NEAR(middle, 0.8016, 5e-5);
    std::vector<Vec3> made{{0, 0, 0}};
    for (const auto& [r1, r2] : {std::pair{core, middle}, std::pair{middle, 1.0}}) {
      const Real mean = 0.75 * (std::pow(r2, 4) - std::pow(r1, 4)) / (std::pow(r2, 3) - std::pow(r1, 3));
      const Real across = mean * pi / 4 * std::sin(pi / 8) / (pi / 8);
      for (int polar = 0; polar < 2; ++polar) {
        for (int azimuth = 0; azimuth < 8; ++azimuth) {
          const Real middle_azimuth = (azimuth + 0.5) * pi / 4;
          made.push_back({across * std::cos(middle_azimuth), across * std::sin(middle_azimuth),
                          polar == 0 ? 0.5 * mean : -0.5 * mean});
          const Vec3 integrated = integrate_centroid(r1, r2, polar * pi / 2, (polar + 1) * pi / 2,
                                                     azimuth * pi / 4, (azimuth + 1) * pi / 4);
          EXPECT_LT(norm(made.back() - integrated), 2e-4);  // 60 midpoints a direction: some (1/60)^2 / 8
        }
      }
    }
    return made;
  }();
  return centres;
}

/// Cells and number of pieces of one particle, piece by piece.
std::map<Index, Index> brute_force(const CartesianGrid& grid, const TestParticle& particle, bool divided) {
  std::map<Index, Index> pieces;
  for (const Vec3& centre : divided ? piece_centres() : std::vector<Vec3>{{0, 0, 0}}) {
    const Vec3 at = particle.position + particle.radius * centre;
    ++pieces[grid.index(grid.locate(0, at.x), grid.locate(1, at.y), grid.locate(2, at.z))];
  }
  return pieces;
}

/// Particles whose cells are not those of brute force.
int count_differing(const CartesianGrid& grid, const std::vector<TestParticle>& from,
                    const Deposition& kernel) {
  const bool divided = std::holds_alternative<Divided>(kernel);
  const dem::Particles particles = make_particles(from);
  Footprint footprint(GridLocator(grid), kernel);
  footprint.compute(particles);
  const auto begin = testing::to_vector(footprint.view().begin, particles.count + 1);
  const auto entries = testing::to_vector(footprint.view().entries, footprint.entry_count());
  int differing = 0;
  for (std::size_t p = 0; p < from.size(); ++p) {
    std::map<Index, Index> found;
    Index sum = 0;
    for (Index e = begin[p]; e < begin[p + 1]; ++e) {
      const FootprintEntry& entry = entries[static_cast<std::size_t>(e)];
      EXPECT_GT(entry.pieces, 0);
      found[entry.cell] += entry.pieces;
      sum += entry.pieces;
    }
    EXPECT_EQ(sum, divided ? 33 : 1) << "partition of unity, particle " << p;
    if (found != brute_force(grid, from[p], divided)) ++differing;
  }
  return differing;
}

const Box box{{-0.01, 0.02, 0.0}, {0.02, 0.05, 0.06}};

struct GridCase {
  const char* name;
  CartesianGrid grid;
};

std::vector<GridCase> grids() {
  const std::array<bool, 3> walls{false, false, false}, periodic{true, true, true}, mixed{true, false, false};
  const std::array<std::vector<Real>, 3> stretched{testing::stretched_faces(-0.01, 0.02, 9, 1.2),
                                                   testing::stretched_faces(0.02, 0.05, 6, 0.8),
                                                   testing::stretched_faces(0, 0.06, 11, 1.1)};
  return {{"wide cells", CartesianGrid(box, {5, 3, 8}, walls)},
          {"wide cells, periodic", CartesianGrid(box, {5, 3, 8}, periodic)},
          {"cells as small as pieces", CartesianGrid(box, {60, 50, 130}, walls)},
          {"cells as small as pieces, periodic", CartesianGrid(box, {60, 50, 130}, periodic)},
          {"stretched", CartesianGrid(stretched, walls)},
          {"stretched, periodic", CartesianGrid(stretched, periodic)},
          {"one and two cells, periodic in x", CartesianGrid(box, {1, 2, 1}, mixed)}};
}

TEST(Footprint, CellsOfEveryPieceAreFound) {
  // Everywhere in the box, so also across its walls and periodic ends.
  const auto particles = testing::random_particles(box, 3000, 2e-3, 7);
  for (const GridCase& c : grids()) {
    for (const Deposition& kernel : {Deposition(Divided{}), Deposition(Centroid{})}) {
      EXPECT_EQ(count_differing(c.grid, particles, kernel), 0) << c.name;
    }
  }
}

TEST(Footprint, PiecesBeyondAWallGoToTheNearestCell) {
  const CartesianGrid grid(box, {6, 6, 12});
  // Centres in a corner and outside the box altogether.
  const std::vector<TestParticle> from{{{-0.0101, 0.02, 0.0}, 2e-3}, {{0.03, 0.06, 0.07}, 2e-3}};
  EXPECT_EQ(count_differing(grid, from, Divided{}), 0);
}

TEST(Footprint, ParticlesBeyondAPeriodicEndWrap) {
  const CartesianGrid grid(box, {6, 6, 12}, {true, true, true});
  const std::vector<TestParticle> from{{{0.0201, 0.0503, -0.0001}, 2e-3}, {{-0.041, 0.0797, 0.13}, 1e-3}};
  EXPECT_EQ(count_differing(grid, from, Divided{}), 0);
}

TEST(Footprint, NoticesThatParticlesMovedOrChangedPlaces) {
  std::vector<TestParticle> from = testing::random_particles(box, 100, 1e-3, 3);
  const CartesianGrid grid(box, {5, 3, 8});
  Footprint footprint(GridLocator(grid), Divided{});
  EXPECT_FALSE(footprint.is_current(make_particles(from)));
  footprint.compute(make_particles(from));
  EXPECT_TRUE(footprint.is_current(make_particles(from)));
  std::swap(from[3], from[40]);
  EXPECT_FALSE(footprint.is_current(make_particles(from)));
  std::swap(from[3], from[40]);
  from[99].position.z = std::nextafter(from[99].position.z, 1);
  EXPECT_FALSE(footprint.is_current(make_particles(from)));
  from.pop_back();
  EXPECT_FALSE(footprint.is_current(make_particles(from)));
}

struct SampleKernel {
  FootprintView footprint;
  DeviceArray<Real> field, sampled;
  KOKKOS_INLINE_FUNCTION void operator()(const Index p) const { sampled(p) = footprint.sample(p, field); }
};

std::vector<Real> sample(const CartesianGrid& grid, const std::vector<Real>& field,
                         const std::vector<TestParticle>& from, const Deposition& kernel) {
  const dem::Particles particles = make_particles(from);
  Footprint footprint(GridLocator(grid), kernel);
  footprint.compute(particles);
  const DeviceArray<Real> values("tests::footprint::field", field.size());
  const DeviceArray<Real> sampled("tests::footprint::sampled", from.size());
  const auto host = Kokkos::create_mirror_view(values);
  std::copy(field.begin(), field.end(), host.data());
  Kokkos::deep_copy(values, host);
  Kokkos::parallel_for("tests::footprint::sample", DeviceRange(0, particles.count),
                       SampleKernel{footprint.view(), values, sampled});
  return testing::to_vector(sampled, particles.count);
}

TEST(Footprint, SamplesAConstantExactlyAndAnyFieldByItsShares) {
  const CartesianGrid grid(box, {5, 3, 8});
  const auto from = testing::random_particles(box, 500, 3e-3, 11);
  std::vector<Real> field(static_cast<std::size_t>(grid.cell_count()), 4.25);
  for (const Real s : sample(grid, field, from, Divided{})) EXPECT_NEAR(s, 4.25, 4e-15);  // a few roundings
  for (std::size_t c = 0; c < field.size(); ++c) field[c] = std::sin(1.0 + static_cast<Real>(c));
  const auto sampled = sample(grid, field, from, Divided{});
  for (std::size_t p = 0; p < from.size(); ++p) {
    Real expected = 0;
    for (const auto& [cell, pieces] : brute_force(grid, from[p], true)) {
      expected += pieces / 33.0 * field[static_cast<std::size_t>(cell)];
    }
    EXPECT_NEAR(sampled[p], expected, 1e-14);
  }
}

// A field that is linear in space is sampled without bias: over all places a particle can have relative to the cells,
// the mean error is zero, since the pieces' centres balance around the particle's centre.
TEST(Footprint, SamplesALinearFieldWithoutBias) {
  const CartesianGrid grid(box, {6, 6, 12});
  std::vector<Real> field;
  const Vec3 slope{3, -2, 5};
  for (Index c = 0; c < grid.cell_count(); ++c) {
    const Index3 at = grid.coordinates(c);
    field.push_back(dot(slope, Vec3{grid.center(0, at.x), grid.center(1, at.y), grid.center(2, at.z)}));
  }
  constexpr int n = 24;
  const Real h = 0.005;  // cell size in all directions
  std::vector<TestParticle> from;
  for (int c = 0; c < n; ++c) {
    for (int b = 0; b < n; ++b) {
      for (int a = 0; a < n; ++a) {
        from.push_back(
            {{0.0 + h * (a + 0.5) / n, 0.03 + h * (b + 0.5) / n, 0.02 + h * (c + 0.5) / n}, 1.5e-3});
      }
    }
  }
  for (const Deposition& kernel : {Deposition(Divided{}), Deposition(Centroid{})}) {
    const auto sampled = sample(grid, field, from, kernel);
    Real error = 0, rms = 0;
    for (std::size_t p = 0; p < from.size(); ++p) {
      const Real e = sampled[p] - dot(slope, from[p].position);
      error += e / static_cast<Real>(from.size());
      rms += e * e / static_cast<Real>(from.size());
    }
    // 24 places a cell: pieces on the two sides of the centre leave a cell at mirrored places, so errors cancel.
    EXPECT_NEAR(error, 0, 1e-12);
    // For one point the rms error of a cell's constant is h / sqrt(12) in each direction.
    const Real one_point = h / std::sqrt(12.) * std::sqrt(9. + 4 + 25);
    if (std::holds_alternative<Centroid>(kernel)) {
      EXPECT_NEAR(std::sqrt(rms) / one_point, 1, 1e-2);
    } else {
      EXPECT_LT(std::sqrt(rms), 0.85 * one_point);  // 33 points see part of the change between cells
    }
  }
}

}  // namespace
}  // namespace pellicle::coupling
