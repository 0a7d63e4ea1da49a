// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/instruction_set.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace segorient {

namespace {

InstructionSet best() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") == 0) return InstructionSet::Sse2;
  const bool has512 =
      __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0;
  return has512 ? InstructionSet::Avx512 : InstructionSet::Avx2;
#else
  return InstructionSet::Scalar;
#endif
}

}  // namespace

InstructionSet instructionSet() {
  const char* wanted = std::getenv("SEGORIENT_SIMD");
  const auto is = [&](const char* name) {
    return wanted != nullptr && std::strcmp(wanted, name) == 0;
  };
  InstructionSet most = InstructionSet::Avx512;
  if (is("scalar")) most = InstructionSet::Scalar;
  if (is("sse2")) most = InstructionSet::Sse2;
  if (is("avx2")) most = InstructionSet::Avx2;
  return std::min(most, best());
}

}  // namespace segorient
