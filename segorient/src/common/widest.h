// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "common/compiler.h"
#include "common/instruction_set.h"

/// A pointer to one of the functions of this name that each_width.inl made: the one for the widest
/// registers of the machine.
#if SEGORIENT_X86
#define SEGORIENT_WIDEST(name) segorient::widestOf(&portable::name, &avx2::name, &avx512::name)
#else
#define SEGORIENT_WIDEST(name) (&portable::name)
#endif

namespace segorient {

template <typename Function>
Function* widestOf(Function* portable, Function* avx2, Function* avx512) {
  if (instructionSet() >= InstructionSet::Avx512) return avx512;
  return instructionSet() >= InstructionSet::Avx2 ? avx2 : portable;
}

}  // namespace segorient
