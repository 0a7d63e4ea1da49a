// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_hints.h>

#include <cstddef>
#include <vector>

#include "io/cloud_table.h"

namespace segorient::program {

using Normals = std::vector<float>;  ///< 4 floats a point

/// Those of a cloud, of length 1.
Normals ownNormals(const CloudTable& table);

/// How normals of the same points differ; signs count for `opposite` only.
struct Difference {
  std::size_t compared = 0;
  std::size_t opposite = 0;
  double median = 0.0;  ///< degrees, as all angles here
  double p90 = 0.0;
  double rms = 0.0;
  double share(std::size_t n) const {
    return compared == 0 ? 0.0 : 100.0 * static_cast<double>(n) / static_cast<double>(compared);
  }
};
Difference compareNormals(const Normals& a, const Normals& b);

/// What pcl::flipNormalTowardsViewpoint() does, where points have sensors of their own.
void turnToOwnSensors(const PointView& points, const OrientationHints& hints, Normals& normals);

/// Share of the points whose sensor is known that it sees from the front, in percent; NaN: none is.
double shareFacing(const PointView& points, const OrientationHints& hints, const Normals& normals);

}  // namespace segorient::program
