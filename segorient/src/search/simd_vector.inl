// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What vectors of any width have in common. Included where kWidth is known.

// Arithmetic is by the compiler's own operators.
using Vector = float __attribute__((vector_size(4 * kWidth)));

inline Vector load(const float* p) {
  Vector v;
  __builtin_memcpy(&v, p, sizeof(v));
  return v;
}
inline void store(Vector v, float* p) {
  __builtin_memcpy(p, &v, sizeof(v));
}
inline Vector broadcast(float v) {
  return Vector{} + v;
}
inline float squareRoot(float v) {
  return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(v)));
}
