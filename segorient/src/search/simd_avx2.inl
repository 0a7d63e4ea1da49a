// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

constexpr const char* kName = "avx2";
constexpr std::uint32_t kWidth = 8;
#include "search/simd_vector.inl"

inline Vector largestOf(Vector a, Vector b) {
  return _mm256_max_ps(a, b);
}
inline Vector smallestOf(Vector a, Vector b) {
  return _mm256_min_ps(a, b);
}
inline Vector squareRoot(Vector v) {
  return _mm256_sqrt_ps(v);
}
inline Vector truncate(Vector v) {
  return _mm256_round_ps(v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
inline Vector counting() {
  return Vector{0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F};
}
// Of each lane, `yes` where a < b, otherwise `no`.
inline Vector selectLess(Vector a, Vector b, Vector yes, Vector no) {
  return _mm256_blendv_ps(no, yes, _mm256_cmp_ps(a, b, _CMP_LT_OQ));
}
inline void storeInts(Vector v, int* p) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), _mm256_cvttps_epi32(v));
}
inline unsigned int lessMask(Vector a, Vector b) {
  return static_cast<unsigned int>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
}
inline __m256i lanesOf(unsigned int mask) {
  return _mm256_cvtepu8_epi32(
      _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&kLanes.lanes[mask])));
}
inline void compress(Vector v, unsigned int mask, float* out) {
  _mm256_storeu_ps(out, _mm256_permutevar8x32_ps(v, lanesOf(mask)));
}
inline std::size_t compressIds(const std::uint32_t* ids, unsigned int mask, std::uint32_t* out) {
  const __m256i v = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(ids));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(out),
                      _mm256_permutevar8x32_epi32(v, lanesOf(mask)));
  return static_cast<std::size_t>(_mm_popcnt_u32(mask));
}

#include "search/simd_keys.inl"
