// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/segmentation/segmentation.h>

namespace segorient {

/// Cuts a cloud into segments of similar normals (paper, section 2.3): region growing by alpha and
/// beta, then the three clean-up passes.
///
/// Seeds are taken flattest first (curvature, then index); growing is breadth-first; normals are
/// compared without their signs, and each accepted one is given the sign that agrees with the
/// segment. The local spacing of a point is the side of the square that it stands for, from its six
/// nearest neighbours.
///
/// \param points all rows finite where the normal is finite
/// \param normals unit normals and curvatures; points with a NaN normal get label -1, a NaN
///        curvature counts as the highest
/// \param neighborhoods of every point; rows without distances are measured anew
/// \param faces where not null: the segments once more, those united whose common border is smooth.
///        Beta keeps segments so flat that each can be seen through a plane, as triangulation and
///        the paper's orientation ask for, and cuts round faces up by it; here a cylinder is one
///        again. A border is smooth where growing could have crossed it but for beta, and the
///        surface bends there by less than alpha more than its curvature on both sides explains.
/// \return empty if the sizes of the three do not agree
SEGORIENT_SEGMENTATION_EXPORT Segmentation segmentByNormals(const PointView& points,
                                                            const NormalView& normals,
                                                            const Neighborhoods& neighborhoods,
                                                            const SegmentationOptions& options,
                                                            SegmentationReport* report = nullptr,
                                                            Segmentation* faces = nullptr);

}  // namespace segorient
