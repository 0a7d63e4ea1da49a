// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/features/normal_options.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// Finds the normals near sharp edges again, from one side of the edge only. Old labels and normals
/// are read and new ones written, so the order of the points does not matter; it may be repeated,
/// with or without segmenting anew in between.
///
/// Does nothing if sizes do not agree.
/// \param regular per label whether the segment is a regular one
/// \param labels per point its segment, -1 for none
/// \param normals 4 floats a point as from estimateNormals(); the curvature stays, and a
///        new normal points to the side of the old one
SEGORIENT_FEATURES_EXPORT RecomputationReport
recomputeNormals(const PointView& points, const Neighborhoods& neighborhoods,
                 const std::vector<std::uint8_t>& regular, const RecomputationOptions& options,
                 std::vector<std::int32_t>& labels, std::vector<float>& normals);

}  // namespace segorient
