// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What vectors of any width have in common. Included where kWidth is known.

// Arithmetic is by the compiler's own operators.
using Vector = SEGORIENT_VECTOR(float, kWidth);

inline Vector load(const float* p) {
  Vector v;
  copyBytes(&v, p, sizeof(v));
  return v;
}
inline void store(Vector v, float* p) {
  copyBytes(p, &v, sizeof(v));
}
inline Vector broadcast(float v) {
  return Vector{} + v;
}
using Quad = SEGORIENT_VECTOR(float, 4);

inline Quad loadQuad(const float* p) {
  return _mm_loadu_ps(p);
}
inline void storeQuad(Quad q, float* p) {
  _mm_storeu_ps(p, q);
}
inline void storeInts(Quad q, int* p) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm_cvttps_epi32(q));
}
inline Quad largestOf(Quad a, Quad b) {
  return _mm_max_ps(a, b);
}
inline Quad smallestOf(Quad a, Quad b) {
  return _mm_min_ps(a, b);
}
inline float squareRoot(float v) {
  return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(v)));
}
