// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <cstddef>
#include <functional>

namespace segorient {

/// Number of threads to use for a request: 0 means all cores that OpenMP reports, less than 0 is 1,
/// more than 64 as many as there are processors, at least 64.
/// No result of this library depends on it.
SEGORIENT_SEARCH_EXPORT int resolveThreads(int requested);

/// The same where it is known how much there is to do: 0 then means no more threads than the work
/// is worth. To wait for one more thread takes up to a time slice of the system where other
/// programs work, so each has to save more than that. \param items how many times something is done
/// \param nanoseconds about how long that takes one thread each time
SEGORIENT_SEARCH_EXPORT int resolveThreads(int requested, std::size_t items, double nanoseconds);

/// Calls work() on each of some threads. None may throw.
SEGORIENT_SEARCH_EXPORT void onEachThread(int threads, const std::function<void()>& work);

}  // namespace segorient
