// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Every x86-64 machine has SSE2. There is no shuffle by a variable.

constexpr const char* kName = "sse2";
constexpr std::uint32_t kWidth = 4;
#include "search/simd_vector.inl"

inline Vector squareRoot(Vector v) {
  return _mm_sqrt_ps(v);
}
inline Vector truncate(Vector v) {
  return _mm_cvtepi32_ps(_mm_cvttps_epi32(v));
}
inline Vector counting() {
  return Vector{0.0F, 1.0F, 2.0F, 3.0F};
}
// Of each lane, `yes` where a < b, otherwise `no`.
inline Vector selectLess(Vector a, Vector b, Vector yes, Vector no) {
  const __m128 less = _mm_cmplt_ps(a, b);
  return _mm_or_ps(_mm_and_ps(less, yes), _mm_andnot_ps(less, no));
}
inline unsigned int lessMask(Vector a, Vector b) {
  return static_cast<unsigned int>(_mm_movemask_ps(_mm_cmplt_ps(a, b)));
}
// Writes two pairs of lanes; of each, the second moves down where the first is not wanted.
inline void putPairs(std::uint64_t low, std::uint64_t high, unsigned int mask, void* out) {
  low >>= 32U * (~mask & 1U);
  high >>= 32U * ((~mask >> 2U) & 1U);
  char* const at = static_cast<char*>(out);
  copyBytes(at, &low, sizeof(low));
  const std::size_t first = (mask & 1U) + ((mask >> 1U) & 1U);
  copyBytes(at + 4 * first, &high, sizeof(high));
}
inline std::size_t lanesIn(unsigned int mask) {
  return (0x4332322132212110ULL >> (4 * mask)) & 15U;
}
inline void compress(Vector v, unsigned int mask, float* out) {
  const __m128i lanes = _mm_castps_si128(v);
  putPairs(static_cast<std::uint64_t>(_mm_cvtsi128_si64(lanes)),
           static_cast<std::uint64_t>(_mm_cvtsi128_si64(_mm_unpackhi_epi64(lanes, lanes))), mask,
           out);
}
inline std::size_t compressIds(const std::uint32_t* ids, unsigned int mask, std::uint32_t* out) {
  std::uint64_t pairs[2];
  copyBytes(pairs, ids, sizeof(pairs));
  putPairs(pairs[0], pairs[1], mask, out);
  return lanesIn(mask);
}

// For each mask the lanes that are set.
struct LaneLists {
  alignas(16) std::uint32_t lanes[16][4];
  constexpr LaneLists() : lanes() {
    for (unsigned int mask = 0; mask < 16; ++mask) {
      unsigned int n = 0;
      for (std::uint32_t lane = 0; lane < 4; ++lane) {
        if ((mask >> lane) & 1U) lanes[mask][n++] = lane;
      }
    }
  }
};
constexpr LaneLists kLaneLists;

// Lists where the lanes of a vector are whose first one is at `first`.
inline std::size_t listLanes(std::uint32_t first, unsigned int mask, std::uint32_t* out) {
  const auto* const lanes = reinterpret_cast<const __m128i*>(kLaneLists.lanes[mask]);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(out),
                   _mm_add_epi32(_mm_set1_epi32(static_cast<int>(first)), _mm_load_si128(lanes)));
  return lanesIn(mask);
}

struct Keys {
  __m128d low, high;
};

inline Keys packKeys(const float* distance, const std::uint32_t* id) {
  const __m128i biased = _mm_add_epi32(_mm_castps_si128(_mm_loadu_ps(distance)),
                                       _mm_set1_epi32(static_cast<int>(kKeyBias)));
  const __m128i ids = _mm_loadu_si128(reinterpret_cast<const __m128i*>(id));
  return {_mm_castsi128_pd(_mm_unpacklo_epi32(ids, biased)),
          _mm_castsi128_pd(_mm_unpackhi_epi32(ids, biased))};
}
inline void unpackKeys(const Keys& keys, float* distance, std::uint32_t* id) {
  const __m128 a = _mm_castpd_ps(keys.low);
  const __m128 b = _mm_castpd_ps(keys.high);
  const __m128i biased = _mm_castps_si128(_mm_shuffle_ps(a, b, 0xdd));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(distance),
                   _mm_sub_epi32(biased, _mm_set1_epi32(static_cast<int>(kKeyBias))));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(id), _mm_castps_si128(_mm_shuffle_ps(a, b, 0x88)));
}
inline Keys minOf(const Keys& a, const Keys& b) {
  return {_mm_min_pd(a.low, b.low), _mm_min_pd(a.high, b.high)};
}
inline Keys maxOf(const Keys& a, const Keys& b) {
  return {_mm_max_pd(a.low, b.low), _mm_max_pd(a.high, b.high)};
}
inline Keys swapPairs(const Keys& a) {
  return {_mm_shuffle_pd(a.low, a.low, 1), _mm_shuffle_pd(a.high, a.high, 1)};
}
inline Keys reverse(const Keys& a) {
  return {_mm_shuffle_pd(a.high, a.high, 1), _mm_shuffle_pd(a.low, a.low, 1)};
}
inline Keys swapHalves(const Keys& a) {
  return {a.high, a.low};
}
inline Keys evenOdd(const Keys& even, const Keys& odd) {
  return {_mm_shuffle_pd(even.low, odd.low, 2), _mm_shuffle_pd(even.high, odd.high, 2)};
}
inline Keys lowHigh(const Keys& low, const Keys& high) {
  return {low.low, high.high};
}
inline void transpose(Keys (&k)[4]) {
  const Keys a = k[0];
  const Keys b = k[1];
  const Keys c = k[2];
  const Keys d = k[3];
  k[0] = {_mm_unpacklo_pd(a.low, b.low), _mm_unpacklo_pd(c.low, d.low)};
  k[1] = {_mm_unpackhi_pd(a.low, b.low), _mm_unpackhi_pd(c.low, d.low)};
  k[2] = {_mm_unpacklo_pd(a.high, b.high), _mm_unpacklo_pd(c.high, d.high)};
  k[3] = {_mm_unpackhi_pd(a.high, b.high), _mm_unpackhi_pd(c.high, d.high)};
}
