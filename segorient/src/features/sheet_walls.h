// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <Eigen/Core>

#include <limits>

#include "features/sheet_fit.h"

namespace segorient::detail {

/// Which offsets along the normal belong to the point's own wall.
struct WallSplit {
  float below = -std::numeric_limits<float>::infinity();
  float above = std::numeric_limits<float>::infinity();
  bool found = false;
};
/// \param most_apart walls farther apart than that many spacings are left to their offset alone
WallSplit splitWalls(const Offsets& offsets, const Eigen::Vector3f& normal, float most_apart);
Plane fitWithin(const Offsets& offsets, const Eigen::Vector3f& normal, const WallSplit& split);

}  // namespace segorient::detail
