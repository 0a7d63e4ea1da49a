// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <array>
#include <vector>

#include "orientation/sensors/flat_points.h"

namespace segorient::detail {

/// Places that one camera may have seen all points from: the sides of its image are planes through
/// it, which bound the cloud and cut through surfaces. Four of them meet in the camera, wherever
/// the cloud was moved to and however it was thinned. That is no evidence of a camera by itself:
/// tapered bodies have such planes, too.
/// \return in the points' unit, those that most planes meet in first; few
SEGORIENT_ORIENTATION_EXPORT std::vector<std::array<float, 3>> findApexes(const FlatPoints& flat,
                                                                          int threads);

}  // namespace segorient::detail
