// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/orientation/orientation_result.h>

#include <vector>

#include "orientation/paper/extremal_points.h"

namespace segorient {

/// Numbers the components by descending number of points and turns each one outward: the extremal
/// points of its own subdivision vote for its sign, each by the cosine of its angle, if that is
/// less than gamma. A component that lies in the material of larger ones is the wall of a cavity
/// and turned inward; whether it does is told by the solid angle that the larger ones, already
/// turned, fill around it. Holds for closed components; the confidences tell how sure that is.
/// \param result all points oriented relative to each other within their components
/// \param of_all extremal points of the whole cloud with the same m, where they are known: a cloud
///        that is one component needs no others
void orientComponents(const PointView& points, const PointView& normals,
                      const Neighborhoods& neighborhoods, const OrientationOptions& options,
                      OrientationResult& result, const std::vector<ExtremalPoint>& of_all = {});

/// Numbers the components by descending number of points and counts them.
void sortComponents(OrientationResult& result);

}  // namespace segorient
