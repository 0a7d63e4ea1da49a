// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

namespace segorient {

/// What vector instructions are used; results do not depend on it.
enum class InstructionSet { Scalar, Sse2, Avx2 };

/// The best one that this machine has, or the one that the environment variable SEGORIENT_SIMD
/// names (scalar, sse2, avx2) if it has that.
InstructionSet instructionSet();

}  // namespace segorient
