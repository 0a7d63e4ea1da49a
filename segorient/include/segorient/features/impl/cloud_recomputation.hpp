// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/features/normal_options.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// recomputeNormals() for a cloud as it comes, with NaN points and duplicates, and neighbours still
/// to be found: works on the distinct finite points. All arrays have one entry a point of the
/// cloud. \param indices points to use; others, and entries out of range, stay as they are \param
/// neighborhoods of the whole cloud, or null to search \param rounds how often the rule is applied
SEGORIENT_FEATURES_EXPORT RecomputationReport
recomputeCloudNormals(const PointView& points, const std::vector<pcl::index_t>& indices,
                      const Neighborhoods* neighborhoods, const std::vector<std::uint8_t>& regular,
                      const RecomputationOptions& options, int rounds,
                      std::vector<std::int32_t>& labels, std::vector<float>& normals);

}  // namespace segorient
