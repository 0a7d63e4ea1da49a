// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What compilers have beyond the standard, under one name each. Where a compiler lacks it, the name
// means the same by plain C++, or nothing where only speed is lost. No other file of the library
// (but prefetch.h, for headers that need no more than that) names a compiler's own functions,
// attributes or pragmas.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "common/prefetch.h"

#if defined(__GNUC__) || defined(__clang__)
#define SEGORIENT_GNU_COMPILER 1
#else
#define SEGORIENT_GNU_COMPILER 0
#endif

// Whether kernels are compiled for x86's wider instructions as well, to choose from at run time.
#if SEGORIENT_GNU_COMPILER && defined(__x86_64__) && !defined(SEGORIENT_PLAIN_VECTORS)
#define SEGORIENT_X86 1
#else
#define SEGORIENT_X86 0
#endif

#if SEGORIENT_X86
#include <immintrin.h>
#endif

// Whether SSE2 is there whatever the machine.
#if SEGORIENT_GNU_COMPILER && defined(__SSE2__) && !defined(SEGORIENT_PLAIN_VECTORS)
#include <emmintrin.h>
#define SEGORIENT_SSE2 1
#else
#define SEGORIENT_SSE2 0
#endif

#if defined(_MSC_VER) && !defined(__clang__)
#include <intrin.h>
#endif

// Functions that are always, and that are never, made part of their callers. SEGORIENT_INLINED goes
// behind the parameters of a lambda.
#if SEGORIENT_GNU_COMPILER
#define SEGORIENT_INLINE inline __attribute__((always_inline))
#define SEGORIENT_INLINED __attribute__((always_inline))
#define SEGORIENT_APART __attribute__((noinline))
#elif defined(_MSC_VER)
#define SEGORIENT_INLINE __forceinline
#define SEGORIENT_INLINED
#define SEGORIENT_APART __declspec(noinline)
#else
#define SEGORIENT_INLINE inline
#define SEGORIENT_INLINED
#define SEGORIENT_APART
#endif

// Before a loop over an array that is to be in registers, at any level of optimisation.
#if defined(__clang__)
#define SEGORIENT_UNROLL _Pragma("clang loop unroll(full)")
#elif SEGORIENT_GNU_COMPILER
#define SEGORIENT_UNROLL _Pragma("GCC unroll 16")
#else
#define SEGORIENT_UNROLL
#endif

// Around code that may use certain of x86's instructions, such as "avx2,popcnt".
#define SEGORIENT_PRAGMA(text) _Pragma(#text)
#if defined(__clang__)
#define SEGORIENT_TARGET_BEGIN(names) \
  SEGORIENT_PRAGMA(clang attribute push(__attribute__((target(names))), apply_to = function))
#define SEGORIENT_TARGET_END SEGORIENT_PRAGMA(clang attribute pop)
#elif SEGORIENT_GNU_COMPILER
#define SEGORIENT_TARGET_BEGIN(names) \
  SEGORIENT_PRAGMA(GCC push_options) SEGORIENT_PRAGMA(GCC target(names))
#define SEGORIENT_TARGET_END SEGORIENT_PRAGMA(GCC pop_options)
#endif

namespace segorient {

/// prefetch() where something is to be written.
SEGORIENT_INLINE void prefetchToWrite(const void* address) {
#if SEGORIENT_GNU_COMPILER
  __builtin_prefetch(address, 1);
#else
  (void)address;
#endif
}

/// How many bits are set.
SEGORIENT_INLINE int countBits(std::uint32_t bits) {
  bits -= bits >> 1 & 0x55555555U;
  bits = (bits & 0x33333333U) + (bits >> 2 & 0x33333333U);
  return static_cast<int>(((bits + (bits >> 4)) & 0x0f0f0f0fU) * 0x01010101U >> 24);
}

/// Number of the lowest bit that is set. \param bits not 0
SEGORIENT_INLINE unsigned int lowestBit(std::uint32_t bits) {
#if SEGORIENT_GNU_COMPILER
  return static_cast<unsigned int>(__builtin_ctz(bits));
#elif defined(_MSC_VER)
  unsigned long at = 0;
  _BitScanForward(&at, bits);
  return static_cast<unsigned int>(at);
#else
  unsigned int at = 0;
  while ((bits & 1U) == 0) bits >>= 1U, ++at;
  return at;
#endif
}

/// memcpy() of few bytes, a number of them that the compiler knows: becomes a load or a store also
/// where nothing else is optimised.
SEGORIENT_INLINE void copyBytes(void* to, const void* from, std::size_t bytes) {
#if SEGORIENT_GNU_COMPILER
  __builtin_memcpy(to, from, bytes);
#else
  std::memcpy(to, from, bytes);
#endif
}

#if SEGORIENT_X86
/// What the machine has; AVX-512 stands for its F and VL parts.
inline bool hasAvx2() {
  return __builtin_cpu_supports("avx2") != 0;
}
inline bool hasAvx512() {
  return hasAvx2() && __builtin_cpu_supports("avx512f") != 0 &&
         __builtin_cpu_supports("avx512vl") != 0;
}
#endif

}  // namespace segorient
