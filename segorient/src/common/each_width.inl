// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Includes SEGORIENT_KERNELS once per instruction set, see lanes.inl: in namespaces portable, and
// where there are such machines, avx2 and avx512.

namespace portable {
namespace {
#define SEGORIENT_LANES 4
#include SEGORIENT_KERNELS
#undef SEGORIENT_LANES
}  // namespace
}  // namespace portable

#if SEGORIENT_X86
SEGORIENT_TARGET_BEGIN("avx2")
namespace avx2 {
namespace {
#define SEGORIENT_LANES 8
#include SEGORIENT_KERNELS
#undef SEGORIENT_LANES
}  // namespace
}  // namespace avx2
SEGORIENT_TARGET_END
SEGORIENT_TARGET_BEGIN("avx512f,avx512vl")
namespace avx512 {
namespace {
#define SEGORIENT_LANES 16
#include SEGORIENT_KERNELS
#undef SEGORIENT_LANES
}  // namespace
}  // namespace avx512
SEGORIENT_TARGET_END
#endif
