// How much memory the engine takes for a particle.
#include <gtest/gtest.h>

#include <cstring>

#include "dem/fill.hpp"
#include "tests/dem/bed.hpp"

namespace pellicle::dem {
namespace {

// The hooks are plain functions, so what they count is kept here: bytes in Views of dem/.
std::uint64_t held = 0;

bool of_dem(const char* label) { return std::strncmp(label, "dem::", 5) == 0; }
void see_allocation(const Kokkos::Profiling::SpaceHandle, const char* label, const void*,
                    const std::uint64_t size) {
  if (of_dem(label)) held += size;
}
void see_release(const Kokkos::Profiling::SpaceHandle, const char* label, const void*,
                 const std::uint64_t size) {
  if (of_dem(label)) held -= size;
}

struct Bytes {
  Real counted;    ///< by the engine
  Real allocated;  ///< by Kokkos
};

/// Bytes a particle of a settling bed of spheres whose radii are spread from 1 - spread to 1 + spread of 1 mm.
Bytes bytes_per_particle(Real spread, bool remembers) {
  namespace tools = Kokkos::Tools::Experimental;
  const auto before = tools::get_callbacks();
  held = 0;
  tools::set_allocate_data_callback(see_allocation);
  tools::set_deallocate_data_callback(see_release);
  const std::size_t count = 30'000;
  auto setup = tests::glass_setup({0.06, 0.06, 0.10}, 1e-5);
  setup.gravity = {0, 0, -9.81};
  setup.skin.smallest_fraction = 0.1;  // so that the length of the lists is given
  setup.skin.tuned = false;
  if (remembers) tests::let_contacts_remember(setup);
  tests::add_box_walls(setup);
  std::vector<Real> radii;
  for (std::size_t p = 0; p < count; ++p)
    radii.push_back(0.001 * (1 + spread * tests::random_vector(1, static_cast<int>(p)).x));
  const auto centres = fill_region(Box{{0, 0, 0}, {0.06, 0.06, 0.0635}}, FillPattern::random, radii, 1);
  std::vector<ParticleSeed> seeds;
  for (std::size_t p = 0; p < centres.size(); ++p) seeds.push_back({centres[p], {}, {}, radii[p], 0, false});
  Engine engine(setup);
  engine.set_particles(seeds);
  for (int k = 0; k < 40; ++k) {
    engine.prepare_outer_step();
    tests::advance(engine, 10);
  }
  EXPECT_EQ(engine.particles().count, static_cast<Index>(count));
  // Each pair is in the list once: more than seven neighbours a particle.
  EXPECT_GT(engine.neighbours_per_particle(), 3.5) << "no packed bed";
  tools::set_callbacks(before);
  return {static_cast<Real>(engine.bytes()) / static_cast<Real>(count),
          static_cast<Real>(held) / static_cast<Real>(count)};
}

TEST(Memory, AParticleTakesAtMost300BytesWithAllItsNeighbours) {
  for (const Real spread : {0.0, 0.33}) {
    const Real bytes = bytes_per_particle(spread, false).counted;
    EXPECT_LE(bytes, 300);
    EXPECT_GT(bytes, 160);  // position, velocity, spin and forces alone
    RecordProperty("bytes_per_particle_spread_" + std::to_string(static_cast<int>(100 * spread)),
                   std::to_string(bytes));
  }
}

TEST(Memory, SpringsOfContactsComeOnTop) {
  EXPECT_GT(bytes_per_particle(0, true).counted, bytes_per_particle(0, false).counted + 100);
}

TEST(Memory, EveryArrayIsCounted) {
  for (const bool remembers : {false, true}) {
    const Bytes bytes = bytes_per_particle(0, remembers);
    EXPECT_LE(bytes.counted, bytes.allocated);
    // What does not grow with the particles: walls, the pair table, Kokkos' notes of some 150 bytes beside each array.
    EXPECT_GT(bytes.counted, bytes.allocated - 1) << remembers;
  }
}

}  // namespace
}  // namespace pellicle::dem
