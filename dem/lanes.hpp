// Eight or sixteen numbers side by side in vector registers of a CPU: what the compiler does not find by itself. Where the
// processor lacks AVX-512 the same results come from shorter vectors and plain loops.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#if defined(__AVX512F__) && defined(__AVX512VL__)
#include <immintrin.h>
#define PELLICLE_AVX512
#endif

#include "core/types.hpp"

#if defined(__GNUC__) && !defined(__clang__)
// On a processor with shorter vectors gcc tells how it would pass the long ones; all calls are inlined.
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

namespace pellicle::dem::lanes {

using Real4 = Real __attribute__((vector_size(32)));
using Real8 = Real __attribute__((vector_size(64)));
using Bits4 = std::int64_t __attribute__((vector_size(32)));
using Bits8 = std::int64_t __attribute__((vector_size(64)));
using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Float16 = float __attribute__((vector_size(64)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Unsigned8 = std::uint32_t __attribute__((vector_size(32)));
using Short8 = std::uint16_t __attribute__((vector_size(16)));

/// One bit a lane, lane 0 the lowest.
using Mask8 = std::uint8_t;

/// Reads a vector from memory of any alignment.
template <class Vector, class T>
inline Vector load(const T* from) {
  Vector v;
  std::memcpy(&v, from, sizeof(Vector));
  return v;
}

/// Writes a vector to memory of any alignment.
template <class Vector, class T>
inline void store(const Vector& v, T* to) {
  std::memcpy(to, &v, sizeof(Vector));
}

inline Float8 to_float(const Real8& v) {
#ifdef PELLICLE_AVX512
  return reinterpret_cast<Float8>(_mm512_maskz_cvtpd_ps(0xff, reinterpret_cast<__m512d>(v)));
#else
  return __builtin_convertvector(v, Float8);
#endif
}

inline Real8 to_real(const Float8& v) {
#ifdef PELLICLE_AVX512
  return reinterpret_cast<Real8>(_mm512_maskz_cvtps_pd(0xff, reinterpret_cast<__m256>(v)));
#else
  return __builtin_convertvector(v, Real8);
#endif
}

inline Real8 join(const Real4& a, const Real4& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline Float8 join(const Float4& a, const Float4& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline Float16 join(const Float8& a, const Float8& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

inline Real8 all(Real x) { return Real8{x, x, x, x, x, x, x, x}; }

/// Lanes where a <= b does not hold, so also where one of them is not a number.
inline unsigned not_at_most(const Float16& a, const Float16& b) {
#ifdef PELLICLE_AVX512
  return _mm512_cmp_ps_mask(reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b), _CMP_NLE_UQ);
#else
  unsigned mask = 0;
  for (int k = 0; k < 16; ++k) mask |= (a[k] <= b[k] ? 0U : 1U) << k;
  return mask;
#endif
}

/// Lanes where a < b.
inline Mask8 less(const Real8& a, const Real8& b) {
#ifdef PELLICLE_AVX512
  return _mm512_cmp_pd_mask(reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b), _CMP_LT_OQ);
#else
  unsigned mask = 0;
  for (int k = 0; k < 8; ++k) mask |= (a[k] < b[k] ? 1U : 0U) << k;
  return static_cast<Mask8>(mask);
#endif
}

/// Lanes below `first` or above `last`.
inline Mask8 outside(const Int8& a, std::int32_t first, std::int32_t last) {
#ifdef PELLICLE_AVX512
  const auto v = reinterpret_cast<__m256i>(a);
  return _mm256_cmplt_epi32_mask(v, _mm256_set1_epi32(first)) |
         _mm256_cmpgt_epi32_mask(v, _mm256_set1_epi32(last));
#else
  unsigned mask = 0;
  for (int k = 0; k < 8; ++k) mask |= (a[k] < first || a[k] > last ? 1U : 0U) << k;
  return static_cast<Mask8>(mask);
#endif
}

inline int count(Mask8 mask) { return std::popcount(mask); }

/// Writes the lanes of a mask side by side; all eight places from `to` on may be written over.
template <class Vector, class T>
inline void pack(Mask8 mask, const Vector& v, T* to) {
#ifdef PELLICLE_AVX512
  if constexpr (sizeof(Vector) == 64) {
    _mm512_storeu_pd(to, _mm512_maskz_compress_pd(mask, reinterpret_cast<__m512d>(v)));
  } else {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                        _mm256_maskz_compress_epi32(mask, reinterpret_cast<__m256i>(v)));
  }
#else
  int n = 0;
  for (int k = 0; k < 8; ++k) {
    to[n] = v[k];
    n += (mask >> k) & 1;
  }
#endif
}

/// The reverse of pack: writes numbers side by side to the places of a mask, and to no others.
inline void unpack(Mask8 mask, const Real* from, Real* to) {
#ifdef PELLICLE_AVX512
  _mm512_mask_storeu_pd(to, mask, _mm512_maskz_expand_pd(mask, _mm512_loadu_pd(from)));
#else
  for (int k = 0; k < 8; ++k) {
    if (((mask >> k) & 1) != 0) to[k] = *from++;
  }
#endif
}

/// Zero in the lanes that are not in the mask.
inline Real8 keep(Mask8 mask, const Real8& v) {
#ifdef PELLICLE_AVX512
  return reinterpret_cast<Real8>(_mm512_maskz_mov_pd(mask, reinterpret_cast<__m512d>(v)));
#else
  Real8 result{};
  for (int k = 0; k < 8; ++k) result[k] = ((mask >> k) & 1) != 0 ? v[k] : 0;
  return result;
#endif
}

/// Lanes of a that are in the mask, of b elsewhere.
inline Real8 select(Mask8 mask, const Real8& a, const Real8& b) {
#ifdef PELLICLE_AVX512
  return reinterpret_cast<Real8>(
      _mm512_mask_mov_pd(reinterpret_cast<__m512d>(b), mask, reinterpret_cast<__m512d>(a)));
#else
  Real8 result = b;
  for (int k = 0; k < 8; ++k) result[k] = ((mask >> k) & 1) != 0 ? a[k] : b[k];
  return result;
#endif
}

/// Three numbers from each of two places, side by side, and two zeros.
inline Float8 load_threes(const float* first, const float* second) {
#ifdef PELLICLE_AVX512
  const auto low = reinterpret_cast<Float4>(_mm_maskz_loadu_ps(0x07, first));
  const auto high = reinterpret_cast<Float4>(_mm_maskz_loadu_ps(0x07, second));
  return __builtin_shufflevector(low, high, 0, 1, 2, 4, 5, 6, 3, 7);
#else
  return Float8{first[0], first[1], first[2], second[0], second[1], second[2], 0, 0};
#endif
}

/// The reverse: writes the first six numbers to two places. Not with masked stores: one of more than is written holds up
/// the next load from there.
inline void store_threes(const Float8& v, float* first, float* second) {
  store(__builtin_shufflevector(v, v, 0, 1), first);
  store(__builtin_shufflevector(v, v, 3, 4), second);
  first[2] = v[2];
  second[2] = v[5];
}

/// Which of eight flags are set.
inline Mask8 load_flags(const bool* from) {
#ifdef PELLICLE_AVX512
  const __m128i flags = _mm_loadu_si64(from);
  return static_cast<Mask8>(_mm_movemask_epi8(_mm_slli_epi16(flags, 7)));
#else
  unsigned mask = 0;
  for (int k = 0; k < 8; ++k) mask |= (from[k] ? 1U : 0U) << k;
  return static_cast<Mask8>(mask);
#endif
}

/// The reverse: sets or clears eight flags.
inline void store_flags(Mask8 mask, bool* to) {
  for (int k = 0; k < 8; ++k) to[k] = ((mask >> k) & 1) != 0;
}

/// As round_to_single of a number.
inline Real8 round_to_single(const Real8& v) {
  constexpr std::int64_t dropped = (std::int64_t{1} << 29) - 1;
  return reinterpret_cast<Real8>((reinterpret_cast<Bits8>(v) + (dropped + 1) / 2) & ~dropped);
}

/// Transposes eight rows of eight.
inline void transpose(Real8 (&r)[8]) {
  Real8 t[8];
  for (int i = 0; i < 8; i += 2) {
    t[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    t[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int i = 0; i < 8; i += 4) {
    for (int c = 0; c < 2; ++c) {
      r[i + c] = __builtin_shufflevector(t[i + c], t[i + c + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      r[i + c + 2] = __builtin_shufflevector(t[i + c], t[i + c + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
  for (int c = 0; c < 4; ++c) {
    t[c] = __builtin_shufflevector(r[c], r[c + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    t[c + 4] = __builtin_shufflevector(r[c], r[c + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
  for (int c = 0; c < 8; ++c) r[c] = t[c];
}

/// Transposes sixteen rows of sixteen.
inline void transpose(Float16 (&r)[16]) {
  Float16 t[16];
  for (int i = 0; i < 16; i += 2) {
    t[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
    t[i + 1] =
        __builtin_shufflevector(r[i], r[i + 1], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
  }
  for (int i = 0; i < 16; i += 4) {
    for (int c = 0; c < 2; ++c) {
      const Float16& a = t[i + c];
      const Float16& b = t[i + c + 2];
      r[i + 2 * c] = __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
      r[i + 2 * c + 1] =
          __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
    }
  }
  // Now r[4 i + c] holds columns c, c + 4, c + 8, c + 12 of rows 4 i … 4 i + 3.
  const auto low = [](const Float16& a, const Float16& b) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27);
  };
  const auto high = [](const Float16& a, const Float16& b) {
    return __builtin_shufflevector(a, b, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31);
  };
  for (int c = 0; c < 4; ++c) {
    const Float16 even_first = low(r[c], r[c + 4]);
    const Float16 odd_first = high(r[c], r[c + 4]);
    const Float16 even_last = low(r[c + 8], r[c + 12]);
    const Float16 odd_last = high(r[c + 8], r[c + 12]);
    t[c] = low(even_first, even_last);
    t[c + 8] = high(even_first, even_last);
    t[c + 4] = low(odd_first, odd_last);
    t[c + 12] = high(odd_first, odd_last);
  }
  for (int c = 0; c < 16; ++c) r[c] = t[c];
}

}  // namespace pellicle::dem::lanes
