// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>

namespace segorient {

/// How segments get their orientation relative to each other.
enum class OrientationMethod : std::uint8_t {
  AUTO,         ///< the best known
  PROPAGATION,  ///< spanning tree over the angles between segments (paper, 3.1)
  BOUNDARY,     ///< directions of the segments' boundaries (paper, 3.2.2)
  COMBINED,     ///< the tree, the boundaries where its angle is unreliable, extremal points for the
                ///< rest
  EXTREMAL,     ///< extremal points in the boxes of a subdivision of space (paper, 3.3)
  HOPPE         ///< without segments, for comparison: spanning tree over the angles between
                ///< neighbouring points (Hoppe et al. 1992, as the paper describes it in 3.1)
};

/// auto, propagation, boundary, combined, extremal or hoppe.
const char* toString(OrientationMethod method);

/// \return false, and `method` unchanged, for any other name
bool fromString(const std::string& name, OrientationMethod& method);

}  // namespace segorient
