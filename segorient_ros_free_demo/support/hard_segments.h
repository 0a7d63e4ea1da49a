// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace segorient::program {

/// Labels that a report of `orient` lists as hard to orient, ascending. Throws FileError if the
/// file cannot be read or is no such report.
std::vector<std::uint32_t> readHardSegments(const std::string& path);

}  // namespace segorient::program
