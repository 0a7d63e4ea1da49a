// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// One float of each of several points, side by side in a vector register. Included once per
// instruction set, with SEGORIENT_LANES set to 4, 8 or 16; all arithmetic is per lane and rounded
// as scalar code would, so the results do not depend on the width.

constexpr std::size_t kWidth = SEGORIENT_LANES;

using Lanes = SEGORIENT_VECTOR(float, SEGORIENT_LANES);
using Mask = SEGORIENT_VECTOR(std::int32_t, SEGORIENT_LANES);
using Quad = SEGORIENT_VECTOR(float, 4);

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

inline Twice3 both(const Lanes3& a, const Lanes3& b) {
  return {{a.x, b.x}, {a.y, b.y}, {a.z, b.z}};
}
inline Lanes3 firstOf(const Twice3& a) {
  return {a.x.first, a.y.first, a.z.first};
}
inline Lanes3 secondOf(const Twice3& a) {
  return {a.x.second, a.y.second, a.z.second};
}

inline Lanes all(float value) {
  return Lanes{} + value;
}
inline Lanes select(Mask condition, Lanes yes, Lanes no) {
  return SEGORIENT_CHOSEN(condition, yes, no);
}
// The second one where they are equal or not numbers.
inline Lanes larger(Lanes a, Lanes b) {
#if SEGORIENT_LANES == 16
  return SEGORIENT_BITS_AS(
      Lanes, _mm512_maskz_max_ps(0xffff, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
#else
  return SEGORIENT_CHOSEN(a > b, a, b);
#endif
}
inline Lanes smaller(Lanes a, Lanes b) {
#if SEGORIENT_LANES == 16
  return SEGORIENT_BITS_AS(
      Lanes, _mm512_maskz_min_ps(0xffff, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
#else
  return SEGORIENT_CHOSEN(a < b, a, b);
#endif
}
inline Lanes absolute(Lanes a) {
  return SEGORIENT_BITS_AS(Lanes, SEGORIENT_BITS_AS(Mask, a) & 0x7fffffff);
}

inline Lanes squareRoot(Lanes a) {
#if SEGORIENT_LANES == 16
  return SEGORIENT_BITS_AS(Lanes, _mm512_maskz_sqrt_ps(0xffff, reinterpret_cast<__m512>(a)));
#elif SEGORIENT_LANES == 8
  return SEGORIENT_BITS_AS(Lanes, _mm256_sqrt_ps(reinterpret_cast<__m256>(a)));
#elif SEGORIENT_SSE2
  return SEGORIENT_BITS_AS(Lanes, _mm_sqrt_ps(reinterpret_cast<__m128>(a)));
#else
  for (std::size_t l = 0; l < kWidth; ++l) a[l] = std::sqrt(a[l]);
  return a;
#endif
}

// Operators cannot stand in parentheses.
// NOLINTBEGIN(bugprone-macro-parentheses)
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
SEGORIENT_TWICE(TwiceMask, ==)
SEGORIENT_TWICE(TwiceMask, !=)
#undef SEGORIENT_TWICE
// NOLINTEND(bugprone-macro-parentheses)
inline Twice operator+(float a, const Twice& b) {
  return {a + b.first, a + b.second};
}
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
inline TwiceMask operator|(const TwiceMask& a, const TwiceMask& b) {
  return {a.first | b.first, a.second | b.second};
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
#if SEGORIENT_LANES == 16
  return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(m), reinterpret_cast<__m512i>(m)) != 0;
#elif SEGORIENT_LANES == 8
  return _mm256_movemask_ps(reinterpret_cast<__m256>(m)) != 0;
#elif SEGORIENT_SSE2
  return _mm_movemask_ps(reinterpret_cast<__m128>(m)) != 0;
#else
  return (m[0] | m[1] | m[2] | m[3]) != 0;
#endif
}

inline Lanes load(const float* p) {
  Lanes a;
  copyBytes(&a, p, sizeof(a));
  return a;
}
inline void store(float* p, Lanes a) {
  copyBytes(p, &a, sizeof(a));
}

inline bool any(const TwiceMask& m) {
  return any(m.first | m.second);
}
inline Twice loadTwice(const float* p) {
  return {load(p), load(p + kWidth)};
}
inline void store(float* p, const Twice& a) {
  store(p, a.first);
  store(p + kWidth, a.second);
}

inline Quad loadQuad(const float* p) {
  Quad q;
  copyBytes(&q, p, sizeof(q));
  return q;
}
inline void storeQuad(float* p, Quad q) {
  copyBytes(p, &q, sizeof(q));
}

/// x, y, z of one point a lane; p[l] points to 4 floats. \param fourth gets the last of these
inline Lanes3 loadRows(const float* const* p, Lanes& fourth) {
#if SEGORIENT_LANES == 16
  const auto four = [p](int first) SEGORIENT_INLINED {
    const __m512 one = _mm512_castps128_ps512(_mm_loadu_ps(p[first]));
    const __m512 two = _mm512_maskz_insertf32x4(0xffff, one, _mm_loadu_ps(p[first + 4]), 1);
    const __m512 three = _mm512_maskz_insertf32x4(0xffff, two, _mm_loadu_ps(p[first + 8]), 2);
    return _mm512_maskz_insertf32x4(0xffff, three, _mm_loadu_ps(p[first + 12]), 3);
  };
  const __m512 a = four(0);
  const __m512 b = four(1);
  const __m512 c = four(2);
  const __m512 d = four(3);
  const __m512 ab = _mm512_maskz_unpacklo_ps(0xffff, a, b);
  const __m512 cd = _mm512_maskz_unpacklo_ps(0xffff, c, d);
  const __m512 ab_z = _mm512_maskz_unpackhi_ps(0xffff, a, b);
  const __m512 cd_z = _mm512_maskz_unpackhi_ps(0xffff, c, d);
  fourth = SEGORIENT_BITS_AS(Lanes, _mm512_maskz_shuffle_ps(0xffff, ab_z, cd_z, 0xee));
  return {SEGORIENT_BITS_AS(Lanes, _mm512_maskz_shuffle_ps(0xffff, ab, cd, 0x44)),
          SEGORIENT_BITS_AS(Lanes, _mm512_maskz_shuffle_ps(0xffff, ab, cd, 0xee)),
          SEGORIENT_BITS_AS(Lanes, _mm512_maskz_shuffle_ps(0xffff, ab_z, cd_z, 0x44))};
#elif SEGORIENT_LANES == 8
  using Pair = SEGORIENT_VECTOR(float, 8);
  const auto pair = [](const float* low, const float* high) SEGORIENT_INLINED {
    return static_cast<Pair>(
        SEGORIENT_SHUFFLED(loadQuad(low), loadQuad(high), 0, 1, 2, 3, 4, 5, 6, 7));
  };
  const Pair a = pair(p[0], p[4]);
  const Pair b = pair(p[1], p[5]);
  const Pair c = pair(p[2], p[6]);
  const Pair d = pair(p[3], p[7]);
  const Pair ab = SEGORIENT_SHUFFLED(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  const Pair cd = SEGORIENT_SHUFFLED(c, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const Pair ab_z = SEGORIENT_SHUFFLED(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  const Pair cd_z = SEGORIENT_SHUFFLED(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  fourth = SEGORIENT_SHUFFLED(ab_z, cd_z, 2, 3, 10, 11, 6, 7, 14, 15);
  return {SEGORIENT_SHUFFLED(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13),
          SEGORIENT_SHUFFLED(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15),
          SEGORIENT_SHUFFLED(ab_z, cd_z, 0, 1, 8, 9, 4, 5, 12, 13)};
#else
  const Quad a = loadQuad(p[0]);
  const Quad b = loadQuad(p[1]);
  const Quad c = loadQuad(p[2]);
  const Quad d = loadQuad(p[3]);
  const Quad ab = SEGORIENT_SHUFFLED(a, b, 0, 4, 1, 5);
  const Quad cd = SEGORIENT_SHUFFLED(c, d, 0, 4, 1, 5);
  const Quad ab_z = SEGORIENT_SHUFFLED(a, b, 2, 6, 3, 7);
  const Quad cd_z = SEGORIENT_SHUFFLED(c, d, 2, 6, 3, 7);
  fourth = SEGORIENT_SHUFFLED(ab_z, cd_z, 2, 3, 6, 7);
  return {SEGORIENT_SHUFFLED(ab, cd, 0, 1, 4, 5), SEGORIENT_SHUFFLED(ab, cd, 2, 3, 6, 7),
          SEGORIENT_SHUFFLED(ab_z, cd_z, 0, 1, 4, 5)};
#endif
}
inline Lanes3 loadPoints(const float* const* p) {
  Lanes unused;
  return loadRows(p, unused);
}

/// The inverse of loadRows().
inline void storePoints(float* const* p, const Lanes3& a, Lanes fourth) {
#if SEGORIENT_LANES == 16
  const auto x = reinterpret_cast<__m512>(a.x);
  const auto y = reinterpret_cast<__m512>(a.y);
  const auto z = reinterpret_cast<__m512>(a.z);
  const auto w = reinterpret_cast<__m512>(fourth);
  const __m512 xy = _mm512_maskz_unpacklo_ps(0xffff, x, y);
  const __m512 xy_high = _mm512_maskz_unpackhi_ps(0xffff, x, y);
  const __m512 zw = _mm512_maskz_unpacklo_ps(0xffff, z, w);
  const __m512 zw_high = _mm512_maskz_unpackhi_ps(0xffff, z, w);
  const __m512 points[4] = {_mm512_maskz_shuffle_ps(0xffff, xy, zw, 0x44),
                            _mm512_maskz_shuffle_ps(0xffff, xy, zw, 0xee),
                            _mm512_maskz_shuffle_ps(0xffff, xy_high, zw_high, 0x44),
                            _mm512_maskz_shuffle_ps(0xffff, xy_high, zw_high, 0xee)};
  for (int i = 0; i < 4; ++i) {
    const auto v = SEGORIENT_BITS_AS(Lanes, points[i]);
    storeQuad(p[i], SEGORIENT_SHUFFLED(v, v, 0, 1, 2, 3));
    storeQuad(p[4 + i], SEGORIENT_SHUFFLED(v, v, 4, 5, 6, 7));
    storeQuad(p[8 + i], SEGORIENT_SHUFFLED(v, v, 8, 9, 10, 11));
    storeQuad(p[12 + i], SEGORIENT_SHUFFLED(v, v, 12, 13, 14, 15));
  }
#else
  for (std::size_t l = 0; l < kWidth; ++l) {
    storeQuad(p[l], Quad{a.x[l], a.y[l], a.z[l], fourth[l]});
  }
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
template <typename V>
struct Frame {
  Vector3<V> u, v, n;
};
template <typename V>
inline Frame<V> frameOf(const Vector3<V>& n) {
  const V zero{};
  const V sign = select(n.z < 0.0F, zero - 1.0F, zero + 1.0F);
  const V a = -1.0F / (sign + n.z);
  const V b = n.x * n.y * a;
  return {{1.0F + sign * n.x * n.x * a, sign * b, zero - sign * n.x},
          {b, sign + n.y * n.y * a, zero - n.y},
          n};
}
