// Counter-based random numbers: each is a function of (seed, purpose, step, id) alone, so that it does not depend on
// the number of threads, on the order of the particles or on a restart.
#pragma once

#include <Kokkos_Macros.hpp>
#include <cstdint>

#include "core/types.hpp"
#include "core/vector.hpp"

namespace pellicle::core {

/// What a random number is for; two purposes never share a stream.
enum class Purpose : std::uint32_t {
  fill_position = 1,
  fill_velocity,
  diameter,
  spray,
  capture,
  test,
  feed_position
};

/// Four random words.
struct RandomWords {
  std::uint32_t word[4];
};

/// Philox4x32-10: Salmon, Moraes, Dror & Shaw (2011), "Parallel random numbers: as easy as 1, 2, 3", SC11,
/// doi 10.1145/2063384.2063405.
KOKKOS_INLINE_FUNCTION constexpr RandomWords philox4x32_10(RandomWords counter, std::uint32_t key0,
                                                           std::uint32_t key1) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product0 = std::uint64_t{0xD2511F53u} * counter.word[0];
    const std::uint64_t product1 = std::uint64_t{0xCD9E8D57u} * counter.word[2];
    counter = {{static_cast<std::uint32_t>(product1 >> 32) ^ counter.word[1] ^ key0,
                static_cast<std::uint32_t>(product1),
                static_cast<std::uint32_t>(product0 >> 32) ^ counter.word[3] ^ key1,
                static_cast<std::uint32_t>(product0)}};
    key0 += 0x9E3779B9u;  // the golden ratio and sqrt(3) - 1: Weyl sequences of the keys
    key1 += 0xBB67AE85u;
  }
  return counter;
}

/// Four independent random words for a purpose, an outer step or substep, and a particle id (below 2^32).
/// `draw` (below 2^16) gives further words for the same four.
KOKKOS_INLINE_FUNCTION constexpr RandomWords random_words(std::uint64_t seed, Purpose purpose,
                                                          std::int64_t step, std::int64_t id,
                                                          std::uint32_t draw = 0) {
  const auto s = static_cast<std::uint64_t>(step);
  return philox4x32_10(
      {{static_cast<std::uint32_t>(id), static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(s >> 32),
        static_cast<std::uint32_t>(purpose) << 16 | draw}},
      static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32));
}

/// A number in [0, 1) on a grid of 2^-53 from two random words.
KOKKOS_INLINE_FUNCTION constexpr Real to_uniform(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 32 | low) >> 11;
  return static_cast<Real>(bits) * 0x1.0p-53;
}

/// Uniform in [0, 1).
KOKKOS_INLINE_FUNCTION constexpr Real random_uniform(std::uint64_t seed, Purpose purpose, std::int64_t step,
                                                     std::int64_t id, std::uint32_t draw = 0) {
  const RandomWords w = random_words(seed, purpose, step, id, draw);
  return to_uniform(w.word[0], w.word[1]);
}

/// Three independent uniforms in [0, 1); uses draws `2 draw` and `2 draw + 1`.
KOKKOS_INLINE_FUNCTION constexpr Vec3 random_uniform3(std::uint64_t seed, Purpose purpose, std::int64_t step,
                                                      std::int64_t id, std::uint32_t draw = 0) {
  const RandomWords a = random_words(seed, purpose, step, id, 2 * draw);
  const RandomWords b = random_words(seed, purpose, step, id, 2 * draw + 1);
  return {to_uniform(a.word[0], a.word[1]), to_uniform(a.word[2], a.word[3]),
          to_uniform(b.word[0], b.word[1])};
}

/// Standard normal deviate: Box & Muller (1958), Ann. Math. Stat. 29, 610.
KOKKOS_INLINE_FUNCTION Real random_normal(std::uint64_t seed, Purpose purpose, std::int64_t step,
                                          std::int64_t id, std::uint32_t draw = 0) {
  const RandomWords w = random_words(seed, purpose, step, id, draw);
  const Real u = 1.0 - to_uniform(w.word[0], w.word[1]);  // in (0, 1]: its logarithm is finite
  const Real v = to_uniform(w.word[2], w.word[3]);
  constexpr Real two_pi = 6.283185307179586476925286766559;
  return std::sqrt(-2.0 * std::log(u)) * std::cos(two_pi * v);
}

}  // namespace pellicle::core
