// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// For the inner loops that are compiled once per instruction set.
#pragma once

// For what has registers enough only if it is compiled on its own.
#define SEGORIENT_APART __attribute__((noinline))

// Before a loop over an array that is to be in registers, at any level of optimisation.
#if defined(__clang__)
#define SEGORIENT_UNROLL _Pragma("clang loop unroll(full)")
#else
#define SEGORIENT_UNROLL _Pragma("GCC unroll 16")
#endif
