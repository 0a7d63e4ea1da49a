// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// One float of each of several points, side by side in a vector register. Included once per
// instruction set, with SEGORIENT_LANES set to 4 or 8; all arithmetic is per lane and rounded as
// scalar code would, so the results do not depend on the width.

constexpr int kLanes = SEGORIENT_LANES;
constexpr std::size_t kWidth = SEGORIENT_LANES;

typedef float Lanes __attribute__((vector_size(4 * SEGORIENT_LANES)));
typedef std::int32_t Mask __attribute__((vector_size(4 * SEGORIENT_LANES)));
typedef float Quad __attribute__((vector_size(16)));

/// Two registers, computed in turn: while a quotient or root of one is on its way, the other gets
/// on.
struct Twice {
  Lanes first, second;
};
struct TwiceMask {
  Mask first, second;
};

template <typename V>
struct Vector3 {
  V x, y, z;
};
using Lanes3 = Vector3<Lanes>;
using Twice3 = Vector3<Twice>;

inline Lanes all(float value) {
  return Lanes{} + value;
}
inline Lanes select(Mask condition, Lanes yes, Lanes no) {
  return condition ? yes : no;
}
inline Lanes larger(Lanes a, Lanes b) {
  return a > b ? a : b;
}
inline Lanes smaller(Lanes a, Lanes b) {
  return a < b ? a : b;
}
inline Lanes absolute(Lanes a) {
  return reinterpret_cast<Lanes>(reinterpret_cast<Mask>(a) & 0x7fffffff);
}

inline Lanes squareRoot(Lanes a) {
#if SEGORIENT_LANES == 8
  return reinterpret_cast<Lanes>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
#elif defined(__SSE2__)
  return reinterpret_cast<Lanes>(_mm_sqrt_ps(reinterpret_cast<__m128>(a)));
#else
  for (int l = 0; l < kLanes; ++l) a[l] = std::sqrt(a[l]);
  return a;
#endif
}

#define SEGORIENT_TWICE(result, op)                           \
  inline result operator op(const Twice& a, const Twice& b) { \
    return {a.first op b.first, a.second op b.second};        \
  }                                                           \
  inline result operator op(const Twice& a, float b) {        \
    return {a.first op b, a.second op b};                     \
  }
SEGORIENT_TWICE(Twice, +)
SEGORIENT_TWICE(Twice, -)
SEGORIENT_TWICE(Twice, *)
SEGORIENT_TWICE(Twice, /)
SEGORIENT_TWICE(TwiceMask, <)
SEGORIENT_TWICE(TwiceMask, >)
SEGORIENT_TWICE(TwiceMask, >=)
#undef SEGORIENT_TWICE
inline Twice operator-(float a, const Twice& b) {
  return {a - b.first, a - b.second};
}
inline Twice operator*(float a, const Twice& b) {
  return {a * b.first, a * b.second};
}
inline Twice operator/(float a, const Twice& b) {
  return {a / b.first, a / b.second};
}
inline TwiceMask operator&(const TwiceMask& a, const TwiceMask& b) {
  return {a.first & b.first, a.second & b.second};
}
inline Twice select(const TwiceMask& condition, const Twice& yes, const Twice& no) {
  return {select(condition.first, yes.first, no.first),
          select(condition.second, yes.second, no.second)};
}
inline Twice larger(const Twice& a, const Twice& b) {
  return {larger(a.first, b.first), larger(a.second, b.second)};
}
inline Twice smaller(const Twice& a, const Twice& b) {
  return {smaller(a.first, b.first), smaller(a.second, b.second)};
}
inline Twice squareRoot(const Twice& a) {
  return {squareRoot(a.first), squareRoot(a.second)};
}

inline bool any(Mask m) {
#if SEGORIENT_LANES == 8
  return _mm256_movemask_ps(reinterpret_cast<__m256>(m)) != 0;
#elif defined(__SSE2__)
  return _mm_movemask_ps(reinterpret_cast<__m128>(m)) != 0;
#else
  return (m[0] | m[1] | m[2] | m[3]) != 0;
#endif
}

inline Lanes load(const float* p) {
  Lanes a;
  __builtin_memcpy(&a, p, sizeof(a));
  return a;
}
inline void store(float* p, Lanes a) {
  __builtin_memcpy(p, &a, sizeof(a));
}

inline Quad loadQuad(const float* p) {
  Quad q;
  __builtin_memcpy(&q, p, sizeof(q));
  return q;
}
inline void storeQuad(float* p, Quad q) {
  __builtin_memcpy(p, &q, sizeof(q));
}

/// x, y, z of one point a lane; p[l] points to 4 floats.
inline Lanes3 loadPoints(const float* const* p) {
#if SEGORIENT_LANES == 8
  typedef float Pair __attribute__((vector_size(32)));
  const auto pair = [](const float* low, const float* high) __attribute__((always_inline)) {
    return static_cast<Pair>(
        __builtin_shufflevector(loadQuad(low), loadQuad(high), 0, 1, 2, 3, 4, 5, 6, 7));
  };
  const Pair a = pair(p[0], p[4]);
  const Pair b = pair(p[1], p[5]);
  const Pair c = pair(p[2], p[6]);
  const Pair d = pair(p[3], p[7]);
  const Pair ab = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  const Pair cd = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const Pair ab_z = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  const Pair cd_z = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  return {__builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(ab_z, cd_z, 0, 1, 8, 9, 4, 5, 12, 13)};
#else
  const Quad a = loadQuad(p[0]);
  const Quad b = loadQuad(p[1]);
  const Quad c = loadQuad(p[2]);
  const Quad d = loadQuad(p[3]);
  const Quad ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Quad cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Quad ab_z = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Quad cd_z = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  return {__builtin_shufflevector(ab, cd, 0, 1, 4, 5), __builtin_shufflevector(ab, cd, 2, 3, 6, 7),
          __builtin_shufflevector(ab_z, cd_z, 0, 1, 4, 5)};
#endif
}

template <typename V>
inline V dot(const Vector3<V>& a, const Vector3<V>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename V>
inline Vector3<V> cross(const Vector3<V>& a, const Vector3<V>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename V>
inline Vector3<V> sum(const Vector3<V>& a, const Vector3<V>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename V>
inline Vector3<V> difference(const Vector3<V>& a, const Vector3<V>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename V>
inline Vector3<V> scaled(const Vector3<V>& a, V s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <typename M, typename V>
inline Vector3<V> select(M condition, const Vector3<V>& yes, const Vector3<V>& no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y),
          select(condition, yes.z, no.z)};
}
template <typename V>
inline Vector3<V> unit(const Vector3<V>& a) {
  return scaled(a, 1.0F / squareRoot(dot(a, a)));
}

/// Orthonormal vectors that with n are a right-handed frame (Duff et al., Building an orthonormal
/// basis, revisited, JCGT 2017).
struct Frame {
  Lanes3 u, v, n;
};
inline Frame frameOf(const Lanes3& n) {
  const Lanes sign = select(n.z < 0.0F, all(-1.0F), all(1.0F));
  const Lanes a = -1.0F / (sign + n.z);
  const Lanes b = n.x * n.y * a;
  return {{1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}
