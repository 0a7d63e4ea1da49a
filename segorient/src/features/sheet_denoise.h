// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <vector>

#include "features/sheet_normals.h"

namespace segorient {

/// Whether the noise is above about one spacing, so that neighbourhoods of 32 no longer show the
/// surface: planes over few and over many neighbours then fit equally badly.
SEGORIENT_FEATURES_EXPORT bool needsDenoising(const NoiseLevel& noise);

/// Moves every point along the normal of its k neighbours' best-fit plane onto that plane. The
/// neighbourhoods are searched one by one and not kept.
/// \param index built on `points`
/// \return 4 floats a point
SEGORIENT_FEATURES_EXPORT std::vector<float> projectOnPlanes(const PointView& points,
                                                             const search::MedianHashIndex& index,
                                                             int k, int threads = 0);

}  // namespace segorient
