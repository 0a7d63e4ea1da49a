// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/segmentation/segmentation.h>

#include <vector>

namespace segorient::detail {

/// Points that have no plane of their own, but a normal from those around them, are given to the
/// segment of the nearest that has one.
/// \param normals 4 floats a point
void labelTheRest(const Neighborhoods& neighborhoods, const std::vector<float>& normals,
                  Segmentation& segmentation);

/// Labels as the final normals have them: a point whose normal is that of the face beside its
/// segment's, as one finds out near sharp edges and between walls, goes to that face's segment.
///
/// The face of a segment is, where the point is, the mean normal of those neighbours that are in
/// it. Where the own one is within 20 degrees the point stays, and also where no other one is
/// nearer by half.
/// Does not depend on the order of points or threads. Labels are ordered by size again; members
/// are not listed, see collectMembers().
/// \param normals final ones, oriented, 4 floats a point
void followFinalNormals(const Neighborhoods& neighborhoods, const std::vector<float>& normals,
                        int threads, Segmentation& segmentation);

}  // namespace segorient::detail
