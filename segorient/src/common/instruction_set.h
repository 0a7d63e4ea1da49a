// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

namespace segorient {

/// What vector instructions are used, from the least to the most; exact results do not depend on
/// it. Avx512 stands for its F and VL parts.
enum class InstructionSet { Scalar, Sse2, Avx2, Avx512 };

/// The best one that this machine has, or the one that the environment variable SEGORIENT_SIMD
/// names (scalar, sse2, avx2, avx512) if it has that.
SEGORIENT_SEARCH_EXPORT InstructionSet instructionSet();

}  // namespace segorient
