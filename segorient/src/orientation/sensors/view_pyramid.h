// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <array>
#include <vector>

#include "orientation/sensors/flat_points.h"

namespace segorient::detail {

/// Where sides of a camera's image meet.
struct Apex {
  std::array<float, 3> place{0.F, 0.F, 0.F};  ///< in the points' unit
  bool whole = false;                         ///< all four sides meet here
};

/// Places that one camera may have seen all points from: the sides of its image are planes through
/// it, which bound the cloud and cut through surfaces, at the angles of a rectangle's sides. They
/// meet in the camera, wherever the cloud was moved to and however it was thinned.
/// \return whole ones first, of either those that most planes meet in; few
SEGORIENT_ORIENTATION_EXPORT std::vector<Apex> findApexes(const FlatPoints& flat, int threads);

}  // namespace segorient::detail
