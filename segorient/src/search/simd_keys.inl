// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Keys to sort by, four of them, where there is AVX2.

using Keys = __m256d;

inline Keys packKeys(const float* distance, const std::uint32_t* id) {
  const __m128i biased = _mm_add_epi32(_mm_castps_si128(_mm_loadu_ps(distance)),
                                       _mm_set1_epi32(static_cast<int>(kKeyBias)));
  const __m128i ids = _mm_loadu_si128(reinterpret_cast<const __m128i*>(id));
  return _mm256_castsi256_pd(
      _mm256_set_m128i(_mm_unpackhi_epi32(ids, biased), _mm_unpacklo_epi32(ids, biased)));
}
inline void unpackKeys(Keys keys, float* distance, std::uint32_t* id) {
  const __m256i apart = _mm256_permutevar8x32_epi32(_mm256_castpd_si256(keys),
                                                    _mm256_setr_epi32(0, 2, 4, 6, 1, 3, 5, 7));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(id), _mm256_castsi256_si128(apart));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(distance),
                   _mm_sub_epi32(_mm256_extracti128_si256(apart, 1),
                                 _mm_set1_epi32(static_cast<int>(kKeyBias))));
}
inline Keys minOf(Keys a, Keys b) {
  return _mm256_min_pd(a, b);
}
inline Keys maxOf(Keys a, Keys b) {
  return _mm256_max_pd(a, b);
}
inline Keys swapPairs(Keys a) {
  return _mm256_permute_pd(a, 0x5);
}
inline Keys reverse(Keys a) {
  return _mm256_permute4x64_pd(a, 0x1b);
}
inline Keys swapHalves(Keys a) {
  return _mm256_permute2f128_pd(a, a, 0x01);
}
inline Keys evenOdd(Keys even, Keys odd) {
  return _mm256_blend_pd(even, odd, 0xa);
}
inline Keys lowHigh(Keys low, Keys high) {
  return _mm256_blend_pd(low, high, 0xc);
}
inline void transpose(Keys (&k)[4]) {
  const Keys a = _mm256_unpacklo_pd(k[0], k[1]);
  const Keys b = _mm256_unpackhi_pd(k[0], k[1]);
  const Keys c = _mm256_unpacklo_pd(k[2], k[3]);
  const Keys d = _mm256_unpackhi_pd(k[2], k[3]);
  k[0] = _mm256_permute2f128_pd(a, c, 0x20);
  k[1] = _mm256_permute2f128_pd(b, d, 0x20);
  k[2] = _mm256_permute2f128_pd(a, c, 0x31);
  k[3] = _mm256_permute2f128_pd(b, d, 0x31);
}
