// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// One number at a time: for machines without the instructions below, and to compare those with.

constexpr const char* kName = "scalar";
constexpr std::uint32_t kWidth = 1;
using Vector = float;

inline Vector load(const float* p) {
  return *p;
}
inline void store(Vector v, float* p) {
  *p = v;
}
inline Vector broadcast(float v) {
  return v;
}
inline Vector largestOf(Vector a, Vector b) {
  return a > b ? a : b;
}
inline unsigned int lessMask(Vector a, Vector b) {
  return a < b ? 1U : 0U;
}
inline void compress(Vector v, unsigned int /*mask*/, float* out) {
  *out = v;
}
inline std::size_t compressIds(const std::uint32_t* ids, unsigned int mask, std::uint32_t* out) {
  *out = *ids;
  return mask;
}
inline Vector smallestOf(Vector a, Vector b) {
  return a < b ? a : b;
}
inline float squareRoot(float v) {
  return std::sqrt(v);
}
inline Vector truncate(Vector v) {
  return static_cast<float>(static_cast<int>(v));
}
inline Vector counting() {
  return 0.0F;
}
// `yes` where a < b, otherwise `no`.
inline Vector selectLess(Vector a, Vector b, Vector yes, Vector no) {
  return a < b ? yes : no;
}
inline void storeInts(Vector v, int* p) {
  *p = static_cast<int>(v);
}

using Quad = SEGORIENT_VECTOR(float, 4);

inline Quad loadQuad(const float* p) {
  Quad q;
  copyBytes(&q, p, sizeof(q));
  return q;
}
inline void storeQuad(Quad q, float* p) {
  copyBytes(p, &q, sizeof(q));
}
inline void storeInts(Quad q, int* p) {
  for (int i = 0; i < 4; ++i) p[i] = static_cast<int>(q[i]);
}
inline Quad largestOf(Quad a, Quad b) {
  for (int i = 0; i < 4; ++i) a[i] = a[i] > b[i] ? a[i] : b[i];
  return a;
}
inline Quad smallestOf(Quad a, Quad b) {
  for (int i = 0; i < 4; ++i) a[i] = a[i] < b[i] ? a[i] : b[i];
  return a;
}

struct Keys {
  std::uint64_t lane[4];
};

inline Keys packKeys(const float* distance, const std::uint32_t* id) {
  Keys keys;
  for (std::size_t i = 0; i < 4; ++i) {
    std::uint32_t bits;
    copyBytes(&bits, distance + i, 4);
    keys.lane[i] = std::uint64_t{bits} << 32U | id[i];
  }
  return keys;
}
inline void unpackKeys(const Keys& keys, float* distance, std::uint32_t* id) {
  for (std::size_t i = 0; i < 4; ++i) {
    const auto bits = static_cast<std::uint32_t>(keys.lane[i] >> 32U);
    copyBytes(distance + i, &bits, 4);
    id[i] = static_cast<std::uint32_t>(keys.lane[i]);
  }
}
inline Keys minOf(const Keys& a, const Keys& b) {
  Keys out;
  for (std::size_t i = 0; i < 4; ++i) out.lane[i] = a.lane[i] < b.lane[i] ? a.lane[i] : b.lane[i];
  return out;
}
inline Keys maxOf(const Keys& a, const Keys& b) {
  Keys out;
  for (std::size_t i = 0; i < 4; ++i) out.lane[i] = a.lane[i] < b.lane[i] ? b.lane[i] : a.lane[i];
  return out;
}
inline Keys swapPairs(const Keys& a) {
  return {{a.lane[1], a.lane[0], a.lane[3], a.lane[2]}};
}
inline Keys reverse(const Keys& a) {
  return {{a.lane[3], a.lane[2], a.lane[1], a.lane[0]}};
}
inline Keys swapHalves(const Keys& a) {
  return {{a.lane[2], a.lane[3], a.lane[0], a.lane[1]}};
}
inline Keys evenOdd(const Keys& even, const Keys& odd) {
  return {{even.lane[0], odd.lane[1], even.lane[2], odd.lane[3]}};
}
inline Keys lowHigh(const Keys& low, const Keys& high) {
  return {{low.lane[0], low.lane[1], high.lane[2], high.lane[3]}};
}
inline void transpose(Keys (&k)[4]) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::uint64_t other = k[i].lane[j];
      k[i].lane[j] = k[j].lane[i];
      k[j].lane[i] = other;
    }
  }
}
