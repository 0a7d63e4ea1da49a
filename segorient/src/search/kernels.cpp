// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// One source file for all instruction sets, compiled without -m flags: the code for each is between
// pragmas, and the one to run is chosen when the program runs.
#include "kernels.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define SEGORIENT_X86 1
#include <immintrin.h>
#else
#define SEGORIENT_X86 0
#include <cmath>
#endif

namespace segorient::search {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Plain loops: for other machines, and to compare the others with.
namespace scalar {

constexpr std::uint32_t kWidth = 1;
using Vector = float;
using Counter = std::uint32_t;

inline Vector load(const float* p) {
  return *p;
}
inline void store(float* p, Vector v) {
  *p = v;
}
inline void store(std::uint32_t* p, Counter c) {
  *p = c;
}
inline Vector broadcast(float v) {
  return v;
}
inline Vector add(Vector a, Vector b) {
  return a + b;
}
inline Vector sub(Vector a, Vector b) {
  return a - b;
}
inline Vector mul(Vector a, Vector b) {
  return a * b;
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
inline Counter zeroCounter() {
  return 0;
}
inline Counter countLess(Counter c, Vector a, Vector b) {
  return c + (a < b ? 1U : 0U);
}
inline Counter addCounters(Counter a, Counter b) {
  return a + b;
}
inline void interleave(const float* d, const std::uint32_t* id, std::uint32_t* out) {
  __builtin_memcpy(out, d, 4);
  out[1] = *id;
}
inline void deinterleave(const std::uint32_t* in, float* d, std::uint32_t* id) {
  __builtin_memcpy(d, in, 4);
  *id = in[1];
}
inline std::size_t total(Counter c) {
  return c;
}
#if SEGORIENT_X86
inline float squareRoot(float v) {
  return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(v)));
}
#else
inline float squareRoot(float v) {
  return std::sqrt(v);
}
#endif
inline void prefetchForWrite(const void* p) {
  __builtin_prefetch(p, 1);
}

#include "kernels.inl"
#include "kernels_all_points.inl"

constexpr Kernels kKernels{"scalar", collect, collectRegion, sortNearest, allInRegion};

}  // namespace scalar

#if SEGORIENT_X86

/// Every x86-64 machine has it. There is no shuffle by a variable, hence the plain stores.
namespace sse2 {

constexpr std::uint32_t kWidth = 4;
using Vector = __m128;
using Counter = __m128i;

inline Vector load(const float* p) {
  return _mm_loadu_ps(p);
}
inline void store(float* p, Vector v) {
  _mm_storeu_ps(p, v);
}
inline void store(std::uint32_t* p, Counter c) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(p), c);
}
inline Vector broadcast(float v) {
  return _mm_set1_ps(v);
}
inline Vector add(Vector a, Vector b) {
  return _mm_add_ps(a, b);
}
inline Vector sub(Vector a, Vector b) {
  return _mm_sub_ps(a, b);
}
inline Vector mul(Vector a, Vector b) {
  return _mm_mul_ps(a, b);
}
inline Vector largestOf(Vector a, Vector b) {
  return _mm_max_ps(a, b);
}
inline unsigned int lessMask(Vector a, Vector b) {
  return static_cast<unsigned int>(_mm_movemask_ps(_mm_cmplt_ps(a, b)));
}
inline void compress(Vector v, unsigned int mask, float* out) {
  if (mask == 0) return;
  float lanes[4];
  _mm_storeu_ps(lanes, v);
  std::size_t n = 0;
  for (unsigned int lane = 0; lane < 4; ++lane) {
    out[n] = lanes[lane];
    n += (mask >> lane) & 1U;
  }
}
inline std::size_t compressIds(const std::uint32_t* ids, unsigned int mask, std::uint32_t* out) {
  if (mask == 0) return 0;
  std::size_t n = 0;
  for (unsigned int lane = 0; lane < 4; ++lane) {
    out[n] = ids[lane];
    n += (mask >> lane) & 1U;
  }
  return n;
}
inline Counter zeroCounter() {
  return _mm_setzero_si128();
}
inline Counter countLess(Counter c, Vector a, Vector b) {
  return _mm_sub_epi32(c, _mm_castps_si128(_mm_cmplt_ps(a, b)));
}
inline Counter addCounters(Counter a, Counter b) {
  return _mm_add_epi32(a, b);
}
inline void interleave(const float* d, const std::uint32_t* id, std::uint32_t* out) {
  const __m128 a = _mm_loadu_ps(d);
  const __m128 b = _mm_loadu_ps(reinterpret_cast<const float*>(id));
  _mm_storeu_ps(reinterpret_cast<float*>(out), _mm_unpacklo_ps(a, b));
  _mm_storeu_ps(reinterpret_cast<float*>(out + 4), _mm_unpackhi_ps(a, b));
}
inline void deinterleave(const std::uint32_t* in, float* d, std::uint32_t* id) {
  const __m128 a = _mm_loadu_ps(reinterpret_cast<const float*>(in));
  const __m128 b = _mm_loadu_ps(reinterpret_cast<const float*>(in + 4));
  _mm_storeu_ps(d, _mm_shuffle_ps(a, b, 0x88));
  _mm_storeu_ps(reinterpret_cast<float*>(id), _mm_shuffle_ps(a, b, 0xdd));
}
inline std::size_t total(Counter c) {
  c = _mm_add_epi32(c, _mm_shuffle_epi32(c, 0x4e));
  c = _mm_add_epi32(c, _mm_shuffle_epi32(c, 0xb1));
  return static_cast<std::size_t>(static_cast<unsigned int>(_mm_cvtsi128_si32(c)));
}
inline float squareRoot(float v) {
  return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(v)));
}
inline void prefetchForWrite(const void* p) {
  __builtin_prefetch(p, 1);
}

#include "kernels.inl"
#include "kernels_all_points.inl"

constexpr Kernels kKernels{"sse2", collect, collectRegion, sortNearest, allInRegion};

}  // namespace sse2

/// For each mask of eight lanes the lanes that are set, in a byte each.
struct LaneTable {
  std::uint64_t lanes[256];
  constexpr LaneTable() : lanes() {
    for (unsigned int mask = 0; mask < 256; ++mask) {
      std::uint64_t entry = 0;
      unsigned int n = 0;
      for (std::uint64_t lane = 0; lane < 8; ++lane) {
        if ((mask >> lane) & 1U) entry |= lane << (8 * n++);
      }
      lanes[mask] = entry;
    }
  }
};
constexpr LaneTable kLanes;

#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,popcnt"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,popcnt")
#endif

namespace avx2 {

constexpr std::uint32_t kWidth = 8;
using Vector = __m256;
using Counter = __m256i;

inline Vector load(const float* p) {
  return _mm256_loadu_ps(p);
}
inline void store(float* p, Vector v) {
  _mm256_storeu_ps(p, v);
}
inline void store(std::uint32_t* p, Counter c) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), c);
}
inline Vector broadcast(float v) {
  return _mm256_set1_ps(v);
}
inline Vector add(Vector a, Vector b) {
  return _mm256_add_ps(a, b);
}
inline Vector sub(Vector a, Vector b) {
  return _mm256_sub_ps(a, b);
}
inline Vector mul(Vector a, Vector b) {
  return _mm256_mul_ps(a, b);
}
inline Vector largestOf(Vector a, Vector b) {
  return _mm256_max_ps(a, b);
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
inline Counter zeroCounter() {
  return _mm256_setzero_si256();
}
inline Counter countLess(Counter c, Vector a, Vector b) {
  return _mm256_sub_epi32(c, _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
}
inline Counter addCounters(Counter a, Counter b) {
  return _mm256_add_epi32(a, b);
}
inline void interleave(const float* d, const std::uint32_t* id, std::uint32_t* out) {
  const __m256 a = _mm256_loadu_ps(d);
  const __m256 b = _mm256_loadu_ps(reinterpret_cast<const float*>(id));
  const __m256 low = _mm256_unpacklo_ps(a, b);
  const __m256 high = _mm256_unpackhi_ps(a, b);
  _mm256_storeu_ps(reinterpret_cast<float*>(out), _mm256_permute2f128_ps(low, high, 0x20));
  _mm256_storeu_ps(reinterpret_cast<float*>(out + 8), _mm256_permute2f128_ps(low, high, 0x31));
}
inline __m256 inOrder(__m256 v) {
  return _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(v), 0xd8));
}
inline void deinterleave(const std::uint32_t* in, float* d, std::uint32_t* id) {
  const __m256 a = _mm256_loadu_ps(reinterpret_cast<const float*>(in));
  const __m256 b = _mm256_loadu_ps(reinterpret_cast<const float*>(in + 8));
  _mm256_storeu_ps(d, inOrder(_mm256_shuffle_ps(a, b, 0x88)));
  _mm256_storeu_ps(reinterpret_cast<float*>(id), inOrder(_mm256_shuffle_ps(a, b, 0xdd)));
}
inline std::size_t total(Counter c) {
  __m128i s = _mm_add_epi32(_mm256_castsi256_si128(c), _mm256_extracti128_si256(c, 1));
  s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4e));
  s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0xb1));
  return static_cast<std::size_t>(static_cast<unsigned int>(_mm_cvtsi128_si32(s)));
}
inline float squareRoot(float v) {
  return _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(v)));
}
inline void prefetchForWrite(const void* p) {
  __builtin_prefetch(p, 1);
}

#include "kernels.inl"
#include "kernels_all_points.inl"

constexpr Kernels kKernels{"avx2", collect, collectRegion, sortNearest, allInRegion};

}  // namespace avx2

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#endif  // SEGORIENT_X86

}  // namespace

const Kernels& chooseKernels() {
  const char* wanted = std::getenv("SEGORIENT_SIMD");
  const auto is = [&](const char* name) {
    return wanted != nullptr && std::strcmp(wanted, name) == 0;
  };
  if (is("scalar")) return scalar::kKernels;
#if SEGORIENT_X86
  if (!is("sse2") && __builtin_cpu_supports("avx2") != 0) return avx2::kKernels;
  return sse2::kKernels;
#else
  return scalar::kKernels;
#endif
}

void sortIds(std::uint32_t* ids, std::size_t count) {
  std::sort(ids, ids + count);
}

void sortPairs(float* distances, std::uint32_t* ids, std::size_t count) {
  std::vector<std::pair<float, std::uint32_t>> pairs(count);
  for (std::size_t i = 0; i < count; ++i) pairs[i] = {distances[i], ids[i]};
  std::sort(pairs.begin(), pairs.end());
  for (std::size_t i = 0; i < count; ++i) {
    distances[i] = pairs[i].first;
    ids[i] = pairs[i].second;
  }
}

}  // namespace segorient::search
