// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// One source file for all instruction sets, compiled without -m flags: the code for each is between
// pragmas, and the one to run is chosen when the program runs. The kernels themselves are written
// once, in the .inl files, for any width of vector. They call nothing of the standard library: an
// inline function compiled for one instruction set could otherwise be linked into code that runs on
// machines without it.
#include "search/kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "common/compiler.h"
#include "common/instruction_set.h"
#include "common/vectors.h"

namespace segorient::search {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLargest = std::numeric_limits<float>::max();

// Sorted keys are compared as doubles, which no sum of a float's bits and this is a special one of.
constexpr std::uint32_t kKeyBias = 0x00100000U;

namespace scalar {
#include "search/simd_scalar.inl"

#include "search/kernels_ranges.inl"

#include "search/kernels_take.inl"

#include "search/kernels_one.inl"
}  // namespace scalar

#if SEGORIENT_X86

namespace sse2 {
#include "search/simd_sse2.inl"

#include "search/kernels_ranges.inl"

#include "search/kernels_take_listed.inl"

#include "search/kernels_one.inl"
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

SEGORIENT_TARGET_BEGIN("avx2,popcnt")

namespace avx2 {
#include "search/simd_avx2.inl"

#include "search/kernels_ranges.inl"

#include "search/kernels_take.inl"

#include "search/kernels_one.inl"
}  // namespace avx2

SEGORIENT_TARGET_END
SEGORIENT_TARGET_BEGIN("avx512f,avx512vl,popcnt")

namespace avx512 {
#include "search/simd_avx512.inl"

#include "search/kernels_ranges.inl"

#include "search/kernels_take.inl"

#include "search/kernels_one.inl"
}  // namespace avx512

SEGORIENT_TARGET_END

#endif  // SEGORIENT_X86

}  // namespace

const Kernels& chooseKernels() {
  switch (instructionSet()) {
#if SEGORIENT_X86
    case InstructionSet::Avx512:
      return avx512::kKernels;
    case InstructionSet::Avx2:
      return avx2::kKernels;
    case InstructionSet::Sse2:
      return sse2::kKernels;
#endif
    default:
      return scalar::kKernels;
  }
}

namespace {

// Distances are not negative, so that their bits are in their order.
std::vector<std::uint64_t> keysOf(const float* distance, const std::uint32_t* id,
                                  std::size_t count) {
  std::vector<std::uint64_t> keys(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, distance + i, sizeof(bits));
    keys[i] = std::uint64_t{bits} << 32U | id[i];
  }
  return keys;
}

void fromKeys(const std::vector<std::uint64_t>& keys, std::size_t count, float* distance,
              std::uint32_t* id) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = static_cast<std::uint32_t>(keys[i] >> 32U);
    std::memcpy(distance + i, &bits, sizeof(bits));
    id[i] = static_cast<std::uint32_t>(keys[i]);
  }
}

}  // namespace

void sortMany(const float* distance, const std::uint32_t* id, std::size_t count,
              float* out_distance, std::uint32_t* out_id) {
  std::vector<std::uint64_t> keys = keysOf(distance, id, count);
  std::sort(keys.begin(), keys.end());
  fromKeys(keys, count, out_distance, out_id);
}

void keepNearest(float* distance, std::uint32_t* id, std::size_t count, std::size_t k) {
  std::vector<std::uint64_t> keys = keysOf(distance, id, count);
  std::nth_element(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(k), keys.end());
  fromKeys(keys, k, distance, id);
}

}  // namespace segorient::search
