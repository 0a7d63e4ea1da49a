// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <vector>

#include "orientation/automatic/sheet_filter.h"

namespace segorient::detail {

/// Where two sheets meet in a wedge, the mean of their oriented normals may point to either side:
/// points there take the normal of the sheet that they lie on, where the noise allows to tell.
/// Sheets are taken from neighbours whose surroundings agree about the normal, and from those that
/// have got theirs in this way.
/// \param residual median residual of the cloud, in spacings
/// \param filtered normals of some points change, confidences stay: such points are on an edge
void chooseSheets(const PointView& points, const Neighborhoods& neighborhoods,
                  const std::vector<float>& spacing, float residual, int threads,
                  FilteredNormals& filtered);

}  // namespace segorient::detail
