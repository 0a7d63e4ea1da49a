// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/cloud_table.h"

namespace segorient::program {

/// Several clouds as one: all points, in the order of the clouds.
///
/// - Fields: all that any cloud has. Where a cloud lacks one, its points get NaN, or 0 in fields of
///   whole numbers and in `rgb`. Where types differ, the field has one that holds both. A field
///   that has more numbers a point in one cloud than in another is left out, with a note.
/// - `scan`: which cloud, 0, 1, ...; a cloud that has such a field counts as many as its largest.
/// - `vp_x vp_y vp_z`, if a cloud has them or knows its sensor's place: NaN for points of others.
/// - Clouds of height above 1 are listed in `grids`. The joint cloud has no viewpoint and height 1.
/// - What a LAS file says beyond its points stays, of the first one; its scale and offset only if
/// all
///   clouds are LAS and have the same. Triangles do not stay.
///
/// \param names of the clouds, for notes
/// \param headers whether a cloud's own viewpoint (PCD: VIEWPOINT), where it is not 0, counts as
///        known
CloudTable joinClouds(std::vector<CloudTable> clouds, const std::vector<std::string>& names,
                      bool headers);

/// What the LAS file of all clouds says beyond their points; null if none is LAS.
/// \param origins of each cloud, null where it is not LAS
std::shared_ptr<const LasOrigin> commonOrigin(
    const std::vector<std::shared_ptr<const LasOrigin>>& origins);

}  // namespace segorient::program
