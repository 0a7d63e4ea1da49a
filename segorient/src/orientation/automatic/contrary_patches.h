// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <vector>

#include "orientation/automatic/sheet_filter.h"

namespace segorient::detail {

/// Turns small patches over whose normals are contrary to those of the surface they lie in. At the
/// tip of a narrow wedge a segment may reach from one face some spacings into the other one; there
/// its normals are right but for the sign, which is that of the face it came from.
///
/// Neighbours with nearly parallel normals, each in the other's plane, are on one surface, so that
/// their signs have to agree. What hangs together by such neighbours of one sign is a patch; it is
/// turned where it meets another one of the other sign that is much larger.
/// \param residual median residual of the cloud, in spacings; where the planes of two sheets cannot
///        be told apart for noise, nothing is done
/// \param filtered some normals change. Where confidences say that the normals around agree, no
///        contrary one is looked for.
void turnContraryPatches(const PointView& points, const Neighborhoods& neighborhoods,
                         const std::vector<float>& spacing, float residual, int threads,
                         FilteredNormals& filtered);

}  // namespace segorient::detail
