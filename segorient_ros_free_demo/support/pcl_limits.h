// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <limits>
#include <string>

#include "io/cloud_table.h"
#include "io/errors.h"

namespace segorient::program {

/// For commands that run PCL beside our own: its kd-tree adds and subtracts coordinates in floats,
/// and aborts where the result is none.
inline void requirePclRange(const LocalPoints& points, const std::string& path) {
  constexpr double kMost = std::numeric_limits<float>::max() / 4.F;
  if (std::max(points.extent(), points.reach()) > kMost) {
    throw FileError(path, "has coordinates too large for PCL's kd-tree, which runs beside ours");
  }
}

}  // namespace segorient::program
