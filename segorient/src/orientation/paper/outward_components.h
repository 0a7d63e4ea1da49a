// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_result.h>

#include <cstddef>
#include <vector>

#include "orientation/paper/extremal_points.h"

namespace segorient {

/// How the outside of a component is found.
struct ComponentSignOptions {
  float gamma = 0.6108652F;          ///< extremal points with a larger angle do not vote, radians
  std::size_t max_box_points = 120;  ///< m of the paper
  int threads = 0;                   ///< see resolveThreads()
};

/// Numbers the components by descending number of points and turns each one outward: the extremal
/// points of its own subdivision vote for its sign, each by the cosine of its angle. A component
/// that lies in the material of larger ones is the wall of a cavity and turned inward; whether it
/// does is told by the solid angle that the larger ones, already turned, fill around it. Holds for
/// closed components; the confidences tell how sure that is.
/// \param result all points oriented relative to each other within their components
/// \param of_all extremal points of the whole cloud with the same m, where they are known: a cloud
///        that is one component needs no others
void orientComponents(const PointView& points, const PointView& normals,
                      const Neighborhoods& neighborhoods, const ComponentSignOptions& options,
                      OrientationResult& result, const std::vector<ExtremalPoint>& of_all = {});

/// Numbers the components by descending number of points and counts them.
void sortComponents(OrientationResult& result);

}  // namespace segorient
