// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/instruction_set.h>

#include <cstdlib>
#include <cstring>

namespace segorient {

InstructionSet instructionSet() {
  const char* wanted = std::getenv("SEGORIENT_SIMD");
  const auto is = [&](const char* name) {
    return wanted != nullptr && std::strcmp(wanted, name) == 0;
  };
  if (is("scalar")) return InstructionSet::Scalar;
#if defined(__x86_64__)
  if (!is("sse2") && __builtin_cpu_supports("avx2") != 0) return InstructionSet::Avx2;
  return InstructionSet::Sse2;
#else
  return InstructionSet::Scalar;
#endif
}

}  // namespace segorient
