// What outputs read of heat, film and hits.
#include <gtest/gtest.h>

#include <cmath>

#include "core/model_list.hpp"
#include "heat/film_laws.hpp"
#include "tests/tools/particles_for_tests.hpp"
#include "tools/pellicle/particle_quantities.hpp"

namespace pellicle::tools {
namespace {

Real value(const ParticleSample& sample, std::string_view name) {
  return particle_quantity(core::find_model(particle_quantities, name), sample);
}

TEST(FilmLaws, ThicknessOfACoating) {
  // A shell from 0.375 to 0.376 mm: 4/3 pi (0.376^3 - 0.375^3) mm3 = 1.7718...e-3 mm3 of 1500 kg/m3.
  const Real shell = 4.0 / 3.0 * M_PI * (std::pow(0.376e-3, 3) - std::pow(0.375e-3, 3));
  EXPECT_NEAR(heat::coating_thickness(0.375e-3, 1500 * shell, 1500), 1e-6, 1e-6 * 1e-12);  // cubes cancel
  EXPECT_EQ(heat::coating_thickness(0.375e-3, 0, 1500), 0);
  // The thesis's mean, 1.8942838 ug on 375 um, with 40 digits; the flat film m / (4 pi R^2 rho) would be 0.71463 um.
  EXPECT_NEAR(heat::coating_thickness(375e-6, 1.8942838e-9, 1500), 7.13272687025664e-7, 1e-20);
  // Far thinner than round-off of R: the flat limit m / (4 pi R^2 rho).
  const Real flat = 1e-22 / (4 * M_PI * 375e-6 * 375e-6 * 1500);
  EXPECT_NEAR(heat::coating_thickness(375e-6, 1e-22, 1500), flat, 1e-12 * flat);
}

TEST(ParticleQuantities, HeatFilmAndHits) {
  ParticleSample sample;
  sample.position_radius.radius = 375e-6;
  sample.temperature = 321;
  sample.film = {2e-12, 1.8942838e-9};
  sample.hit = {4, 0.25, 0.75};
  sample.solids_density = 1500;
  EXPECT_EQ(value(sample, "particle_temperature"), 321);
  EXPECT_EQ(value(sample, "film_liquid"), 2e-12);
  EXPECT_EQ(value(sample, "film_solids"), 1.8942838e-9);
  EXPECT_NEAR(value(sample, "coating_thickness"), 7.13272687025664e-7, 1e-20);
  EXPECT_EQ(value(sample, "hits"), 4);
  EXPECT_EQ(value(sample, "first_hit_time"), 0.25);
  EXPECT_EQ(value(sample, "last_hit_time"), 0.75);
}

// The copy on the host is sorted by id: so must be what lies beside the particles.
TEST(ParticleQuantities, ColumnsFollowTheIds) {
  ParticleColumns columns = tests::make_particles({{{}, {}, 2}, {{}, {}, 0}, {{}, {}, 1}});
  columns.temperature = DeviceArray<Real>("test::temperature", 3);
  columns.film = DeviceArray<heat::Film>("test::film", 3);
  columns.hits = DeviceArray<spray::HitRecord>("test::hits", 3);
  const auto temperature = Kokkos::create_mirror_view(columns.temperature);
  const auto film = Kokkos::create_mirror_view(columns.film);
  const auto hits = Kokkos::create_mirror_view(columns.hits);
  const int ids[] = {2, 0, 1};
  for (std::size_t p = 0; p < 3; ++p) {
    temperature(p) = 300 + ids[p];
    film(p) = {1e-9 * ids[p], 2e-9 * ids[p]};
    hits(p).hits = 10 * ids[p];
  }
  Kokkos::deep_copy(columns.temperature, temperature);
  Kokkos::deep_copy(columns.film, film);
  Kokkos::deep_copy(columns.hits, hits);
  const HostParticles host = copy_to_host(columns);
  for (std::size_t id = 0; id < 3; ++id) {
    const ParticleSample sample = host.sample(id);
    EXPECT_EQ(sample.velocity_spin.id, static_cast<int>(id));
    EXPECT_EQ(sample.temperature, 300 + static_cast<int>(id));
    EXPECT_EQ(sample.film.solids, 2e-9 * static_cast<int>(id));
    EXPECT_EQ(sample.hit.hits, 10 * static_cast<int>(id));
  }
}

}  // namespace
}  // namespace pellicle::tools
