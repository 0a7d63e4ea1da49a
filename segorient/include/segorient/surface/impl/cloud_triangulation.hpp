// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/surface/segment_mesh.h>

#include <vector>

namespace segorient {

/// What SegmentTriangulation does that does not depend on the point type.
/// \param normals one a point; only looked at where `segmentation` is empty, and the cloud is
///        segmented then
/// \param segmentation of the whole cloud, or empty
/// \param indices points to use, null = all; bad ones are left out
/// \param all see triangulateSegments()
/// \param meshes output, one a segment; empty where false is returned
/// \return false if the segmentation, or the normals that one is to be made from, are not of this
///         cloud
SEGORIENT_SURFACE_EXPORT bool triangulateCloud(const PointView& points, const NormalView& normals,
                                               const Segmentation& segmentation,
                                               const pcl::Indices* indices,
                                               const TriangulationOptions& options, bool all,
                                               std::vector<SegmentMesh>& meshes);

}  // namespace segorient
