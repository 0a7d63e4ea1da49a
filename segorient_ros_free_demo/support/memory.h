// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <istream>
#include <string>

namespace segorient::program {

/// Bytes that this process can still get without swapping, as /proc/meminfo says and the limits of
/// its control group and its own (ulimit -v) allow; the largest number where none is known.
std::size_t availableMemory();

/// MemAvailable of a /proc/meminfo in bytes; the largest number where it has none.
std::size_t availableIn(std::istream& meminfo);

/// Throws FileError about `file` if `needed` bytes are more than `available`.
void requireMemory(const std::string& file, std::size_t needed, std::size_t available);

}  // namespace segorient::program
