// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/instruction_set.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "common/compiler.h"

namespace segorient {

namespace {

InstructionSet best() {
#if SEGORIENT_X86
  if (hasAvx512()) return InstructionSet::Avx512;
  return hasAvx2() ? InstructionSet::Avx2 : InstructionSet::Sse2;
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
