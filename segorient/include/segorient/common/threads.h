// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

namespace segorient {

/// Number of threads to use for a request: 0 means all cores that OpenMP reports, less than 0 is 1.
/// No result of this library depends on it.
int resolveThreads(int requested);

}  // namespace segorient
