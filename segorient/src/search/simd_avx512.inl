// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Sixteen lanes, and lanes moved together by one instruction; to memory by another, since both at
// once are slow on some machines.

constexpr const char* kName = "avx512";
constexpr std::uint32_t kWidth = 16;
#include "search/simd_vector.inl"

// What is not masked draws a warning from some versions of g++ about its own header.
constexpr __mmask16 kAll = 0xffff;

inline Vector largestOf(Vector a, Vector b) {
  return _mm512_maskz_max_ps(kAll, a, b);
}
inline Vector smallestOf(Vector a, Vector b) {
  return _mm512_maskz_min_ps(kAll, a, b);
}
inline Vector squareRoot(Vector v) {
  return _mm512_maskz_sqrt_ps(kAll, v);
}
inline Vector truncate(Vector v) {
  return _mm512_maskz_roundscale_ps(kAll, v, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
}
inline Vector counting() {
  return Vector{0.0F, 1.0F, 2.0F,  3.0F,  4.0F,  5.0F,  6.0F,  7.0F,
                8.0F, 9.0F, 10.0F, 11.0F, 12.0F, 13.0F, 14.0F, 15.0F};
}
// Of each lane, `yes` where a < b, otherwise `no`.
inline Vector selectLess(Vector a, Vector b, Vector yes, Vector no) {
  return _mm512_mask_blend_ps(_mm512_cmp_ps_mask(a, b, _CMP_LT_OQ), no, yes);
}
inline void storeInts(Vector v, int* p) {
  _mm512_storeu_si512(p, _mm512_maskz_cvttps_epi32(kAll, v));
}
inline unsigned int lessMask(Vector a, Vector b) {
  return static_cast<unsigned int>(_mm512_cmp_ps_mask(a, b, _CMP_LT_OQ));
}
inline void compress(Vector v, unsigned int mask, float* out) {
  _mm512_storeu_ps(out, _mm512_maskz_compress_ps(static_cast<__mmask16>(mask), v));
}
inline std::size_t compressIds(const std::uint32_t* ids, unsigned int mask, std::uint32_t* out) {
  _mm512_storeu_si512(
      out, _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), _mm512_loadu_si512(ids)));
  return static_cast<std::size_t>(_mm_popcnt_u32(mask));
}

#include "search/simd_keys.inl"
