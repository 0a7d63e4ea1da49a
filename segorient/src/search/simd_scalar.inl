// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// One number at a time: for machines without the instructions below, and to compare those with.

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
inline float squareRoot(float v) {
  return __builtin_sqrtf(v);
}

struct Keys {
  std::uint64_t lane[4];
};

inline Keys packKeys(const float* distance, const std::uint32_t* id) {
  Keys keys;
  for (std::size_t i = 0; i < 4; ++i) {
    std::uint32_t bits;
    __builtin_memcpy(&bits, distance + i, 4);
    keys.lane[i] = std::uint64_t{bits} << 32U | id[i];
  }
  return keys;
}
inline void unpackKeys(const Keys& keys, float* distance, std::uint32_t* id) {
  for (std::size_t i = 0; i < 4; ++i) {
    const auto bits = static_cast<std::uint32_t>(keys.lane[i] >> 32U);
    __builtin_memcpy(distance + i, &bits, 4);
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
